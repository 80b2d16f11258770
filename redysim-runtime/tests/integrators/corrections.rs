//! Corrections of the state after accepted steps.

use redysim_runtime::integrate::Accepted;
use redysim_runtime::{IntegrationError, Integrator, Ode, Ode4, Ode5, Ode45};

/// A point on the unit circle, brought back to it after each step; refused from time `until` on.
struct Circle {
    until: f64,
    ends: Vec<(f64, f64)>,
}

impl Circle {
    fn new(until: f64) -> Self {
        Circle { until, ends: vec![] }
    }
}

impl Ode<f64, [f64; 2]> for Circle {
    fn derivative(&mut self, _t: f64, y: &[f64; 2], dydt: &mut [f64; 2]) {
        *dydt = [-y[1], y[0]];
    }

    fn accepted(&mut self, t: f64, step: f64, y: &mut [f64; 2]) -> Accepted {
        self.ends.push((t, step));
        if t >= self.until {
            return Accepted::Refused;
        }
        let radius = y[0].hypot(y[1]);
        *y = y.map(|y| y / radius);
        Accepted::Corrected
    }
}

fn check(method: impl Integrator<f64>, stages: u64) {
    let mut circle = Circle::new(f64::INFINITY);
    let mut previous = [1.0, 0.0];
    let end = method
        .each_step(&mut circle, (0.0, 3.0), [1.0, 0.0], |step| {
            let (y0, y1) = (step.start().1, step.end().1);
            assert_eq!(*y0, previous, "a step begins where the last was corrected to");
            assert!((y1[0].hypot(y1[1]) - 1.0).abs() < 1e-15, "its end is the corrected one: {y1:?}");
            assert_eq!(step.at(step.end().0), *y1);
            let middle = step.at(0.5 * (step.start().0 + step.end().0));
            assert!((middle[0].hypot(middle[1]) - 1.0).abs() < 1e-3);
            previous = *y1;
        })
        .unwrap();
    let took = end.statistics;
    assert_eq!(took.corrections, took.steps);
    assert_eq!(took.evaluations, stages * (took.steps + took.rejected) + took.steps);
    assert_eq!(circle.ends.len() as u64, took.steps, "rejected steps are not shown");
    assert!(circle.ends.iter().all(|&(t, step)| 0.0 < step && step <= t));
    assert!((end.y[1] / end.y[0] - 3.0_f64.tan()).abs() < 1e-3);
}

#[test]
fn each_method_goes_on_from_the_corrected_state() {
    check(Ode4::new(0.1), 4);
    check(Ode5::new(0.1), 6);
    check(Ode45::new().rtol(1e-5).initial_step(1.5).max_step(1.5), 6);
}

#[test]
fn a_refused_state_ends_the_integration() {
    let error = Ode5::new(0.25).integrate(&mut Circle::new(0.5), (0.0, 3.0), [1.0, 0.0]).unwrap_err();
    assert_eq!(error, IntegrationError::Refused { t: 0.5 });
    assert!(error.to_string().contains("last_error"), "{error}");
}

/// ẏ = −2 t y², y = 1/(1 + t²).
#[test]
fn ode4_converges_with_order_four_and_its_answers_between_steps_with_the_cubic() {
    let mut f = |t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = -2.0 * t * y[0] * y[0];
    let mut errors = |h: f64| {
        let mut between = 0.0_f64;
        let end = Ode4::new(h)
            .each_step(&mut f, (0.0, 3.0), [1.0], |step| {
                for theta in [0.2, 0.5, 0.8] {
                    let t = step.start().0 + theta * h;
                    between = between.max((step.at(t)[0] - 1.0 / (1.0 + t * t)).abs());
                }
            })
            .unwrap();
        ((end.y[0] - 0.1).abs(), between)
    };
    let (coarse, fine) = (errors(0.05), errors(0.025));
    let (p, dense) = ((coarse.0 / fine.0).log2(), (coarse.1 / fine.1).log2());
    println!("measured order {p:.3}, {dense:.3} between steps");
    assert!((p - 4.0).abs() < 0.2, "{p}");
    assert!((dense - 4.0).abs() < 0.2, "{dense}");
}
