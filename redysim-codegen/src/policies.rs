//! What the generator's choices weigh: every number that is a judgement, with its reason.

/// A sine-cosine pair takes about the time of so many multiplications, on processors and with angles side by side.
pub const PRICE_PER_PAIR: u32 = 20;

/// Past so many operations unrolled code no longer fits an instruction cache of 32 KB, and every operation costs about
/// twice as much: loops are tried.
pub const LONGEST_UNROLLED: u32 = 3000;

/// The longest chain for which the explicit mass matrix is considered at all: it takes O(n³) operations there, and the
/// condition of the matrix costs digits.
pub const LONGEST_CHAIN_BY_FACTORISATION: usize = 25;

/// By how much more the factorisation may lose than the recursion where it takes fewer operations.
pub const MOST_LOST_AGAINST_RECURSION: f64 = 10.0;

/// What the factorisation may lose in any case: less than inputs that are measured or rounded lose.
pub const NEGLIGIBLE_LOSS: f64 = 1e-13;

/// By how much more digits may be lost in another description of the robot than in the model's own: states that are not
/// sampled then keep a factor of four.
pub const MOST_LOST_BY_DESCRIPTION: f64 = 1.5;

/// What is lost in any description: a few roundings.
pub const ROUNDINGS: f64 = 4.0 * f64::EPSILON;
