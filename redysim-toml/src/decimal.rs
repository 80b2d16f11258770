//! Numbers with a decimal comma, which neither TOML nor CSV has.

use std::ops::Range;

/// The text with a point for the comma of each number such as 1,5 or -0,25e-3; `None` without such a number. A comma
/// is that of a number if there is a digit on both its sides and no point after those behind it, so that the list `0,15,0,0`
/// is that of `0.15` and `0.0`, and `0,0.5` one of two numbers.
///
/// ```
/// use redysim_toml::with_decimal_points;
///
/// assert_eq!(with_decimal_points("[0,15, 0,0]").unwrap(), "[0.15, 0.0]");
/// assert_eq!(with_decimal_points("[1, 2]"), None);
/// ```
pub fn with_decimal_points(text: &str) -> Option<String> {
    let characters: Vec<char> = text.chars().collect();
    let digit = |index: Option<usize>| {
        index.and_then(|index| characters.get(index)).is_some_and(|character| character.is_ascii_digit())
    };
    let begins_another = |index: usize| characters[index..].iter().find(|c| !c.is_ascii_digit()) == Some(&'.');
    // Whether the number that is being read has its point, its comma or its exponent.
    let mut is_complete = false;
    let with_point = |(index, &character): (usize, &char)| match character {
        ',' if !is_complete && digit(index.checked_sub(1)) && digit(Some(index + 1)) && !begins_another(index + 1) => {
            is_complete = true;
            '.'
        }
        '.' | 'e' | 'E' => {
            is_complete = true;
            character
        }
        '+' | '-' | '0'..='9' => character,
        _ => {
            is_complete = false;
            character
        }
    };
    let written: String = characters.iter().enumerate().map(with_point).collect();
    (written != text).then_some(written)
}

/// The first value of a line of TOML that is a number with a decimal comma, and how it is written with a point; with
/// `arrays` also an array of such numbers, which is otherwise one of more numbers.
pub(crate) fn value_with_comma(line: &str, arrays: bool) -> Option<(Range<usize>, String)> {
    let line = line.split('#').next().unwrap_or_default();
    line.match_indices('=').find_map(|(equals, _)| {
        let rest = &line[equals + 1..];
        let start = line.len() - rest.trim_start().len();
        if arrays && line[start..].starts_with('[') {
            let value = start..start + line[start..].rfind(']')? + 1;
            let written = with_decimal_points(&line[value.clone()])?;
            return Some((value, written));
        }
        let of_a_number = |c: char| c.is_ascii_digit() || "+-,.eE".contains(c);
        let length = line[start..].find(|c| !of_a_number(c)).unwrap_or(line.len() - start);
        let value = line[start..start + length].trim_end_matches(',');
        let written = with_decimal_points(value)?;
        written.parse::<f64>().is_ok().then(|| (start..start + value.len(), written))
    })
}

/// How many elements a flat array has, as text.
pub(crate) fn elements(array: &str) -> usize {
    let inside = array.trim_matches(|c: char| "[]".contains(c) || c.is_whitespace());
    inside.split(',').filter(|element| !element.trim().is_empty()).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_commas_between_digits_are_decimal() {
        for (text, written) in [
            ("1,5", "1.5"),
            ("-0,25e-3", "-0.25e-3"),
            ("1,5 deg", "1.5 deg"),
            ("0,15,0,0,0,0", "0.15,0.0,0.0"),
            ("[0,15, 1, 0,5]", "[0.15, 1, 0.5]"),
            ("[\"1,5 deg\", 0]", "[\"1.5 deg\", 0]"),
        ] {
            assert_eq!(with_decimal_points(text).as_deref(), Some(written));
        }
        for text in ["1.5,2.5", "[0,0.3, 0.2]", "[1, 2]", "a,1", "1,", "1e3,2", ""] {
            assert_eq!(with_decimal_points(text), None, "{text}");
        }
    }

    #[test]
    fn arrays_of_a_line_are_found_on_request() {
        let line = "com = [0,1, 0,05] # m";
        assert_eq!(value_with_comma(line, true), Some((6..17, "[0.1, 0.05]".to_owned())));
        assert_eq!(value_with_comma(line, false), None);
    }

    #[test]
    fn values_of_a_line_are_found_where_they_stand() {
        for (line, found) in [
            ("mass = 0,5", Some((7..10, "0.5"))),
            ("dh = { a = 0,3, alpha = 1 }", Some((11..14, "0.3"))),
            ("dh = { a = 1, d=-2,5e-1}", Some((16..23, "-2.5e-1"))),
            ("mass = 1.5 2 # or = 0,5", None),
            ("name = a1,2", None),
        ] {
            assert_eq!(
                value_with_comma(line, false),
                found.map(|(place, written)| (place, written.to_owned())),
                "{line}"
            );
        }
    }
}
