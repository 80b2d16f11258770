//! `Vec` in place of arrays: the same bits, and no panic where lengths are wrong.
#![cfg(feature = "alloc")]

use crate::mechanisms::Arm;
use redysim_runtime::integrate::Accepted;
use redysim_runtime::{
    Arguments, ComputedTorque, ConfigurationSpace, ForwardDynamics, ForwardSimulation, Gauss4, IntegrationError,
    Integrator, InverseDynamics, LengthMismatch, Limited, LinkState, Mechanism, Motion, Ode, Ode5, Ode15s, Ode45, Pd,
    Pid, Proportional, Radau5, SetPoint, Solution, TorqueLaw, TrackingPd, ZeroTorque,
};

/// The arm with sizes known only at run time, and as many accelerations as it says.
struct DynamicArm(usize);

impl Mechanism for DynamicArm {
    without_names!("arm", 2, 2);
}

impl ConfigurationSpace<f64> for DynamicArm {
    type Coordinates = Vec<f64>;
    type Velocities = Vec<f64>;
    type State = Vec<f64>;
    type Matrix = Vec<Vec<f64>>;
    type Links = Vec<LinkState<f64>>;

    fn coordinate_rates(&self, _: &Vec<f64>, v: &Vec<f64>) -> Vec<f64> {
        v.clone()
    }
    fn integrate(&self, q: &Vec<f64>, dv: &Vec<f64>) -> Vec<f64> {
        q.iter().zip(dv).map(|(q, dv)| q + dv).collect()
    }
    fn difference(&self, q0: &Vec<f64>, q1: &Vec<f64>) -> Vec<f64> {
        q1.iter().zip(q0).map(|(q1, q0)| q1 - q0).collect()
    }
    fn neutral(&self) -> Vec<f64> {
        vec![0.0; 2]
    }
}

impl ForwardDynamics<f64> for DynamicArm {
    fn forward_dynamics(&self, q: &Vec<f64>, v: &Vec<f64>, tau: &Vec<f64>) -> Vec<f64> {
        let accelerations = Arm.forward_dynamics(&[q[0], q[1]], &[v[0], v[1]], &[tau[0], tau[1]]);
        accelerations[..self.0].to_vec()
    }

    fn forward_dynamics_tangent(
        &self,
        at: Arguments<'_, f64, Self>,
        slopes: Arguments<'_, f64, Self>,
    ) -> Option<Vec<f64>> {
        let [at, slopes] = [at, slopes].map(|(q, v, tau)| [q, v, tau].map(|values| [values[0], values[1]]));
        let [[q, v, tau], [dq, dv, dtau]] = [at, slopes];
        Some(Arm.forward_dynamics_tangent((&q, &v, &tau), (&dq, &dv, &dtau))?.to_vec())
    }
}

impl InverseDynamics<f64> for DynamicArm {
    fn inverse_dynamics(&self, q: &Vec<f64>, v: &Vec<f64>, a: &Vec<f64>) -> Vec<f64> {
        Arm.inverse_dynamics(&[q[0], q[1]], &[v[0], v[1]], &[a[0], a[1]]).to_vec()
    }
}

const Q: [f64; 2] = [0.5, -0.25];
const V: [f64; 2] = [2.0, 3.0];

/// Everything both paths produce: asked answers and the end.
fn answers<S: AsRef<[f64]>>(solve: impl FnOnce(&mut dyn FnMut(f64, &S)) -> S) -> Vec<Vec<f64>> {
    let mut answers = vec![];
    let end = solve(&mut |t, y| answers.push([&[t], y.as_ref()].concat()));
    answers.push(end.as_ref().to_vec());
    answers
}

fn compare(method: impl Integrator<f64>) {
    let times = [0.0, 0.3, 0.7, 1.0];
    let (kp, kd, target) = ([10.0, 20.0], [1.0, 2.0], [1.0, 1.0]);
    let mut fixed = ForwardSimulation::new(&Arm, Pd { target, kp, kd });
    let law = Pd { target: target.to_vec(), kp: kp.to_vec(), kd: kd.to_vec() };
    let mut dynamic = ForwardSimulation::new(&DynamicArm(2), law);

    let array = answers(|output: &mut dyn FnMut(f64, &[f64; 5])| {
        let start = fixed.state(&Q, &V);
        method.solve(&mut fixed, (0.0, 1.0), start, times, output).unwrap().y
    });
    let vec = answers(|output: &mut dyn FnMut(f64, &Vec<f64>)| {
        let start = dynamic.state(&Q.to_vec(), &V.to_vec());
        method.solve(&mut dynamic, (0.0, 1.0), start, times, output).unwrap().y
    });
    assert_eq!(array.len(), 5);
    assert_eq!(array, vec);
}

#[test]
fn vectors_give_the_same_bits_as_arrays() {
    compare(Ode5::new(0.01));
    compare(Ode45::new());
    compare(Ode15s::new());
}

fn refused(law: impl TorqueLaw<f64, DynamicArm>) -> IntegrationError<f64> {
    let mut simulation = ForwardSimulation::new(&DynamicArm(2), law);
    let start = simulation.state(&Q.to_vec(), &V.to_vec());
    Ode45::new().integrate(&mut simulation, (0.0, 1.0), start).unwrap_err()
}

fn wrong(vector: &'static str, length: usize, expected: usize) -> IntegrationError<f64> {
    IntegrationError::WrongLength(LengthMismatch { vector, length, expected })
}

#[test]
fn a_simulation_begins_only_with_gains_and_targets_of_the_right_length() {
    let two = || vec![1.0; 2];
    assert_eq!(refused(Proportional { target: two(), kp: vec![1.0] }), wrong("kp", 1, 2));
    assert_eq!(refused(Proportional { target: vec![0.0; 3], kp: two() }), wrong("target", 3, 2));
    assert_eq!(refused(Pd { target: two(), kp: two(), kd: vec![] }), wrong("kd", 0, 2));
    assert_eq!(refused(Pd { target: vec![], kp: two(), kd: two() }), wrong("target", 0, 2));

    let motion =
        |q: usize, v: usize, a: usize| move |_t: f64| Motion { q: vec![0.0; q], v: vec![0.0; v], a: vec![0.0; a] };
    assert_eq!(refused(TrackingPd { trajectory: motion(2, 2, 2), kp: vec![1.0; 4], kd: two() }), wrong("kp", 4, 2));
    assert_eq!(refused(TrackingPd { trajectory: motion(2, 1, 2), kp: two(), kd: two() }), wrong("trajectory.v", 1, 2));
    let torques = |trajectory| ComputedTorque { mechanism: &DynamicArm(2), trajectory, kp: two(), kd: two() };
    assert_eq!(refused(torques(motion(3, 2, 2))), wrong("trajectory.q", 3, 2));
    assert_eq!(refused(torques(motion(2, 2, 0))), wrong("trajectory.a", 0, 2));
    assert_eq!(wrong("kp", 1, 2).to_string(), "`kp` must have 2 elements, but it has 1");
}

#[test]
fn pid_and_limits_are_checked_for_a_component_of_each_velocity() {
    let two = || vec![1.0; 2];
    let pid = |[kp, ki, tracking, integral]: [usize; 4]| Pid {
        trajectory: SetPoint::new(&DynamicArm(2), vec![0.0; 2]),
        kp: vec![1.0; kp],
        ki: vec![1.0; ki],
        kd: two(),
        tracking: vec![1.0; tracking],
        integral: vec![0.0; integral],
    };
    let checked = |law: &dyn TorqueLaw<f64, DynamicArm>| law.check_lengths(0.0, &DynamicArm(2));
    let wrong = |vector, length| Err(LengthMismatch { vector, length, expected: 2 });
    assert_eq!(checked(&pid([2, 2, 2, 2])), Ok(()));
    assert_eq!(checked(&pid([1, 2, 2, 2])), wrong("kp", 1));
    assert_eq!(checked(&pid([2, 3, 2, 2])), wrong("ki", 3));
    assert_eq!(checked(&pid([2, 2, 0, 2])), wrong("tracking", 0));
    assert_eq!(checked(&pid([2, 2, 2, 1])), wrong("integral", 1));
    assert_eq!(checked(&Limited { law: pid([2, 2, 2, 2]), limits: vec![1.0] }), wrong("limits", 1));
    assert_eq!(checked(&Limited { law: pid([2, 2, 2, 1]), limits: two() }), wrong("integral", 1));
    // A force for each velocity all the same, NaN where something is missing.
    let mut short = Limited { law: pid([2, 1, 2, 2]), limits: vec![1.0] };
    let (at, mut rates) = ((Q.to_vec(), V.to_vec()), [0.0_f64; 3]);
    let short: &mut dyn TorqueLaw<f64, DynamicArm> = &mut short;
    let force = short.torque_with_state(&DynamicArm(2), 0.0, (&at.0, &at.1), &[0.0], &mut rates);
    assert!(force.len() == 2 && force[1].is_nan() && rates[1].is_nan());
}

#[test]
fn a_law_that_is_evaluated_outside_a_simulation_gives_nan_for_a_missing_gain() {
    let mut short_gain = Proportional { target: vec![0.0; 2], kp: vec![1.0] };
    let torque = short_gain.torque(&DynamicArm(2), 0.0, &Q.to_vec(), &V.to_vec());
    assert!(torque.len() == 2 && torque[0] == -0.5 && torque[1].is_nan());
}

#[test]
fn a_start_of_the_wrong_length_is_reported() {
    let mut simulation = ForwardSimulation::new(&DynamicArm(2), ZeroTorque);
    let mut error = |start| Ode45::new().integrate(&mut simulation, (0.0, 1.0), start).unwrap_err();
    let state = |q: &[f64], v: &[f64]| ForwardSimulation::new(&DynamicArm(2), ()).state(&q.to_vec(), &v.to_vec());
    assert_eq!(error(state(&[0.1], &V)), wrong("state", 4, 5));
    assert_eq!(error(state(&Q, &[0.1, 0.2, 0.3])), wrong("state", 6, 5));
    // Coordinates and velocities whose lengths are wrong by as much.
    assert_eq!(error(state(&[0.1], &[0.1, 0.2, 0.3])), IntegrationError::NonFiniteState { t: 0.0, component: 1 });
    assert_eq!(error(state(&[0.1, 0.2, 0.3], &[0.1])), IntegrationError::NonFiniteState { t: 0.0, component: 3 });
    assert_eq!(error(vec![0.1; 3]), wrong("state", 3, 5));
}

#[test]
fn a_state_without_components_is_integrated_to_the_end() {
    let mut nothing = |_t: f64, _y: &Vec<f64>, _dydt: &mut Vec<f64>| {};
    for end in [
        Ode45::new().integrate(&mut nothing, (0.0, 1.0), vec![]),
        Ode15s::new().integrate(&mut nothing, (0.0, 1.0), vec![]),
    ] {
        let end = end.unwrap();
        assert_eq!((end.t, end.y.len()), (1.0, 0));
    }
}

/// What a derivative lacks is not a number: it must not pass for a component that stands still.
#[test]
fn a_derivative_that_is_too_short_is_reported() {
    fn outcome(method: impl Integrator<f64>) -> Result<Solution<f64, Vec<f64>>, IntegrationError<f64>> {
        let mut short = |_t: f64, y: &Vec<f64>, dydt: &mut Vec<f64>| *dydt = vec![-y[0]];
        method.integrate(&mut short, (0.0, 1.0), vec![1.0, 1.0])
    }
    let expected = Err(IntegrationError::NonFiniteDerivative { t: 0.0, component: 1 });
    assert_eq!(outcome(Ode5::new(0.1)), expected);
    assert_eq!(outcome(Ode45::new()), expected);
    assert_eq!(outcome(Ode15s::new()), expected);
    assert_eq!(outcome(Radau5::new()), expected);
    assert_eq!(outcome(Gauss4::new(0.1)), expected);
}

#[test]
fn accelerations_that_are_too_few_are_reported() {
    let mut simulation = ForwardSimulation::new(&DynamicArm(1), ZeroTorque);
    let start = simulation.state(&Q.to_vec(), &V.to_vec());
    let error = Ode45::new().integrate(&mut simulation, (0.0, 1.0), start).unwrap_err();
    assert_eq!(error, IntegrationError::NonFiniteDerivative { t: 0.0, component: 3 });
}

/// A correction that leaves a part of the state out.
struct Forgetful;

impl Ode<f64, Vec<f64>> for Forgetful {
    fn derivative(&mut self, _t: f64, _y: &Vec<f64>, dydt: &mut Vec<f64>) {
        dydt.fill(1.0);
    }

    fn accepted(&mut self, _t: f64, _step: f64, y: &mut Vec<f64>) -> Accepted {
        y.truncate(1);
        Accepted::Corrected
    }
}

#[test]
fn a_corrected_state_that_is_too_short_is_reported() {
    let outcome = Ode5::new(0.5).integrate(&mut Forgetful, (0.0, 1.0), vec![1.0, 1.0]);
    assert_eq!(outcome, Err(IntegrationError::NonFiniteState { t: 0.5, component: 1 }));
}

/// A tangent that leaves a part of the slope out.
struct ShortTangent;

impl Ode<f64, Vec<f64>> for ShortTangent {
    fn derivative(&mut self, _t: f64, y: &Vec<f64>, dydt: &mut Vec<f64>) {
        dydt[0] = -y[0];
        dydt[1] = -1e6 * y[1];
    }

    fn tangent(&mut self, _t: f64, _y: &Vec<f64>, direction: &Vec<f64>, slope: &mut Vec<f64>) -> bool {
        *slope = vec![-direction[0]];
        true
    }
}

#[test]
fn a_tangent_that_is_too_short_is_reported() {
    let expected = Err(IntegrationError::NonFiniteDerivative { t: 0.0, component: 1 });
    assert_eq!(Ode15s::new().integrate(&mut ShortTangent, (0.0, 1.0), vec![1.0, 1.0]), expected);
    assert_eq!(Radau5::new().integrate(&mut ShortTangent, (0.0, 1.0), vec![1.0, 1.0]), expected);
}
