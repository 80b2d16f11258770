//! Names, values and numbers as messages show them.

/// A name or value of the file between backticks; long ones are cut, odd characters escaped.
pub fn quoted(text: &str) -> String {
    const MOST: usize = 60;
    let shown: String = text.chars().take(MOST).flat_map(char::escape_debug).collect();
    let more = if text.chars().nth(MOST).is_some() { "…" } else { "" };
    format!("`{}{more}`", shown.replace("\\\"", "\"").replace("\\'", "'"))
}

/// The name that `text` was probably meant to be, whatever the case of its letters: the nearest by insertions, deletions,
/// replacements and swaps, or else the only one that begins with three or more letters of `text`. Of several as near it is
/// the one that has the same letters, or none.
///
/// ```
/// use redysim_toml::words::nearest;
///
/// assert_eq!(nearest("dmaping", ["damping", "stiffness"]), Some("damping"));
/// assert_eq!(nearest("Stiff", ["damping", "stiffness"]), Some("stiffness"));
/// assert_eq!(nearest("link7", ["link1", "link2"]), None);
/// ```
pub fn nearest<'a>(text: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let text = text.to_lowercase();
    let length = text.chars().count();
    let letters = |text: &str| {
        let mut letters: Vec<char> = text.chars().collect();
        letters.sort_unstable();
        letters
    };
    // The least distance, and the one name at it; `None` for several. The same of names that begin with the text.
    let (mut least, mut near) = ((usize::MAX, true), None);
    let (mut longer, mut is_only) = (None, true);
    for name in names {
        let lower = name.to_lowercase();
        let other = lower.chars().count();
        if length >= 3 && lower.starts_with(&text) {
            is_only &= longer.is_none_or(|longer| longer == name);
            longer = Some(name);
        }
        let most = (length.max(other) / 3).max(1).min(length.max(other).saturating_sub(1)).min(least.0);
        if length.abs_diff(other) > most {
            continue;
        }
        let distance = strsim::damerau_levenshtein(&text, &lower);
        if distance > most {
            continue;
        }
        let distance = (distance, letters(&text) != letters(&lower));
        if distance < least {
            (least, near) = (distance, Some(name));
        } else if distance == least && near.is_some_and(|near| near != name) {
            near = None;
        }
    }
    near.or(longer.filter(|_| is_only))
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
        assert_eq!(nearest("", keys), None);
    }

    #[test]
    fn names_of_one_letter_are_not_near_each_other() {
        assert_eq!(nearest("b", ["a"]), None);
        assert_eq!(nearest("A", ["a", "b"]), Some("a"));
        assert_eq!(nearest("kd", ["kp"]), Some("kp"));
    }

    #[test]
    fn the_case_of_letters_is_of_no_account() {
        assert_eq!(nearest("PID", ["p", "pd", "pid"]), Some("pid"));
        assert_eq!(nearest("ode46", ["Ode45", "Ode15s"]), Some("Ode45"));
        assert_eq!(nearest("RK4", ["Rk4", "Euler"]), Some("Rk4"));
    }

    #[test]
    fn the_one_name_that_begins_with_the_text_is_near() {
        assert_eq!(nearest("damp", ["damping", "friction"]), Some("damping"));
        assert_eq!(nearest("fric", ["friction", "friction_velocity"]), None);
        assert_eq!(nearest("da", ["damping", "friction"]), None);
    }

    #[test]
    fn of_several_names_as_near_none_is_taken() {
        let links: Vec<_> = (1..=6).map(|link| format!("link{link}")).collect();
        assert_eq!(nearest("link7", links.iter().map(String::as_str)), None);
        assert_eq!(nearest("lnik6", links.iter().map(String::as_str)), Some("link6"));
        assert_eq!(nearest("link7", ["link1", "link1"]), Some("link1"));
        assert_eq!(nearest("Ode54", ["Ode4", "Ode5", "Ode45", "Ode23"]), Some("Ode45"));
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
