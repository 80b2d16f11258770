//! A header for C++ over that of C, and a package of CMake.

use super::comment::documentation;
use super::function::Writer;
use super::names::Prefix;
use crate::backend::head::VERSION;
use crate::mechanism::FunctionProgram;
use redysim_runtime::function::{Argument, Dimension, Form, Length, Shape};

/// Words of C++ (to C++20) that are a prefix in C, but not a namespace; `std` inside another one would hide the library.
const KEYWORDS: &str = "alignas alignof and and_eq asm auto bitand bitor bool break case catch char class compl concept const \
    const_cast consteval constexpr constinit continue co_await co_return co_yield decltype default delete do double \
    dynamic_cast else enum explicit export extern false float for friend goto if inline int long mutable namespace new \
    noexcept not not_eq nullptr operator or or_eq private protected public register reinterpret_cast requires return short \
    signed sizeof static static_assert static_cast std struct switch template this thread_local throw true try typedef typeid \
    typename union unsigned using virtual void volatile wchar_t while xor xor_eq";

/// Whether no namespace of C++ can have the name.
pub fn is_keyword(name: &str) -> bool {
    KEYWORDS.split_whitespace().any(|keyword| keyword == name)
}

/// The types of arguments and results that are arrays or structs of C.
const STRUCTS: [(Shape, &str); 7] = [
    (Shape::Energy, "Energy"),
    (Shape::CenterOfMass, "CenterOfMass"),
    (Shape::Momentum, "Momentum"),
    (Shape::HybridMotion, "HybridMotion"),
    (Shape::Links, "LinkState"),
    (Shape::Frames, "FrameState"),
    (Shape::FrameJacobians, "FrameJacobian"),
];

/// The whole header; `head` is its first comment.
pub fn header(writer: &Writer, head: &str) -> String {
    let (prefix, number) = (writer.prefix, writer.scalar.type_name());
    let guard = prefix.constant("HPP");
    let name = prefix.as_str();
    let mut text = format!(
        "{head}#ifndef {guard}\n#define {guard}\n\n#include \"{name}.h\"\n\n#include <array>\n#include <cstddef>\n\n\
         namespace redysim {{\nnamespace {name} {{\n\n"
    );
    text += &documentation([format!("Sizes, as in {name}.h.")]);
    for size in ["NQ", "NV", "NL", "NC", "NF", "NP"] {
        text += &format!("constexpr std::size_t {} = {};\n", size.to_lowercase(), prefix.constant(size));
    }
    text += "\n";
    text += &documentation(["A number, and what functions take and give, in the model's order; matrices by rows."]);
    text += &format!("using Number = {number};\nusing Coordinates = std::array<Number, nq>;\n");
    text += "using Velocities = std::array<Number, nv>;\nusing Forces = std::array<Number, nv>;\n";
    text += "using Matrix = std::array<std::array<Number, nv>, nv>;\n";
    let has = |shape: Shape| writer.functions().any(|program| program.function.signature().result == shape);
    if has(Shape::LoopRows) || has(Shape::LoopJacobian) {
        text +=
            "using LoopRows = std::array<Number, nc>;\nusing LoopJacobian = std::array<std::array<Number, nv>, nc>;\n";
    }
    for (shape, alias) in STRUCTS.into_iter().chain([(Shape::FrameAccelerations, "FrameAcceleration")]) {
        if let (true, Some(structure)) = (has(shape), shape.form().structure) {
            text += &format!("using {alias} = {};\n", prefix.type_of(structure.name));
        }
    }
    let takes_wrenches =
        |program: &FunctionProgram| program.function.signature().arguments.contains(&Argument::Wrenches);
    if let (true, Some(wrench)) = (writer.functions().any(takes_wrenches), Argument::Wrenches.form().structure) {
        text += &format!("using Wrench = {};\n", prefix.type_of(wrench.name));
    }
    if writer.is_parametric() {
        text += &robot(prefix);
    }
    if writer.has_trig() {
        let (parameter, argument) = of_robot(writer);
        text += &format!("using JointTrig = {};\n\n", prefix.type_of("joint_trig"));
        text +=
            &documentation(["The coordinates with the sines and cosines of all angles, for functions that need them."]);
        text += &format!(
            "inline JointTrig joint_trig({parameter}const Coordinates &q) noexcept\n{{\n    JointTrig trig;\n    \
             {}({argument}q.data(), &trig);\n    return trig;\n}}\n",
            prefix.item("joint_trig")
        );
    }
    for program in writer.functions() {
        text += &function(writer, program, false);
        if writer.has_form_with_trig(program) {
            text += &function(writer, program, true);
        }
    }
    text + "\n}\n}\n\n#endif\n"
}

/// The robot with its run-time parameters.
fn robot(prefix: &Prefix) -> String {
    let name = prefix.as_str();
    let structure =
        documentation(["The robot with its run-time parameters: what depends on them alone, computed once."]);
    format!(
        "using Parameters = std::array<Number, np>;\n\n{structure}class Robot {{\npublic:\n    \
         /** With the parameters of the model. */\n    Robot() noexcept {{ {name}_default(&robot); }}\n    \
         /** With other parameters, which are not checked. */\n    \
         explicit Robot(const Parameters &parameters) noexcept {{ {name}_init(&robot, parameters.data()); }}\n    \
         /** Takes other parameters; or stays as it is, and returns the index of the first that is invalid, plus one. */\n    \
         int try_init(const Parameters &parameters) noexcept {{ return {name}_try_init(&robot, parameters.data()); }}\n    \
         /** For functions of C. */\n    const {name}_t *c() const noexcept {{ return &robot; }}\n\nprivate:\n    \
         {name}_t robot;\n}};\n"
    )
}

/// The argument for the robot in C++ and in the call of C, if functions have it.
fn of_robot(writer: &Writer) -> (&'static str, &'static str) {
    if writer.is_parametric() { ("const Robot &robot, ", "robot.c(), ") } else { ("", "") }
}

fn function(writer: &Writer, program: &FunctionProgram, with_trig: bool) -> String {
    let (function, signature) = (program.function, program.function.signature());
    let (robot, robot_in_c) = of_robot(writer);
    let result = signature.result.form();
    let mut parameters = Vec::new();
    let mut arguments = Vec::new();
    for (index, &argument) in signature.arguments.iter().enumerate() {
        let name = argument.name();
        if with_trig && index == 0 {
            parameters.push("const JointTrig &trig".to_string());
            arguments.push("&trig".to_string());
        } else {
            parameters.push(format!("const {} &{name}", of_argument(argument)));
            arguments.push(format!("{name}.data()"));
        }
    }
    let of_result = result_type(signature.result, &result);
    let place = match result.lengths {
        [] => format!("&{}", result.name),
        [_] => format!("{}.data()", result.name),
        // The arrays of an array lie one after the other, as the rows of C do.
        [_, row, ..] => {
            format!("reinterpret_cast<Number (*)[{}]>({}.data())", length(*row), result.name)
        }
    };
    arguments.push(place);
    let parameters = format!("{robot}{}", parameters.join(", "));
    let parameters = parameters.trim_end_matches(", ");
    let suffix = if with_trig { "_with_trig" } else { "" };
    let what = match with_trig {
        false => program.documentation.first().cloned().unwrap_or_default(),
        true => "The same with sines and cosines that are already computed.".to_string(),
    };
    format!(
        "\n{}inline {of_result} {}({parameters}) noexcept\n{{\n    {of_result} {};\n    {}{suffix}({robot_in_c}{});\n    return \
         {};\n}}\n",
        documentation(what.lines()),
        function.name(),
        result.name,
        writer.prefix.item(function.name()),
        arguments.join(", "),
        result.name
    )
}

fn of_argument(argument: Argument) -> &'static str {
    match argument {
        Argument::Wrenches => "std::array<Wrench, nf>",
        Argument::Forces => "Forces",
        _ if argument.dimension() == Dimension::Coordinates => "Coordinates",
        _ => "Velocities",
    }
}

fn result_type(shape: Shape, form: &Form) -> String {
    let structure = STRUCTS.into_iter().find(|(of, _)| *of == shape).map(|(_, alias)| alias);
    match (shape, structure) {
        (Shape::Forces, _) => "Forces".into(),
        (Shape::MassMatrix | Shape::CoriolisMatrix, _) => "Matrix".into(),
        (Shape::Coordinates, _) => "Coordinates".into(),
        (Shape::Accelerations | Shape::Displacement, _) => "Velocities".into(),
        (Shape::LoopRows, _) => "LoopRows".into(),
        (Shape::LoopJacobian, _) => "LoopJacobian".into(),
        (Shape::Power, _) => "Number".into(),
        (Shape::FrameAccelerations, _) => "std::array<FrameAcceleration, nf>".into(),
        (_, Some(alias)) => match form.lengths {
            [of] => format!("std::array<{alias}, {}>", length(*of)),
            _ => alias.into(),
        },
        (_, None) => unreachable!("every other shape is a struct"),
    }
}

fn length(length: Length) -> String {
    match length {
        Length::Size(dimension) => dimension.name().to_lowercase(),
        Length::Three => "3".into(),
    }
}

/// `CMakeLists.txt`: a library that other builds take by `add_subdirectory` or, installed, by `find_package`.
pub fn cmake(prefix: &Prefix) -> String {
    CMAKE.replace("@name@", prefix.as_str()).replace("@version@", VERSION)
}

const CMAKE: &str = include_str!("CMakeLists.txt");
