//! Expressions evaluated in many states at once, and the derivatives of their outputs by every value in them.
//!
//! Each value has a column, one number for each state. What is done for a node is a loop by index over plain slices:
//! macros run without optimisation, where iterators and operators of other types take several times as long.

use crate::expressions::Expressions;
use crate::graph::{Edge, Node};
use redysim_runtime::Scalar;

/// Columns of equal length, in one piece.
#[derive(Clone, Debug)]
pub struct Columns {
    states: usize,
    numbers: Vec<f64>,
}

impl Columns {
    /// `count` columns of zeros.
    pub fn new(count: usize, states: usize) -> Columns {
        Columns { states, numbers: vec![0.0; count * states] }
    }

    /// Length of each column.
    pub fn states(&self) -> usize {
        self.states
    }

    /// One column.
    pub fn column(&self, index: usize) -> &[f64] {
        &self.numbers[index * self.states..(index + 1) * self.states]
    }

    /// One column, to be written.
    pub fn column_mut(&mut self, index: usize) -> &mut [f64] {
        &mut self.numbers[index * self.states..(index + 1) * self.states]
    }

    /// The columns before `index` in one piece, and that one.
    fn split(&mut self, index: usize) -> (&[f64], &mut [f64]) {
        let (before, rest) = self.numbers.split_at_mut(index * self.states);
        (before, &mut rest[..self.states])
    }
}

/// ±1.
pub fn sign(edge: Edge) -> f64 {
    if edge.is_negative() { -1.0 } else { 1.0 }
}

/// The values of the nodes in `live`, in states whose arguments are the columns of `arguments`.
pub fn evaluate(expressions: &Expressions, live: &[usize], arguments: &[Columns], values: &mut Columns) {
    let states = values.states;
    // The sine of an angle comes with its cosine.
    let mut others: Vec<(Node, Vec<f64>)> = Vec::new();
    for &node in live {
        let (before, out) = values.split(node);
        let of = |edge: Edge| &before[edge.node() * states..(edge.node() + 1) * states];
        // Operands of sums, products and quotients carry no sign.
        match expressions.graph.node(node) {
            Node::Input { argument, index } => {
                out.copy_from_slice(arguments[usize::from(argument)].column(index as usize));
            }
            Node::Constant(bits) | Node::Parameter { nominal: bits, .. } => out.fill(f64::from_bits(bits)),
            Node::Add(a, b) => sum(out, of(a), of(b)),
            Node::Subtract(a, b) => difference(out, of(a), of(b)),
            Node::Multiply(a, b) => product(out, of(a), of(b)),
            Node::Divide(a, b) => quotient(out, of(a), of(b)),
            function @ (Node::Sin(a) | Node::Cos(a)) => {
                if let Some((_, known)) = others.iter().find(|(other, _)| *other == function) {
                    out.copy_from_slice(known);
                    continue;
                }
                let mut other = vec![0.0; states];
                let is_sine = function == Node::Sin(a);
                for ((own, other), x) in out.iter_mut().zip(&mut other).zip(of(a)) {
                    let (sine, cosine) = Scalar::sin_cos(sign(a) * x);
                    (*own, *other) = if is_sine { (sine, cosine) } else { (cosine, sine) };
                }
                others.push((if is_sine { Node::Cos(a) } else { Node::Sin(a) }, other));
            }
            Node::Sqrt(a) => out.iter_mut().zip(of(a)).for_each(|(y, x)| *y = (sign(a) * x).sqrt()),
        }
    }
}

/// The indices of the nodes that an output needs.
pub fn live(expressions: &Expressions) -> Vec<usize> {
    let uses = expressions.uses();
    (0..uses.len()).filter(|&node| uses[node] > 0).collect()
}

/// The derivative of `output` by each node on which it depends (reverse accumulation).
pub fn derivatives(expressions: &Expressions, output: Edge, values: &Columns) -> Vec<Option<Vec<f64>>> {
    let mut derivatives: Vec<Option<Vec<f64>>> = vec![None; output.node() + 1];
    derivatives[output.node()] = Some(vec![sign(output); values.states]);
    for node in (0..=output.node()).rev() {
        let Some(own) = derivatives[node].take() else { continue };
        let at = |edge: Edge| values.column(edge.node());
        let mut accumulate = |edge: Edge, part: &dyn Fn(&mut [f64])| {
            part(derivatives[edge.node()].get_or_insert_with(|| vec![0.0; own.len()]));
        };
        match expressions.graph.node(node) {
            Node::Input { .. } | Node::Constant(_) | Node::Parameter { .. } => {}
            Node::Sin(a) => {
                let cosines: Vec<f64> = at(a).iter().map(|&x| sign(a) * Scalar::sin_cos(x).1).collect();
                accumulate(a, &|out| add_product(out, &own, &cosines));
            }
            Node::Cos(a) => {
                let sines: Vec<f64> = at(a).iter().map(|&x| Scalar::sin_cos(x).0).collect();
                accumulate(a, &|out| subtract_product(out, &own, &sines));
            }
            Node::Add(a, b) => {
                accumulate(a, &|out| add(out, &own, 1.0));
                accumulate(b, &|out| add(out, &own, 1.0));
            }
            Node::Subtract(a, b) => {
                accumulate(a, &|out| add(out, &own, 1.0));
                accumulate(b, &|out| add(out, &own, -1.0));
            }
            Node::Multiply(a, b) => {
                accumulate(a, &|out| add_product(out, &own, at(b)));
                accumulate(b, &|out| add_product(out, &own, at(a)));
            }
            Node::Divide(a, b) => {
                let mut by_divisor = own.clone();
                quotient(&mut by_divisor, &own, at(b));
                accumulate(a, &|out| add(out, &by_divisor, 1.0));
                let ratio = values.column(node);
                accumulate(b, &|out| subtract_product(out, &by_divisor, ratio));
            }
            Node::Sqrt(a) => {
                let mut halved = own.clone();
                quotient(&mut halved, &own, values.column(node));
                accumulate(a, &|out| add(out, &halved, 0.5 * sign(a)));
            }
        }
        derivatives[node] = Some(own);
    }
    derivatives
}

fn sum(out: &mut [f64], a: &[f64], b: &[f64]) {
    let mut i = 0;
    while i < out.len() {
        out[i] = a[i] + b[i];
        i += 1;
    }
}

fn difference(out: &mut [f64], a: &[f64], b: &[f64]) {
    let mut i = 0;
    while i < out.len() {
        out[i] = a[i] - b[i];
        i += 1;
    }
}

fn product(out: &mut [f64], a: &[f64], b: &[f64]) {
    let mut i = 0;
    while i < out.len() {
        out[i] = a[i] * b[i];
        i += 1;
    }
}

fn quotient(out: &mut [f64], a: &[f64], b: &[f64]) {
    let mut i = 0;
    while i < out.len() {
        out[i] = a[i] / b[i];
        i += 1;
    }
}

fn add(out: &mut [f64], a: &[f64], factor: f64) {
    let mut i = 0;
    while i < out.len() {
        out[i] += factor * a[i];
        i += 1;
    }
}

fn add_product(out: &mut [f64], a: &[f64], b: &[f64]) {
    let mut i = 0;
    while i < out.len() {
        out[i] += a[i] * b[i];
        i += 1;
    }
}

fn subtract_product(out: &mut [f64], a: &[f64], b: &[f64]) {
    let mut i = 0;
    while i < out.len() {
        out[i] -= a[i] * b[i];
        i += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::Graph;

    /// Of y = √(x² + sin x / (2 + cos z)) − z x, by differences of the whole function.
    #[test]
    fn derivatives_are_those_of_differences() {
        let mut graph = Graph::default();
        let [x, z] = [0, 1].map(|index| graph.input(0, index));
        let two = graph.constant(2.0);
        let (square, sine, cosine) = (graph.multiply(x, x), graph.sin(x), graph.cos(z));
        let divisor = graph.add(two, cosine);
        let quotient = graph.divide(sine, divisor);
        let radicand = graph.add(square, quotient);
        let (root, product) = (graph.sqrt(radicand), graph.multiply(z, x));
        let output = graph.add(product, -root);
        let expressions = Expressions { graph, outputs: vec![-output] };
        let states = [[0.7, 0.2], [1.9, -2.3]];
        let mut arguments = Columns::new(2, states.len());
        for (state, values) in states.iter().enumerate() {
            (0..2).for_each(|index| arguments.column_mut(index)[state] = values[index]);
        }
        let mut values = Columns::new(expressions.graph.len(), states.len());
        evaluate(&expressions, &live(&expressions), &[arguments], &mut values);
        let found = derivatives(&expressions, expressions.outputs[0], &values);
        for (input, edge) in [x, z].into_iter().enumerate() {
            for (state, at) in states.iter().enumerate() {
                let value = |shift: f64| {
                    let mut moved = *at;
                    moved[input] += shift;
                    expressions.evaluate(&[&moved])[0]
                };
                assert!(
                    (value(0.0) - sign(expressions.outputs[0]) * values.column(output.node())[state]).abs() < 1e-15
                );
                let expected = (value(1e-5) - value(-1e-5)) / 2e-5;
                let derivative = found[edge.node()].as_ref().expect("the output depends on it")[state];
                assert!((derivative - expected).abs() < 1e-9, "{derivative}, not {expected}");
            }
        }
    }
}
