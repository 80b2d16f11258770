//! The largest stable step of a method, predicted and observed.

use crate::mechanisms::Arm;
use redysim_runtime::integrate::FixedStep;
use redysim_runtime::integrate::stability::{LinearStability, StabilityFunction, StableStep, largest_stable_step};
use redysim_runtime::integrate::tableau::{DORMAND_PRINCE, DORMAND_PRINCE_853, RUNGE_KUTTA_4};
use redysim_runtime::{Dop8, ForwardSimulation, Integrator, Ode, Ode4, Ode5, Pd, SemiImplicitEuler, Step};

type Law = Pd<[f64; 2], [f64; 2]>;

fn held(kp: [f64; 2], kd: [f64; 2]) -> ForwardSimulation<'static, Arm, Law> {
    ForwardSimulation::new(&Arm, Pd { target: [0.0, 0.0], kp, kd })
}

/// Whether a small disturbance of the hanging arm stays small.
fn stays(method: &impl Integrator<f64>, simulation: &mut ForwardSimulation<'_, Arm, Law>, h: f64) -> bool {
    let start = simulation.state(&[1e-6, -1e-6], &[0.0, 0.0]);
    let mut largest: f64 = 0.0;
    let look = |step: &Step<'_, f64, [f64; 5]>| largest = step.end().1[..4].iter().fold(0.0, |l, y| y.abs().max(l));
    method.each_step(simulation, (0.0, 600.0 * h), start, look).is_ok() && largest < 1e-3
}

fn compare<M: LinearStability>(method: impl Fn(f64) -> FixedStep<f64, M>, kp: [f64; 2], kd: [f64; 2]) {
    let mut simulation = held(kp, kd);
    let state = simulation.state(&[0.0, 0.0], &[0.0, 0.0]);
    let predicted = largest_stable_step(&mut simulation, 0.0, &state, &method(1.0)).unwrap();
    let (mut inside, mut outside) = (0.5 * predicted.step, 2.0 * predicted.step);
    assert!(stays(&method(inside), &mut simulation, inside) && !stays(&method(outside), &mut simulation, outside));
    for _ in 0..8 {
        let h = 0.5 * (inside + outside);
        *if stays(&method(h), &mut simulation, h) { &mut inside } else { &mut outside } = h;
    }
    println!("{predicted:?}, observed {inside}");
    assert!((predicted.step / inside - 1.0).abs() < 0.1, "{predicted:?} against {inside}");
}

#[test]
fn the_predicted_limit_of_a_held_arm_is_the_observed_one() {
    let gains = [
        ([100.0, 100.0], [20.0, 20.0]),
        ([1e4, 50.0], [3.0, 60.0]),
        ([400.0, 100.0], [0.5, 0.1]),
        ([1e3, 1e3], [400.0, 10.0]),
        ([100.0, 25.0], [30.0, 3.0]),
    ];
    for (kp, kd) in gains.into_iter().take(if cfg!(debug_assertions) { 2 } else { gains.len() }) {
        compare(Ode4::new, kp, kd);
        compare(Ode5::new, kp, kd);
        compare(Dop8::new, kp, kd);
        compare(SemiImplicitEuler::new, kp, kd);
    }
}

#[test]
fn the_warning_names_the_velocity_whose_gain_is_large() {
    for (velocity, kd) in [(0, [2000.0, 1.0]), (1, [1.0, 300.0])] {
        let mut simulation = held([100.0, 100.0], kd);
        let state = simulation.state(&[0.3, 1.5], &[0.1, 0.2]);
        let warning = simulation.step_warning(&Ode5::new(0.1), 0.0, &state).unwrap().unwrap();
        println!("{warning}");
        assert_eq!(warning.stable.velocity, Some(velocity));
        assert_eq!(warning.stable.component, Some(velocity + 2));
        let message = warning.to_string();
        let [name, step] = [format!("velocity {velocity}"), format!("{:?}", warning.stable.step)];
        for word in ["0.1 s", &name, &step, "lower the gain"] {
            assert!(message.contains(word), "{message:?} lacks {word:?}");
        }
        let h = 0.99 * warning.stable.step;
        assert_eq!(simulation.step_warning(&Ode5::new(h), 0.0, &state).unwrap(), None);
    }
}

#[test]
fn the_stability_function_is_the_exponential_up_to_the_order() {
    let z: (f64, f64) = (-0.02, 0.03);
    let exact = (z.0.exp() * z.1.cos(), z.0.exp() * z.1.sin());
    let size = f64::hypot(z.0, z.1);
    let check = |(re, im): (f64, f64), order: i32| {
        let error = (re - exact.0).hypot(im - exact.1);
        assert!(error < size.powi(order + 1) / 100.0 + 1e-16, "order {order}: {error:e}");
    };
    check(StabilityFunction::new(&RUNGE_KUTTA_4).at(z), 4);
    check(StabilityFunction::new(&DORMAND_PRINCE).at(z), 5);
    check(StabilityFunction::new(&DORMAND_PRINCE_853).at(z), 8);
}

/// |R| of order 5 at −3.3066: 1 − z + … + z⁵/120 + z⁶/600.
#[test]
fn regions_of_stability_reach_as_far_as_published() {
    let reach = |ray: (f64, f64)| {
        [
            StabilityFunction::new(&RUNGE_KUTTA_4).reach(ray),
            StabilityFunction::new(&DORMAND_PRINCE).reach(ray),
            StabilityFunction::new(&DORMAND_PRINCE_853).reach(ray),
        ]
    };
    for (found, expected) in reach((-1.0, 0.0)).into_iter().zip([2.7853, 3.3066, 6.3937]) {
        assert!((found - expected).abs() < 1e-3, "{found} instead of {expected}");
    }
    assert!((reach((0.0, 1.0))[0] - 8.0_f64.sqrt()).abs() < 1e-5);
    // Twice as fast is half as far.
    assert!((2.0 * reach((-2.0, 0.0))[1] - reach((-1.0, 0.0))[1]).abs() < 1e-9);
}

/// Without a tangent of its own, and of a dimension that only the state knows.
#[cfg(feature = "alloc")]
#[test]
fn differences_serve_where_there_is_no_tangent() {
    let mut chain = |_t: f64, y: &Vec<f64>, dydt: &mut Vec<f64>| {
        for i in 0..y.len() {
            let left = if i == 0 { 0.0 } else { y[i - 1] };
            let right = y.get(i + 1).copied().unwrap_or(0.0);
            dydt[i] = 100.0 * (left - 2.0 * y[i] + right);
        }
    };
    let stable = largest_stable_step(&mut chain, 0.0, &vec![0.0; 20], &Ode4::new(1.0)).unwrap();
    let eigenvalue = -400.0 * (20.0 * std::f64::consts::PI / 42.0).sin().powi(2);
    assert!((stable.eigenvalue.0 / eigenvalue - 1.0).abs() < 1e-5, "{stable:?} {eigenvalue}");
    assert!((stable.step * eigenvalue / -2.7853 - 1.0).abs() < 1e-4);
}

#[test]
fn what_neither_swings_nor_is_damped_limits_nothing() {
    let mut growth = |_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| *dydt = [3.0 * y[0], 0.0];
    let stable = largest_stable_step(&mut growth, 0.0, &[1.0, 1.0], &Ode5::new(1.0)).unwrap();
    assert_eq!((stable.step, stable.component), (f64::INFINITY, None));
}

/// The fast mode of a system in which another one falls over limits the step as if it were alone, and a swing that
/// grows by itself limits it as one that does not.
#[test]
fn modes_that_grow_by_themselves_do_not_change_the_largest_step() {
    struct Upright;
    impl Ode<f64, [f64; 4]> for Upright {
        fn derivative(&mut self, _t: f64, y: &[f64; 4], dydt: &mut [f64; 4]) {
            *dydt = [y[2], y[3], 4.0 * y[0], -2500.0 * y[1]];
        }
        fn coordinate_rates(&mut self, _t: f64, y: &[f64; 4], rates: &mut [f64; 4]) -> usize {
            rates[..2].copy_from_slice(&y[2..]);
            2
        }
    }
    let euler = largest_stable_step(&mut Upright, 0.0, &[0.0; 4], &SemiImplicitEuler::new(1.0)).unwrap();
    assert!((euler.step * 50.0 / 2.0 - 1.0).abs() < 0.01, "{euler:?}");
    assert_eq!(euler.velocity, Some(1));
    let four = largest_stable_step(&mut Upright, 0.0, &[0.0; 4], &Ode4::new(1.0)).unwrap();
    assert!((four.step * 50.0 / 8.0_f64.sqrt() - 1.0).abs() < 1e-3, "{four:?}");

    let mut growing = |_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| *dydt = [y[0] + 50.0 * y[1], y[1] - 50.0 * y[0]];
    let four = largest_stable_step(&mut growing, 0.0, &[0.0; 2], &Ode4::new(1.0)).unwrap();
    assert!((four.step * 50.0 / 8.0_f64.sqrt() - 1.0).abs() < 1e-3, "{four:?}");
}

/// A body on a hinge and a slider; the hinge has two coordinates, cosine and sine, for its one velocity.
#[test]
fn the_limiting_velocity_is_found_where_a_joint_has_more_coordinates_than_velocities() {
    struct HingeAndSlider;
    impl Ode<f64, [f64; 5]> for HingeAndSlider {
        fn derivative(&mut self, _t: f64, y: &[f64; 5], dydt: &mut [f64; 5]) {
            let [cosine, sine, x, turning, sliding] = *y;
            *dydt = [-sine * turning, cosine * turning, sliding, -4.0 * sine, -2500.0 * x];
        }
        fn coordinate_rates(&mut self, _t: f64, y: &[f64; 5], rates: &mut [f64; 5]) -> usize {
            let [cosine, sine, _, turning, sliding] = *y;
            *rates = [-sine * turning, cosine * turning, sliding, 0.0, 0.0];
            3
        }
    }
    let rest = [1.0, 0.0, 0.0, 0.0, 0.0];
    let check = |stable: StableStep<f64>, limit: f64| {
        assert_eq!((stable.component, stable.velocity), (Some(4), Some(1)));
        assert!((stable.step * 50.0 / limit - 1.0).abs() < 1e-3, "{stable:?}");
    };
    check(largest_stable_step(&mut HingeAndSlider, 0.0, &rest, &Ode4::new(1.0)).unwrap(), 8.0_f64.sqrt());
    check(largest_stable_step(&mut HingeAndSlider, 0.0, &rest, &SemiImplicitEuler::new(1.0)).unwrap(), 2.0);
}

/// h² ω² + 4 ζ ω h ≤ 4.
#[test]
fn the_semi_implicit_method_is_stable_up_to_the_limit_of_its_map() {
    struct Oscillator(f64, f64);
    impl Ode<f64, [f64; 2]> for Oscillator {
        fn derivative(&mut self, _t: f64, y: &[f64; 2], dydt: &mut [f64; 2]) {
            *dydt = [y[1], -self.0 * self.0 * y[0] - 2.0 * self.1 * self.0 * y[1]];
        }
        fn coordinate_rates(&mut self, _t: f64, y: &[f64; 2], rates: &mut [f64; 2]) -> usize {
            rates[0] = y[1];
            1
        }
    }
    for damping in [0.0, 0.1, 0.9, 1.0, 1.1, 3.0] {
        let method = SemiImplicitEuler::new(1.0);
        let stable = largest_stable_step(&mut Oscillator(50.0, damping), 0.0, &[0.1, 0.0], &method).unwrap();
        let expected = (-2.0 * damping + (4.0 * damping * damping + 4.0).sqrt()) / 50.0;
        assert!((stable.step / expected - 1.0).abs() < 0.01, "ζ = {damping}: {} {expected}", stable.step);
    }
}
