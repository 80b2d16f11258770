//! Passes over expressions: each takes a graph and returns one of equal value.

mod sums;

use crate::expressions::Expressions;

/// A pass.
type Pass = fn(&Expressions) -> Expressions;

/// All passes in order.
const PASSES: [(&str, Pass); 1] = [("sums", sums::collected)];

/// The expressions after all passes. In debug builds each pass is checked: the values before and after must agree.
pub fn simplified(mut expressions: Expressions) -> Expressions {
    for (name, pass) in PASSES {
        let simpler = pass(&expressions);
        if cfg!(debug_assertions) {
            check::same_values(name, &expressions, &simpler);
        }
        expressions = simpler;
    }
    expressions
}

mod check {
    use crate::expressions::Expressions;
    use crate::graph::Node;

    /// Panics where the two differ by more than roundoff at a few points.
    pub fn same_values(pass: &str, before: &Expressions, after: &Expressions) {
        for seed in 1..=3_u64 {
            let arguments = points(before, seed);
            let arguments: Vec<&[f64]> = arguments.iter().map(Vec::as_slice).collect();
            let (old, new) = (before.evaluate(&arguments), after.evaluate(&arguments));
            let scale = old.iter().fold(0.0_f64, |scale, value| scale.max(value.abs()));
            for (index, (old, new)) in old.iter().zip(&new).enumerate() {
                let same = (old - new).abs() <= 1e-10 * scale || old == new || (old.is_nan() && new.is_nan());
                assert!(same, "the pass `{pass}` changed output {index} from {old:e} to {new:e}");
            }
        }
    }

    /// Values for every input, spread over ±1 by a fixed rule.
    fn points(expressions: &Expressions, seed: u64) -> Vec<Vec<f64>> {
        let mut points: Vec<Vec<f64>> = Vec::new();
        for node in (0..expressions.graph.len()).map(|index| expressions.graph.node(index)) {
            if let Node::Input { argument, index } = node {
                let (argument, index) = (usize::from(argument), index as usize);
                points.resize(points.len().max(argument + 1), Vec::new());
                let values = &mut points[argument];
                values.resize(values.len().max(index + 1), 0.0);
                let golden = 0.618_033_988_749_895 * (seed * 1_000 + argument as u64 * 100 + index as u64 + 1) as f64;
                values[index] = 2.0 * golden.fract() - 1.0;
            }
        }
        points
    }
}
