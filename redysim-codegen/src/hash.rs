//! A hash for small keys that are asked for often: one multiplication instead of a cryptographic round.
//!
//! Nobody chooses the keys with ill intent, and a build without optimisation, as macros get, spends half its time in
//! the standard hash.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// A map with this hash.
pub type FastMap<K, V> = HashMap<K, V, BuildHasherDefault<Mixing>>;

/// Folds what is written into one word by multiplication with the golden ratio (Knuth's multiplicative hash).
#[derive(Clone, Copy, Debug, Default)]
pub struct Mixing(u64);

impl Hasher for Mixing {
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.write_u64(u64::from(byte));
        }
    }

    fn write_u64(&mut self, word: u64) {
        let mixed = (self.0.rotate_left(23) ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        self.0 = mixed ^ (mixed >> 32);
    }

    fn finish(&self) -> u64 {
        self.0.wrapping_mul(0x9e37_79b9_7f4a_7c15)
    }
}
