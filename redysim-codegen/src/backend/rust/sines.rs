//! Sines and cosines that a function computes when it is about to read them: those of a branch before the branch, so that
//! lanes neither keep those of all branches in registers nor write results while there is nothing left to compute.

use super::body::{SINES, local};
use super::moments::Moment;
use super::values::trig;
use crate::mechanism::TrigProgram;
use crate::program::{Program, SideBySide, Statement, Trig};
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use redysim_runtime::MOST_SINES;
use std::collections::HashMap;

/// When a function computes the sine and the cosine of each angle. Angles are numbered as in the function's `TrigProgram`.
#[derive(Debug, PartialEq)]
pub struct SinesWhenRead {
    /// How many angles there are.
    pub angles: usize,
    /// Those that are computed before a branch, or before the first statement.
    before: HashMap<Moment, Vec<usize>>,
    /// The place of each variable that is a sine or a cosine among those of the function.
    places: HashMap<String, (Trig, usize)>,
}

impl SinesWhenRead {
    /// The moments of a function that needs the angles of `trig`; `None` if it reads no sine first in a branch.
    pub fn of(trig: &TrigProgram, program: &Program) -> Option<SinesWhenRead> {
        let mut sines = SinesWhenRead { angles: trig.angles.len(), before: HashMap::new(), places: HashMap::new() };
        for statement in &program.statements {
            if let Statement::Destructure { array, names } = statement {
                let named = names.iter().zip(&trig.places).filter_map(|(name, place)| Some((name.clone()?, (*place)?)));
                sines.places.extend(named.map(|(name, place)| (name, (*array, place))));
            }
        }
        let mut known = vec![false; trig.angles.len()];
        // An output may be written before any branch.
        for output in &program.outputs {
            output.variables(&mut |name| sines.read(name, Moment::default(), &mut known));
        }
        for (number, statement) in (1..).zip(&program.statements) {
            if let Statement::SideBySide(SideBySide { branches, inputs, .. }) = statement {
                for branch in 0..*branches {
                    let moment = Moment { statement: number, branch };
                    let values = inputs.iter().map(|input| &input.branches[branch]);
                    values.for_each(|value| value.variables(&mut |name| sines.read(name, moment, &mut known)));
                }
            } else {
                statement.reads(&mut |name| sines.read(name, Moment::default(), &mut known));
            }
        }
        let read_by_branches = sines.before.keys().any(|moment| moment.statement > 0);
        let others = (0..known.len()).filter(|&angle| !known[angle]);
        sines.before.entry(Moment::default()).or_default().extend(others);
        read_by_branches.then_some(sines)
    }

    fn read(&mut self, name: &str, moment: Moment, known: &mut [bool]) {
        if let Some(&(_, angle)) = self.places.get(name)
            && !std::mem::replace(&mut known[angle], true)
        {
            self.before.entry(moment).or_default().push(angle);
        }
    }

    /// The code that computes those that are computed before this moment.
    pub fn computed_before(&self, moment: Moment) -> TokenStream {
        let (sines, angles) = (local(SINES), self.before.get(&moment).map_or(&[][..], Vec::as_slice));
        let calls = angles.chunks(MOST_SINES).map(|angles| {
            let angles = angles.iter().copied().map(Literal::usize_unsuffixed);
            quote!(#sines.compute([#(#angles),*]);)
        });
        quote!(#(#calls)*)
    }

    /// What stands for each variable that is a sine or a cosine.
    pub fn expressions(&self) -> HashMap<String, TokenStream> {
        let expression = |(name, &(array, place)): (&String, &(Trig, usize))| {
            let (sines, place) = (local(SINES), Literal::usize_unsuffixed(place));
            let field = trig(array);
            (name.clone(), quote!(#sines.#field[#place]))
        };
        self.places.iter().map(expression).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::body::{Schedule, body};
    use super::super::writes::{LARGE_MATRIX, Writes};
    use super::*;
    use crate::angles::{Angle, Term};
    use crate::program::{Input, Value};
    use redysim_runtime::function::Shape;

    fn variable(name: &str) -> Value {
        Value::Variable(name.into())
    }

    /// A function of the angles 0 to 4, of which angle 2 is not needed: a statement reads the sine of 0, two legs that of 1
    /// or 3, and nothing that of 4.
    fn function() -> (TrigProgram, Program) {
        let names = (0..5).map(|angle| (angle != 2 && angle != 4).then(|| format!("sin_{angle}"))).collect();
        let legs = SideBySide {
            name: "legs".into(),
            branches: 2,
            inputs: vec![
                Input { name: "sin".into(), branches: ["sin_3", "sin_1"].map(variable).into() },
                Input { name: "base".into(), branches: ["base", "base"].map(variable).into() },
            ],
            body: Vec::new(),
            results: Vec::new(),
        };
        let statements = vec![
            Statement::Destructure { array: Trig::Sines, names },
            Statement::Let { name: "base".into(), value: variable("sin_0") },
            Statement::SideBySide(legs),
        ];
        let coordinate = |coordinate| {
            let term = Term { coordinate, factor: 1.0, without_turns: false };
            Angle { terms: vec![term], constant: 0.0 }
        };
        let trig = TrigProgram {
            without_turns: Vec::new(),
            angles: [0, 1, 3, 4].map(coordinate).into(),
            places: vec![Some(0), Some(1), None, Some(2), Some(3)],
        };
        (trig, Program { statements, outputs: Vec::new() })
    }

    #[test]
    fn the_sines_of_a_branch_are_computed_before_it_and_all_others_first() {
        let (trig, program) = function();
        let sines = SinesWhenRead::of(&trig, &program).expect("legs read sines");
        let computed =
            |statement, branch| sines.computed_before(Moment { statement, branch }).to_string().replace(' ', "");
        assert_eq!(computed(0, 0), "sines.compute([0,3]);");
        assert_eq!(computed(3, 0), "sines.compute([2]);");
        assert_eq!(computed(3, 1), "sines.compute([1]);");
        assert_eq!(computed(2, 0), "");
        let expressions = sines.expressions();
        assert_eq!(expressions["sin_3"].to_string().replace(' ', ""), "sines.sin[2]");
    }

    #[test]
    fn sines_that_are_elements_of_a_matrix_are_computed_first_and_written() {
        let (trig, mut program) = function();
        program.outputs = vec![variable("sin_3"), variable("base"), variable("sin_1")];
        program.outputs.resize(LARGE_MATRIX, Value::Constant(0.0));
        assert_eq!(SinesWhenRead::of(&trig, &program), None, "the branches read no sine first");

        program.outputs[2] = variable("base");
        let (writes, sines) = (Writes::of(Shape::MassMatrix, &program), SinesWhenRead::of(&trig, &program));
        assert_eq!(sines.as_ref().map(|sines| sines.before[&Moment::default()].clone()), Some(vec![2, 0, 3]));
        let code =
            body(&program, &[], &quote!(runtime), &Schedule { writes, sines }, |_| unreachable!("it is written"));
        let code = code.to_string().replace(' ', "");
        let calls = ["matrix.write(sines.sin[2]);", "matrix.write(base);", "matrix.zeros();"];
        assert_eq!(calls.map(|call| code.matches(call).count()), [1, 2, 1], "{code}");
    }

    #[test]
    fn a_function_whose_branches_read_no_sine_first_has_them_from_the_beginning() {
        let (trig, mut program) = function();
        let sum = Value::Sum(Box::new(variable("sin_1")), Box::new(variable("sin_3")));
        program.statements.insert(1, Statement::Let { name: "sum".into(), value: sum });
        assert_eq!(SinesWhenRead::of(&trig, &program), None);
    }
}
