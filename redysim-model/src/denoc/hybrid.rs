//! Hybrid dynamics: accelerations of the joints whose forces are given, and forces of those whose accelerations are given,
//! in two ways.
//!
//! Given are the accelerations of the velocities with an actuator, and the forces of the others. Source: Featherstone, *Rigid
//! Body Dynamics Algorithms*, Springer 2008, sections 9.1 and 9.2.

use super::factorisation::{EliminationOrder, Factorisation};
use super::forward::Method;
use super::inverse::inverse_dynamics;
use super::mass_matrix::mass_matrix;
use super::mimic::articulated_bodies;
use super::trace::Trace;
use super::workspace::Workspace;
use crate::parameter::ParameterIn;
use crate::tree::Tree;
use redysim_runtime::{HybridMotion, Scalar};

/// Accelerations and joint forces from what `u` gives of each velocity, by the given method.
pub fn hybrid_dynamics<S: Scalar>(
    method: Method,
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
    u: &[S],
) -> HybridMotion<Vec<S>> {
    match method {
        Method::Factorisation => {
            hybrid_dynamics_by_factorisation(EliminationOrder::TipsFirst, [tree; 2], trace, q, v, u)
        }
        Method::Recursion => hybrid_dynamics_by_recursion(tree, trace, q, v, u),
    }
}

/// By the mass matrix: the forces h for the given accelerations, with zero for those that are not given; then
/// M_pp a_p = u_p − h_p for the passive joints p, and τ = h + M_dp a_p for the driven ones d.
///
/// The first tree is that for forces, the second that for the mass matrix: two descriptions of the same robot.
pub fn hybrid_dynamics_by_factorisation<S: Scalar, P: ParameterIn<S>>(
    order: EliminationOrder,
    [for_forces, for_matrix]: [&Tree<P>; 2],
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
    u: &[S],
) -> HybridMotion<Vec<S>> {
    let actuated = for_matrix.actuated();
    let is_passive = |velocity: usize| !actuated[velocity];
    let velocities = || for_matrix.independent_bodies().flat_map(|body| body.v.clone());
    let passive: Vec<usize> = velocities().filter(|&velocity| is_passive(velocity)).collect();
    let mut given = u.to_vec();
    passive.iter().for_each(|&i| given[i] = S::zero());
    let mut tau = inverse_dynamics(for_forces, trace, q, v, &given);
    let matrix = mass_matrix(for_matrix, trace, q);
    let drive: Vec<S> = u.iter().zip(&tau).map(|(&u, &tau)| u - tau).collect();
    let found = Factorisation::of_joints(order, for_matrix, trace, &matrix, is_passive).solve(&drive);
    for i in velocities() {
        if actuated[i] {
            for &k in &passive {
                tau[i] += matrix[i][k] * found[k];
            }
        } else {
            (given[i], tau[i]) = (found[i], u[i]);
        }
    }
    HybridMotion { a: given, tau }
}

/// By the O(n) recursion over articulated bodies, in which only passive joints are free.
pub fn hybrid_dynamics_by_recursion<S: Scalar>(
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
    u: &[S],
) -> HybridMotion<Vec<S>> {
    let [mut a, mut tau] = [(); 2].map(|()| u.to_vec());
    let (work, actuated) = (&mut Workspace::default(), tree.actuated());
    articulated_bodies(work, tree, trace, (q, v, u), &|velocity| actuated[velocity], (&mut a, &mut tau));
    HybridMotion { a, tau }
}
