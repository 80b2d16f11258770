//! Laws of any joints on a body that moves freely and on one that turns about a point.
#![cfg(feature = "generic")]

use crate::common::models::generic;
use redysim::Real;
use redysim::generic::GenericMechanism;
use redysim::{
    ComputedTorque, ConfigurationSpace, ForwardSimulation, GravityForces, Integrator, Mechanism, Motion, Ode45, Pd,
    Pid, Proportional, Radau5, SetPoint, TorqueLaw, TrackingPd,
};

/// The position at the end of `law` on `mechanism` after `duration`, with what is left of the way to `target` and of the
/// velocities, and the states of the law.
fn brought(
    mechanism: &GenericMechanism,
    law: impl TorqueLaw<f64, GenericMechanism>,
    (q, v): (&Vec<f64>, &Vec<f64>),
    target: &Vec<f64>,
    duration: f64,
) -> (Vec<f64>, f64, Vec<f64>) {
    let mut simulation = ForwardSimulation::new(mechanism, law);
    let start: Vec<f64> = simulation.extended_state(q, v);
    let end =
        Ode45::new().rtol(1e-9).atol(1e-10).integrate(&mut simulation, (0.0, duration), start).expect("it moves").y;
    let parts = simulation.split(&end);
    let left = mechanism.difference(&parts.q, target);
    let largest = left.iter().chain(&parts.v).fold(0.0, |largest: f64, left| Real::maximum(largest, left.abs()));
    (parts.q, largest, end[mechanism.nq() + mechanism.nv() + 1..].to_vec())
}

/// A start 3 rad from the neutral orientation about (2, −3, 6)/7, with velocities that lead past half a turn.
fn away(mechanism: &GenericMechanism, position: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let turn = [6.0 / 7.0, -9.0 / 7.0, 18.0 / 7.0];
    let way: Vec<f64> = position.iter().map(|_| 0.0).chain(turn).collect();
    let mut q = mechanism.integrate(&mechanism.neutral(), &way);
    q[..position.len()].copy_from_slice(position);
    let v = position.iter().map(|x| 0.5 * x).chain(turn.map(|w| 2.0 * w)).collect();
    (q, v)
}

#[test]
fn a_free_body_under_pid_comes_to_its_target_through_more_than_half_a_turn_and_carries_its_weight() {
    let parcel = generic("parcel");
    let gains = |linear: f64, angular: f64| [linear, linear, linear, angular, angular, angular].to_vec();
    let target = parcel.integrate(&parcel.neutral(), &vec![0.0, 0.0, 0.0, 0.4, -0.3, 0.2]);
    let pid = Pid {
        trajectory: SetPoint::new(&parcel, target.clone()),
        kp: gains(48.0, 0.8),
        ki: gains(48.0, 0.8),
        kd: gains(24.0, 0.4),
        tracking: vec![0.0; 6],
        integral: vec![0.0; 6],
    };
    let (q, v) = away(&parcel, &[0.5, -0.3, 0.2]);
    let opposite: Vec<f64> = q.iter().enumerate().map(|(i, x)| if i < 3 { *x } else { -x }).collect();
    for start in [&q, &opposite] {
        let (_, left, integral) = brought(&parcel, pid.clone(), (start, &v), &target, 24.0);
        assert!(left < 1e-6, "{left}");
        let weight = parcel.gravity_forces(&target);
        assert!(integral.iter().zip(&weight).all(|(z, weight)| (z - weight).abs() < 1e-4), "{integral:?} {weight:?}");
    }
}

#[test]
fn a_free_body_under_pd_comes_to_its_target_through_more_than_half_a_turn() {
    let mut model = generic("parcel").model().clone();
    model.gravity = redysim::generic::Vec3([0.0; 3]);
    let parcel = GenericMechanism::new(model);
    let (kp, kd) = (vec![48.0, 48.0, 48.0, 0.8, 0.8, 0.8], vec![24.0, 24.0, 24.0, 0.3, 0.3, 0.3]);
    let (target, (q, v)) = (parcel.neutral(), away(&parcel, &[0.5, -0.3, 0.2]));
    let law = Pd { target: target.clone(), kp, kd };
    // A tenth of a second later it has turned past half a turn: the shorter way is the other one.
    let (passed, ..) = brought(&parcel, law.clone(), (&q, &v), &target, 0.1);
    let [before, after] = [&q, &passed].map(|q| parcel.difference(q, &target)[5]);
    assert!(before < -2.0 && after > 2.0, "{before} {after}");
    let (_, left, _) = brought(&parcel, law, (&q, &v), &target, 16.0);
    assert!(left < 1e-6, "{left}");
}

#[test]
fn a_pendulum_in_space_under_pid_comes_to_rest_at_its_target_by_its_weight() {
    let top = generic("spherical_pendulum");
    let target = top.integrate(&top.neutral(), &vec![0.9, -0.4, 2.0]);
    let pid = Pid {
        trajectory: SetPoint::new(&top, target.clone()),
        kp: vec![16.0; 3],
        ki: vec![16.0; 3],
        kd: vec![4.0; 3],
        tracking: vec![0.0; 3],
        integral: vec![0.0; 3],
    };
    let (q, v) = away(&top, &[]);
    let (_, left, integral) = brought(&top, pid, (&q, &v), &target, 30.0);
    assert!(left < 1e-6, "{left}");
    let weight = top.gravity_forces(&target);
    assert!(integral.iter().zip(&weight).all(|(z, weight)| (z - weight).abs() < 1e-4), "{integral:?} {weight:?}");
}

type Law<'m> = Box<dyn TorqueLaw<f64, GenericMechanism> + 'm>;

/// The laws that have slopes.
fn with_slopes(body: &GenericMechanism) -> Vec<(&'static str, Law<'_>)> {
    let (target, nv) =
        (body.integrate(&body.neutral(), &(0..body.nv()).map(|i| 0.3 - 0.2 * i as f64).collect()), body.nv());
    let (kp, kd): (Vec<f64>, Vec<f64>) = (0..nv).map(|i| (20.0 + i as f64, 3.0 - 0.2 * i as f64)).unzip();
    let rest = SetPoint::new(body, target.clone());
    let swing = {
        let target = target.clone();
        move |t: f64| Motion { q: body.integrate(&target, &vec![t; nv]), v: vec![1.0; nv], a: vec![0.0; nv] }
    };
    vec![
        ("P", Box::new(Proportional { target: target.clone(), kp: kp.clone() })),
        ("PD", Box::new(Pd { target, kp: kp.clone(), kd: kd.clone() })),
        ("tracking PD", Box::new(TrackingPd { trajectory: swing, kp: kp.clone(), kd: kd.clone() })),
        ("computed torque", Box::new(ComputedTorque { mechanism: body, trajectory: rest, kp, kd })),
    ]
}

#[test]
fn slopes_of_forces_on_joints_in_space_are_their_differences() {
    for body in [generic("parcel"), generic("spherical_pendulum")] {
        let (nq, nv) = (body.nq(), body.nv());
        let (q, v) = away(&body, &[0.5, -0.3, 0.2][..nv - 3]);
        let q = body.integrate(&q, &vec![-0.4; nv]);
        for (name, mut law) in with_slopes(&body) {
            for direction in 0..nq + nv {
                let along = |by: f64, first: usize, x: &[f64]| -> Vec<f64> {
                    x.iter().enumerate().map(|(i, x)| if first + i == direction { x + by } else { *x }).collect()
                };
                let mut force = |by: f64| law.torque(&body, 0.3, &along(by, 0, &q), &along(by, nq, &v));
                let (h, ahead, behind) = (1e-5, force(1e-5), force(-1e-5));
                let slopes = (along(1.0, 0, &vec![0.0; nq]), along(1.0, nq, &vec![0.0; nv]));
                let slope = law.torque_tangent(&body, 0.3, (&q, &v), (&slopes.0, &slopes.1)).expect("it has one");
                for i in 0..nv {
                    // Truncation h²/6 of third derivatives below 1000, rounding 1e-13/h.
                    let expected = (ahead[i] - behind[i]) / (2.0 * h);
                    assert!((slope[i] - expected).abs() < 1e-7, "{name}, {direction}, {i}: {} {expected}", slope[i]);
                }
            }
        }
    }
}

#[test]
fn an_implicit_method_turns_a_stiff_body_as_an_explicit_one_does_with_fewer_evaluations() {
    let top = generic("spherical_pendulum");
    let law = Pd { target: top.integrate(&top.neutral(), &vec![0.9, -0.4, 2.0]), kp: vec![3e3; 3], kd: vec![3e2; 3] };
    let mut simulation = ForwardSimulation::new(&top, law);
    let (q, v) = away(&top, &[]);
    let start = simulation.state(&q, &v);
    let explicit =
        Ode45::new().rtol(1e-8).atol(1e-9).integrate(&mut simulation, (0.0, 0.5), start.clone()).expect("it moves");
    let implicit = Radau5::new().rtol(1e-8).atol(1e-9).integrate(&mut simulation, (0.0, 0.5), start).expect("it moves");
    let [one, other] = [&explicit.y, &implicit.y].map(|y| simulation.split(y));
    let apart = top.difference(&one.q, &other.q);
    assert!(apart.iter().all(|apart| apart.abs() < 1e-6), "{apart:?}");
    let evaluations = [&explicit, &implicit].map(|end| end.statistics.evaluations);
    assert!(3 * evaluations[1] < evaluations[0], "{evaluations:?}");
}
