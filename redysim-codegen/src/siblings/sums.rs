//! Sums over what several branches contribute, branch by branch: what one branch contributes is summed first, so that
//! it is a pack, of which one number is taken for each branch. The number of operations stays as it is.

use super::Siblings;
use super::forms::{dependence, forms};
use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};
use redysim_model::Function;

/// The expressions with the terms of each sum by branches.
pub fn by_branches(expressions: &Expressions, function: Function, siblings: &Siblings) -> Expressions {
    let graph = &expressions.graph;
    let (uses, dependence) = (expressions.uses(), dependence(graph, function, siblings));
    let forms = forms(graph, function, siblings);
    let is_part: Vec<bool> = parts_of_sums(expressions, &uses);
    expressions.rebuilt(
        |index| uses[index] > 0,
        |new, index, mapped| {
            let name = graph.name(index);
            let branch = |term: &Edge| match dependence[term.node()] {
                branches if branches.is_power_of_two() => Some(branches.trailing_zeros()),
                _ => None,
            };
            let mut terms = Vec::new();
            if is_sum(graph.node(index)) && !is_part[index] && !dependence[index].is_power_of_two() {
                add_terms(graph, &is_part, graph.edge(index), &mut terms);
            }
            let of_branches = terms.iter().filter(|term| branch(term).is_some()).count();
            if terms.len() < 3 || of_branches < siblings.branches.len() {
                return (new.rebuild(graph.node(index), mapped), name);
            }
            // What does not depend on one branch stands first.
            terms.sort_by_key(|term| branch(term).map(|branch| (branch, forms[term.node()], term.node())));
            let sum_of = |new: &mut Graph, terms: &[Edge]| {
                terms.iter().map(|&term| mapped(term)).reduce(|sum, term| new.add(sum, term))
            };
            let sums: Vec<Edge> =
                terms.chunk_by(|a, b| branch(a) == branch(b)).filter_map(|terms| sum_of(new, terms)).collect();
            let sum = sums.into_iter().reduce(|sum, term| new.add(sum, term));
            (sum.unwrap_or_else(|| new.rebuild(graph.node(index), mapped)), name)
        },
    )
}

/// Sums whose only use is a term of another sum.
fn parts_of_sums(expressions: &Expressions, uses: &[usize]) -> Vec<bool> {
    let graph = &expressions.graph;
    let mut is_part = vec![false; graph.len()];
    for node in
        (0..graph.len()).filter(|&node| uses[node] > 0).map(|node| graph.node(node)).filter(|&node| is_sum(node))
    {
        for operand in node.operands().map(Edge::node) {
            is_part[operand] = uses[operand] == 1 && is_sum(graph.node(operand));
        }
    }
    is_part
}

fn is_sum(node: Node) -> bool {
    matches!(node, Node::Add(..) | Node::Subtract(..))
}

/// Adds the terms of a sum to `terms`.
fn add_terms(graph: &Graph, is_part: &[bool], sum: Edge, terms: &mut Vec<Edge>) {
    let (a, b) = match graph.node(sum.node()) {
        Node::Add(a, b) => (a, b),
        Node::Subtract(a, b) => (a, -b),
        _ => return terms.push(sum),
    };
    for operand in [a, b] {
        let operand = operand.flipped_if(sum.is_negative());
        if is_part[operand.node()] { add_terms(graph, is_part, operand, terms) } else { terms.push(operand) }
    }
}
