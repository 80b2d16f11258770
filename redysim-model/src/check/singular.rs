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
    let report = |body: usize| {
        let Body { joint, link, .. } = tree.bodies[body];
        (link, messages::singular_mass_matrix(&model.links[link].name, &model.links[link].joint_name, joint))
    };
    without_inertia(&tree).into_iter().map(report).collect()
}

/// The bodies whose joints meet no inertia at any sampled position.
fn without_inertia(tree: &Tree) -> Vec<usize> {
    // A joint meets at least the inertia of its own body, so only bodies without any about their axis are in question, unless
    // joints further out move this body, too.
    let is_in_question = |&body: &usize| !tree.mimics.is_empty() || !meets_own_inertia(&tree.bodies[body]);
    let mut suspects: Vec<usize> = tree.outward().filter(is_in_question).collect();
    for position in 0..POSITIONS {
        if suspects.is_empty() {
            return Vec::new();
        }
        let q = tree.sample(position);
        let free = pivotless(tree, &mass_matrix(tree, &Untraced, &q), &sizes(tree, &q));
        suspects.retain(|body| free.contains(body));
    }
    suspects
}

/// For each velocity, the sum of what its joint and those that mimic it meet by themselves. Their inertia together may be
/// the roundoff of these, if one undoes the motion of the other.
fn sizes(tree: &Tree, q: &[f64]) -> Vec<f64> {
    let each = Tree { mimics: Vec::new(), ..tree.clone() };
    let matrix = mass_matrix(&each, &Untraced, &tree.all_coordinates(q));
    let mut sizes: Vec<f64> = (0..tree.nv()).map(|velocity| matrix[velocity][velocity]).collect();
    for (k, mimic) in tree.mimics.iter().enumerate() {
        let index = tree.nv() + k;
        sizes[mimic.v] += mimic.multiplier * mimic.multiplier * matrix[index][index];
    }
    sizes
}

fn meets_own_inertia(body: &Body) -> bool {
    body.joint.meets(body.inertia) > ROUNDOFF || has_rotors(body)
}

/// Whether each velocity of the joint has an armature.
fn has_rotors(body: &Body) -> bool {
    body.physics.as_ref().is_some_and(|physics| physics.velocities.iter().all(|each| each.armature > 0.0))
}

/// The bodies with a velocity whose pivot is only roundoff, in the elimination of a symmetric `matrix` over the
/// mechanism's velocities, from the tips to the ground; `sizes` are those of what the diagonal is a sum of.
pub(super) fn pivotless(tree: &Tree, matrix: &[Vec<f64>], sizes: &[f64]) -> Vec<usize> {
    let of_body = |body: usize| tree.bodies[body].v.clone().map(move |velocity| (body, velocity));
    let velocities = tree.outward().flat_map(of_body).filter(|(_, velocity)| *velocity < tree.nv());
    let (body_of, at): (Vec<usize>, Vec<usize>) = velocities.unzip();
    let mut reduced: Vec<Vec<f64>> = at.iter().map(|&i| at.iter().map(|&j| matrix[i][j]).collect()).collect();
    let mut without = Vec::new();
    for k in (0..at.len()).rev() {
        let pivot = reduced[k][k];
        if pivot <= ROUNDOFF * sizes[at[k]] {
            without.push(body_of[k]);
            continue;
        }
        let column: Vec<f64> = reduced.iter().map(|row| row[k]).collect();
        for (row, factor) in reduced.iter_mut().zip(&column).take(k) {
            for (element, other) in row.iter_mut().zip(&column).take(k) {
                *element -= factor * other / pivot;
            }
        }
    }
    without.dedup();
    without
}

#[cfg(test)]
mod tests {
    use super::{pivotless, without_inertia};
    use crate::pseudo::PseudoInertia;
    use crate::tree::tests::arm;

    /// The forearm has the velocity 0, the upper arm 1 and 2. Only velocity 2 meets no inertia.
    #[test]
    fn a_body_of_two_velocities_is_pivotless_where_one_of_them_is() {
        let mut tree = arm();
        tree.bodies[0].v = 1..3;
        let mut matrix = [[2.0, 1.0, 0.0], [1.0, 3.0, 0.0], [0.0, 0.0, 0.0]].map(Vec::from);
        assert_eq!(pivotless(&tree, &matrix, &[1.0; 3]), [0]);
        matrix[2][2] = 1.0;
        assert_eq!(pivotless(&tree, &matrix, &[1.0; 3]), [0_usize; 0]);
        assert_eq!(pivotless(&tree, &matrix, &[1.0, 1.0, 1e13]), [0]);
        matrix[0][0] = 0.0;
        assert_eq!(pivotless(&tree, &matrix, &[1.0; 3]), [1]);
    }

    #[test]
    fn a_joint_without_inertia_is_found_behind_a_joint_of_two_velocities() {
        let mut tree = arm();
        tree.bodies[0].v = 1..3;
        tree.bodies[1].inertia = PseudoInertia::zero();
        assert_eq!(without_inertia(&tree), [1]);
    }
}
