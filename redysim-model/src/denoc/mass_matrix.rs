//! The generalised inertia matrix, from composite bodies.

use super::frame::{JointFrame, joint_frames};
use super::trace::Trace;
use crate::inertia::Sym3;
use crate::joint::Screw;
use crate::pseudo::PseudoInertia;
use crate::spatial::{Vec3, Wrench};
use crate::tree::{Body, Tree};
use redysim_runtime::Scalar;

/// M(q), by rows: element (i, j) is the force on joint i for a unit acceleration of joint j.
///
/// Body j and all it carries, taken as one rigid body, meet the acceleration with a wrench; what joint i on the way to
/// the ground feels of it is the element. Joints that are not on one way to the ground do not feel each other.
pub fn mass_matrix<S: Scalar>(tree: &Tree, trace: &impl Trace<S>, q: &[S]) -> Vec<Vec<S>> {
    let frames = joint_frames(tree, trace, q);
    let upright = upright(tree);
    let own_inertia = |(body, frame): (&Body, &JointFrame<S>)| Composite::new(body.inertia, frame);
    let mut composites: Vec<Composite<S>> = tree.bodies.iter().zip(&frames).map(own_inertia).collect();
    let mut matrix = vec![vec![S::zero(); tree.nv()]; tree.nv()];
    for (index, body) in tree.bodies.iter().enumerate().rev() {
        let composite = composites[index];
        composite.name(trace, index);
        if let Some(parent) = body.parent {
            let carried = composite.to_parent(&frames[index], upright[index]);
            composites[parent] = composites[parent].plus(carried);
        }
        let mut wrench = composite.unit_wrench(body.joint.screw());
        let mut at = index;
        loop {
            let joint = &tree.bodies[at];
            let element = joint.joint.screw().project(wrench);
            matrix[body.v.start][joint.v.start] = element;
            matrix[joint.v.start][body.v.start] = element;
            let Some(parent) = joint.parent else { break };
            wrench = frames[at].wrench_to_parent(wrench);
            at = parent;
        }
    }
    matrix
}

/// Which bodies can turn about directions parallel to their own joint's axis only, as all bodies of a planar mechanism.
fn upright(tree: &Tree) -> Vec<bool> {
    let mut upright: Vec<bool> = Vec::with_capacity(tree.bodies.len());
    for body in &tree.bodies {
        upright.push(body.parent.is_none_or(|parent| body.is_parallel() && upright[parent]));
    }
    upright
}

/// A body and all it carries, as one rigid body.
#[derive(Clone, Copy)]
struct Composite<S> {
    inertia: PseudoInertia<S>,
    /// The moment of inertia about z, Σ_xx + Σ_yy. A body that turns about z only has no other use for these two.
    polar: S,
}

impl<S: Scalar> Composite<S> {
    fn new(inertia: PseudoInertia<f64>, frame: &JointFrame<S>) -> Self {
        let Sym3 { xx, yy, .. } = inertia.second.map(S::from_f64);
        Composite { inertia: frame.own_inertia(inertia), polar: xx + yy }
    }

    fn plus(self, other: Self) -> Self {
        Composite { inertia: self.inertia + other.inertia, polar: self.polar + other.polar }
    }

    /// The composite in the parent's axes and about the parent's origin.
    fn to_parent(self, frame: &JointFrame<S>, upright: bool) -> Self {
        let inertia = frame.inertia_to_parent(self.inertia);
        let polar = if upright {
            // Steiner's theorem for this one moment.
            let (p, far, near) = (frame.position, inertia.moment, frame.to_parent(self.inertia.moment));
            self.polar + (p[0] * (near[0] + far[0]) + p[1] * (near[1] + far[1]))
        } else {
            inertia.second.xx + inertia.second.yy
        };
        Composite { inertia, polar }
    }

    /// The wrench that gives the body a unit acceleration of its joint from rest.
    fn unit_wrench(self, screw: Screw) -> Wrench<S> {
        let Vec3([x, y, _]) = self.inertia.moment;
        let (zero, s) = (S::zero(), self.inertia.second);
        let turn = Wrench { moment: Vec3([-s.xz, -s.yz, self.polar]), force: Vec3([-y, x, zero]) };
        let slide = Wrench { moment: Vec3([y, -x, zero]), force: Vec3([zero, zero, self.inertia.mass]) };
        screw.combined(turn, slide)
    }

    fn name(self, trace: &impl Trace<S>, body: usize) {
        trace.name_vector(self.inertia.moment, "h", body);
        trace.name_symmetric(self.inertia.second, "S", body);
        trace.name(self.polar, "J", body, "zz");
    }
}
