//! The reduction of an `f32` of many turns in integers: the digits of 2/π are multiplied that make the fraction of a
//! quarter turn (M. H. Payne and R. N. Hanek, *Radian reduction for trigonometric functions*, SIGNUM Newsletter 18,
//! 1983).

use super::reduction::Reduced;

/// The binary digits of 2/π after the point, 32 at a time, behind 32 zeros.
const TWO_OVER_PI_DIGITS: [u32; 8] =
    [0x0000_0000, 0xa2f9_836e, 0x4e44_1529, 0xfc27_57d1, 0xf534_ddc0, 0xdb62_9599, 0x3c43_9041, 0xfe51_63ab];

/// π/2 · 2³¹.
const HALF_PI_DIGITS: u64 = 0xc90f_daa2;

/// The reduction of a number of at least 2⁻⁶; NaN where it is not finite.
pub fn by_digits(x: f32) -> Reduced<f32> {
    let bits = x.to_bits();
    let exponent = (bits >> 23) & 0xff;
    if exponent == 0xff {
        return Reduced { rounded: f32::NAN, rest: f32::NAN, tail: f32::NAN };
    }
    // |x| = mantissa · 2^(exponent − 150). Digits of 2/π that this takes to 4 and more only add whole turns; the product
    // with the 96 digits that follow them is the number of quarter turns, with the point after two digits. The digits
    // that are left out are less than 2⁻⁷⁰ of a quarter turn.
    let mantissa = u64::from((bits & 0x7f_ffff) | 0x80_0000);
    let skipped = exponent.saturating_sub(150 + 2 - 32);
    let word = |index: u32| TWO_OVER_PI_DIGITS.get((skipped / 32 + index) as usize).copied().unwrap_or(0);
    let window =
        |index: u32| (((u64::from(word(index)) << 32) | u64::from(word(index + 1))) << (skipped % 32) >> 32) as u32;
    let third = mantissa * u64::from(window(2));
    let second = mantissa * u64::from(window(1)) + (third >> 32);
    let first = (mantissa * u64::from(window(0)) + (second >> 32)) as u32;
    let fraction = (u64::from(first) << 34) | ((second & 0xffff_ffff) << 2) | ((third >> 30) & 3);
    let up = fraction >> 63 == 1;
    let fraction = if up { fraction.wrapping_neg() } else { fraction };
    let zeros = fraction.leading_zeros().min(63);
    // No f32 comes so close to a multiple of π/2 that less than 32 digits were left.
    let digits = ((((fraction << zeros) >> 32) * HALF_PI_DIGITS) >> 32) as u32;
    let rest = digits as f32;
    let tail = digits.wrapping_sub(rest as u32) as i32 as f32;
    let scale = power_of_two(-31 - zeros as i32).copysign(if up { -x } else { x });
    let quarters = (first >> 30).wrapping_add(u32::from(up));
    let quarters = if x < 0.0 { quarters.wrapping_neg() } else { quarters };
    Reduced { rounded: f32::from_bits(quarters & 3), rest: rest * scale, tail: tail * scale }
}

/// 2ⁿ, for a result that is a normal number.
fn power_of_two(n: i32) -> f32 {
    f32::from_bits(((127 + n) as u32) << 23)
}
