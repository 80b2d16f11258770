//! Closed loops with more coordinates than velocities: a slider-crank whose crank has cosine and sine for coordinates
//! does what the one with the angle does.

use crate::slider_crank::{ByAngle, ByCosine, CRANK, ROD, by_cosine};
use redysim_runtime::{
    ClosedLoop, ClosedLoopComputedTorque, ClosedLoopInverse, ClosedLoopSimulation, ComputedTorque, ConfigurationSpace,
    Integrator, LoopClosure, LoopError, Mechanism, Motion, Ode45, Pd, Pid, Proportional, SetPoint, TorqueLaw,
    TrackingPd,
};
use std::f64::consts::TAU;

/// What roundings in two orders leave of numbers below 100, through a few products and one solve of two rows: measured,
/// 2e-14 at most.
const TOLERANCE: f64 = 1e-13;

/// Checks each component.
#[track_caller]
fn close(name: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{name}");
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert!((found - expected).abs() <= tolerance, "{name}[{i}] is {found}, not {expected}");
    }
}

/// A closed position with the crank at `angle`, the rod's tip in front.
fn closed(angle: f64) -> [f64; 3] {
    let rod = -(CRANK * angle.sin() / ROD).asin();
    [angle, rod - angle, CRANK * angle.cos() + ROD * rod.cos()]
}

/// A guess near it.
fn near(angle: f64) -> [f64; 3] {
    let [crank, rod, slider] = closed(angle);
    [crank + 0.02, rod - 0.07, slider + 0.01]
}

const V: [f64; 3] = [1.7, -0.4, 0.9];
const ANGLES: [f64; 5] = [0.3, 1.4, 2.5, -0.8, -2.2];

#[test]
fn the_jacobian_and_the_bias_are_derivatives_of_the_residual_along_integrate() {
    for angle in ANGLES {
        let q = by_cosine(&near(angle));
        let h = 1e-5;
        let moved = |by: f64| ByCosine.integrate(&q, &V.map(|v| by * v));
        let [ahead, behind] = [h, -h].map(|by| ByCosine.loop_residual(&moved(by)));
        let rate = |jacobian: [[f64; 3]; 2]| jacobian.map(|row| (0..3).map(|i| row[i] * V[i]).sum::<f64>());
        // Truncation h²/6 of third derivatives below 20; rounding 1e-16/h.
        let difference = [0, 1].map(|row| (ahead[row] - behind[row]) / (2.0 * h));
        close("J v", &rate(ByCosine.loop_jacobian(&q)), &difference, 1e-9);
        let [ahead, behind] = [h, -h].map(|by| rate(ByCosine.loop_jacobian(&moved(by))));
        let difference = [0, 1].map(|row| (ahead[row] - behind[row]) / (2.0 * h));
        close("bias", &ByCosine.loop_bias(&q, &V), &difference, 1e-8);
    }
}

#[test]
fn assembly_does_not_depend_on_the_coordinates() {
    let (angle, cosine) = (ClosedLoop::new(&ByAngle), ClosedLoop::new(&ByCosine));
    for at in ANGLES {
        for held in [&[][..], &[0], &[1], &[2]] {
            let guess = near(at);
            let expected = angle.assemble(&guess, &V, held).expect("it closes");
            let found = cosine.assemble(&by_cosine(&guess), &V, held).expect("it closes");
            close("q", &found.q, &by_cosine(&expected.q), TOLERANCE);
            close("v", &found.v, &expected.v, TOLERANCE);
            close("residual", &cosine.closure().loop_residual(&found.q), &[0.0; 2], 1e-14);
            close("displacement", &[found.largest_displacement], &[expected.largest_displacement], TOLERANCE);
            close("distance", &[found.distance], &[expected.distance], TOLERANCE);
            assert_eq!((found.velocity, found.rank), (expected.velocity, expected.rank), "at {at}, held {held:?}");
            for &held in held {
                assert_eq!(ByCosine.difference(&by_cosine(&guess), &found.q)[held], 0.0, "{held} is held");
            }
        }
    }
}

#[test]
fn dynamics_and_projection_do_not_depend_on_the_coordinates() {
    let (angle, cosine) = (ClosedLoop::new(&ByAngle), ClosedLoop::new(&ByCosine));
    for at in ANGLES {
        let (q, tau) = (closed(at), [3.0, -2.0, 5.0]);
        let expected = angle.dynamics(&q, &V, &tau).expect("regular");
        let found = cosine.dynamics(&by_cosine(&q), &V, &tau).expect("regular");
        close("accelerations", &found.accelerations, &expected.accelerations, TOLERANCE);
        close("multipliers", &found.multipliers, &expected.multipliers, TOLERANCE);
        assert_eq!(found.rank, 2);
        let expected = angle.project(&near(at), &V).expect("near");
        let found = cosine.project(&by_cosine(&near(at)), &V).expect("near");
        close("q", &found.q, &by_cosine(&expected.q), TOLERANCE);
        close("v", &found.v, &expected.v, TOLERANCE);
    }
}

/// The slider back and forth; from 0 to 1 s it goes farther than one move.
fn sliding(t: f64) -> Motion<[f64; 1], [f64; 1]> {
    let (s, c) = (2.0 * t).sin_cos();
    Motion { q: [0.9 + 0.3 * c], v: [-0.6 * s], a: [-1.2 * c] }
}

#[test]
fn inverse_dynamics_do_not_depend_on_the_coordinates() {
    for actuated in [&[2][..], &[0], &[0, 2], &[1, 2, 0]] {
        let mut angle = ClosedLoopInverse::new(ClosedLoop::new(&ByAngle), &[2], near(0.5)).actuated(actuated);
        let guess = by_cosine(&near(0.5));
        let mut cosine = ClosedLoopInverse::new(ClosedLoop::new(&ByCosine), &[2], guess).actuated(actuated);
        for t in [0.1, 0.2, 1.0, 0.4, 0.7] {
            let expected = angle.at(t, &sliding).expect("within reach");
            let found = cosine.at(t, &sliding).expect("within reach");
            assert_eq!(found.motion.q[3], sliding(t).q[0]);
            close("q", &found.motion.q, &by_cosine(&expected.motion.q), TOLERANCE);
            close("v", &found.motion.v, &expected.motion.v, TOLERANCE);
            close("a", &found.motion.a, &expected.motion.a, TOLERANCE);
            close("forces", &found.forces, &expected.forces, TOLERANCE);
            close("multipliers", &found.multipliers, &expected.multipliers, TOLERANCE);
            assert_eq!((found.rank, found.redundancy), (expected.rank, expected.redundancy));
        }
    }
}

#[test]
fn computed_torque_does_not_depend_on_the_coordinates() {
    let angle = ClosedLoopComputedTorque::new(ClosedLoop::new(&ByAngle), &[2], sliding, [[40.0], [12.0]]);
    let cosine = ClosedLoopComputedTorque::new(ClosedLoop::new(&ByCosine), &[2], sliding, [[40.0], [12.0]]);
    for at in ANGLES {
        let state = ClosedLoop::new(&ByAngle).assemble(&closed(at), &V, &[]).expect("it is closed");
        let expected = angle.forces(0.3, &state.q, &state.v).expect("regular");
        let found = cosine.forces(0.3, &by_cosine(&state.q), &state.v).expect("regular");
        close("a", &found.motion.a, &expected.motion.a, TOLERANCE);
        close("forces", &found.forces, &expected.forces, TOLERANCE);
        // The slider's error, by hand.
        let wanted = sliding(0.3);
        let error = wanted.q[0] - state.q[2];
        let a = wanted.a[0] + 12.0 * (wanted.v[0] - state.v[2]) + 40.0 * error;
        close("slider", &[found.motion.a[2]], &[a], TOLERANCE);
    }
}

/// Follows the open chain, all joints at once, by [`ComputedTorque`] of the tree.
#[test]
fn computed_torque_of_a_tree_takes_position_errors_on_the_tangent() {
    let motion = |t: f64| Motion { q: [3.0 + t, -0.4 * t, 0.7], v: [1.0, -0.4, 0.0], a: [0.2, 0.0, -0.1] };
    let (kp, kd) = ([40.0, 30.0, 20.0], [12.0, 11.0, 10.0]);
    let mut angle = ComputedTorque { mechanism: &ByAngle, trajectory: motion, kp, kd };
    let trajectory = |t: f64| {
        let Motion { q, v, a } = motion(t);
        Motion { q: by_cosine(&q), v, a }
    };
    let mut cosine = ComputedTorque { mechanism: &ByCosine, trajectory, kp, kd };
    for t in [0.0, 0.1, 0.3] {
        // The crank's error stays below π, where its angle and the shortest way agree.
        let q = [2.5, 0.3, 0.8];
        let expected = angle.torque(&ByAngle, t, &q, &V);
        let found = cosine.torque(&ByCosine, t, &by_cosine(&q), &V);
        close("torque", &found, &expected, TOLERANCE);
    }
    // Beyond π the shortest way is the other one.
    let far = cosine.torque(&ByCosine, 0.0, &by_cosine(&[-3.2, 0.3, 0.8]), &V);
    let near = cosine.torque(&ByCosine, 0.0, &by_cosine(&[-3.2 + TAU, 0.3, 0.8]), &V);
    close("torque", &far, &near, TOLERANCE);
}

#[test]
fn springs_and_integral_action_do_not_depend_on_the_coordinates() {
    let (kp, ki, kd, v) = ([4.0, 3.0, 2.0], [1.0, 0.9, 0.8], [0.7, 0.6, 0.5], &V);
    // The crank's error stays below π, where its angle and the shortest way agree.
    let (q, target) = ([2.5, 0.3, 0.8], [-0.4, 0.1, 1.0]);
    let (at, to) = (by_cosine(&q), by_cosine(&target));
    let (angle, cosine) = (SetPoint::new(&ByAngle, target), SetPoint::new(&ByCosine, to));
    let expected = Proportional { target, kp }.torque(&ByAngle, 0.0, &q, v);
    close("P", &Proportional { target: to, kp }.torque(&ByCosine, 0.0, &at, v), &expected, TOLERANCE);
    let expected = Pd { target, kp, kd }.torque(&ByAngle, 0.0, &q, v);
    close("PD", &Pd { target: to, kp, kd }.torque(&ByCosine, 0.0, &at, v), &expected, TOLERANCE);
    let expected = TrackingPd { trajectory: angle, kp, kd }.torque(&ByAngle, 0.0, &q, v);
    close("tracking", &TrackingPd { trajectory: cosine, kp, kd }.torque(&ByCosine, 0.0, &at, v), &expected, TOLERANCE);
    let [tracking, integral] = [[0.0; 3], [0.3, -0.2, 0.1]];
    let (mut rates, mut expected_rates) = ([0.0; 3], [0.0; 3]);
    let mut pid = Pid { trajectory: angle, kp, ki, kd, tracking, integral };
    let expected = pid.torque_with_state(&ByAngle, 0.0, (&q, v), &integral, &mut expected_rates);
    let mut pid = Pid { trajectory: cosine, kp, ki, kd, tracking, integral };
    close("PID", &pid.torque_with_state(&ByCosine, 0.0, (&at, v), &integral, &mut rates), &expected, TOLERANCE);
    close("PID's rates", &rates, &expected_rates, TOLERANCE);
}

#[test]
fn simulation_does_not_depend_on_the_coordinates() {
    let method = Ode45::new().rtol(1e-10).atol(1e-12);
    let start = ClosedLoop::new(&ByAngle).assemble(&near(0.5), &[2.0, 0.0, 0.0], &[0]).expect("it closes");
    let law = |_: f64, _: &[f64; 3], v: &[f64; 3]| [4.0 - 0.5 * v[0], 0.0, 0.0];
    let mut angle = ClosedLoopSimulation::new(ClosedLoop::new(&ByAngle), law);
    let state = angle.assembled(&start);
    let end = method.integrate(&mut angle, (0.0, 1.0), state).expect("regular");
    let expected = angle.split(&end.y);
    let law = |_: f64, _: &[f64; 4], v: &[f64; 3]| [4.0 - 0.5 * v[0], 0.0, 0.0];
    let mut cosine = ClosedLoopSimulation::new(ClosedLoop::new(&ByCosine), law);
    let state = cosine.start(&by_cosine(&start.q), &start.v).expect("closed");
    let end = method.integrate(&mut cosine, (0.0, 1.0), state).expect("regular");
    let found = cosine.split(&end.y);
    let length = found.q[0].hypot(found.q[1]);
    let q = [found.q[0] / length, found.q[1] / length, found.q[2], found.q[3]];
    // Some hundred steps of 1e-10 each, which the motion spreads.
    close("q", &q, &by_cosine(&expected.q), 1e-8);
    close("v", &found.v, &expected.v, 1e-7);
    close("energy", &[found.actuator_energy], &[expected.actuator_energy], 1e-7);
}

#[test]
fn a_trajectory_cannot_prescribe_a_joint_of_two_coordinates() {
    let loops = ClosedLoop::new(&ByCosine);
    let error = ClosedLoopInverse::new(loops, &[0], by_cosine(&near(0.5))).at(0.1, &sliding).unwrap_err();
    assert_eq!(error, LoopError::NoCoordinate { velocity: 0 });
    let message = loops.with_names(error).to_string();
    assert!(message.contains("several coordinates"), "{message}");
    assert!(message.ends_with("velocity 0 is that of the joint `crank`"), "{message}");
    let law = ClosedLoopComputedTorque::new(loops, &[0], sliding, [[1.0], [1.0]]);
    let error = law.forces(0.1, &by_cosine(&closed(0.5)), &V).unwrap_err();
    assert_eq!(error, LoopError::NoCoordinate { velocity: 0 });
}

#[test]
fn errors_count_and_name_velocities() {
    let loops = ClosedLoop::new(&ByCosine);
    let q = by_cosine(&near(0.5));
    let error = loops.assemble(&q, &V, &[3]).unwrap_err();
    assert_eq!(error, LoopError::VelocityOutOfRange { velocity: 3, count: 3 });
    let error = ClosedLoopInverse::new(loops, &[2], q).actuated(&[3]).at(0.1, &sliding).unwrap_err();
    assert_eq!(error, LoopError::VelocityOutOfRange { velocity: 3, count: 3 });
    let error = ClosedLoopInverse::new(loops, &[2], q).actuated(&[]).at(0.1, &sliding).unwrap_err();
    let LoopError::Unactuated { velocity: 0, .. } = error else { panic!("{error}") };
    assert_eq!(loops.with_names(error).joint_name, Some("crank"));
    let singular = LoopError::<f64>::SingularInertia { velocity: 1 };
    assert_eq!(loops.with_names(singular).joint_name, Some("rod"));
    // Beyond the dead centre, where the rod cannot reach.
    let far = |t: f64| Motion { q: [1.0 + t], v: [1.0], a: [0.0] };
    let error = ClosedLoopInverse::new(loops, &[2], q).at(0.6, &far).unwrap_err();
    assert!(matches!(error, LoopError::Unreachable { velocity: 2, .. }), "{error}");
}

#[test]
fn velocities_have_the_coordinates_of_the_same_number_where_there_are_as_many_of_them() {
    let of = |mechanism: &dyn Mechanism| [0, 1, 2, 3].map(|velocity| mechanism.coordinate_of_velocity(velocity));
    assert_eq!(of(&ByAngle), [Some(0), Some(1), Some(2), None]);
    assert_eq!(of(&ByCosine), [None, Some(2), Some(3), None]);
}
