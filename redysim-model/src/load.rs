//! From a file to a checked model.

use crate::check;
use crate::faults::Faults;
use crate::messages;
use crate::model::Model;
use crate::options::CodegenOptions;
use crate::schema::Document;
use redysim_toml::{Diagnostic, Diagnostics, Findings, Message, Severity, Source, Text, parse};
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
    pub options: CodegenOptions,
    /// Warnings, in the file's order, without those that the file allows.
    pub warnings: Vec<Diagnostic>,
    /// What people may well mean, in the file's order, without what the file allows.
    pub notes: Vec<Diagnostic>,
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

    /// Reads and checks a model file with options beside it, as [`from_toml_with`](Model::from_toml_with) does.
    ///
    /// # Errors
    ///
    /// As [`load`](Model::load), and every fault in the options.
    pub fn load_with(
        path: impl AsRef<Path>,
        file_name: impl Into<String>,
        options: impl Into<String>,
    ) -> Result<Loaded, Faults> {
        let (path, name, options) = (path.as_ref(), file_name.into(), options.into());
        let bytes = match std::fs::read(path) {
            Ok(bytes) => bytes,
            Err(_) if path.is_dir() => return Err(nothing_of(name, messages::is_directory(), &options, true)),
            Err(error) => return Err(nothing_of(name, messages::unreadable(path, &error), &options, true)),
        };
        of_bytes(bytes, name, options)
    }

    /// Checks the bytes of a model file as [`from_toml`](Model::from_toml) does its text.
    ///
    /// # Errors
    ///
    /// As [`from_toml`](Model::from_toml), and if they are not UTF-8.
    pub fn from_bytes(bytes: Vec<u8>, file_name: impl Into<String>) -> Result<Loaded, Faults> {
        of_bytes(bytes, file_name.into(), String::new())
    }

    /// Checks the text of a model file. Messages call the file `file_name`.
    ///
    /// What the file may leave out: `joint_name` is the link's name; `com`, `point_a`, `point_b` and the entries of
    /// `dh`, `dh_standard`, `origin` and `inertia` are zero; `actuated` is true; without `dh`, `dh_standard` and `origin`,
    /// a joint with an `axis` stands in the parent's frame; `axis_a` and `axis_b` of a revolute cut are z.
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

    /// Checks the text of a model file with options beside it: TOML with the keys `functions`, `locked` and
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
    /// assert!(!loaded.options.functions.contains(Function::MassMatrix));
    /// ```
    pub fn from_toml_with(
        text: impl Into<String>,
        file_name: impl Into<String>,
        options: impl Into<String>,
    ) -> Result<Loaded, Faults> {
        let source = Arc::new(Source::new(file_name, text));
        let options_source = options_source(options.into());
        let new_findings = || Findings::with_beside(Arc::clone(&source), Arc::clone(&options_source));
        let mut findings = new_findings();
        let (file, options) = (parse(&source), parse(&options_source));
        if !file.is_valid() || !options.is_valid() {
            // A text with syntax errors is read for the interface only: other errors in it may follow from these.
            let interface = Document::read(&file, &options, &mut new_findings()).public_interface();
            file.report(&mut findings);
            findings.within(Text::Beside, |findings| options.report(findings));
            return Err(Faults { diagnostics: findings.into_sorted(), interface: Box::new(interface), unread: false });
        }
        let document = Document::read(&file, &options, &mut findings);
        let checked = check::check(&document, &mut findings);
        let allowed: Vec<_> = document.allowed.iter().map(|lint| lint.name()).collect();
        let found = findings.into_sorted().without(&allowed);
        match checked {
            Some((model, options)) => {
                let (notes, warnings) = found.into_iter().partition(|found| found.severity() == Severity::Note);
                Ok(Loaded { model, text: source.text.clone(), options, warnings, notes })
            }
            None => Err(Faults { diagnostics: found, interface: Box::new(document.public_interface()), unread: false }),
        }
    }
}

fn of_bytes(bytes: Vec<u8>, name: String, options: String) -> Result<Loaded, Faults> {
    match String::from_utf8(bytes) {
        Ok(text) => Model::from_toml_with(text, name, options),
        Err(error) => Err(nothing_of(name, messages::not_utf8(error.as_bytes()), &options, false)),
    }
}

fn options_source(text: String) -> Arc<Source> {
    Arc::new(Source::new("options", text))
}

/// Without a file there are no links, but the options still list the functions that the code around the model calls.
fn nothing_of(name: String, message: Message, options: &str, unread: bool) -> Faults {
    let (nothing, options_source) = (Source::new("", ""), options_source(options.to_string()));
    let mut echoes = Findings::with_beside(options_source.clone(), options_source.clone());
    let interface = Document::read(&parse(&nothing), &parse(&options_source), &mut echoes).public_interface();
    let diagnostics = Diagnostics(vec![Diagnostic::unreadable(name, message)]);
    Faults { diagnostics, interface: Box::new(interface), unread }
}
