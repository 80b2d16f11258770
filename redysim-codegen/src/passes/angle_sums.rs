//! The sine and cosine of a sum of two angles whose own are computed anyway: six operations, instead of another pair.
//!
//! One function may need the angles of two joints with parallel axes and their sum, where the descriptions of the robot
//! of which it is made add up different angles.

use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};
use std::collections::HashSet;

/// The expressions with the addition theorems for sums of angles.
pub fn expanded(expressions: &Expressions) -> Expressions {
    let old = &expressions.graph;
    let uses = expressions.uses();
    let live = (0..old.len()).filter(|&index| uses[index] > 0);
    let angles: HashSet<Edge> = live
        .filter_map(|index| match old.node(index) {
            Node::Sin(angle) | Node::Cos(angle) => Some(angle.abs()),
            _ => None,
        })
        .collect();
    expressions.rebuilt(
        |index| uses[index] > 0,
        |graph, index, mapped| {
            let edge = match old.node(index) {
                Node::Sin(angle) => sin_cos(old, graph, &angles, angle, mapped).0,
                Node::Cos(angle) => sin_cos(old, graph, &angles, angle, mapped).1,
                node => graph.rebuild(node, mapped),
            };
            (edge, old.name(index))
        },
    )
}

/// The sine and cosine of an angle of the old graph, in the new one.
fn sin_cos(
    old: &Graph,
    graph: &mut Graph,
    angles: &HashSet<Edge>,
    angle: Edge,
    mapped: &dyn Fn(Edge) -> Edge,
) -> (Edge, Edge) {
    let terms = match old.node(angle.node()) {
        Node::Add(a, b) => Some((a, b)),
        Node::Subtract(a, b) => Some((a, -b)),
        _ => None,
    };
    let Some((a, b)) = terms.filter(|(a, b)| angles.contains(&a.abs()) && angles.contains(&b.abs())) else {
        let angle = mapped(angle);
        return (graph.sin(angle), graph.cos(angle));
    };
    let [(sin_a, cos_a), (sin_b, cos_b)] = [a, b].map(|term| {
        let (sin, cos) = sin_cos(old, graph, angles, term.abs(), mapped);
        (sin.flipped_if(term.is_negative()), cos)
    });
    let mut product = |a: Edge, b: Edge| graph.multiply(a, b);
    let [sines, cosines] = [product(sin_a, sin_b), product(cos_a, cos_b)];
    let [first, second] = [product(sin_a, cos_b), product(cos_a, sin_b)];
    let (sin, cos) = (graph.add(first, second), graph.add(cosines, -sines));
    (sin.flipped_if(angle.is_negative()), cos)
}
