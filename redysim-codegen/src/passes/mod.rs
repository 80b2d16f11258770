//! Passes over expressions: each takes a graph and returns one of equal value.

mod factors;
mod squares;
mod sums;
mod terms;

use crate::expressions::Expressions;

/// Which passes are on. Each gives the same values with fewer operations; switched off, it shows what it gains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Passes {
    /// Frames of bodies are chosen anew ([`frames`](redysim_model::frames)).
    pub frames: bool,
    /// Inertia that a joint cannot tell from its parent's moves to the parent
    /// ([`regroup`](redysim_model::regroup)).
    pub base_parameters: bool,
    /// Masses on joint axes go where they cost least; on top of `base_parameters`.
    pub axis_masses: bool,
    /// One angle for consecutive parallel axes.
    pub parallel_axes: bool,
    /// Lengths in a unit that makes a constant 1.
    pub units: bool,
    /// Like terms of sums are collected.
    pub sums: bool,
    /// s² + c² = 1.
    pub squares: bool,
    /// Common factors of sums.
    pub factors: bool,
    /// Loops over bodies on which the same is done, where the code is long.
    pub loops: bool,
}

impl Passes {
    /// No pass at all.
    pub const fn none() -> Self {
        Passes {
            frames: false,
            base_parameters: false,
            axis_masses: false,
            parallel_axes: false,
            units: false,
            sums: false,
            squares: false,
            factors: false,
            loops: false,
        }
    }

    /// Every pass.
    pub const fn all() -> Self {
        Passes {
            frames: true,
            base_parameters: true,
            axis_masses: true,
            parallel_axes: true,
            units: true,
            sums: true,
            squares: true,
            factors: true,
            loops: true,
        }
    }
}

impl Passes {
    /// Without the passes that treat alike bodies differently.
    pub const fn even(self) -> Self {
        Passes { frames: false, axis_masses: false, parallel_axes: false, units: false, ..self }
    }
}

impl Default for Passes {
    /// Every pass.
    fn default() -> Self {
        Passes::all()
    }
}

/// A pass over expressions.
type Pass = fn(&Expressions) -> Expressions;

/// The expressions after all passes over expressions that are on. In debug builds each is checked: the values before
/// and after must agree.
pub fn simplified(mut expressions: Expressions, passes: &Passes) -> Expressions {
    if !passes.loops {
        expressions.graph.forget_steps();
    }
    let sums = |expressions| applied("sums", passes.sums, sums::collected, expressions);
    let collected = sums(expressions);
    let price = collected.price();
    let merged = applied("squares", passes.squares, squares::merged, collected);
    let shared = applied("factors", passes.factors, factors::shared, merged);
    // What has moved has new neighbours.
    if shared.price() < price { sums(shared) } else { shared }
}

/// The expressions after a pass, if it is on and does not make them dearer.
fn applied(name: &str, on: bool, pass: Pass, expressions: Expressions) -> Expressions {
    if !on {
        return expressions;
    }
    let simpler = pass(&expressions);
    if cfg!(debug_assertions) {
        check::same_values(name, &expressions, &simpler);
    }
    if simpler.price() <= expressions.price() { simpler } else { expressions }
}

mod check {
    use crate::expressions::Expressions;
    use crate::graph::Node;

    /// Panics where the two differ by more than the roundoff of an ill-conditioned mechanism at a few points.
    pub fn same_values(pass: &str, before: &Expressions, after: &Expressions) {
        for seed in 1..=3_u64 {
            let arguments = points(before, seed);
            let arguments: Vec<&[f64]> = arguments.iter().map(Vec::as_slice).collect();
            let (old, new) = (before.evaluate(&arguments), after.evaluate(&arguments));
            let scale = old.iter().fold(0.0_f64, |scale, value| scale.max(value.abs()));
            for (index, (old, new)) in old.iter().zip(&new).enumerate() {
                let same = (old - new).abs() <= 1e-6 * scale || old == new || (old.is_nan() && new.is_nan());
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
