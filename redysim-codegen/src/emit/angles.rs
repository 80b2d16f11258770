//! The angles of a mechanism: every one whose sine or cosine some function needs, once for all functions.

use super::{constant, local};
use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// Angles as expressions of the coordinates `q`, in the order of the first coordinate of each.
#[derive(Clone, Debug, Default)]
pub struct Angles {
    angles: Vec<Angle>,
}

#[derive(Clone, Debug)]
struct Angle {
    /// The coordinates it depends on.
    coordinates: Vec<u32>,
    /// The expression, which also tells one angle from another.
    tokens: TokenStream,
    text: String,
}

impl Angles {
    /// The angles of all `functions`.
    pub fn of<'a>(functions: impl IntoIterator<Item = &'a Expressions>) -> Angles {
        let mut angles = Angles::default();
        for expressions in functions {
            for edge in trigonometric(expressions).map(|(_, angle)| angle) {
                angles.add(&expressions.graph, edge);
            }
        }
        angles.angles.sort_by(|a, b| a.coordinates.cmp(&b.coordinates));
        angles
    }

    /// Number of angles.
    pub fn len(&self) -> usize {
        self.angles.len()
    }

    /// Where among the angles `edge` of `graph` is.
    pub fn position(&self, graph: &Graph, edge: Edge) -> usize {
        let text = rendered(graph, edge.abs()).to_string();
        self.angles
            .iter()
            .position(|angle| angle.text == text)
            .expect("all angles are collected before any is looked up")
    }

    /// The angles at the given positions, as elements of an array.
    pub fn expressions(&self, positions: impl IntoIterator<Item = usize>) -> Vec<TokenStream> {
        positions.into_iter().map(|position| self.angles[position].tokens.clone()).collect()
    }

    /// The positions of the angles whose sine or cosine `expressions` needs, in order.
    pub fn needed_by(&self, expressions: &Expressions) -> Vec<usize> {
        let mut needed: Vec<usize> =
            trigonometric(expressions).map(|(_, angle)| self.position(&expressions.graph, angle)).collect();
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
            self.angles.push(Angle { coordinates, tokens, text });
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

/// An angle as an expression of the coordinates: a sum of a few terms.
fn rendered(graph: &Graph, edge: Edge) -> TokenStream {
    let value = match graph.node(edge.node()) {
        Node::Input { index, .. } => {
            let (q, index) = (local("q"), Literal::u32_unsuffixed(index));
            quote!(#q[#index])
        }
        Node::Constant(bits) => {
            let value = constant(f64::from_bits(bits));
            quote!(S::from_f64(#value))
        }
        Node::Add(a, b) => {
            let (a, b) = (rendered(graph, a), rendered(graph, b));
            quote!((#a + #b))
        }
        Node::Subtract(a, b) => {
            let (a, b) = (rendered(graph, a), rendered(graph, b));
            quote!((#a - #b))
        }
        Node::Multiply(a, b) => {
            let (a, b) = (rendered(graph, a), rendered(graph, b));
            quote!((#a * #b))
        }
        node @ (Node::Divide(..) | Node::Sin(_) | Node::Cos(_) | Node::Sqrt(_)) => {
            unreachable!("an angle is a sum of coordinates and constants, not {node:?}")
        }
    };
    if edge.is_negative() { quote!(-#value) } else { value }
}
