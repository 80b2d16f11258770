//! Common factors of a sum: x·y + x·z is x·(y + z), one multiplication less.
//!
//! Only products that nothing else uses are taken apart, so that none is computed twice. Of each sum the factor that
//! most products share is taken first.

use super::terms::{Parts, with_sums};
use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};
use std::collections::HashMap;

/// The expressions with common factors taken out of sums.
pub fn shared(expressions: &Expressions) -> Expressions {
    // As chains first, so that terms are met in an order that does not depend on how a sum is balanced.
    let expressions = &with_sums(expressions, &Parts::used_once(expressions), |graph, terms, mapped| {
        chain(graph, terms.iter().map(|&term| mapped(term)))
    });
    let old = &expressions.graph;
    let uses = expressions.uses();
    with_sums(expressions, &Parts::used_once(expressions), |graph, terms, mapped| {
        let mut sum = Vec::with_capacity(terms.len());
        let mut open: Vec<Edge> = terms.to_vec();
        while let Some(factor) = most_shared(old, &uses, &open) {
            let (with, without): (Vec<Edge>, Vec<Edge>) =
                open.into_iter().partition(|&term| cofactor(old, &uses, term, factor).is_some());
            let cofactors = with.into_iter().filter_map(|term| cofactor(old, &uses, term, factor)).map(mapped);
            let cofactors = chain(graph, cofactors);
            sum.push(graph.multiply(mapped(factor), cofactors));
            open = without;
        }
        chain(graph, open.into_iter().map(mapped).chain(sum))
    })
}

/// The sum of terms, one after the other.
fn chain(graph: &mut Graph, terms: impl Iterator<Item = Edge>) -> Edge {
    terms.fold(graph.constant(0.0), |sum, term| graph.add(sum, term))
}

/// The factor that most terms share; `None` if no two do.
fn most_shared(graph: &Graph, uses: &[usize], terms: &[Edge]) -> Option<Edge> {
    let mut counts: HashMap<Edge, (usize, usize)> = HashMap::new();
    let products = terms.iter().filter_map(|&term| product(graph, uses, term));
    for (order, factor) in products.flat_map(|(a, b)| if a == b { vec![a] } else { vec![a, b] }).enumerate() {
        counts.entry(factor).or_insert((0, order)).0 += 1;
    }
    let best = counts.into_iter().max_by_key(|&(_, (count, order))| (count, std::cmp::Reverse(order)));
    best.filter(|&(_, (count, _))| count > 1).map(|(factor, _)| factor)
}

/// The factors of a product that nothing else uses.
fn product(graph: &Graph, uses: &[usize], term: Edge) -> Option<(Edge, Edge)> {
    match graph.node(term.node()) {
        Node::Multiply(a, b) if uses[term.node()] == 1 => Some((a, b)),
        _ => None,
    }
}

/// What is left of a term without the factor.
fn cofactor(graph: &Graph, uses: &[usize], term: Edge, factor: Edge) -> Option<Edge> {
    let (a, b) = product(graph, uses, term)?;
    let left = if a == factor {
        b
    } else if b == factor {
        a
    } else {
        return None;
    };
    Some(left.flipped_if(term.is_negative()))
}
