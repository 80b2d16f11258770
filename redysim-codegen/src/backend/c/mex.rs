//! For MATLAB and Octave: a gateway (MEX) over the functions in C, and their help.

use super::comment::{percent, statement, string};
use super::function::Writer;
use super::header::{Table, tables};
use crate::backend::head::VERSION;
use crate::mechanism::FunctionProgram;
use redysim_model::PublicInterface;
use redysim_runtime::function::{Argument, Dimension, Form, Length};

const RUNTIME: &str = include_str!("runtime/mex.c");

/// How the gateway is compiled, for the head of its files.
pub fn commands(writer: &Writer) -> [String; 3] {
    let name = writer.prefix.as_str();
    [
        "Compile it in MATLAB or Octave by the first command, or in a shell by the second:".into(),
        format!("    mex -output {name} {name}_mex.c {name}.c"),
        format!("    CFLAGS=\"-std=c99 -O2\" mkoctfile --mex -o {name}.mex {name}_mex.c {name}.c"),
    ]
}

/// The gateway; `head` is its first comment.
pub fn gateway(writer: &Writer, head: &str) -> String {
    let (prefix, interface) = (writer.prefix, writer.mechanism.interface);
    let most = |count: fn(&Form, &PublicInterface) -> usize| {
        writer
            .functions()
            .map(|program| count(&program.function.signature().result.form(), interface))
            .max()
            .unwrap_or(1)
    };
    let mut text = format!(
        "{head}#include \"{}.h\"\n\n#include <math.h>\n#include <mex.h>\n#include <stddef.h>\n#include <string.h>\n\n\
         enum {{ MOST_ARGUMENTS = 3, MOST_PARTS = {}, MOST_ARRAYS = {} }};\n{TYPES}",
        prefix.as_str(),
        most(|form, _| parts(form)),
        most(|form, interface| elements(form, interface) * parts(form)),
    );
    text += &writer.functions().map(|program| caller(writer, program)).collect::<String>();
    text += "\nstatic const function_t functions[] = {\n";
    text += &writer.functions().map(|program| row(writer, program)).collect::<String>();
    text += "};\n\n/* Names and units of the model. */\nstatic const struct {\n    const char *name;\n    const char *const *texts;\n    \
             size_t length;\n} names[] = {\n";
    for Table { name, length, .. } in tables(writer).iter().filter(|table| table.is_of_strings()) {
        text += &statement(1, &format!("{{\"{name}\", {}, {}}},", prefix.item(name), prefix.constant(length)));
    }
    text + "};\n\n" + &RUNTIME.replace("@name@", prefix.as_str()).replace("@NAME@_", &prefix.constant(""))
}

/// What describes a function, its arguments and its result.
const TYPES: &str = "
/* An array: rows and columns of one state, and 0 columns of a vector. */
typedef struct {
    const char *name;
    size_t rows, columns;
} shape_t;

/* A function: how it is called for one state, its arguments, and its result: the number of its structs and their parts, or an
   array, which has no name. */
typedef struct {
    const char *name;
    void (*call)(const void *robot, const double *const *given, double *result);
    size_t arguments;
    shape_t argument[MOST_ARGUMENTS];
    size_t elements, count;
    shape_t parts[MOST_PARTS];
} function_t;
";

fn parts(form: &Form) -> usize {
    form.structure.map_or(1, |structure| structure.fields.len())
}

fn elements(form: &Form, interface: &PublicInterface) -> usize {
    match (form.structure, form.lengths) {
        (Some(_), [Length::Size(dimension)]) => interface.size(*dimension),
        _ => 1,
    }
}

/// The function that calls one of the mechanism on numbers.
fn caller(writer: &Writer, program: &FunctionProgram) -> String {
    let (name, signature) = (program.function.name(), program.function.signature());
    let robot = if writer.is_parametric() { "robot, " } else { "" };
    let mut unused = String::new();
    if robot.is_empty() {
        unused += &statement(1, "(void)robot;");
    }
    if signature.arguments.is_empty() {
        unused += &statement(1, "(void)given;");
    }
    let mut arguments: Vec<String> = Vec::new();
    for (index, argument) in signature.arguments.iter().enumerate() {
        let (element, _) = writer.element_and_length(*argument);
        let cast = if argument.form().structure.is_some() { format!("(const {element} *)") } else { String::new() };
        arguments.push(format!("{cast}given[{index}]"));
    }
    let form = signature.result.form();
    arguments.push(match (form.structure, form.lengths) {
        (Some(structure), _) => format!("({} *)result", writer.prefix.type_of(structure.name)),
        (None, [_, row]) => format!("(double (*)[{}])result", written(writer, row)),
        _ => "result".into(),
    });
    let head = format!("static void call_{name}(const void *robot, const double *const *given, double *result)");
    let call = format!("{}({robot}{});", writer.prefix.item(name), arguments.join(", "));
    format!("\n{}{{\n{unused}{}}}\n", statement(0, &head), statement(1, &call))
}

fn written(writer: &Writer, length: &Length) -> String {
    match length {
        Length::Size(dimension) => writer.prefix.constant(dimension.name()),
        Length::Three => "3".into(),
    }
}

/// The row of a function in the table.
fn row(writer: &Writer, program: &FunctionProgram) -> String {
    let (name, signature) = (program.function.name(), program.function.signature());
    let shape = |name: &str, [rows, columns]: [String; 2]| format!("{{{name}, {rows}, {columns}}}");
    let of_lengths = |lengths: &[Length]| match lengths {
        [] => ["1".into(), "0".into()],
        [rows] => [written(writer, rows), "0".into()],
        [rows, columns, ..] => [written(writer, rows), written(writer, columns)],
    };
    let of_argument = |argument: &Argument| {
        let (_, length) = writer.element_and_length(*argument);
        let sizes = match argument.numbers() {
            1 => [length, "0".into()],
            numbers => [numbers.to_string(), length],
        };
        shape(&string(argument.name()), sizes)
    };
    let arguments: Vec<String> = signature.arguments.iter().map(of_argument).collect();
    let arguments = if arguments.is_empty() { "{NULL, 0, 0}".into() } else { arguments.join(", ") };
    let form = signature.result.form();
    let (elements, parts) = match form.structure {
        None => ("1".into(), vec![shape("NULL", of_lengths(form.lengths))]),
        Some(structure) => (
            form.lengths.first().map_or("1".into(), |length| written(writer, length)),
            structure.fields.iter().map(|(name, lengths, _)| shape(&string(name), of_lengths(lengths))).collect(),
        ),
    };
    let row = format!(
        "{{\"{name}\", call_{name}, {}, {{{arguments}}}, {elements}, {}, {{{}}}}},",
        signature.arguments.len(),
        parts.len(),
        parts.join(", ")
    );
    statement(1, &row)
}

/// The file `prefix.m`: the help of the gateway, and how it is compiled where it is not yet.
pub fn help(writer: &Writer) -> String {
    let (name, interface) = (writer.prefix.as_str(), writer.mechanism.interface);
    let mut lines = vec![
        format!("{}  Dynamics of the mechanism {}, generated by redysim {VERSION}.", name.to_uppercase(), interface.name),
        String::new(),
        "  Vectors are columns, and may be rows in arguments. With a state in each column of the arguments, results have a \
         column for each, or matrices a page; an argument with one state is that of all."
            .into(),
    ];
    let parameters = if writer.is_parametric() { "[, parameters]" } else { "" };
    for program in writer.functions() {
        let (function, signature) = (program.function.name(), program.function.signature());
        let result = signature.result.form();
        let arguments: String = signature.arguments.iter().map(|argument| format!(", {}", argument.name())).collect();
        lines.extend([String::new(), format!("  {} = {name}('{function}'{arguments}{parameters})", result.name)]);
        let summary = program.documentation.first().map(|paragraph| paragraph.split_whitespace().collect::<Vec<_>>());
        lines.push(format!("    {}", summary.unwrap_or_default().join(" ")));
        let size = |lengths: &[Length]| {
            let sizes = lengths.iter().map(|length| number(interface, length).to_string());
            sizes.chain(std::iter::repeat("1".into())).take(2).collect::<Vec<_>>().join(" by ")
        };
        match result.structure {
            None => lines.push(format!("    {}: {}, {}.", result.name, size(result.lengths), lower(result.what))),
            Some(structure) => {
                let count = size(result.lengths);
                lines.push(format!("    {}: {}, a struct, {count}, of:", result.name, lower(result.what)));
                let part = |(part, lengths, what): &(&str, &[Length], &str)| {
                    format!("      {part}: {}, {}.", size(lengths), lower(what))
                };
                lines.extend(structure.fields.iter().map(part));
            }
        }
    }
    lines.extend([
        String::new(),
        format!("  model = {name}('model')"),
        "    Names, units and parameters of the model.".into(),
        String::new(),
        "  Arguments:".into(),
    ]);
    let units = writer.units;
    let list = |what: &str, names: Vec<String>| format!("  - {what}, {} by 1: {}.", names.len(), names.join(", "));
    let with = |names: Vec<&str>, units: &[String]| -> Vec<String> {
        names.iter().zip(units).map(|(name, unit)| format!("{name} ({unit})")).collect()
    };
    let velocities: Vec<&str> = interface.velocity_names().collect();
    lines.push(list("q", with(interface.coordinate_names().collect(), &units.coordinates)));
    lines.push(list("v", with(velocities.clone(), &units.velocities)));
    lines.push(list("a", with(velocities.clone(), &units.accelerations)));
    lines.push(list("tau", with(velocities, &units.forces)));
    if interface.size(Dimension::Frames) > 0 {
        lines.push(format!(
            "  - wrenches, 6 by {}: force (N) and moment (N m) on each frame: {}.",
            interface.frames.len(),
            interface.frames.join(", ")
        ));
    }
    if writer.is_parametric() {
        let parameters = interface.parameters.iter().map(|parameter| parameter.name.as_str());
        lines.push(list("parameters", with(parameters.collect(), &units.parameters)));
    }
    lines.push(String::new());
    lines.push(
        "  Faults have identifiers: redysim:function, redysim:arguments, redysim:type, redysim:shape, redysim:value, \
                redysim:parameters and redysim:result."
            .into(),
    );
    let [_, command, _] = commands(writer);
    format!(
        "function varargout = {name}(varargin)\n{}error('redysim:compile', '{name} is not compiled. In its folder: {}');\nend\n",
        percent(lines),
        command.trim()
    )
}

fn number(interface: &PublicInterface, length: &Length) -> usize {
    match length {
        Length::Size(dimension) => interface.size(*dimension),
        Length::Three => 3,
    }
}

/// With a small letter first, unless it is a symbol or an abbreviation.
fn lower(text: &str) -> String {
    let mut letters = text.chars();
    match (letters.next(), letters.clone().next()) {
        (Some(first), Some(second)) if second.is_lowercase() => first.to_lowercase().chain(letters).collect(),
        _ => text.into(),
    }
}
