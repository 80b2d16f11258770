//! What acts in the joints without an actuator.

use crate::parameter::ParameterIn;
use crate::tree::Tree;
use redysim_runtime::Scalar;

/// The part of the bias that damping, friction and springs take: the force that each joint must have against them.
pub fn passive_forces<S: Scalar>(tree: &Tree<impl ParameterIn<S>>, q: &[S], v: &[S]) -> Vec<S> {
    let mut tau = vec![S::zero(); tree.nv()];
    for body in &tree.bodies {
        let physics = body.physics;
        if let Some(force) = physics.and_then(|physics| physics.passive_force(q[body.q.start], v[body.v.start])) {
            tau[body.v.start] = force;
        }
    }
    tau
}

/// The power that damping and friction take, which is never negative.
pub fn dissipated_power<S: Scalar>(tree: &Tree<impl ParameterIn<S>>, v: &[S]) -> S {
    let forces = tree.bodies.iter().filter_map(|body| {
        let v = v[body.v.start];
        body.physics?.dissipative_force(v).map(|force: S| force * v)
    });
    forces.reduce(|sum, power| sum + power).unwrap_or_else(S::zero)
}
