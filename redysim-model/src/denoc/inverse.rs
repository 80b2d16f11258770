//! Inverse dynamics: joint forces from motion, by one recursion outwards and one inwards (recursive Newton-Euler).

use super::joint::{JointFrame, along_joint, joint_frames};
use super::trace::Trace;
use crate::inertia::Sym3;
use crate::pseudo::PseudoInertia;
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

    /// The motion behind a joint that turns about z with rate `rate` and acceleration `joint`.
    fn behind_revolute(self, frame: &JointFrame<S>, rate: S, joint: S) -> Self {
        let acceleration = frame.to_body(self.acceleration + self.point_rate * frame.position);
        let mut w = frame.to_body(self.angular);
        let before = frame.to_body(self.angular_rate);
        let Some(image) = frame.axis_image(self.point_rate) else {
            let rates = before + Vec3([w[1] * rate, -(w[0] * rate), joint]);
            w[2] += rate;
            return Self::new(w, rates, acceleration);
        };
        // The points of the axis belong to both bodies, so the third columns of their U are the same vector, and
        // U_xz = ω_x ω_z + ω̇_y, U_yz = ω_y ω_z − ω̇_x give ω̇ without the products of ω and the joint's rate.
        w[2] += rate;
        let rates = Vec3([w[1] * w[2] - image[1], image[0] - w[0] * w[2], before[2] + joint]);
        let mut motion = Self::new(w, rates, acceleration);
        for i in 0..3 {
            motion.point_rate.0[i][2] = image[i];
        }
        motion
    }

    /// The motion behind a joint that moves along z with rate `rate` and acceleration `joint`.
    fn behind_prismatic(self, frame: &JointFrame<S>, rate: S, joint: S) -> Self {
        let w = frame.to_body(self.angular);
        let twice = rate + rate;
        let acceleration = frame.to_body(self.acceleration + self.point_rate * frame.position);
        let acceleration = acceleration + Vec3([w[1] * twice, -(w[0] * twice), joint]);
        Self::new(w, frame.to_body(self.angular_rate), acceleration)
    }

    fn name(&self, trace: &impl Trace<S>, body: usize) {
        trace.name_vector(self.angular, "w", body);
        trace.name_vector(self.angular_rate, "dw", body);
        trace.name_vector(self.acceleration, "acc", body);
    }

    /// Force and moment about the origin that give a body of these moments of mass this motion: f = m a + U h, and n
    /// such that n× = U Σ − (U Σ)ᵀ, plus h × a.
    fn wrench(&self, inertia: &PseudoInertia<S>, shape: Shape<S>) -> (Vec3<S>, Vec3<S>) {
        let PseudoInertia { mass, moment, second: s } = *inertia;
        let force = self.acceleration.scale(mass) + self.point_rate * moment;
        let (w, u) = (self.angular, self.point_rate.0);
        // U_jj − U_ii.
        let squares = |i: usize, j: usize| w[j] * w[j] - w[i] * w[i];
        // Σ_jj U_kj − Σ_kk U_jk, for i, j, k in cyclic order: where the two moments are equal, only ω̇ is left of U.
        let across = |i: usize, j: usize, k: usize, first: S, second: S| {
            if shape.equal[i] {
                (first + second) * self.angular_rate[i]
            } else if shape.still && i == 2 {
                // In axes that do not turn, the sum is a constant and the difference is not.
                shape.polar * self.angular_rate[i] + (first - second) * (w[j] * w[k])
            } else {
                first * u[k][j] - second * u[j][k]
            }
        };
        let own = Vec3([
            across(0, 1, 2, s.yy, s.zz) + s.xy * u[2][0] - s.xz * u[1][0] + s.yz * squares(1, 2),
            across(1, 2, 0, s.zz, s.xx) + s.yz * u[0][1] - s.xy * u[2][1] + s.xz * squares(2, 0),
            across(2, 0, 1, s.xx, s.yy) + s.xz * u[1][2] - s.yz * u[0][2] + s.xy * squares(0, 1),
        ]);
        (force, own + moment.cross(self.acceleration))
    }
}

/// What is known of a body's moments of mass in numbers.
#[derive(Clone, Copy)]
struct Shape<S> {
    /// Σ_xx + Σ_yy.
    polar: S,
    /// Whether the two second moments across each axis are equal.
    equal: [bool; 3],
    /// Whether the body turns against its axes.
    still: bool,
}

impl<S: Scalar> Shape<S> {
    fn new(inertia: &PseudoInertia<f64>, frame: &JointFrame<S>) -> Self {
        let Sym3 { xx, yy, zz, xy, .. } = inertia.second;
        let still = frame.is_still();
        let round = xx == yy && (xy == 0.0 || !still);
        Shape {
            equal: [yy == zz && !still, zz == xx && !still, round],
            still,
            polar: S::from_f64(xx) + S::from_f64(yy),
        }
    }
}

/// τ = M(q) a + C(q, v) v + g(q): the joint forces for accelerations `a` at coordinates `q` and velocities `v`.
pub fn inverse_dynamics<S: Scalar>(tree: &Tree, trace: &impl Trace<S>, q: &[S], v: &[S], a: &[S]) -> Vec<S> {
    let frames = joint_frames(tree, trace, q);
    let ground = BodyMotion::ground(tree.gravity);
    let mut motions: Vec<BodyMotion<S>> = Vec::with_capacity(tree.bodies.len());
    let mut wrenches: Vec<(Vec3<S>, Vec3<S>)> = Vec::with_capacity(tree.bodies.len());
    trace.sweep("outward", tree.outward(), |index| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
        let parent = body.parent.map_or(ground, |parent| motions[parent]);
        let (rate, joint) = (v[body.coordinate], a[body.coordinate]);
        let motion = match body.joint {
            Joint::Revolute => parent.behind_revolute(frame, rate, joint),
            Joint::Prismatic => parent.behind_prismatic(frame, rate, joint),
        };
        motion.name(trace, index);
        wrenches.push(motion.wrench(&frame.own_inertia(body.inertia), Shape::new(&body.inertia, frame)));
        motions.push(motion);
    });
    let mut tau = vec![S::zero(); tree.dof()];
    trace.sweep("inward", tree.inward(), |index| {
        let body = &tree.bodies[index];
        let (mut force, mut moment) = wrenches[index];
        // Taken from the children, not handed to the parent: so the sum for one body is one sum.
        for child in tree.children(index) {
            let load = frames[child].wrench_to_parent(wrenches[child].0, wrenches[child].1);
            (force, moment) = (force + load.0, moment + load.1);
        }
        trace.name_vector(force, "force", index);
        trace.name_vector(moment, "moment", index);
        wrenches[index] = (force, moment);
        tau[body.coordinate] = along_joint(body.joint, force, moment);
        trace.name(tau[body.coordinate], "tau", index, "");
    });
    tau
}

/// C(q, v) v + g(q): the joint forces at zero acceleration.
pub fn bias_forces<S: Scalar>(tree: &Tree, trace: &impl Trace<S>, q: &[S], v: &[S]) -> Vec<S> {
    inverse_dynamics(tree, trace, q, v, &vec![S::zero(); tree.dof()])
}

/// g(q): the joint forces at rest.
pub fn gravity_forces<S: Scalar>(tree: &Tree, trace: &impl Trace<S>, q: &[S]) -> Vec<S> {
    bias_forces(tree, trace, q, &vec![S::zero(); tree.dof()])
}
