//! Sums taken as a whole: through all additions whose only use is the sum.

use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};

/// Additions and subtractions that are only part of one larger sum; if `by_body`, of one in the same step of a
/// recursion.
fn inner_sums(graph: &Graph, uses: &[usize], by_body: bool) -> Vec<bool> {
    let mut inner = vec![false; graph.len()];
    for index in (0..graph.len()).rev() {
        if uses[index] == 0 {
            continue;
        }
        if let Node::Add(a, b) | Node::Subtract(a, b) = graph.node(index) {
            for operand in [a, b].map(Edge::node) {
                let is_sum = matches!(graph.node(operand), Node::Add(..) | Node::Subtract(..));
                let within_reach = !by_body || graph.step(operand) == graph.step(index);
                inner[operand] |= is_sum && uses[operand] == 1 && within_reach;
            }
        }
    }
    inner
}

/// The terms of the sum at `root`, each with its sign, in the order in which they are met.
fn terms(graph: &Graph, root: usize, inner: &[bool]) -> Vec<Edge> {
    let mut terms = Vec::new();
    let mut open = vec![(root, false)];
    while let Some((index, negative)) = open.pop() {
        let (Node::Add(a, b) | Node::Subtract(a, b)) = graph.node(index) else { continue };
        let second = matches!(graph.node(index), Node::Subtract(..)) != negative;
        for (operand, negative) in [(a, negative), (b, second)] {
            if inner[operand.node()] {
                open.push((operand.node(), operand.is_negative() != negative));
            } else {
                terms.push(operand.flipped_if(negative));
            }
        }
    }
    terms
}

/// The live nodes in a new graph, with sums made by `sum` from their terms in the old graph.
pub fn with_sums(
    expressions: &Expressions,
    mut sum: impl FnMut(&mut Graph, &[Edge], &dyn Fn(Edge) -> Edge) -> Edge,
) -> Expressions {
    let old = &expressions.graph;
    let uses = expressions.uses();
    let inner = inner_sums(old, &uses, expressions.is_long());
    expressions.rebuilt(
        |index| uses[index] > 0 && !inner[index],
        |graph, index, mapped| {
            let edge = match old.node(index) {
                Node::Add(..) | Node::Subtract(..) => sum(graph, &terms(old, index, &inner), mapped),
                node => graph.rebuild(node, mapped),
            };
            (edge, old.name(index))
        },
    )
}
