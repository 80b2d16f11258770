//! From a function on a tree to its expressions.

use crate::expressions::Expressions;
use crate::passes::{PassError, Passes, simplified};
use crate::symbol::{Symbol, SymbolicTree, Tracer};
use redysim_model::{Function, denoc};
use redysim_runtime::function::Argument;

/// The expressions of `function` on `tree`, forward dynamics by the recursion, simplified.
pub fn simplified_on(tree: &SymbolicTree, function: Function, passes: &Passes) -> Result<Expressions, PassError> {
    simplified(traced_on(tree, function), passes)
}

/// The expressions of `function` on `tree`, forward dynamics by the recursion, before any pass over them.
pub fn traced_on(tree: &SymbolicTree, function: Function) -> Expressions {
    traced(tree, function, |tracer, arguments| denoc::evaluate(function, &tracer.tree(tree), tracer, arguments))
}

/// The expressions of `computed`, which computes `function` on trees of the same joints as `tree`, before any pass.
pub fn traced(
    tree: &SymbolicTree,
    function: Function,
    computed: impl for<'g> Fn(&'g Tracer, &[&[Symbol<'g>]]) -> Vec<Symbol<'g>>,
) -> Expressions {
    let length = |argument: &Argument| tree.argument_length(*argument);
    traced_of(function.signature().arguments.iter().map(length), computed)
}

/// The expressions of `computed`, a function of arrays of the given lengths, before any pass.
pub fn traced_of(
    lengths: impl IntoIterator<Item = usize>,
    computed: impl for<'g> Fn(&'g Tracer, &[&[Symbol<'g>]]) -> Vec<Symbol<'g>>,
) -> Expressions {
    let tracer = Tracer::default();
    let outputs = {
        let symbols: Vec<Vec<Symbol>> =
            (0..).zip(lengths).map(|(index, length)| tracer.argument(index, length)).collect();
        let symbols: Vec<&[Symbol]> = symbols.iter().map(Vec::as_slice).collect();
        tracer.edges(&computed(&tracer, &symbols))
    };
    Expressions { graph: tracer.into_graph(), outputs }
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use redysim_model::{Model, Tree};
    use redysim_runtime::Dual;

    /// A chain of 40 uniform bodies.
    pub fn chain_of_40() -> SymbolicTree<'static> {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/peers/chain40.toml");
        Tree::new(&Model::load(path).expect("a valid model").model).map(Symbol::Constant)
    }

    /// The slopes of a function of coordinates, velocities, and accelerations or forces, along a direction: the last
    /// three of six arguments.
    pub fn derivative_on(tree: &SymbolicTree, function: Function) -> Expressions {
        let tree = &tree.map(Symbol::nominal);
        traced_of([tree.nv(); 6], |tracer, x| {
            let dual = |(&value, &slope)| Dual { value, slope };
            let duals = [0, 1, 2].map(|index| x[index].iter().zip(x[index + 3]).map(dual).collect::<Vec<_>>());
            let arguments = function.signature().arguments.len();
            let results = denoc::evaluate(function, tree, tracer, &duals.each_ref().map(Vec::as_slice)[..arguments]);
            results.into_iter().map(|result| result.slope).collect()
        })
    }
}
