//! Operations of corresponding bodies, put together.
//!
//! A pack has one value of each branch. Those to begin with are operations of the same form at corresponding bodies in
//! the same sweep; their operands are packs in turn, down to what is the same for all branches, to constants, and to
//! values that have to be gathered.

use super::Siblings;
use super::forms::{dependence, forms};
use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};
use redysim_model::Function;
use std::collections::HashMap;

/// A value of each branch.
#[derive(Clone, Debug)]
pub enum Pack {
    /// One node, which all branches read.
    Same(usize),
    /// A node for each branch, which is computed outside.
    Each(Vec<usize>),
    /// An operation for each branch.
    Operation(Operation),
}

/// The same operation for each branch.
#[derive(Clone, Debug)]
pub struct Operation {
    /// The node of each branch. The first one has the kind of the operation.
    pub nodes: Vec<usize>,
    /// The operands.
    pub operands: Vec<Operand>,
}

/// An operand of an operation.
#[derive(Clone, Debug)]
pub struct Operand {
    /// Its values.
    pub source: Source,
    /// For each branch, whether the operation has it with a minus sign.
    pub minus: Vec<bool>,
}

/// Where the values of an operand come from.
#[derive(Clone, Debug)]
pub enum Source {
    /// A positive constant for each branch.
    Constants(Vec<f64>),
    /// A pack, by its index.
    Pack(usize),
}

/// What kind of operation a node is; whether a sum has a minus sign is a matter of signs.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// a + b or a − b.
    Sum,
    /// a b.
    Product,
    /// a / b.
    Quotient,
    /// The square root of a.
    Root,
}

impl Kind {
    /// The kind of a node that is an operation.
    pub fn of(node: Node) -> Kind {
        match node {
            Node::Add(..) | Node::Subtract(..) => Kind::Sum,
            Node::Multiply(..) => Kind::Product,
            Node::Divide(..) => Kind::Quotient,
            _ => Kind::Root,
        }
    }
}

impl Operation {
    /// What kind of operation it is.
    pub fn kind(&self, graph: &Graph) -> Kind {
        Kind::of(graph.node(self.nodes[0]))
    }
}

/// The packs of a function for the given siblings, operands first. `live` marks the operations of the function's code.
pub fn packs(expressions: &Expressions, live: &[bool], function: Function, siblings: &Siblings) -> Vec<Pack> {
    let graph = &expressions.graph;
    let forms = &forms(graph, function, siblings);
    let places = Places::of(graph, live, forms, function, siblings);
    let mut first = places.alike(&expressions.outputs);
    // Packs to be made, by their node of the first branch.
    let mut wanted: Vec<Vec<Vec<usize>>> = vec![Vec::new(); graph.len()];
    let mut made: HashMap<Vec<usize>, usize> = HashMap::new();
    let mut packs: Vec<(Vec<usize>, Vec<OperandNodes>)> = Vec::new();
    for node in (0..graph.len()).rev() {
        let mut here = std::mem::take(&mut wanted[node]);
        if here.is_empty() {
            here.extend(first.remove(&node));
        }
        for nodes in here {
            if made.contains_key(&nodes) {
                continue;
            }
            let operands = if places.can_be_packed(&nodes) { aligned(graph, forms, &nodes) } else { Vec::new() };
            for operand in operands.iter().filter(|operand| !operand.is_constant(graph)) {
                wanted[operand.nodes[0]].push(operand.nodes.clone());
            }
            made.insert(nodes.clone(), packs.len());
            packs.push((nodes, operands));
        }
    }
    let last = packs.len().wrapping_sub(1);
    let source = |operand: OperandNodes| {
        let constant = |&node: &usize| graph.constant_value(graph.edge(node));
        let constants: Option<Vec<f64>> = operand.nodes.iter().map(constant).collect();
        let source = constants.map_or_else(|| Source::Pack(last - made[&operand.nodes]), Source::Constants);
        Operand { source, minus: operand.minus }
    };
    let pack = |(nodes, operands): (Vec<usize>, Vec<OperandNodes>)| {
        if !operands.is_empty() {
            Pack::Operation(Operation { nodes, operands: operands.into_iter().map(source).collect() })
        } else if nodes.iter().all(|node| *node == nodes[0]) {
            Pack::Same(nodes[0])
        } else {
            Pack::Each(nodes)
        }
    };
    packs.into_iter().rev().map(pack).collect()
}

/// The nodes of an operand, and its signs.
struct OperandNodes {
    nodes: Vec<usize>,
    minus: Vec<bool>,
}

impl OperandNodes {
    fn is_constant(&self, graph: &Graph) -> bool {
        self.nodes.iter().all(|&node| matches!(graph.node(node), Node::Constant(_)))
    }
}

/// Which nodes belong together.
struct Places<'a> {
    graph: &'a Graph,
    live: &'a [bool],
    forms: &'a [u64],
    siblings: &'a Siblings,
    /// The branch of each node that depends on one branch alone or arises at a body of it.
    branches: Vec<Option<usize>>,
}

impl<'a> Places<'a> {
    fn of(graph: &'a Graph, live: &'a [bool], forms: &'a [u64], function: Function, siblings: &'a Siblings) -> Self {
        let dependence = dependence(graph, function, siblings);
        let of_body = |body: usize| siblings.branches.iter().position(|branch| branch.bodies.contains(&body));
        let branch = |node: usize| match dependence[node].count_ones() {
            1 => Some(dependence[node].trailing_zeros() as usize),
            _ => graph.step(node).and_then(|step| of_body(step.body)),
        };
        Places { graph, live, forms, siblings, branches: (0..graph.len()).map(branch).collect() }
    }

    /// The packs to begin with, by their node of the first branch: operations of the same form in each branch, in their
    /// order, and the results for corresponding velocities.
    fn alike(&self, outputs: &[Edge]) -> HashMap<usize, Vec<usize>> {
        let mut alike: HashMap<u64, Vec<Vec<usize>>> = HashMap::new();
        for node in (0..self.graph.len()).filter(|&node| self.live[node]) {
            if let Some(branch) = self.branches[node] {
                let of_form = alike.entry(self.forms[node]);
                of_form.or_insert_with(|| vec![Vec::new(); self.siblings.branches.len()])[branch].push(node);
            }
        }
        let of_all = alike.into_values().filter(|nodes| nodes.iter().all(|other| other.len() == nodes[0].len()));
        let packs = of_all.flat_map(|nodes| {
            (0..nodes[0].len()).map(move |i| nodes.iter().map(|branch| branch[i]).collect::<Vec<usize>>())
        });
        let velocities = self.siblings.branches.iter().map(|branch| branch.velocities.len()).min().unwrap_or(0);
        let results = outputs.chunks_exact(self.siblings.velocities).flat_map(|row| {
            let result = |place: usize| -> Vec<usize> {
                self.siblings.branches.iter().map(|branch| row[branch.velocities[place]].node()).collect()
            };
            (0..velocities).map(result).collect::<Vec<_>>()
        });
        results.filter(|nodes| self.can_be_packed(nodes)).chain(packs).map(|nodes| (nodes[0], nodes)).collect()
    }

    /// Whether nodes are operations of one kind, not all the same one, of one form or of one branch each.
    fn can_be_packed(&self, nodes: &[usize]) -> bool {
        let kind = |node: usize| Kind::of(self.graph.node(node));
        nodes.iter().any(|node| *node != nodes[0])
            && nodes.iter().all(|&node| self.live[node] && kind(node) == kind(nodes[0]))
            && (nodes.iter().all(|&node| self.forms[node] == self.forms[nodes[0]])
                || nodes.iter().all(|&node| self.branches[node].is_some()))
    }
}

/// The operands of operations of one kind, in an order in which those of the same form belong together.
fn aligned(graph: &Graph, forms: &[u64], nodes: &[usize]) -> Vec<OperandNodes> {
    let signed = |node: usize| -> Vec<Edge> {
        match graph.node(node) {
            Node::Subtract(a, b) => vec![a, -b],
            node => node.operands().collect(),
        }
    };
    let first = signed(nodes[0]);
    let is_ordered = matches!(Kind::of(graph.node(nodes[0])), Kind::Quotient | Kind::Root);
    let mut aligned: Vec<OperandNodes> =
        first.iter().map(|_| OperandNodes { nodes: Vec::new(), minus: Vec::new() }).collect();
    for &node in nodes {
        let mut operands = signed(node);
        if let ([a, b], [x, y], false) = (&first[..], &operands[..], is_ordered) {
            let likeness = |one: Edge, other: Edge| {
                2 * u32::from(forms[one.node()] == forms[other.node()]) + u32::from(one.node() == other.node())
            };
            if likeness(*a, *y) + likeness(*b, *x) > likeness(*a, *x) + likeness(*b, *y) {
                operands.swap(0, 1);
            }
        }
        for (operand, edge) in aligned.iter_mut().zip(operands) {
            operand.nodes.push(edge.node());
            operand.minus.push(edge.is_negative());
        }
    }
    aligned
}
