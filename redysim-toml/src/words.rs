//! Names, values and numbers as messages show them.

/// A name or value of the file between backticks; long ones are cut, odd characters escaped.
pub fn quoted(text: &str) -> String {
    const MOST: usize = 60;
    let shown: String = text.chars().take(MOST).flat_map(char::escape_debug).collect();
    let more = if text.chars().nth(MOST).is_some() { "…" } else { "" };
    format!("`{}{more}`", shown.replace("\\\"", "\"").replace("\\'", "'"))
}

/// The name that `text` was probably meant to be: the nearest by insertions, deletions, replacements and swaps.
pub fn nearest<'a>(text: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let near = |name: &&str| {
        let longer = text.chars().count().max(name.chars().count());
        Some(strsim::damerau_levenshtein(text, name)).filter(|distance| *distance <= (longer / 3).max(1))
    };
    let candidates = names.into_iter().filter_map(|name| Some((near(&name)?, name)));
    candidates.min_by_key(|(distance, _)| *distance).map(|(_, name)| name)
}

/// A list of names, shortened to the first 20.
pub fn shortened(names: &[&str]) -> String {
    const MOST: usize = 20;
    let more = if names.len() > MOST { ", …" } else { "" };
    format!("{}{more}", names[..names.len().min(MOST)].join(", "))
}

/// "did you mean `x`? ", or nothing.
pub fn did_you_mean(name: Option<&str>) -> String {
    name.map_or(String::new(), |name| format!("did you mean {}? ", quoted(name)))
}

/// A computed value, rounded to six digits.
pub fn rounded(value: f64) -> String {
    let short: f64 = format!("{value:.5e}").parse().unwrap_or(value);
    format!("{short:?}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_near_names_are_near() {
        let keys = ["mass", "com", "name"];
        assert_eq!(nearest("mas", keys), Some("mass"));
        assert_eq!(nearest("nmae", keys), Some("name"));
        assert_eq!(nearest("colour", keys), None);
        assert_eq!(nearest("link1", ["arm", "link2"]), Some("link2"));
    }

    #[test]
    fn computed_values_are_short() {
        assert_eq!(rounded(1.0000000000000002e-6), "1e-6");
        assert_eq!(rounded(-0.1), "-0.1");
        assert_eq!(rounded(2.0 / 3.0), "0.666667");
    }

    #[test]
    fn quoted_texts_stay_on_one_line() {
        assert_eq!(quoted("two\nlines"), "`two\\nlines`");
        assert_eq!(quoted(&"x".repeat(100)).chars().count(), 63);
    }
}
