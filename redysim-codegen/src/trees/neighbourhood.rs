//! A body with its neighbours, as a small tree of its own.

use redysim_model::inertia::Sym3;
use redysim_model::joint::Joint;
use redysim_model::parameter::Parameter;
use redysim_model::pseudo::PseudoInertia;
use redysim_model::spatial::{Pose, Vec3};
use redysim_model::{Body, Tree};
use std::ops::Range;

/// Bodies towards the ground that are kept, the parent among them.
const ABOVE: usize = 2;
/// Generations of children that are kept.
const BELOW: usize = 1;

/// A part of a tree, and the indices of its bodies in the whole.
pub struct Neighbourhood<P> {
    /// The part.
    pub tree: Tree<P>,
    /// The index in the whole of each body; `None` for a stand-in for the rest of the tree.
    origins: Vec<Option<usize>>,
}

impl<P: Parameter> Neighbourhood<P> {
    /// The index in the part of a body of the whole.
    pub fn index_of(&self, body: usize) -> Option<usize> {
        self.origins.iter().position(|origin| *origin == Some(body))
    }

    /// Makes the stand-ins massless again.
    pub fn relieve_stand_ins(&self, tree: &mut Tree<P>) {
        for (body, origin) in tree.bodies.iter_mut().zip(&self.origins) {
            if origin.is_none() {
                body.inertia = PseudoInertia::zero();
            }
        }
    }
}

/// The body `body` with its parent, its parent's parent and its children.
///
/// Where the tree continues towards the ground, two oblique joints give the part a motion without zeros; where it
/// continues outwards, the last body gets an inertia without zeros.
pub fn neighbourhood<P: Parameter>(tree: &Tree<P>, body: usize) -> Neighbourhood<P> {
    let above: Vec<usize> = std::iter::successors(Some(body), |&at| tree.bodies[at].parent).take(ABOVE + 1).collect();
    let top = *above.last().expect("the body itself");
    let mut part = Tree {
        bodies: Vec::new(),
        links: Vec::new(),
        cuts: Vec::new(),
        frames: Vec::new(),
        springs: Vec::new(),
        mimics: Vec::new(),
        ..tree.clone()
    };
    let mut origins = Vec::new();
    if tree.bodies[top].parent.is_some() {
        for parent in [None, Some(0)] {
            part.bodies.push(stand_in(parent));
            origins.push(None);
        }
    }
    let mut places: Vec<Option<usize>> = vec![None; tree.bodies.len()];
    let mut generations: Vec<Option<usize>> = vec![None; tree.bodies.len()];
    for index in top..tree.bodies.len() {
        let original = &tree.bodies[index];
        let generation = match original.parent {
            _ if index == body => Some(0),
            Some(parent) => generations[parent].map(|generation| generation + 1),
            None => None,
        };
        let kept = above.contains(&index) || generation.is_some_and(|generation| generation <= BELOW);
        if !kept {
            continue;
        }
        generations[index] = generation;
        places[index] = Some(part.bodies.len());
        let parent =
            if index == top { part.bodies.len().checked_sub(1) } else { original.parent.and_then(|at| places[at]) };
        let [q, v] = [own(part.nq(), original.joint.nq()), own(part.nv(), original.joint.nv())];
        let mut copy = Body { parent, q, v, ..original.clone() };
        if generation == Some(BELOW) && tree.children(index).next().is_some() {
            copy.inertia = full_inertia().map(P::from_f64);
        }
        part.bodies.push(copy);
        origins.push(Some(index));
    }
    Neighbourhood { tree: part, origins }
}

/// The coordinates or velocities of a joint that has `count` of them, after the `before` of the bodies before it.
fn own(before: usize, count: usize) -> Range<usize> {
    before..before + count
}

/// A massless body on an oblique joint.
fn stand_in<P: Parameter>(parent: Option<usize>) -> Body<P> {
    let rotation = redysim_model::rotation::roll_pitch_yaw([0.7, 0.4, 0.2]);
    Body {
        parent,
        placement: Pose { rotation, position: Vec3([0.3, 0.5, 0.2]) },
        joint: Joint::Revolute,
        link: parent.map_or(0, |parent| parent + 1),
        offset: 0.0,
        merged_parallel: false,
        q: own(parent.map_or(0, |parent| parent + 1), 1),
        v: own(parent.map_or(0, |parent| parent + 1), 1),
        inertia: PseudoInertia::zero(),
        physics: None,
        actuated: vec![true],
    }
}

/// An inertia without a zero.
fn full_inertia() -> PseudoInertia<f64> {
    let tensor = Sym3 { xx: 0.9, yy: 0.7, zz: 0.8, xy: 0.11, yz: 0.13, xz: 0.17 };
    PseudoInertia::from_central(1.9, Vec3([0.3, 0.5, 0.2]), tensor)
}
