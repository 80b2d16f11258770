//! Closed loops: cut joints kept together while the mechanism moves.
//!
//! | folder | what it solves |
//! |---|---|
//! | `constraints` | the constraints at one position: J in the metric of M, its rank and its least-norm solutions |
//! | `position` | positions and velocities that satisfy the constraints: Newton's method from a guess, projection |
//! | `dynamics` | accelerations and multipliers |
//! | `hybrid` | accelerations of some joints and forces of the others, given the other way round |
//! | `independent` | the motions that the loops allow, by the independent velocities; frames that move with them |
//! | `inverse` | forces of the actuators for a motion of the independent coordinates |
//! | `simulation` | motion in time; the only part that needs the integrators |
//! | `error` | errors, with the names of loops and joints |

mod constraints;
mod dynamics;
mod error;
mod hybrid;
mod independent;
#[cfg(feature = "simulation")]
mod inverse;
mod position;
#[cfg(feature = "simulation")]
mod simulation;

pub use dynamics::ConstrainedMotion;
pub use error::{LoopError, NamedLoopError};
pub use hybrid::ConstrainedHybridMotion;
pub use independent::IndependentMotion;
#[cfg(feature = "simulation")]
pub use inverse::{ClosedLoopComputedTorque, ClosedLoopInverse, LoopForces};
pub use position::{Assembly, Projection};
#[cfg(feature = "simulation")]
pub use simulation::{ClosedLoopHybridSimulation, ClosedLoopSimulation, ForcedMotion, Stabilisation};

/// A mechanism and the closure of its loops.
///
/// The tree of the mechanism is what [`MassMatrix`](crate::MassMatrix) and [`BiasForces`](crate::BiasForces) describe;
/// [`LoopClosure`](crate::LoopClosure) measures how far its cut joints are apart. A `ClosedLoop` puts both together:
///
/// - [`assemble`](Self::assemble) closes the loops from a guess, [`project`](Self::project) removes drift.
/// - [`dynamics`](Self::dynamics) gives accelerations and constraint forces, and
///   [`ClosedLoopSimulation`](crate::ClosedLoopSimulation) moves the mechanism in time with any integrator.
/// - [`hybrid_dynamics`](Self::hybrid_dynamics) takes the accelerations of some joints and finds their forces;
///   [`ClosedLoopHybridSimulation`](crate::ClosedLoopHybridSimulation) moves these joints as a trajectory has them.
/// - [`independent_motion`](Self::independent_motion) has all velocities, and the Jacobians of frames, by independent
///   ones.
/// - [`ClosedLoopInverse`](crate::ClosedLoopInverse) finds the joint forces for a trajectory of the independent
///   coordinates, which [`ClosedLoopComputedTorque`](crate::ClosedLoopComputedTorque) follows under control.
///
/// Everything is based on one decomposition: the rows of J in the metric of M, split into a part that is independent
/// and a part that is not. So redundant rows and singular positions are ordinary cases. Where M is singular, since a
/// rod has no mass, the metric is that of M + w JᵀJ, in which the closed mechanism is the same.
#[derive(Debug)]
pub struct ClosedLoop<'m, M, C = M> {
    mechanism: &'m M,
    closure: &'m C,
}

impl<M, C> Clone for ClosedLoop<'_, M, C> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<M, C> Copy for ClosedLoop<'_, M, C> {}

impl<'m, M> ClosedLoop<'m, M> {
    /// The loops of a mechanism whose model has cut joints.
    pub fn new(mechanism: &'m M) -> Self {
        Self { mechanism, closure: mechanism }
    }
}

impl<'m, M, C> ClosedLoop<'m, M, C> {
    /// The loops of `mechanism` as `closure` describes them.
    pub fn with_closure(mechanism: &'m M, closure: &'m C) -> Self {
        Self { mechanism, closure }
    }

    /// The mechanism.
    pub fn mechanism(&self) -> &'m M {
        self.mechanism
    }

    /// The closure of its loops.
    pub fn closure(&self) -> &'m C {
        self.closure
    }
}
