//! The body of a function as C: its program, printed as statements and expressions.

use super::comment::statement;
use super::scalar::Numbers;
use crate::backend::binding::Binding;
use crate::program::{Carried, Index, Input, LiveOutArray, Loop, LoopRead, SideBySide, Statement, Trig, Value};

/// The names of the arrays of the sines and the cosines of all angles.
pub const SINES: &str = "sines";
pub const COSINES: &str = "cosines";
/// The name of the array of the numbers that are given at run time.
pub const GIVEN: &str = "given";
/// The variable of a loop: which group of bodies it is at.
const GROUP: &str = "group";
/// What follows the name of an input of branches in that of the array with its value for each of them.
const OF_BRANCHES: &str = "_of_branches";
/// The constants of the groups.
const TABLE: &str = "constants";

/// Names that variables must not have, beside those of arguments: what is defined around them, and macros that `math.h`
/// has in some modes of compilers.
pub const RESERVED: [&str; 28] = [
    GIVEN,
    SINES,
    COSINES,
    GROUP,
    TABLE,
    "robot",
    "trig",
    "parameters",
    "result",
    "matrix",
    "jacobian",
    "jacobians",
    "links",
    "frames",
    "wrench_numbers",
    "M_E",
    "M_LOG2E",
    "M_LOG10E",
    "M_LN2",
    "M_LN10",
    "M_PI",
    "M_PI_2",
    "M_PI_4",
    "M_1_PI",
    "M_2_PI",
    "M_2_SQRTPI",
    "M_SQRT2",
    "M_SQRT1_2",
];

/// Prints statements and values.
#[derive(Clone, Copy)]
pub struct Printer<'a> {
    pub numbers: Numbers,
    /// The names of the arrays of the function's arguments.
    pub arguments: &'a [&'a str],
}

impl Printer<'_> {
    /// Statements at a depth of indentation.
    pub fn statements(&self, statements: &[Statement], indent: usize) -> String {
        statements.iter().map(|each| self.statement(each, indent)).collect()
    }

    fn statement(&self, each: &Statement, indent: usize) -> String {
        match each {
            Statement::Destructure { array, names } => {
                self.elements(names, indent, |place| format!("{}[{place}]", trig(*array)))
            }
            Statement::Let { name, value } => self.definition(name, &self.whole(value), indent),
            // C has no limit that would take blocks, and every variable has a name of its own.
            Statement::Block { statements, .. } => self.statements(statements, indent),
            Statement::Loop(sweep) => self.sweep(sweep, indent),
            Statement::SideBySide(each) => self.side_by_side(each, indent),
        }
    }

    /// `const double name = value;`
    pub fn definition(&self, name: &str, value: &str, indent: usize) -> String {
        statement(indent, &format!("const {} {name} = {value};", self.numbers.type_name()))
    }

    /// Definitions of variables for the elements of an array that are read.
    fn elements(&self, names: &[Option<String>], indent: usize, element: impl Fn(usize) -> String) -> String {
        let named = names.iter().enumerate().filter_map(|(place, name)| Some((place, name.as_ref()?)));
        named.map(|(place, name)| self.definition(name, &element(place), indent)).collect()
    }

    /// ```text
    /// double last_w_a_x = w_link2_x;                // carried from body to body
    /// double outward[38][2];                        // live-out: read after the loop
    /// {
    ///     static const double constants[38][3] = {…};
    ///     for (int group = 0; group < 38; group++) {
    ///         const double w_a_x = …;
    ///         last_w_a_x = w_a_x;
    ///         outward[group][0] = force_a_x;
    ///     }
    /// }
    /// ```
    fn sweep(&self, sweep: &Loop, indent: usize) -> String {
        let Loop { groups, ascending, carried, live_out, constants, reads, body } = sweep;
        let number = self.numbers.type_name();
        let mut text = String::new();
        for Carried { name, start, .. } in carried {
            text += &statement(indent, &format!("{number} {name} = {};", self.whole(start)));
        }
        if let Some(LiveOutArray { name, columns }) = live_out {
            text += &statement(indent, &format!("{number} {name}[{groups}][{}];", columns.len()));
        }
        text += &statement(indent, "{");
        text += &self.table(constants, indent + 1);
        let head = if *ascending {
            format!("for (int {GROUP} = 0; {GROUP} < {groups}; {GROUP}++) {{")
        } else {
            format!("for (int {GROUP} = {}; {GROUP} >= 0; {GROUP}--) {{", groups.saturating_sub(1))
        };
        text += &statement(indent + 1, &head);
        for LoopRead { array, names } in reads {
            text += &self.elements(names, indent + 2, |column| format!("{array}[{GROUP}][{column}]"));
        }
        text += &self.statements(body, indent + 2);
        for Carried { name, next, .. } in carried {
            text += &statement(indent + 2, &format!("{name} = {next};"));
        }
        if let Some(LiveOutArray { name, columns }) = live_out {
            for (column, value) in columns.iter().enumerate() {
                text += &statement(indent + 2, &format!("{name}[{GROUP}][{column}] = {value};"));
            }
        }
        text + &statement(indent + 1, "}") + &statement(indent, "}")
    }

    /// ```text
    /// redysim_four branches[2][REDYSIM_FOURS(4)];   // results: read after the loop
    /// {
    ///     static const redysim_four each1_of_branches[] = {REDYSIM_FOUR(0.1, …)};
    ///     const redysim_four v_hip_of_branches[] = {REDYSIM_FOUR(v[6], v[9], v[12], v[15])};
    ///     for (int group = 0; group < REDYSIM_FOURS(4); group++) {
    ///         const redysim_four each1 = each1_of_branches[group];
    ///         const redysim_four v_hip = v_hip_of_branches[group];
    ///         const redysim_four w_thigh_x = each1 * v_hip;
    ///         branches[0][group] = w_thigh_x;
    ///     }
    /// }
    /// ```
    ///
    /// Of numbers of several states, there are as many groups as branches.
    fn side_by_side(&self, each: &SideBySide, indent: usize) -> String {
        let SideBySide { name, branches, inputs, body, results } = each;
        let numbers = self.numbers.of_branches(*branches);
        let within = Printer { numbers, ..*self };
        let (number, groups) = (numbers.type_name(), numbers.groups(*branches));
        let mut text = statement(indent, &format!("{number} {name}[{}][{groups}];", results.len().max(1)));
        text += &statement(indent, "{");
        for Input { name, branches } in inputs {
            let (kind, values): (_, Vec<String>) = if are_constants(branches) {
                let kind = if numbers == Numbers::Lanes { numbers.constant().type_name() } else { number };
                let values = branches.iter().map(|value| self.value(value, Binding::Lowest)).collect();
                (format!("static const {kind}"), values)
            } else {
                (format!("const {number}"), branches.iter().map(|value| self.whole(value)).collect())
            };
            let values = numbers.initialiser(values);
            text += &statement(indent + 1, &format!("{kind} {name}{OF_BRANCHES}[] = {{{values}}};"));
        }
        text += &statement(indent + 1, &format!("for (int {GROUP} = 0; {GROUP} < {groups}; {GROUP}++) {{"));
        for Input { name, branches } in inputs {
            let value = format!("{name}{OF_BRANCHES}[{GROUP}]");
            let is_number = numbers == Numbers::Lanes && are_constants(branches);
            let value = if is_number { numbers.of_constants(value) } else { value };
            text += &within.definition(name, &value, indent + 2);
        }
        text += &within.statements(body, indent + 2);
        for (column, value) in results.iter().enumerate() {
            text += &statement(indent + 2, &format!("{name}[{column}][{GROUP}] = {value};"));
        }
        text + &statement(indent + 1, "}") + &statement(indent, "}")
    }

    /// The constants of all groups, by rows.
    fn table(&self, rows: &[Vec<f64>], indent: usize) -> String {
        let Some(first) = rows.first() else { return String::new() };
        let (number, length, width) = (self.numbers.constant().type_name(), rows.len(), first.len());
        let mut text = statement(indent, &format!("static const {number} {TABLE}[{length}][{width}] = {{"));
        for row in rows {
            let values: Vec<String> = row.iter().map(|&value| self.numbers.constant().literal(value)).collect();
            text += &statement(indent + 1, &format!("{{{}}},", values.join(", ")));
        }
        text + &statement(indent, "};")
    }

    /// A value as that of a variable.
    pub fn whole(&self, value: &Value) -> String {
        let text = self.value(value, Binding::Lowest);
        if is_of_constants(value) { self.numbers.of_constants(text) } else { text }
    }

    /// A value as an expression, within which constants are numbers.
    pub fn value(&self, value: &Value, binding: Binding) -> String {
        let operand = |value: &Value, binding| self.value(value, binding);
        let lowest = |value: &Value| self.value(value, Binding::Lowest);
        let (own, text) = match value {
            Value::Constant(value) => return self.numbers.constant().literal(*value),
            Value::GroupConstant(column) => return format!("{TABLE}[{GROUP}][{column}]"),
            Value::Variable(name) => return name.clone(),
            Value::Argument(argument, place) => return format!("{}[{}]", self.arguments[*argument], index(*place)),
            Value::Given(place) => return format!("{GIVEN}[{place}]"),
            Value::Trig(array, place) => return format!("{}[{}]", trig(*array), index(*place)),
            Value::LiveOut(array, group, column) => return format!("{array}[{group}][{column}]"),
            Value::OfBranch { array, branches, branch, column } => {
                return self.numbers.of_branches(*branches).of_branch(&format!("{array}[{column}]"), *branch);
            }
            Value::Negative(a) => {
                let a = operand(a, Binding::Unary);
                // Two signs that touch would be a decrement.
                return if a.starts_with('-') { format!("-({a})") } else { format!("-{a}") };
            }
            Value::MultiplyAdd(a, b, c) => {
                return format!("{}({}, {}, {})", self.numbers.multiply_add(), lowest(a), lowest(b), lowest(c));
            }
            Value::SquareRoot(a) => return format!("{}({})", self.numbers.square_root(), self.whole(a)),
            Value::Sine(a) => return format!("{}({})", self.numbers.trigonometry("sine"), self.whole(a)),
            Value::Cosine(a) => return format!("{}({})", self.numbers.trigonometry("cosine"), self.whole(a)),
            Value::Sum(a, b) => (Binding::Sum, format!("{} + {}", lowest(a), operand(b, Binding::Sum))),
            Value::Difference(a, b) => (Binding::Sum, format!("{} - {}", lowest(a), operand(b, Binding::Sum))),
            Value::Product(a, b) => {
                (Binding::Product, format!("{} * {}", operand(a, Binding::Sum), operand(b, Binding::Product)))
            }
            Value::Quotient(a, b) => {
                (Binding::Product, format!("{} / {}", operand(a, Binding::Sum), operand(b, Binding::Product)))
            }
        };
        if own.needs_parentheses(binding) { format!("({text})") } else { text }
    }
}

fn are_constants(values: &[Value]) -> bool {
    values.iter().all(|value| matches!(value, Value::Constant(_)))
}

/// Whether a value is computed from constants alone.
fn is_of_constants(value: &Value) -> bool {
    match value {
        Value::Constant(_) | Value::GroupConstant(_) => true,
        _ => {
            let mut operands = value.operands().into_iter().flatten().peekable();
            operands.peek().is_some() && operands.all(is_of_constants)
        }
    }
}

fn trig(array: Trig) -> &'static str {
    match array {
        Trig::Sines => SINES,
        Trig::Cosines => COSINES,
    }
}

fn index(index: Index) -> String {
    match index {
        Index::At(place) => place.to_string(),
        Index::OfGroup { first: 0, period: 1 } => GROUP.to_string(),
        Index::OfGroup { first: 0, period } => format!("{period} * {GROUP}"),
        Index::OfGroup { first, period: 1 } => format!("{GROUP} + {first}"),
        Index::OfGroup { first, period } => format!("{period} * {GROUP} + {first}"),
    }
}
