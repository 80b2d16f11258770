//! Random numbers and states that are the same in every run.

use std::f64::consts::PI;

/// The generator SplitMix64.
pub struct Random(u64);

/// Coordinates, velocities and accelerations.
pub struct State {
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    pub a: Vec<f64>,
}

impl Random {
    pub fn new(seed: u64) -> Self {
        Random(seed)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number below `n`.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n as u64) as usize
    }

    /// A number within ±`bound`.
    pub fn within(&mut self, bound: f64) -> f64 {
        bound * (2.0 * (self.bits() >> 11) as f64 / (1_u64 << 53) as f64 - 1.0)
    }

    /// Numbers within ±`bound`.
    pub fn vector(&mut self, len: usize, bound: f64) -> Vec<f64> {
        (0..len).map(|_| self.within(bound)).collect()
    }

    /// Coordinates within ±π, velocities within ±3, accelerations within ±10.
    pub fn state(&mut self, dof: usize) -> State {
        State { q: self.vector(dof, PI), v: self.vector(dof, 3.0), a: self.vector(dof, 10.0) }
    }
}
