//! Sums taken as a whole: through all additions whose only use is the sum.

use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};

/// Which additions and subtractions are parts of larger sums.
pub struct Parts {
    /// Those whose only use is one larger sum; in a long function, one in the same step of a recursion.
    inner: Vec<bool>,
    /// Whether a sum with a fixed term also takes apart other sums of a value and a fixed term.
    takes_offsets_apart: bool,
    /// Whether the function is long, so that a sum does not extend into the steps of other bodies.
    by_body: bool,
}

impl Parts {
    /// The additions and subtractions that only one larger sum uses.
    pub fn used_once(expressions: &Expressions) -> Parts {
        let (graph, uses, by_body) = (&expressions.graph, expressions.uses(), expressions.is_long());
        let mut inner = vec![false; graph.len()];
        for index in (0..graph.len()).rev() {
            if uses[index] == 0 {
                continue;
            }
            if let Node::Add(a, b) | Node::Subtract(a, b) = graph.node(index) {
                for operand in [a, b].map(Edge::node) {
                    let is_sum = matches!(graph.node(operand), Node::Add(..) | Node::Subtract(..));
                    let within_reach = !by_body || graph.step(operand) == graph.step(index);
                    inner[operand] |= is_sum && uses[operand] == 1 && within_reach;
                }
            }
        }
        Parts { inner, takes_offsets_apart: false, by_body }
    }

    /// The same, and in sums with a fixed term the sums of a value and a fixed term, whatever else uses these: the two fixed
    /// terms are one. So the larger sum does not wait for the smaller one, which nothing has to compute if all that use it
    /// have a fixed term.
    pub fn with_offsets(expressions: &Expressions) -> Parts {
        Parts { takes_offsets_apart: true, ..Parts::used_once(expressions) }
    }

    /// The terms of the sum at `root`, each with its sign, in the order in which they are met.
    fn terms(&self, graph: &Graph, root: usize) -> Vec<Edge> {
        let terms = self.terms_of_parts(graph, root);
        if !(self.takes_offsets_apart && terms.iter().any(|&term| graph.is_fixed(term))) {
            return terms;
        }
        let taken_apart = |term: Edge| {
            let within_reach = !self.by_body || graph.step(term.node()) == graph.step(root);
            let parts = self.terms_of_parts(graph, term.node());
            let is_offset = parts.len() > 1 && parts.iter().filter(|&&part| !graph.is_fixed(part)).count() == 1;
            if within_reach && is_offset {
                parts.into_iter().map(|part| part.flipped_if(term.is_negative())).collect()
            } else {
                vec![term]
            }
        };
        terms.into_iter().flat_map(taken_apart).collect()
    }

    /// The terms of the sum at `root` and of its inner sums. The list is empty if `root` is not a sum.
    fn terms_of_parts(&self, graph: &Graph, root: usize) -> Vec<Edge> {
        let mut terms = Vec::new();
        let mut open = vec![(root, false)];
        while let Some((index, negative)) = open.pop() {
            let (Node::Add(a, b) | Node::Subtract(a, b)) = graph.node(index) else { continue };
            let second = matches!(graph.node(index), Node::Subtract(..)) != negative;
            for (operand, negative) in [(a, negative), (b, second)] {
                if self.inner[operand.node()] {
                    open.push((operand.node(), operand.is_negative() != negative));
                } else {
                    terms.push(operand.flipped_if(negative));
                }
            }
        }
        terms
    }
}

/// The live nodes in a new graph, with sums made by `sum` from their terms in the old graph, and without the parts that only
/// larger sums use.
pub fn with_sums(
    expressions: &Expressions,
    parts: &Parts,
    mut sum: impl FnMut(&mut Graph, &[Edge], &dyn Fn(Edge) -> Edge) -> Edge,
) -> Expressions {
    let old = &expressions.graph;
    let uses = expressions.uses();
    expressions.rebuilt(
        |index| uses[index] > 0 && !parts.inner[index],
        |graph, index, mapped| {
            let edge = match old.node(index) {
                Node::Add(..) | Node::Subtract(..) => sum(graph, &parts.terms(old, index), mapped),
                node => graph.rebuild(node, mapped),
            };
            (edge, old.name(index))
        },
    )
}
