//! The text of a file, and positions in it.

use std::ops::Range;

/// A file's name, as messages show it, and its text.
#[derive(Debug)]
pub struct Source {
    /// The name.
    pub name: String,
    /// The text.
    pub text: String,
}

/// Where a byte range starts: its line, and the part of the range that lies in that line.
pub(crate) struct Place<'a> {
    /// 1-based.
    pub(crate) line: usize,
    /// 1-based, in characters.
    pub(crate) column: usize,
    /// The line without its end.
    pub(crate) text: &'a str,
    /// The part of the range on this line, in bytes of `text`.
    pub(crate) span: Range<usize>,
}

impl Source {
    /// A text, and the name of its file.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Source { name: name.into(), text: text.into() }
    }

    /// Where `span` starts. Any range is accepted: one outside the text, or not at character boundaries, is moved to
    /// the nearest that is inside.
    pub(crate) fn place(&self, span: &Range<usize>) -> Place<'_> {
        let start = floor_boundary(&self.text, span.start);
        let before = &self.text[..start];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let line_length = self.text[line_start..].find('\n').unwrap_or(self.text.len() - line_start);
        let text = self.text[line_start..line_start + line_length].trim_end_matches('\r');
        let first = (start - line_start).min(text.len());
        let last = floor_boundary(text, span.end.saturating_sub(line_start)).max(first);
        Place {
            line: before.matches('\n').count() + 1,
            column: text[..first].chars().count() + 1,
            text,
            span: first..last,
        }
    }
}

/// Why a file with these bytes, which are not UTF-8, cannot be read, behind its name: "is UTF-16, not UTF-8", or the line
/// that has another encoding.
pub fn not_utf8_because(bytes: &[u8]) -> String {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return "is UTF-16, not UTF-8".into();
    }
    let valid = std::str::from_utf8(bytes).map_or_else(|error| error.valid_up_to(), str::len);
    let line = bytes[..valid].iter().filter(|byte| **byte == b'\n').count() + 1;
    format!("is not UTF-8: line {line} has another encoding (byte {})", valid + 1)
}

/// The last character boundary of `text` that is not after `index`.
fn floor_boundary(text: &str, index: usize) -> usize {
    let index = index.min(text.len());
    (0..=index).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(span: Range<usize>) -> (usize, usize, String) {
        let source = Source { name: String::new(), text: "a = 1\nβ = \"äx\"\r\n".into() };
        let place = source.place(&span);
        (place.line, place.column, place.text[place.span].into())
    }

    #[test]
    fn columns_count_characters() {
        assert_eq!(place(0..1), (1, 1, "a".into()));
        assert_eq!(place(6..8), (2, 1, "β".into()));
        assert_eq!(place(11..16), (2, 5, "\"äx\"".into()));
    }

    #[test]
    fn a_range_ends_with_its_line() {
        assert_eq!(place(4..9), (1, 5, "1".into()));
        assert_eq!(place(15..400), (2, 8, "\"".into()));
    }

    #[test]
    fn any_range_has_a_place() {
        assert_eq!(place(18..18), (3, 1, "".into()));
        assert_eq!(place(500..900), (3, 1, "".into()));
        assert_eq!(place(7..8), (2, 1, "β".into()));
        #[expect(clippy::reversed_empty_ranges, reason = "the point of the test")]
        let reversed = 4..2;
        assert_eq!(place(reversed), (1, 5, "".into()));
    }
}
