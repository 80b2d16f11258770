//! What a scenario is about: a model and its joints, and what is to be computed of it.

use std::cell::OnceCell;
use std::fmt;
use std::path::Path;

use redysim_model::{Mobility, Model};
use redysim_toml::{Field, Key, Message, Reader};
use serde::{Deserialize, Serialize};

use super::held::Held;
use super::table::InputTable;
use crate::failure::Failure;
use crate::layout::{Component, Layout};

/// What may be computed of a model.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Dynamics {
    /// The forces that a prescribed motion takes.
    Inverse,
    /// The motion that forces make.
    Forward,
}

impl fmt::Display for Dynamics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Dynamics::Inverse => "inverse",
            Dynamics::Forward => "forward",
        })
    }
}

/// What a scenario is about.
pub struct Subject<'s> {
    /// What is to be computed.
    pub dynamics: Dynamics,
    /// Its joints that move, and their coordinates.
    pub layout: &'s Layout,
    /// The model.
    pub model: &'s Model,
    /// What its loops leave free, computed on first use, because it takes closing them.
    pub mobility: OnceCell<Mobility>,
    /// The folder of the files that it names.
    pub folder: &'s Path,
    /// Their texts, where they are not in that folder.
    pub held: Option<Held<'s>>,
}

impl Subject<'_> {
    /// Whether there are closed loops.
    pub fn loops(&self) -> bool {
        !self.model.loops.is_empty()
    }

    /// What the loops leave free.
    pub fn mobility(&self) -> &Mobility {
        self.mobility.get_or_init(|| Mobility::of(self.model))
    }

    /// Warns about a setting that applies only to closed loops, if the model has no loops.
    pub fn expect_loops<T>(&self, reader: &mut Reader<'_, '_>, key: &str, setting: &Field<T>) {
        if let (false, Some(given)) = (self.loops(), setting.spanned()) {
            let title = format!("{}: `{key}` applies only to closed loops, and the model has no loops", reader.item());
            let message = Message { title, label: "without effect".into(), help: "leave it out".into() };
            reader.warning_at(given.span(), message);
        }
    }

    /// The velocities that have an actuator.
    pub fn actuated(&self) -> Vec<usize> {
        self.layout.actuated_velocities()
    }

    /// Reads the table in the file that `key` names with `read`; errors are reported at the key.
    pub fn table<T>(
        &self,
        reader: &mut Reader<'_, '_>,
        key: &Key,
        read: impl FnOnce(InputTable) -> Result<T, Failure>,
    ) -> Option<T> {
        let file = reader.required(key, Reader::text);
        let named = file.spanned()?;
        let table = match self.held {
            Some(held) => held.table(named.get_ref()),
            None => InputTable::read(&self.folder.join(named.get_ref())),
        };
        match table.and_then(read) {
            Ok(read) => Some(read),
            Err(fault) => {
                let help = Some(fault.advice()).filter(|help| !help.is_empty());
                let (title, help) =
                    (fault.message().to_owned(), help.unwrap_or("correct the table, or name another").into());
                reader.error_at(named.span(), Message { title, label: "named here".into(), help })
            }
        }
    }
}

/// The value of a field that may be missing; `None` if it is invalid.
pub fn given<T>(field: Field<Option<T>>) -> Option<Option<T>> {
    match field {
        Field::Missing => Some(None),
        Field::Invalid => None,
        Field::Value(value) => value.into_inner().map(Some),
    }
}

/// The neutral position of coordinates; of velocities, zero.
pub fn neutral(components: &[Component]) -> Vec<f64> {
    components.iter().map(|component| component.neutral).collect()
}

/// One entry for each of `components`: `values` for those `at`, the neutral position or zero for the others.
pub fn spread(at: &[usize], values: &[f64], components: &[Component]) -> Vec<f64> {
    let mut all = neutral(components);
    for (&index, &value) in at.iter().zip(values) {
        all[index] = value;
    }
    all
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use crate::layout::tests::free_base_with_arm;

    const LINKS: &str = "name = 'robot'\ngravity = [0, 0, -9.81]\n\
        [[link]]\nname = 'body'\njoint_name = 'base'\nparent = 'base'\njoint = 'free'\norigin = {}\n\
        mass = 1\ncom = [0, 0, 0]\ninertia = { xx = 1, yy = 1, zz = 1 }\nactuated = false\n\
        [[link]]\nname = 'arm'\nparent = 'body'\norigin = {}\njoint = 'revolute'\naxis = [0, 0, 1]\nmass = 1\n\
        com = [1, 0, 0]\ninertia = { xx = 1, yy = 1, zz = 1 }\n";

    /// What `read` makes of a forward run of a free joint `base` and a revolute joint `arm`, whose loops have a
    /// mobility of six. Loops, layout and mobility are made by hand.
    pub fn with_free_base<T>(read: impl FnOnce(&Subject<'_>) -> T) -> T {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/fourbar.toml");
        let links = Model::from_toml(LINKS, "robot.toml").unwrap().model.links;
        let model = Model { links, ..Model::load(path).unwrap().model };
        let mobility = OnceCell::from(Mobility { mobility: 6, ..Mobility::default() });
        let (layout, folder) = (free_base_with_arm(), Path::new(""));
        read(&Subject { dynamics: Dynamics::Forward, layout: &layout, model: &model, mobility, folder, held: None })
    }
}
