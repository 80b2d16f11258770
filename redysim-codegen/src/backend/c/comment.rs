//! Comments and strings of C, whatever names of the model they have.

use crate::backend::lines::{WIDTH, wrap};

/// `text` as a part of a comment: nothing in it ends the comment, begins another one, is a trigraph, or moves the text
/// around it.
pub fn plain(text: &str) -> String {
    let shown = text.chars().map(|c| if hides(c) { c.escape_default().to_string() } else { c.to_string() });
    shown.collect::<String>().replace("*/", "* /").replace("/*", "/ *").replace("??", "? ?")
}

/// Control characters, and those that set the direction of writing.
fn hides(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// A documentation comment of the given lines; an empty one is a new paragraph, and one that is too long goes on in the
/// next.
pub fn documentation<T: AsRef<str>>(lines: impl IntoIterator<Item = T>) -> String {
    block("/**", lines)
}

/// A comment at the head of a file.
pub fn head<T: AsRef<str>>(lines: impl IntoIterator<Item = T>) -> String {
    block("/*", lines)
}

/// A comment of MATLAB and Octave.
pub fn percent<T: AsRef<str>>(lines: impl IntoIterator<Item = T>) -> String {
    let wrapped = lines.into_iter().flat_map(|line| wrap(&plain(line.as_ref()), WIDTH - 3));
    wrapped.map(|line| format!("% {line}").trim_end().to_string() + "\n").collect()
}

fn block<T: AsRef<str>>(start: &str, lines: impl IntoIterator<Item = T>) -> String {
    let wrapped: Vec<String> = lines.into_iter().flat_map(|line| wrap(&plain(line.as_ref()), WIDTH - 3)).collect();
    if let [line] = wrapped.as_slice()
        && line.chars().count() + start.len() + 4 <= WIDTH
    {
        return format!("{start} {line} */\n");
    }
    let lines: String = wrapped.iter().map(|line| format!(" * {line}").trim_end().to_string() + "\n").collect();
    format!("{start}\n{lines} */\n")
}

/// A string literal.
pub fn string(text: &str) -> String {
    let mut literal = String::from("\"");
    for byte in text.bytes() {
        match byte {
            b'"' | b'\\' | b'?' => literal.extend(['\\', byte.into()]),
            b' '..=b'~' => literal.push(byte.into()),
            // Three digits, so that a digit that follows is not part of it.
            _ => literal += &format!("\\{byte:03o}"),
        }
    }
    literal + "\""
}

/// A statement with its indentation. A long statement continues on further lines: it breaks after a comma in the second half
/// of a line, or else at a space.
pub fn statement(indent: usize, text: &str) -> String {
    let (mut lines, mut rest, mut spaces) = (String::new(), text, " ".repeat(4 * indent));
    while spaces.len() + rest.len() > WIDTH {
        let room = rest.floor_char_boundary(WIDTH - spaces.len());
        let after_comma = rest[..room].rfind(", ").map(|comma| comma + 1).filter(|&end| end > room / 2);
        let Some(end) = after_comma.or_else(|| rest[..room].rfind(' ')).or_else(|| rest.find(' ')) else { break };
        lines += &format!("{spaces}{}\n", &rest[..end]);
        rest = rest[end..].trim_start();
        spaces = " ".repeat(4 * (indent + 1));
    }
    lines + &format!("{spaces}{rest}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_ends_a_comment_or_a_string() {
        assert_eq!(plain("a */ b /* c ??/ \n \u{202e}"), "a * / b / * c ? ?/ \\n \\u{202e}");
        assert_eq!(string("a\"b\\c??/ä\n1"), "\"a\\\"b\\\\c\\?\\?/\\303\\244\\0121\"");
    }

    #[test]
    fn long_statements_and_comments_go_on_in_the_next_line() {
        let text = format!("const double x = {};", vec!["abcdefgh"; 30].join(" + "));
        let lines = statement(1, &text);
        assert!(lines.lines().count() > 2 && lines.lines().all(|line| line.len() <= WIDTH), "{lines}");
        assert_eq!(lines.split_whitespace().collect::<Vec<_>>(), text.split_whitespace().collect::<Vec<_>>());
        let comment = documentation(["one", "", &"word ".repeat(40)]);
        assert!(comment.starts_with("/**\n * one\n *\n * word") && comment.lines().all(|line| line.len() <= WIDTH));
        assert_eq!(documentation(["one"]), "/** one */\n");
    }
}
