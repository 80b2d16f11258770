//! Products of a constant and two values: c·(x·y) and c·(x·z) are (c·x)·y and (c·x)·z, one multiplication less.

use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};
use std::collections::HashMap;

/// The expressions with each constant times the value that most products have beside it.
pub fn shared(expressions: &Expressions) -> Expressions {
    let (old, uses) = (&expressions.graph, expressions.uses());
    let live = || (0..old.len()).filter(|&index| uses[index] > 0);
    let mut counts: HashMap<(Edge, Edge), usize> = HashMap::new();
    for index in live() {
        if let Some((constant, values)) = product(old, &uses, index) {
            values.into_iter().for_each(|value| *counts.entry((constant, value)).or_default() += 1);
        }
    }
    let count = |constant: Edge, value: Edge| {
        let scaled = old.index_of(Node::Multiply(constant, value)).filter(|&scaled| uses[scaled] > 0);
        counts[&(constant, value)] + usize::from(scaled.is_some())
    };
    expressions.rebuilt(
        |index| uses[index] > 0,
        |graph, index, mapped| {
            let edge = match product(old, &uses, index) {
                Some((constant, [x, y])) if count(constant, x).max(count(constant, y)) > 1 => {
                    let (x, y) = if count(constant, x) >= count(constant, y) { (x, y) } else { (y, x) };
                    let scaled = graph.multiply(mapped(constant), mapped(x));
                    graph.multiply(scaled, mapped(y))
                }
                _ => graph.rebuild(old.node(index), mapped),
            };
            (edge, old.name(index))
        },
    )
}

/// The constant and the values of a product of three whose product of two nothing else uses.
fn product(graph: &Graph, uses: &[usize], index: usize) -> Option<(Edge, [Edge; 2])> {
    let Node::Multiply(constant, product) = graph.node(index) else { return None };
    graph.constant_value(constant)?;
    match graph.node(product.node()) {
        Node::Multiply(x, y) if uses[product.node()] == 1 && x != y => Some((constant, [x, y])),
        _ => None,
    }
}
