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

    /// Links of a tree that grows from the ground, then put in any order: mostly each on the one before, so that chains
    /// get long, else on any, or on the ground. `link` makes the `n`th to grow, given its parent's place in the result.
    pub fn tree<L>(&mut self, count: usize, mut link: impl FnMut(&mut Self, usize, Option<usize>) -> L) -> Vec<L> {
        let mut order: Vec<usize> = (0..count).collect();
        for index in (1..count).rev() {
            order.swap(index, self.below(index + 1));
        }
        let mut links: Vec<Option<L>> = (0..count).map(|_| None).collect();
        for grown in 0..count {
            let parent = if self.below(3) > 0 { grown.checked_sub(1) } else { self.below(grown + 1).checked_sub(1) };
            links[order[grown]] = Some(link(self, grown, parent.map(|parent| order[parent])));
        }
        links.into_iter().flatten().collect()
    }
}
