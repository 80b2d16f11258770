//! The generalised inertia matrix, from composite bodies.

use super::frame::{JointFrame, joint_frames_in};
use super::trace::Trace;
use super::workspace::{Composite, Workspace};
use crate::inertia::{RigidInertia, Sym3};
use crate::joint::{MOST_FREEDOMS, Screw, across};
use crate::parameter::ParameterIn;
use crate::pseudo::PseudoInertia;
use crate::spatial::{Vec3, Wrench};
use crate::tree::{Body, Tree};
use redysim_runtime::Scalar;

/// M(q), by rows: element (i, j) is the force on joint i for a unit acceleration of joint j.
///
/// Body j and all it carries, taken as one rigid body, meet the acceleration with a wrench; what joint i on the way to
/// the ground feels of it is the element. Joints that are not on one way to the ground do not feel each other.
pub fn mass_matrix<S: Scalar>(tree: &Tree<impl ParameterIn<S>>, trace: &impl Trace<S>, q: &[S]) -> Vec<Vec<S>> {
    let nv = tree.nv();
    let mut matrix = vec![S::zero(); nv * nv];
    mass_matrix_in(&mut Workspace::default(), tree, trace, q, &mut matrix);
    matrix.chunks(nv.max(1)).map(<[S]>::to_vec).collect()
}

/// [`mass_matrix`] with the buffers of `work`, written to `matrix` by rows, of length NV².
pub fn mass_matrix_in<S: Scalar, P: ParameterIn<S>>(
    work: &mut Workspace<S>,
    tree: &Tree<P>,
    trace: &impl Trace<S>,
    q: &[S],
    matrix: &mut [S],
) {
    if tree.mimics.is_empty() {
        return mass_matrix_of_all_in(work, tree, trace, q, matrix);
    }
    let (nv, of_all) = (tree.nv(), tree.nv_of_all());
    let mut all = std::mem::take(&mut work.all_joints);
    all.take_coordinates(tree, q);
    all.matrix.clear();
    all.matrix.resize(of_all * of_all, S::zero());
    mass_matrix_of_all_in(work, tree, trace, &all.q, &mut all.matrix);
    tree.fold_mimics_of_matrix(&mut all.matrix);
    for (row, found) in matrix.chunks_mut(nv).zip(all.matrix.chunks(of_all)) {
        row.copy_from_slice(&found[..nv]);
    }
    work.all_joints = all;
}

/// The matrix over all joints, written to `matrix` by rows.
fn mass_matrix_of_all_in<S: Scalar, P: ParameterIn<S>>(
    work: &mut Workspace<S>,
    tree: &Tree<P>,
    trace: &impl Trace<S>,
    q: &[S],
    matrix: &mut [S],
) {
    let nv = tree.nv_of_all();
    let Workspace { positions, frames, planar, composites, .. } = work;
    joint_frames_in(positions, frames, tree, trace, q);
    find_planar(planar, tree);
    composites.clear();
    composites.reserve(tree.bodies.len());
    for (body, frame) in tree.bodies.iter().zip(frames.iter()) {
        composites.push(Composite::new(body.inertia, frame));
    }
    matrix.fill(S::zero());
    for (index, body) in tree.bodies.iter().enumerate().rev() {
        let composite = &composites[index];
        composite.name(trace, index);
        let mut columns = [Wrench::zero(); MOST_FREEDOMS];
        for (wrench, screw) in columns.iter_mut().zip(body.joint.screws()) {
            *wrench = composite.unit_wrench(screw);
        }
        if let Some(parent) = body.parent {
            let carried = composite.to_parent(&frames[index], planar[index]);
            composites[parent] = composites[parent].plus(&carried);
        }
        for (velocity, (column, &own)) in body.v.clone().zip(&columns).enumerate() {
            // Of the body's own velocities, each pair once.
            for (row, screw) in body.v.clone().zip(body.joint.screws()).take(velocity + 1) {
                let mut element = screw.project(own);
                let physics = body.physics.as_ref().filter(|_| row == column);
                if let Some(armature) = physics.and_then(|physics| physics.armature(velocity)) {
                    element += armature;
                }
                matrix[column * nv + row] = element;
                matrix[row * nv + column] = element;
            }
            let (mut at, mut wrench) = (index, own);
            while let Some(parent) = tree.bodies[at].parent {
                wrench = frames[at].wrench_to_parent(wrench);
                at = parent;
                let Body { joint, v: rows, .. } = &tree.bodies[at];
                joint.project(wrench, &mut matrix[column * nv..][rows.clone()]);
                for row in rows.clone() {
                    matrix[row * nv + column] = matrix[column * nv + row];
                }
            }
        }
    }
}

/// Which bodies can turn about directions parallel to their own joint's axis only, as all bodies of a planar mechanism.
pub(super) fn find_planar(planar: &mut Vec<bool>, tree: &Tree<impl Copy>) {
    planar.clear();
    planar.reserve(tree.bodies.len());
    for body in &tree.bodies {
        planar.push(body.parent.is_none_or(|parent| body.is_parallel() && planar[parent]));
    }
}

impl<S: Scalar> Composite<S> {
    #[inline(always)]
    pub fn new(inertia: PseudoInertia<impl ParameterIn<S>>, frame: &JointFrame<S>) -> Self {
        let Sym3 { xx, yy, .. } = inertia.second.map(ParameterIn::value);
        Composite { inertia: frame.own_inertia(inertia), polar: xx + yy }
    }

    #[inline(always)]
    pub fn plus(&self, other: &Self) -> Self {
        Composite { inertia: self.inertia + other.inertia, polar: self.polar + other.polar }
    }

    /// The composite in the parent's axes and about the parent's origin.
    #[inline(always)]
    pub fn to_parent(&self, frame: &JointFrame<S>, planar: bool) -> Self {
        let inertia = frame.inertia_to_parent(self.inertia);
        let polar = if planar {
            // Steiner's theorem for this one moment.
            let (p, far, near) = (frame.position, inertia.moment, frame.to_parent(self.inertia.moment));
            self.polar + (p[0] * (near[0] + far[0]) + p[1] * (near[1] + far[1]))
        } else {
            inertia.second.xx + inertia.second.yy
        };
        Composite { inertia, polar }
    }

    /// The same with the inertia tensor.
    pub fn to_rigid(&self) -> RigidInertia<S> {
        let RigidInertia { mass, moment, tensor } = self.inertia.to_rigid();
        RigidInertia { mass, moment, tensor: Sym3 { zz: self.polar, ..tensor } }
    }

    /// The wrench that gives the body a unit acceleration along one freedom of its joint from rest.
    #[inline(always)]
    fn unit_wrench(&self, screw: Screw) -> Wrench<S> {
        let force = across(screw.axis, self.inertia.moment);
        let along = Vec3::zero().with_component(screw.axis, self.inertia.mass);
        let turn = Wrench { moment: self.tensor_column(screw.axis), force };
        let slide = Wrench { moment: -force, force: along };
        screw.combined(turn, slide)
    }

    /// A column of the inertia tensor.
    #[inline(always)]
    fn tensor_column(&self, axis: usize) -> Vec3<S> {
        let Sym3 { xx, yy, zz, xy, yz, xz } = self.inertia.second;
        match axis {
            0 => Vec3([yy + zz, -xy, -xz]),
            1 => Vec3([-xy, zz + xx, -yz]),
            _ => Vec3([-xz, -yz, self.polar]),
        }
    }

    pub fn name(&self, trace: &impl Trace<S>, body: usize) {
        trace.name_vector(self.inertia.moment, "h", body);
        trace.name_symmetric(self.inertia.second, "S", body);
        trace.name(self.polar, "J", body, "zz");
    }
}
