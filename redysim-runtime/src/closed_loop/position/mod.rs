//! Positions and velocities that satisfy the constraints.

mod assembly;
mod newton;
mod projection;

pub use assembly::Assembly;
pub(super) use newton::{NewtonSolution, NewtonStatus};
pub(super) use projection::ProjectedPoint;
pub use projection::Projection;
