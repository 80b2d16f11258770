//! Draws a [`Figure`] in pixels: its SVG, rendered with the font that comes along.

use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb::Database};

use crate::figure::Figure;
use crate::{DrawingError, plot};

/// DejaVu Sans, so that there is text on machines without fonts.
const FONT: &[u8] = include_bytes!("../fonts/DejaVuSans.ttf");
const FAMILY: &str = "DejaVu Sans";

/// Pixels of the picture for each of the SVG's.
const SCALE: f32 = 2.0;

/// The figure as a PNG file of 1600 pixels in width.
///
/// # Errors
///
/// If the figure is too large for the memory.
pub fn png(figure: &Figure) -> Result<Vec<u8>, DrawingError> {
    let mut fonts = Database::new();
    fonts.load_font_data(FONT.to_vec());
    fonts.set_sans_serif_family(FAMILY);
    let options = Options { font_family: FAMILY.to_owned(), fontdb: Arc::new(fonts), ..Options::default() };
    let tree = Tree::from_str(&plot::svg(figure)?, &options).map_err(DrawingError::new)?;
    let size = tree.size().to_int_size().scale_by(SCALE).ok_or_else(|| DrawingError::new("it has no size"))?;
    let mut pixels =
        Pixmap::new(size.width(), size.height()).ok_or_else(|| DrawingError::new("it is too large for the memory"))?;
    resvg::render(&tree, Transform::from_scale(SCALE, SCALE), &mut pixels.as_mut());
    pixels.encode_png().map_err(DrawingError::new)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::figure::Panel;
    use crate::text;

    /// The pixels of a picture with one panel of this title.
    fn pixels(title: &str) -> Pixmap {
        let panels = vec![Panel::new(title, "torque", "N m").line("", 1, &[0.0, 1.0], &[0.0, 1.0])];
        Pixmap::decode_png(&png(&Figure { columns: 1, panels, shared_legend: false }).unwrap()).unwrap()
    }

    #[test]
    fn text_is_drawn_where_no_font_is_installed() {
        for letters in ["Torque τ", "Schräglage", "Момент", "s²"] {
            let differing = |a: &Pixmap, b: &Pixmap| a.pixels().iter().zip(b.pixels()).filter(|(a, b)| a != b).count();
            let drawn = differing(&pixels(letters), &pixels(""));
            assert!(drawn > 100, "{letters}: {drawn} pixels");
        }
    }

    #[test]
    fn values_of_any_size_are_drawn() {
        for values in [[f64::MAX, f64::MIN], [5e-324, 0.0], [f64::NAN, f64::INFINITY], [0.0, 0.0], [1.0, 1.0 + 1e-15]] {
            let panels = vec![Panel::new("all", "torque", "N m").line("", 1, &[0.0, 1.0], &values).prefixed()];
            assert!(png(&Figure { columns: 1, panels, shared_legend: false }).is_ok(), "{values:?}");
        }
    }

    /// The columns of pixels from the first letter of a title to the last.
    fn letters(title: &str) -> i32 {
        let (with, without) = (pixels(title), pixels(""));
        let columns = |(a, (index, b)): (_, (usize, _))| (a != b).then_some(index as u32 % with.width());
        let differing: Vec<u32> =
            with.pixels().iter().zip(without.pixels().iter().enumerate()).filter_map(columns).collect();
        let ends = differing.iter().min().zip(differing.iter().max());
        ends.map_or(0, |(first, last)| ((last - first) as f32 / SCALE) as i32)
    }

    #[test]
    fn texts_are_no_wider_than_the_room_that_they_are_given() {
        for text in ["left_hip_pitch_joint", "10⁻¹²", "MWMWMWMW", "illjjfftt", "12345.67890", "−1·10⁻⁹ µN", "λ … ~"]
        {
            let (drawn, given) = (letters(text), text::width(text, text::TITLE));
            assert!((given - 8..=given).contains(&drawn) || text.contains('…'), "{text}: {drawn} in {given}");
            assert!(drawn <= given, "{text}: {drawn} in {given}");
        }
    }
}
