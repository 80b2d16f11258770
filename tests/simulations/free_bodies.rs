//! Bodies on spherical and free joints in motion: tops against their integrals and steady precession, a floating arm by the
//! conservation of momentum, and the lengths of quaternions.
#![cfg(feature = "generic")]

use crate::common::methods::{WithMethod, every_adaptive, every_fixed};
use crate::common::models::generic;
use core::ops::ControlFlow;
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use redysim::Real;
use redysim::generic::Inertia;
use redysim::{
    Dop853, Event, ForwardSimulation, Gauss4, Gauss6, Integrator, LengthMismatch, LinkState, Occurrence, Ode, Ode4,
    Ode45, Radau5, ZeroTorque, redysim,
};

redysim! {
    /// A body that turns about a point.
    pub struct Body(
        "models/spherical_pendulum.toml",
        functions = [forward_dynamics, energy, link_kinematics],
        parameters = ["gravity", "bob.mass", "bob.com", "bob.inertia"]
    );
}

redysim! {
    /// KR5 on a platform that floats.
    pub struct Floating(
        "models/kr5_floating.toml",
        functions = [forward_dynamics, energy, link_kinematics],
        parameters = ["gravity"]
    );
}

/// A rotation about an axis, 0 for x to 2 for z.
pub fn turn(axis: usize, angle: f64) -> Matrix3<f64> {
    *Rotation3::from_axis_angle(&Unit::new_unchecked(Vector3::ith(axis, 1.0)), angle).matrix()
}

pub fn tensor(Inertia { xx, yy, zz, xy, yz, xz }: Inertia) -> Matrix3<f64> {
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}

pub fn rotation(link: &LinkState<f64>) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| link.rotation[i][j])
}

/// A symmetric top on its tip: moments across and about its axis, and m g l.
pub struct Top {
    pub body: Body,
    pub across: f64,
    pub about: f64,
    pub weight: f64,
}

const TILT: f64 = 0.6;
const SPIN: f64 = 60.0;

impl Top {
    pub fn new() -> Top {
        let (mass, height, gravity, across, about) = (0.5, 0.08, 9.81, 0.0011, 0.002);
        let parameters = [0.0, 0.0, -gravity, mass, 0.0, 0.0, height, across, across, about, 0.0, 0.0, 0.0];
        let across = across + mass * height * height;
        Top { body: Body::new(&parameters), across, about, weight: mass * gravity * height }
    }

    /// The slower rate of steady precession: A Ω² cos θ − C ω₃ Ω + m g l = 0.
    fn precession(&self) -> f64 {
        let (momentum, twice) = (self.about * SPIN, 2.0 * self.across * TILT.cos());
        let root = (momentum * momentum - 2.0 * twice * self.weight).sqrt();
        // The difference of the two large terms without cancellation.
        2.0 * self.weight / (momentum + root)
    }

    /// Tilted about x, turning about the vertical and spinning about its axis.
    fn start(&self, precession: f64) -> ([f64; 4], [f64; 3]) {
        let (sin, cos) = (0.5 * TILT).sin_cos();
        ([sin, 0.0, 0.0, cos], [0.0, precession * TILT.sin(), SPIN])
    }

    fn tilt(&self, q: &[f64; 4], v: &[f64; 3]) -> f64 {
        let axis = rotation(&self.body.link_kinematics(q, v)[0]) * Vector3::z();
        axis.xy().norm().atan2(axis.z)
    }

    /// Energy, angular momentum about the vertical, and spin.
    fn integrals(&self, q: &[f64; 4], v: &[f64; 3]) -> [f64; 3] {
        let inertia = Matrix3::from_diagonal(&Vector3::new(self.across, self.across, self.about));
        let momentum = rotation(&self.body.link_kinematics(q, v)[0]) * inertia * Vector3::from(*v);
        [self.body.energy(q, v).total(), momentum.z, v[2]]
    }
}

#[test]
fn a_heavy_top_keeps_energy_vertical_angular_momentum_and_spin() {
    let top = Top::new();
    // Let go without precession: it falls, and rises again.
    let (q, v) = top.start(0.0);
    let before = top.integrals(&q, &v);
    let mut simulation = ForwardSimulation::new(&top.body, ZeroTorque);
    let copy = simulation;
    let state = simulation.state(&q, &v);
    let (mut worst, mut tilts) = ([0.0_f64; 3], [f64::INFINITY, 0.0_f64]);
    let on_step = |step: &redysim::Step<'_, f64, _>| {
        let now = copy.split(step.end().1);
        let after = top.integrals(&now.q, &now.v);
        for ((worst, before), after) in worst.iter_mut().zip(before).zip(after) {
            *worst = Real::maximum(*worst, (after / before - 1.0).abs());
        }
        let tilt = top.tilt(&now.q, &now.v);
        tilts = [tilts[0].min(tilt), tilts[1].max(tilt)];
    };
    let method = Dop853::new().rtol(1e-13).atol(1e-15);
    let end = if cfg!(debug_assertions) { 10.0 } else { 30.0 };
    method.each_step(&mut simulation, (0.0, end), state, on_step).expect("it spins all the time");
    println!("energy, momentum, spin {worst:?}; tilts {tilts:?}");
    assert!(tilts[1] - tilts[0] > 0.1, "it nods: {tilts:?}");
    assert!(worst.iter().all(|error| *error <= 1e-12), "{worst:?}");
}

#[test]
fn a_top_that_precesses_steadily_does_not_nod() {
    let top = Top::new();
    let precession = top.precession();
    let (q, v) = top.start(precession);
    let mut simulation = ForwardSimulation::new(&top.body, ZeroTorque);
    let copy = simulation;
    let state = simulation.state(&q, &v);
    let (mut nodded, mut turned) = (0.0_f64, 0.0_f64);
    let times = (0..=300).map(|i| 0.1 * f64::from(i));
    Dop853::new()
        .rtol(1e-13)
        .atol(1e-15)
        .solve(&mut simulation, (0.0, 30.0), state, times, |t, state| {
            let now = copy.split(state);
            nodded = nodded.max((top.tilt(&now.q, &now.v) - TILT).abs());
            // The axis goes round the vertical at the rate of precession, from where it was at first: −y.
            let axis = rotation(&top.body.link_kinematics(&now.q, &now.v)[0]) * Vector3::z();
            let (sin, cos) = (precession * t).sin_cos();
            turned = turned.max((axis - Vector3::new(TILT.sin() * sin, -TILT.sin() * cos, TILT.cos())).norm());
        })
        .expect("it spins for 30 s");
    println!("precession {precession:.3} rad/s, nodded {nodded:.1e} rad, off {turned:.1e}");
    assert!(nodded <= 1e-11, "{nodded:e} rad");
    // 30 s at several rad/s.
    assert!(turned <= 1e-10, "{turned:e}");
}

/// Momentum of all links and, as the scale of each, the sum of the parts' sizes.
fn momentum(links: &[LinkState<f64>], bodies: &[(f64, Inertia)]) -> ([Vector3<f64>; 2], [f64; 2]) {
    let (mut sums, mut sizes) = ([Vector3::zeros(); 2], [0.0; 2]);
    for (link, (mass, inertia)) in links.iter().zip(bodies) {
        let [origin, com, velocity, w] =
            [link.origin, link.com, link.velocity, link.angular_velocity].map(Vector3::from);
        let linear = *mass * (velocity + w.cross(&(com - origin)));
        let own = rotation(link) * tensor(*inertia) * rotation(link).transpose() * w;
        let angular = com.cross(&linear) + own;
        sums = [sums[0] + linear, sums[1] + angular];
        sizes = [sizes[0] + linear.norm(), sizes[1] + angular.norm()];
    }
    (sums, sizes)
}

const ARM: ([f64; 13], [f64; 12]) = (
    [0.2, -0.1, 0.4, 0.1, 0.3, -0.2, 0.927_361_849_549_570_4, 0.3, -0.8, 1.1, 0.7, -0.4, 0.9],
    [0.02, -0.03, 0.01, 0.1, -0.2, 0.15, 0.5, -0.4, 0.6, 0.8, -0.7, 0.3],
);

#[test]
fn a_floating_arm_without_gravity_keeps_its_momentum_and_its_energy() {
    let (arm, (q, v)) = (Floating::new(&[0.0; 3]), ARM);
    let model = generic("kr5_floating");
    let bodies: Vec<(f64, Inertia)> = model.model().links.iter().map(|link| (link.mass, link.inertia)).collect();
    let mut simulation = ForwardSimulation::new(&arm, ZeroTorque);
    let copy = simulation;
    let state = simulation.state(&q, &v);
    let at = |q: &[f64; 13], v: &[f64; 12]| (momentum(&arm.link_kinematics(q, v), &bodies), arm.energy(q, v).kinetic);
    let ((before, _), energy) = at(&q, &v);
    let (mut worst, mut moved, mut lengths) = ([0.0_f64; 3], 0.0_f64, 0.0_f64);
    let on_step = |step: &redysim::Step<'_, f64, _>| {
        let now = copy.split(step.end().1);
        let ((after, sizes), kinetic) = at(&now.q, &now.v);
        let errors = [0, 1].map(|i| (after[i] - before[i]).norm() / sizes[i]);
        for (worst, error) in worst.iter_mut().zip([errors[0], errors[1], (kinetic / energy - 1.0).abs()]) {
            *worst = Real::maximum(*worst, error);
        }
        moved = now.q[7..].iter().zip(&q[7..]).fold(moved, |most, (now, then)| Real::maximum(most, (now - then).abs()));
        let length = now.q[3..7].iter().map(|x| x * x).sum::<f64>().sqrt();
        lengths = lengths.max((length - 1.0).abs());
    };
    let method = Dop853::new().rtol(1e-13).atol(1e-15);
    let end = method.each_step(&mut simulation, (0.0, 30.0), state, on_step).expect("it floats for 30 s");
    println!(
        "momenta and energy {worst:?}, lengths {lengths:.1e}, joints moved by {moved:.1} rad, {:?}",
        end.statistics
    );
    assert!(moved > 3.0, "joints move: {moved} rad");
    assert!(worst.iter().all(|error| *error <= 1e-12), "{worst:?}");
    // Beyond 4096 roundings of a component, at most twice that of the length, a step corrects it.
    assert!(lengths <= 2e-12, "{lengths:e}");
}

/// The worst length of the quaternion at the steps of a second and a half of the nodding top, by a loose method.
#[test]
fn quaternions_keep_their_length_under_loose_methods() {
    let top = Top::new();
    let (q, v) = top.start(0.0);
    for tolerance in [1e-3, 1e-6] {
        let mut simulation = ForwardSimulation::new(&top.body, ZeroTorque);
        let copy = simulation;
        let state = simulation.state(&q, &v);
        let mut worst = 0.0_f64;
        let on_step = |step: &redysim::Step<'_, f64, _>| {
            let length = copy.split(step.end().1).q.iter().map(|x| x * x).sum::<f64>().sqrt();
            worst = Real::maximum(worst, (length - 1.0).abs());
        };
        let method = Ode45::new().rtol(tolerance).atol(1e-3 * tolerance);
        let end = method.each_step(&mut simulation, (0.0, 30.0), state, on_step).expect("it spins");
        println!("{tolerance:e}: {worst:.1e} in {:?}", end.statistics);
        // A correction leaves half the square of the local error, which the tolerance bounds.
        assert!(worst <= 10.0 * tolerance * tolerance + 2e-12, "{tolerance:e}: {worst:e}");
    }
}

/// A second of the nodding top by each method, at times and at events within its steps.
struct LengthsWithinSteps {
    /// How far lengths are from 1 at least where they are not corrected.
    least: f64,
    /// How far they are from it at most where they are.
    most: f64,
}

impl WithMethod for LengthsWithinSteps {
    fn with(&mut self, name: &str, method: &impl Integrator<f64>) {
        const END: f64 = 1.0;
        let top = Top::new();
        let (q, v) = top.start(0.0);
        let mut simulation = ForwardSimulation::new(&top.body, ZeroTorque);
        let copy = simulation;
        let off = |state: &_| (copy.split(state).q.iter().map(|x| x * x).sum::<f64>().sqrt() - 1.0).abs();
        let state = simulation.state(&q, &v);
        let (mut between, mut at_events, mut events_found, mut uncorrected) = (0.0_f64, 0.0_f64, 0, 0.0_f64);
        let times = (0..=1000).map(|i| 1e-3 * f64::from(i));
        method
            .solve(&mut simulation, (0.0, END), state, times, |_, y| between = between.max(off(y)))
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let on_step = |step: &redysim::Step<'_, f64, _>| {
            for part in [0.3, 0.5, 0.8] {
                let (start, end) = (step.start().0, step.end().0);
                uncorrected = uncorrected.max(off(&step.at(start + part * (end - start))));
            }
        };
        method.each_step(&mut simulation, (0.0, END), state, on_step).expect("it spins");
        let halfway = |_: f64, y: &_| copy.split(y).q[0];
        let on_event = |event: Occurrence<'_, f64, _>| {
            (at_events, events_found) = (at_events.max(off(event.y)), events_found + 1);
            ControlFlow::Continue(())
        };
        let (mut events, ignored) = ([Event::any(&halfway)], |_: &redysim::Step<'_, f64, _>| ControlFlow::Continue(()));
        method.solve_with_events(&mut simulation, (0.0, END), state, &mut events, ignored, on_event).expect("it spins");
        println!("{name}: {uncorrected:.1e} without, {between:.1e} at times, {at_events:.1e} at {events_found} events");
        assert!(uncorrected > self.least, "{name}: {uncorrected:e}");
        let corrected = f64::min(2.0 * uncorrected * uncorrected + 2e-12, self.most);
        assert!(between < corrected, "{name}: {between:e} of {uncorrected:e}");
        assert!(events_found > 3 && at_events < corrected, "{name}: {at_events:e} at {events_found} events");
    }
}

/// The dense output alone does not keep the length; states at times that are asked for, and at events, are corrected, which
/// leaves 3/8 of the square of what they are off by; the ends of steps are off by a little more than what is within.
#[test]
fn quaternions_have_length_one_within_steps_of_every_method_and_at_its_events() {
    // Steps in which the quaternion turns by 0.3 rad, where the method of first order changes its length by three quarters.
    every_fixed(1e-2, &mut LengthsWithinSteps { least: 1e-11, most: 0.3 });
    every_adaptive(1e-4, 1e-7, &mut LengthsWithinSteps { least: 1e-9, most: 1e-6 });
    if !cfg!(debug_assertions) {
        every_fixed(1e-3, &mut LengthsWithinSteps { least: 0.0, most: 1e-5 });
    }
}

/// The equations of a simulation, whose states are not corrected after steps.
struct Uncorrected<O>(O);

impl<O: Ode<f64, [f64; 8]>> Ode<f64, [f64; 8]> for Uncorrected<O> {
    fn derivative(&mut self, t: f64, y: &[f64; 8], dydt: &mut [f64; 8]) {
        self.0.derivative(t, y, dydt);
    }
    fn check_lengths(&self, t: f64, y: &[f64; 8]) -> Result<(), LengthMismatch> {
        self.0.check_lengths(t, y)
    }
    fn project_onto_tangent(&self, y: &[f64; 8], direction: &mut [f64; 8]) {
        self.0.project_onto_tangent(y, direction);
    }
    fn tangent(&mut self, t: f64, y: &[f64; 8], direction: &[f64; 8], slope: &mut [f64; 8]) -> bool {
        self.0.tangent(t, y, direction, slope)
    }
    fn coordinate_rates(&mut self, t: f64, y: &[f64; 8], rates: &mut [f64; 8]) -> usize {
        self.0.coordinate_rates(t, y, rates)
    }
}

/// How far from 1 the length of the quaternion of a top comes in a second of steps of 2.5 ms, without corrections.
fn length_error(method: &impl Integrator<f64>) -> f64 {
    let top = Top::new();
    let (q, v) = top.start(0.0);
    let simulation = ForwardSimulation::new(&top.body, ZeroTorque);
    let state: [f64; 8] = simulation.state(&q, &v);
    let mut worst = 0.0_f64;
    let on_step = |step: &redysim::Step<'_, f64, [f64; 8]>| {
        let length = step.end().1[..4].iter().map(|x| x * x).sum::<f64>().sqrt();
        worst = Real::maximum(worst, (length - 1.0).abs());
    };
    method.each_step(&mut Uncorrected(simulation), (0.0, 1.0), state, on_step).expect("it spins");
    worst
}

/// The length is a quadratic invariant of q' = N(q) v, which Gauss methods keep (Hairer, Lubich and Wanner, *Geometric
/// Numerical Integration*, theorem IV.2.1), up to the roundings of the stages in a few hundred steps; other methods
/// change it by their local errors.
#[test]
fn gauss_methods_keep_the_length_of_a_quaternion_without_corrections_and_others_do_not() {
    const STEP: f64 = 2.5e-3;
    let [fourth, sixth] = [length_error(&Gauss4::new(STEP)), length_error(&Gauss6::new(STEP))];
    let explicit = length_error(&Ode4::new(STEP));
    println!("length off by {fourth:.1e} and {sixth:.1e} by Gauss, {explicit:.1e} by Runge and Kutta");
    assert!(fourth <= 1e-14 && sixth <= 1e-14, "{fourth:e} {sixth:e}");
    // (h ω/2)⁶/144 a step, 0.075⁶/144 · 400.
    assert!(explicit > 1e-8, "{explicit:e}");
}

/// Their Jacobian has ∂(N(q) v)/∂q, which the test of tangents below holds against differences.
#[test]
fn implicit_methods_agree_about_a_nodding_top() {
    let top = Top::new();
    let (q, v) = top.start(0.0);
    let mut simulation = ForwardSimulation::new(&top.body, ZeroTorque);
    let state = simulation.state(&q, &v);
    let mut end = |method: &dyn Fn(&mut ForwardSimulation<'_, Body, ZeroTorque>) -> [f64; 8]| method(&mut simulation);
    let exact =
        end(&|ode| Dop853::new().rtol(1e-13).atol(1e-15).integrate(ode, (0.0, 2.0), state).expect("explicit").y);
    let radau = end(&|ode| Radau5::new().rtol(1e-11).atol(1e-13).integrate(ode, (0.0, 2.0), state).expect("Radau").y);
    let gauss = end(&|ode| Gauss6::new(1e-3).integrate(ode, (0.0, 2.0), state).expect("Gauss").y);
    for (found, name) in [(radau, "Radau5"), (gauss, "Gauss6")] {
        let error = found.iter().zip(&exact).fold(0.0_f64, |worst, (x, y)| Real::maximum(worst, (x - y).abs()));
        println!("{name}: {error:.1e}");
        // Of velocities of 60 rad/s after 19 turns.
        assert!(error <= 1e-7, "{name}: {error:e}");
    }
}

#[test]
fn the_tangent_of_a_simulation_is_its_derivative_along_a_direction() {
    let (arm, (q, v)) = (Floating::new(&[0.3, -1.0, -9.0]), ARM);
    let mut simulation = ForwardSimulation::new(&arm, ZeroTorque);
    let state: [f64; 26] = simulation.state(&q, &v);
    // Each coordinate and velocity on its own.
    for element in 0..25 {
        let mut direction = [0.0; 26];
        direction[element] = 1.0;
        let mut slope = [0.0; 26];
        assert!(simulation.tangent(0.0, &state, &direction, &mut slope), "a compiled type has tangents");
        let mut rate = |step: f64| {
            let mut rate = [0.0; 26];
            let mut moved = state;
            moved[element] += step;
            simulation.derivative(0.0, &moved, &mut rate);
            rate
        };
        const STEP: f64 = 1e-5;
        let (ahead, behind) = (rate(STEP), rate(-STEP));
        let size = slope.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
        for i in 0..26 {
            let difference = (ahead[i] - behind[i]) / (2.0 * STEP);
            // Central differences are right to the square of the step, times third derivatives of some hundreds.
            assert!((slope[i] - difference).abs() <= 1e-6 * size, "{i} along {element}: {} or {difference}", slope[i]);
        }
    }
}
