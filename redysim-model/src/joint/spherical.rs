//! A joint that turns its body about any axis through the joint's origin.
//!
//! Its coordinates are a quaternion, its velocities the angular velocity in the body's frame.

use super::{JointPosition, Screw, quaternion};
use crate::inertia::Sym3;
use crate::parameter::Parameter;
use crate::pseudo::PseudoInertia;
use crate::spatial::Vec3;
use redysim_runtime::Scalar;

pub const COORDINATE_NAMES: &[&str] = &["qx", "qy", "qz", "qw"];
pub const VELOCITY_NAMES: &[&str] = &["wx", "wy", "wz"];

/// The motion subspace.
pub const SCREWS: [Screw; 3] = [Screw::rotation(0), Screw::rotation(1), Screw::rotation(2)];

#[inline]
pub fn position<S: Scalar>(q: &[S]) -> JointPosition<S> {
    JointPosition::InSpace { orientation: four(q), displacement: None }
}

pub fn coordinate_rates<S: Scalar>(q: &[S], v: &[S], rates: &mut [S]) {
    rates.copy_from_slice(&quaternion::rates(four(q), three(v)));
}

pub fn integrate<S: Scalar>(q: &[S], dv: &[S], moved: &mut [S]) {
    moved.copy_from_slice(&quaternion::turned(four(q), quaternion::exponential(three(dv)).quaternion));
}

pub fn difference<S: Scalar>(q0: &[S], q1: &[S], dv: &mut [S]) {
    dv.copy_from_slice(&quaternion::difference(four(q0), four(q1)).vector.0);
}

pub fn neutral<S: Scalar>(q: &mut [S]) {
    q.copy_from_slice(&quaternion::identity());
}

/// Mass at the joint's origin belongs to both bodies.
pub fn split<P: Parameter>(inertia: PseudoInertia<P>) -> (PseudoInertia<P>, PseudoInertia<P>) {
    let shared = PseudoInertia { mass: inertia.mass, ..PseudoInertia::zero() };
    (PseudoInertia { mass: P::zero(), ..inertia }, shared)
}

/// The inertia tensor about the origin, in all directions.
pub fn meets(inertia: PseudoInertia<f64>) -> f64 {
    least_share(inertia.to_rigid().tensor)
}

/// The least principal moment of a tensor as a share of their sum.
pub(super) fn least_share(tensor: Sym3<f64>) -> f64 {
    let moments = tensor.eigenvalues();
    let sum: f64 = moments.iter().sum();
    if sum > 0.0 { moments[0] / sum } else { 0.0 }
}

/// The first three numbers of a slice.
pub(super) fn three<S: Copy>(numbers: &[S]) -> Vec3<S> {
    Vec3([numbers[0], numbers[1], numbers[2]])
}

/// The first four numbers of a slice.
pub(super) fn four<S: Copy>(numbers: &[S]) -> [S; 4] {
    [numbers[0], numbers[1], numbers[2], numbers[3]]
}
