//! Sums and differences of the same two values: c (x + y) + d (x − y) is (c + d) x + (c − d) y, one addition less where
//! nothing else uses one of the two.
//!
//! Such are the elements ω_i ω_j ± ω̇_k of the matrix by which a body's second moments of mass are multiplied.

use super::terms::{Parts, with_sums};
use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};

/// The expressions with such terms of sums replaced.
pub fn replaced(expressions: &Expressions) -> Expressions {
    let (old, uses) = (&expressions.graph, expressions.uses());
    with_sums(expressions, &Parts::used_once(expressions), |graph, terms, mapped| {
        let mut open: Vec<Edge> = terms.to_vec();
        let mut sum = Vec::new();
        while let Some(([first, second], [x, y])) = pair(old, &uses, &open) {
            open.retain(|&term| term != first.edge && term != second.edge);
            let [c, d] = [first, second].map(|term| mapped(term.factor));
            for (factor, value) in [(graph.add(c, d), x), (graph.add(c, -d), y)] {
                sum.push(graph.multiply(factor, mapped(value)));
            }
        }
        open.into_iter().map(mapped).chain(sum).fold(graph.constant(0.0), |sum, term| graph.add(sum, term))
    })
}

/// A term that is a known factor times the sum of two values.
#[derive(Clone, Copy)]
struct Term {
    edge: Edge,
    factor: Edge,
    values: [Edge; 2],
    /// Whether nothing else uses the sum of the values.
    is_only_use: bool,
}

impl Term {
    /// `None` for any other term, and for one whose product has other uses.
    fn of(graph: &Graph, uses: &[usize], edge: Edge) -> Option<Term> {
        let Node::Multiply(factor, sum) = graph.node(edge.node()) else { return None };
        let values = match graph.node(sum.node()) {
            Node::Add(a, b) => [a, b],
            Node::Subtract(a, b) => [a, -b],
            _ => return None,
        };
        let factor = factor.flipped_if(edge.is_negative() != sum.is_negative());
        let is_only_use = uses[sum.node()] == 1;
        (graph.is_fixed(factor) && uses[edge.node()] == 1).then_some(Term { edge, factor, values, is_only_use })
    }
}

/// Two terms c (x + y) and d (x − y) of a sum, with x and y.
fn pair(graph: &Graph, uses: &[usize], terms: &[Edge]) -> Option<([Term; 2], [Edge; 2])> {
    let known: Vec<Term> = terms.iter().filter_map(|&term| Term::of(graph, uses, term)).collect();
    known.iter().enumerate().find_map(|(i, first)| {
        let second = known[i + 1..].iter().find(|second| {
            (first.is_only_use || second.is_only_use)
                && first.values[0] == second.values[0]
                && first.values[1] == -second.values[1]
        })?;
        Some(([*first, *second], first.values))
    })
}
