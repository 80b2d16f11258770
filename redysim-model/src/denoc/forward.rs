//! Forward dynamics: accelerations from joint forces, in two ways.

use super::articulated::{ArticulatedInertia, Spatial};
use super::factorisation::Factorisation;
use super::inverse::bias_forces;
use super::joint::{JointFrame, joint_frames};
use super::mass_matrix::mass_matrix;
use super::trace::Trace;
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
pub fn forward_dynamics<S: Scalar>(
    method: Method,
    tree: &Tree,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
) -> Vec<S> {
    match method {
        Method::Factorisation => forward_dynamics_by_factorisation(tree, trace, q, v, tau),
        Method::Recursion => forward_dynamics_by_recursion(tree, trace, q, v, tau),
    }
}

/// Accelerations from the explicit mass matrix: M = U D Uᵀ, then three substitutions.
pub fn forward_dynamics_by_factorisation<S: Scalar>(
    tree: &Tree,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
) -> Vec<S> {
    let bias = bias_forces(tree, trace, q, v);
    let drive: Vec<S> = tau.iter().zip(bias).map(|(&tau, bias)| tau - bias).collect();
    Factorisation::new(tree, trace, &mass_matrix(tree, trace, q)).solve(&drive)
}

/// Accelerations by recursion: inertias and bias wrenches inwards, accelerations outwards.
///
/// The same elimination, M = U D Uᵀ, without the matrix: the pivot D of a joint is what its body and all it carries,
/// on free joints, set against it. The bias is carried along as a wrench instead of being summed up as joint forces
/// first, since their roundoff would be multiplied by the condition of M.
pub fn forward_dynamics_by_recursion<S: Scalar>(
    tree: &Tree,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
) -> Vec<S> {
    let frames = joint_frames(tree, trace, q);
    let drifts = drifts(tree, trace, &frames, v);
    let mut inertias: Vec<ArticulatedInertia<S>> = tree
        .bodies
        .iter()
        .zip(&frames)
        .map(|(body, frame)| ArticulatedInertia::rigid(frame.own_inertia(body.inertia).to_rigid()))
        .collect();
    let mut biases = vec![Spatial::zero(); tree.bodies.len()];
    let mut pivots: Vec<Pivot<S>> = Vec::with_capacity(tree.bodies.len());
    trace.sweep("inward", tree.inward(), |index| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
        let free = free_axis(body.joint);
        let inertia = inertias[index];
        inertia.name(trace, index);
        let own = frame.own_inertia(body.inertia).to_rigid();
        let bias = biases[index].plus(centrifugal_wrench(own, drifts[index].angular));
        bias.name(trace, "bias_n", "bias_f", index);
        let column = inertia.column(free);
        let inverse = S::one() / column.component(free);
        trace.name(inverse, "inv_D", index, "");
        let ratio = column.scale(inverse);
        ratio.name(trace, "ratio_n", "ratio_f", index);
        let drive = tau[body.coordinate] - bias.component(free);
        trace.name(drive, "drive", index, "");
        if let Some(parent) = body.parent {
            let felt = inertia.felt_through(free, column, ratio);
            let mut wrench = bias.plus(felt.apply(drifts[index].acceleration)).plus(ratio.scale(drive));
            *wrench.component_mut(free) = tau[body.coordinate];
            let (linear, angular) = frame.wrench_to_parent(wrench.linear, wrench.angular);
            biases[parent] = biases[parent].plus(Spatial { angular, linear });
            inertias[parent] = inertias[parent].plus(felt.to_parent(frame));
        }
        pivots.push(Pivot { inverse, ratio, drive });
    });
    pivots.reverse();

    let ground = Spatial { angular: Vec3::zero(), linear: Vec3::constant(-tree.gravity) };
    let mut accelerations: Vec<Spatial<S>> = Vec::with_capacity(tree.bodies.len());
    let mut result = vec![S::zero(); tree.dof()];
    trace.sweep("accelerations", tree.outward(), |index| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
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
        trace.name(joint, "acc", index, "");
        result[body.coordinate] = joint;
        acceleration.name(trace, "dw", "acc", index);
        accelerations.push(acceleration);
    });
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

fn drifts<S: Scalar>(tree: &Tree, trace: &impl Trace<S>, frames: &[JointFrame<S>], v: &[S]) -> Vec<Drift<S>> {
    let mut drifts: Vec<Drift<S>> = Vec::with_capacity(tree.bodies.len());
    trace.sweep("velocities", tree.outward(), |index| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
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
        trace.name_vector(angular, "w", index);
        acceleration.name(trace, "drift_n", "drift_f", index);
        drifts.push(Drift { angular, acceleration });
    });
    drifts
}

/// The wrench (ω × J ω, ω × (ω × h)) of a body that turns without acceleration.
fn centrifugal_wrench<S: Scalar>(inertia: RigidInertia<S>, w: Vec3<S>) -> Spatial<S> {
    let RigidInertia { moment, tensor, .. } = inertia;
    Spatial { angular: w.cross(tensor.full() * w), linear: w.cross(w.cross(moment)) }
}

/// The axis of six along which a joint moves.
fn free_axis(joint: Joint) -> usize {
    match joint {
        Joint::Revolute => 2,
        Joint::Prismatic => 5,
    }
}
