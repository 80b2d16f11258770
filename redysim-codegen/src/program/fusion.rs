//! Products that are one operation with a sum.

use std::ops::Range;

/// What is computed at one place of a program, from what is computed before it.
#[derive(Clone, Debug, Default)]
pub struct Operation {
    /// The places of its operands.
    pub operands: Vec<usize>,
    /// How long it takes once its operands are ready, in units of an addition.
    pub latency: u32,
    /// Of a sum, those operands that are products which nothing else reads.
    pub products: Vec<usize>,
}

/// Which of `operations` are products that are fused with the sum that reads them.
///
/// Of two such products in one sum, the one that is ready later is fused. The other one is computed in the meantime, so
/// that the sum is ready one operation after the factors of the later one; the other way round it would be two. Of products
/// that are ready at the same time, the one that stands later.
pub fn fused_products(operations: &[Operation]) -> Vec<bool> {
    let mut fused = vec![false; operations.len()];
    // When each operation may begin, and when it is ready.
    let mut times: Vec<Range<u32>> = Vec::with_capacity(operations.len());
    for Operation { operands, latency, products } in operations {
        let latest = products.iter().copied().max_by_key(|&product| (times[product].end, product));
        let available = |&operand: &usize| {
            let is_fused = Some(operand) == latest;
            if is_fused { times[operand].start } else { times[operand].end }
        };
        let start = operands.iter().map(available).max().unwrap_or(0);
        if let Some(product) = latest {
            fused[product] = true;
        }
        times.push(start..start + latency);
    }
    fused
}

#[cfg(test)]
mod tests {
    use super::*;

    fn operation(operands: &[usize]) -> Operation {
        Operation { operands: operands.to_vec(), latency: 1, products: Vec::new() }
    }

    /// a, b, a b, (a b) b, and the sum of a product of (a b) b, at 4, and one of a and b, at 5.
    fn late_and_early_product() -> Vec<Operation> {
        let leaf = Operation::default();
        let sum = Operation { products: vec![4, 5], ..operation(&[4, 5]) };
        vec![leaf.clone(), leaf, operation(&[0, 1]), operation(&[2, 1]), operation(&[3, 0]), operation(&[0, 1]), sum]
    }

    #[test]
    fn of_two_products_in_a_sum_the_one_that_is_ready_later_is_fused() {
        let fused = fused_products(&late_and_early_product());
        assert_eq!(fused, [false, false, false, false, true, false, false]);
    }

    /// A product of the sum above is ready four operations after the leaves, as the sum does not wait for its fused
    /// product but for the factors: sooner than one of five operations, later than one of three.
    #[test]
    fn a_sum_is_ready_one_operation_after_the_factors_of_its_fused_product() {
        let chain = |length: usize| {
            let mut operations = late_and_early_product();
            let product_of_sum = operations.len();
            operations.push(operation(&[6, 0]));
            for _ in 0..length {
                let last = operations.len() - 1;
                let operand = if last == product_of_sum { 0 } else { last };
                operations.push(operation(&[operand, 0]));
            }
            let other = operations.len() - 1;
            operations.push(Operation { products: vec![product_of_sum, other], ..operation(&[product_of_sum, other]) });
            let fused = fused_products(&operations);
            [fused[product_of_sum], fused[other]]
        };
        assert_eq!(chain(3), [true, false]);
        assert_eq!(chain(5), [false, true]);
    }
}
