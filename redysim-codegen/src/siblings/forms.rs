//! The forms of values, and the branches that they depend on.

use super::Siblings;
use crate::graph::{Graph, Node};
use redysim_model::Function;
use redysim_runtime::function::Dimension;
use rustc_hash::FxHasher;
use std::hash::{Hash, Hasher};

/// The branches on whose inputs each node depends, a bit for each.
pub fn dependence(graph: &Graph, function: Function, siblings: &Siblings) -> Vec<u8> {
    let arguments = function.signature().arguments;
    let mut dependence: Vec<u8> = Vec::with_capacity(graph.len());
    for node in 0..graph.len() {
        let node = graph.node(node);
        let own = match node {
            Node::Input { argument, index } => {
                let dimension = arguments.get(usize::from(argument)).map(|argument| argument.dimension());
                siblings.place(dimension, index as usize).map_or(0, |(branch, _)| 1 << branch)
            }
            _ => 0,
        };
        dependence.push(node.operands().fold(own, |all, operand| all | dependence[operand.node()]));
    }
    dependence
}

/// The form of each node, as a hash: two nodes of the same form are computed in the same way, but for constants, signs
/// and the branch whose inputs they read.
pub fn forms(graph: &Graph, function: Function, siblings: &Siblings) -> Vec<u64> {
    let arguments = function.signature().arguments;
    let mut forms: Vec<u64> = Vec::with_capacity(graph.len());
    for node in 0..graph.len() {
        let node = graph.node(node);
        let mut operands: Vec<u64> = node.operands().map(|operand| forms[operand.node()]).collect();
        let mut hasher = FxHasher::default();
        match node {
            Node::Input { argument, index } => {
                let dimension = arguments.get(usize::from(argument)).map(|argument| argument.dimension());
                (0, argument, siblings.corresponding(dimension, index as usize)).hash(&mut hasher);
            }
            Node::Constant(_) => 1.hash(&mut hasher),
            Node::Parameter { .. } => 2.hash(&mut hasher),
            Node::Add(..) | Node::Subtract(..) => 3.hash(&mut hasher),
            Node::Multiply(..) => 4.hash(&mut hasher),
            Node::Divide(..) => 5.hash(&mut hasher),
            Node::Sqrt(_) => 6.hash(&mut hasher),
            Node::Sin(_) => 7.hash(&mut hasher),
            Node::Cos(_) => 8.hash(&mut hasher),
        }
        if !matches!(node, Node::Divide(..)) {
            operands.sort_unstable();
        }
        operands.hash(&mut hasher);
        forms.push(hasher.finish());
    }
    forms
}

impl Siblings {
    /// The branch of an element of an argument, and the place in it.
    fn place(&self, dimension: Option<Dimension>, index: usize) -> Option<(usize, usize)> {
        self.branches.iter().enumerate().find_map(|(number, branch)| {
            let elements = match dimension? {
                Dimension::Coordinates => &branch.coordinates,
                Dimension::Velocities => &branch.velocities,
                _ => return None,
            };
            Some((number, elements.iter().position(|&element| element == index)?))
        })
    }

    /// The place of an element in its branch, and whether it is of a branch at all.
    fn corresponding(&self, dimension: Option<Dimension>, index: usize) -> (bool, usize) {
        self.place(dimension, index).map_or((false, index), |(_, place)| (true, place))
    }
}
