//! The data of the animation: what the page `viewer/` needs to show a motion.

mod bodies;
mod motion;

use serde::Serialize;

use crate::failure::Failure;
use crate::layout::Layout;
use crate::recorded::{Chart, Recorded};
use bodies::{Body, Cut};
use motion::Keyframes;

/// The page, made by `viewer/build.mjs`, with a place for the data.
const PAGE: &str = include_str!("../../viewer/dist/viewer.html");
/// What stands in that place.
const PLACE: &str = "{\"redysim\":\"data\"}";

/// A page of HTML that needs nothing else and plays what was recorded; and what those who look at it should know, which
/// it shows, too.
///
/// # Errors
/// If the model or a table is missing or wrong.
pub fn page(recorded: &Recorded) -> Result<(String, Vec<String>), Failure> {
    let model = recorded.model()?;
    let charts = recorded.charts()?;
    let layout = Layout::of(&model);
    let (motion, notes) = motion::of(recorded, &model, &layout)?;
    let animation = Animation {
        name: &model.name,
        gravity: model.gravity.0,
        bodies: bodies::of(&model, &layout),
        cuts: bodies::cuts(&model),
        motion,
        notes: &notes,
        charts: charts.iter().map(Curves::of).collect(),
        joints: layout.coordinates.iter().map(|coordinate| coordinate.name.as_str()).collect(),
    };
    let json = serde_json::to_string(&animation).map_err(Failure::outside)?;
    Ok((PAGE.replacen(PLACE, &in_html(&json), 1), notes))
}

/// JSON that may stand in a `<script>`: without characters that HTML takes for its own.
fn in_html(json: &str) -> String {
    json.replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026")
}

/// All that the page knows.
#[derive(Serialize)]
struct Animation<'a> {
    name: &'a str,
    gravity: [f64; 3],
    bodies: Vec<Body<'a>>,
    cuts: Vec<Cut<'a>>,
    motion: Keyframes,
    notes: &'a [String],
    charts: Vec<Curves<'a>>,
    /// The names of the coordinates.
    joints: Vec<&'a str>,
}

/// A chart: single precision shows as much as a screen can.
#[derive(Serialize)]
struct Curves<'a> {
    title: &'a str,
    quantity: &'a str,
    unit: &'a str,
    t: &'a [f64],
    curves: Vec<Values<'a>>,
}

#[derive(Serialize)]
struct Values<'a> {
    name: &'a str,
    colour: usize,
    values: Vec<f32>,
}

impl<'a> Curves<'a> {
    fn of(chart: &'a Chart) -> Self {
        let values = |curve: &'a crate::recorded::Curve| Values {
            name: &curve.name,
            colour: curve.colour,
            values: curve.values.iter().map(|&value| value as f32).collect(),
        };
        let curves = chart.curves.iter().map(values).collect();
        Curves { title: chart.title, quantity: chart.quantity, unit: &chart.unit, t: &chart.t, curves }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_has_one_place_for_the_data() {
        assert_eq!(PAGE.matches(PLACE).count(), 1);
    }

    #[test]
    fn json_in_a_script_cannot_end_it_and_means_the_same() {
        let name = "</script><!-- & \u{2028} \"";
        let json = in_html(&serde_json::to_string(name).unwrap());
        assert!(!json.contains(['<', '>', '&']), "{json}");
        assert_eq!(serde_json::from_str::<String>(&json).unwrap(), name);
    }
}
