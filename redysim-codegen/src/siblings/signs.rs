//! Which values of a branch are the negatives of the pack's: those that the operations of the first branch compute from
//! the values of this one.
//!
//! The terms of a sum have the sign of the sum, a product has the product of the signs of its factors, and a product
//! with a constant may have either sign, since the constant takes it. Packs whose signs depend on each other are joined
//! into classes (union-find), in the order of the operations. Where signs contradict each other, as where mirrored
//! branches meet a coordinate that is not mirrored, the operand is multiplied by a sign of each branch.

use super::packs::{Kind, Operand, Operation, Pack, Source};
use crate::graph::Graph;

/// For each pack, which values are the negatives of the nodes'.
pub fn signs(graph: &Graph, packs: &[Pack], branches: usize) -> Vec<Vec<bool>> {
    let of_branches: Vec<Vec<bool>> = (0..branches).map(|branch| of_branch(graph, packs, branch)).collect();
    (0..packs.len()).map(|pack| of_branches.iter().map(|signs| signs[pack]).collect()).collect()
}

fn of_branch(graph: &Graph, packs: &[Pack], branch: usize) -> Vec<bool> {
    // The last element is that whose sign is plus.
    let plus = packs.len();
    let mut classes = Classes((0..=plus).map(|pack| (pack, false)).collect());
    for (index, pack) in packs.iter().enumerate() {
        let Pack::Operation(Operation { nodes, operands }) = pack else {
            classes.join(index, plus, false);
            continue;
        };
        if branch == 0 {
            classes.join(index, plus, false);
            continue;
        }
        let differs = |operand: &Operand| operand.minus[branch] != operand.minus[0];
        let kind = Kind::of(graph.node(nodes[0]));
        let variable = |operand: &Operand| match operand.source {
            Source::Pack(pack) => Some((pack, differs(operand))),
            Source::Constants(_) => None,
        };
        let variables: Vec<(usize, bool)> = operands.iter().filter_map(variable).collect();
        match (kind, &variables[..]) {
            (Kind::Sum, variables) => variables.iter().for_each(|&(pack, differs)| classes.join(index, pack, differs)),
            (Kind::Product, [_]) => {}
            (Kind::Product | Kind::Quotient, &[(a, differs), (b, other)]) => {
                if classes.find(a).0 == classes.find(b).0 {
                    let sign = classes.find(a).1 != classes.find(b).1;
                    classes.join(index, plus, sign != (differs != other));
                } else {
                    let (known, open) = if classes.find(b).0 == plus { (b, a) } else { (a, b) };
                    classes.join(known, plus, false);
                    let sign = classes.find(known).1;
                    classes.join(index, open, sign != (differs != other));
                }
            }
            (Kind::Root, &[(a, differs)]) => {
                classes.join(a, plus, differs);
                classes.join(index, plus, false);
            }
            (_, variables) => variables.iter().for_each(|&(pack, differs)| classes.join(index, pack, differs)),
        }
    }
    (0..packs.len()).map(|pack| classes.find(pack).1).collect()
}

/// Classes of elements whose signs depend on each other: for each element one of its class, and the sign relative to it.
struct Classes(Vec<(usize, bool)>);

impl Classes {
    /// The element that stands for the class, and the sign relative to it.
    fn find(&self, element: usize) -> (usize, bool) {
        let (mut at, mut sign) = (element, false);
        while self.0[at].0 != at {
            sign ^= self.0[at].1;
            at = self.0[at].0;
        }
        (at, sign)
    }

    /// Lets the sign of `a` be that of `b` times `differs`, unless they depend on each other already.
    fn join(&mut self, a: usize, b: usize, differs: bool) {
        let ((a, sign_a), (b, sign_b)) = (self.find(a), self.find(b));
        // The element of the sign plus is the last one and stays the root.
        let (child, root) = if a < b { (a, b) } else { (b, a) };
        if child != root {
            self.0[child] = (root, differs != (sign_a != sign_b));
        }
    }
}
