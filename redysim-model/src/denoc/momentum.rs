//! The momentum of the whole mechanism.

use super::energy::{first_moment, for_each_velocity};
use super::frame::joint_frames;
use super::trace::Trace;
use crate::parameter::{ParameterIn, per_mass};
use crate::spatial::Wrench;
use crate::tree::Tree;
use redysim_runtime::{Momentum, Scalar};

/// Linear momentum, and angular momentum about the centre of mass, in the axes of the base frame.
///
/// One recursion outwards has the velocities. The momenta of the bodies, as wrenches about their origins, and their
/// first moments add up inwards; about the centre of mass c of the mass m, the angular momentum is that about the base
/// less c × p.
pub fn momentum<S: Scalar, P: ParameterIn<S>>(tree: &Tree<P>, trace: &impl Trace<S>, q: &[S], v: &[S]) -> Momentum<S> {
    let (q, v) = (&tree.all_coordinates(q), &tree.all_velocities(v));
    let frames = joint_frames(tree, trace, q);
    let mut momenta: Vec<Wrench<S>> = Vec::with_capacity(tree.bodies.len());
    for_each_velocity(tree, trace, &frames, v, |index, velocity| {
        momenta.push(frames[index].own_inertia(tree.bodies[index].inertia).to_rigid().momentum(velocity));
    });
    let mut total = Wrench::zero();
    trace.sweep("momenta", tree.inward(), |index| {
        let momentum = frames[index].wrench_to_parent(momenta[index]);
        trace.name_wrench(momentum, ["l", "p"], index);
        match tree.bodies[index].parent {
            Some(parent) => momenta[parent] = momenta[parent] + momentum,
            None => total = total + momentum,
        }
    });
    let (moment, mass) = first_moment(tree, trace, &frames);
    let center = moment.scale(per_mass(mass));
    let Wrench { moment: angular, force: linear } = total.moved_by(-center);
    Momentum { linear: linear.0, angular: angular.0 }
}
