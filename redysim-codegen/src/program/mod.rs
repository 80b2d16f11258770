//! A function as statements over plain expressions: what a backend prints, in whatever language.
//!
//! A program is made once from a graph: a value with a name or more than one use becomes a `let`, a product and a sum
//! become one fused operation, uniform bodies become a loop, branches that are alike become one computation for all of
//! them, and a long function becomes blocks. A backend decides nothing; it prints the program.

mod blocks;
mod build;
mod fusion;
mod loops;
mod names;
mod side_by_side;
#[cfg(test)]
mod tests;
mod values;

pub use build::{NamingContext, program};

/// The body of a function that is given the sines and the cosines of all angles in two arrays.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// The statements, in order.
    pub statements: Vec<Statement>,
    /// What is returned, in the order of the function's [`Shape`](redysim_runtime::function::Shape).
    pub outputs: Vec<Value>,
}

/// One statement. Every variable is defined once, before it is read.
#[derive(Clone, Debug, PartialEq)]
pub enum Statement {
    /// Defines variables for the elements of an array; `None` is not read.
    Destructure {
        /// The array.
        array: Trig,
        /// A variable for each of its elements.
        names: Vec<Option<String>>,
    },
    /// Defines a variable.
    Let {
        /// The variable.
        name: String,
        /// Its value.
        value: Value,
    },
    /// Statements of which only some variables are read later.
    Block {
        /// The statements.
        statements: Vec<Statement>,
        /// The variables read later.
        live_out: Vec<String>,
    },
    /// A loop over groups of uniform bodies.
    Loop(Loop),
    /// The same for each of several branches.
    SideBySide(SideBySide),
}

/// The arrays of the sines and cosines of all angles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trig {
    /// Their sines.
    Sines,
    /// Their cosines.
    Cosines,
}

/// A sweep of a recursion over groups of uniform bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop {
    /// Number of groups.
    pub groups: usize,
    /// Whether it starts at the first group; else at the last.
    pub ascending: bool,
    /// The variables that the loop carries from group to group, and that are read after it.
    pub carried: Vec<Carried>,
    /// The values of every group that are read after the loop.
    pub live_out: Option<LiveOutArray>,
    /// The constants of each group, by rows; empty if there are none.
    pub constants: Vec<Vec<f64>>,
    /// The live-out values of other loops that are read for the same group.
    pub reads: Vec<LoopRead>,
    /// The statements for one group.
    pub body: Vec<Statement>,
}

/// What is computed for each of several branches, one after the other or, in the lanes of a vector, at once. No branch
/// reads what another one computes.
#[derive(Clone, Debug, PartialEq)]
pub struct SideBySide {
    /// The name of the array of its results, a row for each branch.
    pub name: String,
    /// Number of branches.
    pub branches: usize,
    /// What differs from branch to branch or comes from outside.
    pub inputs: Vec<Input>,
    /// The statements for one branch, of inputs and of variables that it defines.
    pub body: Vec<Statement>,
    /// The variables of the body whose values are the columns of the results.
    pub results: Vec<String>,
}

/// A value for each branch.
#[derive(Clone, Debug, PartialEq)]
pub struct Input {
    /// The variable that has it.
    pub name: String,
    /// Its value for each branch, outside.
    pub branches: Vec<Value>,
}

/// A variable that a loop carries from group to group.
#[derive(Clone, Debug, PartialEq)]
pub struct Carried {
    /// The variable.
    pub name: String,
    /// Its value before the loop.
    pub start: Value,
    /// The variable of the loop's body whose value it takes at the end of each group.
    pub next: String,
}

/// What a loop reads of the live-out values of another loop.
#[derive(Clone, Debug, PartialEq)]
pub struct LoopRead {
    /// The array.
    pub array: String,
    /// A variable for each of its columns; `None` is not read.
    pub names: Vec<Option<String>>,
}

/// The array of the values that are read after a loop, a row for each group.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveOutArray {
    /// Its name.
    pub name: String,
    /// The variables of the loop's body whose values are its columns.
    pub columns: Vec<String>,
}

/// A value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A number.
    Constant(f64),
    /// A constant of the group that a loop is at, by its column in the table.
    GroupConstant(usize),
    /// A variable.
    Variable(String),
    /// An element of an argument, which the function's signature numbers.
    Argument(usize, Index),
    /// A number that is given at run time, once for all calls, by its place.
    Given(usize),
    /// An element of an array of sines or cosines.
    Trig(Trig, Index),
    /// An element of the array of values that are read after a loop: array, group, column.
    LiveOut(String, usize, usize),
    /// A result of one of several branches.
    OfBranch {
        /// The array of their results.
        array: String,
        /// How many branches have them.
        branches: usize,
        /// The branch.
        branch: usize,
        /// Which of its results.
        column: usize,
    },
    /// −a.
    Negative(Box<Value>),
    /// a + b.
    Sum(Box<Value>, Box<Value>),
    /// a − b.
    Difference(Box<Value>, Box<Value>),
    /// a b.
    Product(Box<Value>, Box<Value>),
    /// a / b.
    Quotient(Box<Value>, Box<Value>),
    /// a b + c, which may be rounded once.
    MultiplyAdd(Box<Value>, Box<Value>, Box<Value>),
    /// The non-negative square root of a.
    SquareRoot(Box<Value>),
    /// The sine of a.
    Sine(Box<Value>),
    /// The cosine of a.
    Cosine(Box<Value>),
}

/// Where an element stands in an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Index {
    /// At this place.
    At(usize),
    /// In a loop over groups of `period` bodies: at `first + period · group`.
    OfGroup {
        /// The place in the first group.
        first: usize,
        /// Places from group to group.
        period: usize,
    },
}

/// Where a value is read.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Scope {
    /// Outside of loops.
    Outside,
    /// In the loop of this sweep.
    Sweep(usize),
}

impl Program {
    /// Whether a value of the program, or a part of one, `is` as wanted.
    #[cfg(feature = "source")]
    pub fn has(&self, is: &impl Fn(&Value) -> bool) -> bool {
        self.statements.iter().any(|statement| statement.has(is)) || self.outputs.iter().any(|output| output.has(is))
    }
}

impl Value {
    /// Whether the value, or a part of it, `is` as wanted.
    #[cfg(feature = "source")]
    fn has(&self, is: &impl Fn(&Value) -> bool) -> bool {
        is(self) || self.operands().into_iter().flatten().any(|operand| operand.has(is))
    }

    /// Whether it is the number 0.
    pub fn is_zero(&self) -> bool {
        *self == Value::Constant(0.0)
    }

    /// −a, without two signs.
    fn negated(self) -> Value {
        match self {
            Value::Constant(value) => Value::Constant(-value),
            Value::Negative(value) => *value,
            value => Value::Negative(Box::new(value)),
        }
    }

    /// a + b, as a difference where one of them has a sign.
    fn sum(a: Value, b: Value) -> Value {
        let (a, b) = if a.is_negative() && !b.is_negative() { (b, a) } else { (a, b) };
        if b.is_negative() {
            Value::Difference(Box::new(a), Box::new(b.negated()))
        } else {
            Value::Sum(Box::new(a), Box::new(b))
        }
    }

    /// Whether a sign stands in front.
    fn is_negative(&self) -> bool {
        matches!(self, Value::Negative(_)) || matches!(self, Value::Constant(value) if *value < 0.0)
    }

    /// Calls `visit` with every variable in the value.
    pub fn variables<'a>(&'a self, visit: &mut impl FnMut(&'a str)) {
        match self {
            Value::Variable(name) => visit(name),
            _ => self.operands().into_iter().flatten().for_each(|operand| operand.variables(visit)),
        }
    }

    /// The values that it is computed from.
    pub fn operands(&self) -> [Option<&Value>; 3] {
        match self {
            Value::Negative(a) | Value::SquareRoot(a) | Value::Sine(a) | Value::Cosine(a) => [Some(a), None, None],
            Value::Sum(a, b) | Value::Difference(a, b) | Value::Product(a, b) | Value::Quotient(a, b) => {
                [Some(a), Some(b), None]
            }
            Value::MultiplyAdd(a, b, c) => [Some(a), Some(b), Some(c)],
            Value::Constant(_)
            | Value::GroupConstant(_)
            | Value::Variable(_)
            | Value::Argument(..)
            | Value::Given(_)
            | Value::Trig(..)
            | Value::LiveOut(..)
            | Value::OfBranch { .. } => [None; 3],
        }
    }
}

impl Statement {
    /// Whether a value of the statement, or a part of one, `is` as wanted.
    #[cfg(feature = "source")]
    fn has(&self, is: &impl Fn(&Value) -> bool) -> bool {
        match self {
            Statement::Destructure { .. } => false,
            Statement::Let { value, .. } => value.has(is),
            Statement::Block { statements, .. } => statements.iter().any(|statement| statement.has(is)),
            Statement::Loop(sweep) => {
                sweep.carried.iter().any(|carried| carried.start.has(is))
                    || sweep.body.iter().any(|statement| statement.has(is))
            }
            Statement::SideBySide(SideBySide { inputs, body, .. }) => {
                inputs.iter().flat_map(|input| &input.branches).any(|value| value.has(is))
                    || body.iter().any(|statement| statement.has(is))
            }
        }
    }

    /// Calls `visit` with every variable that the statement reads, its own among them.
    pub(crate) fn reads<'a>(&'a self, visit: &mut impl FnMut(&'a str)) {
        match self {
            Statement::Destructure { .. } => {}
            Statement::Let { value, .. } => value.variables(visit),
            Statement::Block { statements, .. } => statements.iter().for_each(|statement| statement.reads(visit)),
            Statement::Loop(each) => {
                each.carried.iter().for_each(|carried| carried.start.variables(visit));
                each.body.iter().for_each(|statement| statement.reads(visit));
            }
            Statement::SideBySide(SideBySide { inputs, .. }) => {
                inputs.iter().flat_map(|input| &input.branches).for_each(|value| value.variables(visit));
            }
        }
    }
}
