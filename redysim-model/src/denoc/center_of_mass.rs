//! The centre of mass of the whole mechanism, from composite bodies.

use super::frame::{JointFrame, joint_frames};
use super::trace::Trace;
use crate::joint::across;
use crate::parameter::{ParameterIn, per_mass};
use crate::spatial::Vec3;
use crate::tree::{Body, Tree};
use redysim_runtime::{CenterOfMass, Scalar};

/// Position Σ m c / Σ m and velocity Σ m ċ / Σ m of the centre of mass, in the base frame.
///
/// Momentum is linear in the joint velocities: a joint that turns about an axis e adds v (e × h) to that of what it
/// carries, whose first moment about the joint is h, and one that slides along e adds v m e. So one recursion inwards has both.
pub fn center_of_mass<S: Scalar, P: ParameterIn<S>>(
    tree: &Tree<P>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
) -> CenterOfMass<S> {
    let (q, v) = (&tree.all_coordinates(q), &tree.all_velocities(v));
    let frames = joint_frames(tree, trace, q);
    let of_body =
        |(body, frame): (&Body<P>, &JointFrame<S>)| frame.fixed_vector(body.inertia.moment.map(ParameterIn::value));
    let mut moments: Vec<Vec3<S>> = tree.bodies.iter().zip(&frames).map(of_body).collect();
    let mut masses: Vec<_> = tree.bodies.iter().map(|body| body.inertia.mass).collect();
    let mut momenta = vec![Vec3::zero(); tree.bodies.len()];
    let (mut moment, mut mass, mut momentum) =
        (tree.ground.moment.map(ParameterIn::value), tree.ground.mass, Vec3::zero());
    trace.sweep("inward", tree.inward(), |index| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
        let own = moments[index];
        trace.name_vector(own, "h", index);
        let mut own_momentum = momenta[index];
        for (screw, &v) in body.joint.screws().zip(&v[body.v.clone()]) {
            if let Some(turn) = screw.turn(v) {
                own_momentum = own_momentum + across(screw.axis, own).scale(turn);
            }
            if let Some(slide) = screw.slide(v) {
                own_momentum[screw.axis] += masses[index].value() * slide;
            }
        }
        trace.name_vector(own_momentum, "p", index);
        let carried = frame.position.scale(masses[index].value()) + frame.to_parent(own);
        let carried_momentum = frame.to_parent(own_momentum);
        match body.parent {
            Some(parent) => {
                masses[parent] = masses[parent] + masses[index];
                moments[parent] = moments[parent] + carried;
                momenta[parent] = momenta[parent] + carried_momentum;
            }
            None => {
                mass += masses[index];
                moment = moment + carried;
                momentum = momentum + carried_momentum;
            }
        }
    });
    let share = per_mass(mass);
    CenterOfMass { position: moment.scale(share).0, velocity: momentum.scale(share).0 }
}
