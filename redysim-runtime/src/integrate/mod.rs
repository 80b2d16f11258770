//! Integration of ordinary differential equations ẏ = f(t, y), forward or backward in time, without allocation.
//!
//! [`Ode4`], [`Ode5`], [`Dop8`] and [`SemiImplicitEuler`] take steps of one given size; [`Ode45`] and [`Dop853`] choose
//! their steps from tolerances, as MATLAB's `ode45` does. [`Ode15s`] and [`Radau5`] are for stiff equations, [`Gauss4`]
//! and [`Gauss6`] for long conservative motion. Each is an [`Integrator`], and gives the solution between its steps,
//! too. What is integrated is an [`Ode`]: a closure, a [`ForwardSimulation`](crate::ForwardSimulation) of a mechanism,
//! or a [`ClosedLoopSimulation`](crate::ClosedLoopSimulation), which corrects the end of each step.
//!
//! [`solve_with_events`](Integrator::solve_with_events) finds [`Event`]s during the integration, [`stability`] computes
//! before a run how large steps may be, and explicit methods report where an equation is stiff.
//!
//! The parts of an integration are separate, as in OrdinaryDiffEq.jl: a [`Formula`](algorithm::Formula) takes one trial
//! step and keeps its own cache ([`explicit`], [`collocation`]; coefficients in [`tableau`]), a
//! [`StepControl`](step_control::StepControl) chooses sizes from errors, and an
//! [`Integration`](integration::Integration), owned by the `driver` of `fixed` and `adaptive`, has equation,
//! tolerances, time, state and statistics. Another explicit Runge-Kutta pair is another [`Tableau`](tableau::Tableau),
//! another method of any kind another [`Algorithm`](algorithm::Algorithm).

mod adaptive;
pub mod algorithm;
pub mod collocation;
mod complex;
mod dormand_prince;
mod dormand_prince_853;
mod driver;
mod error;
mod events;
pub mod explicit;
mod fixed;
mod implicit;
pub mod integration;
mod integrator;
mod interval;
mod ndf;
mod observer;
mod ode;
mod ode4;
mod save_at;
mod semi_implicit_euler;
pub mod stability;
mod step;
pub mod step_control;
mod stiffness;
pub mod tableau;
mod tolerance;

pub use adaptive::Adaptive;
pub use collocation::gauss::{GaussLegendre2, GaussLegendre3};
pub use collocation::radau::RadauIIA;
pub use dormand_prince::DormandPrince;
pub use dormand_prince_853::DormandPrince853;
pub use events::Direction;
pub use fixed::FixedStep;
pub use ndf::{Bdf, Ndf, NdfFormula};
pub use observer::{Ends, EveryStep, ObservedStep, Observer};
pub use ode::Accepted;
pub use ode4::RungeKutta4;
pub use semi_implicit_euler::{SemiImplicit, SymplecticEuler};
pub use tolerance::Tolerances;
pub(crate) use tolerance::finite;

use root::*;

/// What belongs to the root of the crate.
pub(crate) mod root {
    pub use super::collocation::gauss::{Gauss4, Gauss6};
    pub use super::collocation::radau::Radau5;
    pub use super::dormand_prince::{Ode5, Ode45};
    pub use super::dormand_prince_853::{Dop8, Dop853};
    pub use super::error::IntegrationError;
    pub use super::events::{Event, Occurrence};
    pub use super::integrator::{Integrator, Solution, Statistics};
    pub use super::ndf::Ode15s;
    pub use super::ode::Ode;
    pub use super::ode4::Ode4;
    pub use super::semi_implicit_euler::SemiImplicitEuler;
    pub use super::step::Step;
}
