//! Data as TOML.

use serde::Serialize;
use toml_edit::{DocumentMut, Item, TableLike, Value};

/// The text of a file with these data, in which very small and very large numbers have exponents.
pub fn to_toml(data: &impl Serialize) -> String {
    let plain = toml::to_string(data).expect("TOML has strings, numbers, arrays and tables");
    // A count above 2⁶³ is written, but not read.
    let Ok(mut document) = plain.parse::<DocumentMut>() else { return plain };
    shorten_table(document.as_table_mut());
    document.to_string()
}

fn shorten_table(table: &mut dyn TableLike) {
    for (_, item) in table.iter_mut() {
        match item {
            Item::Value(value) => shorten(value),
            Item::Table(table) => shorten_table(table),
            Item::ArrayOfTables(tables) => tables.iter_mut().for_each(|table| shorten_table(table)),
            Item::None => {}
        }
    }
}

/// Replaces numbers by the shortest decimals that read back as exactly these.
fn shorten(value: &mut Value) {
    match value {
        Value::Float(number) if number.value().is_finite() => {
            let decor = number.decor().clone();
            if let Ok(short) = format!("{:?}", number.value()).parse::<Value>() {
                *value = short;
                *value.decor_mut() = decor;
            }
        }
        Value::Array(values) => values.iter_mut().for_each(shorten),
        Value::InlineTable(table) => shorten_table(table),
        _ => {}
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
