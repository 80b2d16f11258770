// Every integrator by its algorithm, for the tests that all of them must pass. A new one joins by one line in each list
// that it belongs to.

/// Calls the generic function `$check::<A>(name)` with every method that chooses its steps from tolerances.
macro_rules! every_adaptive {
    ($check:ident) => {{
        use redysim_runtime::integrate as of;
        $check::<of::DormandPrince>("Ode45");
        $check::<of::DormandPrince853>("Dop853");
        $check::<of::Ndf>("Ode15s");
        $check::<of::Bdf>("Bdf");
        $check::<of::RadauIIA>("Radau5");
    }};
}

/// Calls the generic function `$check::<A>(name)` with every method with steps of one size.
macro_rules! every_fixed {
    ($check:ident) => {{
        use redysim_runtime::integrate as of;
        $check::<of::SymplecticEuler>("SemiImplicitEuler");
        $check::<of::RungeKutta4>("Ode4");
        $check::<of::DormandPrince>("Ode5");
        $check::<of::DormandPrince853>("Dop8");
        $check::<of::GaussLegendre2>("Gauss4");
        $check::<of::GaussLegendre3>("Gauss6");
        $check::<of::Ndf<1>>("Ndf of order 1");
        $check::<of::RadauIIA>("RadauIIA");
    }};
}

/// Calls `$check(name, &method)` with every method: those that choose their steps have the default tolerances, the
/// others steps of size `$step`.
macro_rules! every_method {
    ($check:ident, $step:literal) => {{
        use redysim_runtime::integrate::algorithm::Algorithm;
        use redysim_runtime::integrate::step_control::EstimatesErrors;
        use redysim_runtime::integrate::{Adaptive, FixedStep};
        fn check_adaptive<A: EstimatesErrors>(name: &str) {
            $check(name, &Adaptive::<f64, A>::new());
        }
        fn check_fixed<A: Algorithm>(name: &str) {
            $check(name, &FixedStep::<f64, A>::new($step));
        }
        every_adaptive!(check_adaptive);
        every_fixed!(check_fixed);
    }};
}
