//! The integrators, by their names and settings.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use redysim_runtime::integrate::{Adaptive, Observer};
use redysim_runtime::{
    Dop8, Dop853, Event, Gauss4, Gauss6, IntegrationError, Integrator, Occurrence, Ode, Ode4, Ode5, Ode15s, Ode45,
    Radau5, SemiImplicitEuler, Solution,
};
use std::ops::ControlFlow;

/// The names of the integrators.
const FIXED: [&str; 6] = ["SemiImplicitEuler", "Ode4", "Ode5", "Dop8", "Gauss4", "Gauss6"];
const ADAPTIVE: [&str; 4] = ["Ode45", "Dop853", "Ode15s", "Radau5"];

/// The method of an integration, and its settings.
#[derive(FromPyObject)]
pub struct Method {
    #[pyo3(item)]
    integrator: String,
    #[pyo3(item)]
    rtol: f64,
    #[pyo3(item)]
    atol: f64,
    #[pyo3(item)]
    max_step: Option<f64>,
    #[pyo3(item)]
    step: Option<f64>,
    /// Times at which a step ends, in order.
    #[pyo3(item)]
    stops: Vec<f64>,
}

/// What is integrated, by whatever method.
pub struct Task<'t, 'e, K, G> {
    pub ode: &'t mut dyn Ode<f64, Vec<f64>>,
    pub interval: (f64, f64),
    pub start: Vec<f64>,
    pub events: &'t mut [Event<'e, f64, Vec<f64>>],
    /// Sees every step.
    pub keeper: &'t mut K,
    pub on_event: G,
}

pub type Solved = Result<Solution<f64, Vec<f64>>, IntegrationError<f64>>;

impl<K, G> Task<'_, '_, K, G>
where
    K: Observer<f64, Vec<f64>>,
    G: FnMut(Occurrence<'_, f64, Vec<f64>>) -> ControlFlow<()>,
{
    fn by(self, method: &impl Integrator<f64>) -> Solved {
        let Task { ode, interval, start, events, keeper, on_event } = self;
        method.run_with_events(ode, interval, start, events, keeper, on_event)
    }
}

impl Method {
    /// # Errors
    /// If the method is unknown, or a setting is missing.
    pub fn check(&self) -> PyResult<()> {
        let name = self.integrator.as_str();
        let message = match (FIXED.contains(&name), ADAPTIVE.contains(&name), self.step) {
            (true, _, None) => format!("{name} takes steps of one size: give `step`, s"),
            (true, ..) if !self.stops.is_empty() => {
                format!("{name} takes steps of one size, which no `stops` change: take Ode45, Dop853, Ode15s or Radau5")
            }
            (_, true, Some(_)) => format!("{name} chooses its steps: give `max_step` in place of `step`"),
            (false, false, _) => {
                format!("integrator must be one of {}, not {name:?}", [&FIXED[..], &ADAPTIVE].concat().join(", "))
            }
            _ if !self.stops.iter().all(|stop| stop.is_finite()) => "`stops` must be finite times, s".to_owned(),
            _ => return Ok(()),
        };
        Err(PyValueError::new_err(message))
    }

    /// The method with these tolerances, largest step and stops.
    fn on<'a, M>(&'a self, method: Adaptive<'a, f64, M>, max_step: f64) -> Adaptive<'a, f64, M> {
        method.rtol(self.rtol).atol(self.atol).max_step(max_step).stops(&self.stops)
    }

    /// Integrates by the method, which is one of those that [`check`](Self::check) knows.
    pub fn run<K, G>(&self, task: Task<'_, '_, K, G>) -> Solved
    where
        K: Observer<f64, Vec<f64>>,
        G: FnMut(Occurrence<'_, f64, Vec<f64>>) -> ControlFlow<()>,
    {
        let max_step = self.max_step.unwrap_or(0.1 * (task.interval.1 - task.interval.0).abs());
        let step = self.step.unwrap_or(f64::NAN);
        match self.integrator.as_str() {
            "SemiImplicitEuler" => task.by(&SemiImplicitEuler::new(step)),
            "Ode4" => task.by(&Ode4::new(step)),
            "Ode5" => task.by(&Ode5::new(step)),
            "Dop8" => task.by(&Dop8::new(step)),
            "Gauss4" => task.by(&Gauss4::new(step)),
            "Gauss6" => task.by(&Gauss6::new(step)),
            "Dop853" => task.by(&self.on(Dop853::new(), max_step)),
            "Ode15s" => task.by(&self.on(Ode15s::new(), max_step)),
            "Radau5" => task.by(&self.on(Radau5::new(), max_step)),
            _ => task.by(&self.on(Ode45::new(), max_step)),
        }
    }
}
