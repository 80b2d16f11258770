//! The C compiler that the environment names.

use std::env;
use std::ffi::OsString;

/// The C compiler of the environment variable `CC` and its flags, as in `CC="gcc -m32"`; `cc` where it is empty or not set.
pub fn c_compiler() -> (OsString, Vec<OsString>) {
    words(env::var_os("CC"))
}

fn words(variable: Option<OsString>) -> (OsString, Vec<OsString>) {
    let words = |text: &str| text.split_whitespace().map(OsString::from).collect();
    // What is not Unicode is the path of a file.
    let words: Vec<OsString> =
        variable.map_or_else(Vec::new, |text| text.to_str().map_or_else(|| vec![text.clone()], words));
    let mut words = words.into_iter();
    (words.next().unwrap_or_else(|| "cc".into()), words.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flags_may_follow_the_name_and_nothing_is_cc() {
        let of = |text: &str| words(Some(text.into()));
        assert_eq!(of("gcc -m32 -g"), ("gcc".into(), vec!["-m32".into(), "-g".into()]));
        assert_eq!(of(" clang"), ("clang".into(), Vec::new()));
        for nothing in [None, Some(""), Some("  ")] {
            assert_eq!(words(nothing.map(OsString::from)), ("cc".into(), Vec::new()));
        }
    }
}
