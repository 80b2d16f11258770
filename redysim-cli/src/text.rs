//! Data as TOML.

use serde::Serialize;
use toml_edit::visit_mut::VisitMut;
use toml_edit::{DocumentMut, Formatted, Item, RawString, Value};

/// The text of a file with these data, in which very small and very large numbers have exponents.
pub fn to_toml(data: &impl Serialize) -> String {
    let plain = toml::to_string(data).expect("TOML has strings, numbers, arrays and tables");
    // A count above 2⁶³ is written, but not read.
    let Ok(mut document) = plain.parse::<DocumentMut>() else { return plain };
    Shortest.visit_document_mut(&mut document);
    document.to_string()
}

/// A number as the shortest decimal that reads back as exactly this.
pub fn number(number: f64) -> Formatted<f64> {
    match format!("{number:?}").parse() {
        Ok(Value::Float(shortest)) => shortest,
        _ => Formatted::new(number),
    }
}

/// Sets a key to `default`, unless the table has it.
pub fn set_default(table: &mut Item, key: &str, default: Item) {
    if table.get(key).is_some() {
        return;
    }
    // The blank before the brace that closes an inline table is to stand after the new value.
    if let Some((_, last)) = table.as_inline_table_mut().and_then(|table| table.iter_mut().last())
        && last.decor().suffix().and_then(RawString::as_str).is_some_and(|blank| blank.trim().is_empty())
    {
        last.decor_mut().set_suffix("");
    }
    table[key] = default;
}

/// Replaces numbers by their shortest decimals.
struct Shortest;

impl VisitMut for Shortest {
    fn visit_float_mut(&mut self, float: &mut Formatted<f64>) {
        let decor = float.decor().clone();
        *float = number(*float.value());
        *float.decor_mut() = decor;
    }
}

#[cfg(test)]
mod tests {
    use super::to_toml;

    #[test]
    fn small_and_large_numbers_have_exponents_and_keep_their_bits() {
        let numbers = [1.2e-15, 1e-100, -0.0, f64::MAX, 5e-324, 0.1, 3.0];
        let data = std::collections::BTreeMap::from([("numbers", numbers)]);
        let text = to_toml(&data);
        assert_eq!(text.trim(), "numbers = [1.2e-15, 1e-100, -0.0, 1.7976931348623157e308, 5e-324, 0.1, 3.0]");
        let read: std::collections::BTreeMap<String, Vec<f64>> = toml::from_str(&text).unwrap();
        assert_eq!(read["numbers"].iter().map(|n| n.to_bits()).collect::<Vec<_>>(), numbers.map(f64::to_bits));
    }
}
