//! Positions and velocities of all links in the base frame.

use super::joint::joint_frames;
use super::trace::Trace;
use crate::spatial::{Mat3, Pose, Vec3};
use crate::tree::{Attachment, Joint, Tree};
use redysim_runtime::{LinkState, Scalar};

/// A frame that moves, seen from the base frame.
#[derive(Clone, Copy)]
struct MovingFrame<S> {
    pose: Pose<S>,
    velocity: Vec3<S>,
    angular_velocity: Vec3<S>,
}

impl<S: Scalar> MovingFrame<S> {
    fn ground() -> Self {
        MovingFrame { pose: Pose::identity(), velocity: Vec3::zero(), angular_velocity: Vec3::zero() }
    }

    /// The frame that stands at `pose` on this one and does not move against it.
    fn carry(self, pose: Pose<S>) -> Self {
        let arm = self.pose.rotation * pose.position;
        MovingFrame {
            pose: Pose { rotation: self.pose.rotation * pose.rotation, position: self.pose.position + arm },
            velocity: self.velocity + self.angular_velocity.cross(arm),
            angular_velocity: self.angular_velocity,
        }
    }

    /// The state of the link whose frame this is.
    fn state_of(self, link: &Attachment) -> LinkState<S> {
        let Mat3(rotation) = self.pose.rotation;
        LinkState {
            rotation,
            origin: self.pose.position.0,
            com: self.pose.transform(Vec3::constant(link.com)).0,
            velocity: self.velocity.0,
            angular_velocity: self.angular_velocity.0,
        }
    }
}

/// Rotation, origin, centre of mass, velocity of the origin and angular velocity of every link, in the model's order.
pub fn link_kinematics<S: Scalar>(tree: &Tree, trace: &impl Trace<S>, q: &[S], v: &[S]) -> Vec<LinkState<S>> {
    let joints = joint_frames(tree, trace, q);
    let mut frames: Vec<MovingFrame<S>> = Vec::with_capacity(tree.bodies.len());
    trace.sweep("outward", tree.outward(), |index| {
        let (body, joint) = (&tree.bodies[index], &joints[index]);
        let parent = body.parent.map_or(MovingFrame::ground(), |parent| frames[parent]);
        let mut frame = parent.carry(Pose { rotation: Mat3::identity(), position: joint.position });
        frame.pose.rotation = Mat3(frame.pose.rotation.0.map(|row| joint.to_body(Vec3(row)).0));
        let along = frame.pose.rotation.column(2).scale(v[body.coordinate]);
        match body.joint {
            Joint::Revolute => frame.angular_velocity = frame.angular_velocity + along,
            Joint::Prismatic => frame.velocity = frame.velocity + along,
        }
        frames.push(frame);
    });
    let state = |link: &Attachment| {
        let pose = Pose::constant(link.pose);
        match link.body {
            Some(body) => {
                let fixed = || frames[body].carry(joints[body].fixed_pose(pose)).state_of(link);
                trace.step("links", body, fixed)
            }
            None => MovingFrame::ground().carry(pose).state_of(link),
        }
    };
    tree.links.iter().map(state).collect()
}
