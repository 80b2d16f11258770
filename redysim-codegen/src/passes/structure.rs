//! The invariants of every graph: operands precede the nodes that use them, equal values are one node, and every node
//! is as the constructors of [`Graph`] make it.

use super::PassFault;
use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};

/// The first fault in the structure of `after`, which a pass makes of `before`.
pub fn broken(before: &Expressions, after: &Expressions) -> Option<PassFault> {
    let (graph, outputs) = (&after.graph, &after.outputs);
    if outputs.len() != before.outputs.len() {
        return Some(PassFault::OutputCount { before: before.outputs.len(), after: outputs.len() });
    }
    if let Some(output) = outputs.iter().position(|output| output.node() >= graph.len()) {
        return Some(PassFault::OutputOutOfRange { output });
    }
    (0..graph.len()).find_map(|node| broken_node(&before.graph, graph, node))
}

/// What is wrong with one node of `after`.
fn broken_node(before: &Graph, after: &Graph, index: usize) -> Option<PassFault> {
    let node = after.node(index);
    if let Some(operand) = node.operands().map(Edge::node).find(|&operand| operand >= index) {
        return Some(PassFault::OperandOrder { node: index, operand });
    }
    if after.index_of(node) != Some(index) {
        return Some(PassFault::DuplicateNode { node: index });
    }
    match node {
        Node::Input { argument, index } if before.index_of(node).is_none() => {
            Some(PassFault::NewInput { argument, index })
        }
        _ if !is_canonical(after, node) => Some(PassFault::NotCanonical { node: index }),
        _ => None,
    }
}

/// Whether the constructors of the graph make such a node.
fn is_canonical(graph: &Graph, node: Node) -> bool {
    let constant = |edge: Edge| graph.constant_value(edge);
    match node {
        Node::Input { .. } | Node::Parameter { .. } => true,
        Node::Constant(bits) => !f64::from_bits(bits).is_sign_negative(),
        Node::Add(a, b) | Node::Subtract(a, b) => {
            !(a.is_negative() || b.is_negative())
                && a.node() < b.node()
                && !(constant(a).is_some() && constant(b).is_some())
        }
        Node::Multiply(a, b) => {
            let is_ordered = constant(a).is_some() || graph.order(a) <= graph.order(b);
            let is_trivial = constant(a).is_some_and(|factor| factor == 0.0 || factor == 1.0);
            !(a.is_negative() || b.is_negative()) && constant(b).is_none() && is_ordered && !is_trivial
        }
        Node::Divide(a, b) => !(a.is_negative() || b.is_negative()) && constant(b).is_none(),
        Node::Sin(a) | Node::Cos(a) => !a.is_negative() && constant(a).is_none(),
        Node::Sqrt(a) => constant(a).is_none(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// y = sin x (x + 2).
    fn sound() -> Expressions {
        let mut graph = Graph::default();
        let (x, two) = (graph.input(0, 0), graph.constant(2.0));
        let (sum, sine) = (graph.add(x, two), graph.sin(x));
        let output = graph.multiply(sine, sum);
        Expressions { graph, outputs: vec![output] }
    }

    /// The same with one more node, which no constructor checks.
    fn with_node(node: impl FnOnce(&Graph) -> Node) -> Option<PassFault> {
        let mut expressions = sound();
        let node = node(&expressions.graph);
        expressions.graph.push_unchecked(node);
        broken(&sound(), &expressions)
    }

    const NEXT: usize = 5;

    #[test]
    fn what_the_constructors_make_is_well_formed() {
        assert_eq!(sound().graph.len(), NEXT);
        assert_eq!(broken(&sound(), &sound()), None);
    }

    #[test]
    fn a_missing_output_is_reported() {
        let expressions = Expressions { outputs: Vec::new(), ..sound() };
        assert_eq!(broken(&sound(), &expressions), Some(PassFault::OutputCount { before: 1, after: 0 }));
    }

    #[test]
    fn an_output_outside_the_graph_is_reported() {
        let mut expressions = sound();
        expressions.outputs[0] = expressions.graph.edge(NEXT);
        assert_eq!(broken(&sound(), &expressions), Some(PassFault::OutputOutOfRange { output: 0 }));
    }

    #[test]
    fn an_operand_that_does_not_precede_its_node_is_reported() {
        for operand in [NEXT, NEXT + 7] {
            let fault = with_node(|graph| Node::Sqrt(graph.edge(operand)));
            assert_eq!(fault, Some(PassFault::OperandOrder { node: NEXT, operand }));
        }
    }

    #[test]
    fn an_equal_node_is_reported() {
        let fault = with_node(|graph| graph.node(2));
        assert_eq!(fault, Some(PassFault::DuplicateNode { node: NEXT }));
    }

    #[test]
    fn an_input_that_was_not_there_is_reported() {
        let fault = with_node(|_| Node::Input { argument: 0, index: 1 });
        assert_eq!(fault, Some(PassFault::NewInput { argument: 0, index: 1 }));
    }

    #[test]
    fn a_node_that_hides_an_equal_value_is_reported() {
        let not_canonical: [fn(&Graph) -> Node; 8] = [
            |graph| Node::Add(graph.edge(2), graph.edge(0)),
            |graph| Node::Subtract(-graph.edge(0), graph.edge(2)),
            |graph| Node::Multiply(graph.edge(0), graph.edge(1)),
            |graph| Node::Multiply(graph.edge(0), -graph.edge(2)),
            |graph| Node::Divide(graph.edge(0), graph.edge(1)),
            |graph| Node::Sin(-graph.edge(0)),
            |graph| Node::Cos(graph.edge(1)),
            |_| Node::Constant((-2.0_f64).to_bits()),
        ];
        for node in not_canonical {
            assert_eq!(with_node(node), Some(PassFault::NotCanonical { node: NEXT }));
        }
    }
}
