//! The steps of a recursion, and which of them are uniform.

use super::is_operation;
use crate::graph::{Edge, Graph, Node, Step};
use std::collections::HashMap;
use std::ops::Range;

/// The steps of all sweeps.
pub struct Steps {
    sweeps: Vec<&'static str>,
    /// The operations of each step, in order.
    nodes: HashMap<(&'static str, usize), Vec<usize>>,
    /// The same, without constants and relative to the body.
    forms: HashMap<(&'static str, usize), Vec<Form>>,
    bodies: usize,
}

/// An operation without its constants, described relative to its body.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Form {
    operation: Operation,
    operands: [Option<Operand>; 2],
}

/// The kind of an operation; whether a sum has a minus sign is a matter of signs, not of form.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Operation {
    Sum,
    Product,
    Quotient,
    Root,
}

/// Where an operand comes from. Bodies and indices are differences to the body of the operation.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Operand {
    Constant,
    Input {
        argument: u8,
        index: isize,
    },
    Sin(isize),
    Cos(isize),
    /// Operation `position` of the step of `sweep`.
    Step {
        sweep: &'static str,
        body: isize,
        position: usize,
    },
    /// A number that is given at run time, the same at every body.
    Parameter(u32),
    /// An operation that belongs to no step.
    Outside(usize),
}

impl Steps {
    /// The steps of a graph. `live` marks the operations of the function's code.
    pub fn of(graph: &Graph, live: &[bool], positions: &HashMap<usize, usize>) -> Steps {
        let mut steps = Steps { sweeps: Vec::new(), nodes: HashMap::new(), forms: HashMap::new(), bodies: 0 };
        let mut places = vec![0; graph.len()];
        let step_of = at_the_bodies_that_they_read(graph, live);
        for node in (0..graph.len()).filter(|&node| live[node]) {
            let Some(step) = step_of[node] else { continue };
            if !steps.sweeps.contains(&step.sweep) {
                steps.sweeps.push(step.sweep);
            }
            steps.bodies = steps.bodies.max(step.body + 1);
            let nodes = steps.nodes.entry((step.sweep, step.body)).or_default();
            places[node] = nodes.len();
            nodes.push(node);
        }
        for (&(sweep, body), nodes) in &steps.nodes {
            let operand = |edge: Edge| match graph.node(edge.node()) {
                Node::Constant(_) => Operand::Constant,
                Node::Input { argument, index } => Operand::Input { argument, index: index as isize - body as isize },
                Node::Parameter { index, .. } => Operand::Parameter(index),
                Node::Sin(_) => Operand::Sin(positions[&edge.node()] as isize - body as isize),
                Node::Cos(_) => Operand::Cos(positions[&edge.node()] as isize - body as isize),
                _ => match step_of[edge.node()] {
                    None => Operand::Outside(edge.node()),
                    Some(step) => Operand::Step {
                        sweep: step.sweep,
                        body: step.body as isize - body as isize,
                        position: places[edge.node()],
                    },
                },
            };
            let forms = nodes.iter().map(|&node| {
                let mut operands = graph.node(node).operands().map(operand);
                Form { operation: operation(graph.node(node)), operands: [operands.next(), operands.next()] }
            });
            steps.forms.insert((sweep, body), forms.collect());
        }
        steps
    }

    /// The names of the sweeps.
    pub fn sweeps(&self) -> impl Iterator<Item = &'static str> {
        self.sweeps.iter().copied()
    }

    /// The operations of one step.
    pub fn nodes(&self, sweep: &'static str, body: usize) -> &[usize] {
        self.nodes.get(&(sweep, body)).map_or(&[], Vec::as_slice)
    }

    /// The longest run of uniform bodies: every sweep does the same on each as on the body `period` further on. Cut to
    /// whole groups of `period` bodies.
    pub fn longest_run(&self, period: usize) -> Option<Range<usize>> {
        let uniform = |body: usize| {
            self.sweeps().all(|sweep| self.forms.get(&(sweep, body)) == self.forms.get(&(sweep, body + period)))
        };
        let mut longest = 0..0;
        let mut start = 0;
        for body in 0..self.bodies {
            if body + period < self.bodies && uniform(body) {
                continue;
            }
            let end = (body + period).min(self.bodies);
            let length = (end - start) / period * period;
            if length > longest.len() {
                longest = start..start + length;
            }
            start = body + 1;
        }
        (!longest.is_empty()).then_some(longest)
    }
}

/// The step of each live operation. An operation is moved to another body if all steps that it reads are of that body
/// and at least one of them is of another sweep, as for the derivative of a child's rotation times the child's wrench. A
/// loop then reads from other loops only values of its own group.
fn at_the_bodies_that_they_read(graph: &Graph, live: &[bool]) -> Vec<Option<Step>> {
    let mut steps: Vec<Option<Step>> = vec![None; graph.len()];
    for node in (0..graph.len()).filter(|&node| live[node]) {
        let Some(own) = graph.step(node) else { continue };
        let read = || graph.node(node).operands().filter_map(|operand| steps[operand.node()]);
        let of_another_sweep = read().find(|step| step.sweep != own.sweep);
        let moved = of_another_sweep.filter(|moved| read().all(|step| step.body == moved.body));
        steps[node] = Some(moved.map_or(own, |Step { body, .. }| Step { body, ..own }));
    }
    steps
}

fn operation(node: Node) -> Operation {
    debug_assert!(is_operation(node));
    match node {
        Node::Add(..) | Node::Subtract(..) => Operation::Sum,
        Node::Multiply(..) => Operation::Product,
        Node::Divide(..) => Operation::Quotient,
        _ => Operation::Root,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::angles::Angles;
    use crate::expressions::Expressions;
    use crate::reroll::operations;
    use crate::tracing::tests::{chain_of_40, derivative_on};
    use crate::tracing::traced_on;
    use redysim_model::Function;

    fn uniform_bodies(expressions: &Expressions) -> Option<Range<usize>> {
        let positions = Angles::of([expressions]).positions(expressions);
        Steps::of(&expressions.graph, &operations(expressions), &positions).longest_run(1)
    }

    #[test]
    fn the_bodies_that_are_uniform_in_a_function_are_uniform_in_its_derivative() {
        let (tree, function) = (chain_of_40(), Function::InverseDynamics);
        let plain = uniform_bodies(&traced_on(&tree, function));
        let derivative = uniform_bodies(&derivative_on(&tree, function));
        assert!(plain.as_ref().is_some_and(|bodies| bodies.len() > 30), "{plain:?}");
        assert_eq!(derivative, plain);
    }
}
