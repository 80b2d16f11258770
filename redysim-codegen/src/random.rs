//! Random numbers that are the same in every run.

/// The generator SplitMix64.
pub struct Random(u64);

impl Random {
    /// The generator that starts at `seed`.
    pub fn new(seed: u64) -> Self {
        Random(seed.wrapping_mul(0x2545_f491_4f6c_dd1d))
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number within ±1; one of the two ends if `at_end`.
    pub fn share(&mut self, at_end: bool) -> f64 {
        let within = 2.0 * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64 - 1.0;
        if at_end { 1.0_f64.copysign(within) } else { within }
    }
}
