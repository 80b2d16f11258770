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
    // The recursion accelerates joints that mimic others by themselves first.
    let tree = Tree { mimics: Vec::new(), ..Tree::new(model) };
    let report = |body: usize| {
        let Body { joint, link, .. } = tree.bodies[body];
        (link, messages::singular_mass_matrix(&model.links[link].name, &model.links[link].joint_name, joint))
    };
    without_inertia(&tree).into_iter().map(report).collect()
}

/// The bodies whose joints meet no inertia at any sampled position.
fn without_inertia(tree: &Tree) -> Vec<usize> {
    // A joint meets at least the inertia of its own body, so only bodies without any about their axis are in question.
    let mut suspects: Vec<usize> = tree.outward().filter(|&body| !meets_own_inertia(&tree.bodies[body])).collect();
    for position in 0..POSITIONS {
        if suspects.is_empty() {
            return Vec::new();
        }
        let free = pivotless(tree, &mass_matrix(tree, &Untraced, &tree.sample(position)));
        suspects.retain(|body| free.contains(body));
    }
    suspects
}

fn meets_own_inertia(body: &Body) -> bool {
    body.joint.meets(body.inertia) > ROUNDOFF || body.physics.is_some_and(|physics| physics.armature > 0.0)
}

/// The bodies with a velocity whose pivot is only roundoff, in the elimination of a symmetric `matrix` over the
/// velocities, from the tips to the ground.
pub(super) fn pivotless(tree: &Tree, matrix: &[Vec<f64>]) -> Vec<usize> {
    let of_body = |body: usize| tree.bodies[body].v.clone().map(move |velocity| (body, velocity));
    let (body_of, at): (Vec<usize>, Vec<usize>) = tree.outward().flat_map(of_body).unzip();
    let mut reduced: Vec<Vec<f64>> = at.iter().map(|&i| at.iter().map(|&j| matrix[i][j]).collect()).collect();
    let mut without = Vec::new();
    for k in (0..at.len()).rev() {
        let pivot = reduced[k][k];
        if pivot <= ROUNDOFF * matrix[at[k]][at[k]] {
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
        assert_eq!(pivotless(&tree, &matrix), [0]);
        matrix[2][2] = 1.0;
        assert_eq!(pivotless(&tree, &matrix), [0_usize; 0]);
        matrix[0][0] = 0.0;
        assert_eq!(pivotless(&tree, &matrix), [1]);
    }

    #[test]
    fn a_joint_without_inertia_is_found_behind_a_joint_of_two_velocities() {
        let mut tree = arm();
        tree.bodies[0].v = 1..3;
        tree.bodies[1].inertia = PseudoInertia::zero();
        assert_eq!(without_inertia(&tree), [1]);
    }
}
