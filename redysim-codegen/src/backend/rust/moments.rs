//! Moments of a program: when what it computes is known, and when it reads its sines.

use crate::program::{Loop, Program, Statement, Value};
use std::collections::HashMap;

/// A moment of a program: before or after a statement, or a branch of one that computes branches side by side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Moment {
    /// The number of the statement, from 1 on; 0 is before all of them.
    pub statement: usize,
    /// The branch.
    pub branch: usize,
}

/// When the variables and arrays of a program are known.
pub struct Known<'p>(HashMap<&'p str, usize>);

impl<'p> Known<'p> {
    /// Those of this program.
    pub fn in_program(program: &'p Program) -> Self {
        let mut known = HashMap::new();
        for (number, statement) in (1..).zip(&program.statements) {
            let mut define = |name: &'p String| _ = known.insert(name.as_str(), number);
            match statement {
                Statement::Destructure { names, .. } => names.iter().flatten().for_each(define),
                Statement::Let { name, .. } => define(name),
                Statement::Block { live_out, .. } => live_out.iter().for_each(define),
                Statement::Loop(Loop { carried, live_out, .. }) => {
                    carried.iter().map(|carried| &carried.name).for_each(&mut define);
                    live_out.iter().map(|array| &array.name).for_each(define);
                }
                Statement::SideBySide(side_by_side) => define(&side_by_side.name),
            }
        }
        Known(known)
    }

    /// The moment after which a value is known, and the column of the last result of that branch that it is computed from.
    pub fn value(&self, value: &Value) -> (Moment, usize) {
        let statement = |name: &String| self.0.get(name.as_str()).copied().unwrap_or_default();
        match value {
            Value::Variable(name) | Value::LiveOut(name, ..) => (Moment { statement: statement(name), branch: 0 }, 0),
            Value::OfBranch { array, branch, column, .. } => {
                (Moment { statement: statement(array), branch: *branch }, *column)
            }
            _ => value.operands().into_iter().flatten().map(|operand| self.value(operand)).max().unwrap_or_default(),
        }
    }
}
