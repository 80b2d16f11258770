//! The inertia of a rigid body about the origin of a frame, over any scalar.

use crate::spatial::{Mat3, Twist, Vec3, Wrench};
use redysim_runtime::Scalar;
use std::ops::Add;

/// A symmetric 3×3 matrix by its six elements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sym3<S> {
    /// Element xx.
    pub xx: S,
    /// Element yy.
    pub yy: S,
    /// Element zz.
    pub zz: S,
    /// Element xy.
    pub xy: S,
    /// Element yz.
    pub yz: S,
    /// Element xz.
    pub xz: S,
}

impl<S: Scalar> Sym3<S> {
    /// The zero matrix.
    pub fn zero() -> Self {
        Self::from_upper(|_, _| S::zero())
    }

    /// The matrix with `element(i, j)` for i ≤ j.
    #[inline(always)]
    pub fn from_upper(mut element: impl FnMut(usize, usize) -> S) -> Self {
        Sym3 {
            xx: element(0, 0),
            yy: element(1, 1),
            zz: element(2, 2),
            xy: element(0, 1),
            yz: element(1, 2),
            xz: element(0, 2),
        }
    }

    /// All nine elements.
    pub fn full(self) -> Mat3<S> {
        Mat3([[self.xx, self.xy, self.xz], [self.xy, self.yy, self.yz], [self.xz, self.yz, self.zz]])
    }

    /// R A Rᵀ.
    #[inline(always)]
    pub fn rotated(self, rotation: Mat3<S>) -> Self {
        let half = rotation * self.full();
        Self::from_upper(|i, j| Vec3(half.0[i]).dot(Vec3(rotation.0[j])))
    }

    /// R A Rᵀ for the rotation about z with the given cosine and sine.
    ///
    /// With t = (xx − yy) c − 2 xy s, the block in the plane becomes xx' = yy + c t, yy' = xx − c t, xy' = xy + s t:
    /// 15 operations where the triple product takes 75.
    #[inline(always)]
    pub fn rotated_about_z(self, cos: S, sin: S) -> Self {
        let t = (self.xx - self.yy) * cos - (self.xy + self.xy) * sin;
        Sym3 {
            xx: self.yy + cos * t,
            yy: self.xx - cos * t,
            zz: self.zz,
            xy: self.xy + sin * t,
            xz: cos * self.xz - sin * self.yz,
            yz: sin * self.xz + cos * self.yz,
        }
    }

    /// Applies `f` to each element.
    pub fn map<T>(self, f: impl Fn(S) -> T) -> Sym3<T> {
        Sym3 { xx: f(self.xx), yy: f(self.yy), zz: f(self.zz), xy: f(self.xy), yz: f(self.yz), xz: f(self.xz) }
    }
}

impl<S: Scalar> Add for Sym3<S> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        let (a, b) = (self, b);
        Sym3 { xx: a.xx + b.xx, yy: a.yy + b.yy, zz: a.zz + b.zz, xy: a.xy + b.xy, yz: a.yz + b.yz, xz: a.xz + b.xz }
    }
}

impl Sym3<f64> {
    /// The eigenvalues, from smallest to largest, by cyclic Jacobi rotations (Golub, Van Loan, Matrix Computations,
    /// section 8.5). Errors are a few roundings of the largest eigenvalue.
    pub fn eigenvalues(self) -> [f64; 3] {
        /// Convergence is quadratic: after five sweeps, elements off the diagonal are only roundoff.
        const SWEEPS: usize = 10;
        let Mat3(mut a) = self.full();
        for (p, q) in [(0, 1), (0, 2), (1, 2)].into_iter().cycle().take(3 * SWEEPS) {
            if a[p][q] == 0.0 {
                continue;
            }
            // The smaller of the two rotations that make a[p][q] zero, and its tangent.
            let cotangent = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
            let tangent = cotangent.signum() / (cotangent.abs() + cotangent.hypot(1.0));
            let cos = 1.0 / tangent.hypot(1.0);
            let sin = tangent * cos;
            let (shift, r) = (tangent * a[p][q], 3 - p - q);
            (a[p][p], a[q][q]) = (a[p][p] - shift, a[q][q] + shift);
            let (rp, rq) = (cos * a[r][p] - sin * a[r][q], sin * a[r][p] + cos * a[r][q]);
            [a[r][p], a[p][r], a[r][q], a[q][r], a[p][q], a[q][p]] = [rp, rp, rq, rq, 0.0, 0.0];
        }
        let mut eigenvalues = [a[0][0], a[1][1], a[2][2]];
        eigenvalues.sort_by(f64::total_cmp);
        eigenvalues
    }
}

/// Mass, first moment and inertia tensor of a rigid body about the origin of a frame, in its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidInertia<S> {
    /// Mass, kg.
    pub mass: S,
    /// First moment, mass times centre of mass, kg m.
    pub moment: Vec3<S>,
    /// Inertia tensor about the origin, kg m².
    pub tensor: Sym3<S>,
}

impl<S: Scalar> RigidInertia<S> {
    /// I v, the momentum at a velocity: angular about the origin, and linear.
    pub fn momentum(&self, Twist { angular, linear }: Twist<S>) -> Wrench<S> {
        Wrench {
            moment: self.tensor.full().fused_product(angular) + self.moment.fused_cross(linear),
            force: linear.scale(self.mass) + angular.fused_cross(self.moment),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rotation::about_z;

    #[test]
    fn eigenvalues_do_not_depend_on_the_axes() {
        let turned_over = Mat3([[0.0, 0.6, 0.8], [1.0, 0.0, 0.0], [0.0, 0.8, -0.6]]);
        for expected in [[1.0, 2.0, 3.0], [-1.0, 0.5, 0.5], [1e-9, 1.0, 1.0], [2.0, 2.0, 2.0]] {
            let diagonal = Sym3 { xx: expected[1], yy: expected[2], zz: expected[0], ..Sym3::zero() };
            for angle in [0.0, 0.3, -1.1, 2.9] {
                let rotation = about_z(angle) * turned_over * about_z(0.7 * angle);
                let found = diagonal.rotated(rotation).eigenvalues();
                for (found, expected) in found.iter().zip(expected) {
                    assert!((found - expected).abs() < 8.0 * f64::EPSILON * 3.0, "{found} instead of {expected}");
                }
            }
        }
    }
}
