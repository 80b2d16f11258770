//! The inertia of a body with everything it carries on free joints.

use super::joint::JointFrame;
use super::trace::Trace;
use crate::inertia::{RigidInertia, Sym3};
use crate::spatial::{Mat3, Vec3};
use redysim_runtime::Scalar;

/// A motion (ω̇, a) or a wrench (n, f): the angular part first, as six components.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spatial<S> {
    pub angular: Vec3<S>,
    pub linear: Vec3<S>,
}

impl<S: Scalar> Spatial<S> {
    pub fn zero() -> Self {
        Spatial { angular: Vec3::zero(), linear: Vec3::zero() }
    }

    pub fn component(&self, i: usize) -> S {
        if i < 3 { self.angular[i] } else { self.linear[i - 3] }
    }

    pub fn component_mut(&mut self, i: usize) -> &mut S {
        if i < 3 { &mut self.angular[i] } else { &mut self.linear[i - 3] }
    }

    pub fn scale(self, factor: S) -> Self {
        Spatial { angular: self.angular.scale(factor), linear: self.linear.scale(factor) }
    }

    pub fn dot(self, other: Self) -> S {
        self.angular.dot(other.angular) + self.linear.dot(other.linear)
    }

    pub fn plus(self, other: Self) -> Self {
        Spatial { angular: self.angular + other.angular, linear: self.linear + other.linear }
    }

    pub fn name(self, trace: &impl Trace<S>, angular: &'static str, linear: &'static str, body: usize) {
        trace.name_vector(self.angular, angular, body);
        trace.name_vector(self.linear, linear, body);
    }
}

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
    pub fn apply(&self, acceleration: Spatial<S>) -> Spatial<S> {
        let Spatial { angular, linear } = acceleration;
        Spatial {
            angular: self.tensor.full() * angular + self.coupling * linear,
            linear: self.coupling.transpose() * angular + self.mass.full() * linear,
        }
    }

    /// Column `i` of the matrix: the wrench for a unit acceleration along axis `i` of six.
    pub fn column(&self, i: usize) -> Spatial<S> {
        if i < 3 {
            Spatial { angular: self.tensor.full().column(i), linear: Vec3(self.coupling.0[i]) }
        } else {
            Spatial { angular: self.coupling.column(i - 3), linear: self.mass.full().column(i - 3) }
        }
    }

    /// I − U Uᵀ / D: what is felt through a joint that is free along axis `free` of six, where U is column `free` and
    /// `ratio` = U / D. Row and column `free` of the result vanish identically, so they are set, not computed.
    pub fn felt_through(&self, free: usize, column: Spatial<S>, ratio: Spatial<S>) -> Self {
        let element = |value: S, i: usize, j: usize| {
            if i == free || j == free { S::zero() } else { value - ratio.component(i) * column.component(j) }
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
        let tensor = frame.tensor_to_parent(self.tensor);
        let turned = frame.matrix_to_parent(self.coupling);
        let mass = frame.tensor_to_parent(self.mass);
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
