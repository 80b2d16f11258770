//! Frames of interest: Jacobians, their derivatives along the motion, and the joint forces of wrenches.
//!
//! Results are in the axes of the base frame. The Jacobian has a column for each freedom between the ground and the frame:
//! one that turns about the axis z moves a point at the arm r from its origin by z × r. In the body's own axes that is
//! (−r_y, r_x, 0), two products with columns of its rotation, and none for a frame on the axis.

use super::base_frame::{Bodies, Order};
use super::trace::Trace;
use crate::parameter::ParameterIn;
use crate::spatial::Wrench;
use crate::tree::{BodyFrame, Tree};
use redysim_runtime::{FrameAcceleration, FrameJacobian, Scalar};

/// The Jacobian of each frame at its origin, in the model's order: a row for each axis of the base frame, a column for
/// each velocity.
pub fn frame_jacobians<S: Scalar>(
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    q: &[S],
) -> Vec<FrameJacobian<Vec<S>>> {
    let q = &tree.all_coordinates(q);
    let bodies = Bodies::new(tree, trace, q, &[], Order::Positions);
    let jacobian = |frame: &BodyFrame| {
        let [mut linear, mut angular] = [0; 2].map(|_| [0; 3].map(|_| vec![S::zero(); tree.nv_of_all()]));
        let mut arm = bodies.fixed_vector(frame.body, frame.pose.position);
        let mut at = frame.body;
        while let Some(index) = at {
            let (body, rotation) = (&tree.bodies[index], bodies.placed[index].pose.rotation);
            for (velocity, screw) in body.v.clone().zip(body.joint.screws()) {
                let motion = screw.motion_at(arm);
                let column = [rotation.fused_product(motion.linear), rotation.fused_product(motion.angular)];
                for i in 0..3 {
                    [linear[i][velocity], angular[i][velocity]] = column.map(|vector| vector[i]);
                }
            }
            arm = bodies.joints[index].point_to_parent(arm);
            at = body.parent;
        }
        let folded = |rows: [Vec<S>; 3]| rows.map(|row| tree.folded(row));
        FrameJacobian { linear: folded(linear), angular: folded(angular) }
    };
    tree.frames.iter().map(jacobian).collect()
}

/// J̇ v of each frame, in the model's order: the acceleration of its origin and its angular acceleration at zero joint
/// accelerations.
pub fn frame_bias<S: Scalar>(
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
) -> Vec<FrameAcceleration<S>> {
    let (q, v) = (&tree.all_coordinates(q), &tree.all_velocities(v));
    let bodies = Bodies::new(tree, trace, q, v, Order::Accelerations);
    let acceleration = |frame: &BodyFrame| {
        let placed = bodies.place(frame.body, frame.pose);
        FrameAcceleration { linear: placed.acceleration.0, angular: placed.angular_acceleration.0 }
    };
    tree.frames.iter().map(acceleration).collect()
}

/// Σ Jᵀ w: the joint forces of a wrench at the origin of each frame, in the axes of the base frame.
///
/// What a body carries is one wrench about its joint's origin, whose share along the joint is the joint force.
pub fn frame_forces<S: Scalar>(
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    q: &[S],
    wrenches: &[Wrench<S>],
) -> Vec<S> {
    let q = &tree.all_coordinates(q);
    let bodies = Bodies::new(tree, trace, q, &[], Order::Positions);
    let mut carried: Vec<Option<Wrench<S>>> = vec![None; tree.bodies.len()];
    for (frame, wrench) in tree.frames.iter().zip(wrenches) {
        if let Some(body) = frame.body {
            let wrench = wrench
                .moved_by(bodies.placed[body].pose.rotation * bodies.fixed_vector(frame.body, frame.pose.position));
            carried[body] = Some(carried[body].map_or(wrench, |others| others + wrench));
        }
    }
    let mut forces = vec![S::zero(); tree.nv_of_all()];
    trace.sweep("inward", tree.inward(), |index| {
        let Some(wrench) = carried[index] else { return };
        let body = &tree.bodies[index];
        trace.name_wrench(wrench, ["moment", "force"], index);
        for (velocity, screw) in body.v.clone().zip(body.joint.screws()) {
            forces[velocity] = screw.project_along(bodies.axis(index, screw.axis), wrench);
        }
        if let Some(parent) = body.parent {
            let wrench = wrench.moved_by(bodies.joint_arm(tree, index));
            carried[parent] = Some(carried[parent].map_or(wrench, |others| others + wrench));
        }
    });
    tree.folded(forces)
}
