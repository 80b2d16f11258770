//! Loops of a model: joints that are cut, so that the rest is a tree.

use crate::rotation::align_z;
use crate::spatial::{Mat3, Vec3};

/// A loop: a cut joint holds two links together, with a point and perhaps an axis on each.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Loop {
    /// Name of the loop.
    pub name: String,
    /// What the cut joint holds together.
    pub joint: CutKind,
    /// The side a of the cut.
    pub a: CutSide,
    /// The side b of the cut.
    pub b: CutSide,
}

/// One side of a cut joint.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct CutSide {
    /// Index of the link in [`Model::links`](crate::model::Model::links); `None` is the ground.
    pub link: Option<usize>,
    /// The point of the cut, in the link's frame, m.
    pub point: Vec3<f64>,
    /// Unit vector of the axis of the cut, in the link's frame; z for a cut without one.
    pub axis: Vec3<f64>,
}

/// The kinds of cut joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum CutKind {
    /// Points coincide and axes align.
    Revolute,
    /// Frames align, and the points are on one line along the axis of side a.
    Prismatic,
    /// Points coincide and axes, the two of the cross, are perpendicular.
    Universal,
    /// Axes align on one line.
    Cylindrical,
    /// Axes align, and the points are in one plane perpendicular to them.
    Planar,
    /// Points coincide.
    Spherical,
    /// Points coincide and frames align.
    Weld,
}

impl CutKind {
    /// Every kind with its name in a model file.
    pub const ALL: [(&'static str, CutKind); 7] = [
        (CutKind::Revolute.name(), CutKind::Revolute),
        (CutKind::Prismatic.name(), CutKind::Prismatic),
        (CutKind::Universal.name(), CutKind::Universal),
        (CutKind::Cylindrical.name(), CutKind::Cylindrical),
        (CutKind::Planar.name(), CutKind::Planar),
        (CutKind::Spherical.name(), CutKind::Spherical),
        (CutKind::Weld.name(), CutKind::Weld),
    ];

    /// Its name in a model file.
    pub const fn name(self) -> &'static str {
        match self {
            CutKind::Revolute => "revolute",
            CutKind::Prismatic => "prismatic",
            CutKind::Universal => "universal",
            CutKind::Cylindrical => "cylindrical",
            CutKind::Planar => "planar",
            CutKind::Spherical => "spherical",
            CutKind::Weld => "weld",
        }
    }
}

impl CutKind {
    /// Whether side a, and whether side b, has an axis.
    pub(crate) fn has_axes(self) -> [bool; 2] {
        match self {
            CutKind::Revolute | CutKind::Universal | CutKind::Cylindrical | CutKind::Planar => [true, true],
            CutKind::Prismatic => [true, false],
            CutKind::Spherical | CutKind::Weld => [false, false],
        }
    }
}

impl Loop {
    /// What is aligned on sides a and b, as columns in the frames of their links: z is the axis, if the cut has one.
    pub fn axes(&self) -> [Mat3<f64>; 2] {
        match self.joint {
            CutKind::Weld => [Mat3::identity(); 2],
            // The frames of the links align, so that the axis of one is that of the other.
            CutKind::Prismatic => [align_z(self.a.axis); 2],
            _ => [&self.a, &self.b].map(|side| align_z(side.axis)),
        }
    }
}
