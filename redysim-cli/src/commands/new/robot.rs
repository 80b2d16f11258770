//! The robot of a new crate.

use std::path::Path;

use super::name::plain;
use crate::commands::generate::type_name;
use crate::failure::Failure;
use crate::model;
use redysim_model::{CodegenOptions, Model};
use redysim_toml::words::{did_you_mean, nearest, quoted};

/// The models that the command has itself.
const SHIPPED: [(&str, &str); 3] = [
    ("kr5", include_str!("models/kr5.toml")),
    ("gripper", include_str!("models/gripper.toml")),
    ("fourbar", include_str!("models/fourbar.toml")),
];

/// Names of types that a program uses.
const USED: [&str; 6] = ["ClosedLoop", "ClosedLoopInverse", "Forces", "LoopError", "LoopForces", "Motion"];

/// A robot whose model is checked.
pub struct Robot {
    /// The name of its file, without extension.
    stem: String,
    /// The text of its model file.
    pub text: String,
    /// The model.
    pub model: Model,
    /// What the model file asks for.
    pub options: CodegenOptions,
}

impl Robot {
    /// The shipped robot of that name, or that of a model file or a URDF. Prints warnings unless `quiet`.
    ///
    /// # Errors
    /// If the robot is unknown, or its file has faults.
    pub fn named(robot: &Path, quiet: bool) -> Result<Robot, Failure> {
        if let Some((name, text)) = SHIPPED.into_iter().find(|(name, _)| robot == Path::new(name)) {
            let loaded = model::loaded(robot, Model::from_toml(text, format!("{name}.toml")), quiet)?;
            return Ok(Robot { stem: name.into(), text: loaded.text, model: loaded.model, options: loaded.options });
        }
        if !robot.exists() && robot.extension().is_none() && robot.components().count() == 1 {
            let (name, names) = (robot.to_string_lossy(), SHIPPED.map(|(name, _)| name));
            let help = format!(
                "{}The robots are: {}; another one is given by the path of its model file or URDF",
                did_you_mean(nearest(&name, names)),
                names.join(", ")
            );
            return Err(Failure::command_line(format!("unknown robot {}", quoted(&name))).help(help));
        }
        let stem = match plain(&robot.file_stem().unwrap_or_default().to_string_lossy()) {
            stem if stem.is_empty() => "robot".to_string(),
            stem => stem,
        };
        if model::is_urdf(robot) {
            let read = model::read(robot, quiet)?;
            return Ok(Robot { stem, text: read.text, model: read.model, options: CodegenOptions::default() });
        }
        let loaded = model::load(robot, "", quiet)?;
        if loaded.options.tolerance.is_some() {
            let message = format!(
                "{} has a `tolerance`, with which forward dynamics gives back other accelerations",
                robot.display()
            );
            let help = "take it out of the model file; `redysim!` takes it as well, later";
            return Err(Failure::input(message).help(help));
        }
        Ok(Robot { stem, text: loaded.text, model: loaded.model, options: loaded.options })
    }

    /// The path of its model file in the crate.
    pub fn path(&self) -> String {
        format!("models/{}.toml", self.stem)
    }

    /// Its name as prose has it.
    pub fn title(&self) -> String {
        quoted(&self.model.name)
    }

    /// The name of its type.
    pub fn type_name(&self) -> String {
        let name = type_name(&self.model.name);
        if name.is_ascii() && name.len() > 1 && !USED.contains(&name.as_str()) { name } else { "Robot".into() }
    }
}

#[cfg(test)]
mod tests {
    use super::SHIPPED;

    #[test]
    fn the_shipped_robots_are_those_of_the_repository() {
        for (name, text) in SHIPPED {
            let path = format!("{}/../models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
            assert_eq!(std::fs::read_to_string(path).unwrap(), text, "{name}");
        }
    }
}
