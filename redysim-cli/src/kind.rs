//! What a file in TOML is, by its keys.

use std::path::Path;

use toml::Table;

use crate::failure::Failure;

/// A kind of file.
#[derive(Clone, Copy)]
pub enum Kind {
    Model,
    Scenario,
    Study,
}

impl Kind {
    const ALL: [Kind; 3] = [Kind::Model, Kind::Scenario, Kind::Study];

    fn name(self) -> &'static str {
        match self {
            Kind::Model => "model",
            Kind::Scenario => "scenario",
            Kind::Study => "study",
        }
    }

    /// The key by which a file is of this kind.
    fn key(self) -> &'static str {
        match self {
            Kind::Model => "link",
            Kind::Scenario => "model",
            Kind::Study => "scenario",
        }
    }

    /// The failure of a file at `path` that is of another kind, where this one is expected.
    pub fn mistaken(self, path: &Path, text: &str) -> Option<Failure> {
        let table: Table = text.parse().ok()?;
        if table.contains_key(self.key()) {
            return None;
        }
        let found = Self::ALL.into_iter().find(|kind| table.contains_key(kind.key()))?;
        let shown = path.display();
        let named = || Some(path.with_file_name("").join(table.get(found.key())?.as_str()?));
        let help = match (self, found) {
            (Kind::Model, Kind::Study) => format!("name the model of its scenario, {}", named()?.display()),
            (Kind::Model, _) => format!("name its model: {}", named()?.display()),
            (Kind::Scenario, Kind::Study) => format!("compute it by redysim sweep {shown}"),
            (Kind::Scenario, _) => format!("a scenario names it, as in: model = \"{shown}\""),
            (Kind::Study, Kind::Model) => "a study names a scenario, which names its model, and what varies".into(),
            (Kind::Study, _) => format!("a study names it, and what varies: scenario = \"{shown}\" and a table [over]"),
        };
        Some(Failure::input(format!("{shown} is a {}, not a {}", found.name(), self.name())).help(help))
    }
}
