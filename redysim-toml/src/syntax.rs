//! Syntax errors: from what the parser found to what was probably written, and how TOML writes it.
//!
//! The parser knows what may stand next. What people write instead is a unit behind a number, a comment of another
//! language, a word without quotes, a bracket that is never closed; each has a message of its own.

use std::ops::Range;

use crate::decimal::value_with_comma;
use crate::diagnostic::Message;
use crate::messages::syntax as messages;
use crate::source::Source;

/// The place of a syntax error and its message. `reason` is the parser's, at `span`.
pub(crate) fn explained(source: &Source, span: Range<usize>, reason: &str) -> (Range<usize>, Message) {
    let place = source.place(&span);
    let (line, start) = (place.text, span.start.saturating_sub(place.span.start));
    let in_file = |range: Range<usize>| start + range.start..start + range.end;
    let at = place.span.start;
    if let Some((value, written)) = value_with_comma(line, reason.starts_with("unexpected leading zero")) {
        let message = messages::comma(&line[value.clone()], &written);
        return (in_file(value), message);
    }
    if let Some((header, whole)) = unclosed_header(line, reason) {
        return (in_file(header.clone()), messages::unclosed_header(&line[header], &whole));
    }
    if let Some(comment) = foreign_comment(line) {
        let written = format!("# {}", line[comment.clone()].trim_start_matches(['/', '*', ' ']));
        return (in_file(comment.clone()), messages::foreign_comment(&line[comment], written.trim_end()));
    }
    let explained = match line[..at].rfind('=').or_else(|| line.find('=').filter(|equals| *equals < at)) {
        Some(_) => in_value(line, at, reason),
        None => in_key(line, at, reason),
    };
    match explained {
        Some((range, message)) => (in_file(range), message),
        None => (span, messages::other(reason)),
    }
}

/// A header without its last bracket, and how it is written.
fn unclosed_header(line: &str, reason: &str) -> Option<(Range<usize>, String)> {
    let is_array = reason.starts_with("unclosed array table");
    if !is_array && !reason.starts_with("unclosed table") {
        return None;
    }
    let header = before_comment(line);
    let start = header.len() - header.trim_start().len();
    let (open, close) = if is_array { ("[[", "]]") } else { ("[", "]") };
    let name = header.trim().trim_matches(['[', ']']).trim();
    Some((start..header.trim_end().len(), format!("{open}{name}{close}")))
}

/// The part of a line before `#`.
fn before_comment(line: &str) -> &str {
    line.split('#').next().unwrap_or_default()
}

/// A comment as other languages begin it.
fn foreign_comment(line: &str) -> Option<Range<usize>> {
    let code = before_comment(line);
    if code.contains(['"', '\'']) {
        return None;
    }
    let start = code.find("//").or_else(|| code.find("/*"))?;
    let before = code[..start].trim_end();
    let is_after_value = before.is_empty() || before.contains('=');
    is_after_value.then(|| start..code.trim_end().len())
}

/// Whether a text is a key as TOML has it without quotes, or several between dots.
fn is_bare_key(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || "_-.".contains(c))
}

/// An error before any `=` of its line.
fn in_key(line: &str, at: usize, reason: &str) -> Option<(Range<usize>, Message)> {
    let code = before_comment(line).trim_end();
    let begin = code.len() - code.trim_start().len();
    let whole = begin..code.len();
    let rest = code.get(begin..)?;
    if reason.starts_with("unquoted keys cannot be empty") && rest.starts_with('=') {
        return Some((begin..begin + 1, messages::value_without_key(rest)));
    }
    if !reason.starts_with("key with no value") {
        return None;
    }
    let is_value = |text: &str| text.parse::<f64>().is_ok() || text.starts_with(['"', '\'', '[', '{']);
    if let Some((key, value)) = rest.split_once(':').filter(|(key, _)| is_bare_key(key.trim())) {
        let value = value.trim().trim_end_matches(',').trim_end();
        let is_bare = !is_value(value) && !["true", "false", ""].contains(&value);
        let written = if is_bare { format!("{value:?}") } else { value.into() };
        return Some((whole, messages::colon(key.trim(), &written)));
    }
    if let Some((words, value)) = rest.split_once('=') {
        let written = words.split_whitespace().collect::<Vec<_>>().join("_");
        return is_bare_key(&written).then(|| {
            (begin..begin + words.trim_end().len(), messages::key_of_words(words.trim(), &written, value.trim()))
        });
    }
    let (key, value) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
    match is_bare_key(key) && (value.is_empty() || is_value(value.trim())) {
        true => Some((at..at.max(code.len()), messages::no_equals(key, value.trim()))),
        false => None,
    }
}

/// An error in a value.
fn in_value(line: &str, at: usize, reason: &str) -> Option<(Range<usize>, Message)> {
    let place = token(line, at);
    let text = line.get(place.clone())?;
    let quotes = ['“', '”', '„', '‟', '‘', '’', '‚', '«', '»', '`', '´'];
    if reason.starts_with("invalid basic string") || reason.starts_with("invalid literal string") {
        let quote = if reason.starts_with("invalid basic") { '"' } else { '\'' };
        return line[at..].trim().is_empty().then(|| (place, messages::unclosed_string(quote)));
    }
    if text.is_empty() {
        let key = line[..at].trim_end().trim_end_matches('=').trim_end();
        let is_missing = line[..at].trim_end().ends_with('=') && line[at..].trim_start().is_empty();
        return is_missing.then(|| {
            let begin = key.len() - key.trim_start().len();
            (begin..line.trim_end().len(), messages::no_value(key.trim()))
        });
    }
    if text.contains(quotes) {
        return Some((place, messages::curly_quotes(text, text.trim_matches(quotes).trim())));
    }
    if let Some(tuple) = tuple(line, at) {
        let found = &line[tuple.clone()];
        return Some((tuple, messages::round_brackets(found, found.trim_matches(['(', ')']).trim())));
    }
    if let Some(array) = separated_otherwise(line, &place) {
        let written = line[array.clone()].replace([';', ','], " ");
        let written = written.trim_matches(['[', ']']).split_whitespace().collect::<Vec<_>>().join(", ");
        return Some((array.clone(), messages::separators(&line[array], &written)));
    }
    if reason.starts_with("unexpected key or value") {
        // An equals sign belongs to a second key, which begins before it.
        let second_key = || line[..at].trim_end().split(char::is_whitespace).next_back().unwrap_or_default().len();
        let at = if line[at..].starts_with('=') { line[..at].trim_end().len() - second_key() } else { at };
        let found = line[at..].trim_end();
        return match found {
            "," | ";" => Some((at..at + 1, messages::end_of_line(found))),
            _ => Some((at..at + found.len(), messages::something_follows(found))),
        };
    }
    if let Some(key) = next_key(line, at, &place, reason) {
        let message = messages::missing_comma(&line[key.clone()]);
        return Some((key, message));
    }
    if text.ends_with(';') {
        return Some((place.end - 1..place.end, messages::end_of_line(";")));
    }
    value(text, reason).map(|message| (place, message))
}

/// The key that follows a value in braces without a comma before it.
fn next_key(line: &str, at: usize, place: &Range<usize>, reason: &str) -> Option<Range<usize>> {
    let start = match reason.starts_with("missing comma between key-value pairs") {
        true => at,
        false => place.start + line[place.clone()].find(char::is_whitespace)?,
    };
    let before = line[start..].split_once('=')?.0.trim_end();
    let name = before.split_whitespace().last()?;
    let begin = start + before.len() - name.len();
    (begin < place.end.max(at + 1) && is_bare_key(name)).then_some(begin..begin + name.len())
}

/// A value in round brackets that an error is in.
fn tuple(line: &str, at: usize) -> Option<Range<usize>> {
    let equals = line[..at].rfind('=')?;
    let start = line.len() - line[equals + 1..].trim_start().len();
    let length = line[start..].find(')').filter(|_| line[start..].starts_with('('))?;
    (start <= at).then_some(start..start + length + 1)
}

/// The bytes of the value that an error is in: up to a comma, a bracket or a comment.
fn token(line: &str, at: usize) -> Range<usize> {
    let start = line[..at].rfind(['=', ',', '[', '{']).map_or(0, |before| before + 1);
    let ends = [',', ']', '}', '#'];
    let end = line[start..].find(ends).map_or(line.len(), |end| start + end);
    let text = &line[start..end];
    let begin = start + text.len() - text.trim_start().len();
    begin..begin.max(start + text.trim_end().len())
}

/// The array around a value whose elements are numbers with blanks or semicolons between them.
fn separated_otherwise(line: &str, place: &Range<usize>) -> Option<Range<usize>> {
    let open = line[..place.start].rfind('[')?;
    let close = open + line[open..].find(']')?;
    let inside = line.get(open + 1..close)?.replace([';', ','], " ");
    let numbers: Vec<_> = inside.split_whitespace().collect();
    (numbers.len() > 1
        && numbers.iter().all(|number| number.parse::<f64>().is_ok())
        && place.end <= close
        && line[place.clone()].contains([';', ' ']))
    .then_some(open..close + 1)
}

/// The message about an invalid value by itself.
fn value(text: &str, reason: &str) -> Option<Message> {
    let lower = text.to_ascii_lowercase();
    if matches!(lower.as_str(), "true" | "false" | "inf" | "nan") {
        return (lower != text).then(|| messages::lower_case(text, &lower));
    }
    if matches!(lower.as_str(), "none" | "null" | "nil" | "undefined") {
        return Some(messages::nothing(text));
    }
    if let Some(written) = number(text) {
        return Some(messages::number(text, &written));
    }
    if let Some(degrees) = of_pi(&lower) {
        return Some(messages::expression(text, Some(&format!("\"{degrees:?} deg\"").replace(".0 deg", " deg"))));
    }
    let digits = text.find(|c: char| !(c.is_ascii_digit() || "+-.eE_".contains(c))).unwrap_or(text.len());
    // The e of a unit is not an exponent's.
    let (size, unit) = text.split_at(text[..digits].trim_end_matches(['e', 'E']).len());
    let is_word = |text: &str| {
        text.starts_with(|c: char| c.is_alphabetic() || c == '_') && !text.contains(['/', '*', '^', '(', '+'])
    };
    if size.parse::<f64>().is_ok() && !unit.trim().is_empty() {
        let unit = unit.trim();
        let is_unit = unit.starts_with(|c: char| c.is_alphabetic() || "°%µ".contains(c)) && !unit.contains('(');
        let angle = match unit.to_lowercase().as_str() {
            "°" | "deg" | "degree" | "degrees" => Some("deg"),
            "rad" | "radian" | "radians" => Some("rad"),
            _ => None,
        };
        return Some(match angle {
            Some(angle) => messages::angle_without_quotes(text, &format!("\"{size} {angle}\"")),
            None if is_unit => messages::unit(text, size),
            None if unit.split_whitespace().all(|more| more.parse::<f64>().is_ok()) => {
                messages::something_follows(unit)
            }
            None => messages::expression(text, None),
        });
    }
    if reason.starts_with("invalid exponent") {
        return None;
    }
    match is_word(text) && !text.contains(['"', '\'', '=', '[', ']']) {
        true => Some(messages::no_quotes(text)),
        false if text.contains(['*', '/', '^', '(']) => Some(messages::expression(text, None)),
        false => None,
    }
}

/// A number that TOML does not read, as it does: with a digit on both sides of its point, and none too many.
fn number(text: &str) -> Option<String> {
    let (sign, size) = text.split_at(text.len() - text.trim_start_matches(['+', '-']).len());
    let is_number = size.starts_with(|c: char| c.is_ascii_digit() || c == '.') && text.parse::<f64>().is_ok();
    if !is_number || size == "." {
        return None;
    }
    let (digits, exponent) = size.split_at(size.find(['e', 'E']).unwrap_or(size.len()));
    let (whole, part) = digits.split_once('.').map_or((digits, None), |(whole, part)| (whole, Some(part)));
    let whole = match whole.trim_start_matches('0') {
        "" => "0",
        whole => whole,
    };
    let part = part.map_or(String::new(), |part| format!(".{}", if part.is_empty() { "0" } else { part }));
    let written = format!("{sign}{whole}{part}{exponent}");
    (written != text).then_some(written)
}

/// The degrees of a fraction of π, such as `-3*pi/4`.
fn of_pi(text: &str) -> Option<f64> {
    let text: String = text.chars().filter(|c| !c.is_whitespace()).collect();
    let text =
        ["math.", "np.", "numpy.", "m_"].iter().fold(text, |text, prefix| text.replace(prefix, "")).replace('π', "pi");
    let (before, after) = text.split_once("pi")?;
    let factor = match before.trim_end_matches('*') {
        "" | "+" => 1.0,
        "-" => -1.0,
        factor => factor.parse().ok()?,
    };
    let divisor: f64 = if after.is_empty() { 1.0 } else { after.strip_prefix('/')?.parse().ok()? };
    let degrees: f64 = factor * 180.0 / divisor;
    degrees.is_finite().then_some(degrees)
}

/// The first bracket that is not closed, of an array or a table in a line, with what closes it: it is followed by a header
/// or the end of the text, or that of an array by the next key.
pub(crate) fn unclosed_bracket(text: &str) -> Option<(usize, char)> {
    let mut open: Vec<(usize, char)> = Vec::new();
    let mut at = 0;
    // The quotes around a string of several lines, while it goes on.
    let mut quotes: Option<&str> = None;
    for line in text.split_inclusive('\n') {
        let (start, mut rest) = (at, line);
        at += line.len();
        if quotes.is_none() {
            let code = before_comment(line).trim();
            let is_next = is_header(code) || (open.last().is_some_and(|(_, close)| *close == ']') && is_entry(code));
            match open.first() {
                Some(_) if is_next => return open.last().copied(),
                None if code.starts_with('[') => continue,
                _ => {}
            }
        }
        while let Some(first) = rest.chars().next() {
            let here = start + line.len() - rest.len();
            if let Some(closing) = quotes {
                let Some(end) = rest.find(closing) else { break };
                rest = &rest[end + closing.len()..];
                quotes = None;
                continue;
            }
            let long = ["\"\"\"", "'''"].into_iter().find(|long| rest.starts_with(long));
            let length = match first {
                '#' => break,
                _ if long.is_some() => {
                    quotes = long;
                    3
                }
                '"' | '\'' => string_length(rest, first),
                '[' | '{' => {
                    open.push((here, if first == '[' { ']' } else { '}' }));
                    1
                }
                ']' | '}' => {
                    match open.pop() {
                        Some((_, close)) if close == first => {}
                        // Another one is closed: which is wrong, the parser says.
                        _ => return None,
                    }
                    1
                }
                other => other.len_utf8(),
            };
            rest = &rest[length..];
        }
    }
    open.last().copied()
}

/// The length of the string that a text begins with, on one line.
fn string_length(text: &str, quote: char) -> usize {
    let mut is_escaped = false;
    for (index, character) in text.char_indices().skip(1) {
        match character {
            '\n' => return index,
            _ if is_escaped => is_escaped = false,
            '\\' if quote == '"' => is_escaped = true,
            _ if character == quote => return index + 1,
            _ => {}
        }
    }
    text.len()
}

/// Whether a line is a header such as `[[link]]`.
pub(crate) fn is_header(line: &str) -> bool {
    header(line).is_some()
}

/// The name in a header, and whether it is that of an array of tables.
pub(crate) fn header(line: &str) -> Option<(&str, bool)> {
    let line = before_comment(line).trim();
    let name = line.strip_prefix('[')?.strip_suffix(']')?;
    let inner = name.strip_prefix('[').and_then(|name| name.strip_suffix(']'));
    let (name, is_array) = inner.map_or((name, false), |inner| (inner, true));
    let name = name.trim();
    let is_name = name.starts_with(|c: char| c.is_alphabetic() || c == '_')
        && name.chars().all(|c| c.is_alphanumeric() || "_-.".contains(c));
    is_name.then_some((name, is_array))
}

/// Whether a line begins with a key and `=`.
fn is_entry(line: &str) -> bool {
    key_of(line).is_some()
}

/// The key that a line begins with.
fn key_of(line: &str) -> Option<&str> {
    let key = line.split_once('=')?.0.trim();
    let is_key = key.starts_with(|c: char| c.is_alphabetic() || c == '_')
        && key.chars().all(|c| c.is_alphanumeric() || "_-.".contains(c));
    is_key.then_some(key)
}

/// A table that stands twice, with headers of both kinds, or of the one kind that may occur once: the place of the header
/// `[name]`, its name, and the line of another one.
pub(crate) fn single_header(source: &Source, span: &Range<usize>) -> Option<(Range<usize>, String, usize)> {
    let (name, _) = header(source.place(span).text)?;
    let mut at = 0;
    let mut headers = Vec::new();
    for (number, line) in source.text.split_inclusive('\n').enumerate() {
        if let Some((_, is_array)) = header(line).filter(|(found, _)| *found == name) {
            let code = before_comment(line);
            let start = code.len() - code.trim_start().len();
            headers.push((at + start..at + code.trim_end().len(), is_array, number + 1));
        }
        at += line.len();
    }
    let single = headers.iter().rfind(|(_, is_array, _)| !is_array)?;
    let other = headers.iter().find(|(_, is_array, _)| *is_array).or_else(|| headers.first())?;
    (other.2 != single.2).then(|| (single.0.clone(), name.to_owned(), other.2))
}

/// The line on which the key at `span` stands before in its table, if that is seen.
pub(crate) fn first_line_of_key(source: &Source, span: &Range<usize>) -> Option<usize> {
    let key = source.text.get(span.clone())?;
    let line = source.place(span).line;
    let before: Vec<&str> = source.text.lines().take(line - 1).collect();
    let of_table = before.iter().enumerate().rev().take_while(|(_, line)| !is_header(line));
    of_table.filter(|(_, line)| key_of(before_comment(line).trim()) == Some(key)).last().map(|(index, _)| index + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_digits_on_both_sides_of_their_point() {
        for (text, written) in [(".4", "0.4"), ("4.", "4.0"), ("-.5e3", "-0.5e3"), ("1.e3", "1.0e3"), ("007", "7")] {
            assert_eq!(number(text).as_deref(), Some(written));
        }
        for text in ["4.0", ".", "abc", "inf", "1e", "-"] {
            assert_eq!(number(text), None, "{text}");
        }
    }

    #[test]
    fn fractions_of_pi_are_angles() {
        for (text, degrees) in
            [("pi", 180.0), ("-pi/2", -90.0), ("3 * pi / 4", 135.0), ("math.pi/2", 90.0), ("2π", 360.0)]
        {
            assert_eq!(of_pi(text), Some(degrees), "{text}");
        }
        assert_eq!(of_pi("pint"), None);
        assert_eq!(of_pi("sin(pi)"), None);
    }

    #[test]
    fn brackets_that_are_not_closed_are_found() {
        let at = |text: &str| unclosed_bracket(text);
        assert_eq!(at("a = [1, 2\nb = 3\n"), Some((4, ']')));
        assert_eq!(at("a = [[1, 2], [3, 4]\n[[link]]\n"), Some((4, ']')));
        assert_eq!(at("a = { b = 1\n[[link]]\n"), Some((4, '}')));
        assert_eq!(at("a = { b = 1,\n"), Some((4, '}')));
        for closed in [
            "[[link]]\na = [\n  [1, 2],\n  [3, 4]\n]\n",
            "a = { # [\n  b = 1,\n  c = [2]\n}\n[x]\n",
            "a = \"[\"\nb = '{'\nc = \"\"\"\n[\n\"\"\"\n",
            "a = \"\\\"[\"\n[[link]\nb = 1\n",
        ] {
            assert_eq!(at(closed), None, "{closed}");
        }
    }
}
