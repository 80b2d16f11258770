//! The names of generated C: a prefix for everything that is visible, made from the model's name.

/// The prefix of all names of one mechanism: `kr5` gives `kr5_inverse_dynamics`, `KR5_NQ`, `kr5.h`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prefix(String);

/// Words with which `_t` or `.h` gives a name of the C or C++ standard library, of POSIX or of Windows.
const TAKEN: &[&str] = &[
    "assert",
    "char16",
    "char32",
    "char8",
    "complex",
    "ctype",
    "div",
    "double",
    "errno",
    "fenv",
    "float",
    "fpos",
    "imaxdiv",
    "int16",
    "int32",
    "int64",
    "int8",
    "intmax",
    "intptr",
    "inttypes",
    "iso646",
    "ldiv",
    "limits",
    "lldiv",
    "locale",
    "math",
    "max_align",
    "mbstate",
    "nullptr",
    "off",
    "pid",
    "ptrdiff",
    "setjmp",
    "sig_atomic",
    "signal",
    "size",
    "ssize",
    "stdarg",
    "stdbool",
    "stddef",
    "stdint",
    "stdio",
    "stdlib",
    "string",
    "tgmath",
    "time",
    "uint16",
    "uint32",
    "uint64",
    "uint8",
    "uintmax",
    "uintptr",
    "wchar",
    "wctrans",
    "wctype",
    "windows",
    "wint",
];

impl Prefix {
    /// The prefix `name`, if it can be one: letters, digits and underscores of ASCII, not a digit first, and not a name
    /// of the standard library.
    pub fn new(name: &str) -> Option<Prefix> {
        let is_word = !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        let is_free = !name.starts_with(|c: char| c.is_ascii_digit() || c == '_') && !is_taken(name);
        (is_word && is_free).then(|| Prefix(name.to_string()))
    }

    /// `KR 5 arc` is `kr_5_arc`; what still cannot be a prefix, such as `3-RRR`, `math` or `…`, becomes `mechanism_3_rrr`,
    /// `mechanism_math` and `mechanism`.
    pub fn of_model(name: &str) -> Prefix {
        let words = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
        let name = words.map(str::to_ascii_lowercase).collect::<Vec<_>>().join("_");
        let other =
            || Prefix(["mechanism", &name].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("_"));
        Prefix::new(&name).unwrap_or_else(other)
    }

    /// The prefix itself.
    pub fn as_str(&self) -> &str {
        &self.0
    }

    /// A function or variable: `kr5_mass_matrix`.
    pub fn item(&self, name: &str) -> String {
        format!("{}_{name}", self.0)
    }

    /// A type: `kr5_energy_t`.
    pub fn type_of(&self, name: &str) -> String {
        format!("{}_{name}_t", self.0)
    }

    /// A macro: `KR5_NQ`.
    pub fn constant(&self, name: &str) -> String {
        format!("{}_{name}", self.0.to_ascii_uppercase())
    }
}

fn is_taken(name: &str) -> bool {
    TAKEN.contains(&name.to_ascii_lowercase().as_str()) || name.eq_ignore_ascii_case("redysim")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_model_has_a_prefix() {
        let names = [
            ("kr5", "kr5"),
            ("n-fourbar 2", "n_fourbar_2"),
            ("KR5", "kr5"),
            ("3-RRR", "mechanism_3_rrr"),
            ("math", "mechanism_math"),
            ("Time", "mechanism_time"),
            ("…", "mechanism"),
            ("größe", "gr_e"),
            // Followed by an underscore it is not a keyword.
            ("for", "for"),
        ];
        for (model, prefix) in names {
            assert_eq!(Prefix::of_model(model).as_str(), prefix, "{model}");
        }
    }

    #[test]
    fn what_is_not_an_identifier_or_taken_is_not_a_prefix() {
        for name in ["", "my robot", "6axis", "_kr5", "größe", "stdio", "int32", "Redysim"] {
            assert_eq!(Prefix::new(name), None, "{name}");
        }
        assert_eq!(Prefix::new("Kr5_left").unwrap().constant("NQ"), "KR5_LEFT_NQ");
    }
}
