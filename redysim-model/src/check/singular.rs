//! The numerical test for a singular mass matrix: joints that move mass, yet are met by no inertia at any position.

use crate::denoc::{Untraced, mass_matrix};
use crate::messages;
use crate::model::Model;
use crate::tree::{Body, Tree};
use redysim_toml::Message;

/// Positions that are looked at; a joint is reported if it is met by no inertia at all of them.
const POSITIONS: usize = 3;

/// A pivot this much smaller than its diagonal element is roundoff.
const ROUNDOFF: f64 = 1e-12;

/// The links whose joints make the mass matrix singular, each with its message. Called for a model without errors.
pub(super) fn check(model: &Model) -> Vec<(usize, Message)> {
    let tree = Tree::new(model);
    // A joint meets at least the inertia of its own body, so only bodies without any about their axis are in question.
    let mut suspects: Vec<usize> = (0..tree.nv()).filter(|&body| !meets_own_inertia(&tree.bodies[body])).collect();
    for position in 0..POSITIONS {
        if suspects.is_empty() {
            return Vec::new();
        }
        let free = pivotless(&tree, &mass_matrix(&tree, &Untraced, &tree.sample(position)));
        suspects.retain(|body| free.contains(body));
    }
    let moving: Vec<usize> = (0..model.links.len()).filter(|&link| model.links[link].joint.dof() > 0).collect();
    let report = |body: usize| {
        let link = moving[tree.bodies[body].v.start];
        let Body { joint, .. } = tree.bodies[body];
        (link, messages::singular_mass_matrix(&model.links[link].name, &model.links[link].joint_name, joint))
    };
    suspects.into_iter().map(report).collect()
}

fn meets_own_inertia(body: &Body) -> bool {
    body.joint.meets(body.inertia) > ROUNDOFF
}

/// The bodies whose pivot in the elimination of a symmetric `matrix` over the coordinates, from the tips to the ground,
/// is nothing but roundoff.
pub(super) fn pivotless(tree: &Tree, matrix: &[Vec<f64>]) -> Vec<usize> {
    let at: Vec<usize> = tree.bodies.iter().map(|body| body.v.start).collect();
    let mut reduced: Vec<Vec<f64>> = at.iter().map(|&i| at.iter().map(|&j| matrix[i][j]).collect()).collect();
    let mut without = Vec::new();
    for k in (0..tree.nv()).rev() {
        let pivot = reduced[k][k];
        if pivot <= ROUNDOFF * matrix[at[k]][at[k]] {
            without.push(k);
            continue;
        }
        let column: Vec<f64> = reduced.iter().map(|row| row[k]).collect();
        for (row, factor) in reduced.iter_mut().zip(&column).take(k) {
            for (element, other) in row.iter_mut().zip(&column).take(k) {
                *element -= factor * other / pivot;
            }
        }
    }
    without
}
