//! Positions and velocities of all links in the base frame.

use super::base_frame::{Order, Placed, bodies};
use super::trace::Trace;
use crate::parameter::ParameterIn;
use crate::spatial::{Mat3, Pose};
use crate::tree::{Attachment, Tree};
use redysim_runtime::{LinkState, Scalar};

/// Rotation, origin, centre of mass, velocity of the origin and angular velocity of every link, in the model's order.
pub fn link_kinematics<S: Scalar, P: ParameterIn<S>>(
    tree: &Tree<P>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
) -> Vec<LinkState<S>> {
    let order = Order::Velocities;
    let (bodies, joints) = bodies(tree, trace, q, v, order);
    let state = |link: &Attachment<P>| {
        let pose = Pose::constant(link.pose);
        match link.body {
            Some(body) => {
                trace.step("links", body, || state_of(link, bodies[body].carry(joints[body].fixed_pose(pose), order)))
            }
            None => state_of(link, Placed::ground().carry(pose, order)),
        }
    };
    tree.links.iter().map(state).collect()
}

/// The state of a link with the given frame.
fn state_of<S: Scalar>(link: &Attachment<impl ParameterIn<S>>, frame: Placed<S>) -> LinkState<S> {
    let Mat3(rotation) = frame.pose.rotation;
    LinkState {
        rotation,
        origin: frame.pose.position.0,
        com: frame.pose.transform(link.com.map(ParameterIn::value)).0,
        velocity: frame.velocity.0,
        angular_velocity: frame.angular.0,
    }
}
