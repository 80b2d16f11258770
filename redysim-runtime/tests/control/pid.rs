//! PID control, its integral action and limited forces, against closed forms.

use crate::mechanisms::{Arm, Pendulum};
use redysim_runtime::{
    ConfigurationSpace, ForwardDynamics, ForwardSimulation, Gauss6, IntegrationError, Integrator, LengthMismatch,
    Limited, LinkState, Mechanism, Motion, Ode, Ode5, Ode15s, Ode45, Pd, Pid, Radau5, Scalar, SetPoint, TorqueLaw,
    tracking_rates,
};

/// A mass on a rail: m a = τ + d − c v − k x.
#[derive(Clone, Copy)]
struct Cart {
    mass: f64,
    disturbance: f64,
    damping: f64,
    stiffness: f64,
}

const FREE: Cart = Cart { mass: 2.0, disturbance: 0.0, damping: 0.0, stiffness: 0.0 };

mechanism!(Cart, "cart", 1);

impl<S: Scalar> ForwardDynamics<S> for Cart {
    fn forward_dynamics(&self, q: &[S; 1], v: &[S; 1], tau: &[S; 1]) -> [S; 1] {
        let [m, d, c, k] = [self.mass, self.disturbance, self.damping, self.stiffness].map(S::from_f64);
        [(tau[0] + d - c * v[0] - k * q[0]) / m]
    }
}

/// −1, −2 and −3 1/s: of m (s + 1)(s + 2)(s + 3) = m s³ + Kd s² + Kp s + Ki.
const POLES: [f64; 3] = [-1.0, -2.0, -3.0];

fn with_poles<T>(cart: Cart, trajectory: T) -> Pid<T, [f64; 1]> {
    let [kp, ki, kd] = [11.0, 6.0, 6.0].map(|c| [c * cart.mass]);
    Pid { trajectory, kp, ki, kd, tracking: [0.0], integral: [0.0] }
}

/// Σ cᵢ exp(pᵢ t) with the given value and first and second derivatives at 0, by Lagrange's polynomials.
fn modes([e, de, dde]: [f64; 3], t: f64) -> f64 {
    let [a, b, c] = POLES;
    let mode = |p: f64, [r, s]: [f64; 2]| (dde - (r + s) * de + r * s * e) / ((p - r) * (p - s)) * (p * t).exp();
    mode(a, [b, c]) + mode(b, [a, c]) + mode(c, [a, b])
}

fn error_at(method: &impl Integrator<f64>, cart: Cart, end: f64) -> f64 {
    let mut simulation = ForwardSimulation::new(&cart, with_poles(cart, SetPoint::new(&cart, [1.0])));
    let start: [f64; 4] = simulation.extended_state(&[0.0], &[0.0]);
    1.0 - method.integrate(&mut simulation, (0.0, end), start).unwrap().y[0]
}

#[test]
fn a_mass_under_pid_follows_its_characteristic_polynomial_by_every_kind_of_integrator() {
    let cart = Cart { disturbance: -3.0, ..FREE };
    // m ẍ = Kp + d at the start.
    let start = [1.0, 0.0, -(11.0 * cart.mass + cart.disturbance) / cart.mass];
    for t in [0.2, 1.0, 3.0] {
        let expected = modes(start, t);
        for (name, found, tolerance) in [
            ("Ode45", error_at(&Ode45::new().rtol(1e-10).atol(1e-12), cart, t), 1e-9),
            ("Ode15s", error_at(&Ode15s::new().rtol(1e-9).atol(1e-11), cart, t), 1e-7),
            ("Radau5", error_at(&Radau5::new().rtol(1e-10).atol(1e-12), cart, t), 1e-8),
            ("Ode5", error_at(&Ode5::new(0.002), cart, t), 1e-11),
            ("Gauss6", error_at(&Gauss6::new(0.02), cart, t), 1e-11),
        ] {
            assert!((found - expected).abs() < tolerance, "{name} at {t} s: {found} instead of {expected}");
        }
    }
}

#[test]
fn integral_action_removes_a_constant_disturbance_that_pd_alone_leaves() {
    let cart = Cart { disturbance: -3.0, ..FREE };
    let method = Ode45::new().rtol(1e-9).atol(1e-12);
    assert!(error_at(&method, cart, 30.0).abs() < 1e-9);
    let law = Pd { target: [1.0], kp: [22.0], kd: [12.0] };
    let mut simulation = ForwardSimulation::new(&cart, law);
    let end = method.integrate(&mut simulation, (0.0, 30.0), [0.0; 3]).unwrap();
    assert!((1.0 - end.y[0] - 3.0 / 22.0).abs() < 1e-9, "PD leaves d/Kp: {:?}", end.y);
}

/// The set point jumps within a step, so that the step is rejected.
#[test]
fn rejected_steps_leave_no_trace_in_the_integral() {
    let jump = |t: f64| Motion { q: [if t < 1.0 { 0.0 } else { 1.0 }], v: [0.0], a: [0.0] };
    let law = with_poles(FREE, jump);
    let mut simulation = ForwardSimulation::new(&FREE, law);
    let start: [f64; 4] = simulation.extended_state(&[0.0], &[0.0]);
    let method = Ode45::new().rtol(1e-9).atol(1e-11);
    let end = method.integrate(&mut simulation, (0.0, 3.0), start).unwrap();
    assert!(end.statistics.rejected > 3, "{:?}", end.statistics);
    let expected = modes([1.0, 0.0, -11.0], 2.0);
    assert!((1.0 - end.y[0] - expected).abs() < 1e-7, "{:?} instead of {expected}", end.y);
}

/// The largest coordinate on the way to 1 under a limit of 2 N, and the integral action at the end.
fn peak_under_limit(tracking: f64) -> (f64, f64) {
    let pid = Pid { tracking: [tracking], ..with_poles(FREE, SetPoint::new(&FREE, [1.0])) };
    let mut simulation = ForwardSimulation::new(&FREE, Limited { law: pid, limits: [2.0] });
    let start: [f64; 4] = simulation.extended_state(&[0.0], &[0.0]);
    let mut peak = 0.0_f64;
    let times = (0..=4000).map(|k| f64::from(k) * 0.01);
    let method = Ode45::new().rtol(1e-9).atol(1e-10);
    let end = method.solve(&mut simulation, (0.0, 40.0), start, times, |_, y| peak = peak.max(y[0])).unwrap();
    assert!((end.y[0] - 1.0).abs() < 1e-6, "{:?}", end.y);
    (peak, end.y[3])
}

#[test]
fn an_integral_that_tracks_the_limited_force_does_not_wind_up() {
    let [tracking] = tracking_rates(&[22.0], &[12.0], &[12.0]);
    assert_eq!(tracking, 1.0);
    let (wound_up, _) = peak_under_limit(0.0);
    let (tracked, integral) = peak_under_limit(tracking);
    assert!(wound_up > 1.5, "without anti-windup: {wound_up}");
    assert!(tracked < 1.1, "with anti-windup: {tracked}");
    assert!(integral.abs() < 1e-4, "no force is needed at rest: {integral}");
}

/// k x holds back at x = limit/k, short of the set point: 0 = Ki e + Kt (limit − τ).
#[test]
fn in_lasting_saturation_the_integral_settles_where_the_force_exceeds_its_limit_by_ki_e_over_kt() {
    let cart = Cart { damping: 4.0, stiffness: 10.0, ..FREE };
    let (limit, tracking) = (5.0, 2.0);
    let pid = Pid { tracking: [tracking], ..with_poles(cart, SetPoint::new(&cart, [1.0])) };
    let mut simulation = ForwardSimulation::new(&cart, Limited { law: pid, limits: [limit] });
    let start: [f64; 4] = simulation.extended_state(&[0.0], &[0.0]);
    let end = Ode45::new().rtol(1e-10).atol(1e-10).integrate(&mut simulation, (0.0, 40.0), start).unwrap();
    let e = 1.0 - limit / cart.stiffness;
    assert!((1.0 - end.y[0] - e).abs() < 1e-8, "{:?}", end.y);
    let asked = pid.kp[0] * e + end.y[3];
    assert!((asked - limit - pid.ki[0] * e / tracking).abs() < 1e-6, "{asked}");
    assert_eq!(simulation.torque(40.0, &end.y), [limit]);
}

#[test]
fn limits_cut_off_the_forces_of_any_law_in_both_directions_and_keep_nan() {
    let mut law = Limited { law: |_: f64, q: &[f64; 2], _: &[f64; 2]| *q, limits: [1.0, f64::INFINITY] };
    let mut torque = |q| law.torque(&Arm, 0.0, &q, &[0.0; 2]);
    assert_eq!(torque([3.0, 1e9]), [1.0, 1e9]);
    assert_eq!(torque([-3.0, -1e9]), [-1.0, -1e9]);
    assert_eq!(torque([0.5, 0.0]), [0.5, 0.0]);
    assert!(torque([f64::NAN, 0.0])[0].is_nan());
}

#[test]
fn the_slope_of_a_limited_force_is_zero_where_it_is_cut_off() {
    let pd = Pd { target: [0.0; 2], kp: [10.0; 2], kd: [1.0; 2] };
    let mut law = Limited { law: pd, limits: [5.0; 2] };
    let slope = law.torque_tangent(&Arm, 0.0, (&[1.0, 0.1], &[0.0; 2]), (&[1.0; 2], &[1.0; 2]));
    assert_eq!(slope, Some([0.0, -11.0]));
}

#[test]
fn a_joint_without_integral_gain_has_no_integral_action_under_limits() {
    let pid = Pid { ki: [0.0], tracking: [5.0], ..with_poles(FREE, SetPoint::new(&FREE, [1.0])) };
    let mut limited = Limited { law: pid, limits: [2.0] };
    let mut rates = [f64::NAN];
    let force = limited.torque_with_state(&FREE, 0.0, (&[0.0], &[0.0]), &[0.0], &mut rates);
    assert_eq!((force, rates), ([2.0], [0.0]));
}

#[test]
fn tracking_rates_are_those_of_the_integral_and_derivative_times() {
    assert_eq!(tracking_rates(&[9.0, 8.0, 7.0], &[4.0, 2.0, 0.0], &[1.0, 0.0, 1.0]), [2.0, 0.25, 0.0]);
}

/// Kt = ∞ would give ∞ · 0 within the limits.
#[test]
fn pure_integral_control_under_limits_has_tracking_rate_zero_and_finite_torques() {
    let cart = Cart { damping: 4.0, stiffness: 10.0, ..FREE };
    let [kp, ki, kd] = [[0.0_f64], [6.0], [0.0]];
    let tracking = tracking_rates(&kp, &ki, &kd);
    assert_eq!(tracking, [0.0]);
    let pid = Pid { trajectory: SetPoint::new(&cart, [1.0]), kp, ki, kd, tracking, integral: [0.0] };
    let mut law = Limited { law: pid, limits: [20.0] };
    for (z, expected) in [(0.0, 0.0), (30.0, 20.0)] {
        let mut rates = [f64::NAN];
        let force = law.torque_with_state(&cart, 0.0, (&[0.0], &[0.0]), &[z], &mut rates);
        assert_eq!((force, rates), ([expected], [6.0]));
    }
    let mut simulation = ForwardSimulation::new(&cart, law);
    let start: [f64; 4] = simulation.extended_state(&[0.0], &[0.0]);
    let end = Ode45::new().rtol(1e-9).atol(1e-10).integrate(&mut simulation, (0.0, 40.0), start).unwrap();
    let [force] = simulation.torque(40.0, &end.y);
    assert!((force - cart.stiffness).abs() < 1e-6, "the spring is held at the set point: {force}");
}

/// Every period of the sampled controller is a step of Euler's method, of first order.
#[test]
fn a_sampled_controller_converges_to_the_simulated_one_with_its_period() {
    let cart = Cart { disturbance: -3.0, ..FREE };
    let expected = modes([1.0, 0.0, -9.5], 1.0);
    let error = |count: u32| {
        let mut pid = with_poles(cart, SetPoint::new(&cart, [1.0]));
        let (dt, mut q, mut v) = (1.0 / f64::from(count), [0.0], [0.0]);
        for k in 0..count {
            let t = f64::from(k) * dt;
            let tau = pid.torque(&cart, t, &q, &v);
            pid.advance(&cart, (t, dt), &q, &v, &tau);
            let [a] = cart.forward_dynamics(&q, &v, &tau);
            (q, v) = ([q[0] + dt * v[0]], [v[0] + dt * a]);
        }
        1.0 - q[0] - expected
    };
    let (coarse, fine) = (error(1000), error(2000));
    assert!(fine.abs() < 2e-3 && (coarse / fine - 2.0).abs() < 0.02, "{coarse} {fine}");
}

#[test]
fn a_sampled_controller_follows_the_force_that_its_actuator_gives() {
    let mut pid = Pid { tracking: [4.0], ..with_poles(FREE, SetPoint::new(&FREE, [1.0])) };
    pid.advance(&FREE, (0.0, 0.1), &[0.0], &[0.0], &[2.0]);
    assert_eq!(pid.integral, [0.1 * (12.0 + 4.0 * (2.0 - 22.0))]);
}

#[test]
fn a_simulation_does_not_begin_without_the_states_of_its_law() {
    let mut simulation = ForwardSimulation::new(&FREE, with_poles(FREE, SetPoint::new(&FREE, [1.0])));
    let start = simulation.state(&[0.0], &[0.0]);
    let mismatch = LengthMismatch { vector: "state", length: 3, expected: 4 };
    let error = Ode45::new().integrate(&mut simulation, (0.0, 1.0), start).unwrap_err();
    assert_eq!(error, IntegrationError::WrongLength(mismatch));
}

#[test]
fn an_integral_that_starts_with_the_weight_keeps_a_pendulum_at_rest() {
    let pendulum = Pendulum { mass: 1.0, length: 1.0 };
    let weight = crate::mechanisms::GRAVITY * 0.5_f64.sin();
    let pid = Pid { integral: [weight], ..with_poles(FREE, SetPoint::new(&pendulum, [0.5])) };
    let mut simulation = ForwardSimulation::new(&pendulum, pid);
    let start: [f64; 4] = simulation.extended_state(&[0.5], &[0.0]);
    let mut rates = [f64::NAN; 4];
    simulation.derivative(0.0, &start, &mut rates);
    assert!(rates.iter().all(|rate| rate.abs() < 1e-15), "{rates:?}");
}
