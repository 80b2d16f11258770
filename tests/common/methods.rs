//! Every integrator, one after the other.

use redysim::{Dop8, Dop853, Gauss4, Gauss6, Integrator, Ode4, Ode5, Ode15s, Ode45, Radau5, SemiImplicitEuler};

/// What is to be tried with every method.
pub trait WithMethod {
    fn with(&mut self, name: &str, method: &impl Integrator<f64>);
}

/// All methods with steps of one size.
pub fn every_fixed(step: f64, what: &mut impl WithMethod) {
    what.with("SemiImplicitEuler", &SemiImplicitEuler::new(step));
    what.with("Ode4", &Ode4::new(step));
    what.with("Ode5", &Ode5::new(step));
    what.with("Dop8", &Dop8::new(step));
    what.with("Gauss4", &Gauss4::new(step));
    what.with("Gauss6", &Gauss6::new(step));
}

/// All methods with steps from tolerances.
pub fn every_adaptive(rtol: f64, atol: f64, what: &mut impl WithMethod) {
    what.with("Ode45", &Ode45::new().rtol(rtol).atol(atol));
    what.with("Dop853", &Dop853::new().rtol(rtol).atol(atol));
    what.with("Ode15s", &Ode15s::new().rtol(rtol).atol(atol));
    what.with("Radau5", &Radau5::new().rtol(rtol).atol(atol));
}
