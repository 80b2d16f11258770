//! Scenarios: what is to be computed of a model, in TOML.

mod chosen;
pub mod contact;
mod forces;
mod forward;
mod frames;
mod held;
mod hints;
pub mod in_space;
mod initial;
mod integrator;
mod joints;
pub mod keys;
mod law;
mod limits;
mod prescribed;
mod resolution;
pub mod shorthand;
mod space;
mod span;
mod subject;
mod swing;
mod table;
mod torque;
mod trajectory;

use std::cell::OnceCell;
use std::path::{Path, PathBuf};

use redysim_model::{Diagnostic, GenericMechanism, Model};
use redysim_runtime::LoopClosure;
use redysim_toml::words::did_you_mean;
use redysim_toml::{DeValue, Field, Key, Message, Reader, not_utf8_because, path_from, similar_file};
use toml_edit::DocumentMut;

use crate::failure::Failure;
use crate::kind::Kind;
use crate::layout::Layout;
use crate::model::{self, ModelFile};
use contact::Contacts;
pub use contact::Ground;
pub use forward::Forward;
pub use held::Held;
pub use initial::Initial;
pub use integrator::{Absolute, Integrator, Tolerances, usual_method};
pub use law::Law;
pub use span::Span;
use subject::given;
pub use subject::{Dynamics, Subject};
use table::InputTable;
pub use torque::{HeldFrame, Torque};
pub use trajectory::{Prescribed, Spread, USUAL_THROUGH};

/// The text of the scenario file at `path`.
///
/// # Errors
/// If it cannot be read.
pub fn read_text(path: &Path) -> Result<String, Failure> {
    let bytes = std::fs::read(path).map_err(|error| Failure::file("read", path, &error))?;
    String::from_utf8(bytes).map_err(|error| {
        Failure::input(format!("{} {}", path.display(), not_utf8_because(error.as_bytes())))
            .help("save the file as UTF-8; TOML allows no other encoding")
    })
}

/// What is to be computed of a model.
pub struct Scenario {
    /// Its name, by default that of the file.
    pub name: String,
    /// Its file, as it is copied into results.
    pub document: DocumentMut,
    /// The text of the model's file.
    pub model_text: String,
    /// The URDF of which the model was made, if it was.
    pub urdf: Option<PathBuf>,
    /// The model.
    pub mechanism: GenericMechanism,
    /// Its joints that move, and their coordinates.
    pub layout: Layout,
    /// Where it starts, or which branch of closed loops is meant.
    pub initial: Initial,
    /// The motion that is prescribed or followed.
    pub trajectory: Option<Prescribed>,
    /// What inverse dynamics is asked for, if that is the run.
    pub inverse: Option<Span>,
    /// What motion is asked for, if that is the run.
    pub forward: Option<Forward>,
    /// Which frames may touch the ground, in a motion.
    pub contacts: Contacts,
}

/// The failure of the scenario at `path` without the table `key`, which states `what`.
pub fn missing(path: &Path, what: &str, key: &Key) -> Failure {
    let message = format!("{} does not state {what}", path.display());
    Failure::input(message).help(format!("add a table, as in: {}", key.example()))
}

impl Scenario {
    /// Reads what a scenario has for a run, and its model, and prints their warnings unless `quiet`. What it has for
    /// the other run is not read: it may name files that this run writes.
    ///
    /// # Errors
    /// Every fault of the scenario at once; or those of the model, or the first of a table.
    pub fn load(path: &Path, dynamics: Dynamics, quiet: bool) -> Result<Scenario, Failure> {
        let text = read_text(path)?;
        let shown = path.display().to_string();
        let (scenario, warnings) = Scenario::of_text(text, path, &shown, dynamics, (None, quiet))?;
        if !quiet {
            model::show(&warnings);
        }
        Ok(scenario)
    }

    /// The same of the text of a scenario at `path`, whose messages name it `shown`; returns its warnings, and prints
    /// those of its model unless `quiet`. The files that it names are in its folder, unless they are `held`.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn of_text(
        text: String,
        path: &Path,
        shown: &str,
        dynamics: Dynamics,
        (held, quiet): (Option<Held<'_>>, bool),
    ) -> Result<(Scenario, Vec<Diagnostic>), Failure> {
        if let Some(failure) = Kind::Scenario.mistaken(path, &text) {
            return Err(failure);
        }
        let mut failure = None;
        let read = redysim_toml::read(text.clone(), shown, &keys::SCENARIO, "the scenario", |reader| {
            read(reader, path, text, dynamics, (held, quiet), &mut failure)
        });
        if let Some(failure) = failure {
            return Err(failure);
        }
        let (scenario, warnings) = read.map_err(Failure::input)?;
        scenario.check_tables()?;
        Ok((scenario, warnings))
    }

    /// Whether the model has closed loops.
    pub fn loops(&self) -> bool {
        !self.mechanism.model().loops.is_empty()
    }

    /// The velocities that have an actuator.
    pub fn actuated_velocities(&self) -> Vec<usize> {
        self.layout.actuated_velocities()
    }

    /// The mechanism with its contacts; of a motion with prescribed joints, that in which these have the actuators.
    pub fn ground(&self) -> Ground<'_> {
        let prescribed = self.forward.as_ref().and_then(|forward| forward.prescribed.as_ref());
        self.contacts.under(prescribed.map_or(&self.mechanism, |prescribed| &prescribed.mechanism))
    }

    /// The largest component of the loops' residual at `q`, m (or a sine).
    pub fn position_residual(&self, q: &Vec<f64>) -> f64 {
        let residual: Vec<f64> = self.mechanism.loop_residual(q);
        residual.iter().fold(0.0, |largest, value| largest.max(value.abs()))
    }

    /// Fails unless the tables that are used go as far as the runs that use them.
    fn check_tables(&self) -> Result<(), Failure> {
        let cover =
            |table: Option<&InputTable>, span: Span| table.map_or(Ok(()), |table| table.cover(span.start, span.end));
        if let (Some(span), Some(trajectory)) = (self.inverse, &self.trajectory) {
            cover(trajectory.table.as_ref(), span)?;
        }
        let Some(forward @ Forward { span, torque, .. }) = &self.forward else { return Ok(()) };
        cover(forward.followed().and_then(|trajectory| trajectory.table.as_ref()), *span)?;
        match torque.unlimited() {
            Torque::Table { forces, .. } => cover(Some(&forces.table), *span),
            _ => Ok(()),
        }
    }
}

fn read(
    mut reader: Reader<'_, '_>,
    path: &Path,
    text: String,
    dynamics: Dynamics,
    (held, quiet): (Option<Held<'_>>, bool),
    failure: &mut Option<Failure>,
) -> Option<Scenario> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let stem = path.file_stem().map_or("scenario".into(), |stem| stem.to_string_lossy().into_owned());
    let name = name(&mut reader).value_or(stem);
    let model = reader.required(&keys::MODEL, Reader::text);
    let named = model.spanned()?;
    let model_path = folder.join(named.get_ref());
    // What the rest of the scenario means depends on the joints.
    let read = match held {
        Some(held) => {
            let read = Model::from_toml(held.model, held.model_name);
            model::loaded(&model_path, read, quiet).map(ModelFile::from)
        }
        None if model::is_urdf(&model_path) => model::read(&model_path, quiet),
        None => match Model::load(&model_path) {
            Err(faults) if faults.unread => {
                let why = faults.errors().map(Diagnostic::title).collect::<String>();
                let title = format!("{}: {why}", model_path.display());
                let help = format!(
                    "{}the path of the model is taken from the folder of the scenario",
                    meant_from(folder, &model_path)
                );
                return reader.error_at(named.span(), Message { title, label: "named here".into(), help });
            }
            read => model::loaded(&model_path, read, quiet).map(ModelFile::from),
        },
    };
    let ModelFile { model, text: model_text, urdf, .. } = read.map_err(|fault| *failure = Some(fault)).ok()?;
    let mechanism = GenericMechanism::new(model);
    let layout = Layout::of(mechanism.model());
    let model = mechanism.model();
    let subject = Subject { dynamics, layout: &layout, model, mobility: OnceCell::new(), folder, held };
    let initial = Initial::read(&mut reader, &subject);
    let trajectory = Prescribed::read(&mut reader, &subject);
    let followed = trajectory.as_ref().map(Option::as_ref);
    let contacts = match dynamics {
        Dynamics::Inverse => Some(Contacts::left_out(&mut reader)),
        Dynamics::Forward => Contacts::read(&mut reader, mechanism.model()),
    };
    let (inverse, forward) = match dynamics {
        Dynamics::Inverse => (reader.table(&keys::INVERSE, |mut reader| Span::read(&mut reader)), Field::Missing),
        Dynamics::Forward => (Field::Missing, Forward::read(&mut reader, &subject, followed)),
    };
    let (inverse, forward) = (given(inverse)?, given(forward)?);
    let (name, mut initial, trajectory, contacts) = (name?, initial?, trajectory?, contacts?);
    if let Some(Forward { span, prescribed: Some(prescribed), .. }) = &forward {
        prescribed.start(&mut reader, &subject, span.start, &mut initial)?;
    }
    let followed = forward.as_ref().and_then(|forward| Some((forward.followed()?, forward.span)));
    if let Some(motion) = trajectory.as_ref().zip(inverse).or(followed) {
        limits::check_motion(&mut reader, &subject, &initial, motion)?;
    }
    if let Some(Forward { span, .. }) = forward {
        limits::check_start(&mut reader, &subject, &initial, span)?;
    }
    let document = document(&mut reader, &text)?;
    Some(Scenario {
        name,
        document,
        model_text,
        urdf,
        mechanism,
        layout,
        initial,
        trajectory,
        inverse,
        forward,
        contacts,
    })
}

/// "did you mean `../models/kr5.toml`? ", of a missing file that a scenario in `folder` names, if one of similar name is near.
pub fn meant_from(folder: &Path, missing: &Path) -> String {
    let absolute = |path: &Path| {
        let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
        std::fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf())
    };
    if missing.exists() {
        return String::new();
    }
    let similar = similar_file(missing, &[missing.parent().unwrap_or(folder), folder, Path::new("")]);
    let written = similar.map(|file| path_from(&absolute(folder), &absolute(&file)));
    did_you_mean(written.as_deref())
}

/// The file as a document that can be edited. It is parsed again for that: the parts that this run does not read must
/// be TOML as well.
fn document(reader: &mut Reader<'_, '_>, text: &str) -> Option<DocumentMut> {
    let fault = match text.parse() {
        Ok(document) => return Some(document),
        Err::<_, toml_edit::TomlError>(fault) => fault,
    };
    let title = format!("{}: not TOML: {}", reader.item(), fault.message());
    let help = "TOML has integers from -2^63 to 2^63 - 1 and floats up to 1.8e308".to_owned();
    reader.error_at(fault.span().unwrap_or(0..0), Message { title, label: "here".into(), help })
}

/// The scenario's name, which a folder gets.
pub fn name(reader: &mut Reader<'_, '_>) -> Field<String> {
    reader.field(&keys::NAME, |reader, path, value| {
        let DeValue::String(name) = value.get_ref() else {
            return reader.wrong_type(path, value, "a string");
        };
        let is_plain = Path::new(name.as_ref()).file_name().is_some_and(|plain| plain == name.as_ref());
        if is_plain {
            return Some(name.to_string());
        }
        let title = format!("{}: `{path}` is `{name}`, which cannot be the name of a folder", reader.item());
        let help = "the results go to a folder of this name: give one without / and not empty".to_owned();
        reader.error(value, Message { title, label: "not the name of a folder".into(), help })
    })
}
