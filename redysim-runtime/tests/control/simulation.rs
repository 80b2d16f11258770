//! Forward simulation of mechanisms.

use crate::mechanisms::{Arm, Pendulum, distance};
use redysim_runtime::{ForwardSimulation, Integrator, MechanicalEnergy, Ode, Ode5, Ode45, Pd, ZeroTorque};

#[test]
fn a_state_is_coordinates_velocities_and_actuator_energy() {
    let simulation = ForwardSimulation::new(&Arm, ZeroTorque);
    let state = simulation.state(&[1.0, 2.0], &[3.0, 4.0]);
    assert_eq!(state, [1.0, 2.0, 3.0, 4.0, 0.0]);
    let parts = simulation.split(&[1.0, 2.0, 3.0, 4.0, 5.0]);
    assert_eq!((parts.q, parts.v, parts.actuator_energy), ([1.0, 2.0], [3.0, 4.0], 5.0));
}

#[test]
fn the_rate_of_a_state_is_velocities_accelerations_and_power() {
    let mut simulation = ForwardSimulation::new(&Arm, |_t: f64, _q: &[f64; 2], _v: &[f64; 2]| [10.0, -1.0]);
    let mut rate = [f64::NAN; 5];
    simulation.derivative(0.0, &[0.1, 0.2, 3.0, 4.0, 7.0], &mut rate);
    assert_eq!(rate[..2], [3.0, 4.0]);
    let a = redysim_runtime::ForwardDynamics::forward_dynamics(&Arm, &[0.1, 0.2], &[3.0, 4.0], &[10.0, -1.0]);
    assert_eq!(rate[2..4], a);
    assert_eq!(rate[4], 10.0 * 3.0 - 4.0);
}

#[test]
fn a_pendulum_returns_after_its_period() {
    let pendulum = Pendulum { mass: 2.0, length: 0.5 };
    let amplitude = 2.0;
    let mut simulation = ForwardSimulation::new(&pendulum, ZeroTorque);
    let start = simulation.state(&[amplitude], &[0.0]);
    let method = Ode45::new().rtol(1e-13).atol(1e-13);
    let end = method.integrate(&mut simulation, (0.0, pendulum.period(amplitude)), start).unwrap();
    println!("{:e} after one period, {:?}", distance(&end.y, &start), end.statistics);
    assert!(distance(&end.y, &start) < 1e-12, "{:?}", end.y);
}

/// Free fall of the double pendulum, against Taylor series in 30 digits.
#[test]
fn a_double_pendulum_keeps_twelve_digits() {
    let mut simulation = ForwardSimulation::new(&Arm, ZeroTorque);
    let start = simulation.state(&[1.5, 0.0], &[0.0, 0.0]);
    let one = [-1.1616193325711432, 0.2828795540069356, -2.4802674785981327, 0.38183581283238055, 0.0];
    let three = [1.0246684402533335, -1.209018063238871, -3.76230033218688, 6.156600784775332, 0.0];
    let check = |name: &str, t: f64, y: &[f64; 5], bound: f64| {
        let error = distance(y, if t == 1.0 { &one } else { &three });
        println!("{name}: {error:e} at t = {t}");
        assert!(error < bound, "{name} at {t}: {y:?}");
    };
    let adaptive = Ode45::new().rtol(1e-13).atol(1e-13);
    let end = adaptive.solve(&mut simulation, (0.0, 3.0), start, [3.0], |t, y| check("Ode45", t, y, 1e-12)).unwrap();
    println!("{:?}", end.statistics);
    let one = adaptive.integrate(&mut simulation, (0.0, 1.0), start).unwrap();
    check("Ode45", 1.0, &one.y, 1e-12);
    Ode5::new(1e-4).solve(&mut simulation, (0.0, 3.0), start, [1.0, 3.0], |t, y| check("Ode5", t, y, 2e-14)).unwrap();
}

#[test]
fn the_work_of_the_actuators_is_the_change_of_mechanical_energy() {
    let pendulum = Pendulum { mass: 2.0, length: 0.5 };
    let law = Pd { target: [1.0], kp: [20.0], kd: [1.5] };
    let mut simulation = ForwardSimulation::new(&pendulum, law);
    let (q0, v0) = ([-0.5], [2.0]);
    let start = simulation.state(&q0, &v0);
    let parts = ForwardSimulation::new(&pendulum, law);
    let mut largest_work: f64 = 0.0;
    let times = (0..=20).map(|k| f64::from(k) / 10.0);
    Ode45::new()
        .rtol(1e-10)
        .atol(1e-12)
        .max_step(0.01)
        .solve(&mut simulation, (0.0, 2.0), start, times, |t, y| {
            let now = parts.split(y);
            let change = pendulum.energy(&now.q, &now.v).total() - pendulum.energy(&q0, &v0).total();
            largest_work = largest_work.max(now.actuator_energy.abs());
            assert!((now.actuator_energy - change).abs() < 1e-8, "{} and {change} at {t}", now.actuator_energy);
        })
        .unwrap();
    assert!(largest_work > 1.0);
}

#[test]
fn free_motion_conserves_energy_and_needs_no_actuator() {
    let mut simulation = ForwardSimulation::new(&Arm, ZeroTorque);
    let (q0, v0) = ([1.5_f64, 0.3], [0.5, -1.0]);
    let start = simulation.state(&q0, &v0);
    let end = Ode45::new().rtol(1e-10).atol(1e-12).integrate(&mut simulation, (0.0, 3.0), start).unwrap();
    let end = simulation.split(&end.y);
    assert!((Arm.energy(&end.q, &end.v).total() - Arm.energy(&q0, &v0).total()).abs() < 1e-7);
    assert_eq!(end.actuator_energy, 0.0);
}

#[test]
fn single_precision_simulates_too() {
    let mut simulation = ForwardSimulation::new(&Arm, ZeroTorque);
    let start = simulation.state(&[1.5_f32, 0.0], &[0.0, 0.0]);
    let end = Ode45::new().rtol(2e-5).atol(1e-6).integrate(&mut simulation, (0.0, 1.0), start).unwrap();
    assert!((end.y[0] + 1.161_619_3).abs() < 1e-3, "{:?}", end.y);
}

#[test]
fn a_torque_that_is_not_a_number_is_reported_as_the_acceleration_it_spoils() {
    let mut simulation = ForwardSimulation::new(&Arm, |_t: f64, _q: &[f64; 2], _v: &[f64; 2]| [0.0, f64::NAN]);
    let start = simulation.state(&[1.5, 0.0], &[0.0, 0.0]);
    let error = Ode45::new().integrate(&mut simulation, (0.0, 1.0), start).unwrap_err();
    assert_eq!(error, redysim_runtime::IntegrationError::NonFiniteDerivative { t: 0.0, component: 2 });
}
