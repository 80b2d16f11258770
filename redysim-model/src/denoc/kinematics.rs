//! Positions and velocities of all links in the base frame.

use super::joint::joint_frames;
use crate::spatial::{Mat3, Pose, Vec3};
use crate::tree::{Joint, Tree};
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
}

/// Rotation, origin, centre of mass, velocity of the origin and angular velocity of every link, in the model's order.
pub fn link_kinematics<S: Scalar>(tree: &Tree, q: &[S], v: &[S]) -> Vec<LinkState<S>> {
    let mut frames: Vec<MovingFrame<S>> = Vec::with_capacity(tree.bodies.len());
    for (index, (body, joint)) in tree.bodies.iter().zip(joint_frames(tree, q)).enumerate() {
        q[body.coordinate].step("outward", index);
        let parent = body.parent.map_or(MovingFrame::ground(), |parent| frames[parent]);
        let mut frame = parent.carry(Pose { rotation: Mat3::identity(), position: joint.position });
        frame.pose.rotation = Mat3(frame.pose.rotation.0.map(|row| joint.to_body(Vec3(row)).0));
        let along = frame.pose.rotation.column(2).scale(v[body.coordinate]);
        match body.joint {
            Joint::Revolute => frame.angular_velocity = frame.angular_velocity + along,
            Joint::Prismatic => frame.velocity = frame.velocity + along,
        }
        frames.push(frame);
    }
    tree.links
        .iter()
        .map(|link| {
            if let Some(body) = link.body {
                q[tree.bodies[body].coordinate].step("links", body);
            }
            let body = link.body.map_or(MovingFrame::ground(), |body| frames[body]);
            let frame = body.carry(Pose::constant(link.pose));
            let Mat3(rotation) = frame.pose.rotation;
            LinkState {
                rotation,
                origin: frame.pose.position.0,
                com: frame.pose.transform(Vec3::constant(link.com)).0,
                velocity: frame.velocity.0,
                angular_velocity: frame.angular_velocity.0,
            }
        })
        .collect()
}
