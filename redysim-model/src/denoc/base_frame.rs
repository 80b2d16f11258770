//! Where every body is and how it moves, seen from the base frame.

use super::frame::{JointFrame, joint_frames};
use super::trace::Trace;
use crate::parameter::ParameterIn;
use crate::spatial::{Mat3, Pose, Twist, Vec3};
use crate::tree::{Body, Tree};
use redysim_runtime::Scalar;

/// How many derivatives of positions are computed; the others are zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Order {
    Positions,
    Velocities,
    Accelerations,
}

/// A frame in the base frame.
#[derive(Clone, Copy)]
pub(super) struct Placed<S> {
    pub pose: Pose<S>,
    /// Velocity of the origin.
    pub velocity: Vec3<S>,
    /// Angular velocity.
    pub angular: Vec3<S>,
    /// Acceleration of the origin at zero joint accelerations, without gravity.
    pub acceleration: Vec3<S>,
    /// Angular acceleration at zero joint accelerations.
    pub angular_acceleration: Vec3<S>,
}

impl<S: Scalar> Placed<S> {
    pub fn ground() -> Self {
        let zero = Vec3::zero();
        Placed { pose: Pose::identity(), velocity: zero, angular: zero, acceleration: zero, angular_acceleration: zero }
    }

    /// The derivative of a vector fixed to the frame, ω × r, ...
    pub fn derivative(&self, arm: Vec3<S>) -> Vec3<S> {
        self.angular.fused_cross(arm)
    }

    /// ... and its second derivative, ω̇ × r + ω × (ω × r).
    pub fn second_derivative(&self, arm: Vec3<S>) -> Vec3<S> {
        self.angular_acceleration.fused_cross(arm) + self.derivative(self.derivative(arm))
    }

    /// The frame, so far fixed to `parent`, at the velocity `across` against it, in its own axes.
    fn moved_across(mut self, parent: &Self, across: Twist<S>) -> Self {
        let [turn, slide] = [across.angular, across.linear].map(|vector| self.pose.rotation.fused_product(vector));
        self.angular_acceleration = self.angular_acceleration + parent.derivative(turn);
        self.angular = self.angular + turn;
        self.acceleration = self.acceleration + (parent.angular + self.angular).fused_cross(slide);
        self.velocity = self.velocity + slide;
        self
    }

    /// The frame that stands at `pose` on this one and does not move against it.
    pub fn carry(self, pose: Pose<S>, order: Order) -> Self {
        let arm = self.pose.rotation.fused_product(pose.position);
        let mut carried = self;
        let rotation = self.pose.rotation.apart() * pose.rotation.apart();
        carried.pose = Pose { rotation, position: self.pose.position + arm };
        if order >= Order::Velocities {
            carried.velocity = self.velocity + self.derivative(arm);
        }
        if order >= Order::Accelerations {
            carried.acceleration = self.acceleration + self.second_derivative(arm);
        }
        carried
    }
}

/// All bodies in the base frame, and their joints' frames.
pub(super) struct Bodies<S> {
    pub placed: Vec<Placed<S>>,
    pub joints: Vec<JointFrame<S>>,
    order: Order,
}

impl<S: Scalar> Bodies<S> {
    /// At the coordinates `q` and velocities `v`.
    pub fn new(tree: &Tree<impl ParameterIn<S>>, trace: &impl Trace<S>, q: &[S], v: &[S], order: Order) -> Self {
        let (placed, joints) = bodies(tree, trace, q, v, order);
        Bodies { placed, joints, order }
    }

    /// The frame that stands at `pose` on a body; `None` is the ground.
    pub fn place(&self, body: Option<usize>, pose: Pose<f64>) -> Placed<S> {
        let pose = Pose::constant(pose);
        match body {
            Some(body) => self.placed[body].carry(self.joints[body].fixed_pose(pose), self.order),
            None => Placed::ground().carry(pose, self.order),
        }
    }

    /// An axis of a body's frame.
    pub fn axis(&self, body: usize, axis: usize) -> Vec3<S> {
        self.placed[body].pose.rotation.column(axis)
    }

    /// A vector fixed to a body, in the body's axes; `None` is the ground.
    pub fn fixed_vector(&self, body: Option<usize>, vector: Vec3<f64>) -> Vec3<S> {
        let vector = Vec3::constant(vector);
        body.map_or(vector, |body| self.joints[body].fixed_vector(vector))
    }

    /// From the origin of a body's parent to its own.
    pub fn joint_arm(&self, tree: &Tree<impl Copy>, body: usize) -> Vec3<S> {
        let position = self.joints[body].position;
        tree.bodies[body].parent.map_or(position, |parent| self.placed[parent].pose.rotation.fused_product(position))
    }
}

/// Bodies one behind another whose joint axes are parallel: their angular velocities differ along the axes only, by the
/// sum of the joints' rates, and no rate is multiplied by an axis twice.
#[derive(Clone, Copy)]
struct ParallelRun<S> {
    /// The parent of the first body; `None` is the ground.
    base: Option<usize>,
    /// The rate of the last body against it, about its own axis.
    rate: S,
}

impl<S: Scalar> ParallelRun<S> {
    /// The run up to the body behind its last one, before the rate of that body's own joint is added.
    fn behind<P>(self, body: &Body<P>) -> Self {
        ParallelRun { rate: body.about_parallel_axis(self.rate), ..self }
    }
}

/// All bodies at the coordinates `q` and velocities `v`, and their joints' frames.
fn bodies<S: Scalar>(
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
    order: Order,
) -> (Vec<Placed<S>>, Vec<JointFrame<S>>) {
    let joints = joint_frames(tree, trace, q);
    let mut bodies: Vec<Placed<S>> = Vec::with_capacity(tree.bodies.len());
    let mut runs: Vec<ParallelRun<S>> = Vec::new();
    trace.sweep("outward", tree.outward(), |index| {
        let (body, joint) = (&tree.bodies[index], &joints[index]);
        let parent = body.parent.map_or(Placed::ground(), |parent| bodies[parent]);
        let mut placed = parent.carry(Pose { rotation: Mat3::identity(), position: joint.position }, order);
        placed.pose.rotation = parent.pose.rotation.map_rows(|row| joint.to_body(row));
        if order >= Order::Velocities {
            if !body.joint.is_on_axis() {
                runs.push(ParallelRun { base: Some(index), rate: S::zero() });
                bodies.push(placed.moved_across(&parent, body.joint.added(Twist::zero(), &v[body.v.clone()])));
                return;
            }
            let axis = placed.pose.rotation.column(2);
            let (screw, qd) = (body.joint.screw(0), v[body.v.start]);
            let mut run = match body.parent {
                Some(parent) if body.is_parallel() => runs[parent].behind(body),
                _ => ParallelRun { base: body.parent, rate: S::zero() },
            };
            if let Some(turn) = screw.turn(qd) {
                let base = run.base.map_or(Placed::ground(), |base| bodies[base]);
                run.rate += turn;
                let turn = axis.scale(run.rate);
                placed.angular_acceleration = base.angular_acceleration + base.derivative(turn);
                placed.angular = base.angular + turn;
            }
            runs.push(run);
            if let Some(slide) = screw.slide(qd).map(|slide| axis.scale(slide)) {
                let across = parent.derivative(slide);
                placed.acceleration = placed.acceleration + across + across;
                placed.velocity = placed.velocity + slide;
            }
        }
        bodies.push(placed);
    });
    (bodies, joints)
}
