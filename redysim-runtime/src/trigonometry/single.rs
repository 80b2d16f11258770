//! Sine and cosine of `f32`, worked out in `f64`: what that costs in width, it saves in the reduction, of which the
//! roundoff needs no care, and in shorter polynomials.
//!
//! The polynomials in r² are of least relative error (found by Remez exchange: 2⁻³⁶ for the sine, 2⁻³¹ for the cosine),
//! so that only the last rounding counts.

use super::angle::Angle;
use super::double::ROUNDER;
use super::reduction;
use super::several::{Kernel, several};
use crate::lanes::{F32x8, F32x16, F64x8, Lanes};
use bytemuck::cast;

/// Sine and cosine of `x` radians.
#[inline]
pub fn sin_cos(x: f32) -> (f32, f32) {
    let (sin, cos) = in_double(f64::from(x));
    (sin as f32, cos as f32)
}

/// Sines and cosines of all `angles`, several at a time.
#[inline(always)]
pub fn sin_cos_all<const N: usize>(angles: [f32; N]) -> ([f32; N], [f32; N]) {
    several::<Single, f32, N>(angles)
}

/// Sine and cosine of `x` radians, in every lane.
#[inline]
pub fn sin_cos_8(x: F32x8) -> (F32x8, F32x8) {
    let (sin, cos) = eight(x.to_array());
    (sin.into(), cos.into())
}

/// Sine and cosine of `x` radians, in every lane.
#[inline]
pub fn sin_cos_16(x: F32x16) -> (F32x16, F32x16) {
    let [low, high]: [[f32; 8]; 2] = cast(x.to_array());
    let ((low_sin, low_cos), (high_sin, high_cos)) = (eight(low), eight(high));
    let both = |low, high| F32x16::from(cast::<[[f32; 8]; 2], [f32; 16]>([low, high]));
    (both(low_sin, high_sin), both(low_cos, high_cos))
}

/// This file's sine and cosine, as [`several`] takes them.
struct Single;

fn eight(angles: [f32; 8]) -> ([f32; 8], [f32; 8]) {
    let (sin, cos) = in_double(F64x8::from(angles.map(f64::from)));
    let narrow = |lanes: F64x8| lanes.to_array().map(|number| number as f32);
    (narrow(sin), narrow(cos))
}

impl Kernel<f32> for Single {
    #[inline(always)]
    fn group<L: Angle + Lanes<f64, W>, const W: usize>(angles: [f32; W]) -> ([f32; W], [f32; W]) {
        let (sin, cos) = in_double(L::from(angles.map(f64::from)));
        let narrow = |lanes: L| <L as Into<[f64; W]>>::into(lanes.apart()).map(|number| number as f32);
        (narrow(sin), narrow(cos))
    }

    #[inline(always)]
    fn one(angle: f32) -> (f32, f32) {
        sin_cos(angle)
    }
}

/// 2²⁰ quarter turns.
const MANY_TURNS: f64 = 1_647_099.0;
/// π/2 in a part of 33 bits, of which multiples up to 2²⁰ are exact, and one of 53.
const HALF_PI: [f64; 2] = [1.5707963267341256, 6.077100506506192e-11];

/// Sine and cosine, to more digits than a `f32` has, of angles that were `f32`: none of those that are not reduced
/// elsewhere comes closer to a multiple of π/2 than the parts of π/2 are good for.
#[inline(always)]
fn in_double<A: Angle>(x: A) -> (A, A) {
    let (rounded, rest) = reduced(x);
    if !x.all_within(A::from_f64(MANY_TURNS)) {
        // The other lanes of a huge angle are reduced as they are when they are alone, to give the same bits.
        return x.one_by_one(|x| {
            let (mut rounded, mut rest) = reduced(x);
            if !x.all_within(MANY_TURNS) {
                let angle = reduction::reduced(x);
                (rounded, rest) = (angle.rounded, angle.rest);
            }
            let (sin, cos) = kernel(rest);
            f64::turned(rounded, sin, cos)
        });
    }
    let (sin, cos) = kernel(rest);
    A::turned(rounded, sin, cos)
}

/// The quarter turns, in the last bits, and what is left, for angles of few turns.
#[inline(always)]
fn reduced<A: Angle>(x: A) -> (A, A) {
    let k = A::from_f64;
    let rounded = x.mul_add(k(core::f64::consts::FRAC_2_PI), k(ROUNDER));
    let minus_n = k(ROUNDER) - rounded;
    (rounded, minus_n.mul_add(k(HALF_PI[1]), minus_n.mul_add(k(HALF_PI[0]), x)))
}

/// (sin r − r) / r³ as a polynomial in r².
const SINE: [f64; 4] = [-0.16666666644211606, 0.008333329327948209, -0.00019839261165637746, 2.7173457518465026e-6];

/// (cos r − 1 + r²/2) / r⁴ as a polynomial in r².
const COSINE: [f64; 3] = [0.04166665464820804, -0.0013887654138661685, 2.4463803885607833e-5];

/// Sine and cosine of r, |r| ≤ π/4.
#[inline(always)]
fn kernel<A: Angle>(r: A) -> (A, A) {
    let k = A::from_f64;
    let z = r * r;
    let squared = z * z;
    let [a, b, c, d] = SINE.map(k);
    let sin = (r * z).mul_add(squared.mul_add(z.mul_add(d, c), z.mul_add(b, a)), r);
    let [a, b, c] = COSINE.map(k);
    let cos = squared.mul_add(squared.mul_add(c, z.mul_add(b, a)), z.mul_add(k(-0.5), k(1.0)));
    (sin, cos)
}
