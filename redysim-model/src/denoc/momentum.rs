//! The momentum of the whole mechanism.

use super::frame::{JointFrame, joint_frames};
use super::trace::Trace;
use crate::parameter::ParameterIn;
use crate::spatial::{Twist, Vec3, Wrench};
use crate::tree::{Body, Tree};
use redysim_runtime::{Momentum, Scalar};

/// Linear momentum, and angular momentum about the centre of mass, in the axes of the base frame.
///
/// One recursion outwards has the velocities. The momenta of the bodies, as wrenches about their origins, and their
/// first moments add up inwards; about the centre of mass c of the mass m, the angular momentum is that about the base
/// less c × p.
pub fn momentum<S: Scalar, P: ParameterIn<S>>(tree: &Tree<P>, trace: &impl Trace<S>, q: &[S], v: &[S]) -> Momentum<S> {
    let frames = joint_frames(tree, trace, q);
    let mut velocities: Vec<Twist<S>> = Vec::with_capacity(tree.bodies.len());
    let mut momenta: Vec<Wrench<S>> = Vec::with_capacity(tree.bodies.len());
    trace.sweep("outward", tree.outward(), |index| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
        let parent = body.parent.map_or(Twist::zero(), |parent| velocities[parent]);
        let velocity = body.joint.added(frame.twist_to_body(parent), &v[body.v.clone()]);
        trace.name_twist(velocity, ["w", "vel"], index);
        momenta.push(frame.own_inertia(body.inertia).to_rigid().momentum(velocity));
        velocities.push(velocity);
    });
    let of_body =
        |(body, frame): (&Body<P>, &JointFrame<S>)| frame.fixed_vector(body.inertia.moment.map(ParameterIn::value));
    let mut moments: Vec<Vec3<S>> = tree.bodies.iter().zip(&frames).map(of_body).collect();
    let mut masses: Vec<P> = tree.bodies.iter().map(|body| body.inertia.mass).collect();
    let (mut total, mut moment, mut mass) =
        (Wrench::zero(), tree.ground.moment.map(ParameterIn::value), tree.ground.mass);
    trace.sweep("inward", tree.inward(), |index| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
        let momentum = frame.wrench_to_parent(momenta[index]);
        trace.name_wrench(momentum, ["l", "p"], index);
        let carried = frame.position.scale(masses[index].value()) + frame.to_parent(moments[index]);
        match body.parent {
            Some(parent) => {
                momenta[parent] = momenta[parent] + momentum;
                moments[parent] = moments[parent] + carried;
                masses[parent] = masses[parent] + masses[index];
            }
            None => {
                total = total + momentum;
                moment = moment + carried;
                mass += masses[index];
            }
        }
    });
    let center = moment.scale((P::one() / mass).value());
    let Wrench { moment: angular, force: linear } = total.moved_by(-center);
    Momentum { linear: linear.0, angular: angular.0 }
}
