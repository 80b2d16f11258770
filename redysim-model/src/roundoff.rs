//! Geometry and inertias without what is nothing but roundoff.

use crate::inertia::Sym3;
use crate::parameter::Parameter;
use crate::pseudo::PseudoInertia;
use crate::spatial::{Mat3, Pose, Vec3};

/// Sets to zero what is smaller than the roundoff of the largest element, so that the noise of a fixed rotation never
/// becomes a term of a recursion. A value that is not known before run time is unchanged.
fn without_noise<P: Parameter>(values: &mut [&mut P]) {
    let largest = values.iter().filter_map(|value| value.number()).fold(0.0_f64, |largest, x| largest.max(x.abs()));
    for value in values {
        if value.number().is_some_and(|x| x.abs() < 4.0 * f64::EPSILON * largest) {
            **value = P::zero();
        }
    }
}

impl Pose<f64> {
    /// -0.0 comes from products with zero; it would be printed.
    pub(crate) fn without_negative_zeros(self) -> Self {
        Pose {
            rotation: Mat3::from_fn(|i, j| self.rotation.0[i][j] + 0.0),
            position: Vec3::from_fn(|i| self.position[i] + 0.0),
        }
    }

    pub(crate) fn without_roundoff(mut self) -> Self {
        let Mat3(rows) = &mut self.rotation;
        for element in rows.iter_mut().flatten() {
            let nearest = element.round();
            if (*element - nearest).abs() < 4.0 * f64::EPSILON {
                *element = nearest;
            }
        }
        let [x, y, z] = &mut self.position.0;
        without_noise(&mut [x, y, z]);
        self
    }
}

impl<P: Parameter> PseudoInertia<P> {
    pub(crate) fn without_roundoff(mut self) -> Self {
        let [x, y, z] = &mut self.moment.0;
        without_noise(&mut [x, y, z]);
        let Sym3 { xx, yy, zz, xy, yz, xz } = &mut self.second;
        without_noise(&mut [xx, yy, zz, xy, yz, xz]);
        self
    }
}

/// ±1 for what differs from it by roundoff.
pub(crate) fn exact_one(value: f64) -> f64 {
    if (value.abs() - 1.0).abs() < 16.0 * f64::EPSILON { value.signum() } else { value }
}
