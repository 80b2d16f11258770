//! The semi-implicit method of Euler: its rule, its order, and what it does with energy.

use crate::mechanisms::{Arm, Pendulum};
use redysim_runtime::Real;
use redysim_runtime::{
    ForwardDynamics, ForwardSimulation, IntegrationError, Integrator, MechanicalEnergy, Ode, Ode45, SemiImplicitEuler,
    Step, ZeroTorque,
};

/// ẍ = −x.
struct Oscillator;

impl Ode<f64, [f64; 2]> for Oscillator {
    fn derivative(&mut self, _t: f64, y: &[f64; 2], dydt: &mut [f64; 2]) {
        *dydt = [y[1], -y[0]];
    }

    fn coordinate_rates(&mut self, _t: f64, y: &[f64; 2], rates: &mut [f64; 2]) -> usize {
        rates[0] = y[1];
        1
    }
}

#[test]
fn a_step_moves_the_velocities_first_and_then_the_coordinates_with_them() {
    let h = 0.1;
    let mut simulation = ForwardSimulation::new(&Arm, |_: f64, _: &[f64; 2], _: &[f64; 2]| [3.0, -1.0]);
    let (q, v) = ([0.4, -0.7], [1.1, 0.2]);
    let start = simulation.state(&q, &v);
    let a = Arm.forward_dynamics(&q, &v, &[3.0, -1.0]);
    let v_new = [v[0] + h * a[0], v[1] + h * a[1]];
    let expected = [q[0] + h * v_new[0], q[1] + h * v_new[1], v_new[0], v_new[1], h * (3.0 * v[0] - v[1])];
    let end = SemiImplicitEuler::new(h).integrate(&mut simulation, (0.0, h), start).unwrap();
    assert!(crate::mechanisms::distance(&end.y, &expected) < 1e-15, "{:?} instead of {expected:?}", end.y);
    assert_eq!((end.statistics.steps, end.statistics.evaluations), (1, 1));
}

#[test]
fn the_error_is_of_order_one_also_between_the_steps_and_backward() {
    let pendulum = Pendulum { mass: 2.0, length: 0.5 };
    let mut simulation = ForwardSimulation::new(&pendulum, ZeroTorque);
    let exact = Ode45::new().rtol(1e-12).atol(1e-12);
    let mut error = |h: f64, to: f64| {
        let start = simulation.state(&[1.0], &[0.5]);
        let reference = exact.integrate(&mut simulation, (0.0, to), start).unwrap().y;
        let mut found = start;
        let times = [to];
        // The interval goes on by half a step, so that the asked time is within one.
        let end = to + 0.5 * to.signum() * h;
        SemiImplicitEuler::new(h).solve(&mut simulation, (0.0, end), start, times, |_, y| found = *y).unwrap();
        let at_end = SemiImplicitEuler::new(h).integrate(&mut simulation, (0.0, to), start).unwrap().y;
        crate::mechanisms::distance(&found, &reference).max(crate::mechanisms::distance(&at_end, &reference))
    };
    for to in [1.0, -1.0] {
        let p = (error(1e-3, to) / error(5e-4, to)).log2();
        println!("measured order {p:.3}");
        assert!((p - 1.0).abs() < 0.05, "{p}");
    }
}

/// ẍ = 2 cos(t²) − 4 t² x, whose solution is sin(t²).
struct Chirp;

impl Ode<f64, [f64; 2]> for Chirp {
    fn derivative(&mut self, t: f64, y: &[f64; 2], dydt: &mut [f64; 2]) {
        *dydt = [y[1], 2.0 * (t * t).cos() - 4.0 * t * t * y[0]];
    }

    fn coordinate_rates(&mut self, _t: f64, y: &[f64; 2], rates: &mut [f64; 2]) -> usize {
        rates[0] = y[1];
        1
    }
}

#[test]
fn an_equation_that_depends_on_time_is_solved_with_order_one() {
    let error = |h: f64| {
        let end = SemiImplicitEuler::new(h).integrate(&mut Chirp, (0.0, 1.5), [0.0, 0.0]).unwrap();
        (end.y[0] - 2.25_f64.sin()).abs()
    };
    let p = (error(1e-3) / error(5e-4)).log2();
    println!("measured order {p:.3}");
    assert!((p - 1.0).abs() < 0.05, "{p}");
}

/// (q² + v² − h q v)/2 is invariant, so that the energy stays within h/2 of itself, while the explicit method
/// multiplies it by 1 + h² in every step.
#[test]
fn the_energy_of_an_oscillator_swings_but_does_not_grow() {
    let h = 0.1;
    let (mut worst, mut drift): (f64, f64) = (0.0, 0.0);
    let look = |step: &Step<'_, f64, [f64; 2]>| {
        let &[q, v] = step.end().1;
        worst = Real::maximum(worst, (q * q + v * v - 1.0).abs());
        drift = drift.max((q * q + v * v - h * q * v - 1.0).abs());
    };
    SemiImplicitEuler::new(h).each_step(&mut Oscillator, (0.0, 1000.0), [1.0, 0.0], look).unwrap();
    println!("energy within {worst}, modified energy within {drift:e}");
    assert!(worst < 0.06 && worst > 0.04);
    assert!(drift < 1e-13);
    let explicit = (0..10_000).fold([1.0, 0.0], |[q, v]: [f64; 2], _| [q + h * v, v - h * q]);
    assert!(explicit[0].hypot(explicit[1]) > 1e20);
}

#[test]
fn the_energy_of_a_falling_arm_does_not_drift() {
    let mut simulation = ForwardSimulation::new(&Arm, ZeroTorque);
    let start = simulation.state(&[0.5, 0.2], &[0.0, 0.0]);
    let energy = |y: &[f64; 5]| Arm.energy(&[y[0], y[1]], &[y[2], y[3]]).total();
    let mut worst: f64 = 0.0;
    let look =
        |step: &Step<'_, f64, [f64; 5]>| worst = Real::maximum(worst, (energy(step.end().1) - energy(&start)).abs());
    SemiImplicitEuler::new(1e-3).each_step(&mut simulation, (0.0, 100.0), start, look).unwrap();
    println!("energy within {worst} J");
    assert!(worst < 0.1, "{worst}");
}

#[test]
fn an_equation_without_coordinates_is_refused_with_advice() {
    let mut decay = |_t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = -y[0];
    let error = SemiImplicitEuler::new(0.1).integrate(&mut decay, (0.0, 1.0), [1.0]).unwrap_err();
    assert_eq!(error, IntegrationError::NoCoordinates);
    for word in ["0 coordinates", "coordinate_rates", "Ode4"] {
        assert!(error.to_string().contains(word), "{error}");
    }
}
