// Equations with known solutions, for the tests of all methods.

use redysim_runtime::{Integrator, Ode, Real, Scalar, Step};

/// Two nonlinear equations that depend on time: ẏ₁ = −2 t y₁², ẏ₂ = cos(t) (1 + y₂²), with the solution
/// 1/(1 + t²), tan(sin t).
pub fn nonlinear<S: Scalar>(t: S, y: &[S; 2], dydt: &mut [S; 2]) {
    dydt[0] = S::from_f64(-2.0) * t * y[0] * y[0];
    dydt[1] = t.sin_cos().1 * (S::one() + y[1] * y[1]);
}

/// The solution of [`nonlinear`].
pub fn exact(t: f64) -> [f64; 2] {
    [1.0 / (1.0 + t * t), t.sin().tan()]
}

/// How far `y` is from the solution of [`nonlinear`] at `t`.
pub fn error_at<S: Real>(t: S, y: &[S; 2]) -> f64 {
    exact(t.to_f64()).into_iter().zip(y).map(|(exact, y)| (y.to_f64() - exact).abs()).fold(0.0, Real::maximum)
}

/// The equation of A. Prothero and A. Robinson, ẏ = λ (y − cos t) − sin t: from y(0) = 1 the solution is cos t, from
/// other starts it soon is.
pub fn prothero_robinson(lambda: f64) -> impl FnMut(f64, &[f64; 1], &mut [f64; 1]) {
    move |t, y, dydt| dydt[0] = lambda * (y[0] - t.cos()) - t.sin()
}

/// The largest errors at the ends of the steps from 0 to 3, and within the steps.
pub fn errors_of_steps<const N: usize>(
    method: impl Integrator<f64>,
    ode: &mut impl Ode<f64, [f64; N]>,
    exact: impl Fn(f64) -> [f64; N],
) -> (f64, f64) {
    let (mut at_ends, mut within) = (0.0_f64, 0.0_f64);
    let error =
        |t: f64, y: &[f64; N]| exact(t).iter().zip(y).fold(0.0_f64, |most, (a, b)| Real::maximum(most, (a - b).abs()));
    let look = |step: &Step<'_, f64, [f64; N]>| {
        let ((from, _), (to, y)) = (step.start(), step.end());
        at_ends = at_ends.max(error(to, y));
        for theta in [0.05, 0.2, 0.4, 0.6, 0.8, 0.95] {
            let t = from + theta * (to - from);
            within = within.max(error(t, &step.at(t)));
        }
    };
    method.each_step(ode, (0.0, 3.0), exact(0.0), look).unwrap();
    (at_ends, within)
}

/// The slope of log(error) over log(size).
pub fn order(coarse: (f64, f64), fine: (f64, f64)) -> f64 {
    (coarse.1 / fine.1).ln() / (coarse.0 / fine.0).ln()
}
