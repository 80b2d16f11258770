//! What differs for a mechanism that is given numbers at run time: a struct with what depends on them alone, which
//! functions take, and the functions that make it.

use super::body::GIVEN;
use super::comment::{documentation, statement};
use super::function::{ROBOT, Writer};
use super::runtime;
use crate::program::Program;
use redysim_model::PublicInterface;
use redysim_runtime::ParameterRule;

/// How many numbers depend on parameters alone; an array has at least one.
fn numbers(lumped: &Program) -> usize {
    lumped.outputs.len().max(1)
}

/// The struct, and the declarations of what makes it.
pub fn declarations(writer: &Writer, lumped: &Program) -> String {
    let (prefix, number) = (writer.prefix.as_str(), writer.scalar.type_name());
    let structure = documentation([
        "The robot with its run-time parameters: what depends on them alone, computed once. Initialise it before any other \
         function reads it; then any number of threads may.",
    ]) + &format!("typedef struct {{\n    {number} {GIVEN}[{}];\n}} {prefix}_t;\n", numbers(lumped));
    let init = documentation([
        format!(
            "The robot with the given parameters, in the order of {prefix}_parameter_names and the units of \
             {prefix}_parameter_units."
        ),
        String::new(),
        format!(
            "What depends on them alone is computed here, once. Parameters are not checked; {prefix}_try_init checks them."
        ),
    ]) + &statement(0, &format!("{};", head_of_init(writer)));
    let try_init = documentation([
        "The robot with the given parameters, if a rigid body and its joint can have them.".to_string(),
        String::new(),
        format!(
            "Returns 0; or, for the first parameter that violates its rule, its index plus one, and leaves the robot as it is: \
             {prefix}_parameter_names[status - 1] must be {prefix}_parameter_rules[status - 1]. Of an inertia tensor, it is the \
             first element."
        ),
    ]) + &statement(0, &format!("{};", head_of_try_init(writer)));
    let default = documentation(["The robot with the parameters of the model."])
        + &statement(0, &format!("{};", head_of_default(writer)));
    [structure, init, try_init, default].join("\n")
}

/// The functions.
pub fn definitions(writer: &Writer, lumped: &Program) -> String {
    let (prefix, number, interface) = (writer.prefix, writer.scalar.type_name(), writer.mechanism.interface);
    let places: Vec<String> = (0..lumped.outputs.len()).map(|place| format!("{ROBOT}->{GIVEN}[{place}]")).collect();
    let mut code = writer.code(lumped, &[], &places);
    if code.contains(&format!("{GIVEN}[")) && lumped.statements.iter().len() + lumped.outputs.len() > 0 {
        code = statement(1, &format!("const {number} *{GIVEN} = parameters;")) + &code;
    }
    if lumped.outputs.is_empty() {
        code = statement(1, "(void)parameters;")
            + &statement(1, &format!("{ROBOT}->{GIVEN}[0] = {};", writer.scalar.literal(0.0)));
    }
    let init = format!("{}\n{{\n{code}}}\n", head_of_init(writer));
    let default = format!(
        "{}\n{{\n    {}({ROBOT}, {});\n}}\n",
        head_of_default(writer),
        prefix.item("init"),
        prefix.item("parameters")
    );
    let tensors = if has_tensor(interface) { runtime::check_of_inertia(writer.scalar) + "\n" } else { String::new() };
    [tensors + &init, try_init(writer), default].join("\n")
}

fn try_init(writer: &Writer) -> String {
    let (interface, prefix) = (writer.mechanism.interface, writer.prefix);
    let zero = writer.scalar.literal(0.0);
    let np = prefix.constant("NP");
    // All numbers first, so that a tensor is not reported for an element that is not finite.
    let mut text = format!(
        "{}\n{{\n    for (int i = 0; i < {np}; i++) {{\n        if (!isfinite(parameters[i])) {{\n            return i + 1;\n        \
         }}\n    }}\n",
        head_of_try_init(writer)
    );
    let (mut elements, mut components) = (0, 0);
    for (index, parameter) in interface.parameters.iter().enumerate() {
        let holds = match parameter.rule {
            ParameterRule::NotNegative => format!("parameters[{index}] >= {zero}"),
            ParameterRule::Positive => format!("parameters[{index}] > {zero}"),
            ParameterRule::Inertia => {
                elements += 1;
                if elements % 6 != 1 {
                    continue;
                }
                format!("redysim_is_inertia(&parameters[{index}])")
            }
            ParameterRule::Quaternion => {
                components += 1;
                if components % 4 != 1 {
                    continue;
                }
                let is_not_zero = |component: usize| format!("parameters[{}] != {zero}", index + component);
                (0..4).map(is_not_zero).collect::<Vec<_>>().join(" || ")
            }
            _ => continue,
        };
        text += &format!("    if (!({holds})) {{\n        return {};\n    }}\n", index + 1);
    }
    text + &format!("    {}({ROBOT}, parameters);\n    return 0;\n}}\n", prefix.item("init"))
}

/// What a parameter must be, in words.
pub fn rule(rule: ParameterRule) -> &'static str {
    match rule {
        ParameterRule::NotNegative => "a finite number that is not negative",
        ParameterRule::Positive => "a finite number that is positive",
        ParameterRule::Inertia => {
            "an element of the inertia tensor of a body: no principal moment is negative, and none is larger than the sum of the \
             others"
        }
        ParameterRule::Quaternion => {
            "an element of a quaternion x, y, z, w, of which one is not zero: the first stands for all four"
        }
        _ => "a finite number",
    }
}

fn has_tensor(interface: &PublicInterface) -> bool {
    interface.parameters.iter().any(|parameter| parameter.rule == ParameterRule::Inertia)
}

fn head_of_init(writer: &Writer) -> String {
    head(writer, "void", "init")
}

fn head_of_try_init(writer: &Writer) -> String {
    head(writer, "int", "try_init")
}

fn head(writer: &Writer, result: &str, name: &str) -> String {
    let (prefix, number) = (writer.prefix, writer.scalar.type_name());
    let (name, np) = (prefix.item(name), prefix.constant("NP"));
    format!("{result} {name}({}_t *{ROBOT}, const {number} parameters[{np}])", prefix.as_str())
}

fn head_of_default(writer: &Writer) -> String {
    format!("void {}({}_t *{ROBOT})", writer.prefix.item("default"), writer.prefix.as_str())
}
