//! Mechanisms some of whose joints follow a motion while the others move: against closed forms, momentum and energy.
#![cfg(feature = "generic")]

use crate::common::models::generic;
use redysim::Real;
use redysim::generic::GenericMechanism;
use redysim::{
    ConfigurationSpace, Cycloid, Dop853, ForwardDynamics, HybridMotion, HybridSimulation, IntegrationError, Integrator,
    LengthMismatch, MechanicalEnergy, Momentum, Motion, Ode, Pd, PdGravity, SetPoint, SimulationState, TorqueLaw,
    TotalMomentum, Trajectory, Vector, ZeroTorque, redysim,
};

redysim! { struct CartPole("models/cart_pole.toml"); }
redysim! { struct Satellite("models/floating_three_link.toml"); }

/// The states at five instants of so many seconds, by a method that leaves hardly more than rounding.
fn states<Y: Vector<f64>>(ode: &mut impl Ode<f64, Y>, end: f64, start: Y) -> Vec<(f64, Y)> {
    let mut states = Vec::new();
    let times = [0.0, 0.25, 0.5, 0.75, 1.0].map(|part| part * end);
    let method = Dop853::new().rtol(1e-13).atol(1e-14);
    method.solve(ode, (0.0, end), start, times, |t, y| states.push((t, y.clone()))).expect("it comes to its end");
    states
}

/// On a cart with the acceleration a, a pole hangs still at θ = π + atan(a/g), and the cart takes the force (M + m) a.
#[test]
fn a_pole_under_a_cart_of_constant_acceleration_hangs_still_along_the_apparent_weight() {
    let along = 3.0_f64;
    let angle = std::f64::consts::PI + (along / 9.81).atan();
    let motion = |t: f64| Motion { q: [0.5 * along * t * t, 0.0], v: [along * t, 0.0], a: [along, 0.0] };
    let mut simulation = HybridSimulation::new(&CartPole, motion, ZeroTorque);
    let start: [f64; 5] = simulation.state(0.0, &[9.0, angle], &[9.0, 0.0]);
    assert_eq!(start, [0.0, angle, 0.0, 0.0, 0.0]);
    for (t, y) in states(&mut simulation, 1.6, start) {
        let SimulationState { q, v, actuator_energy } = simulation.split(t, &y);
        assert!((q[1] - angle).abs() < 1e-12 && v[1].abs() < 1e-11, "{t}: {q:?} {v:?}");
        assert!((q[0] - 0.5 * along * t * t).abs() < 1e-15 && v[0] == along * t, "{t}: {q:?} {v:?}");
        let force = simulation.forced_motion(t, &y).tau;
        assert!((force[0] - 1.2 * along).abs() < 1e-11 && force[1] == 0.0, "{t}: {force:?}");
        assert!((actuator_energy - 1.2 * along * q[0]).abs() < 1e-11, "{t}: {actuator_energy}");
    }
}

/// The copy of a prescribed motion in the state is not what the mechanism moves by.
#[test]
fn the_accelerations_are_those_of_the_motion_whatever_the_state_has_in_its_place() {
    let motion = |t: f64| Motion { q: [t.sin(), 0.0], v: [t.cos(), 0.0], a: [-t.sin(), 0.0] };
    let mut simulation = HybridSimulation::new(&CartPole, motion, ZeroTorque);
    let [mut right, mut wrong] = [[0.0; 5]; 2];
    simulation.derivative(0.7, &[0.7_f64.sin(), 0.3, 0.7_f64.cos(), -2.0, 0.0], &mut right);
    simulation.derivative(0.7, &[5.0, 0.3, -4.0, -2.0, 0.0], &mut wrong);
    assert!(right.iter().zip(&wrong).all(|(right, wrong)| (right - wrong).abs() < 1e-13), "{right:?} {wrong:?}");
    assert_eq!((wrong[0], wrong[2]), (0.7_f64.cos(), -0.7_f64.sin()));
}

#[test]
fn a_satellite_keeps_its_momentum_while_its_arm_follows_a_motion() {
    let arm = Cycloid::new([0.38, -0.62, 1.29], [-1.57, 0.5, 2.0], 4.0).expect("a motion");
    let motion = |t: f64| {
        let Motion { q: [q1, q2, q3], v: [v1, v2, v3], a: [a1, a2, a3] } = arm.at(t);
        Motion {
            q: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, q1, q2, q3],
            v: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, v1, v2, v3],
            a: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, a1, a2, a3],
        }
    };
    let mut simulation = HybridSimulation::new(&Satellite, motion, ZeroTorque);
    let turning = [0.1, -0.05, 0.02, 0.03, 0.02, -0.04, 0.0, 0.0, 0.0];
    let start: [f64; 20] = simulation.state(0.0, &Satellite.neutral(), &turning);
    let parts = states(&mut simulation, 4.0, start);
    let at = |(t, y): &(f64, [f64; 20])| {
        let SimulationState { q, v, actuator_energy } = simulation.split(*t, y);
        (Satellite.momentum(&q, &v), Satellite.energy(&q, &v).total() - actuator_energy)
    };
    let (Momentum { linear, angular }, energy) = at(&parts[0]);
    for part in &parts {
        let (momentum, now) = at(part);
        // Shares of the momentum of a satellite of 500 kg and 83.6 kg m².
        let off = |now: [f64; 3], before: [f64; 3]| (0..3).map(|i| (now[i] - before[i]).abs()).fold(0.0, Real::maximum);
        let [linear, angular] = [off(momentum.linear, linear) / 55.0, off(momentum.angular, angular) / 4.0];
        assert!(linear < 1e-12 && angular < 1e-12, "at {} s: {linear:e}, {angular:e}", part.0);
        assert!((now - energy).abs() < 1e-11 * energy, "at {} s: {now} instead of {energy} J", part.0);
    }
    let HybridMotion { tau, .. } = simulation.forced_motion(2.0, &parts[2].1);
    assert!(tau[..6] == [0.0; 6] && tau[6..].iter().all(|tau| tau.abs() > 1e-3), "{tau:?}");
}

/// A ship whose arm hangs from springs and dampers: the joint of several coordinates is prescribed, the others are not.
#[test]
fn a_free_joint_may_follow_a_motion_while_the_arm_on_it_is_driven() {
    let plain = generic("kr5_floating");
    let mut model = plain.model().clone();
    model.links.iter_mut().for_each(|link| link.actuated = (link.joint_name == "base").into());
    let robot = GenericMechanism::new(model);
    let rates = vec![0.3, -0.1, 0.2, 0.5, -0.4, 0.7, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let motion = |t: f64| {
        let way: Vec<f64> = rates.iter().map(|rate| t * rate).collect();
        Motion { q: plain.integrate(&plain.neutral(), &way), v: rates.clone(), a: vec![0.0; 12] }
    };
    // The base's springs and dampers have no effect: it is prescribed.
    let whole = SetPoint::new(&plain, plain.neutral());
    let kd = [&[40.0; 6][..], &[40.0, 40.0, 20.0, 0.2, 0.05, 1e-4]].concat();
    let kp = kd.iter().map(|kd| 5.0 * kd).collect();
    let mut law = PdGravity { mechanism: &plain, trajectory: whole, kp, kd };
    let mut simulation = HybridSimulation::new(&robot, motion, law.clone());
    let start: Vec<f64> = simulation.extended_state(0.0, &plain.neutral(), &vec![0.0; 12]);
    let parts = states(&mut simulation, 0.8, start);
    let at = |simulation: &HybridSimulation<'_, _, _, _>, (t, y): &(f64, Vec<f64>)| simulation.split(*t, y);
    let SimulationState { q, v, .. } = at(&simulation, &parts[0]);
    let energy = plain.energy(&q, &v).total();
    for part in &parts {
        let SimulationState { q, v, actuator_energy } = at(&simulation, part);
        let expected = motion(part.0);
        assert!(q[..7].iter().zip(&expected.q).all(|(q, expected)| (q - expected).abs() < 1e-15), "{q:?}");
        assert_eq!(v[..6], rates[..6]);
        let HybridMotion { a, tau } = simulation.forced_motion(part.0, &part.1);
        assert_eq!(tau[6..], law.torque(&plain, part.0, &q, &v)[6..]);
        let free = plain.forward_dynamics(&q, &v, &tau);
        assert!(free.iter().zip(&a).all(|(free, a)| (free - a).abs() < 1e-9), "{free:?} instead of {a:?}");
        let now = plain.energy(&q, &v).total() - actuator_energy;
        assert!((now - energy).abs() < 1e-9, "{now} instead of {energy} J at {} s", part.0);
    }
}

#[test]
fn a_motion_without_a_coordinate_for_each_joint_is_reported_before_the_start() {
    let robot = generic("cart_pole");
    let motion = |_: f64| Motion { q: vec![0.0], v: vec![0.0; 2], a: vec![0.0; 2] };
    let law = Pd { target: vec![0.0; 2], kp: vec![1.0; 2], kd: vec![1.0; 2] };
    let mut simulation = HybridSimulation::new(&robot, motion, law);
    let end = Dop853::new().solve(&mut simulation, (0.0, 1.0), vec![0.0; 5], [], |_, _| {});
    let mismatch = LengthMismatch { vector: "trajectory.q", length: 1, expected: 2 };
    assert_eq!(end.map(|_| ()), Err(IntegrationError::WrongLength(mismatch)));
}
