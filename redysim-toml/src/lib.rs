//! Reads TOML files that people write by hand, and reports every error in them at once, each where it stands.
//!
//! Model files and scenarios are read through this crate. It knows nothing of mechanisms.
//!
//! # Map
//!
//! | item | what it is |
//! |---|---|
//! | [`Key`], [`Keys`] | the keys of a table: name, example, meaning with unit; also for [`Keys::documentation`] |
//! | [`Hint`] | what to write instead of a name that is not among the keys |
//! | [`Reader`] | reads the values of one table, and reports unknown keys, missing keys and invalid values |
//! | [`Field`] | the value of a key: missing, invalid, or a value with its place |
//! | [`Findings`] | collects errors and warnings while a file is read and checked |
//! | [`Diagnostic`] | an error or a warning; its `Display` shows the line of the file with a caret |
//! | [`Message`] | its words: item, rule and value in the title, the rule in the label, the remedy in the help |
//! | [`read`] | reads a file from its text to a value, with all of these |
//! | [`with_decimal_points`] | numbers with a decimal comma, as they are to be written |
//! | [`radians`] | angles with a unit |
//! | [`similar_file`], [`why_missing`], [`path_from`] | the file that a missing one was probably meant to be, and where it is |
//! | [`words`] | quoted values, nearest names, short numbers: for further messages |
//!
//! # Example
//!
//! ```
//! use redysim_toml::{Key, Keys, Reader, read};
//!
//! const HANDS: Key = Key::new("hands", "2", "how many");
//! const TILT: Key = Key::new("tilt", "\"90 deg\"", "without a unit in rad");
//! const CLOCK: Keys = Keys::new("A clock", &[HANDS, TILT]);
//!
//! let clock = |text: &str| {
//!     read(text, "clock.toml", &CLOCK, "the clock", |mut clock| {
//!         let hands = clock.required(&HANDS, Reader::positive);
//!         let tilt = clock.angle(&TILT).value_or(0.0);
//!         Some((*hands.value()?, tilt?))
//!     })
//! };
//! let (value, warnings) = clock("hands = 3\ntilt = '180 deg'").unwrap();
//! assert_eq!(value, (3.0, std::f64::consts::PI));
//! assert!(warnings.is_empty());
//!
//! let errors = clock("hand = 3\ntilt = '1 turn'").unwrap_err();
//! assert_eq!(errors.iter().filter_map(|error| error.position()).collect::<Vec<_>>(), [(1, 1), (2, 8)]);
//! println!("{errors}"); // shows both lines with a caret; of the first it asks: did you mean `hands`?
//! ```

mod decimal;
mod diagnostic;
mod field;
mod file;
mod findings;
mod key;
mod kind;
mod messages;
mod nearby;
mod reader;
mod source;
mod syntax;
mod units;
mod value;
pub mod words;

pub use decimal::with_decimal_points;
pub use diagnostic::{Diagnostic, Diagnostics, Message, Severity, Text};
pub use field::Field;
pub use file::{Parsed, parse, read};
pub use findings::Findings;
pub use key::{Hint, Key, KeyPath, Keys};
pub use kind::Kind;
pub use nearby::{path_from, similar_file, why_missing};
pub use reader::{Reader, TableAt, name_of};
pub use source::{Source, not_utf8_because};
pub use units::radians;
pub use value::{Array, LARGE_ANGLE, MOST_ANGLE, ROUNDED_ANGLE, Table, Value, rounded_quarter_turns};

pub use toml::Spanned;
pub use toml::de::DeValue;
