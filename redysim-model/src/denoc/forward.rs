//! Forward dynamics: accelerations from joint forces, in two ways.

use super::articulated::ArticulatedInertia;
use super::factorisation::Factorisation;
use super::frame::{JointFrame, joint_frames_in};
use super::inverse::bias_forces;
use super::mass_matrix::mass_matrix;
use super::mimic::articulated_bodies;
use super::trace::Trace;
use super::workspace::{BiasAcceleration, Pivot, Workspace};
use crate::inertia::RigidInertia;
use crate::joint::Screw;
use crate::parameter::ParameterIn;
use crate::spatial::{Twist, Vec3, Wrench};
use crate::tree::{Body, Tree};
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
    tree: &Tree<impl ParameterIn<S>>,
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
    tree: &Tree<impl ParameterIn<S>>,
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
    articulated_bodies(work, tree, trace, (q, v, tau), |_| false, (result, &mut []));
}

/// What makes the bodies of a recursion over articulated bodies move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Loads {
    /// The given joint forces and accelerations, gravity, velocities, and what acts without an actuator.
    All,
    /// What is given alone. All velocities are zero.
    Given,
}

/// The recursion over articulated bodies, for all joints. Of a velocity for which `drives` holds, `given` has the
/// acceleration, and the joint force is written to `forces`; of each other, `given` has the force. All accelerations are
/// written to `result`.
pub(super) fn articulated_bodies_of_all<S: Scalar, P: ParameterIn<S>>(
    work: &mut Workspace<S>,
    tree: &Tree<P>,
    trace: &impl Trace<S>,
    loads: Loads,
    (q, v, given): (&[S], &[S], &[S]),
    drives: impl Fn(usize) -> bool,
    (result, forces): (&mut [S], &mut [S]),
) {
    let Workspace { positions, frames, biases, inertias, wrenches, pivots, accelerations, springs, .. } = work;
    joint_frames_in(positions, frames, tree, trace, q);
    let of_springs = match loads {
        Loads::All => springs.forces(tree, frames, v),
        Loads::Given => &mut [],
    };
    let physics_of = |body: &Body<P>| body.physics.filter(|_| loads == Loads::All);
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
        let armature: Option<S> = body.physics.and_then(|physics| physics.armature());
        let free = || body.v.clone().zip(body.joint.screws()).filter(|(velocity, _)| !drives(*velocity));
        let force = |velocity: usize| {
            let passive: Option<S> =
                physics_of(body).and_then(|physics| physics.passive_force(q[body.q.start], v[velocity]));
            passive.map_or(tau[velocity], |passive| tau[velocity] - passive)
        };
        // One freedom after the other: each meets the body with those before it free.
        for (velocity, screw) in free() {
            let component = body.joint.component(velocity - body.v.start);
            let column = felt.column(screw);
            let pivot = screw.project(column);
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
            if armature.is_none() {
                wrench = free().fold(wrench, |wrench, (velocity, screw)| screw.with_force(wrench, force(velocity)));
            }
            wrenches[parent] = wrenches[parent] + frame.wrench_to_parent(wrench);
            inertias[parent] = inertias[parent].plus(felt.to_parent(frame));
        }
    });

    let gravity = match loads {
        Loads::All => tree.gravity.map(ParameterIn::value),
        Loads::Given => Vec3::zero(),
    };
    let ground = Twist { angular: Vec3::zero(), linear: -gravity };
    accelerations.clear();
    accelerations.reserve(tree.bodies.len());
    trace.sweep("accelerations", tree.outward(), |index| {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
        let parent = body.parent.map_or(ground, |parent| accelerations[parent]);
        let mut acceleration = Twist {
            angular: frame.to_body(parent.angular),
            linear: frame.to_body(parent.linear + parent.angular.cross(frame.position)),
        } + biases[index].acceleration;
        let has_rotor = body.physics.is_some_and(|physics| physics.armature::<S>().is_some());
        for (velocity, screw) in body.v.clone().zip(body.joint.screws()).rev() {
            if drives(velocity) {
                result[velocity] = given[velocity];
                continue;
            }
            let Pivot { inverse, ratio, drive } = &pivots[velocity];
            let qdd = *inverse * *drive - power(screw, *ratio, acceleration, has_rotor);
            acceleration = screw.added(acceleration, qdd);
            trace.name(qdd, "acc", index, body.joint.component(velocity - body.v.start));
            result[velocity] = qdd;
        }
        if body.v.clone().any(|velocity| !drives(velocity)) {
            trace.name_twist(acceleration, ["dw", "acc"], index);
        }
        if body.v.clone().any(&drives) {
            let wrench = inertias[index].apply(acceleration) + wrenches[index];
            for (velocity, screw) in body.v.clone().zip(body.joint.screws()).filter(|(velocity, _)| drives(*velocity)) {
                let mut force = screw.project(wrench);
                let in_joint =
                    physics_of(body).and_then(|physics| physics.force(q[body.q.start], v[velocity], given[velocity]));
                for part in in_joint.into_iter().chain(of_springs.get(velocity).copied()) {
                    force += part;
                }
                forces[velocity] = force;
            }
        }
        accelerations.push(acceleration);
    });
}

/// `ratio` · `acceleration`. Without a rotor Sᵀ `ratio` is one: where S is an axis of six, that component is not
/// multiplied.
fn power<S: Scalar>(screw: Screw, mut ratio: Wrench<S>, acceleration: Twist<S>, has_rotor: bool) -> S {
    match screw.unit_axis() {
        Some(axis) if !has_rotor => {
            *ratio.component_mut(axis) = S::zero();
            ratio.dot(acceleration) + acceleration.component(axis)
        }
        _ => ratio.dot(acceleration),
    }
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
        let centripetal = frame.to_body(parent.cross(parent.cross(frame.position)));
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
    Wrench { moment: w.cross(tensor.full() * w), force: w.cross(w.cross(moment)) }
}
