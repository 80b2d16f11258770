//! Text in lines of limited length.

/// The length of a line of generated code.
pub const WIDTH: usize = 120;

/// Lines of at most `width` characters, if words allow it. Lines after the first are indented as the first is.
pub fn wrap(text: &str, width: usize) -> Vec<String> {
    let indent =
        " ".repeat(text.len() - text.trim_start().len() + if text.trim_start().starts_with("- ") { 2 } else { 0 });
    let mut lines = vec![String::new()];
    let mut first = true;
    for word in text.split(' ') {
        let line = lines.last_mut().expect("there is a line");
        if !first && !line.trim().is_empty() && line.chars().count() + 1 + word.chars().count() > width {
            lines.push(indent.clone() + word);
        } else {
            if !first {
                line.push(' ');
            }
            line.push_str(word);
        }
        first = false;
    }
    lines
}
