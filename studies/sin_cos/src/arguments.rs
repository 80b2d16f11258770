//! Which angles are tried.

use std::f64::consts::FRAC_PI_4;

/// A range of angles, of either sign.
#[derive(Clone, Copy)]
pub enum Range {
    /// Up to a quarter turn, evenly.
    QuarterTurn,
    /// Up to 100 rad, evenly: what robots do.
    Hundred,
    /// Up to 10⁵ rad, evenly.
    Even,
    /// From 10⁻⁸ to 10⁵ rad, evenly in their logarithms.
    Logarithmic,
    /// The `f64` next to multiples of π/4 up to 10⁵ rad, and their neighbours.
    Multiples,
    /// Finite numbers, evenly in their bits.
    AnyBits,
    /// The numbers known as hard: in each binade that nearest to a multiple of π/2, from its continued fraction.
    Hard,
}

impl Range {
    pub const ALL: [Self; 7] =
        [Self::QuarterTurn, Self::Hundred, Self::Even, Self::Logarithmic, Self::Multiples, Self::AnyBits, Self::Hard];

    pub fn name(self) -> &'static str {
        match self {
            Self::QuarterTurn => "up to π/4, even",
            Self::Hundred => "up to 100, even",
            Self::Even => "up to 10⁵, even",
            Self::Logarithmic => "10⁻⁸ to 10⁵, even in logarithm",
            Self::Multiples => "beside multiples of π/4 up to 10⁵",
            Self::AnyBits => "all finite numbers, even in bits",
            Self::Hard => "nearest to a multiple of π/2 in each binade, and neighbours",
        }
    }

    /// How many to try, if `wanted` are wanted.
    pub fn count(self, wanted: usize) -> usize {
        match self {
            Self::Hard => HARD.len() * NEIGHBOURS,
            _ => wanted,
        }
    }

    /// Argument `index`, always the same.
    pub fn argument(self, index: usize) -> f64 {
        let bits = mixed(index as u64);
        let unit = (bits >> 12) as f64 / (1_u64 << 52) as f64;
        let sign = if bits & 1 == 0 { 1.0 } else { -1.0 };
        sign * match self {
            Self::QuarterTurn => unit * FRAC_PI_4,
            Self::Hundred => unit * 100.0,
            Self::Even => unit * 1e5,
            Self::Logarithmic => 10.0_f64.powf(13.0 * unit - 8.0),
            Self::Multiples => {
                let multiple = (unit * 1e5 / FRAC_PI_4).round() * FRAC_PI_4;
                f64::from_bits(multiple.max(FRAC_PI_4).to_bits() + ((bits >> 1) & 15) - 8)
            }
            Self::AnyBits => f64::from_bits(mixed(bits) % f64::INFINITY.to_bits()),
            Self::Hard => {
                let bits = HARD[index / NEIGHBOURS];
                f64::from_bits(bits + (index % NEIGHBOURS) as u64 - NEIGHBOURS as u64 / 2)
            }
        }
    }
}

/// Each hard number with as many below and above it.
const NEIGHBOURS: usize = 201;

/// SplitMix64.
fn mixed(index: u64) -> u64 {
    let mut z = index.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The bits of the hard numbers, in hexadecimal, a line each: `python3 hard.py > hard.txt`.
static HARD: std::sync::LazyLock<Vec<u64>> = std::sync::LazyLock::new(|| {
    include_str!("../hard.txt").lines().map(|line| u64::from_str_radix(line, 16).expect("hexadecimal")).collect()
});
