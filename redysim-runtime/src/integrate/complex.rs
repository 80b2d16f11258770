//! Complex numbers, as far as linear equations and eigenvalues need them.

use core::ops::{Add, Div, Mul, Sub};

use super::implicit::lu::Field;
use crate::Real;

/// The number `re` + `im` i.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Complex<S> {
    pub re: S,
    pub im: S,
}

impl<S: Real> Complex<S> {
    pub fn real(re: S) -> Self {
        Self { re, im: S::zero() }
    }

    pub fn conj(self) -> Self {
        Self { re: self.re, im: -self.im }
    }

    pub fn scale(self, factor: S) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }

    /// |z|, without overflow of the squares.
    pub fn abs(self) -> S {
        let (re, im) = (self.re.abs(), self.im.abs());
        let (large, small) = (re.maximum(im), re.minimum(im));
        if small > S::zero() {
            let ratio = small / large;
            large * (S::one() + ratio * ratio).sqrt()
        } else {
            large
        }
    }

    /// The square root with a real part that is not negative.
    pub fn sqrt(self) -> Self {
        let half = S::from_f64(0.5);
        let size = self.abs();
        if size == S::zero() {
            return self;
        }
        let large = (half * (size + self.re.abs())).sqrt();
        let small = half * self.im / large;
        if self.re >= S::zero() {
            Self { re: large, im: small }
        } else {
            let sign = if self.im < S::zero() { -S::one() } else { S::one() };
            Self { re: small.abs(), im: sign * large }
        }
    }
}

impl<S: Real> Add for Complex<S> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { re: self.re + other.re, im: self.im + other.im }
    }
}

impl<S: Real> Sub for Complex<S> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self { re: self.re - other.re, im: self.im - other.im }
    }
}

impl<S: Real> Mul for Complex<S> {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self { re: self.re * other.re - self.im * other.im, im: self.re * other.im + self.im * other.re }
    }
}

impl<S: Real> Div for Complex<S> {
    type Output = Self;

    /// R. L. Smith's division (*Algorithm 116*, Comm. ACM 5 (1962)): the squares of the parts, which may overflow, do
    /// not occur.
    fn div(self, other: Self) -> Self {
        if other.re.abs() >= other.im.abs() {
            let ratio = other.im / other.re;
            let size = other.re + other.im * ratio;
            Self { re: (self.re + self.im * ratio) / size, im: (self.im - self.re * ratio) / size }
        } else {
            let ratio = other.re / other.im;
            let size = other.re * ratio + other.im;
            Self { re: (self.re * ratio + self.im) / size, im: (self.im * ratio - self.re) / size }
        }
    }
}

impl<S: Real> Field for Complex<S> {
    type Magnitude = S;

    /// |re| + |im|, at most √2 times the absolute value.
    fn magnitude(self) -> S {
        self.re.abs() + self.im.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::integrate::implicit::lu::Lu;

    fn c(re: f64, im: f64) -> Complex<f64> {
        Complex { re, im }
    }

    #[test]
    fn division_undoes_multiplication_also_where_squares_overflow() {
        for (a, b) in [(c(1.0, 2.0), c(3.0, -0.5)), (c(-2.0, 0.1), c(0.2, 7.0)), (c(1e200, 2e200), c(3e100, 1e101))] {
            let back = a * b / b;
            assert!((back - a).magnitude() < 1e-15 * a.magnitude(), "{back:?} instead of {a:?}");
        }
        let quotient = c(1e300, 1e300) / c(1e300, -1e300);
        assert!((quotient - c(0.0, 1.0)).magnitude() < 1e-15, "{quotient:?}");
    }

    #[test]
    fn complex_equations_are_solved_by_the_same_decomposition_as_real_ones() {
        let rows = [[c(0.0, 0.0), c(2.0, 1.0)], [c(1.0, -3.0), c(0.5, 0.0)]];
        let x = [c(1.0, 2.0), c(-1.0, 0.25)];
        let mut b = rows.map(|row| row[0] * x[0] + row[1] * x[1]);
        Lu::<Complex<f64>, [Complex<f64>; 2]>::new(rows).unwrap().solve(&mut b);
        for (b, x) in b.into_iter().zip(x) {
            assert!((b - x).magnitude() < 1e-15, "{b:?} instead of {x:?}");
        }
    }
}
