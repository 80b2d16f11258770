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
