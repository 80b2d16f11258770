//! The angles of a mechanism: every one whose sine or cosine some function needs, once for all functions.

use super::{constant, local};
use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use std::collections::{HashMap, HashSet};

/// Angles as expressions of the coordinates `q`: first those of single joints in order, then sums.
#[derive(Clone, Debug, Default)]
pub struct Angles {
    angles: Vec<Angle>,
}

#[derive(Clone, Debug)]
struct Angle {
    /// The coordinates it depends on.
    coordinates: Vec<u32>,
    /// Whether it is more than one coordinate.
    is_sum: bool,
    /// The expression, which also tells one angle from another.
    tokens: TokenStream,
    text: String,
}

impl Angles {
    /// The angles of all `functions`.
    pub fn of<'a>(functions: impl IntoIterator<Item = &'a Expressions>) -> Angles {
        let mut angles = Angles::default();
        for expressions in functions {
            let mut seen = HashSet::new();
            for (_, angle) in trigonometric(expressions) {
                if seen.insert(angle) {
                    angles.add(&expressions.graph, angle);
                }
            }
        }
        // Sums of angles last, so that those of a chain of joints stand as the joints do.
        angles.angles.sort_by_key(|angle| (angle.coordinates.len(), angle.coordinates.clone()));
        angles
    }

    /// Number of angles.
    pub fn len(&self) -> usize {
        self.angles.len()
    }

    /// For each live sine and cosine of a function, where its angle is among these.
    pub fn positions(&self, expressions: &Expressions) -> HashMap<usize, usize> {
        let mut known: HashMap<Edge, usize> = HashMap::new();
        trigonometric(expressions)
            .map(|(node, angle)| {
                (node, *known.entry(angle).or_insert_with(|| self.position(&expressions.graph, angle)))
            })
            .collect()
    }

    /// Where among the angles `edge` of `graph` is.
    fn position(&self, graph: &Graph, edge: Edge) -> usize {
        let text = rendered(graph, edge.abs()).to_string();
        self.angles
            .iter()
            .position(|angle| angle.text == text)
            .expect("all angles are collected before any is looked up")
    }

    /// The coordinates whose sums are among the angles at the given positions, in order.
    pub fn summed(&self, positions: impl IntoIterator<Item = usize>) -> Vec<u32> {
        let sums = positions.into_iter().map(|position| &self.angles[position]).filter(|angle| angle.is_sum);
        let mut coordinates: Vec<u32> = sums.flat_map(|angle| angle.coordinates.clone()).collect();
        coordinates.sort_unstable();
        coordinates.dedup();
        coordinates
    }

    /// The angles at the given positions, as elements of an array. In sums coordinates stand [by name](without_turns).
    pub fn expressions(&self, positions: impl IntoIterator<Item = usize>) -> Vec<TokenStream> {
        positions.into_iter().map(|position| self.angles[position].tokens.clone()).collect()
    }

    /// The positions of the angles whose sine or cosine `expressions` needs, in order.
    pub fn needed_by(&self, expressions: &Expressions) -> Vec<usize> {
        let mut needed: Vec<usize> = self.positions(expressions).into_values().collect();
        needed.sort_unstable();
        needed.dedup();
        needed
    }

    fn add(&mut self, graph: &Graph, edge: Edge) {
        let tokens = rendered(graph, edge.abs());
        let text = tokens.to_string();
        if self.angles.iter().all(|angle| angle.text != text) {
            let mut coordinates = Vec::new();
            let mut open = vec![edge.node()];
            while let Some(index) = open.pop() {
                if let Node::Input { index, .. } = graph.node(index) {
                    coordinates.push(index);
                }
                open.extend(graph.node(index).operands().map(Edge::node));
            }
            coordinates.sort_unstable();
            let is_sum = !matches!(graph.node(edge.node()), Node::Input { .. });
            self.angles.push(Angle { coordinates, is_sum, tokens, text });
        }
    }
}

/// The live sines and cosines of a function, with their angles.
fn trigonometric(expressions: &Expressions) -> impl Iterator<Item = (usize, Edge)> {
    let uses = expressions.uses();
    (0..expressions.graph.len()).filter(move |&index| uses[index] > 0).filter_map(|index| {
        match expressions.graph.node(index) {
            Node::Sin(angle) | Node::Cos(angle) => Some((index, angle)),
            _ => None,
        }
    })
}

/// The name of a coordinate without whole turns.
pub fn without_turns(coordinate: u32) -> Ident {
    local(&format!("near_{coordinate}"))
}

/// An angle as an expression of the coordinates: one of them, or a sum of a few terms.
fn rendered(graph: &Graph, edge: Edge) -> TokenStream {
    match graph.node(edge.node()) {
        Node::Input { index, .. } => {
            let (q, index) = (local("q"), Literal::u32_unsuffixed(index));
            let value = quote!(#q[#index]);
            if edge.is_negative() { quote!(-#value) } else { value }
        }
        _ => rendered_sum(graph, edge),
    }
}

fn rendered_sum(graph: &Graph, edge: Edge) -> TokenStream {
    let value = match graph.node(edge.node()) {
        Node::Input { index, .. } => {
            let near = without_turns(index);
            quote!(#near)
        }
        Node::Constant(bits) => {
            let value = constant(f64::from_bits(bits));
            quote!(S::from_f64(#value))
        }
        Node::Add(a, b) => {
            let (a, b) = (rendered_sum(graph, a), rendered_sum(graph, b));
            quote!((#a + #b))
        }
        Node::Subtract(a, b) => {
            let (a, b) = (rendered_sum(graph, a), rendered_sum(graph, b));
            quote!((#a - #b))
        }
        Node::Multiply(a, b) => {
            let (a, b) = (rendered_sum(graph, a), rendered_sum(graph, b));
            quote!((#a * #b))
        }
        node @ (Node::Divide(..) | Node::Sin(_) | Node::Cos(_) | Node::Sqrt(_)) => {
            unreachable!("an angle is a sum of coordinates and constants, not {node:?}")
        }
    };
    if edge.is_negative() { quote!(-#value) } else { value }
}
