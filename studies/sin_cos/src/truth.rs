//! Sine and cosine to many digits, and how far a `f64` is from them.

use rug::Float;
use rug::float::Special;

/// Digits of the reference, in bits: 53, the 66 that the hardest angle loses to cancellation, and a margin. MPFR rounds
/// correctly, so that the cancellation costs its results nothing; the margin is for the difference.
const PRECISION: u32 = 192;

/// Numbers to work in, so that none is allocated for each angle.
pub struct Truth {
    sin: Float,
    cos: Float,
    difference: Float,
}

impl Truth {
    pub fn new() -> Self {
        let number = || Float::with_val(PRECISION, Special::Zero);
        Self { sin: number(), cos: number(), difference: number() }
    }

    /// The errors of `sin` and `cos` of `angle`, in units in the last place of the true values.
    pub fn errors(&mut self, angle: f64, sin: f64, cos: f64) -> [f64; 2] {
        use rug::Assign;
        self.sin.assign(angle);
        self.sin.sin_cos_mut(&mut self.cos);
        [(sin, &self.sin), (cos, &self.cos)].map(|(found, truth)| {
            self.difference.assign(found - truth);
            let error = self.difference.to_f64().abs() / place(truth.to_f64());
            if error.is_nan() { f64::INFINITY } else { error }
        })
    }
}

/// The distance between neighbouring `f64` about `value`.
fn place(value: f64) -> f64 {
    match value.abs().to_bits() >> 52 {
        exponent @ 53.. => f64::from_bits((exponent - 52) << 52),
        exponent => f64::from_bits(1 << (exponent.max(1) - 1)),
    }
}
