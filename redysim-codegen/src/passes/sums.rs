//! Like terms of a sum become one: x·c + y + x·d is x·(c + d) + y.
//!
//! A constructor of the graph sees two terms at a time; here a whole sum is looked at, through all additions whose
//! only use is the sum. Constants are collected in numbers, and a coefficient that is only roundoff vanishes.

use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node, sum_without_noise};
use std::collections::HashMap;

/// The expressions with like terms collected.
pub fn collected(expressions: &Expressions) -> Expressions {
    let old = &expressions.graph;
    let uses = expressions.uses();
    let inner = inner_sums(old, &uses);
    let mut graph = Graph::default();
    let mut made: Vec<Option<Edge>> = vec![None; old.len()];
    for index in (0..old.len()).filter(|&index| uses[index] > 0 && !inner[index]) {
        let node = old.node(index);
        let edge = match node {
            Node::Add(..) | Node::Subtract(..) => rebuilt_sum(old, index, &inner, &mut graph, &made),
            _ => graph.rebuild(node, |edge| mapped(&made, edge)),
        };
        if let Some(name) = old.name(index) {
            graph.set_name(edge, name);
        }
        made[index] = Some(edge);
    }
    let outputs = expressions.outputs.iter().map(|&output| mapped(&made, output)).collect();
    Expressions { graph, outputs }
}

/// Sums, and constants times something, that are only part of one larger sum.
fn inner_sums(graph: &Graph, uses: &[usize]) -> Vec<bool> {
    let mut inner = vec![false; graph.len()];
    for index in (0..graph.len()).rev() {
        if uses[index] == 0 {
            continue;
        }
        if let Node::Add(a, b) | Node::Subtract(a, b) = graph.node(index) {
            for operand in [a, b].map(Edge::node) {
                let is_sum = matches!(graph.node(operand), Node::Add(..) | Node::Subtract(..));
                inner[operand] |= is_sum && uses[operand] == 1;
            }
        }
    }
    inner
}

fn rebuilt_sum(old: &Graph, root: usize, inner: &[bool], graph: &mut Graph, made: &[Option<Edge>]) -> Edge {
    let mut order: Vec<Edge> = Vec::new();
    let mut coefficients: HashMap<Edge, f64> = HashMap::new();
    let mut constant = 0.0;
    let mut open = vec![(root, false)];
    while let Some((index, negative)) = open.pop() {
        let (Node::Add(a, b) | Node::Subtract(a, b)) = old.node(index) else { continue };
        let second = matches!(old.node(index), Node::Subtract(..)) != negative;
        // The second operand waits on the stack, so that terms come in the order in which they were added.
        for (operand, negative) in [(b, second), (a, negative)] {
            if inner[operand.node()] {
                open.push((operand.node(), operand.is_negative() != negative));
                continue;
            }
            let edge = mapped(made, operand).flipped_if(negative);
            if let Some(value) = graph.constant_value(edge) {
                constant = sum_without_noise(constant, value);
                continue;
            }
            let (factor, base) = graph.coefficient(edge);
            let known = coefficients.entry(base).or_insert_with(|| {
                order.push(base);
                0.0
            });
            *known = sum_without_noise(*known, factor);
        }
    }
    let mut sum = graph.constant(constant);
    for base in order {
        let factor = graph.constant(coefficients[&base]);
        let term = graph.multiply(factor, base);
        sum = graph.add(sum, term);
    }
    sum
}

fn mapped(made: &[Option<Edge>], edge: Edge) -> Edge {
    made[edge.node()].expect("operands are made before what uses them").flipped_if(edge.is_negative())
}
