//! Reading a file from its text to a value.

use std::ops::Range;
use std::sync::Arc;

use toml::Spanned;
use toml::de::{DeTable, Error};

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::findings::Findings;
use crate::key::Keys;
use crate::messages;
use crate::reader::Reader;
use crate::source::Source;
use crate::syntax::{explained, first_line_of_key, single_header, unclosed_bracket};
use crate::value::Table;

/// Reads the text of a file whose table has the keys `keys`. Messages call the file `file_name` and what it describes
/// `item`. `read` receives a reader of the file's table; it returns `None` after it has reported an error. Returns the
/// value of `read` and the warnings.
///
/// # Errors
/// Every error in the text, each shown at its place: invalid TOML, or errors reported by `read` and the [`Reader`].
pub fn read<T>(
    text: impl Into<String>,
    file_name: impl Into<String>,
    keys: &Keys,
    item: &str,
    read: impl FnOnce(Reader<'_, '_>) -> Option<T>,
) -> Result<(T, Vec<Diagnostic>), Diagnostics> {
    let source = Arc::new(Source::new(file_name, text));
    let mut findings = Findings::new(Arc::clone(&source));
    let parsed = parse(&source);
    let read = match parsed.is_valid() {
        true => read(Reader::new(parsed.root(), parsed.start(), item, keys, &mut findings)),
        false => {
            parsed.report(&mut findings);
            None
        }
    };
    match read.filter(|_| findings.errors() == 0) {
        Some(read) => Ok((read, findings.into_sorted().0)),
        None => Err(findings.into_sorted()),
    }
}

/// A text as TOML: as much of it as can be parsed, and its syntax errors.
#[derive(Debug)]
pub struct Parsed<'s> {
    source: &'s Source,
    root: Spanned<DeTable<'s>>,
    errors: Vec<Error>,
}

/// Parses a text.
pub fn parse(source: &Source) -> Parsed<'_> {
    let (root, errors) = DeTable::parse_recoverable(&source.text);
    Parsed { source, root, errors }
}

/// The number of lines with syntax errors that are listed: a file with more is probably not TOML.
const MOST_SYNTAX_ERRORS: usize = 10;

impl<'s> Parsed<'s> {
    /// The table of the whole text.
    pub fn root(&self) -> &Table<'s> {
        self.root.get_ref()
    }

    /// Whether there are no syntax errors.
    pub fn is_valid(&self) -> bool {
        self.errors.is_empty()
    }

    /// The place of the first key, where keys missing in the whole text are reported.
    pub fn start(&self) -> Range<usize> {
        self.root().keys().map(Spanned::span).min_by_key(|span| span.start).unwrap_or_default()
    }

    /// Reports the first syntax error of each line; those after it follow from the first.
    pub fn report(&self, findings: &mut Findings) {
        let text = &self.source.text;
        let start = text.len() - text.trim_start_matches('\u{feff}').trim_start().len();
        if !self.is_valid() && text[start..].starts_with('<') {
            return findings.error(start..start + 1, messages::xml());
        }
        if let Some(header) = table_header(&text[start..]).filter(|_| !self.is_valid()) {
            return findings.error(start + header.start..start + header.end, messages::csv());
        }
        // What stands in a bracket that is not closed is read as a part of it.
        let unclosed = if self.is_valid() { None } else { unclosed_bracket(text) };
        let mut lines = Vec::new();
        let mut has_second_header = false;
        for error in &self.errors {
            let span = error.span().unwrap_or_default();
            let line = self.source.place(&span).line;
            if unclosed.is_some_and(|(open, _)| line >= findings.line(&(open..open))) {
                break;
            }
            if lines.contains(&line) {
                continue;
            }
            if lines.len() == MOST_SYNTAX_ERRORS {
                return findings.error(span, messages::more_is_not_toml());
            }
            if error.message() == "duplicate key" {
                match single_header(self.source, &span) {
                    // The keys below a second header seem to be there twice as well.
                    _ if has_second_header => {}
                    Some((place, name, other)) => {
                        let line = findings.line(&place);
                        findings.error(place, messages::syntax::single_header(&name, line, other));
                        has_second_header = true;
                    }
                    None => {
                        let key = text.get(span.clone()).unwrap_or_default();
                        let first = first_line_of_key(self.source, &span);
                        findings.error(span, messages::syntax::duplicate_key(key, first));
                    }
                }
                lines.push(line);
                continue;
            }
            lines.push(line);
            let (place, message) = explained(self.source, span, error.message());
            findings.error(place, message);
        }
        if let Some((open, close)) = unclosed {
            findings.error(open..open + 1, messages::syntax::unclosed_bracket(close));
        }
    }
}

/// The first line that is neither empty nor a comment, if it is that of a table (CSV): names between commas.
fn table_header(text: &str) -> Option<Range<usize>> {
    let header = text.lines().map(str::trim).find(|line| !line.is_empty() && !line.starts_with('#'))?;
    // Commas in brackets are those of an array.
    let is_closed = |name: &str| name.matches('[').count() == name.matches(']').count();
    let is_table = header.contains(',')
        && !header.contains(['=', ':', '{', '"'])
        && !header.starts_with('[')
        && header.split(',').all(is_closed);
    let start = text.find(header)?;
    is_table.then_some(start..start + header.len())
}
