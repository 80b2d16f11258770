//! Which values of a group of bodies are the negatives of their template nodes.
//!
//! Each value has a sign relative to its template node. Both terms of a sum have the sign of the sum, a product has the
//! product of the signs of its factors, and a product with a constant may have either sign, since the constant takes
//! it. Values whose signs depend on each other are joined into classes (union-find), in the order of the operations. A
//! sign that is needed before it is determined becomes an unknown, and a cycle in a class gives an equation for the
//! unknowns.

use super::{Place, TEMPLATE};
use crate::graph::{Edge, Graph, Node};
use std::collections::HashMap;

/// Signs of nodes relative to their template nodes.
pub struct Signs {
    /// A parent in the forest of classes, and the sign relative to the parent's.
    parents: Vec<(usize, Sign)>,
    /// For each unknown, what it is equal to, if that is known.
    unknowns: Vec<Option<Sign>>,
    /// The element whose sign is plus, the root of its class.
    plus: usize,
}

/// A product of signs: minus, and unknowns by their number.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Sign(u128);

impl Sign {
    const PLUS: Sign = Sign(0);
    const MINUS: Sign = Sign(1 << 127);
    /// The most unknowns that there can be.
    const UNKNOWNS: usize = 127;

    fn minus_if(negative: bool) -> Sign {
        if negative { Sign::MINUS } else { Sign::PLUS }
    }

    fn unknown(number: usize) -> Sign {
        Sign(1 << number)
    }

    fn has(self, unknown: usize) -> bool {
        self.0 >> unknown & 1 == 1
    }
}

impl std::ops::Mul for Sign {
    type Output = Sign;
    #[expect(clippy::suspicious_arithmetic_impl, reason = "equal signs cancel")]
    fn mul(self, other: Sign) -> Sign {
        Sign(self.0 ^ other.0)
    }
}

/// Two signs contradict each other, or there are too many unknowns.
struct Contradiction;

impl Signs {
    /// The signs of the nodes `members`, which are in the order of operations; `None` where they contradict each other.
    pub fn of(graph: &Graph, members: &[usize], places: &HashMap<usize, Place>) -> Option<Signs> {
        let plus = graph.len();
        let parents = (0..=plus).map(|node| (node, Sign::PLUS)).collect();
        let mut signs = Signs { parents, unknowns: Vec::new(), plus };
        for (&node, place) in places {
            if place.group == TEMPLATE {
                signs.parents[node] = (plus, Sign::PLUS);
            }
        }
        for &node in members {
            let place = places[&node];
            if place.group != TEMPLATE {
                signs.relate(graph, node, place.template).ok()?;
            }
        }
        Some(signs)
    }

    /// Whether the value of `node` is the negative of its template node's. An undetermined sign is plus.
    pub fn is_negative(&self, node: usize) -> bool {
        self.solved(self.find(node).1).has(127)
    }

    fn relate(&mut self, graph: &Graph, node: usize, template: usize) -> Result<(), Contradiction> {
        match (graph.node(node), graph.node(template)) {
            (own @ (Node::Add(a, b) | Node::Subtract(a, b)), other @ (Node::Add(x, y) | Node::Subtract(x, y))) => {
                let differs = matches!(own, Node::Add(..)) != matches!(other, Node::Add(..));
                for (operand, template, differs) in [(a, x, false), (b, y, differs)] {
                    if graph.constant_value(operand).is_none() {
                        let known = self.known(self.element(graph, template))?;
                        self.join(node, self.element(graph, operand), Sign::minus_if(differs) * known)?;
                    }
                }
                Ok(())
            }
            (Node::Multiply(a, b), Node::Multiply(x, y)) | (Node::Divide(a, b), Node::Divide(x, y)) => {
                if graph.constant_value(a).is_some() {
                    // A constant numerator is the same in all groups, so it takes no sign.
                    let quotient = matches!(graph.node(node), Node::Divide(..));
                    let known = if quotient { self.known(self.element(graph, y))? } else { return Ok(()) };
                    return self.join(node, self.element(graph, b), known);
                }
                let known = self.known(self.element(graph, x))? * self.known(self.element(graph, y))?;
                let (mut a, mut b) = (self.element(graph, a), self.element(graph, b));
                let ((root_a, sign_a), (root_b, sign_b)) = (self.find(a), self.find(b));
                if root_a == root_b {
                    return self.join(node, self.plus, sign_a * sign_b * known);
                }
                if root_b == self.plus {
                    (a, b) = (b, a);
                }
                let factor = self.known(a)?;
                self.join(node, b, factor * known)
            }
            (Node::Sqrt(a), Node::Sqrt(x)) => {
                let known = self.known(self.element(graph, x))?;
                self.join(self.element(graph, a), self.plus, known)?;
                self.join(node, self.plus, Sign::PLUS)
            }
            _ => Ok(()),
        }
    }

    /// The element that stands for the sign of an operand: inputs, sines and cosines are what they are.
    fn element(&self, graph: &Graph, edge: Edge) -> usize {
        let fixed = matches!(
            graph.node(edge.node()),
            Node::Input { .. } | Node::Parameter { .. } | Node::Sin(_) | Node::Cos(_)
        );
        if fixed { self.plus } else { edge.node() }
    }

    /// The sign of an element, an unknown if nothing is known of it yet.
    fn known(&mut self, element: usize) -> Result<Sign, Contradiction> {
        if self.find(element).0 != self.plus {
            let unknown = self.unknowns.len();
            if unknown == Sign::UNKNOWNS {
                return Err(Contradiction);
            }
            self.unknowns.push(None);
            self.join(element, self.plus, Sign::unknown(unknown))?;
        }
        Ok(self.solved(self.find(element).1))
    }

    /// The root of a class, and the sign relative to it.
    fn find(&self, element: usize) -> (usize, Sign) {
        let (mut at, mut sign) = (element, Sign::PLUS);
        while self.parents[at].0 != at {
            let (parent, relative) = self.parents[at];
            (at, sign) = (parent, sign * relative);
        }
        (at, sign)
    }

    /// The sign of `a` is that of `b` times `relative`.
    fn join(&mut self, a: usize, b: usize, relative: Sign) -> Result<(), Contradiction> {
        let ((a, sign_a), (b, sign_b)) = (self.find(a), self.find(b));
        let relative = self.solved(relative * sign_a * sign_b);
        if a == b {
            return self.equals_plus(relative);
        }
        // The element of the sign plus is the last one and stays the root.
        let (child, root) = if a < b { (a, b) } else { (b, a) };
        self.parents[child] = (root, relative);
        Ok(())
    }

    /// The equation that a product of signs is plus.
    fn equals_plus(&mut self, sign: Sign) -> Result<(), Contradiction> {
        if sign == Sign::PLUS {
            return Ok(());
        }
        let Some(unknown) = (0..self.unknowns.len()).find(|&unknown| sign.has(unknown)) else {
            return Err(Contradiction);
        };
        let value = sign * Sign::unknown(unknown);
        for known in self.unknowns.iter_mut().flatten().filter(|known| known.has(unknown)) {
            *known = *known * Sign::unknown(unknown) * value;
        }
        self.unknowns[unknown] = Some(value);
        Ok(())
    }

    /// A sign with the known unknowns replaced.
    fn solved(&self, sign: Sign) -> Sign {
        let known = self.unknowns.iter().enumerate().filter(|(unknown, _)| sign.has(*unknown));
        known.fold(sign, |sign, (unknown, value)| match value {
            Some(value) => sign * Sign::unknown(unknown) * *value,
            None => sign,
        })
    }
}
