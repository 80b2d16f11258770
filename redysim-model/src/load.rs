//! From a file to a checked model.

use crate::check;
use crate::faults::Faults;
use crate::messages;
use crate::model::Model;
use crate::scene::Scene;
use crate::schema::Document;
use redysim_toml::{Diagnostic, Diagnostics, Findings, Message, Source, Text, parse};
use std::path::Path;
use std::sync::Arc;

/// A model, and what seems odd about its file.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The model.
    pub model: Model,
    /// The text of its file, as it was read.
    pub text: String,
    /// What is asked of it, by the file or beside it.
    pub scene: Scene,
    /// Warnings, in the file's order.
    pub warnings: Vec<Diagnostic>,
}

impl Model {
    /// Reads and checks a model file.
    ///
    /// # Errors
    ///
    /// Every fault in the file, each shown where it stands; or why the file could not be read.
    pub fn load(path: impl AsRef<Path>) -> Result<Loaded, Faults> {
        let name = path.as_ref().display().to_string();
        Model::load_as(path, name)
    }

    /// Reads and checks a model file as [`load`](Model::load) does; messages call it `file_name`.
    ///
    /// # Errors
    ///
    /// As [`load`](Model::load).
    pub fn load_as(path: impl AsRef<Path>, file_name: impl Into<String>) -> Result<Loaded, Faults> {
        Model::load_with(path, file_name, "")
    }

    /// Reads and checks a model file with a scene beside it, as [`from_toml_with`](Model::from_toml_with) does.
    ///
    /// # Errors
    ///
    /// As [`load`](Model::load), and every fault in the scene.
    pub fn load_with(
        path: impl AsRef<Path>,
        file_name: impl Into<String>,
        scene: impl Into<String>,
    ) -> Result<Loaded, Faults> {
        let (path, name, scene) = (path.as_ref(), file_name.into(), scene.into());
        let bytes = match std::fs::read(path) {
            Ok(bytes) => bytes,
            Err(_) if path.is_dir() => return Err(nothing_of(name, messages::is_directory(), &scene, true)),
            Err(error) => return Err(nothing_of(name, messages::unreadable(&error), &scene, true)),
        };
        match String::from_utf8(bytes) {
            Ok(text) => Model::from_toml_with(text, name, scene),
            Err(error) => {
                Err(nothing_of(name, messages::not_utf8(error.utf8_error().valid_up_to() + 1), &scene, false))
            }
        }
    }

    /// Checks the text of a model file. Messages call the file `file_name`.
    ///
    /// What the file may leave out: `joint_name` is the link's name; `com`, `point_a`, `point_b` and the entries of
    /// `dh`, `origin` and `inertia` are zero; `actuated` is true; of `origin` and `axis` (used where there is no `dh`)
    /// one may be missing, and is then the parent's frame or z; `axis_a` and `axis_b` of a revolute cut are z.
    ///
    /// # Errors
    ///
    /// Every fault in the text, each shown where it stands.
    ///
    /// # Example
    ///
    /// ```
    /// use redysim_model::Model;
    ///
    /// let pendulum = r#"
    ///     name = "pendulum"
    ///     gravity = [0.0, 0.0, -9.81]
    ///
    ///     [[link]]
    ///     name = "rod"
    ///     parent = "base"
    ///     joint = "revolute"
    ///     axis = [0, 1, 0]
    ///     mass = 1.0
    ///     com = [0.5, 0.0, 0.0]
    /// "#;
    /// let loaded = Model::from_toml(pendulum, "pendulum.toml").unwrap();
    /// assert_eq!(loaded.model.dof(), 1);
    ///
    /// let faults = Model::from_toml(pendulum.replace("mass", "mas"), "pendulum.toml").unwrap_err();
    /// println!("{faults}"); // shows line 10 with a caret below `mas`, and asks: did you mean `mass`?
    /// assert_eq!(faults.errors().next().unwrap().position(), Some((10, 5)));
    /// ```
    pub fn from_toml(text: impl Into<String>, file_name: impl Into<String>) -> Result<Loaded, Faults> {
        Model::from_toml_with(text, file_name, "")
    }

    /// Checks the text of a model file with a scene beside it: TOML with the keys `functions`, `locked` and
    /// `tolerance`, each of which wins over that of the file.
    ///
    /// # Errors
    ///
    /// Every fault in both texts, each shown where it stands.
    ///
    /// # Example
    ///
    /// ```
    /// use redysim_model::{Function, Model};
    ///
    /// # let pendulum = "name = 'pendulum'\ngravity = [0, 0, -9.81]\n\n[[link]]\nname = 'rod'\nparent = 'base'\n\
    /// #     joint = 'revolute'\naxis = [0, 1, 0]\nmass = 1.0\ncom = [0.5, 0, 0]";
    /// let loaded = Model::from_toml_with(pendulum, "pendulum.toml", "functions = ['inverse_dynamics']").unwrap();
    /// assert!(!loaded.scene.functions.contains(Function::MassMatrix));
    /// ```
    pub fn from_toml_with(
        text: impl Into<String>,
        file_name: impl Into<String>,
        scene: impl Into<String>,
    ) -> Result<Loaded, Faults> {
        let source = Arc::new(Source::new(file_name, text));
        let scene_source = scene_source(scene.into());
        let new_findings = || Findings::with_beside(Arc::clone(&source), Arc::clone(&scene_source));
        let mut findings = new_findings();
        let (file, scene) = (parse(&source), parse(&scene_source));
        if !file.is_valid() || !scene.is_valid() {
            // What stands in a broken text is read for the outline only: its errors would be echoes of the syntax
            // errors.
            let outline = Document::read(&file, &scene, &mut new_findings()).outline();
            file.report(&mut findings);
            findings.within(Text::Beside, |findings| scene.report(findings));
            return Err(Faults { diagnostics: findings.into_sorted(), outline: Box::new(outline), unread: false });
        }
        let document = Document::read(&file, &scene, &mut findings);
        match check::check(&document, &mut findings) {
            Some((model, scene)) => {
                Ok(Loaded { model, text: source.text.clone(), scene, warnings: findings.into_sorted().0 })
            }
            None => Err(Faults {
                diagnostics: findings.into_sorted(),
                outline: Box::new(document.outline()),
                unread: false,
            }),
        }
    }
}

fn scene_source(text: String) -> Arc<Source> {
    Arc::new(Source::new("scene", text))
}

/// Without a file there are no links, but the scene still says which functions code around the model will call.
fn nothing_of(name: String, message: Message, scene: &str, unread: bool) -> Faults {
    let (nothing, scene_source) = (Source::new("", ""), scene_source(scene.to_string()));
    let mut echoes = Findings::with_beside(scene_source.clone(), scene_source.clone());
    let outline = Document::read(&parse(&nothing), &parse(&scene_source), &mut echoes).outline();
    let diagnostics = Diagnostics(vec![Diagnostic::unreadable(name, message)]);
    Faults { diagnostics, outline: Box::new(outline), unread }
}
