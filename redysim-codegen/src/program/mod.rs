//! A function as statements over plain expressions: what a backend prints, in whatever language.
//!
//! A program is made once from a graph: a value with a name or more than one use becomes a `let`, a product and a sum
//! become one fused operation, uniform bodies become a loop, and a long function becomes blocks. A backend decides
//! nothing; it prints the program.

mod blocks;
mod build;
mod loops;
mod names;
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

impl Value {
    /// −a, without two signs.
    fn negated(self) -> Value {
        match self {
            Value::Constant(value) => Value::Constant(-value),
            Value::Negative(value) => *value,
            value => Value::Negative(Box::new(value)),
        }
    }

    /// Whether a sign stands in front.
    fn is_negative(&self) -> bool {
        matches!(self, Value::Negative(_)) || matches!(self, Value::Constant(value) if *value < 0.0)
    }

    /// Calls `visit` with every variable in the value.
    fn variables<'a>(&'a self, visit: &mut impl FnMut(&'a str)) {
        match self {
            Value::Variable(name) => visit(name),
            Value::Negative(a) | Value::SquareRoot(a) | Value::Sine(a) | Value::Cosine(a) => a.variables(visit),
            Value::Sum(a, b) | Value::Difference(a, b) | Value::Product(a, b) | Value::Quotient(a, b) => {
                a.variables(visit);
                b.variables(visit);
            }
            Value::MultiplyAdd(a, b, c) => {
                a.variables(visit);
                b.variables(visit);
                c.variables(visit);
            }
            Value::Constant(_)
            | Value::GroupConstant(_)
            | Value::Argument(..)
            | Value::Given(_)
            | Value::Trig(..)
            | Value::LiveOut(..) => {}
        }
    }
}

impl Statement {
    /// Calls `visit` with every variable that the statement reads, its own among them.
    fn reads<'a>(&'a self, visit: &mut impl FnMut(&'a str)) {
        match self {
            Statement::Destructure { .. } => {}
            Statement::Let { value, .. } => value.variables(visit),
            Statement::Block { statements, .. } => statements.iter().for_each(|statement| statement.reads(visit)),
            Statement::Loop(each) => {
                each.carried.iter().for_each(|carried| carried.start.variables(visit));
                each.body.iter().for_each(|statement| statement.reads(visit));
            }
        }
    }
}
