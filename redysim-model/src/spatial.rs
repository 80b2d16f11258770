//! Vectors, rotations and poses in three dimensions, over any scalar.
//!
//! The operators, [`dot`](Vec3::dot) and [`cross`](Vec3::cross) round every product and every sum, so that the constants of
//! a model, which come from them, have the same bits on every processor: what generates code and what runs it may be
//! compiled for different ones. What recursions compute at run time uses [`fused_dot`](Vec3::fused_dot),
//! [`fused_cross`](Vec3::fused_cross) and [`fused_product`](Mat3::fused_product), which take multiply-adds.

use redysim_runtime::Scalar;
use std::ops::{Add, Index, IndexMut, Mul, Neg, Sub};

/// Three components in some frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Vec3<S>(pub [S; 3]);

/// A 3×3 matrix, by rows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Mat3<S>(pub [[S; 3]; 3]);

/// Where a frame stands in another: `rotation` has the frame's axes as columns, `position` is its origin.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Pose<S> {
    /// The frame's axes, as columns.
    pub rotation: Mat3<S>,
    /// The frame's origin, m.
    pub position: Vec3<S>,
}

impl<S: Scalar> Vec3<S> {
    /// The zero vector.
    pub fn zero() -> Self {
        Vec3([S::zero(); 3])
    }

    /// The vector whose component `i` is `component(i)`.
    #[inline(always)]
    pub fn from_fn(mut component: impl FnMut(usize) -> S) -> Self {
        // `std::array::from_fn` compiles to many times as much, for every closure and scalar.
        Vec3([component(0), component(1), component(2)])
    }

    /// Component `i` by comparisons, for an axis that is only known at run time. An index would keep the vector in
    /// memory, where loading it waits for its stores.
    #[inline(always)]
    pub fn component(self, i: usize) -> S {
        let Vec3([x, y, z]) = self;
        match i {
            0 => x,
            1 => y,
            _ => z,
        }
    }

    /// The vector whose component `i` is `value`.
    #[inline(always)]
    pub fn with_component(self, i: usize, value: S) -> Self {
        Self::from_fn(|j| if j == i { value } else { self[j] })
    }

    /// Constants of the model as scalars.
    pub fn constant(value: Vec3<f64>) -> Self {
        Self::from_fn(|i| S::from_f64(value[i]))
    }

    /// Applies `f` to each component.
    #[inline(always)]
    pub fn map<T>(self, f: impl Fn(S) -> T) -> Vec3<T> {
        let Vec3([x, y, z]) = self;
        Vec3([f(x), f(y), f(z)])
    }

    /// aᵀ b.
    pub fn dot(self, b: Self) -> S {
        self[2] * b[2] + (self[1] * b[1] + self[0] * b[0])
    }

    /// a × b.
    pub fn cross(self, b: Self) -> Self {
        self.cross_by(b, |a, b, c| a * b + c)
    }

    /// aᵀ b in multiply-adds.
    #[inline(always)]
    pub fn fused_dot(self, b: Self) -> S {
        self[2].mul_add(b[2], self[1].mul_add(b[1], self[0] * b[0]))
    }

    /// a × b in multiply-adds.
    #[inline(always)]
    pub fn fused_cross(self, b: Self) -> Self {
        self.cross_by(b, S::mul_add)
    }

    #[inline(always)]
    fn cross_by(self, b: Self, multiply_add: impl Fn(S, S, S) -> S) -> Self {
        let a = self;
        let element = |i: usize, j: usize| multiply_add(-a[j], b[i], a[i] * b[j]);
        Vec3([element(1, 2), element(2, 0), element(0, 1)])
    }

    /// The vector times a scalar.
    pub fn scale(self, factor: S) -> Self {
        Self::from_fn(|i| factor * self[i])
    }

    /// The skew-symmetric matrix a× with (a×) b = a × b.
    pub fn skew(self) -> Mat3<S> {
        let (zero, [x, y, z]) = (S::zero(), self.0);
        Mat3([[zero, -z, y], [z, zero, -x], [-y, x, zero]])
    }
}

impl<S: Scalar> Mat3<S> {
    /// The unit matrix.
    pub fn identity() -> Self {
        Self::from_fn(|i, j| if i == j { S::one() } else { S::zero() })
    }

    /// The matrix whose element in row `i` and column `j` is `element(i, j)`.
    #[inline(always)]
    pub fn from_fn(mut element: impl FnMut(usize, usize) -> S) -> Self {
        let mut row = |i| [element(i, 0), element(i, 1), element(i, 2)];
        Mat3([row(0), row(1), row(2)])
    }

    /// The matrix of the rows that `f` makes of this one's.
    #[inline(always)]
    pub(crate) fn map_rows(self, f: impl Fn(Vec3<S>) -> Vec3<S>) -> Self {
        let Mat3([x, y, z]) = self;
        Mat3([f(Vec3(x)).0, f(Vec3(y)).0, f(Vec3(z)).0])
    }

    /// Constants of the model as scalars.
    pub fn constant(value: Mat3<f64>) -> Self {
        Self::from_fn(|i, j| S::from_f64(value.0[i][j]))
    }

    /// The same matrix, of whose elements the compiler does not know that more than three lie side by side. It would load
    /// eight into a vector of 512 bits, which code for one state avoids.
    #[inline(always)]
    pub(crate) fn apart(self) -> Self {
        let Mat3([x, y, z]) = self;
        Mat3([x, S::apart(y), z])
    }

    /// Aᵀ.
    pub fn transpose(self) -> Self {
        Self::from_fn(|i, j| self.0[j][i])
    }

    /// A b in multiply-adds.
    #[inline(always)]
    pub fn fused_product(self, b: Vec3<S>) -> Vec3<S> {
        let rows = self.apart().0;
        Vec3::from_fn(|i| Vec3(rows[i]).fused_dot(b))
    }

    /// Column `j`.
    #[inline(always)]
    pub fn column(self, j: usize) -> Vec3<S> {
        Vec3::from_fn(|i| Vec3(self.0[i]).component(j))
    }

    /// Row `i`.
    #[inline(always)]
    pub fn row(self, i: usize) -> Vec3<S> {
        self.transpose().column(i)
    }
}

impl<S: Scalar> Pose<S> {
    /// The pose of a frame that coincides with its reference.
    pub fn identity() -> Self {
        Pose { rotation: Mat3::identity(), position: Vec3::zero() }
    }

    /// Constants of the model as scalars.
    pub fn constant(value: Pose<f64>) -> Self {
        Pose { rotation: Mat3::constant(value.rotation), position: Vec3::constant(value.position) }
    }

    /// The point with coordinates `point` in the frame, in the reference.
    pub fn transform(self, point: Vec3<S>) -> Vec3<S> {
        self.rotation * point + self.position
    }
}

impl<S: Scalar> Mul for Pose<S> {
    type Output = Pose<S>;
    /// The pose of a frame that stands at `inner` in the frame that stands at `self`.
    fn mul(self, inner: Self) -> Self {
        Pose { rotation: self.rotation * inner.rotation, position: self.transform(inner.position) }
    }
}

impl<S> Index<usize> for Vec3<S> {
    type Output = S;
    fn index(&self, i: usize) -> &S {
        &self.0[i]
    }
}

impl<S> IndexMut<usize> for Vec3<S> {
    fn index_mut(&mut self, i: usize) -> &mut S {
        &mut self.0[i]
    }
}

impl<S: Scalar> Add for Vec3<S> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self::from_fn(|i| self[i] + b[i])
    }
}

impl<S: Scalar> Sub for Vec3<S> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self::from_fn(|i| self[i] - b[i])
    }
}

impl<S: Scalar> Neg for Vec3<S> {
    type Output = Self;
    fn neg(self) -> Self {
        Self::from_fn(|i| -self[i])
    }
}

impl<S: Scalar> Add for Mat3<S> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Self::from_fn(|i, j| self.0[i][j] + b.0[i][j])
    }
}

impl<S: Scalar> Sub for Mat3<S> {
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        Self::from_fn(|i, j| self.0[i][j] - b.0[i][j])
    }
}

impl<S: Scalar> Mul<Vec3<S>> for Mat3<S> {
    type Output = Vec3<S>;
    fn mul(self, b: Vec3<S>) -> Vec3<S> {
        let rows = self.apart().0;
        Vec3::from_fn(|i| Vec3(rows[i]).dot(b))
    }
}

impl<S: Scalar> Mul for Mat3<S> {
    type Output = Self;
    fn mul(self, b: Self) -> Self {
        Self::from_fn(|i, j| Vec3(self.0[i]).dot(b.column(j)))
    }
}

/// A velocity or an acceleration of a body, (ω; v) or (ω̇; a), at the origin of a frame and in its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist<S> {
    /// The angular part.
    pub angular: Vec3<S>,
    /// The part of the point at the origin.
    pub linear: Vec3<S>,
}

/// A moment about the origin of a frame and a force, (n; f), in its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench<S> {
    /// The moment, N m.
    pub moment: Vec3<S>,
    /// The force, N.
    pub force: Vec3<S>,
}

/// Component `i` of two vectors, those of the first one first.
#[inline(always)]
fn component_of_six<S: Scalar>([first, second]: [Vec3<S>; 2], i: usize) -> S {
    if i < 3 { first.component(i) } else { second.component(i - 3) }
}

/// The same vectors with `value` as component `i` of six.
#[inline(always)]
fn with_component_of_six<S: Scalar>([first, second]: [Vec3<S>; 2], i: usize, value: S) -> [Vec3<S>; 2] {
    if i < 3 { [first.with_component(i, value), second] } else { [first, second.with_component(i - 3, value)] }
}

impl<S: Scalar> Twist<S> {
    /// No motion.
    pub fn zero() -> Self {
        Twist { angular: Vec3::zero(), linear: Vec3::zero() }
    }

    /// The rate of a motion that is fixed to a body, v × S at the body's velocity v.
    pub fn rate_in(self, velocity: Twist<S>) -> Self {
        Twist {
            angular: velocity.angular.fused_cross(self.angular),
            linear: velocity.angular.fused_cross(self.linear) + velocity.linear.fused_cross(self.angular),
        }
    }

    /// Component `i` of six, the angular ones first.
    #[inline(always)]
    pub fn component(self, i: usize) -> S {
        component_of_six([self.angular, self.linear], i)
    }

    /// The same with `value` as component `i` of six.
    #[inline(always)]
    pub fn with_component(self, i: usize, value: S) -> Self {
        let [angular, linear] = with_component_of_six([self.angular, self.linear], i, value);
        Twist { angular, linear }
    }
}

impl<S: Scalar> Wrench<S> {
    /// Nothing.
    pub fn zero() -> Self {
        Wrench { moment: Vec3::zero(), force: Vec3::zero() }
    }

    /// Component `i` of six, the moment first.
    #[inline(always)]
    pub fn component(self, i: usize) -> S {
        component_of_six([self.moment, self.force], i)
    }

    /// The same with `value` as component `i` of six.
    #[inline(always)]
    pub fn with_component(self, i: usize, value: S) -> Self {
        let [moment, force] = with_component_of_six([self.moment, self.force], i, value);
        Wrench { moment, force }
    }

    /// The wrench times a scalar.
    pub fn scale(self, factor: S) -> Self {
        Wrench { moment: self.moment.scale(factor), force: self.force.scale(factor) }
    }

    /// The same about another point, from which the point of this one is at `arm`.
    pub fn moved_by(self, arm: Vec3<S>) -> Self {
        Wrench { moment: self.moment + arm.fused_cross(self.force), force: self.force }
    }

    /// The power of the wrench at a motion.
    pub fn dot(self, twist: Twist<S>) -> S {
        self.moment.fused_dot(twist.angular) + self.force.fused_dot(twist.linear)
    }
}

impl<S> From<redysim_runtime::Wrench<S>> for Wrench<S> {
    fn from(redysim_runtime::Wrench { force, moment }: redysim_runtime::Wrench<S>) -> Self {
        Wrench { moment: Vec3(moment), force: Vec3(force) }
    }
}

impl<S: Scalar> Add for Twist<S> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Twist { angular: self.angular + b.angular, linear: self.linear + b.linear }
    }
}

impl<S: Scalar> Add for Wrench<S> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        Wrench { moment: self.moment + b.moment, force: self.force + b.force }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_component_that_is_set_is_the_only_one_that_changes() {
        let (first, second) = (Vec3([1.0, 2.0, 3.0]), Vec3([4.0, 5.0, 6.0]));
        for i in 0..6 {
            let twist = Twist { angular: first, linear: second }.with_component(i, 7.0);
            let wrench = Wrench { moment: first, force: second }.with_component(i, 7.0);
            for j in 0..6 {
                let expected = if i == j { 7.0 } else { 1.0 + j as f64 };
                assert_eq!(twist.component(j), expected, "component {j} of a twist whose component {i} is set");
                assert_eq!(wrench.component(j), expected, "component {j} of a wrench whose component {i} is set");
            }
        }
    }

    #[test]
    fn rows_and_columns_of_a_matrix_are_those_that_are_asked_for() {
        let matrix = Mat3([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]]);
        for i in 0..3 {
            assert_eq!(matrix.row(i).0, matrix.0[i]);
            assert_eq!(matrix.column(i).0, matrix.transpose().0[i]);
        }
    }
}
