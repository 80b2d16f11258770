//! The joint of a link, as users of a model see it: one joint of the tree, or several in series.

use super::{Element, EulerSequence, Joint, Measure, Series, linear};
use crate::model::{JointKind, Link};
use crate::rotation::align_z;
use crate::spatial::{Mat3, Vec3};
use redysim_runtime::Scalar;
use std::ops::Range;

/// What the joint of a link does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LinkJoint {
    /// One joint of the tree.
    Single(Joint),
    /// Several joints of the tree in series, without mass between them.
    Series(Series),
}

impl From<Joint> for LinkJoint {
    fn from(joint: Joint) -> Self {
        LinkJoint::Single(joint)
    }
}

impl LinkJoint {
    /// What the joint of a link does; `None` if it is fixed.
    pub fn of(link: &Link) -> Option<LinkJoint> {
        LinkJoint::of_kind(link.joint, link.pitch, link.coordinates)
    }

    /// The joint of the given kind, `None` if it is fixed. A helical joint has the pitch `pitch`, m/rad; a spherical or
    /// free joint has Euler angles of the given sequence as its coordinates, or else a quaternion.
    pub(crate) fn of_kind(kind: JointKind, pitch: f64, sequence: Option<EulerSequence>) -> Option<LinkJoint> {
        Some(match (kind, sequence) {
            (JointKind::Fixed, _) => return None,
            (JointKind::Revolute, _) => Joint::Revolute.into(),
            (JointKind::Prismatic, _) => Joint::Prismatic.into(),
            (JointKind::Helical, _) => Joint::Helical { pitch }.into(),
            (JointKind::Universal, _) => LinkJoint::Series(Series::Universal),
            (JointKind::Cylindrical, _) => LinkJoint::Series(Series::Cylindrical),
            (JointKind::Planar, _) => LinkJoint::Series(Series::Planar),
            (JointKind::Spherical, None) => Joint::Spherical.into(),
            (JointKind::Spherical, Some(sequence)) => LinkJoint::Series(Series::Spherical(sequence)),
            (JointKind::Free, None) => Joint::Free.into(),
            (JointKind::Free, Some(sequence)) => LinkJoint::Series(Series::Free(sequence)),
        })
    }

    /// Number of coordinates.
    pub fn nq(self) -> usize {
        self.coordinate_names().len()
    }

    /// Number of velocities.
    pub fn nv(self) -> usize {
        self.velocity_names().len()
    }

    /// Names of its coordinates, each unique within the joint.
    pub fn coordinate_names(self) -> &'static [&'static str] {
        match self {
            LinkJoint::Single(joint) => joint.coordinate_names(),
            LinkJoint::Series(series) => series.names(),
        }
    }

    /// Names of its velocities, each unique within the joint.
    pub fn velocity_names(self) -> &'static [&'static str] {
        match self {
            LinkJoint::Single(joint) => joint.velocity_names(),
            LinkJoint::Series(series) => series.names(),
        }
    }

    /// What its coordinates measure.
    pub fn coordinate_measures(self) -> Vec<Measure> {
        match self {
            LinkJoint::Single(joint) => joint.coordinate_measures().to_vec(),
            LinkJoint::Series(series) => series.measures(),
        }
    }

    /// What the integrals of its velocities measure.
    pub fn velocity_measures(self) -> Vec<Measure> {
        match self {
            LinkJoint::Single(joint) => joint.velocity_measures().to_vec(),
            LinkJoint::Series(series) => series.measures(),
        }
    }

    /// Whether its velocities are the rates of its coordinates.
    pub fn is_linear(self) -> bool {
        match self {
            LinkJoint::Single(joint) => joint.is_on_axis(),
            LinkJoint::Series(_) => true,
        }
    }

    /// The range of its coordinates that is a quaternion x, y, z, w; empty for a joint without a quaternion.
    pub fn quaternion(self) -> Range<usize> {
        let nq = self.nq();
        if self.is_linear() { 0..0 } else { nq - 4..nq }
    }

    /// The rates of its coordinates, q̇ = N(q) v.
    pub fn coordinate_rates<S: Scalar>(self, q: &[S], v: &[S], rates: &mut [S]) {
        match self {
            LinkJoint::Single(joint) => joint.coordinate_rates(q, v, rates),
            LinkJoint::Series(_) => linear::coordinate_rates(v, rates),
        }
    }

    /// q ⊞ dv: where the joint is after a unit of time at the velocity `dv`.
    pub fn integrate<S: Scalar>(self, q: &[S], dv: &[S], moved: &mut [S]) {
        match self {
            LinkJoint::Single(joint) => joint.integrate(q, dv, moved),
            LinkJoint::Series(_) => linear::integrate(q, dv, moved),
        }
    }

    /// q₁ ⊟ q₀: the velocity that leads from `q0` to `q1` in a unit of time.
    pub fn difference<S: Scalar>(self, q0: &[S], q1: &[S], dv: &mut [S]) {
        match self {
            LinkJoint::Single(joint) => joint.difference(q0, q1, dv),
            LinkJoint::Series(_) => linear::difference(q0, q1, dv),
        }
    }

    /// The coordinates of the zero position.
    pub fn neutral<S: Scalar>(self, q: &mut [S]) {
        match self {
            LinkJoint::Single(joint) => joint.neutral(q),
            LinkJoint::Series(_) => linear::neutral(q),
        }
    }

    /// The joints of the tree that it is, from the parent to the link, in the frame that it moves, where it has the axis
    /// `axis` if it has one.
    pub fn elements(self, axis: Vec3<f64>) -> Vec<Element> {
        match self {
            // A joint in space has the link's own frame: its coordinates and velocities are those of that frame.
            LinkJoint::Single(joint) if !joint.is_on_axis() => vec![Element { joint, axes: Mat3::identity() }],
            LinkJoint::Single(joint) => vec![Element { joint, axes: align_z(axis) }],
            LinkJoint::Series(series) => {
                let frame = if series == Series::Cylindrical { align_z(axis) } else { Mat3::identity() };
                let in_frame = |Element { joint, axes }| Element { joint, axes: frame * axes };
                series.elements().into_iter().map(in_frame).collect()
            }
        }
    }
}

impl Link {
    /// The displacement of the link along its axis where the joint variable is zero, m.
    pub fn offset_along_axis(&self) -> f64 {
        match LinkJoint::of(self) {
            Some(LinkJoint::Single(joint)) if joint.is_on_axis() => joint.transform(&[self.offset]).position[2],
            _ => 0.0,
        }
    }
}
