//! Coordinates that are lengths or angles of their own: they add up, and their rates are the joint's velocities.

use redysim_runtime::Scalar;

/// The coordinates of a joint with one degree of freedom.
pub const COORDINATE_NAMES: &[&str] = &["q"];
/// The velocities of a joint with one degree of freedom.
pub const VELOCITY_NAMES: &[&str] = &["v"];

/// N(q) v = v.
pub fn coordinate_rates<S: Scalar>(v: &[S], rates: &mut [S]) {
    rates.copy_from_slice(v);
}

/// q + dv.
pub fn integrate<S: Scalar>(q: &[S], dv: &[S], moved: &mut [S]) {
    for (moved, (&q, &dv)) in moved.iter_mut().zip(q.iter().zip(dv)) {
        *moved = q + dv;
    }
}

/// q₁ − q₀.
pub fn difference<S: Scalar>(q0: &[S], q1: &[S], dv: &mut [S]) {
    for (dv, (&q0, &q1)) in dv.iter_mut().zip(q0.iter().zip(q1)) {
        *dv = q1 - q0;
    }
}

/// Zero.
pub fn neutral<S: Scalar>(q: &mut [S]) {
    q.fill(S::zero());
}
