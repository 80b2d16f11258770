//! How a model file is read, for other files in TOML: every fault is found in one pass and shown where it stands.

use std::ops::Range;
use std::sync::Arc;

use toml::Spanned;
use toml::de::DeTable;

use crate::diagnostic::{Diagnostic, Faults, Findings, Source};
use crate::load::report_syntax;
use crate::outline::Outline;

pub use crate::diagnostic::Message;
pub use crate::diagnostic::messages::Manual;
pub use crate::schema::Field;
pub use crate::schema::reader::{Reader, Shape};
pub use crate::schema::value::Value;

/// Reads the text of a file of the kind that `manual` describes and `shape` gives the keys of. Messages call the file
/// `file_name` and what it describes `item`; `read` is handed the file's table; where it
/// makes nothing of it, it has reported why. Beside what it makes of it stand the warnings.
///
/// # Errors
/// Every fault in the text, each shown where it stands: what is no TOML, or what `read` and the [`Reader`] reported.
///
/// ```
/// use redysim_model::document::{Manual, Shape, read};
///
/// const MANUAL: Manual = Manual { file: "the clock file", examples: &[("hands", "hands = 2", "how many")] };
/// const SHAPE: Shape = Shape { owner: "A clock", keys: &["hands"] };
/// let hands = |text: &str| {
///     read(text, "clock.toml", &MANUAL, &SHAPE, "the clock", |mut clock| {
///         let hands = clock.number("hands");
///         clock.required("hands", hands).value().copied()
///     })
/// };
/// assert_eq!(hands("hands = 3").unwrap().0, 3.0);
/// println!("{}", hands("hand = 3").unwrap_err()); // shows the line with a caret, and asks: did you mean `hands`?
/// ```
pub fn read<T>(
    text: impl Into<String>,
    file_name: impl Into<String>,
    manual: &'static Manual,
    shape: &Shape,
    item: &str,
    read: impl FnOnce(Reader<'_, '_>) -> Option<T>,
) -> Result<(T, Vec<Diagnostic>), Faults> {
    let source = Arc::new(Source { name: file_name.into(), text: text.into() });
    let mut findings =
        Findings::new(Arc::clone(&source), Arc::new(Source { name: String::new(), text: String::new() }));
    let (root, errors) = DeTable::parse_recoverable(&source.text);
    let root = root.get_ref();
    let read = if errors.is_empty() {
        let place = root.keys().map(Spanned::span).min_by_key(|span| span.start).unwrap_or(Range::default());
        read(Reader::of_file(manual, root, place, item, &mut findings).without_unknown_keys(shape))
    } else {
        report_syntax(&errors, &source, &mut findings);
        None
    };
    match read.filter(|_| findings.errors() == 0) {
        Some(read) => Ok((read, findings.into_sorted())),
        None => {
            Err(Faults { diagnostics: findings.into_sorted(), outline: Box::new(Outline::default()), unread: false })
        }
    }
}
