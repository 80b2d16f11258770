//! Moments of a program: when what it computes is known, and when it reads its sines.

use crate::program::{Loop, Program, Statement, Value};
use std::collections::HashMap;

/// A moment after a statement and, if that computes branches side by side, after a result of a branch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Moment {
    /// How many statements come before it.
    pub statements: usize,
    /// The branch of the last of them.
    pub branch: usize,
    /// The result of the branch; `None` before the first one.
    pub result: Option<usize>,
}

impl Moment {
    /// After all results of a branch.
    pub fn after(statements: usize, branch: usize) -> Moment {
        Moment { statements, branch, result: Some(usize::MAX) }
    }
}

/// When the variables and arrays of a program are known.
pub struct Known<'p>(HashMap<&'p str, usize>);

impl<'p> Known<'p> {
    /// Those of this program.
    pub fn in_program(program: &'p Program) -> Self {
        let mut known = HashMap::new();
        for (statements, statement) in (1..).zip(&program.statements) {
            let mut define = |name: &'p String| _ = known.insert(name.as_str(), statements);
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

    /// When a value is known: that of a branch, or its negative, with the result of the branch; another one after the
    /// statement or the branch that gives the last of what it is computed from.
    pub fn value(&self, value: &Value) -> Moment {
        match value {
            Value::OfBranch { column, .. } => Moment { result: Some(*column), ..self.last(value) },
            Value::Negative(a) => self.value(a),
            _ => self.last(value),
        }
    }

    fn last(&self, value: &Value) -> Moment {
        let statements = |name: &String| self.0.get(name.as_str()).copied().unwrap_or_default();
        match value {
            Value::Variable(name) | Value::LiveOut(name, ..) => Moment::after(statements(name), 0),
            Value::OfBranch { array, branch, .. } => Moment::after(statements(array), *branch),
            _ => value.operands().into_iter().flatten().map(|operand| self.last(operand)).max().unwrap_or_default(),
        }
    }
}
