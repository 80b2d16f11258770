//! How much room texts take, and how they fit into less.

/// The backend takes the size of a font for the height of its lines, which is so much more.
const LINE: f64 = 1.24;

/// Size of a panel's title.
pub const TITLE: i32 = 16;

/// Widths of the ASCII characters from the space on in DejaVu Sans, in hundredths of the font's size: most of the
/// viewers' fonts are narrower.
const WIDTHS: [u8; 95] = [
    32, 41, 46, 84, 64, 96, 78, 28, 40, 40, 50, 84, 32, 37, 32, 34, 64, 64, 64, 64, 64, 64, 64, 64, 64, 64, 34, 34, 84,
    84, 84, 54, 100, 69, 69, 70, 78, 64, 58, 78, 76, 30, 30, 66, 56, 87, 75, 79, 61, 79, 70, 64, 62, 74, 69, 99, 69,
    62, 69, 40, 34, 40, 84, 50, 50, 62, 64, 55, 64, 62, 36, 64, 64, 28, 28, 58, 28, 98, 64, 62, 64, 64, 42, 53, 40, 64,
    60, 82, 60, 60, 53, 64, 34, 64, 84,
];
/// Those of others that numbers are written with.
const OF_NUMBERS: [(&str, u8); 5] = [("⁰¹²³⁴⁵⁶⁷⁸⁹", 41), ("⁻", 53), ("−", 84), ("·", 32), ("µλ", 64)];
/// That of all others, which few exceed.
const OTHER: u8 = 100;

/// The width of a text in a font of this size, or a little more.
pub fn width(text: &str, size: i32) -> i32 {
    let of = |c: char| {
        let ascii = (c as usize).checked_sub(32).and_then(|k| WIDTHS.get(k)).copied();
        let of_numbers = || OF_NUMBERS.iter().find(|(all, _)| all.contains(c)).map(|(_, width)| *width);
        ascii.or_else(of_numbers).unwrap_or(OTHER)
    };
    let hundredths: u32 = text.chars().map(|c| u32::from(of(c))).sum();
    (f64::from(hundredths) / 100.0 * f64::from(size) / LINE).ceil() as i32
}

/// The width of a panel's title, which is bold: a ninth more.
pub fn title_width(text: &str) -> i32 {
    10 * width(text, TITLE) / 9
}

/// A panel's title in lines of a width of at most `room`.
pub fn wrapped_title(text: &str, room: i32) -> Vec<String> {
    wrapped(text, TITLE, 9 * room / 10)
}

/// The text in lines of a width of at most `room`, broken at spaces. A wider word is shortened in the middle.
pub fn wrapped(text: &str, size: i32, room: i32) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let word = shortened(word, size, room);
        let line = lines.last_mut().expect("there is always one");
        let longer = if line.is_empty() { word.clone() } else { format!("{line} {word}") };
        if line.is_empty() || width(&longer, size) <= room {
            *line = longer;
        } else {
            lines.push(word);
        }
    }
    lines
}

/// The text, shortened in the middle to a width of at most `room`.
fn shortened(text: &str, size: i32, room: i32) -> String {
    let letters: Vec<char> = text.chars().collect();
    let kept = |count: usize| -> String {
        let (start, end) = (&letters[..count.div_ceil(2)], &letters[letters.len() - count / 2..]);
        start.iter().chain(&['…']).chain(end).collect()
    };
    if width(text, size) <= room {
        return text.to_owned();
    }
    (0..letters.len()).rev().map(kept).find(|kept| width(kept, size) <= room).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_no_wider_than_their_room_and_hold_all_words_that_are_not() {
        let text = "left_hip_pitch_joint, right_hip_pitch_joint … waist";
        for room in [60, 120, 160, 200, 1000] {
            let lines = wrapped(text, 15, room);
            assert!(lines.iter().all(|line| width(line, 15) <= room), "{room}: {lines:?}");
        }
        assert_eq!(wrapped(text, 15, 1000), [text]);
        assert_eq!(wrapped(text, 15, 200).join(" "), text);
        assert_eq!(wrapped("left_hip_pitch_joint", 15, 80), ["left_h…_joint"]);
        assert_eq!(wrapped("", 15, 80), [""]);
    }
}
