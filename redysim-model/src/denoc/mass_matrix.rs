//! The generalised inertia matrix, from composite bodies.

use super::joint::{along_joint, joint_frames};
use crate::inertia::RigidInertia;
use crate::spatial::Vec3;
use crate::tree::{Joint, Tree};
use redysim_runtime::Scalar;

/// M(q), by rows: element (i, j) is the force on joint i for a unit acceleration of joint j.
///
/// Body j and all it carries, taken as one rigid body, meet the acceleration with a wrench; what joint i on the way to
/// the ground feels of it is the element. Joints that are not on one way to the ground do not feel each other.
pub fn mass_matrix<S: Scalar>(tree: &Tree, q: &[S]) -> Vec<Vec<S>> {
    let frames = joint_frames(tree, q);
    let mut composites: Vec<RigidInertia<S>> =
        tree.bodies.iter().map(|body| RigidInertia::constant(body.inertia)).collect();
    let mut matrix = vec![vec![S::zero(); tree.dof()]; tree.dof()];
    for (index, body) in tree.bodies.iter().enumerate().rev() {
        let composite = composites[index];
        let composite = RigidInertia {
            mass: composite.mass,
            moment: composite.moment.named("h", index),
            tensor: composite.tensor.named("J", index),
        };
        if let Some(parent) = body.parent {
            composites[parent] = composites[parent] + frames[index].inertia_to_parent(composite);
        }
        let (mut force, mut moment) = unit_wrench(body.joint, &composite);
        let mut at = index;
        loop {
            let joint = &tree.bodies[at];
            let element = along_joint(joint.joint, force, moment);
            matrix[body.coordinate][joint.coordinate] = element;
            matrix[joint.coordinate][body.coordinate] = element;
            let Some(parent) = joint.parent else { break };
            (force, moment) = frames[at].wrench_to_parent(force, moment);
            at = parent;
        }
    }
    matrix
}

/// Force and moment that give the body a unit acceleration of its joint from rest.
fn unit_wrench<S: Scalar>(joint: Joint, inertia: &RigidInertia<S>) -> (Vec3<S>, Vec3<S>) {
    let Vec3([x, y, _]) = inertia.moment;
    match joint {
        Joint::Revolute => (Vec3([-y, x, S::zero()]), Vec3([inertia.tensor.xz, inertia.tensor.yz, inertia.tensor.zz])),
        Joint::Prismatic => (Vec3([S::zero(), S::zero(), inertia.mass]), Vec3([y, -x, S::zero()])),
    }
}
