//! What acts in joints and between points without an actuator.

use super::frame::joint_frames;
use super::springs::Springs;
use super::trace::Trace;
use crate::parameter::ParameterIn;
use crate::tree::Tree;
use redysim_runtime::Scalar;

/// The part of the bias that damping, friction and springs take: the force that each joint must have against them.
pub fn passive_forces<S: Scalar>(tree: &Tree<impl ParameterIn<S>>, trace: &impl Trace<S>, q: &[S], v: &[S]) -> Vec<S> {
    let (q, v) = (&tree.all_coordinates(q), &tree.all_velocities(v));
    let mut tau = vec![S::zero(); tree.nv_of_all()];
    for body in &tree.bodies {
        let Some(physics) = &body.physics else { continue };
        let forces = physics.passive_forces(body.joint, &q[body.q.clone()], &v[body.v.clone()]);
        for (tau, force) in tau[body.v.clone()].iter_mut().zip(forces) {
            if let Some(force) = force {
                *tau = force;
            }
        }
    }
    if !tree.springs.is_empty() {
        let frames = joint_frames(tree, trace, q);
        let mut springs = Springs::default();
        tau.iter_mut().zip(springs.forces(tree, &frames, v)).for_each(|(tau, force)| *tau += *force);
    }
    tree.folded(tau)
}

/// The power that damping and friction take, which is never negative.
pub fn dissipated_power<S: Scalar>(tree: &Tree<impl ParameterIn<S>>, trace: &impl Trace<S>, q: &[S], v: &[S]) -> S {
    let (q, v) = (&tree.all_coordinates(q), &tree.all_velocities(v));
    let in_joints = tree.bodies.iter().flat_map(|body| {
        let of_velocity =
            |(i, &v): (usize, &S)| body.physics.as_ref()?.dissipative_force(i, v).map(|force: S| force * v);
        v[body.v.clone()].iter().enumerate().filter_map(of_velocity)
    });
    let between_points = if tree.springs.is_empty() {
        None
    } else {
        Springs::default().dissipated_power(tree, &joint_frames(tree, trace, q), v)
    };
    in_joints.chain(between_points).reduce(|sum, power| sum + power).unwrap_or_else(S::zero)
}
