//! The body of one function: a graph and the values it returns.

use crate::angles::is_given;
use crate::graph::{Edge, Graph, Leaf, Name, Node};
use crate::policies::{LONGEST_UNROLLED, PRICE_PER_DIVISION, PRICE_PER_PAIR};
use redysim_runtime::{OperationCount, Scalar};
use std::collections::{BTreeSet, HashSet};

/// A graph with its outputs.
#[derive(Clone, Debug)]
pub struct Expressions {
    /// The graph.
    pub graph: Graph,
    /// The values returned, in order.
    pub outputs: Vec<Edge>,
}

impl Expressions {
    /// How often each node is used, by outputs and by live nodes. A node without a use is dead.
    pub fn uses(&self) -> Vec<usize> {
        let mut uses = vec![0; self.graph.len()];
        for output in &self.outputs {
            uses[output.node()] += 1;
        }
        for index in (0..self.graph.len()).rev() {
            if uses[index] > 0 {
                for operand in self.graph.node(index).operands() {
                    uses[operand.node()] += 1;
                }
            }
        }
        uses
    }

    /// How often each value is read in the code of the function, to which sines and cosines of angles are given.
    pub fn uses_in_code(&self) -> Vec<usize> {
        let graph = &self.graph;
        let mut uses = vec![0; graph.len()];
        for output in &self.outputs {
            uses[output.node()] += 1;
        }
        for index in (0..graph.len()).rev() {
            if uses[index] > 0 && !is_given(graph, index) {
                graph.node(index).operands().for_each(|operand| uses[operand.node()] += 1);
            }
        }
        uses
    }

    /// For each output, the inputs on which it depends: the position of the argument and the index in it.
    pub fn inputs_of_outputs(&self) -> Vec<BTreeSet<(u8, u32)>> {
        let of_output = |output: &Edge| {
            let (mut inputs, mut seen, mut rest) = (BTreeSet::new(), HashSet::new(), vec![output.node()]);
            while let Some(index) = rest.pop() {
                match self.graph.node(index) {
                    Node::Input { argument, index } => drop(inputs.insert((argument, index))),
                    node => rest.extend(node.operands().map(Edge::node).filter(|operand| seen.insert(*operand))),
                }
            }
            inputs
        };
        self.outputs.iter().map(of_output).collect()
    }

    /// The outputs in a new graph. `make` is called for each node that is `kept`, in order and in the node's step, with
    /// the node's index and a map from edges of earlier kept nodes to their new values; it returns the new value and
    /// its name. Outputs must be kept.
    pub(crate) fn rebuilt(
        &self,
        kept: impl Fn(usize) -> bool,
        mut make: impl FnMut(&mut Graph, usize, &dyn Fn(Edge) -> Edge) -> (Edge, Option<Name>),
    ) -> Expressions {
        let mut graph = Graph::default();
        let mut made: Vec<Option<Edge>> = vec![None; self.graph.len()];
        let mapped = |made: &[Option<Edge>], edge: Edge| {
            made[edge.node()].expect("kept nodes are made before what uses them").flipped_if(edge.is_negative())
        };
        for index in (0..self.graph.len()).filter(|&index| kept(index)) {
            graph.enter_step(self.graph.step(index));
            let (edge, name) = make(&mut graph, index, &|edge| mapped(&made, edge));
            if let Some(name) = name {
                graph.set_name(edge, name);
            }
            made[index] = Some(edge);
        }
        let outputs = self.outputs.iter().map(|&output| mapped(&made, output)).collect();
        Expressions { graph, outputs }
    }

    /// Whether unrolled code is too long for an instruction cache.
    pub fn is_long(&self) -> bool {
        self.count().flops() > LONGEST_UNROLLED
    }

    /// Operations of the live nodes. A sine and a cosine of one angle are a pair; unary minus is free.
    pub fn count(&self) -> OperationCount {
        let mut count = OperationCount::default();
        let mut angles = HashSet::new();
        for (index, uses) in self.uses().into_iter().enumerate() {
            // What depends on parameters alone is computed once, not in every call.
            if uses == 0 || self.graph.is_fixed(self.graph.edge(index)) {
                continue;
            }
            match self.graph.node(index) {
                Node::Input { .. } | Node::Constant(_) | Node::Parameter { .. } => {}
                Node::Add(..) | Node::Subtract(..) => count.additions += 1,
                Node::Multiply(..) => count.multiplications += 1,
                // A square root takes about as long as a division.
                Node::Divide(..) | Node::Sqrt(_) => count.divisions += 1,
                Node::Sin(angle) | Node::Cos(angle) => {
                    if angles.insert(angle) {
                        count.trig += 1;
                    }
                }
            }
        }
        count
    }

    /// Operations, with each sine-cosine pair at its price in operations: the measure by which alternatives are
    /// compared.
    pub fn price(&self) -> u32 {
        let count = self.count();
        count.additions + count.multiplications + PRICE_PER_DIVISION * count.divisions + PRICE_PER_PAIR * count.trig
    }

    /// The outputs for the given arguments; parameters have the values of the model.
    pub fn evaluate(&self, arguments: &[&[f64]]) -> Vec<f64> {
        self.evaluate_with(arguments, |_, nominal| nominal)
    }

    /// The outputs for the given arguments, computed with any scalar; parameters have the values that `parameter` gives for
    /// their index and their value in the model.
    pub fn evaluate_with<S: Scalar>(&self, arguments: &[&[S]], parameter: impl Fn(u32, f64) -> S) -> Vec<S> {
        let mut values: Vec<S> = Vec::with_capacity(self.graph.len());
        for index in 0..self.graph.len() {
            let at = |edge: Edge| {
                let value = values[edge.node()];
                if edge.is_negative() { -value } else { value }
            };
            let value = self.graph.node(index).evaluate(at, |leaf| match leaf {
                Leaf::Input { argument, index } => arguments[usize::from(argument)][index as usize],
                Leaf::Constant(value) => S::from_f64(value),
                Leaf::Parameter { index, nominal } => parameter(index, nominal),
            });
            values.push(value);
        }
        let at = |edge: &Edge| if edge.is_negative() { -values[edge.node()] } else { values[edge.node()] };
        self.outputs.iter().map(at).collect()
    }
}
