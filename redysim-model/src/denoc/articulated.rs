//! The inertia of a body with everything it carries on free joints.

use super::frame::JointFrame;
use super::trace::Trace;
use crate::inertia::{RigidInertia, Sym3};
use crate::joint::Screw;
use crate::spatial::{Mat3, Twist, Wrench};
use redysim_runtime::Scalar;

/// The symmetric 6×6 matrix [J H; Hᵀ M] that takes the acceleration (ω̇, a) of a body to the wrench (n, f) it needs,
/// with the joints it carries free to move.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArticulatedInertia<S> {
    /// J, moment for angular acceleration.
    pub tensor: Sym3<S>,
    /// H, moment for linear acceleration.
    pub coupling: Mat3<S>,
    /// M, force for linear acceleration.
    pub mass: Sym3<S>,
}

impl<S: Scalar> ArticulatedInertia<S> {
    /// A body that carries nothing.
    pub fn rigid(inertia: RigidInertia<S>) -> Self {
        let RigidInertia { mass, moment, tensor } = inertia;
        let mass = Sym3 { xx: mass, yy: mass, zz: mass, ..Sym3::zero() };
        ArticulatedInertia { tensor, coupling: moment.skew(), mass }
    }

    pub fn plus(self, other: Self) -> Self {
        ArticulatedInertia {
            tensor: self.tensor + other.tensor,
            coupling: self.coupling + other.coupling,
            mass: self.mass + other.mass,
        }
    }

    /// The wrench for an acceleration.
    pub fn apply(&self, acceleration: Twist<S>) -> Wrench<S> {
        let Twist { angular, linear } = acceleration;
        Wrench {
            moment: self.tensor.full().fused_product(angular) + self.coupling.fused_product(linear),
            force: self.coupling.transpose().fused_product(angular) + self.mass.full().fused_product(linear),
        }
    }

    /// I S, the wrench for a unit acceleration along one freedom of a joint.
    pub fn column(&self, screw: Screw) -> Wrench<S> {
        let axis = screw.axis;
        let turn = Wrench { moment: self.tensor.full().column(axis), force: self.coupling.row(axis) };
        let slide = Wrench { moment: self.coupling.column(axis), force: self.mass.full().column(axis) };
        screw.combined(turn, slide)
    }

    /// I − U Uᵀ / D: what is felt through a free joint, where U = I S is `column`, D is Sᵀ U and the armature, and
    /// `ratio` = U / D. Where S is an axis of six, its row and column of the result are those of U times the share of D
    /// that is armature, so they are not computed as differences; without armature they vanish.
    pub fn project_through_joint(
        &self,
        screw: Screw,
        column: Wrench<S>,
        ratio: Wrench<S>,
        rotor_share: Option<S>,
    ) -> Self {
        let free = screw.unit_axis().unwrap_or(6);
        let along = |i: usize| rotor_share.map_or(S::zero(), |share| share * column.component(i));
        let element = |value: S, i: usize, j: usize| {
            if i == free {
                along(j)
            } else if j == free {
                along(i)
            } else {
                value - ratio.component(i) * column.component(j)
            }
        };
        let (tensor, mass) = (self.tensor.full().0, self.mass.full().0);
        ArticulatedInertia {
            tensor: Sym3::from_upper(|i, j| element(tensor[i][j], i, j)),
            coupling: Mat3::from_fn(|i, j| element(self.coupling.0[i][j], i, j + 3)),
            mass: Sym3::from_upper(|i, j| element(mass[i][j], i + 3, j + 3)),
        }
    }

    /// The matrix in the parent's frame and about the parent's origin.
    ///
    /// With p the body's origin and all parts turned into the parent's axes: H' = H + p× M and
    /// J' = J + p× H'ᵀ + (p× Hᵀ)ᵀ.
    pub fn to_parent(self, frame: &JointFrame<S>) -> Self {
        let tensor = frame.rotation.tensor_to_parent(self.tensor);
        let turned = frame.rotation.matrix_to_parent(self.coupling);
        let mass = frame.rotation.tensor_to_parent(self.mass);
        let arm = frame.position.skew();
        let coupling = turned + arm * mass.full();
        let (near, far) = (arm * coupling.transpose(), arm * turned.transpose());
        let steiner = Sym3::from_upper(|i, j| near.0[i][j] + far.0[j][i]);
        ArticulatedInertia { tensor: tensor + steiner, coupling, mass }
    }

    pub fn name(self, trace: &impl Trace<S>, body: usize) {
        trace.name_symmetric(self.tensor, "J", body);
        trace.name_matrix(self.coupling, "H", body);
        trace.name_symmetric(self.mass, "M", body);
    }
}
