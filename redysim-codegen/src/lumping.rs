//! What depends on run-time parameters alone: lumped once for each robot, so that a call pays for the general numbers
//! only.

use crate::expressions::Expressions;
use crate::graph::{Edge, Node};
use crate::symbol::{Symbol, SymbolicTree, Tracer};
use redysim_model::{Model, RunTimeParameter, Tree};

/// The tree of a model whose `parameters` are symbols in the graph of `tracer`.
pub fn tree_with_parameters<'p>(
    model: &Model,
    parameters: &[RunTimeParameter],
    tracer: &'p Tracer,
) -> SymbolicTree<'p> {
    let values = parameters.iter().flat_map(|parameter| parameter.values(model));
    let symbols: Vec<Symbol> = (0..).zip(values).map(|(index, value)| tracer.parameter(index, value)).collect();
    Tree::with_parameters(model, parameters, &symbols)
}

/// Takes out of all functions what depends on parameters alone, and returns it as one function of the parameters: its
/// outputs are the numbers that the functions read in place of it, as their parameters.
///
/// The parameters of the functions are nodes in the graph of `tracer`, whose parameters are those of the mechanism.
pub fn lumped<'a>(functions: impl IntoIterator<Item = &'a mut Expressions>, tracer: Tracer) -> Expressions {
    let mut lumped = Expressions { graph: tracer.into_graph(), outputs: Vec::new() };
    for function in functions {
        *function = without_fixed(function, &mut lumped);
    }
    lumped
}

/// The expressions with an output of `lumped` in place of each fixed value.
fn without_fixed(expressions: &Expressions, lumped: &mut Expressions) -> Expressions {
    let graph = &expressions.graph;
    let uses = expressions.uses();
    let is_fixed = |index: usize| graph.is_fixed(graph.edge(index));
    let mut read = vec![false; graph.len()];
    let operands = (0..graph.len()).filter(|&index| uses[index] > 0 && !is_fixed(index));
    let operands = operands.flat_map(|index| graph.node(index).operands());
    operands.chain(expressions.outputs.iter().copied()).for_each(|edge| read[edge.node()] = true);
    // Each fixed value in the graph of the parameters, and where these have the values of the model.
    let mut fixed: Vec<Option<Edge>> = vec![None; graph.len()];
    let mut nominal = vec![f64::NAN; graph.len()];
    for index in (0..graph.len()).filter(|&index| uses[index] > 0 && is_fixed(index)) {
        let edge = match graph.node(index) {
            Node::Parameter { index, .. } => lumped.graph.edge(index as usize),
            node => lumped
                .graph
                .rebuild(node, |edge| fixed[edge.node()].map_or(edge, |value| value.flipped_if(edge.is_negative()))),
        };
        fixed[index] = Some(edge);
        nominal[index] = graph.nominal(index, &nominal);
    }
    expressions.rebuilt(
        |index| uses[index] > 0 && (read[index] || !is_fixed(index)),
        |graph, index, mapped| {
            let edge = match fixed[index] {
                None => graph.rebuild(expressions.graph.node(index), mapped),
                Some(value) => match lumped.graph.constant_value(value) {
                    Some(constant) => graph.constant(constant),
                    None => {
                        let place = lumped.place(value.abs());
                        let nominal = value.signed(nominal[index]);
                        graph.parameter(place, nominal).flipped_if(value.is_negative())
                    }
                },
            };
            (edge, expressions.graph.name(index))
        },
    )
}

impl Expressions {
    /// The position of a value among the outputs. A new value is appended.
    fn place(&mut self, value: Edge) -> u32 {
        let place = self.outputs.iter().position(|output| *output == value).unwrap_or(self.outputs.len());
        if place == self.outputs.len() {
            self.outputs.push(value);
        }
        place as u32
    }
}
