//! The constants of a loop: a literal if it is the same in all groups, else a column of a table.

use super::is_operation;
use super::signs::Signs;
use crate::graph::{Edge, Graph, Node};

/// A constant of a loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Constant {
    /// The same for all groups.
    Same(f64),
    /// A column of the table.
    Column(usize),
}

/// The constants among the operands of `node`, with the operands' numbers, in the operation of its template node: with
/// the signs that all other values have there.
pub fn constants(graph: &Graph, node: usize, template: usize, signs: &Signs) -> Vec<(usize, f64)> {
    let sign = |negative: bool| if negative { -1.0 } else { 1.0 };
    let own = sign(signs.is_negative(node));
    let relative = |operand: Edge, template: Edge| {
        let is_negative = |edge: Edge| is_operation(graph.node(edge.node())) && signs.is_negative(edge.node());
        sign(is_negative(operand) != is_negative(template))
    };
    match (graph.node(node), graph.node(template)) {
        (Node::Multiply(a, b), Node::Multiply(_, y)) | (Node::Divide(a, b), Node::Divide(_, y)) => {
            graph.constant_value(a).map(|value| (0, own * relative(b, y) * value)).into_iter().collect()
        }
        (one @ (Node::Add(a, b) | Node::Subtract(a, b)), other @ (Node::Add(..) | Node::Subtract(..))) => {
            let differs = matches!(one, Node::Add(..)) != matches!(other, Node::Add(..));
            let first = graph.constant_value(a).map(|value| (0, own * value));
            let second = graph.constant_value(b).map(|value| (1, own * sign(differs) * value));
            first.into_iter().chain(second).collect()
        }
        _ => Vec::new(),
    }
}

/// The constant with the given value for each group. Equal columns are one.
pub fn tabulated(columns: &mut Vec<Vec<f64>>, values: Vec<f64>) -> Constant {
    if values.iter().all(|value| *value == values[0]) {
        return Constant::Same(values[0]);
    }
    let place = columns.iter().position(|column| *column == values).unwrap_or(columns.len());
    if place == columns.len() {
        columns.push(values);
    }
    Constant::Column(place)
}
