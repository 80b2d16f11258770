//! What compiled mechanisms stand on: scalars and their maths, the traits a mechanism implements,
//! integrators, trajectories and torque laws.
//!
//! The crate is `no_std` and allocates nothing. Vectors are arrays whose length comes from the type; with the
//! feature `alloc`, `Vec` may stand in for them where sizes are known only at run time (the generic path).
//!
//! ```
//! # #[cfg(feature = "simulation")] {
//! use redysim_runtime::{Integrator, Ode, Ode45};
//!
//! /// An oscillator of one radian per second.
//! struct Oscillator;
//!
//! impl Ode<f64, [f64; 2]> for Oscillator {
//!     fn derivative(&mut self, _t: f64, y: &[f64; 2], rate: &mut [f64; 2]) {
//!         *rate = [y[1], -y[0]];
//!     }
//! }
//!
//! let end = Ode45::new().rtol(1e-9).solve(&mut Oscillator, (0.0, 1.0), [1.0, 0.0], [], |_, _| {}).unwrap();
//! assert!((end.y[0] - 1.0_f64.cos()).abs() < 1e-8);
//! # }
//! ```
//!
//! | for | see |
//! |---|---|
//! | a mechanism | [`Mechanism`], [`ConfigurationSpace`], a trait for each [`Function`]; [`Operations`] |
//! | numbers | [`Scalar`] and [`Real`]; [`Dual`] for derivatives; [`lanes`], several numbers side by side |
//! | motion in time | [`Integrator`] and the methods, [`integrate`]; [`ForwardSimulation`], [`HybridSimulation`] |
//! | what drives it | [`TorqueLaw`], [`Trajectory`] |
//! | contact | [`Contact`] of a frame with the ground; [`Grounded`], a mechanism with contacts |
//! | tasks | [`OperationalSpace`]: inertia, inverse and null space of a task, such as a frame's motion |
//! | closed loops | [`ClosedLoop`]: constraint forces, assembly and projection; simulation and inverse dynamics |
//! | many states | [`batch`], on all cores; [`Dispatched`], by the best instructions that the processor has |
//!
//! # Lengths
//!
//! The length of an array is part of its type. The length of a slice or a `Vec` is checked where it enters, and one
//! that is wrong is named by a [`LengthMismatch`] or an error of the type that is built: when a trajectory is built, a
//! batch is computed, inverse dynamics of loops are computed, or an integration begins ([`Ode::check_lengths`],
//! [`TorqueLaw::check_lengths`]). Functions of a mechanism whose result is a vector cannot return an error: with a
//! `Vec` of wrong length, they panic with the same words.
//!
//! # Features
//!
//! - `simulation` (default): integrators, trajectories, torque laws, and the closed-loop solves that need them.
//! - `lanes` (default): [`lanes`], and several angles of one state at a time.
//! - `alloc`: `Vec` for vectors. `std`: [`batch`] and [`Dispatched`].
//! - `deterministic`: products and sums are never fused, so that every target gives the same bits.
#![no_std]
// docs.rs shows which feature an item needs.
#![cfg_attr(docsrs, feature(doc_cfg))]
// Parts of the constraint solve serve simulation only.
#![cfg_attr(not(feature = "simulation"), allow(dead_code, unused_imports))]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

#[cfg(feature = "std")]
pub mod batch;
mod branches;
mod closed_loop;
#[cfg(feature = "simulation")]
mod contact;
#[cfg(feature = "simulation")]
mod control;
#[cfg(feature = "std")]
mod dispatch;
mod dual;
#[cfg(feature = "simulation")]
mod exponential;
mod floats;
mod frames;
pub mod function;
#[cfg(feature = "simulation")]
mod hybrid_simulation;
#[cfg(feature = "simulation")]
pub mod integrate;
mod joint_trig;
#[cfg(feature = "lanes")]
pub mod lanes;
mod linear_algebra;
mod matrix;
mod mechanism;
mod operational_space;
mod operations;
mod parameters;
#[cfg(feature = "lanes")]
mod registers;
mod scalar;
#[cfg(feature = "simulation")]
mod simulate;
mod sines;
#[cfg(feature = "simulation")]
mod tangent;
#[cfg(feature = "simulation")]
mod trajectory;
mod trigonometry;
mod vector;
#[cfg(any(feature = "simulation", feature = "std"))]
mod wrapper;

#[doc(hidden)]
pub use branches::{Branches, SideBySide};
pub use closed_loop::{
    Assembly, ClosedLoop, ConstrainedHybridMotion, ConstrainedMotion, IndependentMotion, LoopError, NamedLoopError,
    Projection,
};
#[cfg(feature = "simulation")]
pub use closed_loop::{
    ClosedLoopComputedTorque, ClosedLoopHybridSimulation, ClosedLoopInverse, ClosedLoopSimulation, ForcedMotion,
    LoopForces, Stabilisation,
};
#[cfg(feature = "simulation")]
pub use contact::{
    AnyContactLaw, Contact, ContactError, ContactEvent, ContactLaw, ContactRule, GroundPlane, Grounded,
    HuntCrossleyContact, NormalForce, ReDySimContact, Reaction,
};
#[cfg(feature = "simulation")]
pub use control::{
    Compensation, ComputedTorque, FrameGains, FrameTrajectory, HybridComputedTorque, Impedance, Limited, Pd, PdGravity,
    Pid, Proportional, ProportionalDerivative, TorqueLaw, TrackingPd, ZeroTorque, tracking_rates, uniform,
};
#[cfg(feature = "std")]
pub use dispatch::{Dispatch, Dispatched, Instructions};
pub use dual::{Dual, coordinate_rates_tangent, forward_dynamics_tangent, inverse_dynamics_tangent};
pub use frames::{FrameAcceleration, FrameJacobian, FrameState, Frames, Wrench};
pub use function::set::Functions;
pub use function::table::{Function, Operations};
#[cfg(feature = "simulation")]
pub use hybrid_simulation::HybridSimulation;
#[cfg(feature = "simulation")]
pub use integrate::root::*;
pub use joint_trig::JointTrig;
pub use linear_algebra::RowSet;
#[doc(hidden)]
pub use matrix::{Elements, Rows, Unwritten, WritingOrder, Written, write_matrix};
pub use mechanism::{
    Arguments, BiasForces, CenterOfMass, ConfigurationSpace, CoriolisMatrix, Energy, ForwardDynamics, GravityForces,
    HybridDynamics, HybridMotion, InverseDynamics, LinkKinematics, LinkState, LoopClosure, LoopRows, MassCenter,
    MassMatrix, MechanicalEnergy, Mechanism, Momentum, PassiveForces, TotalMomentum, TreeDynamics, VelocityCoordinates,
};
pub use operational_space::{OperationalSpace, OperationalSpaceError, TaskStatus};
pub use operations::OperationCount;
pub use parameters::{Lift, ParameterError, ParameterRule, check_parameters};
pub use scalar::{FUSED, Real, Scalar};
#[cfg(feature = "simulation")]
pub use simulate::{ForwardSimulation, SimulationState};
#[doc(hidden)]
pub use sines::{MOST_SINES, Sines, sines_at_once};
#[cfg(feature = "simulation")]
pub use trajectory::{
    ConstantDirection, Cycloid, ManifoldSpline, Motion, SetPoint, TangentTrajectory, Trajectory, TrajectoryError,
    ViaPoints,
};
pub use trigonometry::unfused::unfused_sin_cos;
pub use vector::{LengthMismatch, Vector};
