//! The reduction of angles for which subtracting π/2 in a few parts is not enough.
//!
//! Up to 2²⁰ quarter turns π/2 is subtracted in four parts, with the roundoff of every difference kept; beyond, the
//! digits of 2/π are multiplied that make the fraction of a quarter turn (M. H. Payne and R. N. Hanek, *Radian
//! reduction for trigonometric functions*, SIGNUM Newsletter 18, 1983).

/// x = quarters · π/2 + rest + tail, with |rest| ≤ π/4.
pub struct Reduced<A> {
    /// The quarters in its last bits.
    pub rounded: A,
    pub rest: A,
    pub tail: A,
}

impl<A> Reduced<A> {
    /// The reduction in numbers that `number` makes of these.
    #[inline(always)]
    pub fn map<B>(self, number: impl Fn(A) -> B) -> Reduced<B> {
        Reduced { rounded: number(self.rounded), rest: number(self.rest), tail: number(self.tail) }
    }
}

/// Added to a number below 2⁵¹ and taken away again, it leaves the nearest integer, and shows its bits in between.
pub const ROUNDER: f64 = 6_755_399_441_055_744.0;
/// 2²⁰ quarter turns.
const MOST_BY_PARTS: f64 = 1_647_099.0;

/// The reduction of any angle; NaN where it is not finite.
#[cold]
pub fn reduced(x: f64) -> Reduced<f64> {
    if libm::fabs(x) <= MOST_BY_PARTS { by_parts(x) } else { by_digits(x) }
}

/// π/2 in three parts of 33 bits, of which multiples up to 2²⁰ are exact, and a fourth of 53.
const HALF_PI: [f64; 4] = [1.5707963267341256, 6.077100506303966e-11, 2.0222662487111665e-21, 8.4784276603689e-32];

fn by_parts(x: f64) -> Reduced<f64> {
    let rounded = x * core::f64::consts::FRAC_2_PI + ROUNDER;
    let n = rounded - ROUNDER;
    // The first difference is exact; the others leave their roundoff in the tail.
    let first = x - n * HALF_PI[0];
    let (second, tail_2) = two_difference(first, n * HALF_PI[1]);
    let (third, tail_3) = two_difference(second, n * HALF_PI[2]);
    let tail = (tail_2 + tail_3) - n * HALF_PI[3];
    let rest = third + tail;
    Reduced { rounded, rest, tail: (third - rest) + tail }
}

/// a − b, and the roundoff of the difference (Knuth).
fn two_difference(a: f64, b: f64) -> (f64, f64) {
    let difference = a - b;
    let virtual_b = a - difference;
    (difference, (a - (difference + virtual_b)) + (virtual_b - b))
}

/// The binary digits of 2/π after the point, 64 at a time, behind 64 zeros.
const TWO_OVER_PI_DIGITS: [u64; 22] = [
    0x0000_0000_0000_0000,
    0xa2f9_836e_4e44_1529,
    0xfc27_57d1_f534_ddc0,
    0xdb62_9599_3c43_9041,
    0xfe51_63ab_debb_c561,
    0xb724_6e3a_424d_d2e0,
    0x0649_2eea_09d1_921c,
    0xfe1d_eb1c_b129_a73e,
    0xe882_35f5_2ebb_4484,
    0xe99c_7026_b45f_7e41,
    0x3991_d639_8353_39f4,
    0x9c84_5f8b_bdf9_283b,
    0x1ff8_97ff_de05_980f,
    0xef2f_118b_5a0a_6d1f,
    0x6d36_7ecf_27cb_09b7,
    0x4f46_3f66_9e5f_ea2d,
    0x7527_bac7_ebe5_f17b,
    0x3d07_39f7_8a52_92ea,
    0x6bfb_5fb1_1f8d_5d08,
    0x5603_3046_fc7b_6bab,
    0xf0cf_bc20_9af4_361d,
    0xa9e3_9161_5ee6_1b08,
];

/// π/2 · 2⁶³.
const HALF_PI_DIGITS: u128 = 0xc90f_daa2_2168_c234;

/// The reduction of a number so large that its quarter turns are only known from far down in 2/π.
fn by_digits(x: f64) -> Reduced<f64> {
    let bits = x.to_bits();
    let exponent = (bits >> 52) & 0x7ff;
    if exponent == 0x7ff {
        return Reduced { rounded: f64::NAN, rest: f64::NAN, tail: f64::NAN };
    }
    // |x| = mantissa · 2^(exponent − 1075). Digits of 2/π that this takes to 4 and more only add whole turns; the
    // product with the 256 digits that follow them is the number of quarter turns, with the point after two digits.
    let mantissa = u128::from((bits & ((1 << 52) - 1)) | (1 << 52));
    let skipped = (exponent as usize).saturating_sub(1075 + 2 - 64);
    let word = |index: usize| TWO_OVER_PI_DIGITS.get(skipped / 64 + index).copied().unwrap_or(0);
    let window =
        |index: usize| (((u128::from(word(index)) << 64) | u128::from(word(index + 1))) << (skipped % 64) >> 64) as u64;
    let mut product = [0_u64; 4];
    let mut carry = 0_u128;
    for (index, digits) in product.iter_mut().enumerate().rev() {
        let sum = mantissa * u128::from(window(index)) + carry;
        *digits = sum as u64;
        carry = sum >> 64;
    }
    let [first, second, third, _] = product;
    let fraction = (u128::from((first << 2) | (second >> 62)) << 64) | u128::from((second << 2) | (third >> 62));
    let up = fraction >> 127 == 1;
    let fraction = if up { fraction.wrapping_neg() } else { fraction };
    let zeros = fraction.leading_zeros().min(127);
    let rest = ((fraction << zeros) >> 64) * HALF_PI_DIGITS;
    let rounded = rest as f64;
    let tail = rest.wrapping_sub(rounded as u128) as i128 as f64;
    let scale = power_of_two(-127 - zeros as i32).copysign(if up { -x } else { x });
    let quarters = (first >> 62).wrapping_add(u64::from(up));
    let quarters = if x < 0.0 { quarters.wrapping_neg() } else { quarters };
    Reduced { rounded: f64::from_bits(quarters & 3), rest: rounded * scale, tail: tail * scale }
}

/// 2ⁿ, for a result that is a normal number.
fn power_of_two(n: i32) -> f64 {
    f64::from_bits(((1023 + n) as u64) << 52)
}
