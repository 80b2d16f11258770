//! The generalised inertia matrix as a metric.
//!
//! With M = U D Uᵀ (U unit upper triangular: DeNOC's reverse Gaussian elimination) the coordinates s = D^½ Uᵀ x of a
//! velocity or an acceleration x make xᵀ M x = sᵀ s. In them Gauss' principle of least constraint is Euclidean: of all
//! accelerations that keep the loops closed, the true one is nearest to the unconstrained one.

use super::{add_scaled, dot};
use crate::vector::entry;
use crate::{Real, Vector};

/// A pivot of M is not positive, or not a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotPositiveDefinite {
    /// The velocity of the pivot.
    pub velocity: usize,
}

/// M = U D Uᵀ, in the room of M. Row k holds column k of U above its diagonal, then D_k^−½; what follows is not used.
#[derive(Clone)]
pub struct MassMetric<A> {
    factors: A,
    regular: bool,
}

/// A pivot of so many roundings of its diagonal element may be nothing but roundoff.
const ROUNDINGS: f64 = 16.0;

impl<A> MassMetric<A> {
    /// Factorises `matrix`, of which the lower triangle is looked at. Zeros that branches leave cost nothing.
    pub fn new<S: Real, V: Vector<S>>(mut matrix: A) -> Result<Self, NotPositiveDefinite>
    where
        A: Vector<V>,
    {
        let mut regular = true;
        let rows = matrix.as_ref();
        let diagonal = V::from_fn(rows.len(), |k| rows.get(k).map_or(S::zero(), |row| entry(row, k)));
        for k in (0..matrix.as_ref().len()).rev() {
            let Some((above, [row, ..])) = matrix.as_mut().split_at_mut_checked(k) else { continue };
            let Some((column, [pivot, ..])) = row.as_mut().split_at_mut_checked(k) else { continue };
            let size = *pivot;
            if !(size > S::zero() && size.is_finite()) {
                return Err(NotPositiveDefinite { velocity: k });
            }
            regular &= size > S::from_f64(ROUNDINGS) * S::EPSILON * entry(&diagonal, k);
            for (i, other) in above.iter_mut().enumerate() {
                let factor = column.get(i).map_or(S::zero(), |&element| element / size);
                if factor != S::zero() {
                    let columns = other.as_mut().iter_mut().take(i + 1);
                    for (element, &of_pivot) in columns.zip(column.iter()) {
                        *element -= factor * of_pivot;
                    }
                }
            }
            for element in column {
                *element = *element / size;
            }
            *pivot = S::one() / size.sqrt();
        }
        Ok(Self { factors: matrix, regular })
    }

    /// Whether every pivot is more than roundoff.
    pub fn is_regular(&self) -> bool {
        self.regular
    }

    /// D^−½ U⁻¹ f of a generalised force f (or a row of a Jacobian), in place.
    pub fn scale<S: Real, V: Vector<S>>(&self, force: &mut V)
    where
        A: Vector<V>,
    {
        for (k, row) in self.factors.as_ref().iter().enumerate().rev() {
            let Some((column, [root, ..])) = row.as_ref().split_at_checked(k) else { continue };
            let Some((above, [value, ..])) = force.as_mut().split_at_mut_checked(k) else { continue };
            if *value != S::zero() {
                add_scaled(above, -*value, column);
                *value = *value * *root;
            }
        }
    }

    /// U D^½ s: the generalised force with scaled coordinates s, in place; the inverse of [`scale`](Self::scale).
    pub fn unscale_force<S: Real, V: Vector<S>>(&self, scaled: &mut V)
    where
        A: Vector<V>,
    {
        for (k, row) in self.factors.as_ref().iter().enumerate() {
            let Some((column, [root, ..])) = row.as_ref().split_at_checked(k) else { continue };
            let Some((above, [value, ..])) = scaled.as_mut().split_at_mut_checked(k) else { continue };
            *value = *value / *root;
            add_scaled(above, *value, column);
        }
    }

    /// U⁻ᵀ D^−½ s: the acceleration (or velocity, or displacement) with scaled coordinates s, in place.
    pub fn unscale<S: Real, V: Vector<S>>(&self, scaled: &mut V)
    where
        A: Vector<V>,
    {
        for (k, row) in self.factors.as_ref().iter().enumerate() {
            let Some((column, [root, ..])) = row.as_ref().split_at_checked(k) else { continue };
            let Some((above, [value, ..])) = scaled.as_mut().split_at_mut_checked(k) else { continue };
            *value = *value * *root - dot(above, column);
        }
    }

    /// D^½ Uᵀ v: the scaled coordinates of a velocity v, in place.
    pub fn scale_velocity<S: Real, V: Vector<S>>(&self, velocity: &mut V)
    where
        A: Vector<V>,
    {
        for (k, row) in self.factors.as_ref().iter().enumerate().rev() {
            let Some((column, [root, ..])) = row.as_ref().split_at_checked(k) else { continue };
            let Some((above, [value, ..])) = velocity.as_mut().split_at_mut_checked(k) else { continue };
            *value = (*value + dot(above, column)) / *root;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MATRIX: [[f64; 3]; 3] = [[5.0, 1.0, 0.5], [1.0, 3.0, 0.0], [0.5, 0.0, 2.0]];

    #[test]
    fn scaled_forces_measure_with_the_inverse_and_scaled_velocities_with_the_matrix() {
        let metric = MassMetric::new::<f64, [f64; 3]>(MATRIX).unwrap();
        let x = [0.3, -1.2, 2.0];
        let force = MATRIX.map(|row| dot(&row, &x));
        let (mut of_force, mut of_velocity) = (force, x);
        metric.scale(&mut of_force);
        metric.scale_velocity(&mut of_velocity);
        for (a, b) in of_force.iter().zip(&of_velocity) {
            assert!((a - b).abs() < 1e-15, "M x and x have the same scaled coordinates: {of_force:?} {of_velocity:?}");
        }
        assert!((dot(&of_velocity, &of_velocity) - dot(&force, &x)).abs() < 1e-14);
        metric.unscale_force(&mut of_force);
        for (a, b) in of_force.iter().zip(&force) {
            assert!((a - b).abs() < 1e-14, "{of_force:?} {force:?}");
        }
        metric.unscale(&mut of_velocity);
        for (a, b) in of_velocity.iter().zip(&x) {
            assert!((a - b).abs() < 1e-15);
        }
    }

    #[test]
    fn a_pivot_of_roundoff_is_distinguished_from_a_small_one() {
        let near =
            |gap: f64| MassMetric::new::<f64, [f64; 2]>([[1.0 + gap, 1.0], [1.0, 1.0]]).map(|metric| metric.regular);
        assert_eq!(near(2.0 * f64::EPSILON), Ok(false));
        assert_eq!(near(1e-14), Ok(true));
    }

    #[test]
    fn a_matrix_that_is_not_positive_definite_is_refused_with_the_velocity() {
        let error = MassMetric::new::<f64, [f64; 2]>([[1.0, 2.0], [2.0, 1.0]]).err();
        assert_eq!(error, Some(NotPositiveDefinite { velocity: 0 }));
        let error = MassMetric::new::<f64, [f64; 2]>([[1.0, 2.0], [2.0, f64::NAN]]).err();
        assert_eq!(error, Some(NotPositiveDefinite { velocity: 1 }));
    }
}
