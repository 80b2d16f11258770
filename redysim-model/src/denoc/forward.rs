//! Forward dynamics: accelerations from joint forces, in two ways.

use super::articulated::{ArticulatedInertia, Spatial};
use super::factorisation::Factorisation;
use super::inverse::bias_forces;
use super::joint::{JointFrame, joint_frames};
use super::mass_matrix::mass_matrix;
use crate::inertia::RigidInertia;
use crate::spatial::Vec3;
use crate::tree::{Joint, Tree};
use redysim_runtime::Scalar;

/// How accelerations are computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The mass matrix, factorised as U D Uᵀ: fewer operations for a few joints, O(n³) for a chain of n.
    Factorisation,
    /// The O(n) recursion, which never forms the matrix: fewer operations for many joints, and accurate where the
    /// matrix is ill-conditioned.
    Recursion,
}

/// M(q)⁻¹ (τ − C(q, v) v − g(q)) by the given method.
pub fn forward_dynamics<S: Scalar>(method: Method, tree: &Tree, q: &[S], v: &[S], tau: &[S]) -> Vec<S> {
    match method {
        Method::Factorisation => forward_dynamics_by_factorisation(tree, q, v, tau),
        Method::Recursion => forward_dynamics_by_recursion(tree, q, v, tau),
    }
}

/// Accelerations from the explicit mass matrix: M = U D Uᵀ, then three substitutions.
pub fn forward_dynamics_by_factorisation<S: Scalar>(tree: &Tree, q: &[S], v: &[S], tau: &[S]) -> Vec<S> {
    let bias = bias_forces(tree, q, v);
    let drive: Vec<S> = tau.iter().zip(bias).map(|(&tau, bias)| tau - bias).collect();
    Factorisation::new(tree, &mass_matrix(tree, q)).solve(&drive)
}

/// Accelerations by recursion: inertias and bias wrenches inwards, accelerations outwards.
///
/// The same elimination, M = U D Uᵀ, without the matrix: the pivot D of a joint is what its body and all it carries,
/// on free joints, set against it. The bias is carried along as a wrench instead of being summed up as joint forces
/// first, since their roundoff would be multiplied by the condition of M.
pub fn forward_dynamics_by_recursion<S: Scalar>(tree: &Tree, q: &[S], v: &[S], tau: &[S]) -> Vec<S> {
    let frames = joint_frames(tree, q);
    let drifts = drifts(tree, &frames, q, v);
    let mut inertias: Vec<ArticulatedInertia<S>> =
        tree.bodies.iter().map(|body| ArticulatedInertia::rigid(&body.inertia)).collect();
    let mut biases = vec![Spatial::zero(); tree.bodies.len()];
    let mut pivots: Vec<Pivot<S>> = Vec::with_capacity(tree.bodies.len());
    for (index, (body, frame)) in tree.bodies.iter().zip(&frames).enumerate().rev() {
        q[body.coordinate].step("inward", index);
        let free = free_axis(body.joint);
        let inertia = inertias[index].named(index);
        let bias = biases[index].plus(centrifugal_wrench(&body.inertia, drifts[index].angular));
        let bias = bias.named("bias_n", "bias_f", index);
        let column = inertia.column(free);
        let inverse = (S::one() / column.component(free)).named("inv_D", index, "");
        let ratio = column.scale(inverse).named("ratio_n", "ratio_f", index);
        let drive = (tau[body.coordinate] - bias.component(free)).named("drive", index, "");
        if let Some(parent) = body.parent {
            let felt = inertia.felt_through(free, column, ratio);
            let mut wrench = bias.plus(felt.apply(drifts[index].acceleration)).plus(ratio.scale(drive));
            *wrench.component_mut(free) = tau[body.coordinate];
            let (linear, angular) = frame.wrench_to_parent(wrench.linear, wrench.angular);
            biases[parent] = biases[parent].plus(Spatial { angular, linear });
            inertias[parent] = inertias[parent].plus(felt.to_parent(frame));
        }
        pivots.push(Pivot { inverse, ratio, drive });
    }
    pivots.reverse();

    let ground = Spatial { angular: Vec3::zero(), linear: Vec3::constant(-tree.gravity) };
    let mut accelerations: Vec<Spatial<S>> = Vec::with_capacity(tree.bodies.len());
    let mut result = vec![S::zero(); tree.dof()];
    for (index, (body, frame)) in tree.bodies.iter().zip(&frames).enumerate() {
        q[body.coordinate].step("accelerations", index);
        let parent = body.parent.map_or(ground, |parent| accelerations[parent]);
        let mut acceleration = Spatial {
            angular: frame.to_body(parent.angular),
            linear: frame.to_body(parent.linear + parent.angular.cross(frame.position)),
        }
        .plus(drifts[index].acceleration);
        let free = free_axis(body.joint);
        let Pivot { inverse, mut ratio, drive } = pivots[index];
        // The ratio's own component is one; the acceleration along the joint is what is still to be found.
        let carried = acceleration.component(free);
        *ratio.component_mut(free) = S::zero();
        let joint = inverse * drive - (ratio.dot(acceleration) + carried);
        *acceleration.component_mut(free) += joint;
        result[body.coordinate] = joint.named("acc", index, "");
        accelerations.push(acceleration.named("dw", "acc", index));
    }
    result
}

/// One step of the elimination: 1/D, U/D and the force left to accelerate the joint.
struct Pivot<S> {
    inverse: S,
    ratio: Spatial<S>,
    drive: S,
}

/// What velocities alone do to a body.
struct Drift<S> {
    /// Angular velocity ω, in the body's frame.
    angular: Vec3<S>,
    /// Acceleration against the parent at zero joint acceleration.
    acceleration: Spatial<S>,
}

fn drifts<S: Scalar>(tree: &Tree, frames: &[JointFrame<S>], q: &[S], v: &[S]) -> Vec<Drift<S>> {
    let mut drifts: Vec<Drift<S>> = Vec::with_capacity(tree.bodies.len());
    for (index, (body, frame)) in tree.bodies.iter().zip(frames).enumerate() {
        q[body.coordinate].step("velocities", index);
        let rate = v[body.coordinate];
        let parent = body.parent.map_or(Vec3::zero(), |parent| drifts[parent].angular);
        let mut acceleration = Spatial::zero();
        acceleration.linear = frame.to_body(parent.cross(parent.cross(frame.position)));
        let mut angular = frame.to_body(parent);
        let [x, y, _] = angular.0;
        match body.joint {
            Joint::Revolute => {
                acceleration.angular = Vec3([y * rate, -(x * rate), S::zero()]);
                angular[2] += rate;
            }
            Joint::Prismatic => {
                let twice = rate + rate;
                acceleration.linear = acceleration.linear + Vec3([y * twice, -(x * twice), S::zero()]);
            }
        }
        let angular = angular.named("w", index);
        drifts.push(Drift { angular, acceleration: acceleration.named("drift_n", "drift_f", index) });
    }
    drifts
}

/// The wrench (ω × J ω, ω × (ω × h)) of a body that turns without acceleration.
fn centrifugal_wrench<S: Scalar>(inertia: &RigidInertia<f64>, w: Vec3<S>) -> Spatial<S> {
    let RigidInertia { moment, tensor, .. } = RigidInertia::constant(*inertia);
    Spatial { angular: w.cross(tensor.full() * w), linear: w.cross(w.cross(moment)) }
}

/// The axis of six along which a joint moves.
fn free_axis(joint: Joint) -> usize {
    match joint {
        Joint::Revolute => 2,
        Joint::Prismatic => 5,
    }
}
