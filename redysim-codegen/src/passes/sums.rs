//! Like terms of a sum become one: x·c + y + x·d is x·(c + d) + y.
//!
//! A constructor of the graph sees two terms at a time; this pass sees a whole sum, through all additions whose only
//! use is the sum. Constants and what is given at run time become one term, also with that of a smaller sum which has other
//! uses: x + 1 and x + 1 + 2 become x + 1 and x + 3. A coefficient that is only roundoff vanishes.
//!
//! In a long function each body is treated by itself, so that uniform bodies stay uniform and their code can be a loop:
//! a sum does not extend into the steps of other bodies. What other sweeps have computed counts as ready, what the same
//! sweep has computed at another body as late.

use super::terms::{Parts, with_sums};
use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Step, sum_without_noise};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

/// The expressions with like terms collected.
pub fn collected(expressions: &Expressions) -> Expressions {
    let mut depths = Depths { by_body: expressions.is_long(), depths: Vec::new(), in_step: Vec::new() };
    with_sums(expressions, &Parts::with_offsets(expressions), |graph, terms, mapped| {
        let (constant, coefficients) = collect(graph, terms, mapped);
        let mut terms = vec![constant];
        for (base, factor) in coefficients {
            terms.push(graph.multiply(factor, base));
        }
        terms.retain(|&term| graph.constant_value(term) != Some(0.0));
        // Added up again so that the result is ready soonest.
        depths.add_up(graph, terms)
    })
}

/// What does not depend on the arguments and, in the order in which they are met, the coefficients of all other terms of
/// a sum.
fn collect(graph: &mut Graph, operands: &[Edge], mapped: &dyn Fn(Edge) -> Edge) -> (Edge, Vec<(Edge, Edge)>) {
    let mut fixed = Coefficient::default();
    let mut terms: Vec<(Edge, Coefficient)> = Vec::new();
    let mut places: HashMap<Edge, usize> = HashMap::new();
    for edge in operands.iter().map(|&operand| mapped(operand)) {
        if graph.is_fixed(edge) {
            fixed.add(graph, edge);
            continue;
        }
        let (factor, base) = match graph.fixed_coefficient(edge) {
            (Some(factor), base) => (factor, base),
            (None, _) => {
                let (factor, base) = graph.coefficient(edge);
                (graph.constant(factor), base)
            }
        };
        let place = *places.entry(base).or_insert(terms.len());
        if place == terms.len() {
            terms.push((base, Coefficient::default()));
        }
        terms[place].1.add(graph, factor);
    }
    let mut whole = |coefficient: Coefficient| coefficient.whole(graph);
    (whole(fixed), terms.into_iter().map(|(base, coefficient)| (base, whole(coefficient))).collect())
}

/// A sum of numbers that do not depend on the arguments of the function.
#[derive(Default)]
struct Coefficient {
    constant: f64,
    /// What depends on parameters.
    given: Option<Edge>,
}

impl Coefficient {
    fn add(&mut self, graph: &mut Graph, factor: Edge) {
        match graph.constant_value(factor) {
            Some(value) => self.constant = sum_without_noise(self.constant, value),
            None => self.given = Some(self.given.map_or(factor, |given| graph.add(given, factor))),
        }
    }

    fn whole(self, graph: &mut Graph) -> Edge {
        let constant = graph.constant(self.constant);
        self.given.map_or(constant, |given| graph.add(constant, given))
    }
}

/// The length of the longest chain of operations that each node of a graph waits for.
struct Depths {
    /// Whether to count from the start of each body's step.
    by_body: bool,
    depths: Vec<u32>,
    /// The depth within its own step.
    in_step: Vec<u32>,
}

/// The depth of what the same sweep has computed at another body.
const LATE: u32 = 1000;

impl Depths {
    fn of(&mut self, graph: &Graph, edge: Edge) -> u32 {
        for index in self.depths.len()..graph.len() {
            let own = graph.node(index).latency();
            let step = graph.step(index);
            let operands = || graph.node(index).operands().map(Edge::node);
            let depth = operands().map(|operand| self.seen_from(graph, step, operand)).max().unwrap_or(0);
            let same_step = operands().filter(|&operand| graph.step(operand) == step);
            let in_step = same_step.map(|operand| self.in_step[operand]).max().unwrap_or(0);
            self.depths.push(own + depth);
            self.in_step.push(own + in_step);
        }
        self.depths[edge.node()]
    }

    /// The depth of a term for the step that is being computed.
    fn of_term(&mut self, graph: &Graph, term: Edge) -> u32 {
        self.of(graph, term);
        self.seen_from(graph, graph.current_step(), term.node())
    }

    /// The depth of `operand` for what is computed in the step `here`.
    fn seen_from(&self, graph: &Graph, here: Option<Step>, operand: usize) -> u32 {
        match (here, graph.step(operand)) {
            (Some(here), Some(there)) if self.by_body && here != there => {
                if here.sweep == there.sweep {
                    LATE + self.in_step[operand]
                } else {
                    0
                }
            }
            _ => self.depths[operand],
        }
    }

    /// The sum of all terms: always of the two that are ready first, so that none waits for what it does not need.
    fn add_up(&mut self, graph: &mut Graph, terms: Vec<Edge>) -> Edge {
        let mut ready: BinaryHeap<Reverse<(u32, usize, Edge)>> = BinaryHeap::new();
        for (order, term) in terms.into_iter().enumerate() {
            ready.push(Reverse((self.of_term(graph, term), order, term)));
        }
        loop {
            let Some(Reverse((_, order, first))) = ready.pop() else { return graph.constant(0.0) };
            let Some(Reverse((_, _, second))) = ready.pop() else { return first };
            let sum = graph.add(first, second);
            ready.push(Reverse((self.of(graph, sum), order, sum)));
        }
    }
}
