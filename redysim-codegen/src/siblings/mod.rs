//! Sibling branches that are alike, such as four legs or two arms, computed side by side.
//!
//! A recursion does the same at corresponding bodies of such branches; only the constants differ. Their operations
//! become those of one branch, which are done for all branches at once, in the lanes of a vector. The constants that
//! differ are a lane each.
//!
//! The branches are found in the [tree](Siblings). In the graph of a function, operations of corresponding bodies are
//! put together to [packs], from what is read later to what is read earlier, as a compiler's superword-level parallelism
//! does. Since constants of a graph are positive and signs stand on edges, [`signs`] finds which values of a branch are
//! the negatives of those of the first one, as with mirrored legs. The [schedule] puts packs between the operations that
//! stay single.

mod forms;
mod packs;
mod schedule;
mod signs;
mod sums;

use redysim_model::joint::Joint;
use redysim_model::{Body, Tree};
use std::mem::Discriminant;

pub use packs::{Kind, Operand, Operation, Pack, Source};
pub use schedule::{Packs, Part, SideBySide, code_size, may_pay};
pub use sums::by_branches;

/// The most branches that are computed side by side. More are computed in groups of this size.
const MOST_BRANCHES: usize = 8;

/// Branches of a tree on one body, or on the ground, whose joints are the same.
#[derive(Clone, Debug, PartialEq)]
pub struct Siblings {
    /// The branches.
    pub branches: Vec<Branch>,
    /// Number of velocities of the tree.
    pub velocities: usize,
}

/// A branch. What has the same place in its lists corresponds to each other in branches that are alike.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Branch {
    /// Its bodies.
    pub bodies: Vec<usize>,
    /// Their coordinates.
    pub coordinates: Vec<usize>,
    /// Their velocities.
    pub velocities: Vec<usize>,
}

/// What branches that are alike have in common: the joint, with its numbers of coordinates and velocities, and the same
/// for each child.
#[derive(PartialEq)]
struct Shape(Discriminant<Joint>, [usize; 2], Vec<Shape>);

impl Siblings {
    /// All siblings of a tree that are alike, no branch within another one.
    ///
    /// None of a tree with joints that mimic others: its bodies have coordinates that are not those of its functions.
    pub fn of(tree: &Tree) -> Vec<Siblings> {
        let mut siblings = Vec::new();
        if !tree.mimics.is_empty() {
            return siblings;
        }
        let mut parents = vec![None];
        while let Some(parent) = parents.pop() {
            let mut alike: Vec<(Shape, Vec<usize>)> = Vec::new();
            for child in children(tree, parent) {
                let shape = shape(tree, child);
                match alike.iter_mut().find(|(other, _)| *other == shape) {
                    Some((_, roots)) => roots.push(child),
                    None => alike.push((shape, vec![child])),
                }
            }
            for roots in alike.iter().flat_map(|(_, roots)| roots.chunks(MOST_BRANCHES)) {
                match roots {
                    [only] => parents.push(Some(*only)),
                    _ => siblings.push(Siblings {
                        branches: roots.iter().map(|&root| Branch::of(tree, root)).collect(),
                        velocities: tree.nv(),
                    }),
                }
            }
        }
        siblings
    }
}

impl Branch {
    fn of(tree: &Tree, root: usize) -> Branch {
        let mut branch = Branch::default();
        branch.add(tree, root);
        branch
    }

    fn add(&mut self, tree: &Tree, body: usize) {
        let Body { q, v, .. } = &tree.bodies[body];
        self.bodies.push(body);
        self.coordinates.extend(q.clone());
        self.velocities.extend(v.clone());
        children(tree, Some(body)).for_each(|child| self.add(tree, child));
    }
}

fn children(tree: &Tree, parent: Option<usize>) -> impl Iterator<Item = usize> {
    (0..tree.bodies.len()).filter(move |&body| tree.bodies[body].parent == parent)
}

fn shape(tree: &Tree, body: usize) -> Shape {
    let Body { joint, q, v, .. } = &tree.bodies[body];
    let of_children = children(tree, Some(body)).map(|child| shape(tree, child)).collect();
    Shape(std::mem::discriminant(joint), [q.len(), v.len()], of_children)
}
