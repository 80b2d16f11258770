//! Joints that mimic others: from the mechanism's coordinates and velocities to those of all joints, and from the forces
//! of all joints to the mechanism's.
//!
//! The velocities of all joints are G v: those of the mechanism, then the ones of the joints that mimic others, each a
//! multiple of the velocity that it mimics. The recursions run over all joints. The power of forces is the same for both
//! sets of velocities, so that τ = Gᵀ τ_all, M = Gᵀ M_all G and J = J_all G.

use super::forward::{Loads, articulated_bodies_of_all};
use super::trace::Trace;
use super::workspace::Workspace;
use crate::parameter::ParameterIn;
use crate::tree::{Mimic, Tree};
use redysim_runtime::Scalar;
use std::borrow::Cow;

/// Buffers for vectors over all joints; those of a tree without joints that mimic others are not used.
#[derive(Clone, Debug)]
pub(super) struct AllJoints<S> {
    pub q: Vec<S>,
    pub v: Vec<S>,
    pub a: Vec<S>,
    pub tau: Vec<S>,
    /// By rows.
    pub matrix: Vec<S>,
    /// The motion, then the response to a unit acceleration of each velocity that is mimicked: the accelerations of all
    /// joints and their forces.
    motions: Vec<S>,
}

impl<S> AllJoints<S> {
    pub fn for_tree<P>(tree: &Tree<P>) -> Self {
        let nv = if tree.mimics.is_empty() { 0 } else { tree.nv_of_all() };
        let vector = || Vec::with_capacity(nv);
        AllJoints {
            q: Vec::with_capacity(tree.nq() + tree.mimics.len()),
            v: vector(),
            a: vector(),
            tau: vector(),
            matrix: Vec::with_capacity(nv * nv),
            motions: Vec::with_capacity(2 * nv * (1 + tree.mimics.len())),
        }
    }
}

impl<S> Default for AllJoints<S> {
    fn default() -> Self {
        let [q, v, a, tau, matrix, motions] = [(); 6].map(|()| Vec::new());
        AllJoints { q, v, a, tau, matrix, motions }
    }
}

impl<S: Scalar> AllJoints<S> {
    /// Takes the coordinates of all joints from the mechanism's.
    pub fn take_coordinates<P>(&mut self, tree: &Tree<P>, q: &[S]) {
        refill(&mut self.q, q, tree.mimics.iter().map(|mimic| mimic.coordinate_at(q)));
    }

    /// Takes the velocities and accelerations of all joints from the mechanism's.
    pub fn take_rates<P>(&mut self, tree: &Tree<P>, v: &[S], a: &[S]) {
        for (all, own) in [(&mut self.v, v), (&mut self.a, a)] {
            refill(all, own, tree.mimics.iter().map(|mimic| mimic.rate_at(own)));
        }
    }
}

fn refill<S: Copy>(all: &mut Vec<S>, own: &[S], of_mimics: impl Iterator<Item = S>) {
    all.clear();
    all.extend_from_slice(own);
    all.extend(of_mimics);
}

impl<P> Tree<P> {
    /// The coordinates of all joints at the mechanism's coordinates `q`.
    pub(crate) fn all_coordinates<'a, S: Scalar>(&self, q: &'a [S]) -> Cow<'a, [S]> {
        self.with_mimics(q, |mimic| mimic.coordinate_at(q))
    }

    /// G v: the velocities of all joints at the mechanism's velocities `v`, or their accelerations likewise.
    pub(super) fn all_velocities<'a, S: Scalar>(&self, v: &'a [S]) -> Cow<'a, [S]> {
        self.with_mimics(v, |mimic| mimic.rate_at(v))
    }

    fn with_mimics<'a, S: Scalar>(&self, own: &'a [S], of: impl Fn(&Mimic) -> S) -> Cow<'a, [S]> {
        if self.mimics.is_empty() {
            return Cow::Borrowed(own);
        }
        own.iter().copied().chain(self.mimics.iter().map(of)).collect::<Vec<_>>().into()
    }

    /// Gᵀ τ in the first entries, from the forces τ of all joints; or a row of a Jacobian, J G.
    pub(super) fn fold_mimics<S: Scalar>(&self, all: &mut [S]) {
        let nv = self.nv();
        for (k, mimic) in self.mimics.iter().enumerate() {
            let share = S::from_f64(mimic.multiplier) * all[nv + k];
            all[mimic.v] += share;
        }
    }

    /// The element of Gᵀ τ for a velocity, from the forces τ of all joints.
    fn folded_at<S: Scalar>(&self, velocity: usize, all: &[S]) -> S {
        let nv = self.nv();
        let mimics = self.mimics.iter().enumerate().filter(|(_, mimic)| mimic.v == velocity);
        mimics.fold(all[velocity], |sum, (k, mimic)| sum + S::from_f64(mimic.multiplier) * all[nv + k])
    }

    /// Gᵀ τ.
    pub(super) fn folded<S: Scalar>(&self, mut all: Vec<S>) -> Vec<S> {
        self.fold_mimics(&mut all);
        all.truncate(self.nv());
        all
    }

    /// Gᵀ M G in the first NV entries of the first NV rows, from the matrix M over all joints, by rows.
    pub(super) fn fold_mimics_of_matrix<S: Scalar>(&self, all: &mut [S]) {
        let (nv, of_all) = (self.nv(), self.nv_of_all());
        all.chunks_mut(of_all.max(1)).for_each(|row| self.fold_mimics(row));
        for (k, mimic) in self.mimics.iter().enumerate() {
            for column in 0..nv {
                let share = S::from_f64(mimic.multiplier) * all[(nv + k) * of_all + column];
                all[mimic.v * of_all + column] += share;
            }
        }
    }

    /// Gᵀ M G.
    pub(super) fn folded_matrix<S: Scalar>(&self, all: Vec<Vec<S>>) -> Vec<Vec<S>> {
        if self.mimics.is_empty() {
            return all;
        }
        let (nv, of_all) = (self.nv(), self.nv_of_all());
        let mut matrix = all.concat();
        self.fold_mimics_of_matrix(&mut matrix);
        matrix.chunks(of_all).take(nv).map(|row| row[..nv].to_vec()).collect()
    }
}

/// The [recursion over articulated bodies](articulated_bodies_of_all) for the mechanism's velocities: of one for which
/// `drives` holds, `given` has the acceleration, and the joint force is written to `forces`; of each other, `given` has the
/// force. All accelerations are written to `result`.
///
/// A velocity that joints mimic moves these and its own joint as one group. The recursion drives the joints of groups, first
/// with zero acceleration; then the force of each group is met, one after the other, by the response of all accelerations
/// to a unit acceleration of the group, with the share taken off that would change the forces of those before it. What
/// is driven needs no inertia by itself: it is enough that the group has some, as Gᵀ M G does. The recursion needs no
/// matrix for this.
pub(super) fn articulated_bodies<S: Scalar, P: ParameterIn<S>>(
    work: &mut Workspace<S>,
    tree: &Tree<P>,
    trace: &impl Trace<S>,
    (q, v, given): (&[S], &[S], &[S]),
    drives: &dyn Fn(usize) -> bool,
    (result, forces): (&mut [S], &mut [S]),
) {
    if tree.mimics.is_empty() {
        return articulated_bodies_of_all(work, tree, trace, Loads::All, (q, v, given), drives, (result, forces));
    }
    let (nv, of_all) = (tree.nv(), tree.nv_of_all());
    let width = 2 * of_all;
    let is_group = |velocity: usize| !drives(velocity) && tree.is_mimicked(velocity);
    let drives_of_all = |velocity: usize| {
        let own = tree.own_velocity(velocity);
        drives(own) || is_group(own)
    };
    let groups = || (0..nv).filter(|velocity| is_group(*velocity)).enumerate();
    let mut all = std::mem::take(&mut work.all_joints);
    all.take_coordinates(tree, q);
    all.take_rates(tree, v, given);
    for velocity in (0..of_all).filter(|velocity| is_group(tree.own_velocity(*velocity))) {
        all.a[velocity] = S::zero();
    }
    all.motions.clear();
    all.motions.resize(width * (1 + groups().count()), S::zero());
    let AllJoints { q, v, a, motions, .. } = &mut all;
    let (motion, responses) = motions.split_at_mut(width);
    let mut run = |loads: Loads, v: &[S], given: &[S], motion: &mut [S]| {
        let found = motion.split_at_mut(of_all);
        articulated_bodies_of_all(work, tree, trace, loads, (q, v, given), &drives_of_all, found);
    };
    run(Loads::All, v, a, motion);
    v.fill(S::zero());
    let force = |group: usize, motion: &[S]| tree.folded_at(group, &motion[of_all..]);
    for (index, group) in groups() {
        a.fill(S::zero());
        a[group] = S::one();
        for (k, mimic) in tree.mimics.iter().enumerate().filter(|(_, mimic)| mimic.v == group) {
            a[nv + k] = S::from_f64(mimic.multiplier);
        }
        let (earlier, response) = responses.split_at_mut(index * width);
        let response = &mut response[..width];
        run(Loads::Given, v, a, response);
        for (other, earlier) in groups().map(|(_, group)| group).zip(earlier.chunks(width)) {
            meet(response, earlier, S::zero(), |motion| force(other, motion));
        }
        meet(motion, response, given[group], |motion| force(group, motion));
    }
    result.copy_from_slice(&motion[..nv]);
    tree.fold_mimics(&mut motion[of_all..]);
    for velocity in (0..nv).filter(|velocity| drives(*velocity)) {
        forces[velocity] = motion[of_all + velocity];
    }
    work.all_joints = all;
}

/// Adds to `motion` as much of `response` as makes its `force` the `wanted` one.
fn meet<S: Scalar>(motion: &mut [S], response: &[S], wanted: S, force: impl Fn(&[S]) -> S) {
    let share = (wanted - force(motion)) * (S::one() / force(response));
    for (motion, response) in motion.iter_mut().zip(response) {
        *motion += share * *response;
    }
}
