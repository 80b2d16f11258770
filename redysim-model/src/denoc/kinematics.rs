//! Positions and velocities of all links, and of all frames of interest, in the base frame.

use super::base_frame::{Bodies, Order, Placed};
use super::trace::Trace;
use crate::parameter::ParameterIn;
use crate::spatial::Mat3;
use crate::tree::{Attachment, BodyFrame, Tree};
use redysim_runtime::{FrameState, LinkState, Scalar};

/// Rotation, origin, centre of mass, velocity of the origin and angular velocity of every link, in the model's order.
pub fn link_kinematics<S: Scalar, P: ParameterIn<S>>(
    tree: &Tree<P>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
) -> Vec<LinkState<S>> {
    let (q, v) = (&tree.all_coordinates(q), &tree.all_velocities(v));
    let bodies = Bodies::new(tree, trace, q, v, Order::Velocities);
    let state = |link: &Attachment<P>| match link.body {
        Some(body) => trace.step("links", body, || state_of(link, bodies.place(link.body, link.pose))),
        None => state_of(link, bodies.place(None, link.pose)),
    };
    tree.links.iter().map(state).collect()
}

/// Rotation, origin, velocity of the origin and angular velocity of every frame of interest, in the model's order.
pub fn frame_kinematics<S: Scalar>(
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
) -> Vec<FrameState<S>> {
    let (q, v) = (&tree.all_coordinates(q), &tree.all_velocities(v));
    let bodies = Bodies::new(tree, trace, q, v, Order::Velocities);
    let state = |frame: &BodyFrame| {
        let Placed { pose, velocity, angular, .. } = bodies.place(frame.body, frame.pose);
        let Mat3(rotation) = pose.rotation;
        FrameState { rotation, origin: pose.position.0, velocity: velocity.0, angular_velocity: angular.0 }
    };
    tree.frames.iter().map(state).collect()
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
