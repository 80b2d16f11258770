//! Joints with several degrees of freedom that are joints with one degree of freedom in series, without mass between them.

use super::{EulerSequence, Joint, Measure};
use crate::rotation::align_z;
use crate::spatial::Mat3;

/// A joint with several degrees of freedom as joints with one degree of freedom in series: translations, then rotations,
/// each along or about an axis of the frame that the ones before it have moved. Its velocities are the rates of its coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Series {
    /// A rotation φ about x, then a rotation θ about y.
    Universal,
    /// A displacement along z and a rotation about it.
    Cylindrical,
    /// Displacements along x and y, then a rotation about z.
    Planar,
    /// A spherical joint in Euler angles.
    Spherical(EulerSequence),
    /// Displacements along x, y and z, then a spherical joint in Euler angles.
    Free(EulerSequence),
}

/// One of the joints of a [`Series`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element {
    /// [`Joint::Prismatic`] or [`Joint::Revolute`].
    pub joint: Joint,
    /// The axes that take its z axis to its place in the series' frame.
    pub axes: Mat3<f64>,
}

impl Series {
    /// Names of its coordinates and velocities, each unique within the joint.
    pub fn names(self) -> &'static [&'static str] {
        match self {
            Series::Universal => &["phi", "theta"],
            Series::Cylindrical => &["displacement", "angle"],
            Series::Planar => &["x", "y", "angle"],
            Series::Spherical(_) => &["phi", "theta", "psi"],
            Series::Free(_) => &["x", "y", "z", "phi", "theta", "psi"],
        }
    }

    /// The joints with one degree of freedom, from the parent to the link.
    pub fn elements(self) -> Vec<Element> {
        let (translations, rotations): (&[usize], Vec<usize>) = match self {
            Series::Universal => (&[], vec![0, 1]),
            Series::Cylindrical => (&[2], vec![2]),
            Series::Planar => (&[0, 1], vec![2]),
            Series::Spherical(sequence) => (&[], sequence.axes().to_vec()),
            Series::Free(sequence) => (&[0, 1, 2], sequence.axes().to_vec()),
        };
        let element = |joint| move |axis: usize| Element { joint, axes: align_z(Mat3::identity().column(axis)) };
        let translations = translations.iter().copied().map(element(Joint::Prismatic));
        translations.chain(rotations.into_iter().map(element(Joint::Revolute))).collect()
    }

    /// What its coordinates measure, and the integrals of its velocities.
    pub fn measures(self) -> Vec<Measure> {
        self.elements().iter().flat_map(|element| element.joint.velocity_measures()).copied().collect()
    }
}
