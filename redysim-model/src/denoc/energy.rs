//! Kinetic and potential energy.

use super::joint::{JointFrame, joint_frames};
use super::trace::Trace;
use crate::inertia::RigidInertia;
use crate::spatial::Vec3;
use crate::tree::{Body, Joint, Tree};
use redysim_runtime::{Energy, Scalar};

/// Kinetic energy ½ Σ (m v² + 2 v·(ω × h) + ωᵀ J ω) and potential energy −Σ m g·c, zero at the base frame's origin, J.
pub fn energy<S: Scalar>(tree: &Tree, trace: &impl Trace<S>, q: &[S], v: &[S]) -> Energy<S> {
    let frames = joint_frames(tree, trace, q);
    let mut motions: Vec<(Vec3<S>, Vec3<S>)> = Vec::with_capacity(tree.bodies.len());
    let mut twice_kinetic = S::zero();
    trace.sweep("outward", tree.outward(), |index| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
        let (angular, linear) = body.parent.map_or((Vec3::zero(), Vec3::zero()), |parent| motions[parent]);
        let mut linear = frame.to_body(linear + angular.cross(frame.position));
        let mut angular = frame.to_body(angular);
        match body.joint {
            Joint::Revolute => angular[2] += v[body.coordinate],
            Joint::Prismatic => linear[2] += v[body.coordinate],
        }
        trace.name_vector(angular, "w", index);
        trace.name_vector(linear, "vel", index);
        twice_kinetic += twice_kinetic_energy(&frame.own_inertia(body.inertia).to_rigid(), angular, linear);
        motions.push((angular, linear));
    });
    let of_body = |(body, frame): (&Body, &JointFrame<S>)| frame.fixed_vector(Vec3::constant(body.inertia.moment));
    let mut moments: Vec<Vec3<S>> = tree.bodies.iter().zip(&frames).map(of_body).collect();
    let mut masses: Vec<f64> = tree.bodies.iter().map(|body| body.inertia.mass).collect();
    let mut total = Vec3::constant(tree.ground.moment);
    trace.sweep("inward", tree.inward(), |index| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
        let moment = frame.position.scale(S::from_f64(masses[index])) + frame.to_parent(moments[index]);
        match body.parent {
            Some(parent) => {
                masses[parent] += masses[index];
                moments[parent] = moments[parent] + moment;
            }
            None => total = total + moment,
        }
    });
    Energy { kinetic: S::from_f64(0.5) * twice_kinetic, potential: -Vec3::constant(tree.gravity).dot(total) }
}

fn twice_kinetic_energy<S: Scalar>(inertia: &RigidInertia<S>, angular: Vec3<S>, linear: Vec3<S>) -> S {
    let RigidInertia { mass, moment, tensor } = *inertia;
    let momentum = linear.scale(mass) + angular.cross(moment.scale(S::from_f64(2.0)));
    linear.dot(momentum) + angular.dot(tensor.full() * angular)
}
