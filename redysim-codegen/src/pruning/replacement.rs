//! What may replace a value: one of its operands, or a number. So a term of a sum, a factor near 1, or the small change
//! of a cosine is left out.

use super::columns::{Columns, sign};
use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};
use crate::policies::PRICE_PER_PAIR;
use std::collections::HashMap;

/// A node and what replaces it.
#[derive(Clone, Copy, Debug)]
pub struct Replacement {
    pub node: usize,
    pub by: Simpler,
}

/// What replaces a node.
#[derive(Clone, Copy, Debug)]
pub enum Simpler {
    /// One of its operands, or the negative of it.
    Operand(Edge),
    /// A number.
    Number(f64),
}

/// Every replacement that may be tried for the nodes in `live`.
pub fn candidates(graph: &Graph, live: &[usize], values: &Columns) -> Vec<Replacement> {
    let mut found = Vec::new();
    for &node in live {
        let column = values.column(node);
        let mut offer = |by| found.push(Replacement { node, by });
        match graph.node(node) {
            Node::Input { .. } | Node::Constant(_) | Node::Parameter { .. } => continue,
            Node::Add(a, b) => [a, b].into_iter().for_each(|edge| offer(Simpler::Operand(edge))),
            Node::Subtract(a, b) => [a, -b].into_iter().for_each(|edge| offer(Simpler::Operand(edge))),
            Node::Multiply(a, b) => {
                for (kept, factor) in [(a, b), (b, a)] {
                    let factor_is_negative = sign(factor) * values.column(factor.node())[0] < 0.0;
                    offer(Simpler::Operand(kept.flipped_if(factor_is_negative)));
                }
            }
            Node::Divide(a, b) => {
                offer(Simpler::Operand(a.flipped_if(sign(b) * values.column(b.node())[0] < 0.0)));
            }
            Node::Sin(_) | Node::Cos(_) | Node::Sqrt(_) => {}
        }
        let least = column.iter().copied().fold(f64::INFINITY, f64::min);
        let largest = column.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        offer(Simpler::Number(0.0));
        offer(Simpler::Number(0.5 * (least + largest)));
    }
    found
}

impl Replacement {
    /// By how much the value of the node changes, state by state.
    pub fn change(&self, values: &Columns, out: &mut [f64]) {
        let own = values.column(self.node);
        let mut i = 0;
        match self.by {
            Simpler::Operand(edge) => {
                let (operand, sign) = (values.column(edge.node()), sign(edge));
                while i < out.len() {
                    out[i] = sign * operand[i] - own[i];
                    i += 1;
                }
            }
            Simpler::Number(number) => {
                while i < out.len() {
                    out[i] = number - own[i];
                    i += 1;
                }
            }
        }
    }
}

/// A graph with the replacements made so far: how often each node is used, and what replaces it.
pub struct Simplification<'a> {
    expressions: &'a Expressions,
    uses: Vec<usize>,
    replaced: Vec<Option<Simpler>>,
}

impl<'a> Simplification<'a> {
    /// The expressions without a replacement.
    pub fn new(expressions: &'a Expressions) -> Self {
        Simplification { expressions, uses: expressions.uses(), replaced: vec![None; expressions.graph.len()] }
    }

    /// What a replacement saves, as [`Expressions::price`] counts: the node with all that only it uses.
    pub fn saving(&self, replacement: &Replacement) -> u32 {
        let graph = &self.expressions.graph;
        if self.uses[replacement.node] == 0 || self.replaced[replacement.node].is_some() {
            return 0;
        }
        let mut saving = 0;
        let mut released: HashMap<usize, usize> = HashMap::new();
        let mut freed = vec![replacement.node];
        while let Some(node) = freed.pop() {
            saving += price(graph.node(node));
            for operand in graph.node(node).operands().map(Edge::node) {
                let stays = matches!(replacement.by, Simpler::Operand(edge) if edge.node() == operand);
                let count = released.entry(operand).or_insert(0);
                *count += 1;
                if *count == self.uses[operand] && !stays && self.replaced[operand].is_none() {
                    freed.push(operand);
                }
            }
        }
        saving
    }

    /// Makes a replacement.
    pub fn replace(&mut self, Replacement { node, by }: Replacement) {
        if let Simpler::Operand(edge) = by {
            self.uses[edge.node()] += 1;
        }
        self.replaced[node] = Some(by);
        self.release_operands(node);
    }

    /// Takes one use from each operand of a node and, where that was the last, from its operands in turn.
    fn release_operands(&mut self, node: usize) {
        let graph = &self.expressions.graph;
        let mut released: Vec<usize> = graph.node(node).operands().map(Edge::node).collect();
        while let Some(node) = released.pop() {
            self.uses[node] -= 1;
            if self.uses[node] > 0 {
                continue;
            }
            match self.replaced[node] {
                None => released.extend(graph.node(node).operands().map(Edge::node)),
                Some(Simpler::Operand(edge)) => released.push(edge.node()),
                Some(Simpler::Number(_)) => {}
            }
        }
    }

    /// The expressions with all replacements made.
    pub fn rebuilt(&self) -> Expressions {
        let old = &self.expressions.graph;
        self.expressions.rebuilt(
            |node| self.uses[node] > 0,
            |graph, node, mapped| match self.replaced[node] {
                Some(Simpler::Number(number)) => (graph.constant(number), None),
                Some(Simpler::Operand(edge)) => (mapped(edge), None),
                None => (graph.rebuild(old.node(node), mapped), old.name(node)),
            },
        )
    }
}

/// A sine or cosine is half a pair.
fn price(node: Node) -> u32 {
    match node {
        Node::Input { .. } | Node::Constant(_) | Node::Parameter { .. } => 0,
        Node::Sin(_) | Node::Cos(_) => PRICE_PER_PAIR / 2,
        Node::Add(..) | Node::Subtract(..) | Node::Multiply(..) | Node::Divide(..) | Node::Sqrt(_) => 1,
    }
}
