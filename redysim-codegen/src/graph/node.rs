//! Nodes: operations and leaves, and the edges between them.

use redysim_runtime::Scalar;
use std::ops::Neg;

/// A value: a node, or its negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Edge {
    pub(super) node: u32,
    pub(super) negative: bool,
}

impl Edge {
    /// The index of the node.
    pub fn node(self) -> usize {
        self.node as usize
    }

    /// Whether the value is the negative of the node's.
    pub fn is_negative(self) -> bool {
        self.negative
    }

    /// The value with the sign of the node.
    pub fn abs(self) -> Edge {
        Edge { negative: false, ..self }
    }

    /// The negative of the value if `flip`, else the value.
    pub fn flipped_if(self, flip: bool) -> Edge {
        Edge { negative: self.negative != flip, ..self }
    }
}

impl std::ops::Neg for Edge {
    type Output = Edge;
    fn neg(self) -> Edge {
        self.flipped_if(true)
    }
}

/// One operation. Operands of products and sums are ordered and carry no sign that could stand outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// Element `index` of argument `argument` of the function.
    Input {
        /// Position in the function's list of arguments.
        argument: u8,
        /// Index in the array.
        index: u32,
    },
    /// A positive constant, by its bits.
    Constant(u64),
    /// A number that is given at run time, once for all calls of the function.
    Parameter {
        /// Its index among the numbers that are given.
        index: u32,
        /// Its value in the model, by its bits: what stands for it where values are sampled.
        nominal: u64,
    },
    /// a + b.
    Add(Edge, Edge),
    /// a − b.
    Subtract(Edge, Edge),
    /// a · b; a constant comes first.
    Multiply(Edge, Edge),
    /// a / b.
    Divide(Edge, Edge),
    /// sin a.
    Sin(Edge),
    /// cos a.
    Cos(Edge),
    /// The square root of a.
    Sqrt(Edge),
}

impl Node {
    /// The operands.
    pub fn operands(self) -> impl Iterator<Item = Edge> {
        let (a, b) = match self {
            Node::Input { .. } | Node::Constant(_) | Node::Parameter { .. } => (None, None),
            Node::Add(a, b) | Node::Subtract(a, b) | Node::Multiply(a, b) | Node::Divide(a, b) => (Some(a), Some(b)),
            Node::Sin(a) | Node::Cos(a) | Node::Sqrt(a) => (Some(a), None),
        };
        a.into_iter().chain(b)
    }

    /// How long the operation takes, in units of an addition: a division takes several times as long, and the sines and
    /// cosines of angles come before all else.
    pub(crate) fn latency(self) -> u32 {
        match self {
            Node::Input { .. } | Node::Constant(_) | Node::Parameter { .. } => 0,
            Node::Sin(_) | Node::Cos(_) | Node::Add(..) | Node::Subtract(..) | Node::Multiply(..) => 1,
            Node::Divide(..) | Node::Sqrt(_) => 4,
        }
    }

    /// The value of the node, computed with any scalar from the values of its operands; `leaf` gives those of inputs,
    /// constants and parameters.
    pub fn evaluate<S: Scalar>(self, at: impl Fn(Edge) -> S, leaf: impl FnOnce(Leaf) -> S) -> S {
        match self {
            Node::Input { argument, index } => leaf(Leaf::Input { argument, index }),
            Node::Constant(bits) => leaf(Leaf::Constant(f64::from_bits(bits))),
            Node::Parameter { index, nominal } => leaf(Leaf::Parameter { index, nominal: f64::from_bits(nominal) }),
            Node::Add(a, b) => at(a) + at(b),
            Node::Subtract(a, b) => at(a) - at(b),
            Node::Multiply(a, b) => at(a) * at(b),
            Node::Divide(a, b) => at(a) / at(b),
            Node::Sin(a) => at(a).sin_cos().0,
            Node::Cos(a) => at(a).sin_cos().1,
            Node::Sqrt(a) => at(a).sqrt(),
        }
    }
}

impl Edge {
    /// A node's value as that of the edge.
    pub fn signed<S: Neg<Output = S>>(self, value: S) -> S {
        if self.negative { -value } else { value }
    }
}

/// A node without operands.
#[derive(Clone, Copy, Debug)]
pub enum Leaf {
    /// Element `index` of argument `argument`.
    Input {
        /// Position in the function's list of arguments.
        argument: u8,
        /// Index in the array.
        index: u32,
    },
    /// A constant.
    Constant(f64),
    /// A number that is given at run time.
    Parameter {
        /// Its index among those that are given.
        index: u32,
        /// Its value in the model.
        nominal: f64,
    },
}
