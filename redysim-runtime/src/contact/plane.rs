//! The ground as a plane.

use super::ContactError;
use crate::Real;
use crate::linear_algebra::{add_scaled, cross, dot, norm};

/// The ground: the half space below a plane.
///
/// The two tangential directions, along which a law of friction may act one by one, follow from the normal: the first
/// is, of the axes of the base frame, the one farthest from the normal, or the first of them, projected onto the
/// plane. So for a normal along an axis of the base frame they are the two other axes, up to sign.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Fields<S>", into = "Fields<S>"))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "S: Real + serde::Serialize", deserialize = "S: Real + serde::Deserialize<'de>"))
)]
pub struct GroundPlane<S> {
    point: [S; 3],
    /// The outward normal as it was given.
    #[cfg_attr(not(feature = "serde"), allow(dead_code, reason = "what is serialised"))]
    given: [S; 3],
    /// The outward normal and the tangential directions, each of length 1.
    axes: [[S; 3]; 3],
}

/// What a [`GroundPlane`] is made of.
#[cfg(feature = "serde")]
#[derive(serde::Serialize, serde::Deserialize)]
#[serde(rename = "GroundPlane", deny_unknown_fields)]
struct Fields<S> {
    point: [S; 3],
    normal: [S; 3],
}

#[cfg(feature = "serde")]
impl<S: Real> TryFrom<Fields<S>> for GroundPlane<S> {
    type Error = ContactError<S>;

    fn try_from(Fields { point, normal }: Fields<S>) -> Result<Self, ContactError<S>> {
        GroundPlane::new(point, normal)
    }
}

#[cfg(feature = "serde")]
impl<S: Real> From<GroundPlane<S>> for Fields<S> {
    fn from(plane: GroundPlane<S>) -> Self {
        Fields { point: plane.point, normal: plane.given }
    }
}

impl<S: Real> GroundPlane<S> {
    /// The plane through `point`, m, with the outward normal `normal`, of any length, in the base frame.
    ///
    /// # Errors
    /// If the point is not finite, or the normal does not have a direction.
    pub fn new(point: [S; 3], normal: [S; 3]) -> Result<Self, ContactError<S>> {
        if !point.iter().all(|coordinate| coordinate.is_finite()) {
            return Err(ContactError::InvalidPoint { point });
        }
        // Divided by the largest component first, so that no square overflows or vanishes.
        let largest = normal.iter().fold(S::zero(), |largest, component| largest.maximum(component.abs()));
        let scaled = normal.map(|component| component / largest);
        // Of a normal of zeros, the quotients are not numbers.
        if !scaled.iter().all(|component| component.is_finite()) {
            return Err(ContactError::InvalidNormal { normal });
        }
        let unit = direction(scaled);
        let [x, y, z] = unit.map(|component| component.abs());
        let farthest = if x <= y && x <= z { 0 } else { usize::from(y <= z) + 2 * usize::from(y > z) };
        let mut first = core::array::from_fn(|axis| if axis == farthest { S::one() } else { S::zero() });
        let along = dot(&first, &unit);
        add_scaled(&mut first, -along, &unit);
        let first = direction(first);
        Ok(Self { point, given: normal, axes: [unit, first, cross(unit, first)] })
    }

    /// The point that was given, m.
    pub fn point(&self) -> [S; 3] {
        self.point
    }

    /// The outward normal, of length 1.
    pub fn normal(&self) -> [S; 3] {
        let [normal, ..] = self.axes;
        normal
    }

    /// The two tangential directions, of length 1.
    pub fn tangents(&self) -> [[S; 3]; 2] {
        let [_, first, second] = self.axes;
        [first, second]
    }

    /// How high `position` is above the plane, m.
    pub fn height(&self, position: &[S; 3]) -> S {
        let ([x, y, z], [px, py, pz]) = (*position, self.point);
        dot(&[x - px, y - py, z - pz], &self.normal())
    }

    /// The components of a vector along the normal and the tangential directions.
    pub fn components(&self, vector: &[S; 3]) -> [S; 3] {
        self.axes.map(|axis| dot(&axis, vector))
    }

    /// The vector with these components along the normal and the tangential directions.
    pub fn vector(&self, components: [S; 3]) -> [S; 3] {
        let mut sum = [S::zero(); 3];
        for (axis, component) in self.axes.iter().zip(components) {
            add_scaled(&mut sum, component, axis);
        }
        sum
    }
}

fn direction<S: Real>(vector: [S; 3]) -> [S; 3] {
    let length = norm(&vector);
    vector.map(|component| component / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_and_components_are_those_of_an_inclined_plane() {
        let plane = GroundPlane::new([1.0, 0.0, 0.0], [3e200, 0.0, 4e200]).unwrap();
        assert!((plane.height(&[1.0, 7.0, 5.0]) - 4.0_f64).abs() < 1e-15);
        assert!((plane.height(&[-4.0, 7.0, 0.0]) + 3.0).abs() < 1e-15);
        let vector = [0.3, -0.2, 0.9];
        let components = plane.components(&vector);
        assert!((components[0] - (0.6 * 0.3 + 0.8 * 0.9)).abs() < 1e-15);
        for (back, given) in plane.vector(components).iter().zip(vector) {
            assert!((back - given).abs() < 1e-15);
        }
    }

    #[test]
    fn tangents_of_a_normal_along_an_axis_are_the_other_axes() {
        for axis in 0..3 {
            let mut normal = [0.0; 3];
            normal[axis] = -2.0;
            let plane = GroundPlane::new([0.0; 3], normal).unwrap();
            for tangent in plane.tangents() {
                assert_eq!(tangent[axis], 0.0);
                let sizes: [f64; 3] = tangent.map(f64::abs);
                assert_eq!(sizes.iter().sum::<f64>(), 1.0, "{tangent:?}");
            }
            let [first, second] = plane.tangents();
            assert_eq!(dot(&first, &second), 0.0);
        }
    }

    #[test]
    fn planes_without_direction_or_place_are_errors_with_the_values() {
        let error = GroundPlane::new([0.0; 3], [0.0; 3]).unwrap_err();
        assert_eq!(error, ContactError::InvalidNormal { normal: [0.0; 3] });
        assert!(GroundPlane::new([0.0; 3], [f64::NAN, 0.0, 1.0]).is_err());
        assert!(GroundPlane::new([0.0; 3], [f64::INFINITY, 0.0, 1.0]).is_err());
        let error = GroundPlane::new([0.0, f64::INFINITY, 0.0], [0.0, 0.0, 1.0]).unwrap_err();
        assert_eq!(error, ContactError::InvalidPoint { point: [0.0, f64::INFINITY, 0.0] });
    }
}
