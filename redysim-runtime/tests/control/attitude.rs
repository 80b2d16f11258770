//! Laws of joints with orientations: a body that turns about its centre of mass.

use crate::mechanisms::{Top, distance};
use redysim_runtime::{
    ConfigurationSpace, ForwardSimulation, Integrator, Motion, Ode45, Pd, Proportional, TorqueLaw, TrackingPd,
};
use std::f64::consts::{PI, TAU};

/// (2, −3, 6)/7
const AXIS: [f64; 3] = [2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0];
const KP: [f64; 3] = [9.0, 7.0, 8.0];
const KD: [f64; 3] = [3.0, 2.5, 3.5];

/// The orientation that a turn by `angle` about the axis leads to from `q`.
fn turned(q: &[f64; 4], angle: f64) -> [f64; 4] {
    Top.integrate(q, &AXIS.map(|a| angle * a))
}

fn somewhere() -> [f64; 4] {
    Top.integrate(&Top.neutral(), &[0.4, -1.0, 0.3])
}

#[test]
fn a_spring_acts_along_the_rotation_vector_to_either_quaternion_of_its_target_the_shorter_way() {
    let q = somewhere();
    for (angle, error) in [(0.5, 0.5), (3.0, 3.0), (4.0, 4.0 - TAU), (-5.0, TAU - 5.0)] {
        let target = turned(&q, angle);
        for target in [target, target.map(|component| -component)] {
            let torque = Proportional { target, kp: KP }.torque(&Top, 0.0, &q, &[1.0; 3]);
            let expected = std::array::from_fn(|i| KP[i] * error * AXIS[i]);
            assert!(distance(&torque, &expected) < 1e-13, "{angle}: {torque:?} instead of {expected:?}");
        }
    }
}

/// Holds the slopes of a law against differences, in all directions of coordinates and velocities.
fn compare_slopes(name: &str, mut law: impl TorqueLaw<f64, Top>) {
    let v = [0.3, -0.7, 1.1];
    for length in [1.0, 1.1] {
        let q = somewhere().map(|component| length * component);
        for direction in 0..7 {
            let along = |by: f64, first: usize, i: usize| if direction == first + i { by } else { 0.0 };
            let mut force = |by: f64| {
                let q = std::array::from_fn(|i| q[i] + along(by, 0, i));
                law.torque(&Top, 0.5, &q, &std::array::from_fn(|i| v[i] + along(by, 4, i)))
            };
            let (h, (ahead, behind)) = (1e-5, (force(1e-5), force(-1e-5)));
            let (dq, dv) = (std::array::from_fn(|i| along(1.0, 0, i)), std::array::from_fn(|i| along(1.0, 4, i)));
            let slope = law.torque_tangent(&Top, 0.5, (&q, &v), (&dq, &dv)).expect("it has one");
            for i in 0..3 {
                // Truncation h²/6 of third derivatives below 1000, rounding 1e-14/h.
                let difference = (ahead[i] - behind[i]) / (2.0 * h);
                assert!((slope[i] - difference).abs() < 2e-7, "{name}, {direction}, {i}: {} {difference}", slope[i]);
            }
        }
    }
}

#[test]
fn slopes_of_forces_are_their_differences_on_the_tangent() {
    for angle in [0.3, 2.0, -3.0] {
        let target = turned(&somewhere(), angle);
        compare_slopes("P", Proportional { target, kp: KP });
        compare_slopes("PD", Pd { target, kp: KP, kd: KD });
        let trajectory = |t: f64| Motion { q: turned(&target, 0.1 * t), v: AXIS.map(|a| 0.1 * a), a: [0.0; 3] };
        compare_slopes("tracking PD", TrackingPd { trajectory, kp: KP, kd: KD });
    }
}

/// The body turns away from its target, past half a turn, where the shorter way changes, and comes there from the other side.
#[test]
fn a_body_under_pd_comes_to_its_target_through_more_than_half_a_turn() {
    let (target, kp) = (somewhere(), 4.0);
    let law = Pd { target, kp: [kp; 3], kd: [1.5; 3] };
    let mut simulation = ForwardSimulation::new(&Top, law);
    let ends = [1.0, -1.0].map(|side| {
        let start = turned(&target, -3.0).map(|component| side * component);
        let state = simulation.state(&start, &AXIS.map(|a| -6.0 * a));
        let (mut along, mut energies) = (Vec::new(), Vec::new());
        let times = (0..=1500).map(|k| 0.02 * f64::from(k));
        let method = Ode45::new().rtol(1e-10).atol(1e-12);
        let end = method
            .solve(&mut simulation, (0.0, 30.0), state, times, |_, y: &[f64; 8]| {
                let (error, v) = (Top.difference(&[y[0], y[1], y[2], y[3]], &target), [y[4], y[5], y[6]]);
                along.push((0..3).map(|i| error[i] * AXIS[i]).sum::<f64>());
                let kinetic = (0..3).map(|i| 0.5 * Top::INERTIA[i] * v[i] * v[i]).sum::<f64>();
                energies.push(kinetic + 0.5 * kp * error.iter().map(|e| e * e).sum::<f64>());
            })
            .expect("it moves")
            .y;
        assert!((along[0] - 3.0).abs() < 1e-12 && along.iter().any(|along| *along < -3.0), "{along:?}");
        assert!(along.iter().all(|along| along.abs() < PI + 1e-9));
        assert!(energies.windows(2).all(|pair| pair[1] < pair[0] + 1e-9), "the damper takes energy: {energies:?}");
        let rest = Top.difference(&[end[0], end[1], end[2], end[3]], &target);
        assert!(rest.iter().chain(&end[4..7]).all(|left| left.abs() < 1e-6), "{rest:?} {end:?}");
        end
    });
    let [one, other] = ends;
    assert!((0..4).all(|i| (one[i] + other[i]).abs() < 1e-9), "{one:?} and {other:?} are the same orientation");
}
