//! Inverse dynamics: joint forces from motion, by one recursion outwards and one inwards (recursive Newton-Euler).

use super::frame::{JointFrame, joint_frames_in};
use super::trace::Trace;
use super::workspace::{BodyMotion, Workspace};
use crate::inertia::Sym3;
use crate::joint::{Forces, Joint};
use crate::parameter::ParameterIn;
use crate::pseudo::PseudoInertia;
use crate::spatial::{Mat3, Twist, Vec3, Wrench};
use crate::tree::{Body, Tree};
use redysim_runtime::Scalar;

impl<S: Scalar> BodyMotion<S> {
    #[inline(always)]
    fn new(angular: Vec3<S>, angular_acceleration: Vec3<S>, acceleration: Vec3<S>) -> Self {
        let w = angular;
        let products = Mat3::from_fn(|i, j| {
            if i == j { -(w[(i + 1) % 3] * w[(i + 1) % 3] + w[(i + 2) % 3] * w[(i + 2) % 3]) } else { w[i] * w[j] }
        });
        BodyMotion {
            angular,
            angular_acceleration,
            angular_acceleration_tensor: products + angular_acceleration.skew(),
            acceleration,
        }
    }

    /// What the parent, whose motion this is, carries.
    #[inline(always)]
    fn carried(&self, frame: &JointFrame<S>) -> Carried<S> {
        let acceleration = Twist {
            angular: frame.to_body(self.angular_acceleration),
            linear: frame.to_body(self.acceleration + self.angular_acceleration_tensor * frame.position),
        };
        (frame.to_body(self.angular), acceleration)
    }

    /// The motion of a body that its parent, whose motion this is, carries so, across a joint of velocities `v` and
    /// accelerations `a`.
    #[inline(always)]
    fn across(self, (w, carried): Carried<S>, frame: &JointFrame<S>, joint: Joint, v: &[S], a: &[S]) -> Self {
        let acceleration = joint.added(carried + joint.bias(w, v), a);
        let Twist { angular: w, .. } = joint.added(Twist { angular: w, linear: Vec3::zero() }, v);
        let Some((image, about)) =
            frame.rotation.axis_image(self.angular_acceleration_tensor).zip(joint.screw(0).turn(a[0]))
        else {
            return Self::new(w, acceleration.angular, acceleration.linear);
        };
        // The directions of the axis belong to both bodies, so the third columns of their U are the same vector, and
        // U_xz = ω_x ω_z + ω̇_y, U_yz = ω_y ω_z − ω̇_x give ω̇ without the products of ω and the joint's velocity.
        let angular_acceleration = Vec3([w[1] * w[2] - image[1], image[0] - w[0] * w[2], carried.angular[2] + about]);
        let mut motion = Self::new(w, angular_acceleration, acceleration.linear);
        for i in 0..3 {
            motion.angular_acceleration_tensor.0[i][2] = image[i];
        }
        motion
    }

    fn name(&self, trace: &impl Trace<S>, body: usize) {
        trace.name_vector(self.angular, "w", body);
        trace.name_vector(self.angular_acceleration, "dw", body);
        trace.name_vector(self.acceleration, "acc", body);
    }

    /// Force and moment about the origin that give a body of these moments of mass this motion: f = m a + U h, and n
    /// such that n× = U Σ − (U Σ)ᵀ, plus h × a.
    #[inline(always)]
    fn wrench(&self, inertia: &PseudoInertia<S>, moments: SecondMoments<S>) -> Wrench<S> {
        let PseudoInertia { mass, moment, second: s } = *inertia;
        let force = self.acceleration.scale(mass) + self.angular_acceleration_tensor * moment;
        let (w, u) = (self.angular, self.angular_acceleration_tensor.0);
        // U_jj − U_ii.
        let squares = |i: usize, j: usize| w[j] * w[j] - w[i] * w[i];
        // Σ_jj U_kj − Σ_kk U_jk, for i, j, k in cyclic order: where the two moments are equal, only ω̇ is left of U.
        let across = |i: usize, j: usize, k: usize, first: S, second: S| {
            if moments.equal[i] {
                (first + second) * self.angular_acceleration[i]
            } else if moments.merged_parallel && i == 2 {
                // In axes that do not rotate with the joint, the sum is a constant and the difference is not.
                moments.polar * self.angular_acceleration[i] + (first - second) * (w[j] * w[k])
            } else {
                first * u[k][j] - second * u[j][k]
            }
        };
        let own = Vec3([
            across(0, 1, 2, s.yy, s.zz) + s.xy * u[2][0] - s.xz * u[1][0] + s.yz * squares(1, 2),
            across(1, 2, 0, s.zz, s.xx) + s.yz * u[0][1] - s.xy * u[2][1] + s.xz * squares(2, 0),
            across(2, 0, 1, s.xx, s.yy) + s.xz * u[1][2] - s.yz * u[0][2] + s.xy * squares(0, 1),
        ]);
        Wrench { moment: own + moment.fused_cross(self.acceleration), force }
    }
}

/// The angular velocity and the acceleration of what is fixed to a body's parent, at the body's origin and in its axes.
type Carried<S> = (Vec3<S>, Twist<S>);

/// The accelerations `a` across a joint of velocities `v` at which the body does not accelerate along its freedoms; zero
/// for a freedom that both turns and slides.
fn oppose<S: Scalar>((w, carried): Carried<S>, joint: Joint, v: &[S], a: &mut [S]) {
    let acceleration = carried + joint.bias(w, v);
    for (a, screw) in a.iter_mut().zip(joint.screws()) {
        // One at a time, as in `Joint::project`.
        [*a] = S::apart([screw.unit_axis().map_or(S::zero(), |axis| -acceleration.component(axis))]);
    }
}

/// What is known of a body's moments of mass before run time.
#[derive(Clone, Copy)]
struct SecondMoments<S> {
    /// Σ_xx + Σ_yy.
    polar: S,
    /// Whether the two second moments across each axis are equal.
    equal: [bool; 3],
    /// Whether the body rotates against its axes.
    merged_parallel: bool,
}

impl<S: Scalar> SecondMoments<S> {
    #[inline(always)]
    fn new<P: ParameterIn<S>>(inertia: &PseudoInertia<P>, frame: &JointFrame<S>) -> Self {
        let Sym3 { xx, yy, zz, xy, .. } = inertia.second;
        let merged_parallel = frame.merged_parallel();
        let equal = |a: P, b: P| a.number().is_some() && a.number() == b.number();
        let round = equal(xx, yy) && (xy.number() == Some(0.0) || !merged_parallel);
        SecondMoments {
            equal: [equal(yy, zz) && !merged_parallel, equal(zz, xx) && !merged_parallel, round],
            merged_parallel,
            polar: xx.value() + yy.value(),
        }
    }
}

/// τ = M(q) a + C(q, v) v + g(q): the joint forces for accelerations `a` at coordinates `q` and velocities `v`.
pub fn inverse_dynamics<S: Scalar>(
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
    a: &[S],
) -> Vec<S> {
    let mut tau = vec![S::zero(); tree.nv()];
    inverse_dynamics_in(&mut Workspace::default(), tree, trace, q, v, a, &mut tau);
    tau
}

/// [`inverse_dynamics`] with the buffers of `work`, written to `tau`.
pub fn inverse_dynamics_in<S: Scalar>(
    work: &mut Workspace<S>,
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
    a: &[S],
    tau: &mut [S],
) {
    if tree.mimics.is_empty() {
        return inverse_dynamics_of_all_in(work, tree, trace, q, v, Accelerations::Given(a), tau);
    }
    let mut all = std::mem::take(&mut work.all_joints);
    all.take_coordinates(tree, q);
    all.take_rates(tree, v, a);
    all.tau.clear();
    all.tau.resize(tree.nv_of_all(), S::zero());
    inverse_dynamics_of_all_in(work, tree, trace, &all.q, &all.v, Accelerations::Given(&all.a), &mut all.tau);
    tree.fold_mimics(&mut all.tau);
    tau.copy_from_slice(&all.tau[..tree.nv()]);
    work.all_joints = all;
}

/// The accelerations of all joints.
enum Accelerations<'a, S> {
    Given(&'a [S]),
    /// Those at which no body accelerates along a freedom of its own joint. They are written here.
    Opposing(&'a mut [S]),
}

impl<S> Accelerations<'_, S> {
    fn values(&self) -> &[S] {
        match self {
            Accelerations::Given(a) => a,
            Accelerations::Opposing(a) => a,
        }
    }
}

/// The forces of all joints, with what acts in them and the springs, written to `tau`.
fn inverse_dynamics_of_all_in<S: Scalar>(
    work: &mut Workspace<S>,
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
    a: Accelerations<S>,
    tau: &mut [S],
) {
    newton_euler_in(work, tree, trace, q, v, a, tau, |body, a| {
        let [q, v, a] = [&q[body.q.clone()], &v[body.v.clone()], &a[body.v.clone()]];
        body.physics.as_ref().map(|physics| physics.forces(body.joint, q, v, a))
    });
    for (tau, force) in tau.iter_mut().zip(work.springs.forces(tree, &work.frames, v)) {
        *tau += *force;
    }
}

/// The forces of all joints for the bodies' motion, with what acts in each joint itself, written to `tau`.
#[allow(clippy::too_many_arguments, reason = "the arguments of `inverse_dynamics_in` and one more")]
fn newton_euler_in<S: Scalar, P: ParameterIn<S>>(
    work: &mut Workspace<S>,
    tree: &Tree<P>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
    mut a: Accelerations<S>,
    tau: &mut [S],
    in_joint: impl Fn(&Body<P>, &[S]) -> Option<Forces<S>>,
) {
    let Workspace { positions, frames, children, motions, wrenches, .. } = work;
    joint_frames_in(positions, frames, tree, trace, q);
    children.find(tree);
    let still = BodyMotion::new(Vec3::zero(), Vec3::zero(), Vec3::zero());
    motions.clear();
    motions.reserve(tree.bodies.len());
    wrenches.clear();
    wrenches.reserve(tree.bodies.len());
    trace.sweep("outward", tree.outward(), |index| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
        let parent = body.parent.map_or(still, |parent| motions[parent]);
        let carried = match body.parent {
            Some(_) => parent.carried(frame),
            None => {
                (Vec3::zero(), Twist { angular: Vec3::zero(), linear: frame.rotation.ground_to_body(-tree.gravity) })
            }
        };
        let v = &v[body.v.clone()];
        if let Accelerations::Opposing(a) = &mut a {
            oppose(carried, body.joint, v, &mut a[body.v.clone()]);
        }
        let motion = parent.across(carried, frame, body.joint, v, &a.values()[body.v.clone()]);
        motion.name(trace, index);
        wrenches.push(motion.wrench(&frame.own_inertia(body.inertia), SecondMoments::new(&body.inertia, frame)));
        motions.push(motion);
    });
    trace.sweep("inward", tree.inward(), |index| {
        let body = &tree.bodies[index];
        // Taken from the children, not handed to the parent: so the sum for one body is one sum.
        let loads = children.of(index).map(|child| frames[child].wrench_to_parent(wrenches[child]));
        let wrench = loads.fold(wrenches[index], |sum, load| sum + load);
        trace.name_wrench(wrench, ["moment", "force"], index);
        wrenches[index] = wrench;
        body.joint.project(wrench, &mut tau[body.v.clone()]);
        if let Some(forces) = in_joint(body, a.values()) {
            for (tau, force) in tau[body.v.clone()].iter_mut().zip(&forces) {
                if let Some(force) = *force {
                    // One at a time, as in `project`.
                    [*tau] = S::apart([*tau + force]);
                }
            }
        }
        for (i, &tau) in tau[body.v.clone()].iter().enumerate() {
            trace.name(tau, "tau", index, body.joint.component(i));
        }
    });
}

/// C(q, v) v + g(q) and the passive forces: the joint forces at zero acceleration.
pub fn bias_forces<S: Scalar>(tree: &Tree<impl ParameterIn<S>>, trace: &impl Trace<S>, q: &[S], v: &[S]) -> Vec<S> {
    inverse_dynamics(tree, trace, q, v, &vec![S::zero(); tree.nv()])
}

/// Accelerations a₀ and the joint forces τ₀ = M a₀ + C v + g that they take, for M (a − a₀) = τ − τ₀.
///
/// Any a₀ would do. At this one no body accelerates along a freedom of its own joint, so that many terms of τ₀ vanish: a
/// body on a revolute joint has no angular acceleration about its axis, and a free base no acceleration at all, so that
/// τ₀ of a robot that floats is without gravity. With joints that mimic others, a₀ is zero.
pub(super) fn reference_motion<S: Scalar>(
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
) -> (Vec<S>, Vec<S>) {
    let mut a = vec![S::zero(); tree.nv()];
    if !tree.mimics.is_empty() {
        return (a, bias_forces(tree, trace, q, v));
    }
    let mut tau = a.clone();
    let opposing = Accelerations::Opposing(&mut a);
    inverse_dynamics_of_all_in(&mut Workspace::default(), tree, trace, q, v, opposing, &mut tau);
    (a, tau)
}

/// g(q): the joint forces of gravity alone, at rest.
pub fn gravity_forces<S: Scalar>(tree: &Tree<impl ParameterIn<S>>, trace: &impl Trace<S>, q: &[S]) -> Vec<S> {
    let rest = vec![S::zero(); tree.nv_of_all()];
    let mut tau = rest.clone();
    let q = &tree.all_coordinates(q);
    let a = Accelerations::Given(&rest);
    newton_euler_in(&mut Workspace::default(), tree, trace, q, &rest, a, &mut tau, |_, _| None);
    tree.folded(tau)
}
