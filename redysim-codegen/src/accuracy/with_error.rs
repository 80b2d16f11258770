//! An `f64` with its rounding error, and the operators that do not depend on how the error is kept.

use std::marker::PhantomData;
use std::ops::{Add, AddAssign, Neg, Sub, SubAssign};

/// A number and its rounding error; `Meaning` names what the error is: the [rest](super::double_double) of the number
/// or a [bound](super::rounding).
#[derive(Clone, Copy, Debug)]
pub struct WithError<Meaning> {
    pub(crate) value: f64,
    pub(crate) error: f64,
    meaning: PhantomData<Meaning>,
}

impl<Meaning> WithError<Meaning> {
    pub(super) const fn new(value: f64, error: f64) -> Self {
        WithError { value, error, meaning: PhantomData }
    }
}

impl<Meaning> Sub for WithError<Meaning>
where
    Self: Add<Output = Self> + Neg<Output = Self>,
{
    type Output = Self;
    fn sub(self, b: Self) -> Self {
        self + -b
    }
}

impl<Meaning: Copy> AddAssign for WithError<Meaning>
where
    Self: Add<Output = Self>,
{
    fn add_assign(&mut self, b: Self) {
        *self = *self + b;
    }
}

impl<Meaning: Copy> SubAssign for WithError<Meaning>
where
    Self: Sub<Output = Self>,
{
    fn sub_assign(&mut self, b: Self) {
        *self = *self - b;
    }
}
