//! When a function writes the elements of a large matrix: each as soon as it is known, so that lanes neither keep results in
//! registers nor write all of them at the end, while nothing is left to compute.

use super::body::{MATRIX, local};
use super::moments::{Known, Moment};
use crate::program::Program;
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use redysim_runtime::function::Shape;
use std::collections::HashMap;

/// From this number of elements on, a matrix of which at least a third are zero is written element by element where the function
/// returns it. LLVM composes an array literal of that size elsewhere and copies it, which in lanes takes more time than to
/// compute it; of a matrix without zeros it takes less.
pub const LARGE_MATRIX: usize = 256;

/// The order in which the elements of a matrix are written, and when.
pub struct Writes {
    /// The first place of each run of elements that are the same number, and how many they are, as they are written.
    runs: Vec<[usize; 2]>,
    at: HashMap<Moment, Vec<Write>>,
}

/// What is written into a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Write {
    /// The output of this number, one element.
    Output(usize),
    /// Zeros.
    Zeros,
}

impl Writes {
    /// The writes of a function's result; `None` if it is not a large matrix with many zeros.
    pub fn of(shape: Shape, program: &Program) -> Option<Writes> {
        let outputs = &program.outputs;
        let zeros = outputs.iter().filter(|output| output.is_zero()).count();
        let is_matrix = matches!(shape, Shape::MassMatrix | Shape::CoriolisMatrix | Shape::LoopJacobian);
        (is_matrix && outputs.len() >= LARGE_MATRIX && 3 * zeros >= outputs.len()).then(|| Writes::as_known(program))
    }

    /// Outputs in the order in which they are known, and runs of zeros spread among them evenly: zeros alone would wait for
    /// the memory.
    fn as_known(program: &Program) -> Writes {
        let known = Known::in_program(program);
        let numbered = || program.outputs.iter().enumerate();
        let nonzero = numbered().filter(|(_, output)| !output.is_zero());
        let mut outputs: Vec<_> = nonzero.map(|(place, output)| (known.value(output), place)).collect();
        outputs.sort_unstable();
        let places: Vec<usize> = numbered().filter(|(_, output)| output.is_zero()).map(|(place, _)| place).collect();
        let mut zeros = places.chunk_by(|place, next| place + 1 == *next).map(|run| [run[0], run.len()]).peekable();
        let mut writes = Writes { runs: Vec::new(), at: HashMap::new() };
        let mut zeros_written = 0;
        for (written, ((moment, _), place)) in (1..).zip(outputs.iter().copied()) {
            writes.push(moment, [place, 1], Write::Output(place));
            while let Some(run) = zeros.next_if(|_| zeros_written * outputs.len() < written * places.len()) {
                zeros_written += run[1];
                writes.push(moment, run, Write::Zeros);
            }
        }
        writes.runs.extend(zeros);
        writes
    }

    fn push(&mut self, moment: Moment, run: [usize; 2], write: Write) {
        self.runs.push(run);
        self.at.entry(moment).or_default().push(write);
    }

    /// The code that writes what is known after this moment, where the outputs have this code.
    pub fn after(&self, moment: Moment, outputs: &[TokenStream]) -> TokenStream {
        let matrix = local(MATRIX);
        let code = self.at.get(&moment).into_iter().flatten().map(|write| match *write {
            Write::Output(number) => {
                let value = &outputs[number];
                quote!(#matrix.write(#value);)
            }
            Write::Zeros => quote!(#matrix.zeros();),
        });
        quote!(#(#code)*)
    }

    /// The code that writes all elements row by row.
    pub fn by_rows(program: &Program, outputs: &[TokenStream]) -> TokenStream {
        let (matrix, elements) = (local(MATRIX), program.outputs.iter().zip(outputs).collect::<Vec<_>>());
        let runs = elements.chunk_by(|(a, _), (b, _)| a.is_zero() && b.is_zero()).map(|run| match *run {
            [(output, value)] if !output.is_zero() => quote!(#matrix.push(#value);),
            _ => {
                let count = Literal::usize_unsuffixed(run.len());
                quote!(#matrix.zeros(#count);)
            }
        });
        quote!(#(#runs)*)
    }

    /// The declaration of the order, and the number of its runs.
    pub fn order(&self, runtime: &TokenStream) -> (TokenStream, Literal) {
        let count = Literal::usize_unsuffixed(self.runs.len());
        let runs = self.runs.iter().map(|run| {
            let [first, length] = run.map(Literal::usize_unsuffixed);
            quote!([#first, #length])
        });
        let declaration = quote! {
            struct Order;
            impl #runtime::WritingOrder<#count> for Order {
                const RUNS: [[usize; 2]; #count] = [#(#runs),*];
            }
        };
        (declaration, count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::{Input, SideBySide, Statement, Value};

    fn constant(value: f64) -> Value {
        Value::Constant(value)
    }

    fn of_leg(branch: usize, column: usize) -> Value {
        Value::OfBranch { array: "legs".into(), branches: 2, branch, column }
    }

    /// The function of a matrix with these elements, of two legs with two results each and of their sum.
    fn function(outputs: Vec<Value>) -> Program {
        let legs = SideBySide {
            name: "legs".into(),
            branches: 2,
            inputs: vec![Input { name: "length".into(), branches: [1.0, 2.0].map(constant).into() }],
            body: Vec::new(),
            results: vec!["a".into(), "b".into()],
        };
        let sum = Value::Sum(Box::new(of_leg(0, 0)), Box::new(of_leg(1, 0)));
        let statements = vec![Statement::SideBySide(legs), Statement::Let { name: "sum".into(), value: sum }];
        Program { statements, outputs }
    }

    fn text(tokens: TokenStream) -> String {
        tokens.to_string().replace(' ', "")
    }

    #[test]
    fn a_large_matrix_with_zeros_is_written_and_no_other() {
        let matrix = |size: usize, is_set: fn(usize, usize) -> bool| {
            let value = |place| if is_set(place / size, place % size) { 1.0 } else { 0.0 };
            function((0..size * size).map(|place| constant(value(place))).collect())
        };
        let is_written = |shape, program: &Program| Writes::of(shape, program).is_some();
        assert!(is_written(Shape::MassMatrix, &matrix(16, |row, column| row == column)));
        assert!(!is_written(Shape::MassMatrix, &matrix(15, |row, column| row == column)));
        assert!(!is_written(Shape::MassMatrix, &matrix(16, |row, _| row < 12)));
        assert!(!is_written(Shape::Forces, &matrix(16, |row, column| row == column)));
    }

    #[test]
    fn elements_are_written_once_they_are_known_and_zeros_among_them() {
        let minus = |value| Value::Negative(Box::new(value));
        let outputs = vec![
            Value::Variable("sum".into()),
            constant(0.0),
            constant(0.0),
            minus(of_leg(1, 1)),
            of_leg(0, 0),
            Value::Sum(Box::new(of_leg(0, 0)), Box::new(of_leg(0, 1))),
            constant(0.0),
            constant(3.0),
            constant(0.0),
        ];
        let program = function(outputs);
        let writes = Writes::as_known(&program);
        let code: Vec<TokenStream> = ["sum", "k(0)", "k(0)", "-b1", "a0", "a0+b0", "k(0)", "k(3)", "k(0)"]
            .map(|code| code.parse().expect("code"))
            .into();
        assert_eq!(writes.runs, [[7, 1], [1, 2], [4, 1], [5, 1], [6, 1], [3, 1], [8, 1], [0, 1]]);
        let after = |statement, branch| text(writes.after(Moment { statement, branch }, &code));
        assert_eq!(after(0, 0), "matrix.write(k(3));matrix.zeros();");
        assert_eq!(after(1, 0), "matrix.write(a0);matrix.write(a0+b0);matrix.zeros();");
        assert_eq!(after(1, 1), "matrix.write(-b1);matrix.zeros();");
        assert_eq!(after(2, 0), "matrix.write(sum);");
        assert_eq!(
            text(Writes::by_rows(&program, &code)),
            "matrix.push(sum);matrix.zeros(2);matrix.push(-b1);matrix.push(a0);matrix.push(a0+b0);matrix.zeros(1);\
             matrix.push(k(3));matrix.zeros(1);"
        );
    }
}
