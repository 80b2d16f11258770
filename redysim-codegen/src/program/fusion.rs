//! Products that are one operation with a sum.

use crate::graph::{Edge, Graph, Node};
use std::ops::Range;

/// Which nodes are products that are fused with a sum, the only one that uses them.
///
/// Of two such products in one sum, the one that is ready later is fused. The other one is computed in the meantime, so
/// that the sum is ready one operation after the factors of the later one; the other way round it would be two. Of products
/// that are ready at the same time, the one that stands later.
pub fn fused_products(graph: &Graph, uses: &[usize]) -> Vec<bool> {
    let mut fused = vec![false; graph.len()];
    // When each operation may begin, and when it is ready, in units of an addition.
    let mut times: Vec<Range<u32>> = Vec::with_capacity(graph.len());
    for (index, &uses_of_sum) in uses.iter().enumerate() {
        let node = graph.node(index);
        let is_sum = uses_of_sum > 0 && matches!(node, Node::Add(..) | Node::Subtract(..));
        let is_product = |&operand: &usize| uses[operand] == 1 && matches!(graph.node(operand), Node::Multiply(..));
        let products = node.operands().map(Edge::node).filter(|operand| is_sum && is_product(operand));
        let latest = products.max_by_key(|&product| (times[product].end, product));
        if let Some(product) = latest {
            fused[product] = true;
        }
        let available = |operand: usize| {
            let is_fused = Some(operand) == latest;
            if is_fused { times[operand].start } else { times[operand].end }
        };
        let start = node.operands().map(|operand| available(operand.node())).max().unwrap_or(0);
        times.push(start..start + node.latency());
    }
    fused
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expressions::Expressions;

    /// Which of `products` are fused in the code of `output`.
    fn fused<const N: usize>(graph: Graph, output: Edge, products: [Edge; N]) -> [bool; N] {
        let expressions = Expressions { graph, outputs: vec![output] };
        let fused = fused_products(&expressions.graph, &expressions.uses_in_code());
        products.map(|product| fused[product.node()])
    }

    /// The product of `count` + 1 factors, one after the other.
    fn chain(graph: &mut Graph, first: u32, count: u32) -> Edge {
        (first + 1..=first + count).fold(graph.input(0, first), |product, index| {
            let factor = graph.input(0, index);
            graph.multiply(product, factor)
        })
    }

    #[test]
    fn of_two_products_in_a_sum_the_one_that_is_ready_later_is_fused() {
        let mut graph = Graph::default();
        let [late, early] = [chain(&mut graph, 0, 2), chain(&mut graph, 10, 1)];
        let sum = graph.add(late, early);
        assert_eq!(fused(graph, sum, [late, early]), [true, false]);
    }

    /// The sum a b c + d e is ready after two operations, since a fused product does not take an operation of its own. Its
    /// product with another factor is ready after three, and so is a chain of three multiplications, which stands later and
    /// is therefore the one that is fused.
    #[test]
    fn a_sum_is_ready_one_operation_after_the_factors_of_its_fused_product() {
        let beside = |length: u32| {
            let mut graph = Graph::default();
            let [late, early] = [chain(&mut graph, 0, 2), chain(&mut graph, 10, 1)];
            let (sum, factor) = (graph.add(late, early), graph.input(0, 20));
            let product = graph.multiply(sum, factor);
            let other = chain(&mut graph, 30, length);
            let output = graph.add(product, other);
            fused(graph, output, [product, other])
        };
        assert_eq!(beside(2), [true, false]);
        assert_eq!(beside(3), [false, true]);
    }

    #[test]
    fn a_product_with_other_uses_is_not_fused() {
        let mut graph = Graph::default();
        let (product, x) = (chain(&mut graph, 0, 1), graph.input(0, 5));
        let sum = graph.add(product, x);
        let output = graph.multiply(sum, product);
        assert_eq!(fused(graph, output, [product]), [false]);
    }
}
