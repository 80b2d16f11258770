//! When a function writes the elements of a large matrix: each as soon as it is known, so that lanes neither keep results in
//! registers nor write all of them at the end, while nothing is left to compute.

use crate::program::{Loop, Program, Statement, Value};
use redysim_runtime::function::Shape;
use std::collections::{BTreeMap, HashMap};

/// From this number of elements on, a matrix of which at least a third are zero is written element by element where the function
/// returns it. LLVM composes an array literal of that size elsewhere and copies it, which in lanes takes more time than to
/// compute it; of a matrix without zeros it takes less.
const LARGE_MATRIX: usize = 256;

/// The order in which the elements of a matrix are written, and when.
pub struct Writes {
    /// The first place of each run of elements that are the same number, and how many they are, as they are written.
    pub runs: Vec<[usize; 2]>,
    at: BTreeMap<Moment, Vec<Write>>,
}

/// A moment after a statement and, if that computes branches side by side, after a branch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Moment {
    /// How many statements come before it.
    pub statements: usize,
    /// The branch of the last of them.
    pub branch: usize,
}

/// What is written into a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Write {
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
        let mut outputs: Vec<_> = numbered().filter(|(_, output)| !output.is_zero()).collect();
        outputs.sort_by_cached_key(|(_, output)| known.output(output));
        let places: Vec<usize> = numbered().filter(|(_, output)| output.is_zero()).map(|(place, _)| place).collect();
        let mut zeros = places.chunk_by(|place, next| place + 1 == *next).map(|run| [run[0], run.len()]).peekable();
        let mut writes = Writes { runs: Vec::new(), at: BTreeMap::new() };
        let mut zeros_written = 0;
        for (written, (place, output)) in (1..).zip(&outputs) {
            let (moment, _) = known.output(output);
            writes.push(moment, [*place, 1], Write::Output(*place));
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

    /// What is written at this moment.
    pub fn at(&self, moment: Moment) -> &[Write] {
        self.at.get(&moment).map_or(&[], Vec::as_slice)
    }
}

/// When the variables and arrays of a program are known.
struct Known<'p>(HashMap<&'p str, usize>);

impl<'p> Known<'p> {
    fn in_program(program: &'p Program) -> Self {
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

    /// When an output is known, and the last result of a branch that it needs.
    fn output(&self, value: &Value) -> (Moment, usize) {
        let statements = |name: &String| self.0.get(name.as_str()).copied().unwrap_or_default();
        match value {
            Value::Variable(name) | Value::LiveOut(name, ..) => (Moment { statements: statements(name), branch: 0 }, 0),
            Value::OfBranch { array, branch, column, .. } => {
                (Moment { statements: statements(array), branch: *branch }, *column)
            }
            _ => value.operands().into_iter().flatten().map(|operand| self.output(operand)).max().unwrap_or_default(),
        }
    }
}
