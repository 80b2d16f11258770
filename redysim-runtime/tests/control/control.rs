//! Torque laws, by their formulas and in closed loop.

use crate::mechanisms::{Arm, GRAVITY, Pendulum, distance};
use redysim_runtime::{
    ComputedTorque, Cycloid, ForwardSimulation, Integrator, InverseDynamics, Motion, Ode45, Pd, PdGravity,
    Proportional, SetPoint, TorqueLaw, TrackingPd, Trajectory, ZeroTorque, uniform,
};

const Q: [f64; 2] = [0.5, -0.25];
const V: [f64; 2] = [2.0, 3.0];
const TARGET: [f64; 2] = [1.0, 1.0];
const KP: [f64; 2] = [10.0, 20.0];
const KD: [f64; 2] = [1.0, 2.0];

fn torque(mut law: impl TorqueLaw<f64, Arm>, t: f64) -> [f64; 2] {
    law.torque(&Arm, t, &Q, &V)
}

fn swing(t: f64) -> Motion<[f64; 2], [f64; 2]> {
    let (sin, cos) = t.sin_cos();
    Motion { q: [sin, 2.0 * sin], v: [cos, 2.0 * cos], a: [-sin, -2.0 * sin] }
}

#[test]
fn laws_follow_their_formulas() {
    assert_eq!(torque(ZeroTorque, 1.0), [0.0, 0.0]);
    assert_eq!(torque(Proportional { target: TARGET, kp: KP }, 1.0), [10.0 * 0.5, 20.0 * 1.25]);
    assert_eq!(torque(Pd { target: TARGET, kp: KP, kd: KD }, 1.0), [10.0 * 0.5 - 2.0, 20.0 * 1.25 - 2.0 * 3.0]);
    // At t = 0 the swing passes zero with velocity (1, 2).
    assert_eq!(
        torque(TrackingPd { trajectory: swing, kp: KP, kd: KD }, 0.0),
        [10.0 * -0.5 + (1.0 - 2.0), 20.0 * 0.25 + 2.0 * (2.0 - 3.0)]
    );
    assert_eq!(torque(|t: f64, q: &[f64; 2], v: &[f64; 2]| [t * q[0], v[1]], 2.0), [1.0, 3.0]);
}

#[test]
fn computed_torque_is_the_inverse_dynamics_of_the_corrected_acceleration() {
    let t = 0.3;
    let desired = swing(t);
    let a = std::array::from_fn(|i| desired.a[i] + KD[i] * (desired.v[i] - V[i]) + KP[i] * (desired.q[i] - Q[i]));
    let law = ComputedTorque { mechanism: &Arm, trajectory: swing, kp: KP, kd: KD };
    assert!(distance(&torque(law, t), &Arm.inverse_dynamics(&Q, &V, &a)) < 1e-12);
}

#[test]
fn one_gain_for_all_is_as_long_as_the_velocities() {
    assert_eq!(uniform(&Arm, 50.0), [50.0, 50.0]);
    assert_eq!(uniform(&Pendulum { mass: 1.0, length: 1.0 }, 2.0_f32), [2.0]);
}

#[test]
fn a_pendulum_under_pd_comes_to_rest_where_spring_and_weight_balance() {
    let pendulum = Pendulum { mass: 1.0, length: 1.0 };
    let law = Pd { target: [2.0_f64], kp: [100.0], kd: [20.0] };
    let mut simulation = ForwardSimulation::new(&pendulum, law);
    let start = simulation.state(&[0.0], &[0.0]);
    let end = Ode45::new().rtol(1e-8).integrate(&mut simulation, (0.0, 10.0), start).unwrap();
    let rest = simulation.split(&end.y);
    assert!(rest.v[0].abs() < 1e-6, "{rest:?}");
    assert!((100.0 * (2.0 - rest.q[0]) - GRAVITY * rest.q[0].sin()).abs() < 1e-4, "{rest:?}");
}

#[test]
fn a_spring_alone_only_adds_to_the_oscillation() {
    let pendulum = Pendulum { mass: 1.0, length: 1.0 };
    let mut simulation = ForwardSimulation::new(&pendulum, Proportional { target: [0.0], kp: [90.19] });
    let start = simulation.state(&[1e-4], &[0.0]);
    // Small swings: ω² = (kp + m g l)/(m l²) = 100.
    let half_period = std::f64::consts::PI / 10.0;
    let end = Ode45::new().rtol(1e-10).atol(1e-14).integrate(&mut simulation, (0.0, half_period), start).unwrap();
    assert!((end.y[0] + 1e-4).abs() < 1e-11, "{:?}", end.y);
}

/// ë + Kd ė + Kp e = 0 with Kd = 2√Kp: e(t) = (e₀ + (ė₀ + ω e₀) t) exp(−ω t), for each joint with its own ω.
#[test]
fn computed_torque_leaves_linear_error_dynamics() {
    let omega = [3.0, 5.0];
    let trajectory = Cycloid::new([0.0, 0.0], [1.0, -2.0], 1.0).unwrap();
    let law = ComputedTorque { mechanism: &Arm, trajectory, kp: omega.map(|w| w * w), kd: omega.map(|w| 2.0 * w) };
    let mut simulation = ForwardSimulation::new(&Arm, law);
    let (e0, v0) = ([-0.3, 0.2], [0.1, -0.4]);
    let start = simulation.state(&e0.map(|e: f64| -e), &v0.map(|v: f64| -v));
    let times = [0.25, 0.5, 0.75, 1.0, 1.5];
    let method = Ode45::new().rtol(1e-11).atol(1e-12).max_step(0.01);
    method
        .solve(&mut simulation, (0.0, 1.5), start, times, |t, y| {
            for i in 0..2 {
                let w = omega[i];
                let expected = (e0[i] + (v0[i] + w * e0[i]) * t) * (-w * t).exp();
                let e = trajectory.at(t).q[i] - y[i];
                assert!((e - expected).abs() < 1e-9, "joint {i} at {t}: {e} instead of {expected}");
            }
        })
        .unwrap();
}

#[test]
fn tracking_pd_stays_near_a_slow_motion() {
    let pendulum = Pendulum { mass: 0.1, length: 0.5 };
    let trajectory = Cycloid::new([0.0], [1.0], 5.0).unwrap();
    let mut simulation = ForwardSimulation::new(&pendulum, TrackingPd { trajectory, kp: [100.0], kd: [2.0] });
    let start = simulation.state(&[0.0], &[0.0]);
    let times = (1..=50).map(|k| f64::from(k) / 10.0);
    Ode45::new()
        .solve(&mut simulation, (0.0, 5.0), start, times, |t, y| {
            assert!((y[0] - trajectory.at(t).q[0]).abs() < 0.01, "{y:?} at {t}");
        })
        .unwrap();
}

/// The pendulum of 2 kg under PD with the gravity forces of one of `assumed` kg, at rest: its angle.
fn rest_under_pd_with_gravity_of(assumed: f64) -> f64 {
    let pendulum = Pendulum { mass: 2.0, length: 0.5 };
    let known = Pendulum { mass: assumed, ..pendulum };
    let law = PdGravity { mechanism: &known, trajectory: SetPoint::new(&known, [1.0]), kp: [20.0], kd: [6.0] };
    let mut simulation = ForwardSimulation::new(&pendulum, law);
    let start: [f64; 3] = simulation.state(&[0.0], &[0.0]);
    let end = Ode45::new().rtol(1e-9).atol(1e-12).integrate(&mut simulation, (0.0, 20.0), start).unwrap();
    assert!(end.y[1].abs() < 1e-9, "at rest: {:?}", end.y);
    end.y[0]
}

#[test]
fn pd_with_gravity_rests_at_its_set_point_with_the_right_payload() {
    assert!((rest_under_pd_with_gravity_of(2.0) - 1.0).abs() < 1e-9);
}

/// Kp e = (m − m_assumed) g l sin q.
#[test]
fn pd_with_gravity_rests_off_its_set_point_by_the_weight_that_it_does_not_know_over_kp() {
    for assumed in [0.0, 1.5, 2.4] {
        let q = rest_under_pd_with_gravity_of(assumed);
        let missing = (2.0 - assumed) * GRAVITY * 0.5 * q.sin();
        assert!((20.0 * (1.0 - q) - missing).abs() < 1e-7, "{assumed} kg: {q}");
        assert!((q - 1.0).abs() > 0.05, "{assumed} kg: {q}");
    }
}

#[test]
fn laws_work_in_single_precision() {
    let law = Pd { target: [1.0_f32; 2], kp: uniform(&Arm, 2.0), kd: uniform(&Arm, 1.0) };
    let mut law = law;
    assert_eq!(law.torque(&Arm, 0.0, &[0.5; 2], &[1.0; 2]), [0.0, 0.0]);
}
