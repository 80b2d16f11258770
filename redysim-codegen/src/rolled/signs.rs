//! Which values of a group of bodies are the negatives of those of the template.
//!
//! With a sign for each value, a sum asks that both of its terms carry the sign of the sum, a product has the product
//! of the signs of its factors, and a product with a constant may have either, since the constant takes it. That is
//! solved by joining values into classes whose signs hang together, in the order of the operations.

use super::{Place, TEMPLATE};
use crate::graph::{Edge, Graph, Node};
use std::collections::HashMap;

/// Signs of nodes relative to their images in the template.
pub struct Signs {
    /// A parent in the forest of classes, and whether the sign differs from the parent's.
    parents: Vec<(usize, bool)>,
}

/// Two signs contradict each other.
struct Contradiction;

impl Signs {
    /// The signs of the nodes `members`, which are in the order of groups; or the number of groups up to which there is
    /// no contradiction.
    pub fn of(graph: &Graph, members: &[usize], places: &HashMap<usize, Place>) -> Result<Signs, usize> {
        // The class of the last element has the sign plus.
        let mut signs = Signs { parents: (0..=graph.len()).map(|node| (node, false)).collect() };
        for (&node, place) in places {
            if place.group == TEMPLATE {
                signs.parents[node] = (graph.len(), false);
            }
        }
        for &node in members {
            let place = places[&node];
            if place.group != TEMPLATE && signs.relate(graph, node, place.image).is_err() {
                return Err(place.group);
            }
        }
        Ok(signs)
    }

    /// Whether the value of `node` is the negative of its image's. Values that nothing ties have the sign plus.
    pub fn is_negative(&self, node: usize) -> bool {
        self.find(node).1
    }

    fn relate(&mut self, graph: &Graph, node: usize, image: usize) -> Result<(), Contradiction> {
        match (graph.node(node), graph.node(image)) {
            (own @ (Node::Add(a, b) | Node::Subtract(a, b)), other @ (Node::Add(x, y) | Node::Subtract(x, y))) => {
                let differs = matches!(own, Node::Add(..)) != matches!(other, Node::Add(..));
                for (operand, image, differs) in [(a, x, false), (b, y, differs)] {
                    if graph.constant_value(operand).is_none() {
                        let known = self.of_image(graph, image)?;
                        self.join(node, self.operand(graph, operand), differs != known)?;
                    }
                }
                Ok(())
            }
            (Node::Multiply(a, b), Node::Multiply(x, y)) | (Node::Divide(a, b), Node::Divide(x, y)) => {
                if graph.constant_value(a).is_some() {
                    return Ok(());
                }
                let known = self.of_image(graph, x)? != self.of_image(graph, y)?;
                let (a, b) = (self.operand(graph, a), self.operand(graph, b));
                let plus = graph.len();
                let fixed = match (self.find(a), self.find(b)) {
                    ((root, sign), _) if root == plus => (b, sign),
                    (_, (root, sign)) if root == plus => (a, sign),
                    _ => {
                        self.join(a, plus, false)?;
                        (b, false)
                    }
                };
                self.join(node, fixed.0, fixed.1 != known)
            }
            (Node::Sqrt(a), Node::Sqrt(x)) => {
                let known = self.of_image(graph, x)?;
                self.join(self.operand(graph, a), graph.len(), known)?;
                self.join(node, graph.len(), false)
            }
            _ => Ok(()),
        }
    }

    /// The element that stands for the sign of an operand: inputs, sines and cosines are what they are.
    fn operand(&self, graph: &Graph, edge: Edge) -> usize {
        let fixed = matches!(graph.node(edge.node()), Node::Input { .. } | Node::Sin(_) | Node::Cos(_));
        if fixed { graph.len() } else { edge.node() }
    }

    /// The sign of an operand in the template; where it is in another group and free, it becomes plus.
    fn of_image(&mut self, graph: &Graph, edge: Edge) -> Result<bool, Contradiction> {
        let element = self.operand(graph, edge);
        let (root, sign) = self.find(element);
        if root != graph.len() {
            self.join(element, graph.len(), false)?;
            return Ok(false);
        }
        Ok(sign)
    }

    fn find(&self, node: usize) -> (usize, bool) {
        let (mut at, mut sign) = (node, false);
        while self.parents[at].0 != at {
            let (parent, differs) = self.parents[at];
            (at, sign) = (parent, sign != differs);
        }
        (at, sign)
    }

    /// The signs of `a` and `b` differ if `differs`, and are the same if not.
    fn join(&mut self, a: usize, b: usize, differs: bool) -> Result<(), Contradiction> {
        let ((a, sign_a), (b, sign_b)) = (self.find(a), self.find(b));
        let differs = differs != (sign_a != sign_b);
        if a == b {
            return if differs { Err(Contradiction) } else { Ok(()) };
        }
        // The class of the sign plus, which is the last element, stays the root.
        let (child, root) = if a < b { (a, b) } else { (b, a) };
        self.parents[child] = (root, differs);
        Ok(())
    }
}
