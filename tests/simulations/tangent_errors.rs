//! Steps from tolerances weigh errors of an orientation on the tangent: how a body is turned at the start changes
//! neither their number nor their sizes. Implicit methods differentiate along the tangent.
#![cfg(feature = "generic")]

use crate::common::methods::{WithMethod, every_adaptive};
use crate::common::models::generic;
use nalgebra::{Quaternion, UnitQuaternion, Vector3, Vector4};
use redysim::Real;
use redysim::integrate::{Accepted, Tolerances};
use redysim::{
    Dop853, ForwardDynamics, ForwardSimulation, Integrator, Mechanism, Ode, Ode15s, Radau5, Statistics, Step, Vector,
    VelocityCoordinates, ZeroTorque, redysim,
};

redysim! {
    /// A body that turns about a point.
    pub struct Body(
        "models/spherical_pendulum.toml",
        functions = [forward_dynamics],
        parameters = ["gravity"]
    );
}

redysim! {
    /// A body that moves freely.
    pub struct Parcel("models/parcel.toml", functions = [forward_dynamics], parameters = ["gravity"]);
}

type Simulation<'m, M> = ForwardSimulation<'m, M, ZeroTorque>;

/// (x, y, z, w) of the rotation `turn` after that of the quaternion `q`.
fn turned_quaternion(turn: &UnitQuaternion<f64>, q: &[f64]) -> Vector4<f64> {
    (turn.quaternion() * Quaternion::new(q[3], q[0], q[1], q[2])).coords
}

/// The state of a mechanism whose first joint turns about a point or moves freely, in axes of the base that are turned.
fn turned<Y: Vector<f64>>(turn: &UnitQuaternion<f64>, mechanism: &impl Mechanism, state: &Y) -> Y {
    let mut state = state.clone();
    let y = state.as_mut();
    let first = if mechanism.coordinates_of_velocity(0) == VelocityCoordinates::Position(0) { 3 } else { 0 };
    if first == 3 {
        let position = turn * Vector3::new(y[0], y[1], y[2]);
        y[..3].copy_from_slice(position.as_slice());
    }
    let q = turned_quaternion(turn, &y[first..first + 4]);
    y[first..first + 4].copy_from_slice(q.as_slice());
    state
}

/// Turns of which one leaves a quaternion of few components, one exchanges axes, and others do neither.
fn turns() -> Vec<UnitQuaternion<f64>> {
    let vectors = [[0.0; 3], [0.0, 0.0, 3.0], [-1.3, 0.4, 2.2], [0.7, -2.1, 0.3], [1e-3, 0.0, -0.5]];
    vectors.map(|vector| UnitQuaternion::new(Vector3::from(vector))).into()
}

/// Holds the steps from each of several states against those from the first.
struct SameSteps<'m, M, Y> {
    mechanism: &'m M,
    starts: Vec<Y>,
    end: f64,
    largest_difference: f64,
}

impl<M: ForwardDynamics<f64>, Y: Vector<f64>> WithMethod for SameSteps<'_, M, Y> {
    fn with(&mut self, name: &str, method: &impl Integrator<f64>) {
        let runs = self.starts.iter().map(|start| {
            let mut times = Vec::new();
            let mut simulation: Simulation<'_, M> = ForwardSimulation::new(self.mechanism, ZeroTorque);
            let on_step = |step: &Step<'_, f64, Y>| times.push(step.end().0);
            let end = method.each_step(&mut simulation, (0.0, self.end), start.clone(), on_step).expect("it moves");
            (end.statistics, times)
        });
        let runs: Vec<(Statistics, Vec<f64>)> = runs.collect();
        let (expected, times) = &runs[0];
        for (statistics, others) in &runs {
            // Evaluations may differ by those after corrections of the length, which are left out where it is one to rounding.
            let counts = |s: &Statistics| (s.steps, s.rejected);
            assert_eq!(counts(statistics), counts(expected), "{name}");
            for (one, other) in times.iter().zip(others) {
                self.largest_difference = self.largest_difference.max((one - other).abs() / self.end);
            }
        }
        println!("{name}: {expected:?}, times differ by {:.1e} at most", self.largest_difference);
    }
}

fn assert_same_steps<M: ForwardDynamics<f64>, Y: Vector<f64>>(mechanism: &M, start: Y, end: f64) {
    let starts = turns().iter().map(|turn| turned(turn, mechanism, &start)).collect();
    let mut same = SameSteps { mechanism, starts, end, largest_difference: 0.0 };
    for rtol in [1e-3, 1e-5, 1e-7] {
        every_adaptive(rtol, 1e-3 * rtol, &mut same);
    }
    // Roundings of 1e-16 in errors of 1e-7 and less, over many steps.
    assert!(same.largest_difference < 1e-8, "{:e}", same.largest_difference);
}

const SPIN: [f64; 3] = [1.0, 7.0, -2.0];

#[test]
fn a_body_that_is_turned_at_the_start_takes_the_same_steps() {
    let body = Body::new(&[0.0; 3]);
    let start: [f64; 8] = ForwardSimulation::new(&body, ZeroTorque).state(&[0.0, 0.0, 0.0, 1.0], &SPIN);
    assert_same_steps(&body, start, 4.0);
}

#[test]
fn a_body_that_is_thrown_in_axes_that_are_turned_takes_the_same_steps() {
    let parcel = Parcel::new(&[0.0; 3]);
    let (q, v) = ([0.2, -0.1, 0.3, 0.0, 0.0, 0.0, 1.0], [2.0, -3.0, 1.0, 0.3, 4.0, -0.2]);
    let start: [f64; 14] = ForwardSimulation::new(&parcel, ZeroTorque).state(&q, &v);
    assert_same_steps(&parcel, start, 4.0);
}

#[test]
fn the_generic_path_takes_the_steps_of_the_compiled_one() {
    let (body, generic) = (Body::new(&[0.0, 0.0, -9.81]), generic("spherical_pendulum"));
    let (q, v) = ([0.1, -0.2, 0.3, (1.0_f64 - 0.14).sqrt()], SPIN);
    let method = Dop853::new().rtol(1e-6).atol(1e-9);
    let compiled: [f64; 8] = ForwardSimulation::new(&body, ZeroTorque).state(&q, &v);
    let compiled = method.integrate(&mut ForwardSimulation::new(&body, ZeroTorque), (0.0, 3.0), compiled);
    let mut simulation = ForwardSimulation::new(&generic, ZeroTorque);
    let start = simulation.state(&q.to_vec(), &v.to_vec());
    let by_generic = method.integrate(&mut simulation, (0.0, 3.0), start);
    let [one, other] = [compiled.expect("it turns").statistics, by_generic.expect("it turns").statistics];
    assert_eq!((one.steps, one.rejected), (other.steps, other.rejected));
}

/// The angle by which a body that is let spin for 4 s is turned wrongly at the end, in rad, over a range of tolerances.
struct Proportional {
    exact: [f64; 8],
    rtol: f64,
    errors: Vec<(String, f64, f64)>,
}

impl WithMethod for Proportional {
    fn with(&mut self, name: &str, method: &impl Integrator<f64>) {
        let body = Body::new(&[0.0; 3]);
        let mut simulation = ForwardSimulation::new(&body, ZeroTorque);
        let start: [f64; 8] = simulation.state(&[0.0, 0.0, 0.0, 1.0], &SPIN);
        let y = method.integrate(&mut simulation, (0.0, 4.0), start).expect("it turns").y;
        let quaternion = |y: &[f64; 8]| UnitQuaternion::from_quaternion(Quaternion::new(y[3], y[0], y[1], y[2]));
        let angle = quaternion(&y).angle_to(&quaternion(&self.exact));
        println!("{name}, {:.0e}: {angle:.1e} rad", self.rtol);
        self.errors.push((name.to_owned(), self.rtol, angle));
    }
}

/// Over six decades the error as a multiple of the tolerance changes by less than a factor of 30; that of `Ode15s`, whose
/// steps are many, is the largest.
#[test]
fn the_error_of_an_orientation_is_proportional_to_the_tolerance() {
    let body = Body::new(&[0.0; 3]);
    let mut simulation = ForwardSimulation::new(&body, ZeroTorque);
    let start: [f64; 8] = simulation.state(&[0.0, 0.0, 0.0, 1.0], &SPIN);
    let exact =
        Dop853::new().rtol(1e-13).atol(1e-15).integrate(&mut simulation, (0.0, 4.0), start).expect("it turns").y;
    let mut proportional = Proportional { exact, rtol: 0.0, errors: Vec::new() };
    for rtol in [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10] {
        proportional.rtol = rtol;
        every_adaptive(rtol, 1e-3 * rtol, &mut proportional);
    }
    for name in ["Ode45", "Dop853", "Ode15s", "Radau5"] {
        let shares = proportional.errors.iter().filter(|(of, ..)| of == name).map(|(_, rtol, angle)| angle / rtol);
        let (least, most) =
            shares.fold((f64::INFINITY, 0.0_f64), |(least, most), x| (least.min(x), Real::maximum(most, x)));
        println!("{name}: {least:.1} to {most:.1} times the tolerance");
        assert!(most < 1e3 && most < 30.0 * least, "{name}: {least} to {most}");
    }
}

/// The error norm of a turn is its angle for each orientation and each axis. A change of the length alone has the norm zero.
#[test]
fn an_error_of_an_orientation_is_as_large_as_its_angle() {
    let body = Body::new(&[0.0; 3]);
    let simulation = ForwardSimulation::new(&body, ZeroTorque);
    let tolerances = Tolerances::new(1e-6, 1e-9);
    for turn in turns() {
        let start: [f64; 8] = simulation.state(&[0.0, 0.0, 0.0, 1.0], &[0.0; 3]);
        let start = turned(&turn, &body, &start);
        for (axis, angle) in [(0, 1e-3), (1, 1e-7), (2, 3.0)] {
            let mut along = [0.0; 4];
            along[axis] = 0.5 * angle;
            let mut error = [0.0; 8];
            let vector = turn.quaternion() * Quaternion::new(along[3], along[0], along[1], along[2]);
            error[..4].copy_from_slice(vector.coords.as_slice());
            let size = simulation.error_norm(&tolerances, &error, &start, &start);
            assert!((size / angle - 1.0).abs() < 1e-6, "{size:e} instead of {angle:e}");
        }
        let mut lengthened = start.map(|x| 1e-3 * x);
        lengthened[4..].fill(0.0);
        assert!(simulation.error_norm(&tolerances, &lengthened, &start, &start) < 1e-14);
    }
}

/// The inner product of the quaternion of `y` and the same components of `direction`.
fn along_quaternion(y: &[f64; 8], direction: &[f64; 8]) -> f64 {
    (0..4).map(|i| y[i] * direction[i]).sum()
}

/// A simulation that records along how many directions it is differentiated, and how far they leave the tangent of the
/// quaternion. Without tangents it is differentiated by differences.
struct Differentiated<O> {
    simulation: O,
    has_tangents: bool,
    directions: u64,
    off_tangent: f64,
}

impl<O> Differentiated<O> {
    fn new(simulation: O, has_tangents: bool) -> Self {
        Differentiated { simulation, has_tangents, directions: 0, off_tangent: 0.0 }
    }
}

impl<O: Ode<f64, [f64; 8]>> Ode<f64, [f64; 8]> for Differentiated<O> {
    fn derivative(&mut self, t: f64, y: &[f64; 8], dydt: &mut [f64; 8]) {
        self.simulation.derivative(t, y, dydt);
    }
    fn accepted(&mut self, t: f64, step: f64, y: &mut [f64; 8]) -> Accepted {
        self.simulation.accepted(t, step, y)
    }
    fn error_norm(&self, tolerances: &Tolerances<'_, f64>, error: &[f64; 8], y: &[f64; 8], z: &[f64; 8]) -> f64 {
        self.simulation.error_norm(tolerances, error, y, z)
    }
    fn project_onto_tangent(&self, y: &[f64; 8], direction: &mut [f64; 8]) {
        self.simulation.project_onto_tangent(y, direction);
    }
    fn tangent(&mut self, t: f64, y: &[f64; 8], direction: &[f64; 8], slope: &mut [f64; 8]) -> bool {
        self.directions += 1;
        self.off_tangent = self.off_tangent.max(along_quaternion(y, direction).abs());
        self.has_tangents && self.simulation.tangent(t, y, direction, slope)
    }
}

#[test]
fn implicit_methods_differentiate_along_the_tangent_of_a_quaternion() {
    let body = Body::new(&[0.0, 0.0, -9.81]);
    let simulation = || ForwardSimulation::new(&body, ZeroTorque);
    let start: [f64; 8] = simulation().state(&[0.1, -0.2, 0.3, (1.0_f64 - 0.14).sqrt()], &SPIN);
    let check = |name: &str, method: &dyn Fn(&mut Differentiated<Simulation<'_, Body>>) -> u64| {
        let mut differentiated = Differentiated::new(simulation(), true);
        let jacobians = method(&mut differentiated);
        let Differentiated { directions, off_tangent, .. } = differentiated;
        println!("{name}: {jacobians} Jacobians, off the tangent by {off_tangent:.1e}");
        assert!(jacobians > 0 && directions == 8 * jacobians, "{name}: {directions} directions");
        assert!(off_tangent < 1e-15, "{name}: {off_tangent:e}");
    };
    check("Radau5", &|ode| {
        Radau5::new().rtol(1e-6).atol(1e-9).integrate(ode, (0.0, 1.0), start).expect("it turns").statistics.jacobians
    });
    check("Ode15s", &|ode| {
        Ode15s::new().rtol(1e-6).atol(1e-9).integrate(ode, (0.0, 1.0), start).expect("it turns").statistics.jacobians
    });
}

/// Of the motion of a body nothing but a change of the length of its quaternion is off the tangent.
#[test]
fn the_projection_onto_the_tangent_keeps_what_a_body_can_do_and_removes_a_change_of_length() {
    let body = Body::new(&[0.0; 3]);
    let mut simulation = ForwardSimulation::new(&body, ZeroTorque);
    for turn in turns() {
        let start: [f64; 8] = simulation.state(&[0.0, 0.0, 0.0, 1.0], &SPIN);
        let start = turned(&turn, &body, &start);
        let mut rate = [0.0; 8];
        simulation.derivative(0.0, &start, &mut rate);
        let mut projected = rate;
        simulation.project_onto_tangent(&start, &mut projected);
        assert!(
            rate.iter().zip(projected).all(|(rate, kept)| (rate - kept).abs() < 1e-14),
            "{projected:?}, not {rate:?}"
        );
        let mut longer = start;
        simulation.project_onto_tangent(&start, &mut longer);
        assert!(longer[..4].iter().all(|part| part.abs() < 1e-15), "{longer:?}");
        assert_eq!(longer[4..], start[4..]);
    }
}

/// Differences along the tangent give the Jacobian that the derivatives of the equations give, also at an orientation whose
/// quaternion has three zeros.
#[test]
fn differences_along_the_tangent_take_the_steps_of_exact_derivatives() {
    let body = Body::new(&[0.0, 0.0, -9.81]);
    let mut simulation = ForwardSimulation::new(&body, ZeroTorque);
    let start: [f64; 8] = simulation.state(&[0.0, 0.0, 0.0, 1.0], &SPIN);
    let method = Radau5::new().rtol(1e-6).atol(1e-9);
    let exact = method.integrate(&mut simulation, (0.0, 1.0), start).expect("it turns");
    let differences =
        method.integrate(&mut Differentiated::new(simulation, false), (0.0, 1.0), start).expect("it turns");
    let off = exact.y.iter().zip(&differences.y).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
    assert_eq!(exact.statistics.steps, differences.statistics.steps);
    assert!(off < 1e-6, "{off:e}");
}
