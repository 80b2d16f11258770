//! A pass keeps every value, within the rounding errors of both ways to compute it.

use crate::accuracy::rounding::Rounded;
use crate::expressions::Expressions;
use crate::graph::Node;
use crate::random::Random;

/// Points at which a pass is verified.
const POINTS: u64 = 8;

/// A pass over expressions has changed a value: a fault of redysim.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangedValue {
    /// The name of the pass, as in [`Passes`](super::Passes).
    pub pass: &'static str,
    /// Which output of the function.
    pub output: usize,
    /// Its value before the pass.
    pub before: f64,
    /// Its value after the pass.
    pub after: f64,
    /// By how much rounding errors let the two differ.
    pub bound: f64,
}

impl std::fmt::Display for ChangedValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let ChangedValue { pass, output, before, after, bound } = self;
        write!(
            f,
            "the pass `{pass}` changes output {output} from {before:e} to {after:e}, where rounding errors are at most \
             {bound:.1e}: this is a fault of redysim; please report it with the model"
        )
    }
}

impl std::error::Error for ChangedValue {}

/// Compares each output before and after a pass at a few points.
///
/// # Errors
///
/// The first output that differs by more than the rounding errors of both ways.
pub fn same_values(pass: &'static str, before: &Expressions, after: &Expressions) -> Result<(), ChangedValue> {
    for seed in 1..=POINTS {
        let arguments = point(before, seed);
        let arguments: Vec<&[Rounded]> = arguments.iter().map(Vec::as_slice).collect();
        let [old, new] = [before, after].map(|expressions| expressions.evaluate(&arguments));
        let changed = old.iter().zip(&new).position(|(old, new)| !old.may_equal(*new));
        if let Some(output) = changed {
            let (old, new) = (old[output], new[output]);
            let bound = old.error + new.error;
            return Err(ChangedValue { pass, output, before: old.value, after: new.value, bound });
        }
    }
    Ok(())
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

    /// x + y of two inputs, times `factor`.
    fn scaled_sum(factor: f64) -> Expressions {
        let mut graph = Graph::default();
        let (x, y) = (graph.input(0, 0), graph.input(0, 1));
        let sum = graph.add(x, y);
        let factor = graph.constant(factor);
        let output = graph.multiply(factor, sum);
        Expressions { graph, outputs: vec![output] }
    }

    #[test]
    fn a_change_of_the_last_digits_is_rounding() {
        assert_eq!(same_values("sums", &scaled_sum(3.0), &scaled_sum(3.0 * (1.0 + f64::EPSILON))), Ok(()));
    }

    #[test]
    fn a_small_change_of_a_value_names_the_pass() {
        let changed = same_values("sums", &scaled_sum(3.0), &scaled_sum(3.0 * (1.0 + 1e-13))).unwrap_err();
        assert_eq!((changed.pass, changed.output), ("sums", 0));
        assert!(changed.to_string().starts_with("the pass `sums` changes output 0 from "));
    }

    #[test]
    fn a_number_does_not_become_nan() {
        assert!(same_values("sums", &scaled_sum(3.0), &scaled_sum(f64::NAN)).is_err());
    }

    #[test]
    fn a_quotient_by_what_may_be_zero_may_be_anything() {
        let nothing = Rounded::given(0.1) + Rounded::given(0.2) - Rounded::given(0.3);
        assert!((Rounded::given(1.0) / nothing).may_equal(Rounded::given(7.0)));
    }
}
