//! What implicit methods share: the Jacobian of the right-hand side, and linear equations with it.

pub(super) mod jacobian;
pub(super) mod lu;
