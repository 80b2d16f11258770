//! The integrators by their names.

use redysim_model::document::{Field, Reader, Shape};
use redysim_runtime::integrate::{self, Observer, Solution};
use redysim_runtime::{
    Dop853, Gauss4, Gauss6, IntegrationError, Integrator as _, Ode, Ode4, Ode5, Ode15s, Ode45, Radau5,
    SemiImplicitEuler,
};

/// An integrator and its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrator {
    /// Steps of one size, s.
    Fixed(Fixed, f64),
    /// Steps from tolerances.
    Adaptive(Adaptive, Tolerances),
}

/// Methods with steps of one size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fixed {
    SemiImplicitEuler,
    Ode4,
    Ode5,
    Gauss4,
    Gauss6,
}

/// Methods with steps from tolerances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Adaptive {
    Ode45,
    Dop853,
    Ode15s,
    Radau5,
}

/// What keeps the steps of an adaptive method small.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    pub rtol: f64,
    pub atol: f64,
    /// The largest step, s; a tenth of the run unless told.
    pub max_step: Option<f64>,
}

/// MATLAB's defaults.
const USUAL: Tolerances = Tolerances { rtol: 1e-3, atol: 1e-6, max_step: None };

#[derive(Clone, Copy)]
enum Method {
    Fixed(Fixed),
    Adaptive(Adaptive),
}

const FIXED: Shape = Shape { owner: "An integrator with steps of one size", keys: &["method", "step"] };
const ADAPTIVE: Shape =
    Shape { owner: "An integrator with steps from tolerances", keys: &["method", "rtol", "atol", "max_step"] };

const fn fixed(name: &'static str, method: Fixed) -> (&'static str, (Method, &'static Shape)) {
    (name, (Method::Fixed(method), &FIXED))
}

const fn adaptive(name: &'static str, method: Adaptive) -> (&'static str, (Method, &'static Shape)) {
    (name, (Method::Adaptive(method), &ADAPTIVE))
}

/// The names, and behind them other names of the same: the numbers are those of ReDySim's `int_type`.
const METHODS: [(&str, (Method, &Shape)); 13] = [
    fixed("SemiImplicitEuler", Fixed::SemiImplicitEuler),
    fixed("Ode4", Fixed::Ode4),
    fixed("Ode5", Fixed::Ode5),
    fixed("Gauss4", Fixed::Gauss4),
    fixed("Gauss6", Fixed::Gauss6),
    adaptive("Ode45", Adaptive::Ode45),
    adaptive("Dop853", Adaptive::Dop853),
    adaptive("Ode15s", Adaptive::Ode15s),
    adaptive("Radau5", Adaptive::Radau5),
    fixed("Euler", Fixed::SemiImplicitEuler),
    adaptive("0", Adaptive::Ode45),
    adaptive("1", Adaptive::Ode15s),
    fixed("2", Fixed::Ode5),
];

impl Default for Integrator {
    fn default() -> Self {
        Integrator::Adaptive(Adaptive::Ode45, USUAL)
    }
}

impl Integrator {
    /// Reads the table `integrator`.
    pub fn read(reader: &mut Reader<'_, '_>) -> Option<Integrator> {
        let usual = (Method::Adaptive(Adaptive::Ode45), &ADAPTIVE);
        let read = reader.table_of_kind("integrator", "method", &METHODS, usual, |mut reader, method| match method {
            Method::Fixed(method) => {
                let step = reader.positive("step");
                Some(Integrator::Fixed(method, *reader.required("step", step).value()?))
            }
            Method::Adaptive(method) => {
                let [rtol, atol, max_step] = ["rtol", "atol", "max_step"].map(|key| reader.positive(key));
                let max_step = match max_step {
                    Field::Missing => None,
                    given => Some(*given.value()?),
                };
                let tolerances =
                    Tolerances { rtol: rtol.value_or(USUAL.rtol)?, atol: atol.value_or(USUAL.atol)?, max_step };
                Some(Integrator::Adaptive(method, tolerances))
            }
        });
        read.value_or(Some(Integrator::default()))?
    }

    /// Its name.
    pub fn name(&self) -> String {
        match self {
            Integrator::Fixed(method, _) => format!("{method:?}"),
            Integrator::Adaptive(method, _) => format!("{method:?}"),
        }
    }

    /// Integrates `ode` over `interval`.
    ///
    /// # Errors
    /// As [`redysim_runtime::Integrator::run`].
    pub fn run(
        &self,
        ode: &mut dyn Ode<f64, Vec<f64>>,
        interval: (f64, f64),
        start: Vec<f64>,
        observer: &mut impl Observer<f64, Vec<f64>>,
    ) -> Result<Solution<f64, Vec<f64>>, IntegrationError<f64>> {
        match *self {
            Integrator::Fixed(method, step) => match method {
                Fixed::SemiImplicitEuler => SemiImplicitEuler::new(step).run(ode, interval, start, observer),
                Fixed::Ode4 => Ode4::new(step).run(ode, interval, start, observer),
                Fixed::Ode5 => Ode5::new(step).run(ode, interval, start, observer),
                Fixed::Gauss4 => Gauss4::new(step).run(ode, interval, start, observer),
                Fixed::Gauss6 => Gauss6::new(step).run(ode, interval, start, observer),
            },
            Integrator::Adaptive(method, tolerances) => match method {
                Adaptive::Ode45 => tolerances.on(Ode45::new()).run(ode, interval, start, observer),
                Adaptive::Dop853 => tolerances.on(Dop853::new()).run(ode, interval, start, observer),
                Adaptive::Ode15s => tolerances.on(Ode15s::new()).run(ode, interval, start, observer),
                Adaptive::Radau5 => tolerances.on(Radau5::new()).run(ode, interval, start, observer),
            },
        }
    }
}

impl Tolerances {
    fn on<M>(self, method: integrate::Adaptive<'_, f64, M>) -> integrate::Adaptive<'_, f64, M> {
        let method = method.rtol(self.rtol).atol(self.atol);
        match self.max_step {
            Some(size) => method.max_step(size),
            None => method,
        }
    }
}
