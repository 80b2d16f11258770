//! A program that checks a compiled mechanism: it calls every function at a few states, and compares the results with those
//! of the run-time path, which were computed in double-double arithmetic.
//!
//! How far a result may be off is a bound of the rounding errors of its own operations at that state (running error
//! analysis), whatever the order of roundings, and so holds for every compiler, with and without fused multiply-add, and
//! for sines of one unit in the last place.

use super::comment::statement;
use super::function::Writer;
use super::results::InC;
use super::scalar::CScalar;
use crate::accuracy::both::Both;
use crate::functions::TracedFunction;
use crate::generate::TracedMechanism;
use crate::random::Random;
use redysim_model::denoc::{self, Untraced};
use redysim_model::{CodegenOptions, Function, Model, Tree};
use redysim_runtime::ParameterRule;
use redysim_runtime::function::Argument;

/// The states at which functions are called. The last has angles of many turns.
pub const STATES: usize = 3;
/// Roundings of constants that a description of the robot has computed with more of them than the bounds assume.
const SLACK: f64 = 4.0;
/// The same where a constant is a small difference of large ones: roundings of the largest value of the function.
const OF_CONSTANTS: f64 = 8.0;
/// What is smaller than this vanishes, as the roundings of double-double arithmetic do.
const VANISHING: f64 = 1e-30;

/// A state: the numbers of every argument.
pub type State = Vec<(Argument, Vec<f64>)>;

/// A value that a function should give, and how far the given one may be off.
#[derive(Clone, Copy, Debug)]
pub struct Expected {
    pub value: f64,
    pub bound: f64,
}

/// The values that functions should give at the states of the check.
pub struct Reference {
    /// The states.
    pub states: Vec<State>,
    /// The parameters at all states but the first, which has those of the model.
    pub parameters: Vec<f64>,
    /// For each function, its values at each state.
    pub values: Vec<(Function, Vec<Vec<Expected>>)>,
}

impl Reference {
    /// The values of the functions of a mechanism.
    pub fn new(model: &Model, options: &CodegenOptions, traced: &TracedMechanism, scalar: CScalar) -> Reference {
        let tree = Tree::new(model);
        let states: Vec<State> = (0..STATES).map(|index| state(&tree, index, scalar)).collect();
        let parameters = other_parameters(model, options, scalar);
        let values = traced.functions.iter().map(|traced_function| {
            let at = |(index, state): (usize, &State)| {
                // The robot of the model first, then another one.
                let given = if index == 0 { parameters_of(model, options, scalar) } else { parameters.clone() };
                let tree = Tree::with_parameters(model, &options.parameters, &given);
                expected(traced_function, traced, &tree, &given, state, scalar)
            };
            (traced_function.function, states.iter().enumerate().map(at).collect())
        });
        Reference { values: values.collect(), states, parameters }
    }
}

/// Numbers within ±1, ±3 of velocities, ±10 of accelerations and forces; angles within ±3, or ±100 in the last state.
fn state(tree: &Tree, index: usize, scalar: CScalar) -> State {
    let mut random = Random::new(index as u64 + 1);
    let scale = |argument: Argument| match argument {
        Argument::Coordinates if index + 1 == STATES => 100.0,
        Argument::Coordinates | Argument::Start | Argument::End | Argument::Velocities => 3.0,
        Argument::Displacement => 1.0,
        Argument::Accelerations | Argument::Forces | Argument::Given | Argument::Wrenches => 10.0,
    };
    let numbers = |argument: Argument| {
        let numbers =
            (0..tree.argument_length(argument)).map(|_| scalar.rounded(scale(argument) * random.share(false)));
        (argument, numbers.collect())
    };
    Argument::ALL.into_iter().map(numbers).collect()
}

/// The parameters of the model.
fn parameters_of(model: &Model, options: &CodegenOptions, scalar: CScalar) -> Vec<f64> {
    let values = options.parameters.iter().flat_map(|parameter| parameter.values(model));
    values.map(|value| scalar.rounded(value)).collect()
}

/// Parameters of another robot that keep all rules: inertias and the like are a quarter larger, all else is a quarter
/// smaller.
fn other_parameters(model: &Model, options: &CodegenOptions, scalar: CScalar) -> Vec<f64> {
    let factor = |rule: ParameterRule| if rule == ParameterRule::Finite { 0.75 } else { 1.25 };
    let values = options.parameters.iter().flat_map(|parameter| {
        let numbers = parameter.numbers(model).zip(parameter.values(model));
        numbers.map(|((_, rule), value)| factor(rule) * value)
    });
    values.map(|value| scalar.rounded(value)).collect()
}

/// What a function should give at a state.
fn expected(
    traced: &TracedFunction,
    mechanism: &TracedMechanism,
    tree: &Tree,
    parameters: &[f64],
    state: &State,
    scalar: CScalar,
) -> Vec<Expected> {
    let TracedFunction { function, expressions, pruning, .. } = traced;
    let arguments: Vec<&Vec<f64>> =
        function.signature().arguments.iter().map(|argument| numbers(state, *argument)).collect();
    let given: Vec<Vec<Both>> =
        arguments.iter().map(|numbers| numbers.iter().map(|&number| Both::given(number)).collect()).collect();
    let given: Vec<&[Both]> = given.iter().map(Vec::as_slice).collect();
    let lumped = mechanism
        .lumped
        .as_ref()
        .map_or(Vec::new(), |lumped| lumped.evaluate_with(&[], |index, _| Both::given(parameters[index as usize])));
    let found = expressions.evaluate_with(&given, |index, _| lumped[index as usize]);
    let by_tree = denoc::evaluate(*function, tree, &Untraced, &given);
    // A pruned function differs from the run-time path by more than roundings: what is checked is how it was compiled.
    let is_pruned = pruning.as_ref().is_some_and(|pruning| pruning.holds);
    let values = if is_pruned { &found } else { &by_tree }.iter().map(|value| value.exact.to_f64());
    let values: Vec<f64> = values.collect();
    // To first order, bounds of rounding errors are as large as the errors of one operation.
    let unit = match scalar {
        CScalar::F64 => 1.0,
        CScalar::F32 => f64::from(f32::EPSILON) / f64::EPSILON,
    };
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let of_constants = OF_CONSTANTS * largest * unit * f64::EPSILON + VANISHING;
    // What constants of the run-time path have been rounded to counts there alone: the compiled one may cancel them.
    let bound = |found: &Both, by_tree: &Both| {
        SLACK * unit * found.rounded.error_bound().max(by_tree.rounded.error_bound()) + of_constants
    };
    let bounds = found.iter().zip(&by_tree).map(|(found, by_tree)| bound(found, by_tree));
    values.into_iter().zip(bounds).map(|(value, bound)| Expected { value, bound }).collect()
}

/// The numbers of an argument in a state.
pub fn numbers(state: &State, argument: Argument) -> &Vec<f64> {
    let numbers = state.iter().find(|(other, _)| *other == argument).map(|(_, numbers)| numbers);
    numbers.expect("a state has every argument")
}

/// The program.
pub fn program(writer: &Writer, reference: &Reference, head: &str) -> String {
    let (prefix, number) = (writer.prefix, writer.scalar.type_name());
    let functions: Vec<Function> = writer.functions().map(|program| program.function).collect();
    let mut text = format!(
        "{head}/*\n * Calls every function of {0}.c at {STATES} states, and compares the results with those of redysim's run-time path.\n \
         * Exits with 0, or names the functions and elements that are off. KR5_CHECK_SLACK multiplies the errors that are\n \
         * allowed, for sines of less than full precision.\n */\n#include \"{0}.h\"\n\n#include <stdio.h>\n\n#ifndef {1}\n#define {1} \
         1.0\n#endif\n\n",
        prefix.as_str(),
        prefix.constant("CHECK_SLACK"),
    )
    .replace("KR5_CHECK_SLACK", &prefix.constant("CHECK_SLACK"));
    for argument in
        Argument::ALL.into_iter().filter(|argument| functions.iter().any(|function| takes(*function, *argument)))
    {
        text += &states(writer, reference, argument);
    }
    if writer.is_parametric() {
        let values =
            reference.parameters.iter().map(|&value| writer.scalar.literal(value)).collect::<Vec<_>>().join(", ");
        text += &statement(0, &format!("static const {number} parameters[{}] = {{{values}}};", prefix.constant("NP")));
    }
    for function in &functions {
        text += &table(reference, *function);
    }
    text += &COMPARE.replace("@number@", number).replace("@SLACK@", &prefix.constant("CHECK_SLACK"));
    for program in writer.functions() {
        text += &check(writer, program.function, writer.has_form_with_trig(program));
    }
    text + &main(writer, &functions)
}

/// Whether a function has an argument.
pub fn takes(function: Function, argument: Argument) -> bool {
    function.signature().arguments.contains(&argument)
}

/// The table of an argument at all states.
fn states(writer: &Writer, reference: &Reference, argument: Argument) -> String {
    let literal =
        |numbers: &[f64]| numbers.iter().map(|&number| writer.scalar.literal(number)).collect::<Vec<_>>().join(", ");
    let rows = reference.states.iter().map(|state| match numbers(state, argument) {
        numbers if argument == Argument::Wrenches => {
            let wrenches = numbers
                .chunks(6)
                .map(|wrench| format!("{{{{{}}}, {{{}}}}}", literal(&wrench[..3]), literal(&wrench[3..])));
            wrenches.collect::<Vec<_>>().join(", ")
        }
        numbers => literal(numbers),
    });
    let rows: String = rows.map(|row| statement(1, &format!("{{{row}}},"))).collect();
    let (element, length) = writer.element_and_length(argument);
    format!("static const {element} {}[{STATES}][{length}] = {{\n{rows}}};\n", table_of(argument))
}

/// The name of the table of an argument.
fn table_of(argument: Argument) -> String {
    format!("all_{}", argument.name())
}

/// The values that a function should give, and how far they may be off.
fn table(reference: &Reference, function: Function) -> String {
    let values = &reference.values.iter().find(|(other, _)| *other == function).expect("every function has values").1;
    let count = values.first().map_or(0, Vec::len);
    let pair = |expected: &Expected| {
        // Two digits, rounded up.
        let bound = if expected.bound.is_finite() { format!("{:.1e}", 1.1 * expected.bound) } else { "1e300".into() };
        format!("{{{}, {bound}}}", CScalar::F64.literal(expected.value))
    };
    let rows = values.iter().map(|values| {
        let pairs: Vec<String> = values.iter().map(pair).collect();
        statement(1, &format!("{{{}}},", pairs.join(", ")))
    });
    let rows: String = rows.collect();
    format!("static const double expected_{}[{STATES}][{count}][2] = {{\n{rows}}};\n", function.name())
}

/// Compares numbers with those that are expected.
const COMPARE: &str = r#"
/* How many of the numbers are off. */
static int compare(const char *function, int state, int count, const @number@ *found, const double (*expected)[2])
{
    int faults = 0;
    for (int i = 0; i < count; i++) {
        const double difference = (double)found[i] - expected[i][0];
        const double bound = @SLACK@ * expected[i][1];
        if (!(difference <= bound && -difference <= bound)) {
            fprintf(stderr, "%s: state %d, element %d is %.17g instead of %.17g, where rounding errors are at most %.1e\n", function,
                state, i, (double)found[i], expected[i][0], bound);
            faults++;
        }
    }
    return faults;
}
"#;

/// The function that checks one function at a state.
fn check(writer: &Writer, function: Function, with_trig: bool) -> String {
    let (prefix, result) = (writer.prefix, function.signature().result.form());
    let count = result.places(writer.mechanism.interface).len();
    let arguments: Vec<String> =
        function.signature().arguments.iter().map(|argument| format!("{}[state]", table_of(*argument))).collect();
    let robot = if writer.is_parametric() { "robot, " } else { "" };
    let mut text = format!("\nstatic int check_{}({}int state)\n{{\n", function.name(), writer.robot());
    let (element, name) = (result.element(writer.scalar.type_name(), prefix), result.name);
    let brackets = super::results::brackets(result.lengths, prefix);
    text += &statement(1, &format!("{element} {name}{brackets};"));
    if with_trig {
        text += &statement(1, &format!("{} trig;", prefix.type_of("joint_trig")));
    }
    text += &statement(1, "int faults;");
    let (address, first) = if result.lengths.is_empty() {
        (format!("&{name}"), format!("&{name}"))
    } else {
        (name.to_string(), format!("&{name}{}", "[0]".repeat(result.lengths.len())))
    };
    let first =
        if result.structure.is_some() { format!("(const {} *){first}", writer.scalar.type_name()) } else { first };
    let compared = |called: &str, arguments: &[String], assigned: &str| {
        let list: String = arguments.iter().map(|argument| format!("{argument}, ")).collect();
        let name = super::comment::string(called);
        let expected = format!("expected_{}[state]", function.name());
        statement(1, &format!("{called}({robot}{list}{address});"))
            + &statement(1, &format!("{assigned} compare({name}, state, {count}, {first}, {expected});"))
    };
    text += &compared(&prefix.item(function.name()), &arguments, "faults =");
    if with_trig {
        text += &statement(1, &format!("{}({robot}{}, &trig);", prefix.item("joint_trig"), arguments[0]));
        let others: Vec<String> = std::iter::once("&trig".into()).chain(arguments.iter().skip(1).cloned()).collect();
        text += &compared(&prefix.item(&format!("{}_with_trig", function.name())), &others, "faults +=");
    }
    text + "    return faults;\n}\n"
}

fn main(writer: &Writer, functions: &[Function]) -> String {
    let (prefix, mut text) = (writer.prefix, String::from("\nint main(void)\n{\n    int faults = 0;\n"));
    let argument = if writer.is_parametric() {
        let name = prefix.as_str();
        text += &statement(1, &format!("{name}_t robot;"));
        text += &statement(1, &format!("{name}_default(&robot);"));
        "&robot, "
    } else {
        ""
    };
    text += &statement(1, &format!("for (int state = 0; state < {STATES}; state++) {{"));
    for function in functions {
        text += &statement(2, &format!("faults += check_{}({argument}state);", function.name()));
    }
    if writer.is_parametric() {
        let (name, try_init) = (prefix.as_str(), prefix.item("try_init"));
        text += &statement(2, "/* The other states are those of another robot. */");
        text += &statement(2, &format!("if ({name}_try_init(&robot, parameters) != 0) {{"));
        text += &statement(3, &format!("fprintf(stderr, \"{try_init} refuses the parameters of a robot\\n\");"));
        text += &statement(3, "faults++;");
        text += &statement(2, "}");
    }
    text += &statement(1, "}");
    text + "    printf(\"%s: %d of the results are off\\n\", "
        + &prefix.constant("NAME")
        + ", faults);\n    return faults == 0 ? 0 : 1;\n}\n"
}
