//! The space of positions: how coordinates move with velocities, joint by joint.

use crate::tree::Tree;
use redysim_runtime::Scalar;

/// The rates of all coordinates, q̇ = N(q) v.
pub fn coordinate_rates<S: Scalar>(tree: &Tree<impl Copy>, q: &[S], v: &[S]) -> Vec<S> {
    let mut rates = vec![S::zero(); tree.nq()];
    for body in tree.independent_bodies() {
        body.joint.coordinate_rates(&q[body.q.clone()], &v[body.v.clone()], &mut rates[body.q.clone()]);
    }
    rates
}

/// q ⊞ dv: the position after a unit of time at the velocities `dv`.
pub fn integrate<S: Scalar>(tree: &Tree<impl Copy>, q: &[S], dv: &[S]) -> Vec<S> {
    let mut moved = vec![S::zero(); tree.nq()];
    for body in tree.independent_bodies() {
        body.joint.integrate(&q[body.q.clone()], &dv[body.v.clone()], &mut moved[body.q.clone()]);
    }
    moved
}

/// q₁ ⊟ q₀: the velocities that lead from `q0` to `q1` in a unit of time.
pub fn difference<S: Scalar>(tree: &Tree<impl Copy>, q0: &[S], q1: &[S]) -> Vec<S> {
    let mut dv = vec![S::zero(); tree.nv()];
    for body in tree.independent_bodies() {
        body.joint.difference(&q0[body.q.clone()], &q1[body.q.clone()], &mut dv[body.v.clone()]);
    }
    dv
}

/// The coordinates at which every joint is at its zero position.
pub fn neutral<S: Scalar>(tree: &Tree<impl Copy>) -> Vec<S> {
    let mut q = vec![S::zero(); tree.nq()];
    for body in tree.independent_bodies() {
        body.joint.neutral(&mut q[body.q.clone()]);
    }
    q
}
