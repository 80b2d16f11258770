//! Passes over expressions: each takes a graph and returns one of equal value.

mod factors;
mod structure;
mod sums;
mod terms;
mod verification;

use crate::expressions::Expressions;
pub(crate) use verification::well_formed;
pub use verification::{PassError, PassFault};

/// Which passes are on. A pass keeps the values and saves operations; without it, the count shows what it saves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Passes {
    /// Frames of bodies are chosen anew ([`frames`](redysim_model::frames)).
    pub frames: bool,
    /// Inertia that has the same effect on the parent moves to the parent ([`regroup`](redysim_model::regroup)).
    pub base_parameters: bool,
    /// Masses on joint axes go where they cost least; on top of `base_parameters`.
    pub axis_masses: bool,
    /// Angles about consecutive parallel axes are added.
    pub parallel_axes: bool,
    /// The unit of length makes a constant 1.
    pub units: bool,
    /// Like terms of sums are collected.
    pub sums: bool,
    /// Common factors are taken out of sums.
    pub factors: bool,
    /// Loops over uniform bodies, where the code is long.
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
            factors: true,
            loops: true,
        }
    }

    /// Without the passes that make uniform bodies differ, so that their code can be a loop.
    pub const fn uniform(self) -> Self {
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

/// The expressions after all passes over expressions that are on.
///
/// # Errors
///
/// In debug builds each pass is verified, and one that changes a value by more than rounding errors or breaks the graph
/// is reported.
pub fn simplified(mut expressions: Expressions, passes: &Passes) -> Result<Expressions, PassError> {
    if !passes.loops {
        expressions.graph.forget_steps();
    }
    let sums = |expressions| applied("sums", passes.sums, sums::collected, expressions);
    let collected = sums(expressions)?;
    let price = collected.price();
    let shared = applied("factors", passes.factors, factors::shared, collected)?;
    // Factors that were taken out leave new like terms.
    if shared.price() < price { sums(shared) } else { Ok(shared) }
}

/// The expressions after a pass, if it is on and does not raise the price.
fn applied(name: &'static str, on: bool, pass: Pass, expressions: Expressions) -> Result<Expressions, PassError> {
    if !on {
        return Ok(expressions);
    }
    let simpler = pass(&expressions);
    if cfg!(debug_assertions) {
        verification::verified(name, &expressions, &simpler)?;
    }
    Ok(if simpler.price() <= expressions.price() { simpler } else { expressions })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::Graph;

    #[test]
    #[cfg(debug_assertions)]
    fn a_wrong_pass_is_reported_where_it_runs() {
        let mut graph = Graph::default();
        let outputs = vec![graph.input(0, 0)];
        let negated: Pass = |before| Expressions { outputs: vec![-before.outputs[0]], ..before.clone() };
        let error = applied("sums", true, negated, Expressions { graph, outputs }).unwrap_err();
        assert!(matches!(error.fault, PassFault::Value { output: 0, .. }), "{error}");
    }
}
