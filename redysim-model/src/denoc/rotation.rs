//! The rotation between the axes of a body's quantities and its parent's.

use crate::inertia::Sym3;
use crate::joint::quaternion::{self, Quaternion};
use crate::parameter::ParameterIn;
use crate::spatial::{Mat3, Vec3};
use redysim_runtime::Scalar;

/// A rotation about z: cosine and sine of its angle.
pub(super) type RotationAboutZ<S> = (S, S);

/// The rotation of a body's axes in its parent's.
#[derive(Clone, Debug)]
pub(super) enum FrameRotation<S> {
    /// For numbers: the columns of the product of all its factors.
    Columns(Mat3<S>),
    /// For symbols: its factors, of which the fixed one is mostly made of zeros and ones.
    Factors(RotationFactors<S>),
}

/// A fixed rotation, then the joint's own about z.
#[derive(Clone, Debug)]
pub(super) struct RotationFactors<S> {
    /// The rotation of the parent against its axes, where these do not rotate with its joint and the axes are not
    /// parallel.
    pub parent_rotation: Option<RotationAboutZ<S>>,
    /// The rotation by the body's placement, and by its joint where that can turn it about any axis.
    pub fixed: Mat3<S>,
    /// The rotation of the body's axes by its joint; `None` where they do not rotate.
    pub rotation_about_z: Option<RotationAboutZ<S>>,
    /// Whether a product with the joint's axis is a column of the matrix: if the joint's axis is one of the parent's axes.
    pub selects_column: bool,
    /// The rotation by the body's placement, and by its joint if that can turn it about any axis.
    pub in_space: Option<(Mat3<f64>, Quaternion<S>)>,
}

impl<S: Scalar> RotationFactors<S> {
    /// The columns of their product.
    #[inline(always)]
    pub fn columns(&self) -> Mat3<S> {
        let own = self.fixed.map_rows(|row| rotated_back(self.rotation_about_z, row)).transpose();
        self.parent_rotation.map_or(own, |_| own.map_rows(|column| rotated(self.parent_rotation, column)))
    }
}

impl<S: Scalar> FrameRotation<S> {
    /// A vector in the body's axes, in the parent's.
    #[inline(always)]
    pub fn to_parent(&self, v: Vec3<S>) -> Vec3<S> {
        match self {
            FrameRotation::Columns(columns) => {
                let Mat3([x, y, z]) = columns.apart();
                Vec3::from_fn(|i| z[i].mul_add(v[2], y[i].mul_add(v[1], x[i] * v[0])))
            }
            FrameRotation::Factors(factors) => {
                rotated(factors.parent_rotation, factors.fixed * rotated(factors.rotation_about_z, v))
            }
        }
    }

    /// A vector in the parent's axes, in the body's.
    #[inline(always)]
    pub fn to_body(&self, v: Vec3<S>) -> Vec3<S> {
        match self {
            FrameRotation::Columns(columns) => columns.fused_product(v),
            FrameRotation::Factors(factors) => rotated_back(
                factors.rotation_about_z,
                factors.fixed.transpose() * rotated_back(factors.parent_rotation, v),
            ),
        }
    }

    /// An axis of the joint, one of the body's frame, in the parent's axes.
    #[inline(always)]
    pub fn axis(&self, axis: usize) -> Vec3<S> {
        match self {
            FrameRotation::Columns(columns) => Vec3(columns.0[axis]),
            FrameRotation::Factors(factors) => rotated(factors.parent_rotation, factors.fixed.column(axis)),
        }
    }

    /// A vector in the axes of the ground, known before run time, in those of a body on it.
    #[inline(always)]
    pub fn ground_to_body(&self, v: Vec3<impl ParameterIn<S>>) -> Vec3<S> {
        match self {
            FrameRotation::Factors(RotationFactors { in_space: Some((placement, orientation)), .. }) => {
                quaternion::turned_back(*orientation, Mat3::constant(*placement).transpose() * v)
            }
            _ => self.to_body(v.map(ParameterIn::value)),
        }
    }

    /// The product of a matrix of the parent's axes and the joint's axis, in the body's axes; `None` where it costs more
    /// than to select a column. For numbers it is a product like any other.
    #[inline(always)]
    pub fn axis_image(&self, matrix: Mat3<S>) -> Option<Vec3<S>> {
        match self {
            FrameRotation::Factors(factors) if factors.selects_column => {
                Some(self.to_body(matrix * factors.fixed.column(2)))
            }
            _ => None,
        }
    }

    /// A symmetric tensor of the body's axes, in the parent's.
    #[inline(always)]
    pub fn tensor_to_parent(&self, tensor: Sym3<S>) -> Sym3<S> {
        match self {
            FrameRotation::Columns(columns) => {
                let rotation = columns.transpose();
                let full = tensor.full();
                let half = Mat3::from_fn(|i, j| full.fused_product(Vec3(rotation.0[i]))[j]);
                Sym3::from_upper(|i, j| rotation.fused_product(Vec3(half.0[i]))[j])
            }
            FrameRotation::Factors(RotationFactors { parent_rotation, fixed, rotation_about_z, .. }) => {
                rotated_tensor(*parent_rotation, rotated_tensor(*rotation_about_z, tensor).rotated(*fixed))
            }
        }
    }

    /// A general tensor of the body's axes, in the parent's.
    #[inline(always)]
    pub fn matrix_to_parent(&self, matrix: Mat3<S>) -> Mat3<S> {
        if let FrameRotation::Columns(columns) = self {
            let rotation = columns.transpose();
            return rotation * (matrix * rotation.transpose());
        }
        let rows = matrix.map_rows(|row| self.to_parent(row)).transpose();
        rows.map_rows(|column| self.to_parent(column)).transpose()
    }
}

/// `v` after a rotation about z.
#[inline(always)]
pub(super) fn rotated<S: Scalar>(rotation: Option<RotationAboutZ<S>>, v: Vec3<S>) -> Vec3<S> {
    match rotation {
        Some((cos, sin)) => Vec3([cos * v[0] - sin * v[1], sin * v[0] + cos * v[1], v[2]]),
        None => v,
    }
}

/// `v` before a rotation about z.
#[inline(always)]
pub(super) fn rotated_back<S: Scalar>(rotation: Option<RotationAboutZ<S>>, v: Vec3<S>) -> Vec3<S> {
    rotated(rotation.map(|(cos, sin)| (cos, -sin)), v)
}

/// A tensor after a rotation about z.
#[inline(always)]
pub(super) fn rotated_tensor<S: Scalar>(rotation: Option<RotationAboutZ<S>>, tensor: Sym3<S>) -> Sym3<S> {
    rotation.map_or(tensor, |(cos, sin)| tensor.rotated_about_z(cos, sin))
}
