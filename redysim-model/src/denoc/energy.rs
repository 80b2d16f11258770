//! Kinetic and potential energy.

use super::joint::joint_frames;
use crate::inertia::RigidInertia;
use crate::spatial::Vec3;
use crate::tree::{Joint, Tree};
use redysim_runtime::{Energy, Scalar};

/// Kinetic energy ½ Σ (m v² + 2 v·(ω × h) + ωᵀ J ω) and potential energy −Σ m g·c, zero at the base frame's origin, J.
pub fn energy<S: Scalar>(tree: &Tree, q: &[S], v: &[S]) -> Energy<S> {
    let frames = joint_frames(tree, q);
    let mut motions: Vec<(Vec3<S>, Vec3<S>)> = Vec::with_capacity(tree.bodies.len());
    let mut twice_kinetic = S::zero();
    for (index, (body, frame)) in tree.bodies.iter().zip(&frames).enumerate() {
        q[body.coordinate].step("outward", index);
        let (angular, linear) = body.parent.map_or((Vec3::zero(), Vec3::zero()), |parent| motions[parent]);
        let mut linear = frame.to_body(linear + angular.cross(frame.position));
        let mut angular = frame.to_body(angular);
        match body.joint {
            Joint::Revolute => angular[2] += v[body.coordinate],
            Joint::Prismatic => linear[2] += v[body.coordinate],
        }
        let (angular, linear) = (angular.named("w", index), linear.named("vel", index));
        twice_kinetic += twice_kinetic_energy(&RigidInertia::constant(body.inertia), angular, linear);
        motions.push((angular, linear));
    }
    let mut moments: Vec<Vec3<S>> = tree.bodies.iter().map(|body| Vec3::constant(body.inertia.moment)).collect();
    let mut masses: Vec<f64> = tree.bodies.iter().map(|body| body.inertia.mass).collect();
    let mut total = Vec3::constant(tree.ground.moment);
    for (index, (body, frame)) in tree.bodies.iter().zip(&frames).enumerate().rev() {
        q[body.coordinate].step("inward", index);
        let moment = frame.position.scale(S::from_f64(masses[index])) + frame.to_parent(moments[index]);
        match body.parent {
            Some(parent) => {
                masses[parent] += masses[index];
                moments[parent] = moments[parent] + moment;
            }
            None => total = total + moment,
        }
    }
    Energy { kinetic: S::from_f64(0.5) * twice_kinetic, potential: -Vec3::constant(tree.gravity).dot(total) }
}

fn twice_kinetic_energy<S: Scalar>(inertia: &RigidInertia<S>, angular: Vec3<S>, linear: Vec3<S>) -> S {
    let RigidInertia { mass, moment, tensor } = *inertia;
    let momentum = linear.scale(mass) + angular.cross(moment.scale(S::from_f64(2.0)));
    linear.dot(momentum) + angular.dot(tensor.full() * angular)
}
