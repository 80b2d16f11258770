//! `redysim check MODEL`: faults, warnings and notes where they stand, then what the model is.

use std::io::Read;
use std::path::PathBuf;

use crate::failure::Failure;
use crate::model::{self, not_a_model, show};
use crate::number::counted;
use crate::output::{print, to_stderr, visible};
use crate::summary::Summary;
use redysim_model::{Diagnostic, Faults, Loaded, Model, Severity};
use serde::Serialize;

/// Show the faults, warnings and notes of a model, the first 20 of each, then what it is.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  redysim check models/kr5.toml
  redysim check panda.urdf
  redysim import satellite.urdf --base free | redysim check -
  redysim check models/fourbar.toml --json | jq .summary.mobility

With --quiet only faults are shown; the exit code is 0 for a model without faults.

--json prints one object, with all of them and in SI units, whose keys stay as
they are:
  file, valid        the model file, and whether it has no errors
  errors, warnings, notes
                     [{ lint, title, help, file, line, column }]; lint is the name
                     for `allow` or null, line and column count from 1 and are null
                     where the file could not be read
  summary            null for a faulty model; else an object:
    name, gravity, mass, dof, mobility, loop_constraints, loop_rank,
    actuated, passive (names of joints), lints (texts),
    links       [{ name, parent, joint, kind, actuated, mass }]
    loops       [{ name, kind, link_a, link_b, constraints, rank }]; the rank
                counts what does not follow from the loops before
    operations  [{ function, flops, additions, multiplications, divisions,
                   sine_cosine_pairs }]")]
pub struct Arguments {
    /// The model file, a URDF on the ground, or - for the standard input.
    model: PathBuf,
    /// Print everything as JSON.
    #[arg(long)]
    json: bool,
}

/// The model file that stands for the standard input, and what messages call it.
const STANDARD_INPUT: (&str, &str) = ("-", "<stdin>");

impl Arguments {
    fn is_standard_input(&self) -> bool {
        self.model.as_os_str() == STANDARD_INPUT.0
    }

    /// What messages call the model file.
    fn name(&self) -> String {
        if self.is_standard_input() { STANDARD_INPUT.1.into() } else { self.model.display().to_string() }
    }

    /// The model, or its faults.
    ///
    /// # Errors
    /// If the standard input cannot be read; the first fault of a URDF.
    fn load(&self, quiet: bool) -> Result<Result<Loaded, Faults>, Failure> {
        if !self.is_standard_input() {
            return model::with_options(&self.model, "", quiet);
        }
        let mut bytes = Vec::new();
        let read = std::io::stdin().lock().read_to_end(&mut bytes);
        read.map_err(|error| Failure::outside(format!("cannot read the standard input: {error}")))?;
        Ok(Model::from_bytes(bytes, self.name()))
    }

    /// The failure of a file that is a scenario.
    fn not_a_model(&self) -> Option<Failure> {
        if self.is_standard_input() { None } else { not_a_model(&self.model) }
    }
}

/// What `--json` prints.
#[derive(Serialize)]
struct Report<'a> {
    file: String,
    valid: bool,
    errors: Vec<Finding<'a>>,
    warnings: Vec<Finding<'a>>,
    notes: Vec<Finding<'a>>,
    summary: Option<&'a Summary>,
}

/// A diagnostic for programs.
#[derive(Serialize)]
struct Finding<'a> {
    lint: Option<&'static str>,
    title: &'a str,
    help: &'a str,
    file: &'a str,
    line: Option<usize>,
    column: Option<usize>,
}

impl<'a> Finding<'a> {
    fn of(diagnostic: &'a Diagnostic) -> Self {
        let (line, column) = diagnostic.position().unzip();
        Finding {
            lint: diagnostic.lint(),
            title: diagnostic.title(),
            help: diagnostic.help(),
            file: diagnostic.file(),
            line,
            column,
        }
    }
}

/// Checks the model.
pub fn run(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    let read = match arguments.load(quiet) {
        Err(failure) if arguments.json => {
            print_failure(arguments, &failure)?;
            return Err(failure);
        }
        read => read?,
    };
    match read {
        Ok(loaded) => show_model(arguments, &loaded, quiet),
        Err(faults) => Err(show_faults(arguments, &faults, quiet)?),
    }
}

/// Shows what is odd about a model, and what it is.
fn show_model(arguments: &Arguments, loaded: &Loaded, quiet: bool) -> Result<(), Failure> {
    let diagnostics = [&loaded.warnings[..], &loaded.notes].concat();
    if arguments.json {
        let mut summary = Summary::of(loaded);
        let counted = summary.count(loaded).map_err(Failure::input);
        print_json(arguments, &diagnostics, counted.is_ok().then_some(&summary))?;
        return counted;
    }
    if quiet {
        return Ok(());
    }
    show(&diagnostics);
    let mut summary = Summary::of(loaded);
    // What is known is printed before what takes its time.
    print(&visible(&summary.to_string()))?;
    summary.count(loaded).map_err(Failure::input)?;
    summary.generator_warnings.iter().for_each(|warning| to_stderr(&format!("warning: {warning}\n")));
    print(&summary.operations_table())
}

/// Shows why a file is not a model; returns the failure of the command.
fn show_faults(arguments: &Arguments, faults: &Faults, quiet: bool) -> Result<Failure, Failure> {
    let failure = match arguments.not_a_model() {
        // Of its keys none is a model's: that goes without saying.
        Some(failure) if !arguments.json => return Ok(failure),
        // What cannot be read has one error, which says so.
        None if faults.unread && !arguments.json => return Ok(Failure::outside(faults)),
        other => other.unwrap_or_else(|| failure(arguments, faults)),
    };
    match arguments.json {
        true => print_json(arguments, &faults.diagnostics, None)?,
        false => show(&faults.diagnostics.clone().filtered(|found| !quiet || found.severity() == Severity::Error)),
    }
    Ok(failure)
}

fn failure(arguments: &Arguments, faults: &Faults) -> Failure {
    let file = arguments.name();
    match faults.unread {
        true => Failure::outside(format!("{file} could not be read")),
        false => Failure::input(format!("{file} has {}", counted(faults.errors().count(), "error"))),
    }
}

/// The faults of a URDF, or the one reason why it could not be read.
fn urdf_findings<'f>(file: &'f str, failure: &'f Failure) -> Vec<Finding<'f>> {
    let unplaced =
        Finding { lint: None, title: failure.message(), help: failure.advice(), file, line: None, column: None };
    let placed = failure.faults().map(|(fault, help)| Finding {
        title: &fault.title,
        help,
        line: Some(fault.line as usize),
        column: fault.column.map(|column| column as usize),
        ..unplaced
    });
    let placed: Vec<_> = placed.collect();
    if placed.is_empty() { vec![unplaced] } else { placed }
}

/// Prints why a URDF is not a model.
fn print_failure(arguments: &Arguments, failure: &Failure) -> Result<(), Failure> {
    let file = arguments.name();
    let errors = urdf_findings(&file, failure);
    print_report(&Report { file: file.clone(), valid: false, errors, warnings: vec![], notes: vec![], summary: None })
}

fn print_json(arguments: &Arguments, diagnostics: &[Diagnostic], summary: Option<&Summary>) -> Result<(), Failure> {
    let of = |severity| diagnostics.iter().filter(move |found| found.severity() == severity).map(Finding::of).collect();
    print_report(&Report {
        file: arguments.name(),
        valid: summary.is_some(),
        errors: of(Severity::Error),
        warnings: of(Severity::Warning),
        notes: of(Severity::Note),
        summary,
    })
}

fn print_report(report: &Report<'_>) -> Result<(), Failure> {
    let text = serde_json::to_string_pretty(report).map_err(Failure::outside)?;
    print(&(text + "\n"))
}
