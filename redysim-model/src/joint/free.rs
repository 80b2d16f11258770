//! A joint that leaves its body all six freedoms.
//!
//! Its coordinates are the position of the body's origin in the frame of the joint on the parent, then a quaternion;
//! its velocities are the linear velocity of the origin, then the angular velocity, both in the body's frame.

use super::spherical::{four, least_share, three};
use super::{JointPosition, Screw, quaternion};
use crate::parameter::Parameter;
use crate::pseudo::PseudoInertia;
use crate::spatial::Vec3;
use redysim_runtime::Scalar;

pub const COORDINATE_NAMES: &[&str] = &["x", "y", "z", "qx", "qy", "qz", "qw"];
pub const VELOCITY_NAMES: &[&str] = &["vx", "vy", "vz", "wx", "wy", "wz"];

/// The motion subspace.
pub const SCREWS: [Screw; 6] = [
    Screw::translation(0),
    Screw::translation(1),
    Screw::translation(2),
    Screw::rotation(0),
    Screw::rotation(1),
    Screw::rotation(2),
];

#[inline]
pub fn position<S: Scalar>(q: &[S]) -> JointPosition<S> {
    let (position, orientation) = parts(q);
    JointPosition::InSpace { orientation, displacement: Some(position) }
}

pub fn coordinate_rates<S: Scalar>(q: &[S], v: &[S], rates: &mut [S]) {
    let (_, orientation) = parts(q);
    set(rates, quaternion::rotation(orientation) * three(v), quaternion::rates(orientation, three(&v[3..])));
}

/// The exponential of SE(3).
pub fn integrate<S: Scalar>(q: &[S], dv: &[S], moved: &mut [S]) {
    let ((position, orientation), u, w) = (parts(q), three(dv), three(&dv[3..]));
    let exponential = quaternion::exponential(w);
    let position = position + quaternion::rotation(orientation) * exponential.displacement(w, u);
    set(moved, position, quaternion::turned(orientation, exponential.quaternion));
}

/// The logarithm of SE(3).
pub fn difference<S: Scalar>(q0: &[S], q1: &[S], dv: &mut [S]) {
    let ((from, start), (to, end)) = (parts(q0), parts(q1));
    let logarithm = quaternion::difference(start, end);
    let displacement = quaternion::rotation(start).transpose() * (to - from);
    set(dv, logarithm.velocity(displacement), logarithm.vector.0);
}

pub fn neutral<S: Scalar>(q: &mut [S]) {
    set(q, Vec3::zero(), quaternion::identity());
}

/// Every part of the body's inertia resists some motion of the joint.
pub fn split<P: Parameter>(inertia: PseudoInertia<P>) -> (PseudoInertia<P>, PseudoInertia<P>) {
    (inertia, PseudoInertia::zero())
}

/// The mass, and the inertia tensor about the centre of mass in all directions.
pub fn meets(inertia: PseudoInertia<f64>) -> f64 {
    if inertia.mass <= 0.0 {
        return 0.0;
    }
    let to_center = inertia.moment.scale(-1.0 / inertia.mass);
    least_share(inertia.translated(to_center).to_rigid().tensor)
}

/// The position and the orientation.
fn parts<S: Scalar>(q: &[S]) -> (Vec3<S>, quaternion::Quaternion<S>) {
    (three(q), four(&q[3..]))
}

fn set<S: Scalar, const N: usize>(numbers: &mut [S], linear: Vec3<S>, angular: [S; N]) {
    numbers[..3].copy_from_slice(&linear.0);
    numbers[3..].copy_from_slice(&angular);
}
