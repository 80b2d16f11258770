//! The generator, from expressions to source: what it folds and prunes, which way it takes, and how its code reads.

mod derivatives;
mod folding;
#[cfg(feature = "source")]
mod forward_dynamics;
mod loops;
mod parameters;
#[cfg(feature = "source")]
mod pruning;
#[cfg(feature = "source")]
mod source;
mod tracing;
mod verification;
