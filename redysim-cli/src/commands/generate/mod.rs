//! `redysim generate MODEL`: what `redysim!` makes, as source in Rust, C or C++ or for other simulation tools, for those
//! who must review or ship it.

mod fmu;

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use clap::builder::PossibleValuesParser;

use crate::failure::Failure;
use crate::model;
use crate::output::{check_beside, print, to_stderr, write_beside, write_together};
use redysim_codegen::{
    CFiles, COptions, CScalar, CppFiles, MexFiles, SourceError, c_files, cpp_files, mex_files, source_file_with,
};
use redysim_model::{Function, Loaded};

/// Write the source that `redysim!` would make of a model, in Rust, C99 or C++, or for other simulation tools.
///
/// The Rust source is printed, or written to a file with --output; it needs the crate redysim-runtime and nothing else.
/// With --language c a header, a source and a program that checks them are written to the folder --output, such as
/// kr5.h, kr5.c and kr5_check.c; they need math.h and nothing else. --language cpp adds a header for C++11, kr5.hpp,
/// and a package of CMake, CMakeLists.txt. --mex writes the C with a gateway for MATLAB and Octave, kr5_mex.c, whose
/// head has the commands that compile it, its help, kr5.m, and a function that checks it, kr5_check.m. --fmu writes a
/// functional mock-up unit for model exchange and co-simulation, kr5.fmu, with its sources and, for this platform,
/// compiled by `cc` or what the environment variable CC names. The head of each file states how many operations each
/// function takes. The same model gives the same bytes.
#[derive(clap::Args)]
#[command(after_help = "\
Examples:
  redysim generate models/kr5.toml -o src/kr5.rs
  redysim generate models/kr5.toml --name Robot --functions inverse_dynamics,mass_matrix
  redysim generate --language c models/kr5.toml -o controller
  redysim generate --language c --scalar f32 models/gripper.toml -o firmware
  redysim generate --language cpp models/kr5.toml -o kr5
  redysim generate --language cpp panda.urdf -o panda
  redysim generate --mex models/kr5.toml -o matlab
  redysim generate --fmu models/kr5.toml -o fmus
  redysim generate --fmu --fmi 2.0 models/kr5.toml -o fmus_2

In your Cargo.toml: redysim-runtime = { path = \"..\", default-features = false }")]
pub struct Arguments {
    /// The model file, or a URDF on the ground.
    model: PathBuf,
    /// Write to this file instead of printing; with --language c or cpp or with --mex or --fmu, to this folder, which
    /// is made if it is not there.
    #[arg(long, short)]
    output: Option<PathBuf>,
    /// The language of the source.
    #[arg(long, value_enum, default_value_t)]
    language: Language,
    /// For MATLAB and Octave: tau = kr5('inverse_dynamics', q, v, a).
    #[arg(long, conflicts_with = "language")]
    mex: bool,
    /// A functional mock-up unit: states q and v, inputs tau, outputs q, v, a and energies.
    #[arg(long, conflicts_with_all = ["language", "mex", "functions"])]
    fmu: bool,
    /// The version of the Functional Mock-up Interface.
    #[arg(long, value_enum, default_value_t, requires = "fmu", conflicts_with_all = ["language", "mex"])]
    fmi: Fmi,
    /// An FMU without compiled code, for tools that compile its sources.
    #[arg(long, requires = "fmu", conflicts_with_all = ["language", "mex"])]
    source_only: bool,
    /// The floating-point type of C and C++; functions in Rust take any, those of --mex and --fmu double.
    #[arg(long, value_enum, conflicts_with_all = ["mex", "fmu"])]
    scalar: Option<FloatingPoint>,
    /// The name of the Rust type, or what all names in C begin with [default: the model's name, as each language writes
    /// names].
    #[arg(long)]
    name: Option<String>,
    /// Only these functions, beside those that every mechanism has [default: those that the model file asks for, or
    /// all].
    #[arg(long, value_delimiter = ',', value_parser = PossibleValuesParser::new(names_of_functions()))]
    functions: Vec<String>,
    /// Overwrite files that are there already.
    #[arg(long)]
    force: bool,
}

#[derive(Clone, Copy, Debug, Default, clap::ValueEnum)]
enum Language {
    /// Rust, over any scalar.
    #[default]
    Rust,
    /// C99.
    C,
    /// C99 with a header for C++ and a package of CMake.
    Cpp,
}

impl Language {
    /// As an option.
    fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |value| value.get_name().to_string())
    }
}

#[derive(Clone, Copy, Debug, clap::ValueEnum)]
enum FloatingPoint {
    /// double.
    F64,
    /// float.
    F32,
}

#[derive(Clone, Copy, Debug, Default, clap::ValueEnum)]
enum Fmi {
    /// FMI 2.0.
    #[value(name = "2.0")]
    V2,
    /// FMI 3.0.
    #[default]
    #[value(name = "3.0")]
    V3,
}

fn names_of_functions() -> impl Iterator<Item = &'static str> {
    Function::ALL.iter().map(|function| function.name())
}

/// Generates the source.
pub fn run(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    match arguments.language {
        _ if arguments.mex => mex(arguments, quiet),
        _ if arguments.fmu => fmu::run(arguments, quiet),
        Language::Rust => rust(arguments, quiet),
        Language::C | Language::Cpp => c(arguments, quiet),
    }
}

fn rust(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    if arguments.scalar.is_some() {
        let failure = Failure::command_line("--scalar is for --language c and cpp: functions in Rust take any scalar");
        return Err(failure.help("leave it out, or add --language c"));
    }
    let loaded = load(arguments, quiet)?;
    let name = arguments.name.clone().unwrap_or_else(|| type_name(&loaded.model.name));
    let source = source_file_with(&loaded.model, &name, &loaded.options).map_err(failure)?;
    let Some(path) = &arguments.output else { return print(&source) };
    write_beside(&arguments.model, path, source.as_bytes(), arguments.force)?;
    if !quiet {
        report(&source);
        to_stderr(&format!("\n{name} is in {}", path.display()));
    }
    Ok(())
}

fn c(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    let folder = folder(arguments, &format!("--language {}", arguments.language.name()))?;
    let Loaded { model, options, .. } = load(arguments, quiet)?;
    let scalar = match arguments.scalar {
        Some(FloatingPoint::F32) => CScalar::F32,
        Some(FloatingPoint::F64) | None => CScalar::F64,
    };
    let form = COptions { prefix: arguments.name.clone(), scalar };
    let (c, for_cpp) = match arguments.language {
        Language::Cpp => {
            let CppFiles { c, header, cmake } = cpp_files(&model, &form, &options).map_err(failure)?;
            (c, vec![("{}.hpp", header), ("CMakeLists.txt", cmake)])
        }
        Language::Rust | Language::C => (c_files(&model, &form, &options).map_err(failure)?, Vec::new()),
    };
    let CFiles { prefix, header, source, check } = c;
    let in_c = vec![("{}.c", source), ("{}.h", header), ("{}_check.c", check)];
    write_all(arguments, folder, &prefix, [in_c, for_cpp].concat(), quiet)
}

fn mex(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    let folder = folder(arguments, "--mex")?;
    let Loaded { model, options, .. } = load(arguments, quiet)?;
    let files = mex_files(&model, arguments.name.clone(), &options).map_err(failure)?;
    let MexFiles { prefix, header, source, gateway, help, check } = files;
    let files = [("{}.c", source), ("{}.h", header), ("{}_mex.c", gateway), ("{}.m", help), ("{}_check.m", check)];
    write_all(arguments, folder, &prefix, files.into(), quiet)?;
    if !quiet {
        to_stderr(&format!("compile it in that folder by: mex -output {prefix} {prefix}_mex.c {prefix}.c"));
    }
    Ok(())
}

/// The folder for several files.
fn folder<'a>(arguments: &'a Arguments, option: &str) -> Result<&'a Path, Failure> {
    arguments.output.as_deref().ok_or_else(|| {
        Failure::command_line(format!("{option} writes several files and needs a folder"))
            .help("name one with --output")
    })
}

fn check_folder(folder: &Path) -> Result<(), Failure> {
    if folder.exists() && !folder.is_dir() {
        let failure = Failure::outside(format!("{} is there already, and is not a folder", folder.display()));
        return Err(failure.help("write elsewhere with --output"));
    }
    Ok(())
}

/// Writes files to a folder, or none. In their names `{}` stands for the prefix. The first is the source that has the
/// operations in its head.
fn write_all(
    arguments: &Arguments,
    folder: &Path,
    prefix: &str,
    files: Vec<(&str, String)>,
    quiet: bool,
) -> Result<(), Failure> {
    let files: Vec<_> = files.into_iter().map(|(name, text)| (folder.join(name.replace("{}", prefix)), text)).collect();
    // All places before the first is written, so that the files belong together.
    check_folder(folder)?;
    for (path, _) in &files {
        check_beside(&arguments.model, path, arguments.force)?;
    }
    let contents: Vec<_> = files.iter().map(|(path, text)| (path.clone(), text.as_bytes())).collect();
    write_together(folder, &contents, arguments.force)?;
    if !quiet {
        report(&files[0].1);
        let names: Vec<String> = files.iter().map(|(path, _)| path.display().to_string()).collect();
        to_stderr(&format!("\n{prefix} is in {}", names.join(", ")));
    }
    Ok(())
}

/// Prints the operations and the warnings that the head of a source has.
fn report(source: &str) {
    let head = source.lines().take_while(|line| line.starts_with(['/', ' ']));
    let lines = head.map(|line| line.trim_start_matches(['/', '*', ' ']));
    let of_interest = lines.filter(|line| line.contains(" flops, ") || line.starts_with("Warning: "));
    of_interest.for_each(to_stderr);
}

fn failure(error: SourceError) -> Failure {
    match error {
        SourceError::InvalidName(_) | SourceError::InvalidPrefix(_) => {
            Failure::command_line(error).help("give another name with --name")
        }
        SourceError::ClosedLoop(_) => Failure::input(error)
            .help("simulate it by `redysim forward`, or call its functions by --language c or --mex"),
        _ => Failure::input(error),
    }
}

/// The model with the functions that are asked for here, checked as those of a declaration are.
fn load(arguments: &Arguments, quiet: bool) -> Result<Loaded, Failure> {
    let names: Vec<String> = arguments.functions.iter().map(|name| format!("\"{name}\"")).collect();
    let options = if names.is_empty() { String::new() } else { format!("functions = [{}]", names.join(", ")) };
    model::load(&arguments.model, &options, quiet)
}

/// `kr5` is `Kr5`, `n-fourbar 2` is `NFourbar2`; a name that still is not one of a type, such as `3rrr`, is
/// `Mechanism3rrr`.
pub fn type_name(model: &str) -> String {
    let words = model.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty());
    let name: String = words
        .map(|word| {
            let mut letters = word.chars();
            letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
        })
        .collect();
    let begins_well = name.starts_with(|c: char| c.is_alphabetic());
    if begins_well && name != "Self" { name } else { format!("Mechanism{name}") }
}

#[cfg(test)]
mod tests {
    use super::type_name;

    #[test]
    fn every_model_has_a_name_for_a_type() {
        let names = [("kr5", "Kr5"), ("n-fourbar 2", "NFourbar2"), ("3-RRR", "Mechanism3RRR"), ("…", "Mechanism")];
        for (model, name) in names.into_iter().chain([("self", "MechanismSelf"), ("größe", "Größe")]) {
            assert_eq!(type_name(model), name);
        }
    }
}
