//! Passes over expressions: each takes a graph and returns one of equal value.

mod angle_sums;
mod conjugates;
mod constants;
mod factors;
mod rotations;
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
    /// Angles about consecutive parallel axes are added; where the sine and cosine of all three are needed, those of the
    /// sum come from the addition theorems.
    pub parallel_axes: bool,
    /// The unit of length makes a constant 1.
    pub units: bool,
    /// Like terms of sums are collected.
    pub sums: bool,
    /// Common factors are taken out of sums.
    pub factors: bool,
    /// Sums of sums and differences of the same values, and products of a constant and two values, are computed in the
    /// order that costs least. Pruning comes before: it leaves out the terms that the recursions have.
    pub associations: bool,
    /// Squares of rotated components come from sums of squares that the rotation keeps.
    pub rotations: bool,
    /// Loops over uniform bodies, where the code is long.
    pub loops: bool,
    /// Sibling branches that are alike are computed side by side.
    pub siblings: bool,
}

/// The switch of one pass.
pub type Switch = fn(&mut Passes) -> &mut bool;

impl Passes {
    /// The switch of each pass, by its name.
    pub const SWITCHES: [(&str, Switch); 11] = [
        ("frames", |passes| &mut passes.frames),
        ("base_parameters", |passes| &mut passes.base_parameters),
        ("axis_masses", |passes| &mut passes.axis_masses),
        ("parallel_axes", |passes| &mut passes.parallel_axes),
        ("units", |passes| &mut passes.units),
        ("sums", |passes| &mut passes.sums),
        ("factors", |passes| &mut passes.factors),
        ("associations", |passes| &mut passes.associations),
        ("rotations", |passes| &mut passes.rotations),
        ("loops", |passes| &mut passes.loops),
        ("siblings", |passes| &mut passes.siblings),
    ];

    /// All passes, none, and all but each one, by what they are called in tables of what a pass gains.
    pub fn variations() -> impl Iterator<Item = (String, Passes)> {
        let without = Passes::SWITCHES.into_iter().map(|(name, switch)| {
            let mut passes = Passes::all();
            *switch(&mut passes) = false;
            (format!("no {name}"), passes)
        });
        [("all".to_owned(), Passes::all()), ("none".to_owned(), Passes::none())].into_iter().chain(without)
    }

    /// No pass at all.
    pub const fn none() -> Self {
        Passes::each(false)
    }

    /// Every pass.
    pub const fn all() -> Self {
        Passes::each(true)
    }

    const fn each(on: bool) -> Self {
        Passes {
            frames: on,
            base_parameters: on,
            axis_masses: on,
            parallel_axes: on,
            units: on,
            sums: on,
            factors: on,
            associations: on,
            rotations: on,
            loops: on,
            siblings: on,
        }
    }

    /// Without the passes that make uniform bodies differ, so that their code can be a loop.
    pub const fn uniform(self) -> Self {
        Passes { frames: false, axis_masses: false, parallel_axes: false, units: false, ..self }
    }

    /// Without the passes that choose how terms are associated.
    pub(crate) const fn unassociated(self) -> Self {
        Passes { associations: false, rotations: false, ..self }
    }

    /// Without the passes that make branches that are alike differ: which terms they collect first depends on the
    /// order of all terms.
    pub(crate) const fn alike(self) -> Self {
        Passes { sums: false, factors: false, ..self.unassociated() }
    }
}

impl Default for Passes {
    /// Every pass.
    fn default() -> Self {
        Passes::all()
    }
}

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
    let expressions = applied("parallel_axes", passes.parallel_axes, angle_sums::expanded, expressions)?;
    applied("rotations", passes.rotations, rotations::replaced, associated(expressions, passes)?)
}

/// The expressions with like terms and common factors taken together, from terms as they are or as [`conjugates`] takes
/// them apart.
fn associated(expressions: Expressions, passes: &Passes) -> Result<Expressions, PassError> {
    let replaced = applied("conjugates", passes.associations, conjugates::replaced, expressions.clone())?;
    let gains = replaced.price() < expressions.price();
    let collected = collected(expressions, passes)?;
    if !gains {
        return Ok(collected);
    }
    // Terms that were replaced may have had a factor in common with others.
    let replaced = self::collected(replaced, passes)?;
    Ok(if replaced.price() < collected.price() { replaced } else { collected })
}

/// The expressions with like terms collected and common factors taken out.
fn collected(expressions: Expressions, passes: &Passes) -> Result<Expressions, PassError> {
    let sums = |expressions| applied("sums", passes.sums, sums::collected, expressions);
    let collected = sums(expressions)?;
    let price = collected.price();
    let shared = applied("factors", passes.factors, factors::shared, collected)?;
    // Factors that were taken out leave new like terms.
    let shared = if shared.price() < price { sums(shared)? } else { shared };
    applied("constants", passes.associations, constants::shared, shared)
}

/// The expressions after a pass, if it is on and does not raise the price.
pub(crate) fn applied(
    name: &'static str,
    on: bool,
    pass: impl FnOnce(&Expressions) -> Expressions,
    expressions: Expressions,
) -> Result<Expressions, PassError> {
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
        let negated = |before: &Expressions| Expressions { outputs: vec![-before.outputs[0]], ..before.clone() };
        let error = applied("sums", true, negated, Expressions { graph, outputs }).unwrap_err();
        assert!(matches!(error.fault, PassFault::Value { output: 0, .. }), "{error}");
    }
}
