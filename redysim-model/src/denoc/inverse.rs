//! Inverse dynamics: joint forces from motion, by one recursion outwards and one inwards (recursive Newton-Euler).

use super::joint::{along_joint, joint_frames};
use crate::inertia::RigidInertia;
use crate::spatial::{Mat3, Vec3};
use crate::tree::{Joint, Tree};
use redysim_runtime::Scalar;

/// Motion of a body in its own frame. Gravity is an acceleration of the ground, so it needs no forces of its own.
#[derive(Clone, Copy)]
struct BodyMotion<S> {
    /// Angular velocity ω.
    angular: Vec3<S>,
    /// Angular acceleration ω̇.
    angular_rate: Vec3<S>,
    /// U = ω̇× + (ω×)², which takes a point fixed to the body to its acceleration against the origin.
    point_rate: Mat3<S>,
    /// Acceleration of the origin, less gravity.
    acceleration: Vec3<S>,
}

impl<S: Scalar> BodyMotion<S> {
    fn new(angular: Vec3<S>, angular_rate: Vec3<S>, acceleration: Vec3<S>) -> Self {
        let w = angular;
        let products = Mat3::from_fn(|i, j| {
            if i == j { -(w[(i + 1) % 3] * w[(i + 1) % 3] + w[(i + 2) % 3] * w[(i + 2) % 3]) } else { w[i] * w[j] }
        });
        BodyMotion { angular, angular_rate, point_rate: products + angular_rate.skew(), acceleration }
    }

    fn ground(gravity: Vec3<f64>) -> Self {
        Self::new(Vec3::zero(), Vec3::zero(), Vec3::constant(-gravity))
    }

    /// Force and moment about the origin that give a body of this inertia this motion:
    /// f = m a + U h, n = J ω̇ + ω × J ω + h × a.
    fn wrench(&self, inertia: &RigidInertia<f64>) -> (Vec3<S>, Vec3<S>) {
        let RigidInertia { mass, moment, tensor } = RigidInertia::constant(*inertia);
        let force = self.acceleration.scale(mass) + self.point_rate * moment;
        let (w, rate, u) = (self.angular, self.angular_rate, self.point_rate.0);
        // The gyroscopic moment in the elements of U, which the force has computed already. Differences of constants
        // are taken in numbers.
        let t = inertia.tensor;
        let [zy, xz, yx] = [t.zz - t.yy, t.xx - t.zz, t.yy - t.xx].map(S::from_f64);
        let gyroscopic = Vec3([
            tensor.xx * rate[0] + zy * (w[1] * w[2]) - tensor.xy * u[2][0]
                + tensor.xz * u[1][0]
                + tensor.yz * (u[1][1] - u[2][2]),
            tensor.yy * rate[1] + xz * (w[2] * w[0]) - tensor.yz * u[0][1]
                + tensor.xy * u[2][1]
                + tensor.xz * (u[2][2] - u[0][0]),
            tensor.zz * rate[2] + yx * (w[0] * w[1]) - tensor.xz * u[1][2]
                + tensor.yz * u[0][2]
                + tensor.xy * (u[0][0] - u[1][1]),
        ]);
        (force, gyroscopic + moment.cross(self.acceleration))
    }
}

/// τ = M(q) a + C(q, v) v + g(q): the joint forces for accelerations `a` at coordinates `q` and velocities `v`.
pub fn inverse_dynamics<S: Scalar>(tree: &Tree, q: &[S], v: &[S], a: &[S]) -> Vec<S> {
    let frames = joint_frames(tree, q);
    let ground = BodyMotion::ground(tree.gravity);
    let mut motions: Vec<BodyMotion<S>> = Vec::with_capacity(tree.bodies.len());
    let mut wrenches: Vec<(Vec3<S>, Vec3<S>)> = Vec::with_capacity(tree.bodies.len());
    for (index, (body, frame)) in tree.bodies.iter().zip(&frames).enumerate() {
        q[body.coordinate].step("outward", index);
        let parent = body.parent.map_or(ground, |parent| motions[parent]);
        let (rate, acceleration) = (v[body.coordinate], a[body.coordinate]);
        let mut angular = frame.to_body(parent.angular);
        let mut angular_rate = frame.to_body(parent.angular_rate);
        let mut linear = frame.to_body(parent.acceleration + parent.point_rate * frame.position);
        let [x, y, _] = angular.0;
        match body.joint {
            Joint::Revolute => {
                angular_rate = angular_rate + Vec3([y * rate, -(x * rate), acceleration]);
                angular[2] += rate;
            }
            Joint::Prismatic => {
                let twice = rate + rate;
                linear = linear + Vec3([y * twice, -(x * twice), acceleration]);
            }
        }
        let motion = BodyMotion::new(
            angular.named("w", index),
            angular_rate.named("dw", index),
            linear.named("acc", index),
        );
        wrenches.push(motion.wrench(&body.inertia));
        motions.push(motion);
    }
    let mut tau = vec![S::zero(); tree.dof()];
    for (index, (body, frame)) in tree.bodies.iter().zip(&frames).enumerate().rev() {
        q[body.coordinate].step("inward", index);
        let (force, moment) = wrenches[index];
        let (force, moment) = (force.named("force", index), moment.named("moment", index));
        tau[body.coordinate] = along_joint(body.joint, force, moment).named("tau", index, "");
        if let Some(parent) = body.parent {
            let (force, moment) = frame.wrench_to_parent(force, moment);
            wrenches[parent].0 = wrenches[parent].0 + force;
            wrenches[parent].1 = wrenches[parent].1 + moment;
        }
    }
    tau
}

/// C(q, v) v + g(q): the joint forces at zero acceleration.
pub fn bias_forces<S: Scalar>(tree: &Tree, q: &[S], v: &[S]) -> Vec<S> {
    inverse_dynamics(tree, q, v, &vec![S::zero(); tree.dof()])
}

/// g(q): the joint forces at rest.
pub fn gravity_forces<S: Scalar>(tree: &Tree, q: &[S]) -> Vec<S> {
    bias_forces(tree, q, &vec![S::zero(); tree.dof()])
}
