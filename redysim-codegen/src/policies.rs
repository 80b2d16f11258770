//! The weights of the choices between pipelines: which description of a robot, which algorithm, loops or unrolled code.
//!
//! Constants that limit the effort of a single pass, or affect only the layout of the code, are in the files that use
//! them.

/// A division or a square root counts as one operation, as in the flops that the documentation states. It takes several
/// times as long, but this affects few choices: prices are compared before and after a pass and in pruning, which keep
/// the number of divisions; the algorithms for forward dynamics, which have about one for each joint, are compared by
/// flops.
pub const PRICE_PER_DIVISION: u32 = 1;

/// A sine-cosine pair takes about the time of this many multiplications, where the pairs of several angles are computed
/// together.
pub const PRICE_PER_PAIR: u32 = 20;

/// With more operations, unrolled code does not fit an instruction cache of 32 KB, and every operation takes about
/// twice as long: loops are tried.
pub const LONGEST_UNROLLED: u32 = 3000;

/// The fewest groups of uniform bodies that become a loop. With fewer, a loop saves little code: the bodies at either
/// end of a run stay unrolled.
pub const FEWEST_GROUPS: usize = 4;

/// The most bodies in a group. Links that alternate, such as mirrored ones, repeat after two or three; every
/// period that is tried takes another search through the function.
pub const LONGEST_PERIOD: usize = 3;

/// The fewest operations of a function whose branches are computed side by side. With fewer, what is saved is less than
/// a call varies by.
pub const FEWEST_SIDE_BY_SIDE: u32 = 200;

/// Branches are computed side by side if that saves at least one instruction of this many.
pub const LEAST_SAVED_SIDE_BY_SIDE: usize = 4;

/// The longest chain for which the explicit mass matrix is considered at all: it takes O(n³) operations there, and the
/// condition of the matrix costs digits.
pub const LONGEST_CHAIN_BY_FACTORISATION: usize = 25;

/// The loss of the factorisation may exceed that of the recursion by this factor where it takes fewer operations.
pub const MOST_LOST_AGAINST_RECURSION: f64 = 10.0;

/// The loss that the factorisation may always have: less than that of measured or rounded inputs.
pub const NEGLIGIBLE_LOSS: f64 = 1e-13;

/// The loss of another description of the robot may exceed that of the model's own by this factor. States that are not
/// sampled then stay within a factor of four.
pub const MOST_LOST_BY_DESCRIPTION: f64 = 1.5;

/// The loss that every description may have: a few roundings.
pub const ROUNDINGS: f64 = 4.0 * f64::EPSILON;
