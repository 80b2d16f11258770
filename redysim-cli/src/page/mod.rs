//! The page `viewer/` that shows a mechanism in 3D, filled with data: a run that it plays, or a model whose coordinates
//! have sliders.

mod bodies;
mod camera;
mod contacts;
mod footprints;
mod meshes;
mod motion;
mod planes;
mod sliders;
mod solid;

use std::path::Path;

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use redysim_model::Model;
use redysim_model::spatial::Mat3;
use serde::Serialize;

use crate::failure::Failure;
use crate::layout::Layout;
use crate::output;
use crate::recorded::{Chart, Recorded};
use bodies::{Body, Cut, Frame, Orientations};
pub use camera::Camera;
use contacts::Contacts;
use meshes::Meshes;
use motion::Keyframes;
use sliders::Slider;

/// The page, made by `viewer/build.mjs`, with a place for the data.
const PAGE: &str = include_str!("../../viewer/dist/viewer.html");
/// What stands in that place.
const PLACE: &str = "{\"redysim\":\"data\"}";

/// A page of HTML that needs nothing else.
pub struct Page {
    /// Its text.
    pub html: String,
    /// What those who look at it should know, which it shows, too.
    pub notes: Vec<String>,
    /// The meshes that are left out.
    missing: Vec<Failure>,
}

impl Page {
    /// The page that plays what was recorded; without a `camera` the page chooses it by the motion.
    ///
    /// # Errors
    /// If the model or a table is missing or wrong, or if there is nothing for the camera to follow.
    pub fn of_run(recorded: &Recorded, camera: Option<Camera>) -> Result<Page, Failure> {
        let model = recorded.model()?;
        if let Some(camera) = camera {
            camera.check(&model)?;
        }
        let urdf = recorded.urdf();
        let charts = recorded.charts()?;
        let layout = Layout::of(&model);
        let (motion, notes) = motion::of(recorded, &model, &layout)?;
        let charts = charts.iter().map(Curves::of).collect();
        let names = layout.coordinates.iter().map(|coordinate| coordinate.name.clone()).collect();
        let base = camera::moving_base(&model).map(|link| bodies::number(Some(link)));
        let mut data = Data { charts, camera, base, ..Data::of(&model, &layout, names, Moved::Motion(motion), notes) };
        data.contacts = contacts::of(recorded, &model, &layout)?;
        if let Some(contacts) = &data.contacts {
            contacts.extend(&mut data.bodies);
            data.notes.extend(contacts.note());
        }
        data.page(urdf.as_deref())
    }

    /// The page on which whoever looks at it moves the model, with the meshes of the URDF of which it was made.
    ///
    /// # Errors
    /// If the data have no JSON.
    pub fn of_model(model: &Model, urdf: Option<&Path>) -> Result<Page, Failure> {
        let layout = Layout::of(model);
        let (sliders, note) = sliders::of(model, &layout);
        let names = sliders.iter().map(|slider| slider.name.clone()).collect();
        Data::of(model, &layout, names, Moved::Sliders(sliders), note.into_iter().collect()).page(urdf)
    }

    /// Writes it to `path`, and prints where it is, its notes and what it lacks unless `quiet`.
    ///
    /// # Errors
    /// If the file is there and `force` is not given, or if it cannot be written.
    pub fn write(&self, path: &Path, force: bool, quiet: bool) -> Result<(), Failure> {
        output::write_file(path, self.html.as_bytes(), force)?;
        if !quiet {
            self.missing.iter().for_each(|missing| output::to_stderr(&missing.warning()));
            self.notes.iter().for_each(|note| output::to_stderr(&format!("note: {note}")));
            let size = self.html.len().div_ceil(1000);
            output::to_stdout(&format!("{} ({size} kB): open it in a browser", path.display()));
        }
        Ok(())
    }
}

/// A rotation as the page takes it: x, y, z, w.
fn quaternion(rotation: Mat3<f64>) -> [f64; 4] {
    let matrix = Matrix3::from_fn(|row, column| rotation.0[row][column]);
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix)).coords.into()
}

/// JSON that may stand in a `<script>`: without characters that HTML takes for its own.
fn in_html(json: &str) -> String {
    json.replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026")
}

/// All that the page knows.
#[derive(Serialize)]
struct Data<'a> {
    name: &'a str,
    gravity: [f64; 3],
    bodies: Vec<Body<'a>>,
    cuts: Vec<Cut<'a>>,
    frames: Vec<Frame<'a>>,
    #[serde(flatten)]
    moved: Moved,
    notes: Vec<String>,
    charts: Vec<Curves<'a>>,
    /// Of a run on the ground.
    contacts: Option<Contacts>,
    /// Of a run, if it is given.
    camera: Option<Camera>,
    /// The body that the camera can follow in a run.
    base: Option<usize>,
    #[serde(flatten)]
    drawn: Meshes,
    /// The names of the coordinates.
    joints: Vec<String>,
}

/// What moves the mechanism.
#[derive(Serialize)]
#[serde(rename_all = "lowercase")]
enum Moved {
    /// A run.
    Motion(Keyframes),
    /// Whoever looks at it.
    Sliders(Vec<Slider>),
}

impl<'a> Data<'a> {
    /// The data of a model without curves; its coordinates have `names`.
    fn of(model: &'a Model, layout: &Layout, names: Vec<String>, moved: Moved, notes: Vec<String>) -> Self {
        let orientations = match moved {
            Moved::Motion(_) => Orientations::Quaternion,
            Moved::Sliders(_) => Orientations::Rpy,
        };
        Data {
            name: &model.name,
            gravity: model.gravity.0,
            bodies: bodies::of(model, layout, orientations),
            cuts: bodies::cuts(model),
            frames: bodies::frames(model),
            moved,
            notes,
            charts: Vec::new(),
            contacts: None,
            camera: None,
            base: None,
            drawn: Meshes::default(),
            joints: names,
        }
    }

    /// The page of these data, with the meshes of a URDF.
    fn page(mut self, urdf: Option<&Path>) -> Result<Page, Failure> {
        self.drawn = urdf.map(|urdf| Meshes::of_urdf(urdf, &self.bodies)).unwrap_or_default();
        match self.drawn.missing.len() {
            0 => {}
            1 => self.notes.push("one mesh is left out".into()),
            count => self.notes.push(format!("{count} meshes are left out")),
        }
        let json = serde_json::to_string(&self).map_err(Failure::outside)?;
        let Data { notes, drawn: Meshes { missing, .. }, .. } = self;
        Ok(Page { html: PAGE.replacen(PLACE, &in_html(&json), 1), notes, missing })
    }
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
