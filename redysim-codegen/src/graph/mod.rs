//! Expressions as a graph in which equal values are one node.
//!
//! A value is an [`Edge`]: a node and a sign. Since the sign sits on the edge, negation costs nothing, −x and x share
//! one node, and a − b is b − a seen from the other side. Operands always have smaller indices than the node that
//! uses them, so every walk over the graph is a loop over indices.

mod node;

pub use node::{Edge, Leaf, Node};

use rustc_hash::FxHashMap;

/// The name of a value in the generated code: a component of a quantity of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Name {
    /// The quantity, as named in the recursions.
    pub quantity: &'static str,
    /// Index of the body in the tree.
    pub body: usize,
    /// The component; empty for a scalar.
    pub component: &'static str,
    /// Whether the name is that of the node's negative.
    pub negative: bool,
    /// How often the quantity is differentiated along a direction; 0 for the quantity itself.
    pub order: u8,
}

/// Where in a recursion a value arises: at body `body` of the sweep `sweep` over all bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Step {
    /// The name of the sweep in the recursion.
    pub sweep: &'static str,
    /// Index of the body in the tree.
    pub body: usize,
}

/// A hash-consed expression graph. Every constructor folds what can be folded without looking further than the
/// operands: constants, zeros and ones, equal terms, products with two constants.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    names: Vec<Option<Name>>,
    steps: Vec<Option<Step>>,
    /// Whether each node depends on parameters and constants alone, so that it is computed once for all calls.
    fixed: Vec<bool>,
    current_step: Option<Step>,
    indices: FxHashMap<Node, u32>,
}

impl Graph {
    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Whether there are no nodes.
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The node with the given index.
    pub fn node(&self, index: usize) -> Node {
        self.nodes[index]
    }

    /// The value of the node with the given index.
    pub fn edge(&self, index: usize) -> Edge {
        Edge { node: index as u32, negative: false }
    }

    /// The index of a node, if the graph has it.
    pub fn index_of(&self, node: Node) -> Option<usize> {
        self.indices.get(&node).map(|&index| index as usize)
    }

    /// The index of the node of a + b or its negative, if the graph has it.
    pub fn index_of_sum(&self, a: Edge, b: Edge) -> Option<usize> {
        self.index_of(sum(a, b).0)
    }

    /// The name of the node with the given index.
    pub fn name(&self, index: usize) -> Option<Name> {
        self.names[index]
    }

    /// Names a value; the first name stays.
    pub fn set_name(&mut self, edge: Edge, name: Name) {
        let negative = name.negative != edge.negative;
        self.names[edge.node()].get_or_insert(Name { negative, ..name });
    }

    /// The step in which the node with the given index arose.
    pub fn step(&self, index: usize) -> Option<Step> {
        self.steps[index]
    }

    /// Forgets in which steps nodes arose.
    pub fn forget_steps(&mut self) {
        self.steps.fill(None);
        self.current_step = None;
    }

    /// The step in which nodes arise now.
    pub fn current_step(&self) -> Option<Step> {
        self.current_step
    }

    /// Nodes that are made after this arise in `step`.
    pub fn enter_step(&mut self, step: Option<Step>) {
        self.current_step = step;
    }

    /// The value of a constant edge.
    pub fn constant_value(&self, edge: Edge) -> Option<f64> {
        match self.nodes[edge.node()] {
            Node::Constant(bits) => Some(if edge.negative { -f64::from_bits(bits) } else { f64::from_bits(bits) }),
            _ => None,
        }
    }

    /// The value of a node where parameters have those of the model, from the values of the nodes before it; NaN if it
    /// depends on an argument.
    pub fn nominal(&self, index: usize, before: &[f64]) -> f64 {
        self.node(index).evaluate(
            |edge| edge.signed(before[edge.node()]),
            |leaf| match leaf {
                Leaf::Constant(value) | Leaf::Parameter { nominal: value, .. } => value,
                Leaf::Input { .. } => f64::NAN,
            },
        )
    }

    /// Whether a value depends on parameters and constants alone.
    pub fn is_fixed(&self, edge: Edge) -> bool {
        self.fixed[edge.node()]
    }

    /// Number `index` of those that are given at run time, whose value in the model is `nominal`.
    pub fn parameter(&mut self, index: u32, nominal: f64) -> Edge {
        self.intern(Node::Parameter { index, nominal: nominal.to_bits() })
    }

    /// Element `index` of argument `argument`.
    pub fn input(&mut self, argument: u8, index: u32) -> Edge {
        self.intern(Node::Input { argument, index })
    }

    /// A constant.
    pub fn constant(&mut self, value: f64) -> Edge {
        self.intern(Node::Constant(value.abs().to_bits())).flipped_if(value < 0.0)
    }

    /// a + b.
    pub fn add(&mut self, a: Edge, b: Edge) -> Edge {
        if let (Some(x), Some(y)) = (self.constant_value(a), self.constant_value(b)) {
            return self.constant(x + y);
        }
        if self.constant_value(a) == Some(0.0) {
            return b;
        }
        if self.constant_value(b) == Some(0.0) {
            return a;
        }
        let ((x, a_base), (y, b_base)) = (self.coefficient(a), self.coefficient(b));
        if a_base == b_base {
            let factor = self.constant(sum_without_noise(x, y));
            return self.multiply(factor, a_base);
        }
        let ((x, a_base), (y, b_base)) = (self.fixed_coefficient(a), self.fixed_coefficient(b));
        if a_base == b_base && (x.is_some() || y.is_some()) {
            let [x, y] = [(x, a), (y, b)].map(|(factor, term)| self.factor_or_sign(factor, term));
            let factor = self.add(x, y);
            return self.multiply(factor, a_base);
        }
        let (node, negative) = sum(a, b);
        self.intern(node).flipped_if(negative)
    }

    /// a · b.
    pub fn multiply(&mut self, a: Edge, b: Edge) -> Edge {
        let (a, b) = match (self.constant_value(a), self.constant_value(b)) {
            (Some(x), Some(y)) => return self.constant(x * y),
            (None, Some(_)) => (b, a),
            (None, None) if self.order(b) < self.order(a) => (b, a),
            _ => (a, b),
        };
        if let Some(x) = self.constant_value(a) {
            if x == 0.0 {
                return a.abs();
            }
            if x.abs() == 1.0 {
                return b.flipped_if(x < 0.0);
            }
            let (y, base) = self.coefficient(b);
            if y.abs() != 1.0 {
                let factor = self.constant(x * y);
                return self.multiply(factor, base);
            }
        }
        // Factors that are given at run time become one, which costs nothing in a call.
        if self.is_fixed(a)
            && let (Some(factor), base) = self.fixed_coefficient(b)
        {
            let factor = self.multiply(a, factor);
            return self.multiply(factor, base);
        }
        self.intern(Node::Multiply(a.abs(), b.abs())).flipped_if(a.negative != b.negative)
    }

    /// a / b. Division by a constant is multiplication by its reciprocal.
    pub fn divide(&mut self, a: Edge, b: Edge) -> Edge {
        if self.constant_value(a) == Some(0.0) {
            return a.abs();
        }
        if let Some(y) = self.constant_value(b) {
            let reciprocal = self.constant(1.0 / y);
            return self.multiply(a, reciprocal);
        }
        if a.abs() == b.abs() {
            return self.constant(if a == b { 1.0 } else { -1.0 });
        }
        self.intern(Node::Divide(a.abs(), b.abs())).flipped_if(a.negative != b.negative)
    }

    /// sin a; an odd function.
    pub fn sin(&mut self, a: Edge) -> Edge {
        match self.constant_value(a) {
            Some(x) => self.constant(redysim_model::rotation::sin_cos(x).0),
            None => self.intern(Node::Sin(a.abs())).flipped_if(a.negative),
        }
    }

    /// cos a; an even function.
    pub fn cos(&mut self, a: Edge) -> Edge {
        match self.constant_value(a) {
            Some(x) => self.constant(redysim_model::rotation::sin_cos(x).1),
            None => self.intern(Node::Cos(a.abs())),
        }
    }

    /// The square root of a.
    pub fn sqrt(&mut self, a: Edge) -> Edge {
        match self.constant_value(a) {
            Some(x) => self.constant(x.sqrt()),
            None => self.intern(Node::Sqrt(a)),
        }
    }

    /// The value as a constant times a node that is not such a product itself.
    pub fn coefficient(&self, edge: Edge) -> (f64, Edge) {
        let sign = if edge.negative { -1.0 } else { 1.0 };
        if let Node::Multiply(factor, base) = self.nodes[edge.node()]
            && let Some(value) = self.constant_value(factor)
        {
            return (sign * value, base);
        }
        (sign, edge.abs())
    }

    /// The value as a product of a factor that is [fixed](Self::is_fixed), but not a constant, and a value that is not
    /// fixed. Returns `None` and the value without its sign for any other value.
    pub fn fixed_coefficient(&self, edge: Edge) -> (Option<Edge>, Edge) {
        match self.nodes[edge.node()] {
            Node::Multiply(factor, base)
                if self.is_fixed(factor) && self.constant_value(factor).is_none() && !self.is_fixed(base) =>
            {
                (Some(factor.flipped_if(edge.negative)), base)
            }
            _ => (None, edge.abs()),
        }
    }

    /// `factor`, or its default: the sign of `term` as a constant.
    pub fn factor_or_sign(&mut self, factor: Option<Edge>, term: Edge) -> Edge {
        factor.unwrap_or_else(|| self.constant(if term.negative { -1.0 } else { 1.0 }))
    }

    /// By which the factors of a product are in order: those that are given at run time first.
    pub fn order(&self, edge: Edge) -> (bool, u32) {
        (!self.is_fixed(edge), edge.node)
    }

    /// Makes a node of another graph again in this one, from operands already made here.
    pub fn rebuild(&mut self, node: Node, map: impl Fn(Edge) -> Edge) -> Edge {
        match node {
            Node::Input { argument, index } => self.input(argument, index),
            Node::Constant(bits) => self.constant(f64::from_bits(bits)),
            Node::Parameter { index, nominal } => self.parameter(index, f64::from_bits(nominal)),
            Node::Add(a, b) => self.add(map(a), map(b)),
            Node::Subtract(a, b) => self.add(map(a), -map(b)),
            Node::Multiply(a, b) => self.multiply(map(a), map(b)),
            Node::Divide(a, b) => self.divide(map(a), map(b)),
            Node::Sin(a) => self.sin(map(a)),
            Node::Cos(a) => self.cos(map(a)),
            Node::Sqrt(a) => self.sqrt(map(a)),
        }
    }

    /// A node as it is, which no constructor has checked.
    #[cfg(test)]
    pub fn push_unchecked(&mut self, node: Node) {
        let index = self.nodes.len() as u32;
        self.fixed.push(self.is_fixed_node(node));
        self.nodes.push(node);
        self.names.push(None);
        self.steps.push(None);
        self.indices.entry(node).or_insert(index);
    }

    fn is_fixed_node(&self, node: Node) -> bool {
        match node {
            Node::Input { .. } => false,
            node => node.operands().all(|operand| self.fixed.get(operand.node()).is_some_and(|&fixed| fixed)),
        }
    }

    fn intern(&mut self, node: Node) -> Edge {
        let fixed = self.is_fixed_node(node);
        let index = *self.indices.entry(node).or_insert_with(|| {
            self.fixed.push(fixed);
            self.nodes.push(node);
            self.names.push(None);
            self.steps.push(self.current_step);
            (self.nodes.len() - 1) as u32
        });
        Edge { node: index, negative: false }
    }
}

/// The node of a + b, and whether it is that of the negative.
fn sum(a: Edge, b: Edge) -> (Node, bool) {
    let (a, b) = if a.node < b.node { (a, b) } else { (b, a) };
    let (first, second) = (a.abs(), b.abs());
    let node = if a.negative == b.negative { Node::Add(first, second) } else { Node::Subtract(first, second) };
    (node, a.negative)
}

/// x + y, or zero where nothing but the roundoff of the two is left.
pub(crate) fn sum_without_noise(x: f64, y: f64) -> f64 {
    let sum = x + y;
    if sum.abs() <= 4.0 * f64::EPSILON * x.abs().max(y.abs()) { 0.0 } else { sum }
}
