//! The angles of a mechanism: those whose sine or cosine a function needs, each once for all functions.
//!
//! They are sums of coordinates. A sine of anything else is computed where it is needed.

use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};
use std::collections::{HashMap, HashSet};

/// An angle: a sum of coordinates, each times a factor, and a constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Angle {
    /// The coordinates, in order.
    pub terms: Vec<Term>,
    /// What is added to them, rad.
    pub constant: f64,
}

/// A coordinate in a sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Term {
    /// Index of the coordinate.
    pub coordinate: u32,
    /// What it is multiplied by.
    pub factor: f64,
    /// Whether whole turns are taken off it before it is added: in a sum, where this leaves the angle's sine and
    /// cosine.
    pub without_turns: bool,
}

impl Angle {
    /// The angle that `edge` of `graph` is; `None` if it is not a sum of coordinates.
    fn of(graph: &Graph, edge: Edge) -> Option<Angle> {
        let mut angle = Angle { terms: Vec::new(), constant: 0.0 };
        angle.add(graph, edge, 1.0)?;
        angle.terms.sort_unstable_by_key(|term| term.coordinate);
        let is_sum = angle.is_sum();
        for term in &mut angle.terms {
            term.without_turns = is_sum && term.factor.fract() == 0.0;
        }
        Some(angle)
    }

    /// Adds a part of the sum; `None` if it is neither a coordinate nor a constant, nor a sum of these.
    fn add(&mut self, graph: &Graph, edge: Edge, factor: f64) -> Option<()> {
        let factor = if edge.is_negative() { -factor } else { factor };
        match graph.node(edge.node()) {
            Node::Input { index: coordinate, .. } => {
                self.terms.push(Term { coordinate, factor, without_turns: false });
            }
            Node::Constant(bits) => self.constant += factor * f64::from_bits(bits),
            Node::Add(a, b) => {
                self.add(graph, a, factor)?;
                self.add(graph, b, factor)?;
            }
            Node::Subtract(a, b) => {
                self.add(graph, a, factor)?;
                self.add(graph, b, -factor)?;
            }
            _ => match graph.coefficient(edge.abs()) {
                (own, base) if base != edge.abs() => self.add(graph, base, factor * own)?,
                _ => return None,
            },
        }
        Some(())
    }

    /// Whether it is more than one coordinate.
    fn is_sum(&self) -> bool {
        !matches!(self.terms.as_slice(), [Term { factor: 1.0 | -1.0, .. }] if self.constant == 0.0)
    }

    /// The coordinate that the angle is; `None` for a multiple or a sum.
    #[cfg(feature = "source")]
    pub fn coordinate(&self) -> Option<u32> {
        match self.terms[..] {
            [Term { coordinate, factor: 1.0, .. }] if self.constant == 0.0 => Some(coordinate),
            _ => None,
        }
    }

    /// The coordinates it depends on, in order.
    fn coordinates(&self) -> Vec<u32> {
        self.terms.iter().map(|term| term.coordinate).collect()
    }
}

/// The angles of all functions: first those of single joints in order, then sums.
#[derive(Clone, Debug, Default)]
pub struct Angles(Vec<Angle>);

impl Angles {
    /// The angles of all `functions`.
    pub fn of<'a>(functions: impl IntoIterator<Item = &'a Expressions>) -> Angles {
        let mut angles: Vec<Angle> = Vec::new();
        for expressions in functions {
            let mut seen = HashSet::new();
            for (_, edge) in trigonometric(expressions) {
                if seen.insert(edge)
                    && let Some(angle) = Angle::of(&expressions.graph, edge.abs())
                    && !angles.contains(&angle)
                {
                    angles.push(angle);
                }
            }
        }
        // Sums of angles last, so that those of a chain of joints stand as the joints do.
        angles.sort_by_cached_key(|angle| (angle.terms.len(), angle.coordinates()));
        Angles(angles)
    }

    /// Number of angles.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// The angles at the given positions.
    pub fn at(&self, positions: impl IntoIterator<Item = usize>) -> impl Iterator<Item = &Angle> {
        positions.into_iter().map(|position| &self.0[position])
    }

    /// For each live sine and cosine of an angle of the mechanism, where that is among these.
    pub fn positions(&self, expressions: &Expressions) -> HashMap<usize, usize> {
        let mut known: HashMap<Edge, Option<usize>> = HashMap::new();
        trigonometric(expressions)
            .filter_map(|(node, angle)| {
                let position = known.entry(angle).or_insert_with(|| self.position(&expressions.graph, angle));
                Some((node, (*position)?))
            })
            .collect()
    }

    /// Where among the angles `edge` of `graph` is; `None` if it is not a sum of coordinates.
    fn position(&self, graph: &Graph, edge: Edge) -> Option<usize> {
        let wanted = Angle::of(graph, edge.abs())?;
        Some(
            self.0.iter().position(|angle| *angle == wanted).expect("all angles are collected before any is looked up"),
        )
    }

    /// The coordinates whose whole turns are taken off for the sums among the angles at the given positions, in order.
    pub fn summed(&self, positions: impl IntoIterator<Item = usize>) -> Vec<u32> {
        let terms = self.at(positions).flat_map(|angle| &angle.terms).filter(|term| term.without_turns);
        let mut coordinates: Vec<u32> = terms.map(|term| term.coordinate).collect();
        coordinates.sort_unstable();
        coordinates.dedup();
        coordinates
    }

    /// The positions of the angles whose sine or cosine `expressions` needs, in order.
    pub fn needed_by(&self, expressions: &Expressions) -> Vec<usize> {
        let mut needed: Vec<usize> = self.positions(expressions).into_values().collect();
        needed.sort_unstable();
        needed.dedup();
        needed
    }
}

/// Whether a node is the sine or cosine of an angle of the mechanism, which functions are given.
pub fn is_given(graph: &Graph, index: usize) -> bool {
    match graph.node(index) {
        Node::Sin(angle) | Node::Cos(angle) => Angle::of(graph, angle.abs()).is_some(),
        _ => false,
    }
}

/// The live sines and cosines of a function, with their arguments.
fn trigonometric(expressions: &Expressions) -> impl Iterator<Item = (usize, Edge)> {
    let uses = expressions.uses();
    (0..expressions.graph.len()).filter(move |&index| uses[index] > 0).filter_map(|index| {
        match expressions.graph.node(index) {
            Node::Sin(angle) | Node::Cos(angle) => Some((index, angle)),
            _ => None,
        }
    })
}
