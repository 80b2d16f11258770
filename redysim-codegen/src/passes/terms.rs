//! Sums taken as a whole: through all additions whose only use is the sum.

use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};

/// Additions and subtractions that are only part of one larger sum; in a long function, of one in the same step of a
/// recursion.
pub fn inner_sums(expressions: &Expressions) -> Vec<bool> {
    let (graph, uses, by_body) = (&expressions.graph, expressions.uses(), expressions.is_long());
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

/// [`inner_sums`] with sums of a value and one that is given at run time, where only sums use them that have a fixed term
/// of their own: the two fixed terms are one, so that nothing has to compute the smaller sum.
pub fn inner_sums_and_offsets(expressions: &Expressions) -> Vec<bool> {
    let (graph, uses, by_body) = (&expressions.graph, expressions.uses(), expressions.is_long());
    let mut inner = inner_sums(expressions);
    let is_sum = |node: usize| matches!(graph.node(node), Node::Add(..) | Node::Subtract(..));
    let offset = |node: usize| {
        let is_given = |operand: Edge| graph.is_fixed(operand) && graph.constant_value(operand).is_none();
        is_sum(node) && graph.node(node).operands().any(is_given) && !inner[node]
    };
    let mut absorbed = vec![0; graph.len()];
    for root in (0..graph.len()).filter(|&node| uses[node] > 0 && is_sum(node) && !inner[node]) {
        let terms = terms(graph, root, &inner);
        if terms.iter().any(|&term| graph.is_fixed(term)) {
            let within_reach = |node: usize| !by_body || graph.step(node) == graph.step(root);
            let offsets = terms.iter().map(|term| term.node()).filter(|&node| offset(node) && within_reach(node));
            offsets.for_each(|node| absorbed[node] += 1);
        }
    }
    for node in (0..graph.len()).filter(|&node| absorbed[node] > 0 && absorbed[node] == uses[node]) {
        inner[node] = true;
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

/// The live nodes in a new graph, with sums made by `sum` from their terms in the old graph; `inner` marks those that are
/// part of others.
pub fn with_sums(
    expressions: &Expressions,
    inner: &[bool],
    mut sum: impl FnMut(&mut Graph, &[Edge], &dyn Fn(Edge) -> Edge) -> Edge,
) -> Expressions {
    let old = &expressions.graph;
    let uses = expressions.uses();
    expressions.rebuilt(
        |index| uses[index] > 0 && !inner[index],
        |graph, index, mapped| {
            let edge = match old.node(index) {
                Node::Add(..) | Node::Subtract(..) => sum(graph, &terms(old, index, inner), mapped),
                node => graph.rebuild(node, mapped),
            };
            (edge, old.name(index))
        },
    )
}
