//! A robot under a controller with large gains: fixed steps are stable up to the predicted size, explicit methods say
//! that the equation is stiff, and implicit ones take it in a few hundred evaluations.
#![cfg(feature = "generic")]

use super::free_fall_reference::Kr5;
use redysim::Real;
use redysim::integrate::FixedStep;
use redysim::integrate::stability::{LinearStability, largest_stable_step};
use redysim::{
    Dop853, ForwardSimulation, IntegrationError, Integrator, Ode4, Ode5, Ode15s, Ode45, Pd, Radau5, Solution, TorqueLaw,
};

const DOF: usize = Kr5::NV;
const HOLD: [f64; DOF] = [0.5; DOF];
type Law = Pd<[f64; DOF], [f64; DOF]>;
type State = [f64; 2 * DOF + 1];

fn held(kp: f64, kd: f64) -> ForwardSimulation<'static, Kr5, Law> {
    ForwardSimulation::new(&Kr5, Pd { target: HOLD, kp: [kp; DOF], kd: [kd; DOF] })
}

/// KR5 held against its weight, with gains of each joint's size, those of the wrist times `wrist`.
fn balanced(wrist: f64) -> ForwardSimulation<'static, Kr5, impl TorqueLaw<f64, Kr5>> {
    const KP: [f64; DOF] = [2000.0, 2000.0, 2000.0, 50.0, 50.0, 20.0];
    const KD: [f64; DOF] = [200.0, 200.0, 200.0, 5.0, 5.0, 0.5];
    let weight = Kr5::gravity_forces(&HOLD);
    let share = move |joint: usize| if joint < 3 { 1.0 } else { wrist };
    ForwardSimulation::new(&Kr5, move |_t: f64, q: &[f64; DOF], v: &[f64; DOF]| {
        std::array::from_fn(|i| weight[i] + share(i) * (KP[i] * (HOLD[i] - q[i]) - KD[i] * v[i]))
    })
}

/// Whether a small push dies out, or at least does not grow, within 3,000 steps of size `h`.
fn stays(method: &impl Integrator<f64>, wrist: f64, h: f64) -> bool {
    let mut simulation = balanced(wrist);
    let start = simulation.state(&HOLD.map(|q| q + 1e-7), &[0.0; DOF]);
    let end = method.integrate(&mut simulation, (0.0, 3000.0 * h), start);
    end.is_ok_and(|end| end.y[DOF..2 * DOF].iter().all(|v| v.abs() < 1e-2))
}

/// The largest step that is stable, by trying, to one per cent, and the predicted one.
fn limits<M: LinearStability>(wrist: f64, method: impl Fn(f64) -> FixedStep<f64, M>) -> (f64, f64) {
    let mut simulation = balanced(wrist);
    let state = simulation.state(&HOLD, &[0.0; DOF]);
    let predicted = largest_stable_step(&mut simulation, 0.0, &state, &method(1e-3)).expect("a finite state").step;
    let (mut stable, mut unstable) = (0.5 * predicted, 2.0 * predicted);
    assert!(stays(&method(stable), wrist, stable) && !stays(&method(unstable), wrist, unstable));
    while unstable > 1.01 * stable {
        let middle = 0.5 * (stable + unstable);
        if stays(&method(middle), wrist, middle) {
            stable = middle;
        } else {
            unstable = middle;
        }
    }
    (predicted, stable)
}

/// KR5's hand has 8 g: its gains, not those of the arm, limit the step.
#[test]
fn the_largest_stable_step_is_known_before_the_run_and_named_by_its_joint() {
    let wrists = [1.0, 0.1];
    for wrist in wrists.into_iter().take(if cfg!(debug_assertions) { 1 } else { wrists.len() }) {
        let five = limits(wrist, Ode5::new);
        let four = limits(wrist, Ode4::new);
        for (name, (predicted, observed)) in [("Ode5", five), ("Ode4", four)] {
            println!("wrist {wrist}, {name}: predicted {predicted:.3e} s, observed {observed:.3e} s");
            assert!((predicted / observed - 1.0).abs() < 0.1, "{name}: {predicted:.3e} s, but {observed:.3e} s");
        }
        // The intervals of stability on the real axis: 3.3 for order 5, 2.785 for order 4.
        assert!((five.0 / four.0 / (3.307 / 2.785) - 1.0).abs() < 0.01, "{}", five.0 / four.0);
        let mut simulation = balanced(wrist);
        let state = simulation.state(&HOLD, &[0.0; DOF]);
        let warning = simulation.step_warning(&Ode5::new(1e-3), 0.0, &state).expect("a finite state");
        let warning = warning.expect("a millisecond is too much").to_string();
        println!("{warning}");
        assert!(warning.contains("joint `joint6`"), "{warning}");
        assert!(simulation.step_warning(&Ode5::new(0.9 * five.0), 0.0, &state).expect("a finite state").is_none());
    }
}

fn stiff(method: &impl Integrator<f64>, to: f64) -> Result<Solution<f64, State>, IntegrationError<f64>> {
    let mut simulation = held(1e3, 1e2);
    let start = simulation.state(&[0.0; DOF], &[0.0; DOF]);
    method.integrate(&mut simulation, (0.0, to), start)
}

#[test]
fn explicit_methods_report_that_a_stiff_controller_is_stiff() {
    for outcome in [stiff(&Ode45::new().rtol(1e-6), 1.0), stiff(&Dop853::new().rtol(1e-6), 1.0)] {
        let Err(IntegrationError::Stiff { t, step, remaining }) = outcome else { panic!("{outcome:?}") };
        println!("at {t:e} s, with steps of {step:e} s: {remaining} steps to go");
        assert!(t < 1e-4 && step < 1e-6 && remaining > 5_000_000);
    }
    // Without the test they crawl: ten thousand steps lead less than a millisecond far.
    let crawling = Ode45::new().rtol(1e-6).stiffness_limit(None).max_steps(10_000);
    let Err(IntegrationError::TooManySteps { t, .. }) = stiff(&crawling, 1.0) else { panic!("it cannot be done") };
    assert!(t < 1e-3, "{t:e} s");
}

#[test]
fn implicit_methods_take_a_stiff_controller_in_hundreds_of_evaluations() {
    // What the motors' work is worth is not asked: its component may have any error.
    let mut tolerances = [1e-6; 2 * DOF + 1];
    tolerances[2 * DOF] = 1e9;
    let bdf = stiff(&Ode15s::new().rtol(1e-6).atol_each(&tolerances), 1.0).expect("it is for this");
    let radau = stiff(&Radau5::new().rtol(1e-6).atol_each(&tolerances), 1.0).expect("it is for this");
    let judge = stiff(&Radau5::new().rtol(1e-11).atol(1e-13), 1.0).expect("it is for this");
    for (name, solution) in [("Ode15s", bdf), ("Radau5", radau)] {
        let error = (0..DOF).fold(0.0_f64, |worst, i| Real::maximum(worst, (solution.y[i] - judge.y[i]).abs()));
        println!("{name}: error {error:.1e} rad, {:?}", solution.statistics);
        assert!(error < 1e-5, "{name}: {error:.1e} rad");
        assert!(solution.statistics.evaluations < 900, "{name}: {} evaluations", solution.statistics.evaluations);
    }
}
