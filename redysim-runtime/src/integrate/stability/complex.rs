//! Complex numbers, as far as eigenvalues need them.

use core::ops::{Add, Mul, Sub};

use crate::Real;

/// re + i im.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Complex<S> {
    pub re: S,
    pub im: S,
}

impl<S: Real> Complex<S> {
    pub fn real(re: S) -> Self {
        Self { re, im: S::zero() }
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

    pub fn conj(self) -> Self {
        Self { re: self.re, im: -self.im }
    }

    pub fn scale(self, factor: S) -> Self {
        Self { re: self.re * factor, im: self.im * factor }
    }

    pub fn divide(self, other: Self) -> Self {
        let size = other.abs();
        let unit = other.conj().scale(S::one() / size);
        (self * unit).scale(S::one() / size)
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
