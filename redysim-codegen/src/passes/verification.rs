//! A pass keeps every value, within the rounding errors of both ways to compute it, and leaves a well-formed graph.

use super::structure::broken;
use crate::accuracy::rounding::Rounded;
use crate::expressions::Expressions;
use crate::graph::Node;
use crate::random::Random;

/// Points at which a pass is verified.
const POINTS: u64 = 8;

/// A pass over expressions is wrong: a bug in redysim.
#[derive(Clone, Debug, PartialEq)]
pub struct PassError {
    /// The name of the pass, as in [`Passes`](super::Passes), or `pruning`.
    pub pass: &'static str,
    /// What is wrong with its result.
    pub fault: PassFault,
}

/// What is wrong with the result of a pass.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum PassFault {
    /// An output has another value.
    Value {
        /// Which output of the function.
        output: usize,
        /// Its value before the pass.
        before: f64,
        /// Its value after the pass.
        after: f64,
        /// By how much rounding errors let the two differ.
        bound: f64,
    },
    /// The function has another number of outputs.
    OutputCount {
        /// Outputs before the pass.
        before: usize,
        /// Outputs after the pass.
        after: usize,
    },
    /// An output is a node that the graph does not have.
    OutputOutOfRange {
        /// Which output of the function.
        output: usize,
    },
    /// The function reads an input that it did not read before.
    NewInput {
        /// Position in the function's list of arguments.
        argument: u8,
        /// Index in the array.
        index: u32,
    },
    /// An operand does not precede the node that uses it, or the graph does not have it.
    OperandOrder {
        /// The node.
        node: usize,
        /// The operand.
        operand: usize,
    },
    /// Two nodes of a graph in which equal values are one node are equal.
    DuplicateNode {
        /// The later of the two.
        node: usize,
    },
    /// A node is not in the form in which equal values are equal nodes: a sign that belongs outside, operands out of
    /// order, or an operation on constants.
    NotCanonical {
        /// The node.
        node: usize,
    },
}

impl std::fmt::Display for PassError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the pass `{}` {}; this is a bug in redysim: please report it with the model", self.pass, self.fault)
    }
}

impl std::fmt::Display for PassFault {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            PassFault::Value { output, before, after, bound } => write!(
                f,
                "changes output {output} from {before:e} to {after:e}, where rounding errors are at most {bound:.1e}"
            ),
            PassFault::OutputCount { before, after } => write!(f, "returns {after} outputs instead of {before}"),
            PassFault::OutputOutOfRange { output } => {
                write!(f, "returns as output {output} a node that does not exist")
            }
            PassFault::NewInput { argument, index } => {
                write!(f, "reads element {index} of argument {argument}, which the function does not need")
            }
            PassFault::OperandOrder { node, operand } => {
                write!(f, "makes node {node} of node {operand}, which does not precede it")
            }
            PassFault::DuplicateNode { node } => write!(f, "makes node {node} a second time"),
            PassFault::NotCanonical { node } => write!(f, "makes node {node} without the graph's constructors"),
        }
    }
}

impl std::error::Error for PassError {}

/// Checks the structure of the graph that a pass returns, and compares each output before and after it at
/// [`POINTS`] points.
///
/// # Errors
///
/// The first fault of the structure, else the first output that differs by more than the rounding errors of both ways.
pub fn verified(pass: &'static str, before: &Expressions, after: &Expressions) -> Result<(), PassError> {
    well_formed(pass, before, after)?;
    match changed(before, after) {
        Some(fault) => Err(PassError { pass, fault }),
        None => Ok(()),
    }
}

/// Checks the structure alone, for a pass that is allowed to change values.
///
/// # Errors
///
/// The first fault.
pub fn well_formed(pass: &'static str, before: &Expressions, after: &Expressions) -> Result<(), PassError> {
    match broken(before, after) {
        Some(fault) => Err(PassError { pass, fault }),
        None => Ok(()),
    }
}

/// The first output whose values differ.
fn changed(before: &Expressions, after: &Expressions) -> Option<PassFault> {
    (1..=POINTS).find_map(|seed| {
        let arguments = point(before, seed);
        let arguments: Vec<&[Rounded]> = arguments.iter().map(Vec::as_slice).collect();
        // Parameters differ from their values in the model, which may be zero or equal by chance.
        let parameter =
            |index: u32, _| Rounded::given(Random::new(seed + POINTS * (1 + u64::from(index))).share(false));
        let [old, new] = [before, after].map(|expressions| expressions.evaluate_with(&arguments, parameter));
        let output = old.iter().zip(&new).position(|(old, new)| !old.may_equal(*new))?;
        let (old, new) = (old[output], new[output]);
        Some(PassFault::Value { output, before: old.value, after: new.value, bound: old.error + new.error })
    })
}

/// A value within ±1 for every input.
fn point(expressions: &Expressions, seed: u64) -> Vec<Vec<Rounded>> {
    let mut random = Random::new(seed);
    let mut point: Vec<Vec<Rounded>> = Vec::new();
    for node in (0..expressions.graph.len()).map(|index| expressions.graph.node(index)) {
        if let Node::Input { argument, index } = node {
            let (argument, index) = (usize::from(argument), index as usize);
            point.resize(point.len().max(argument + 1), Vec::new());
            let values = &mut point[argument];
            while values.len() <= index {
                values.push(Rounded::given(random.share(false)));
            }
        }
    }
    point
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::Graph;

    /// The sum of two inputs, times each of the factors.
    fn scaled_sums(factors: &[f64]) -> Expressions {
        let mut graph = Graph::default();
        let (x, y) = (graph.input(0, 0), graph.input(0, 1));
        let sum = graph.add(x, y);
        let scaled = |&factor: &f64| {
            let factor = graph.constant(factor);
            graph.multiply(factor, sum)
        };
        let outputs = factors.iter().map(scaled).collect();
        Expressions { graph, outputs }
    }

    fn scaled_sum(factor: f64) -> Expressions {
        scaled_sums(&[factor])
    }

    #[test]
    fn a_change_of_the_last_digits_is_rounding() {
        assert_eq!(verified("sums", &scaled_sum(3.0), &scaled_sum(3.0 * (1.0 + f64::EPSILON))), Ok(()));
    }

    #[test]
    fn a_small_change_of_a_value_names_the_pass() {
        let error = verified("sums", &scaled_sum(3.0), &scaled_sum(3.0 * (1.0 + 1e-13))).unwrap_err();
        assert_eq!(error.pass, "sums");
        assert!(error.to_string().starts_with("the pass `sums` changes output 0 from "), "{error}");
    }

    #[test]
    fn a_wrong_small_output_beside_a_large_one_is_found() {
        let error = verified("sums", &scaled_sums(&[1e9, 1e-6]), &scaled_sums(&[1e9, 1.001e-6])).unwrap_err();
        assert!(matches!(error.fault, PassFault::Value { output: 1, .. }), "{error}");
    }

    #[test]
    fn a_number_does_not_become_nan_nor_nan_a_number() {
        assert!(verified("sums", &scaled_sum(3.0), &scaled_sum(f64::NAN)).is_err());
        assert!(verified("sums", &scaled_sum(f64::NAN), &scaled_sum(3.0)).is_err());
    }

    #[test]
    fn a_quotient_by_what_may_be_zero_may_be_anything() {
        let nothing = Rounded::given(0.1) + Rounded::given(0.2) - Rounded::given(0.3);
        assert!((Rounded::given(1.0) / nothing).may_equal(Rounded::given(7.0)));
        let unbounded = Rounded::given(1.0) / (nothing - Rounded::given(5e-17));
        assert!((Rounded::given(0.0) * unbounded).may_equal(Rounded::given(7.0)));
    }
}
