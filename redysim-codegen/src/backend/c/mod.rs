//! A mechanism as C99: a header, a source, and a program that checks them.

mod body;
mod check;
mod check_matlab;
mod comment;
mod cpp;
mod fmu;
mod function;
mod header;
mod library;
mod mex;
mod names;
mod parametric;
mod results;
mod runtime;
mod scalar;
mod units;

use crate::backend::head;
use crate::backend::rust::source::SourceError;
use crate::generate::{TracedMechanism, traced};
use crate::mechanism::MechanismProgram;
use crate::passes::Passes;
use crate::program::{Program, Statement, Value};
use body::RESERVED;
use check::Reference;
pub use fmu::{FmiVersion, FmuFiles};
use function::Writer;
pub use library::{CLibrary, c_library};
use names::Prefix;
use redysim_model::{CodegenOptions, Model, PublicInterface};
use runtime::Needed;
use scalar::Abreast;
pub use scalar::CScalar;
use std::collections::BTreeSet;
use units::Units;

/// How a mechanism is written in C.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct COptions {
    /// The prefix of all names, and the name of the files; the default is the model's name in lower case.
    pub prefix: Option<String>,
    /// The floating-point type.
    pub scalar: CScalar,
}

/// The files of a mechanism in C99.
#[derive(Clone, Debug, PartialEq)]
pub struct CFiles {
    /// The prefix of all names: the files are `prefix.h`, `prefix.c` and `prefix_check.c`.
    pub prefix: String,
    /// The header: sizes, names, units, operation counts, types and functions.
    pub header: String,
    /// The source.
    pub source: String,
    /// A program that calls every function at a few states and compares its results with those of the run-time path. It
    /// exits with 0, or names the function and the element that is off.
    pub check: String,
}

/// The files of a mechanism in C99 and what C++ needs beside them.
#[derive(Clone, Debug, PartialEq)]
pub struct CppFiles {
    /// The files in C.
    pub c: CFiles,
    /// The header for C++, `prefix.hpp`.
    pub header: String,
    /// `CMakeLists.txt`.
    pub cmake: String,
}

/// The files of a mechanism for MATLAB and Octave.
#[derive(Clone, Debug, PartialEq)]
pub struct MexFiles {
    /// The prefix of all names: the files are `prefix.h`, `prefix.c`, `prefix_mex.c`, `prefix.m` and `prefix_check.m`.
    pub prefix: String,
    /// The header in C.
    pub header: String,
    /// The source in C.
    pub source: String,
    /// The gateway.
    pub gateway: String,
    /// The help of the gateway; where the gateway is not compiled, a function that reports how it is.
    pub help: String,
    /// A function that calls every function of the gateway at a few states and compares its results with those of the
    /// run-time path.
    pub check: String,
}

/// The mechanism of `model` as C99, with the functions that `redysim!` makes.
///
/// It needs `math.h` and nothing else, allocates nothing and has no state. The same model gives the same bytes.
///
/// ```
/// # use redysim_model::{CodegenOptions, Model};
/// use redysim_codegen::{COptions, c_files};
///
/// # let text = "name = 'rod'\ngravity = [0, -9.81, 0]\n[[link]]\nname = 'rod'\nparent = 'base'\njoint = 'revolute'\n\
/// #     axis = [0, 0, 1]\nmass = 2.0\ncom = [0.5, 0, 0]";
/// let model = Model::from_toml(text, "rod.toml")?.model;
/// let files = c_files(&model, &COptions::default(), &CodegenOptions::default())?;
/// assert!(files.header.contains("void rod_gravity_forces(const double q[ROD_NQ], double tau[ROD_NV]);"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// If the prefix is not a name of C or is one of its standard library; in debug builds, if a pass over expressions is
/// wrong.
pub fn c_files(model: &Model, options: &COptions, codegen: &CodegenOptions) -> Result<CFiles, SourceError> {
    printed(model, options, codegen, |printing| printing.c())
}

/// The mechanism of `model` as C99 with a header for C++11 and a package of CMake.
///
/// The header `prefix.hpp` has the functions in the namespace `redysim::prefix`, over `std::array`. The package has the
/// target `prefix::prefix`, in a build by `add_subdirectory`, and where it is installed by `find_package(prefix)`.
///
/// ```
/// # use redysim_model::{CodegenOptions, Model};
/// use redysim_codegen::{COptions, cpp_files};
///
/// # let text = "name = 'rod'\ngravity = [0, -9.81, 0]\n[[link]]\nname = 'rod'\nparent = 'base'\njoint = 'revolute'\n\
/// #     axis = [0, 0, 1]\nmass = 2.0\ncom = [0.5, 0, 0]";
/// let model = Model::from_toml(text, "rod.toml")?.model;
/// let files = cpp_files(&model, &COptions::default(), &CodegenOptions::default())?;
/// assert!(files.header.contains("inline Forces gravity_forces(const Coordinates &q) noexcept"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// As [`c_files`], and if the prefix is a keyword of C++.
pub fn cpp_files(model: &Model, options: &COptions, codegen: &CodegenOptions) -> Result<CppFiles, SourceError> {
    let files = printed(model, options, codegen, |printing| CppFiles {
        c: printing.c(),
        header: cpp::header(&printing.writer, &printing.head(&[])),
        cmake: cpp::cmake(printing.writer.prefix),
    })?;
    if cpp::is_keyword(&files.c.prefix) { Err(SourceError::InvalidPrefix(files.c.prefix)) } else { Ok(files) }
}

/// The mechanism of `model` as C99, in `double`, with a gateway (MEX) for MATLAB and Octave:
/// `tau = kr5('inverse_dynamics', q, v, a)`.
///
/// `prefix` is that of [`COptions`]. The head of the gateway has the commands that compile it.
///
/// ```
/// # use redysim_model::{CodegenOptions, Model};
/// use redysim_codegen::mex_files;
///
/// # let text = "name = 'rod'\ngravity = [0, -9.81, 0]\n[[link]]\nname = 'rod'\nparent = 'base'\njoint = 'revolute'\n\
/// #     axis = [0, 0, 1]\nmass = 2.0\ncom = [0.5, 0, 0]";
/// let model = Model::from_toml(text, "rod.toml")?.model;
/// let files = mex_files(&model, None, &CodegenOptions::default())?;
/// assert!(files.gateway.contains("mex -output rod rod_mex.c rod.c"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// As [`c_files`].
pub fn mex_files(model: &Model, prefix: Option<String>, codegen: &CodegenOptions) -> Result<MexFiles, SourceError> {
    printed(model, &COptions { prefix, scalar: CScalar::F64 }, codegen, |printing| {
        let writer = &printing.writer;
        let commands = mex::commands(writer);
        let head = printing.head(&["", &commands[0], "", &commands[1], &commands[2]]);
        MexFiles {
            prefix: writer.prefix.as_str().to_string(),
            header: printing.header(),
            source: printing.source(),
            gateway: mex::gateway(writer, &head),
            help: mex::help(writer),
            check: check_matlab::check(writer, &printing.reference()),
        }
    })
}

/// The mechanism of `model` as a functional mock-up unit (FMU) for model exchange and co-simulation: the files of its
/// archive, but for compiled code.
///
/// States are the coordinates and velocities, inputs the joint forces, outputs the states, accelerations and energies;
/// gravity and the run-time parameters of `codegen` are parameters, all with units. `prefix` is that of [`COptions`]
/// and the model identifier.
///
/// ```
/// # use redysim_model::{CodegenOptions, Model};
/// use redysim_codegen::{FmiVersion, fmu_files};
///
/// # let text = "name = 'rod'\ngravity = [0, -9.81, 0]\n[[link]]\nname = 'rod'\nparent = 'base'\njoint = 'revolute'\n\
/// #     axis = [0, 0, 1]\nmass = 2.0\ncom = [0.5, 0, 0]";
/// let model = Model::from_toml(text, "rod.toml")?.model;
/// let files = fmu_files(&model, None, FmiVersion::V3, &CodegenOptions::default())?;
/// let paths: Vec<&str> = files.files.iter().map(|(path, _)| path.as_str()).collect();
/// assert_eq!(paths[..2], ["modelDescription.xml", "sources/rod.h"]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// If the model has closed loops, whose coordinates are not independent states; as [`c_files`].
pub fn fmu_files(
    model: &Model,
    prefix: Option<String>,
    version: FmiVersion,
    codegen: &CodegenOptions,
) -> Result<FmuFiles, SourceError> {
    if let Some(cut) = model.loops.first() {
        return Err(SourceError::ClosedLoop(cut.name.clone()));
    }
    let options = COptions { prefix, scalar: CScalar::F64 };
    printed(model, &options, &fmu::options(codegen), |printing| fmu::files(printing, version))
}

/// What is printed of a mechanism.
struct Printing<'a> {
    model: &'a Model,
    codegen: &'a CodegenOptions,
    traced: &'a TracedMechanism,
    writer: Writer<'a>,
}

/// Traces a mechanism and prints it.
fn printed<T>(
    model: &Model,
    options: &COptions,
    codegen: &CodegenOptions,
    print: impl FnOnce(&Printing) -> T,
) -> Result<T, SourceError> {
    let prefix = match &options.prefix {
        Some(name) => Prefix::new(name).ok_or_else(|| SourceError::InvalidPrefix(name.clone()))?,
        None => Prefix::of_model(&model.name),
    };
    let traced = &traced(model, codegen, &Passes::default())?;
    let interface = PublicInterface::new(model, codegen);
    let mechanism = MechanismProgram::new(model, &interface, traced, &RESERVED);
    let units = Units::of(model, &codegen.parameters);
    let writer = Writer { mechanism: &mechanism, prefix: &prefix, scalar: options.scalar, units: &units };
    Ok(print(&Printing { model, codegen, traced, writer }))
}

impl Printing<'_> {
    /// The head of a file, which ends with the lines `what`.
    fn head(&self, what: &[&str]) -> String {
        let operations: Vec<_> =
            self.writer.functions().map(|program| (program.function, program.operations)).collect();
        let lines = what.iter().map(|line| line.to_string());
        comment::head(head::lines(self.model, &operations, &self.traced.warnings).into_iter().chain(lines)) + "\n"
    }

    fn header(&self) -> String {
        header::header(&self.writer, self.model, &self.head(ABOUT))
    }

    fn source(&self) -> String {
        source(&self.writer, &self.head(&[]))
    }

    /// The values that a check compares with.
    fn reference(&self) -> Reference {
        Reference::new(self.model, self.codegen, self.traced, self.writer.scalar)
    }

    fn c(&self) -> CFiles {
        CFiles {
            header: self.header(),
            source: self.source(),
            check: check::program(&self.writer, &self.reference(), &self.head(&[])),
            prefix: self.writer.prefix.as_str().to_string(),
        }
    }
}

/// What holds for all functions, for the head of the header.
const ABOUT: &[&str] = &[
    "",
    "Vectors have the model's order, matrices are by rows. Vectors in space are in the base frame, unless their documentation \
     names other axes. No function allocates, has state, or fails; a result may be written to the array of an argument.",
    "",
    "Angles are in radians. The coordinates of a spherical joint are the unit quaternion x, y, z, w, its velocities the \
     angular velocity in the link's frame; those of a free joint are x, y, z and the quaternion, and the linear velocity of \
     the link's origin, then the angular velocity, both in the link's frame. A quaternion need not have length 1.",
    "",
    "When the source is compiled, these macros choose:",
    "- REDYSIM_FMA: multiply-adds are rounded once, by fma of math.h. Default: twice, the same bits on every processor.",
    "- REDYSIM_VECTORS: 0 computes angles, and branches that are alike, one after the other. Default: in vectors of GCC and \
     Clang, where the processor has them.",
    "- REDYSIM_LIBM: sines and cosines of math.h. Default: redysim's, the same bits everywhere.",
    "- REDYSIM_SINCOS(x, s, c): sines and cosines of your own, of the angle x into *s and *c.",
];

/// The source; `head` is its first comment.
fn source(writer: &Writer, head: &str) -> String {
    let mut parts = vec![
        head.to_string()
            + &format!(
                "#include \"{}.h\"\n\n#include <float.h>\n#include <math.h>\n#include <stdint.h>\n",
                writer.prefix.as_str()
            ),
        runtime::parts(needed(writer), writer.scalar),
        header::definitions_of_tables(writer),
    ];
    if let Some(lumped) = &writer.mechanism.lumped {
        parts.push(parametric::definitions(writer, lumped));
    }
    if writer.has_trig() {
        parts.push(writer.joint_trig());
    }
    parts.extend(writer.functions().map(|program| writer.definitions(program)));
    parts.join("\n")
}

/// Which parts of the runtime the functions need.
fn needed(writer: &Writer) -> Needed {
    let programs: Vec<&Program> =
        writer.functions().map(|program| &program.program).chain(&writer.mechanism.lumped).collect();
    let has = |is: fn(&Value) -> bool| programs.iter().any(|program| program.has(&is));
    let branches = programs.iter().flat_map(|program| &program.statements).filter_map(|statement| match statement {
        Statement::SideBySide(each) => Some(Abreast::of(each.branches, writer.scalar)),
        _ => None,
    });
    Needed {
        angles: writer.has_trig(),
        sine: has(|value| matches!(value, Value::Sine(_))),
        cosine: has(|value| matches!(value, Value::Cosine(_))),
        without_turns: !writer.mechanism.trig.without_turns.is_empty(),
        abreast: branches.collect::<BTreeSet<_>>().into_iter().collect(),
    }
}
