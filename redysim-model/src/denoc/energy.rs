//! Kinetic and potential energy.

use super::frame::{JointFrame, joint_frames};
use super::springs::Springs;
use super::trace::Trace;
use crate::inertia::RigidInertia;
use crate::parameter::ParameterIn;
use crate::spatial::{Twist, Vec3};
use crate::tree::{Body, Tree};
use redysim_runtime::{Energy, Scalar};

/// Kinetic energy ½ Σ (m v² + 2 v·(ω × h) + ωᵀ J ω), with that of the rotors, and potential energy −Σ m g·c, zero at
/// the base frame's origin, with that of the springs, J.
pub fn energy<S: Scalar, P: ParameterIn<S>>(tree: &Tree<P>, trace: &impl Trace<S>, q: &[S], v: &[S]) -> Energy<S> {
    let (q, v) = (&tree.all_coordinates(q), &tree.all_velocities(v));
    let frames = joint_frames(tree, trace, q);
    let mut twice_kinetic = S::zero();
    let mut twice_springs = Springs::default().twice_energy(tree, &frames);
    for_each_velocity(tree, trace, &frames, v, |index, velocity| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
        twice_kinetic += twice_kinetic_energy(&frame.own_inertia(body.inertia).to_rigid(), velocity);
        if let Some(physics) = &body.physics {
            for (i, &v) in v[body.v.clone()].iter().enumerate() {
                if let Some(armature) = physics.armature(i) {
                    twice_kinetic += armature * (v * v);
                }
            }
            if let Some(energy) = physics.twice_spring_energy(body.joint, &q[body.q.clone()]) {
                twice_springs = Some(twice_springs.map_or(energy, |sum| sum + energy));
            }
        }
    });
    let (total, _) = first_moment(tree, trace, &frames);
    let half = S::from_f64(0.5);
    let lifted = tree.gravity.map(ParameterIn::value).fused_dot(total);
    let potential = twice_springs.map_or(-lifted, |springs| half * springs - lifted);
    Energy { kinetic: half * twice_kinetic, potential }
}

/// Calls `visit` with each body, parents first, and its velocity at its origin, in its axes.
pub(super) fn for_each_velocity<S: Scalar>(
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    frames: &[JointFrame<S>],
    v: &[S],
    mut visit: impl FnMut(usize, Twist<S>),
) {
    let mut velocities: Vec<Twist<S>> = Vec::with_capacity(tree.bodies.len());
    trace.sweep("outward", tree.outward(), |index| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
        let parent = body.parent.map_or(Twist::zero(), |parent| velocities[parent]);
        let velocity = body.joint.added(frame.twist_to_body(parent), &v[body.v.clone()]);
        trace.name_twist(velocity, ["w", "vel"], index);
        visit(index, velocity);
        velocities.push(velocity);
    });
}

/// The first moment about the origin of the base frame, and the mass, of all links.
pub(super) fn first_moment<S: Scalar, P: ParameterIn<S>>(
    tree: &Tree<P>,
    trace: &impl Trace<S>,
    frames: &[JointFrame<S>],
) -> (Vec3<S>, P) {
    let of_body =
        |(body, frame): (&Body<P>, &JointFrame<S>)| frame.fixed_vector(body.inertia.moment.map(ParameterIn::value));
    let mut moments: Vec<Vec3<S>> = tree.bodies.iter().zip(frames).map(of_body).collect();
    let mut masses: Vec<P> = tree.bodies.iter().map(|body| body.inertia.mass).collect();
    let (mut total, mut mass) = (tree.ground.moment.map(ParameterIn::value), tree.ground.mass);
    trace.sweep("inward", tree.inward(), |index| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
        let moment = frame.position.scale(masses[index].value()) + frame.to_parent(moments[index]);
        match body.parent {
            Some(parent) => {
                masses[parent] = masses[parent] + masses[index];
                moments[parent] = moments[parent] + moment;
            }
            None => {
                mass += masses[index];
                total = total + moment;
            }
        }
    });
    (total, mass)
}

fn twice_kinetic_energy<S: Scalar>(inertia: &RigidInertia<S>, Twist { angular, linear }: Twist<S>) -> S {
    let RigidInertia { mass, moment, tensor } = *inertia;
    let momentum = linear.scale(mass) + angular.fused_cross(moment.scale(S::from_f64(2.0)));
    linear.fused_dot(momentum) + angular.fused_dot(tensor.full().fused_product(angular))
}
