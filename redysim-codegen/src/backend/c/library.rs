//! Functions of many states, for a library that is compiled where it runs: several states at a time in the lanes of vectors.
//!
//! They need GCC or Clang, whose vector extensions write a function over lanes as over numbers. The code for one state beside
//! them is that of [`c_files`](super::c_files). The command line of GCC can keep it to vectors of 256 bits; lanes have those of 512
//! also then.

use super::body::{COSINES, GIVEN, SINES};
use super::comment::statement;
use super::function::Writer;
use super::results::InC;
use super::scalar::Numbers;
use super::{CFiles, COptions, runtime};
use crate::backend::rust::source::SourceError;
use crate::mechanism::FunctionProgram;
use redysim_model::{CodegenOptions, Function, Model};
use redysim_runtime::function::Argument;

/// A mechanism in C with functions of many states.
///
/// For each of `functions` the source has
///
/// ```c
/// void NAME(size_t count, const double *const *arguments, const size_t *strides, double *result);
/// ```
///
/// where `NAME` is [`symbol`](Self::symbol): the numbers of each argument begin at `arguments[i]` for the first state, and
/// `strides[i]` numbers further for each next one, 0 if they count for all. Results of the states follow each other. With
/// run-time parameters there is one more argument, the `given` numbers that [`INIT`](Self::INIT) makes of parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct CLibrary {
    /// The header, and the source with functions of one state and of many.
    pub files: CFiles,
    /// The functions; without those whose results have no numbers.
    pub functions: Vec<Function>,
    /// How many numbers a robot with run-time parameters is given; 0 without any.
    pub given: usize,
}

impl CLibrary {
    /// The symbol of `void redysim_init(const double *parameters, double *given)`, which a library with run-time parameters
    /// has.
    pub const INIT: &'static str = "redysim_init";

    /// The symbol of a function.
    pub fn symbol(function: Function) -> String {
        format!("redysim_{}", function.name())
    }
}

/// The mechanism of `model` in C with functions of many states, in `double`, for GCC and Clang.
///
/// ```
/// # use redysim_model::{CodegenOptions, Model};
/// use redysim_codegen::{CLibrary, COptions, c_files, c_library};
/// use redysim_model::Function;
///
/// # let text = "name = 'rod'\ngravity = [0, -9.81, 0]\n[[link]]\nname = 'rod'\nparent = 'base'\njoint = 'revolute'\n\
/// #     axis = [0, 0, 1]\nmass = 2.0\ncom = [0.5, 0, 0]";
/// let model = Model::from_toml(text, "rod.toml")?.model;
/// let library = c_library(&model, "rod", &CodegenOptions::default())?;
/// let symbol = CLibrary::symbol(Function::GravityForces);
/// assert!(library.files.source.contains(&format!("void {symbol}(size_t count,")));
/// // What follows the code in C99 is the functions of many states.
/// let c99 = c_files(&model, &COptions::default(), &CodegenOptions::default())?;
/// assert!(library.files.source.starts_with(&c99.source));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
///
/// As [`c_files`](super::c_files).
pub fn c_library(model: &Model, prefix: &str, codegen: &CodegenOptions) -> Result<CLibrary, SourceError> {
    let options = COptions { prefix: Some(prefix.to_owned()), ..COptions::default() };
    super::printed(model, &options, codegen, |printing| {
        let (writer, files) = (&printing.writer, printing.c());
        let given = writer.mechanism.lumped.as_ref().map_or(0, |lumped| lumped.outputs.len().max(1));
        let mut source = files.source.clone() + "\n#include <stddef.h>\n\n";
        source += &runtime::parts_of_lanes(super::needed(writer));
        if given > 0 {
            source += &init(writer);
        }
        for program in writer.functions() {
            source += &format!("\n{}\n{}", of_lanes(writer, program), of_states(writer, program, given));
        }
        let functions = writer.functions().map(|program| program.function).collect();
        CLibrary { files: CFiles { source, ..files }, functions, given }
    })
}

fn init(writer: &Writer) -> String {
    let robot = format!("{}_t", writer.prefix.as_str());
    format!(
        "\nvoid {}(const double *parameters, double *given)\n{{\n    {}(({robot} *)given, parameters);\n}}\n",
        CLibrary::INIT,
        writer.prefix.item("init")
    )
}

/// How many numbers an argument of one state has.
fn numbers(writer: &Writer, argument: Argument) -> usize {
    let interface = writer.mechanism.interface;
    argument.numbers() * interface.size(argument.dimension())
}

fn name_in_lanes(function: Function) -> String {
    format!("redysim_lanes_{}", function.name())
}

/// A function over lanes: of arrays of them.
fn of_lanes(writer: &Writer, program: &FunctionProgram) -> String {
    let (function, trig) = (program.function, &program.trig);
    let arguments: Vec<&str> = function.signature().arguments.iter().map(|argument| argument.name()).collect();
    let given = writer.is_parametric().then_some(GIVEN);
    let parameters = arguments.iter().copied().chain(given).map(|name| format!("const redysim_lanes *{name}, "));
    let head = format!(
        "REDYSIM_SHARED void {}({}redysim_lanes *out)",
        name_in_lanes(function),
        parameters.collect::<String>()
    );
    let count = program.program.outputs.len();
    let places: Vec<String> = (0..count).map(|place| format!("out[{place}]")).collect();
    let mut body = String::new();
    for name in arguments.iter().copied().chain(given) {
        body += &statement(1, &format!("(void){name};"));
    }
    if !trig.angles.is_empty() {
        body += &writer.sines_and_cosines_over(Numbers::Lanes, trig, true);
        body += &statement(1, &format!("(void){SINES};"));
        body += &statement(1, &format!("(void){COSINES};"));
    }
    body += &writer.code_over(Numbers::Lanes, &program.program, &arguments, &places);
    format!("{head}\n{{\n{body}}}\n")
}

/// A function of many states: in lanes, and of each state that is left.
fn of_states(writer: &Writer, program: &FunctionProgram, given: usize) -> String {
    let function = program.function;
    let signature = function.signature();
    let result = signature.result.form();
    let count = program.program.outputs.len();
    let mut inputs: Vec<(&str, usize)> =
        signature.arguments.iter().map(|argument| (argument.name(), numbers(writer, *argument))).collect();
    inputs.extend((given > 0).then_some((GIVEN, given)));
    let mut text = format!(
        "void {}(size_t count, const double *const *arguments, const size_t *strides, double *result)\n{{\n",
        CLibrary::symbol(function)
    );
    text += "    size_t i = 0;\n    (void)arguments;\n    (void)strides;\n    if (count >= REDYSIM_LANES) {\n";
    text += &statement(2, &format!("redysim_lanes out[{count}];"));
    for (index, (name, numbers)) in inputs.iter().enumerate() {
        text += &statement(2, &format!("redysim_lanes {name}[{}];", (*numbers).max(1)));
        // What counts for all states is read once.
        text += &statement(2, &format!("redysim_lanes_read({numbers}, arguments[{index}], strides[{index}], {name});"));
    }
    text += "        for (; i + REDYSIM_LANES <= count; i += REDYSIM_LANES) {\n";
    for (index, (name, numbers)) in inputs.iter().enumerate() {
        text += &statement(3, &format!("if (strides[{index}] > 0 && i > 0) {{"));
        let first = format!("arguments[{index}] + i * strides[{index}]");
        text += &statement(4, &format!("redysim_lanes_read({numbers}, {first}, strides[{index}], {name});"));
        text += &statement(3, "}");
    }
    let names: String = inputs.iter().map(|(name, _)| format!("{name}, ")).collect();
    text += &statement(3, &format!("{}({names}out);", name_in_lanes(function)));
    text += &statement(3, &format!("redysim_lanes_write({count}, out, result + i * {count});"));
    text += "        }\n    }\n    for (; i < count; i++) {\n";
    let of_one = |index: usize, kind: &str| format!("(const {kind} *)(arguments[{index}] + i * strides[{index}])");
    let mut values: Vec<String> = Vec::new();
    if given > 0 {
        values.push(of_one(signature.arguments.len(), &format!("{}_t", writer.prefix.as_str())));
    }
    values.extend(
        signature
            .arguments
            .iter()
            .enumerate()
            .map(|(index, argument)| of_one(index, &argument.form().element("double", writer.prefix))),
    );
    let inner = super::results::brackets(result.lengths.get(1..).unwrap_or_default(), writer.prefix);
    let element = result.element("double", writer.prefix);
    let pointer = if inner.is_empty() { format!("{element} *") } else { format!("{element} (*){inner}") };
    values.push(format!("({pointer})(result + i * {count})"));
    text += &statement(2, &format!("{}({});", writer.prefix.item(function.name()), values.join(", ")));
    text + "    }\n}\n"
}
