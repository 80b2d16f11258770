//! Forward dynamics: accelerations from joint forces, in two ways.

use super::articulated::ArticulatedInertia;
use super::factorisation::{EliminationOrder, Factorisation};
use super::frame::{JointFrame, joint_frames_in};
use super::inverse::reference_motion;
use super::mass_matrix::mass_matrix;
use super::mimic::articulated_bodies;
use super::trace::Trace;
use super::workspace::{BiasAcceleration, Pivot, Workspace};
use crate::inertia::RigidInertia;
use crate::parameter::ParameterIn;
use crate::spatial::{Twist, Vec3, Wrench};
use crate::tree::{Body, Tree};
use redysim_runtime::Scalar;
use std::cell::LazyCell;

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
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
) -> Vec<S> {
    match method {
        Method::Factorisation => {
            forward_dynamics_by_factorisation(EliminationOrder::TipsFirst, [tree; 2], trace, q, v, tau)
        }
        Method::Recursion => forward_dynamics_by_recursion(tree, trace, q, v, tau),
    }
}

/// Accelerations from the explicit mass matrix: M = U D Uᵀ, then three substitutions.
///
/// The first tree is that for forces, the second that for the mass matrix: two descriptions of the same robot.
pub fn forward_dynamics_by_factorisation<S: Scalar, P: ParameterIn<S>>(
    order: EliminationOrder,
    [for_forces, for_matrix]: [&Tree<P>; 2],
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
) -> Vec<S> {
    let (reference, forces) = reference_motion(for_forces, trace, q, v);
    let drive: Vec<S> = tau.iter().zip(forces).map(|(&tau, force)| tau - force).collect();
    let matrix = mass_matrix(for_matrix, trace, q);
    let found = Factorisation::of_joints(order, for_matrix, trace, &matrix, |_| true).solve(&drive);
    reference.into_iter().zip(found).map(|(reference, found)| reference + found).collect()
}

/// Accelerations by recursion: inertias and bias wrenches inwards, accelerations outwards.
///
/// The same elimination, M = U D Uᵀ, without the matrix: the pivot D of a freedom is what its body and all it carries,
/// on free joints, set against it; the freedoms of one joint are eliminated one after the other. The bias is carried along as a wrench instead of being summed up as joint forces
/// first, since their roundoff would be multiplied by the condition of M.
pub fn forward_dynamics_by_recursion<S: Scalar>(
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
) -> Vec<S> {
    let mut result = vec![S::zero(); tree.nv()];
    forward_dynamics_in(&mut Workspace::default(), tree, trace, q, v, tau, &mut result);
    result
}

/// [`forward_dynamics_by_recursion`] with the buffers of `work`, written to `result`.
pub fn forward_dynamics_in<S: Scalar>(
    work: &mut Workspace<S>,
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
    tau: &[S],
    result: &mut [S],
) {
    articulated_bodies(work, tree, trace, (q, v, tau), &|_| false, (result, &mut []));
}

/// What makes the bodies of a recursion over articulated bodies move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Loads {
    /// The given joint forces and accelerations, gravity, velocities, and what acts without an actuator.
    All,
    /// What is given alone, which the inertia of rotors resists as well. All velocities are zero.
    Given,
}

/// The recursion over articulated bodies, for all joints. Of a velocity for which `drives` holds, `given` has the
/// acceleration, and the joint force is written to `forces`; of each other, `given` has the force. All accelerations are
/// written to `result`.
pub(super) fn articulated_bodies_of_all<'t, S: Scalar, P: ParameterIn<S>>(
    work: &mut Workspace<S>,
    tree: &'t Tree<P>,
    trace: &impl Trace<S>,
    loads: Loads,
    (q, v, given): (&[S], &[S], &[S]),
    drives: &dyn Fn(usize) -> bool,
    (result, forces): (&mut [S], &mut [S]),
) {
    let Workspace { positions, frames, biases, inertias, wrenches, pivots, accelerations, springs, .. } = work;
    joint_frames_in(positions, frames, tree, trace, q);
    let of_springs = match loads {
        Loads::All => springs.forces(tree, frames, v),
        Loads::Given => &mut [],
    };
    let physics_of = |body: &'t Body<P>| body.physics.as_ref().filter(|_| loads == Loads::All);
    bias_accelerations(biases, tree, trace, frames, v);
    for (index, body) in tree.bodies.iter().enumerate() {
        for (velocity, screw) in body.v.clone().zip(body.joint.screws()) {
            if drives(velocity) {
                biases[index].acceleration = screw.added(biases[index].acceleration, given[velocity]);
            } else if !of_springs.is_empty() {
                of_springs[velocity] = given[velocity] - of_springs[velocity];
            }
        }
    }
    let of_springs: &[S] = of_springs;
    let tau = if of_springs.is_empty() { given } else { of_springs };
    let rigid = |(body, frame): (&Body<P>, &JointFrame<S>)| {
        ArticulatedInertia::rigid(frame.own_inertia(body.inertia).to_rigid())
    };
    inertias.clear();
    inertias.extend(tree.bodies.iter().zip(frames.iter()).map(rigid));
    wrenches.clear();
    wrenches.resize(tree.bodies.len(), Wrench::zero());
    pivots.clear();
    pivots.resize(tree.nv_of_all(), Pivot::default());
    trace.sweep("inward", tree.inward(), |index| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
        let mut felt = inertias[index];
        felt.name(trace, index);
        let own = frame.own_inertia(body.inertia).to_rigid();
        let mut reaction = Wrench::zero();
        let bias = wrenches[index] + centrifugal_wrench(own, biases[index].angular);
        trace.name_wrench(bias, ["bias_n", "bias_f"], index);
        wrenches[index] = bias;
        let armature = |velocity: usize| armature_of::<S, P>(body, velocity);
        let free = || body.v.clone().zip(body.joint.screws()).filter(|(velocity, _)| !drives(*velocity));
        let passive = LazyCell::new(|| {
            physics_of(body).map(|physics| physics.passive_forces(body.joint, &q[body.q.clone()], &v[body.v.clone()]))
        });
        let force = |velocity: usize| {
            let passive = passive.as_ref().and_then(|forces| forces[velocity - body.v.start]);
            passive.map_or(tau[velocity], |passive| tau[velocity] - passive)
        };
        // One freedom after the other: each meets the body with those before it free.
        for (velocity, screw) in free() {
            let component = body.joint.component(velocity - body.v.start);
            let column = felt.column(screw);
            let pivot = screw.project(column);
            let armature = armature(velocity);
            let inverse = S::one() / armature.map_or(pivot, |armature| pivot + armature);
            trace.name(inverse, "inv_D", index, component);
            let ratio = column.scale(inverse);
            trace.name_wrench(ratio, ["ratio_n", "ratio_f"], index);
            let drive = force(velocity) - screw.project(bias) - screw.project(reaction);
            trace.name(drive, "drive", index, component);
            pivots[velocity] = Pivot { inverse, ratio, drive };
            if body.parent.is_none() && free().next_back().is_some_and(|(last, _)| last == velocity) {
                return;
            }
            // The part of the pivot that the rotor has, which the parent meets through the joint as well.
            let rotor_share = armature.map(|armature| armature * inverse);
            felt = felt.project_through_joint(screw, column, ratio, rotor_share);
            reaction = reaction + ratio.scale(drive);
        }
        if let Some(parent) = body.parent {
            let mut wrench = bias + felt.apply(biases[index].acceleration) + reaction;
            // What the joint transmits along S is its force, less what accelerates the rotor.
            for (velocity, screw) in free().filter(|(velocity, _)| armature(*velocity).is_none()) {
                wrench = screw.with_force(wrench, force(velocity));
            }
            wrenches[parent] = wrenches[parent] + frame.wrench_to_parent(wrench);
            inertias[parent] = inertias[parent].plus(felt.to_parent(frame));
        }
    });

    accelerations.clear();
    accelerations.reserve(tree.bodies.len());
    trace.sweep("accelerations", tree.outward(), |index| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
        let carried = match body.parent.map(|parent| accelerations[parent]) {
            Some(parent) => frame.twist_to_body(parent),
            None if loads == Loads::All => {
                Twist { linear: frame.rotation.ground_to_body(-tree.gravity), ..Twist::zero() }
            }
            None => Twist::zero(),
        };
        let mut acceleration = carried + biases[index].acceleration;
        for (velocity, screw) in body.v.clone().zip(body.joint.screws()).rev() {
            if drives(velocity) {
                result[velocity] = given[velocity];
                continue;
            }
            let Pivot { inverse, ratio, drive } = &pivots[velocity];
            let has_rotor = armature_of::<S, P>(body, velocity).is_some();
            let qdd = match screw.unit_axis() {
                Some(axis) if !has_rotor => {
                    // Sᵀ `ratio` is one, so the body's acceleration along S is known before the joint's.
                    let carried = acceleration.component(axis);
                    let along = *inverse * *drive - ratio.dot(acceleration.with_component(axis, S::zero()));
                    acceleration = acceleration.with_component(axis, along);
                    along - carried
                }
                _ => {
                    let qdd = *inverse * *drive - ratio.dot(acceleration);
                    acceleration = screw.added(acceleration, qdd);
                    qdd
                }
            };
            trace.name(qdd, "acc", index, body.joint.component(velocity - body.v.start));
            result[velocity] = qdd;
        }
        if body.v.clone().any(|velocity| !drives(velocity)) {
            trace.name_twist(acceleration, ["dw", "acc"], index);
        }
        if body.v.clone().any(drives) {
            let wrench = inertias[index].apply(acceleration) + wrenches[index];
            let [q, v, given] = [&q[body.q.clone()], &v[body.v.clone()], &given[body.v.clone()]];
            let in_joint = body.physics.as_ref().map(|physics| match loads {
                Loads::All => physics.forces(body.joint, q, v, given),
                Loads::Given => physics.rotor_forces(given),
            });
            for (velocity, screw) in body.v.clone().zip(body.joint.screws()).filter(|(velocity, _)| drives(*velocity)) {
                let mut force = screw.project(wrench);
                let in_joint = in_joint.and_then(|forces| forces[velocity - body.v.start]);
                for part in in_joint.into_iter().chain(of_springs.get(velocity).copied()) {
                    force += part;
                }
                forces[velocity] = force;
            }
        }
        accelerations.push(acceleration);
    });
}

/// The armature of a velocity, numbered among all joints.
fn armature_of<S: Scalar, P: ParameterIn<S>>(body: &Body<P>, velocity: usize) -> Option<S> {
    body.physics.as_ref().and_then(|physics| physics.armature(velocity - body.v.start))
}

fn bias_accelerations<S: Scalar>(
    biases: &mut Vec<BiasAcceleration<S>>,
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    frames: &[JointFrame<S>],
    v: &[S],
) {
    biases.clear();
    biases.reserve(tree.bodies.len());
    trace.sweep("velocities", tree.outward(), |index| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
        let v = &v[body.v.clone()];
        let parent = body.parent.map_or(Vec3::zero(), |parent| biases[parent].angular);
        let centripetal = frame.to_body(parent.fused_cross(parent.fused_cross(frame.position)));
        let carried = frame.to_body(parent);
        let across = body.joint.bias(carried, v);
        let acceleration = Twist { angular: across.angular, linear: centripetal + across.linear };
        let Twist { angular, .. } = body.joint.added(Twist { angular: carried, linear: Vec3::zero() }, v);
        trace.name_vector(angular, "w", index);
        trace.name_twist(acceleration, ["drift_n", "drift_f"], index);
        biases.push(BiasAcceleration { angular, acceleration });
    });
}

/// The wrench (ω × J ω, ω × (ω × h)) of a body that turns without acceleration.
fn centrifugal_wrench<S: Scalar>(inertia: RigidInertia<S>, w: Vec3<S>) -> Wrench<S> {
    let RigidInertia { moment, tensor, .. } = inertia;
    Wrench { moment: w.fused_cross(tensor.full().fused_product(w)), force: w.fused_cross(w.fused_cross(moment)) }
}
