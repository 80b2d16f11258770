//! Numerical differentiation formulas with corrections of the state and with wrong tangents. `failures.rs` has the
//! errors that every method reports.

use redysim_runtime::IntegrationError::*;
use redysim_runtime::integrate::{Accepted, Adaptive, Bdf, FixedStep};
use redysim_runtime::{Integrator, Ode, Ode15s, Statistics};

/// A problem whose tangents are `tangent` of its state.
struct Told {
    tangent: f64,
    calls: u32,
}

impl Ode<f64, [f64; 1]> for Told {
    fn derivative(&mut self, t: f64, y: &[f64; 1], dydt: &mut [f64; 1]) {
        self.calls += 1;
        dydt[0] = -1e6 * (y[0] - t.cos());
    }

    fn tangent(&mut self, _t: f64, _y: &[f64; 1], direction: &[f64; 1], slope: &mut [f64; 1]) -> bool {
        slope[0] = self.tangent * direction[0];
        true
    }
}

#[test]
fn wrong_tangents_are_reported_or_cost_steps_but_never_the_solution() {
    let run = |tangent: f64, max_steps: u64| {
        let mut told = Told { tangent, calls: 0 };
        let method = Ode15s::new().rtol(1e-6).atol(1e-6).max_steps(max_steps);
        (method.integrate(&mut told, (0.0, 1.0), [2.0]), told.calls)
    };
    for tangent in [f64::NAN, f64::INFINITY] {
        let (outcome, calls) = run(tangent, 1000);
        assert!(matches!(outcome, Err(NonFiniteDerivative { t: 0.0, component: 0 })), "{outcome:?}");
        assert!(calls < 10);
    }
    // Right, nearly right, and useless: as if there were none, the iteration converges for h < 10⁻⁶ only.
    assert!((run(-1e6, 1000).0.unwrap().y[0] - 1.0_f64.cos()).abs() < 1e-5);
    assert!((run(-1.2e6, 1000).0.unwrap().y[0] - 1.0_f64.cos()).abs() < 1e-5);
    let (outcome, calls) = run(0.0, 3000);
    assert!(matches!(outcome, Err(TooManySteps { t, .. }) if t > 1e-4 && t < 0.1), "{outcome:?}");
    assert!(calls < 30_000);
}

/// The first step of order 1 of ẏ = y has the matrix 1 − h.
#[test]
fn a_singular_matrix_asks_for_another_step_size() {
    let mut growth = |_t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = y[0];
    let method = Adaptive::<f64, Bdf>::new().rtol(1e-6).initial_step(1.0).max_step(1.0);
    let end = method.integrate(&mut growth, (0.0, 2.0), [1.0]).unwrap();
    assert!(end.statistics.rejected > 0);
    assert!((end.y[0] / 2.0_f64.exp() - 1.0).abs() < 1e-4, "{:?}", end.y);

    let outcome = FixedStep::<f64, Bdf>::new(1.0).integrate(&mut growth, (0.0, 2.0), [1.0]);
    assert_eq!(outcome, Err(NotConverged { t: 0.0, step: 1.0 }));
    let mut decay = |_t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = -y[0];
    let outcome = FixedStep::<f64, Bdf>::new(1.0).integrate(&mut decay, (2.0, 0.0), [1.0]);
    assert_eq!(outcome, Err(NotConverged { t: 2.0, step: -1.0 }));
}

/// With steps of one size the formulas stay at order 1: BDF is the implicit Euler method.
#[test]
fn steps_of_one_size_are_those_of_the_implicit_euler_method() {
    let mut decay = |_t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = -1e3 * y[0];
    let end = FixedStep::<f64, Bdf>::new(0.01).integrate(&mut decay, (0.0, 0.1), [1.0]).unwrap();
    assert!((end.y[0] * 11.0_f64.powi(10) - 1.0).abs() < 1e-12, "{:?}", end.y);
}

/// A pendulum in Cartesian coordinates, [x, y, ẋ, ẏ], of length 1 and weight 1: accelerations of the two times
/// differentiated constraint. Each accepted step is corrected if `projected`.
struct Pendulum {
    projected: bool,
}

impl Ode<f64, [f64; 4]> for Pendulum {
    fn derivative(&mut self, _t: f64, s: &[f64; 4], dsdt: &mut [f64; 4]) {
        let [x, y, vx, vy] = *s;
        let tension = (vx * vx + vy * vy - y) / (x * x + y * y);
        *dsdt = [vx, vy, -tension * x, -tension * y - 1.0];
    }

    fn accepted(&mut self, _t: f64, _step: f64, s: &mut [f64; 4]) -> Accepted {
        if !self.projected {
            return Accepted::Unchanged;
        }
        let length = s[0].hypot(s[1]);
        let [x, y] = [s[0] / length, s[1] / length];
        let radial = x * s[2] + y * s[3];
        *s = [x, y, s[2] - radial * x, s[3] - radial * y];
        Accepted::Corrected
    }
}

/// Were the past forgotten with each correction, order 1 would take a thousand steps and more.
#[test]
fn small_corrections_leave_the_order_high() {
    for tolerance in [1e-3, 1e-5, 1e-7, 1e-9] {
        let steps = |projected: bool| {
            let method = Ode15s::new().rtol(tolerance).atol(tolerance);
            let end = method.integrate(&mut Pendulum { projected }, (0.0, 10.0), [1.0, 0.0, 0.0, 0.0]).unwrap();
            let took = end.statistics;
            assert_eq!(took.corrections, if projected { took.steps } else { 0 });
            let energy = 0.5 * (end.y[2] * end.y[2] + end.y[3] * end.y[3]) + end.y[1];
            println!("tolerance {tolerance:e}: energy {energy:.1e}, {took:?}");
            took.steps as f64
        };
        let (with, without) = (steps(true), steps(false));
        assert!(with < 1.03 * without, "{with} steps with corrections, {without} without");
    }
}

/// A point that a stiff force keeps near the unit circle, on which it turns: what is corrected is what is stiff.
struct Rim {
    stiffness: f64,
    projected: bool,
}

impl Ode<f64, [f64; 2]> for Rim {
    fn derivative(&mut self, _t: f64, y: &[f64; 2], dydt: &mut [f64; 2]) {
        let pull = self.stiffness * (1.0 - y[0].hypot(y[1]));
        *dydt = [pull * y[0] - y[1], pull * y[1] + y[0]];
    }

    fn accepted(&mut self, _t: f64, _step: f64, y: &mut [f64; 2]) -> Accepted {
        if !self.projected {
            return Accepted::Unchanged;
        }
        let radius = y[0].hypot(y[1]);
        *y = y.map(|y| y / radius);
        Accepted::Corrected
    }
}

#[test]
fn corrections_of_what_is_stiff_cost_less_than_15_percent_more_steps() {
    for stiffness in [1e1, 1e2, 1e3, 1e4] {
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let steps = |projected: bool| {
                let method = Ode15s::new().rtol(tolerance).atol(tolerance);
                let end = method.integrate(&mut Rim { stiffness, projected }, (0.0, 10.0), [1.0, 0.0]).unwrap();
                let error = (end.y[0] - 10.0_f64.cos()).hypot(end.y[1] - 10.0_f64.sin());
                println!("stiffness {stiffness:e}, tolerance {tolerance:e}: {error:.1e}, {:?}", end.statistics);
                assert!(error < 100.0 * tolerance, "{error:e}");
                end.statistics.steps as f64
            };
            let (with, without) = (steps(true), steps(false));
            assert!(with < 1.15 * without, "{with} steps with corrections, {without} without");
        }
    }
}

/// ẏ = −y that is moved by 1 at the end of the first step beyond t = 1.
struct Kicked {
    at: Option<(f64, f64)>,
}

impl Ode<f64, [f64; 1]> for Kicked {
    fn derivative(&mut self, _t: f64, y: &[f64; 1], dydt: &mut [f64; 1]) {
        dydt[0] = -y[0];
    }

    fn accepted(&mut self, t: f64, _step: f64, y: &mut [f64; 1]) -> Accepted {
        if t < 1.0 || self.at.is_some() {
            return Accepted::Unchanged;
        }
        y[0] += 1.0;
        self.at = Some((t, y[0]));
        Accepted::Corrected
    }
}

#[test]
fn after_a_large_correction_the_past_is_that_of_another_solution() {
    for tolerance in [1e-3, 1e-6, 1e-9] {
        let mut kicked = Kicked { at: None };
        let method = Ode15s::new().rtol(tolerance).atol(tolerance);
        let end = method.integrate(&mut kicked, (0.0, 3.0), [1.0]).unwrap();
        let (t, y) = kicked.at.expect("it was kicked");
        let error = (end.y[0] - y * (t - 3.0).exp()).abs();
        let Statistics { steps, rejected, evaluations, .. } = end.statistics;
        println!("tolerance {tolerance:e}: {error:.1e}, {steps} steps, {rejected} rejected, {evaluations} evaluations");
        assert!(error < 10.0 * tolerance, "{error:e}");
        // With the past of the other solution it would take twice as many.
        assert!(rejected <= 10, "{rejected}");
    }
}

/// ẍ = −x whose velocity each step leaves wrong by rounding errors over the distance from x = 0, alternately up and
/// down: as the projection of closed loops does near a singular position.
struct Noisy {
    up: bool,
}

impl Ode<f64, [f64; 2]> for Noisy {
    fn derivative(&mut self, _t: f64, y: &[f64; 2], dydt: &mut [f64; 2]) {
        *dydt = [y[1], -y[0]];
    }

    fn accepted(&mut self, _t: f64, _step: f64, y: &mut [f64; 2]) -> Accepted {
        self.up = !self.up;
        let noise = (1e-12 / y[0].abs()).min(1e-8);
        y[1] += if self.up { noise } else { -noise };
        Accepted::Corrected
    }
}

#[test]
fn corrections_by_noise_that_exceeds_the_tolerance_keep_the_past() {
    let steps = |tolerance: f64| {
        let method = Ode15s::new().rtol(tolerance).atol(tolerance).max_steps(100_000);
        let end = method.integrate(&mut Noisy { up: false }, (0.0, 4.0), [1.0, 0.0]).unwrap();
        println!("tolerance {tolerance:e}: error {:.1e}, {:?}", end.y[0] - 4.0_f64.cos(), end.statistics);
        assert!((end.y[0] - 4.0_f64.cos()).abs() < 1e-7, "{:?}", end.y);
        end.statistics.steps
    };
    let mut looser = steps(3e-11);
    for tolerance in [1e-11, 3e-12, 1e-12, 3e-13, 1e-13] {
        let tighter = steps(tolerance);
        assert!(tighter < 10 * looser, "{tighter} steps at {tolerance:e}, {looser} at three times as much");
        looser = tighter;
    }
}

/// ẏ₁ = cos t + y₂, where the end of every step moves y₂ by 1: the past is that of another solution each time.
struct Switched;

impl Ode<f64, [f64; 2]> for Switched {
    fn derivative(&mut self, t: f64, y: &[f64; 2], dydt: &mut [f64; 2]) {
        *dydt = [t.cos() + y[1], 0.0];
    }

    fn accepted(&mut self, _t: f64, _step: f64, y: &mut [f64; 2]) -> Accepted {
        y[1] = 1.0 - y[1];
        Accepted::Corrected
    }
}

#[test]
fn steps_that_became_small_grow_again_though_each_correction_takes_the_past_away() {
    let method = Ode15s::new().rtol(1e-6).atol(1e-6).initial_step(1e-12).max_steps(10_000);
    let end = method.integrate(&mut Switched, (0.0, 1.0), [0.0, 0.0]).unwrap();
    println!("{:?}", end.statistics);
    assert!(end.statistics.steps < 2000, "{:?}", end.statistics);
}
