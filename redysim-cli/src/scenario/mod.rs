//! Scenarios: what is to be computed of a model, in TOML.

mod integrator;
pub mod joints;
mod manual;
mod span;
mod table;
mod torque;
mod trajectory;

use std::path::Path;

use redysim_model::GenericMechanism;
use redysim_model::document::{self, Field, Message, Reader, Shape};
use redysim_runtime::Stabilisation;
use toml::de::DeValue;

use crate::commands;
use crate::failure::Failure;
pub use integrator::{Absolute, Integrator, Tolerances};
use joints::{Joint, Quantity, values};
pub use span::Span;
pub use torque::{Actuation, Law};
pub use trajectory::{Prescribed, USUAL_THROUGH};

/// What is to be computed of a model.
pub struct Scenario {
    /// Its name: that of the file, unless it says another.
    pub name: String,
    /// The text of its file.
    pub text: String,
    /// The text of the model's file.
    pub model_text: String,
    /// The model.
    pub mechanism: GenericMechanism,
    /// Its moving joints.
    pub joints: Vec<Joint>,
    /// Where it starts, or which branch of closed loops is meant.
    pub initial: Initial,
    /// The motion that is prescribed or followed.
    pub trajectory: Option<Prescribed>,
    /// What inverse dynamics is asked for.
    pub inverse: Option<Span>,
    /// What motion is asked for.
    pub forward: Option<Forward>,
}

/// A start.
pub struct Initial {
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    /// Whether closed loops are closed from there.
    pub assemble: bool,
    /// The joints that stay where they are while loops are closed.
    pub held: Vec<usize>,
}

/// A motion that is to be computed.
pub struct Forward {
    pub span: Span,
    pub integrator: Integrator,
    pub torque: Actuation,
    /// What keeps loops closed.
    pub stabilisation: Stabilisation<f64>,
}

const SCENARIO: Shape =
    Shape { owner: "A scenario", keys: &["name", "model", "initial", "trajectory", "inverse", "forward", "run"] };
const INITIAL: Shape = Shape { owner: "`initial`", keys: &["q", "v", "assemble", "held"] };
const INVERSE: Shape = Shape { owner: "`inverse`", keys: &["start", "end", "step"] };
const FORWARD: Shape =
    Shape { owner: "`forward`", keys: &["start", "end", "step", "integrator", "torque", "stabilisation"] };

const PLAIN: Shape = Shape { owner: "This stabilisation", keys: &["kind"] };
const BAUMGARTE: Shape = Shape { owner: "Baumgarte's stabilisation", keys: &["kind", "alpha"] };

impl Scenario {
    /// Reads a scenario and its model, and prints their warnings unless `quiet`.
    ///
    /// # Errors
    /// Every fault of the scenario at once; or those of the model, or the first of a table.
    pub fn load(path: &Path, quiet: bool) -> Result<Scenario, Failure> {
        let bytes = std::fs::read(path).map_err(|error| Failure::file("read", path, &error))?;
        let text = String::from_utf8(bytes).map_err(|_| {
            Failure::input(format!("{} is not UTF-8", path.display()))
                .help("save the file as UTF-8; TOML allows no other encoding")
        })?;
        let mut failure = None;
        let shown = path.display().to_string();
        let read = document::read(text.clone(), shown, &manual::MANUAL, &SCENARIO, "the scenario", |reader| {
            read(reader, path, text, quiet, &mut failure)
        });
        if let Some(failure) = failure {
            return Err(failure);
        }
        let (scenario, warnings) = read.map_err(Failure::input)?;
        if !quiet {
            for warning in warnings {
                eprintln!("{warning}\n");
            }
        }
        scenario.check_tables()?;
        Ok(scenario)
    }

    /// Whether the model has closed loops.
    pub fn loops(&self) -> bool {
        !self.mechanism.model().loops.is_empty()
    }

    /// Fails unless the tables that are used go as far as the runs that use them.
    fn check_tables(&self) -> Result<(), Failure> {
        if let (Some(span), Some(trajectory)) = (self.inverse, &self.trajectory) {
            trajectory.cover(span.start, span.end)?;
        }
        let Some(Forward { span, torque, .. }) = &self.forward else { return Ok(()) };
        match &self.trajectory {
            Some(trajectory) if torque.follows() => trajectory.cover(span.start, span.end),
            _ => torque.cover(span.start, span.end),
        }
    }
}

fn read(
    mut reader: Reader<'_, '_>,
    path: &Path,
    text: String,
    quiet: bool,
    failure: &mut Option<Failure>,
) -> Option<Scenario> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let stem = path.file_stem().map_or("scenario".into(), |stem| stem.to_string_lossy().into_owned());
    let name = name(&mut reader).value_or(stem);
    let model = reader.text("model");
    let model_path = folder.join(reader.required("model", model).value()?);
    // What the rest of the scenario says depends on the joints.
    let (mechanism, model_text) = match commands::load(&model_path, quiet) {
        Ok(loaded) => (GenericMechanism::new(loaded.model), loaded.text),
        Err(fault) => {
            let told = model_path.is_file();
            let why = "the path of the model is taken from the folder of the scenario";
            *failure = Some(if told { fault } else { fault.help(why) });
            return None;
        }
    };
    let joints = joints::of_model(mechanism.model());
    let loops = !mechanism.model().loops.is_empty();
    let all: Vec<usize> = (0..joints.len()).collect();
    let actuated = indices(&joints, |joint| joint.actuated);
    let initial = initial(&mut reader, &joints, &all, &actuated);
    let independent = if loops { &actuated } else { &all };
    let trajectory = Prescribed::read(&mut reader, &joints, independent, folder, failure);
    let followed = trajectory.as_ref().and_then(Option::as_ref);
    let inverse = reader.table("inverse", &INVERSE, |mut reader| Span::read(&mut reader));
    let forward = reader.table("forward", &FORWARD, |mut reader| {
        let span = Span::read(&mut reader);
        let integrator = Integrator::read(&mut reader, span.map_or(f64::INFINITY, Span::length));
        let torque = Actuation::read(&mut reader, &joints, loops, followed, folder, failure);
        let stabilisation = stabilisation(&mut reader);
        Some(Forward { span: span?, integrator: integrator?, torque: torque?, stabilisation: stabilisation? })
    });
    let (inverse, forward) = (asked(inverse)?, asked(forward)?);
    let (name, initial, trajectory) = (name?, initial?, trajectory?);
    Some(Scenario { name, text, model_text, mechanism, joints, initial, trajectory, inverse, forward })
}

/// The scenario's name, after which a folder is called.
fn name(reader: &mut Reader<'_, '_>) -> Field<String> {
    reader.field("name", |reader, path, value| {
        let DeValue::String(name) = value.get_ref() else {
            return reader.wrong_type(path, value, "a string");
        };
        let is_plain = Path::new(name.as_ref()).file_name().is_some_and(|plain| plain == name.as_ref());
        if is_plain {
            return Some(name.to_string());
        }
        let title = format!("{}: `{path}` is `{name}`, after which no folder can be called", reader.item());
        let help = "the results go to a folder of this name: give one without / and not empty".to_owned();
        reader.fault(value, Message { title, label: "no name of a folder".into(), help })
    })
}

fn initial(reader: &mut Reader<'_, '_>, joints: &[Joint], all: &[usize], actuated: &[usize]) -> Option<Initial> {
    let rest = || vec![0.0; joints.len()];
    let field = reader.table("initial", &INITIAL, |mut reader| {
        let q = values(&mut reader, "q", Quantity::Coordinate, joints, all).value_or(rest());
        let v = values(&mut reader, "v", Quantity::Rate, joints, all).value_or(rest());
        let assemble = reader.flag("assemble").value_or(true);
        let held = joints::some(&mut reader, "held", joints).value_or(actuated.to_vec());
        Some(Initial { q: q?, v: v?, assemble: assemble?, held: held? })
    });
    match asked(field)? {
        Some(initial) => Some(initial),
        None => Some(Initial { q: rest(), v: rest(), assemble: true, held: actuated.to_vec() }),
    }
}

fn stabilisation(reader: &mut Reader<'_, '_>) -> Option<Stabilisation<f64>> {
    let kind = |name, kind| (name, (kind, &PLAIN));
    let kinds = [
        kind("projection", Some(Stabilisation::Projection)),
        kind("none", Some(Stabilisation::None)),
        ("baumgarte", (None, &BAUMGARTE)),
    ];
    let field = reader.table_of_kind("stabilisation", "kind", &kinds, kinds[0].1, |mut reader, kind| {
        kind.or_else(|| {
            let alpha = reader.positive("alpha");
            Some(Stabilisation::Baumgarte { alpha: *reader.required("alpha", alpha).value()? })
        })
    });
    field.value_or(Some(Stabilisation::Projection))?
}

/// What a table says, if it is there; `None` where it is faulty.
fn asked<T>(field: Field<Option<T>>) -> Option<Option<T>> {
    match field {
        Field::Missing => Some(None),
        Field::Faulty => None,
        Field::Value(value) => value.into_inner().map(Some),
    }
}

/// The coordinates of the joints that are `wanted`.
pub fn indices(joints: &[Joint], wanted: impl Fn(&Joint) -> bool) -> Vec<usize> {
    joints.iter().enumerate().filter(|(_, joint)| wanted(joint)).map(|(index, _)| index).collect()
}

/// One entry for each of `count` coordinates: `values` for those `at`, zero for the others.
pub fn spread(at: &[usize], values: &[f64], count: usize) -> Vec<f64> {
    let mut all = vec![0.0; count];
    for (&index, &value) in at.iter().zip(values) {
        all[index] = value;
    }
    all
}
