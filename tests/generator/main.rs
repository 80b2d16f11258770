//! The generator, from expressions to source: what it folds and prunes, which way it takes, and how its code reads.

mod derivatives;
mod folding;
mod forward_dynamics;
mod loops;
mod parameters;
mod pruning;
mod source;
mod tracing;
mod verification;
