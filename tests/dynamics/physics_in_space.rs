//! Rotors, damping, friction and springs in joints with several degrees of freedom, against closed forms, gradients and the
//! balance of energy. `random_trees.rs` has them against Kane's equations.
#![cfg(feature = "generic")]

use crate::common::text::mechanism;
use redysim::Real;
use redysim::generic::{CutKind, CutSide, GenericMechanism, Loop, Model, Vec3};
use redysim::{
    BiasForces, ClosedLoop, ClosedLoopSimulation, ConfigurationSpace, ForwardDynamics, ForwardSimulation, Integrator,
    MassMatrix, MechanicalEnergy, Ode45, ParameterRule, PassiveForces, Radau5, SimulationState, ZeroTorque, redysim,
};

redysim! {
    /// A hull in a bushing, a ball joint and a universal joint.
    struct Bushing(
        "models/test/bushing.toml",
        functions = [inverse_dynamics, forward_dynamics, bias_forces, passive_forces, energy]
    );
}

redysim! {
    /// The same with what acts in its joints given at run time.
    struct Worn(
        "models/test/bushing.toml",
        functions = [forward_dynamics, passive_forces],
        parameters = ["hull.damping", "ball.stiffness", "ball.rest", "cross.armature", "cross.rest", "hull.friction"]
    );
}

const Q: [f64; 13] = [0.1, 0.05, -0.1, 0.3, -0.2, 0.4, 0.8, 0.2, 0.5, -0.1, 0.7, 0.4, -0.6];
const V: [f64; 11] = [0.4, -0.7, 0.2, 1.1, -0.8, 0.5, -1.5, 0.9, 2.0, -0.6, 1.3];
const A: [f64; 11] = [1.0, 0.3, -2.0, 4.0, 0.7, -3.0, 2.5, -1.2, 0.9, 5.0, -4.0];

fn generic() -> GenericMechanism {
    GenericMechanism::new(Model::load("models/test/bushing.toml").expect("a valid model").model)
}

fn assert_close(found: &[f64], expected: &[f64], bound: f64) {
    assert_eq!(found.len(), expected.len());
    let largest = expected.iter().fold(0.0_f64, |largest, x| Real::maximum(largest, x.abs()));
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= bound * largest, "{found} instead of {expected}");
    }
}

/// Displacement and velocity of m ẍ + d ẋ + k x = 0 after a time.
fn oscillation(mass: f64, damping: f64, stiffness: f64, [x, v]: [f64; 2], time: f64) -> [f64; 2] {
    let decay = damping / (2.0 * mass);
    let frequency = (stiffness / mass - decay * decay).sqrt();
    let ((sin, cos), shrunk) = (f64::sin_cos(frequency * time), (-decay * time).exp());
    let (a, b) = (x, (v + decay * x) / frequency);
    [shrunk * (a * cos + b * sin), shrunk * ((b * frequency - decay * a) * cos - (a * frequency + decay * b) * sin)]
}

/// The state after a time without joint forces.
fn moved(mechanism: &GenericMechanism, q: &[f64], v: &[f64], time: f64) -> Vec<f64> {
    let mut simulation = ForwardSimulation::new(mechanism, ZeroTorque);
    let start = simulation.state(&q.to_vec(), &v.to_vec());
    Ode45::new().rtol(1e-11).atol(1e-13).integrate(&mut simulation, (0.0, time), start).expect("it moves").y
}

/// A sphere about its centre turns about one axis, whichever it is: (I + J) φ̈ + d φ̇ + k φ = 0.
#[test]
fn a_sphere_in_a_ball_joint_with_a_spring_and_a_damper_turns_as_its_closed_form() {
    let sphere = mechanism(
        "name = 'sphere'\ngravity = [0, 0, -9.81]\n[[link]]\nname = 'sphere'\nparent = 'base'\njoint = 'spherical'\n\
         origin = {}\nmass = 1.0\ninertia = { xx = 0.4, yy = 0.4, zz = 0.4 }\narmature = 0.1\ndamping = 0.3\n\
         stiffness = 8.0\nrest = [0.2, -0.1, 0.4, 0.8]",
    );
    let (rest, axis, time) = (vec![0.2, -0.1, 0.4, 0.8], [0.48, -0.6, 0.64], 1.3);
    // From a displacement of 2.9 rad, near half a turn.
    let [angle, speed] = [2.9, -1.5];
    let start = sphere.integrate(&rest, &axis.map(|x| angle * x).to_vec());
    let end = moved(&sphere, &start, &axis.map(|x| speed * x), time);
    let [angle, speed] = oscillation(0.4 + 0.1, 0.3, 8.0, [angle, speed], time);
    let found = sphere.difference(&rest, &end[..4].to_vec());
    assert_close(&found, &axis.map(|x| angle * x), 1e-9);
    assert_close(&end[4..7], &axis.map(|x| speed * x), 1e-9);
}

/// Its centre moves as if it did not turn: m p̈ + d ṗ + k (p − p₀) = 0 along each axis of the base.
#[test]
fn the_centre_of_a_free_body_on_springs_of_one_stiffness_moves_as_its_closed_form() {
    let body = mechanism(
        "name = 'body'\ngravity = [0, 0, 0]\n[[link]]\nname = 'body'\nparent = 'base'\njoint = 'free'\norigin = {}\n\
         mass = 2.0\ninertia = { xx = 0.3, yy = 0.4, zz = 0.6 }\ndamping = [1.5, 1.5, 1.5, 0, 0, 0]\n\
         stiffness = [40, 40, 40, 0, 0, 0]\nrest = [0.2, -0.1, 0.3, 0.5, 0.5, 0.5, 0.5]",
    );
    let (start, v, time) = ([0.5, 0.1, -0.2, 0.0, 0.0, 0.0, 1.0], [0.3, -0.4, 0.1, 2.0, 5.0, -1.0], 1.7);
    let end = moved(&body, &start, &v, time);
    for (i, rest) in [0.2, -0.1, 0.3].into_iter().enumerate() {
        let [displacement, _] = oscillation(2.0, 1.5, 40.0, [start[i] - rest, v[i]], time);
        assert!((end[i] - rest - displacement).abs() < 1e-9, "{} instead of {}", end[i] - rest, displacement);
    }
}

/// At rest in the bushing without gravity, small displacements along and about the axes of rest oscillate by themselves.
#[test]
fn a_free_body_in_a_bushing_of_several_stiffnesses_oscillates_along_its_axes_at_rest() {
    let (mass, inertia) = (2.0, [0.3, 0.4, 0.6]);
    let (stiffness, damping) = ([40.0, 60.0, 90.0, 3.0, 5.0, 8.0], [1.5, 0.5, 2.0, 0.2, 0.1, 0.3]);
    let body = mechanism(&format!(
        "name = 'body'\ngravity = [0, 0, 0]\n[[link]]\nname = 'body'\nparent = 'base'\njoint = 'free'\norigin = {{}}\n\
         mass = {mass:?}\ninertia = {{ xx = 0.3, yy = 0.4, zz = 0.6 }}\ndamping = {damping:?}\nstiffness = {stiffness:?}\n\
         rest = [0.2, -0.1, 0.3, 0.1, 0.7, -0.3, 0.6]"
    ));
    let (rest, time) = (vec![0.2, -0.1, 0.3, 0.1, 0.7, -0.3, 0.6], 0.9);
    for i in 0..6 {
        let mut displaced = vec![0.0; 6];
        displaced[i] = 0.2;
        let start = body.integrate(&rest, &displaced);
        let end = moved(&body, &start, &[0.0; 6], time);
        let moved_mass = if i < 3 { mass } else { inertia[i - 3] };
        let [expected, speed] = oscillation(moved_mass, damping[i], stiffness[i], [0.2, 0.0], time);
        let (mut displacement, mut velocity) = (vec![0.0; 6], vec![0.0; 6]);
        (displacement[i], velocity[i]) = (expected, speed);
        for (found, expected) in body.difference(&rest, &end[..7].to_vec()).iter().zip(displacement) {
            assert!((found - expected).abs() < 1e-9, "{i}: {found} instead of {expected}");
        }
        for (found, expected) in end[7..13].iter().zip(velocity) {
            assert!((found - expected).abs() < 1e-9, "{i}: {found} instead of {expected}");
        }
    }
}

/// By central differences of the energy along each velocity, where gravity is subtracted.
#[test]
fn the_forces_of_springs_are_the_gradient_of_their_energy() {
    let (bushing, h) = (generic(), 1e-5);
    let (q, still) = (Q.to_vec(), vec![0.0; 11]);
    let gravity = redysim::GravityForces::gravity_forces(&bushing, &q);
    let gradient: Vec<f64> = (0..11)
        .map(|i| {
            let [above, below] = [h, -h].map(|step| {
                let mut along = still.clone();
                along[i] = step;
                let energy: redysim::Energy<f64> = bushing.energy(&bushing.integrate(&q, &along), &still);
                energy.potential
            });
            (above - below) / (2.0 * h)
        })
        .collect();
    let forces: Vec<f64> =
        bushing.passive_forces(&q, &still).iter().zip(gravity).map(|(x, y): (&f64, f64)| x + y).collect();
    assert_close(&forces, &gradient, 1e-9);
}

#[test]
fn energy_of_a_tumbling_hull_falls_by_what_damping_and_friction_take() {
    let mut simulation = ForwardSimulation::new(&Bushing, ZeroTorque);
    let start = simulation.state(&Q, &V);
    let explicit = Ode45::new().rtol(1e-10).atol(1e-10).integrate(&mut simulation, (0.0, 1.0), start);
    let implicit = Radau5::new().rtol(1e-10).atol(1e-10).integrate(&mut simulation, (0.0, 1.0), start);
    let before = Bushing::energy(&Q, &V).total();
    for end in [explicit, implicit] {
        let SimulationState { q, v, actuator_energy: taken } = simulation.split(&end.expect("it moves").y);
        let change: f64 = Bushing::energy(&q, &v).total() - before;
        assert!(change < -1.0, "{change} J");
        assert!((change - taken).abs() < 1e-7, "{change} J, of which {taken} J are known");
    }
}

/// The universal joint's link is pinned to the ground, so that every joint is in the loop.
#[test]
fn a_closed_loop_with_dampers_and_springs_in_its_ball_joints_loses_what_the_dampers_take() {
    let mut model = generic().model().clone();
    let side = |link, point| CutSide { link, point: Vec3(point), axis: Vec3([0.0, 0.0, 1.0]) };
    let (a, b) = (side(None, [0.4, 0.1, 1.1]), side(Some(2), [0.0, 0.05, 0.2]));
    model.loops.push(Loop { name: "pin".into(), joint: CutKind::Spherical, a, b });
    let pinned = GenericMechanism::new(model);
    let loops = ClosedLoop::new(&pinned);
    let closed = loops.assemble(&Q.to_vec(), &V.to_vec(), &[]).expect("it closes");
    let mut simulation = ClosedLoopSimulation::new(loops, ZeroTorque);
    let start = simulation.assembled(&closed);
    let end = Ode45::new().rtol(1e-9).atol(1e-11).integrate(&mut simulation, (0.0, 0.3), start).expect("it moves").y;
    let SimulationState { q, v, actuator_energy: taken } = simulation.split(&end);
    let before: f64 = pinned.energy(&closed.q, &closed.v).total();
    let change = pinned.energy(&q, &v).total() - before;
    assert!(change < -0.1, "{change} J");
    assert!((change - taken).abs() < 1e-6, "{change} J, of which {taken} J are known");
}

/// MuJoCo's convention for ball joints: the diagonal of M has the armature, the bias nothing of it, and the energy
/// ½ J v², which the power of the joint forces balances.
#[test]
fn an_armature_adds_to_the_diagonal_of_m_and_nothing_to_the_bias() {
    let driven = generic();
    let mut model = driven.model().clone();
    model.links.iter_mut().for_each(|link| link.physics.armature = 0.0.into());
    let plain = GenericMechanism::new(model);
    let (q, v) = (Q.to_vec(), V.to_vec());
    assert_eq!(driven.bias_forces(&q, &v), plain.bias_forces(&q, &v));
    let armature = [0.1, 0.2, 0.3, 0.01, 0.02, 0.03, 0.05, 0.05, 0.05, 0.02, 0.0];
    let [with, without] = [&driven, &plain].map(|mechanism| mechanism.mass_matrix(&q));
    for (i, (with, without)) in with.iter().zip(&without).enumerate() {
        let difference: Vec<f64> =
            with.iter().zip(without).map(|(with, without): (&f64, &f64)| with - without).collect();
        let expected: Vec<f64> = (0..11).map(|k| if k == i { armature[i] } else { 0.0 }).collect();
        difference.iter().zip(expected).for_each(|(x, y)| assert!((x - y).abs() < 1e-15, "{x} instead of {y}"));
    }
    let kinetic = |mechanism: &GenericMechanism| mechanism.energy(&q, &v).kinetic;
    let of_rotors: f64 = armature.iter().zip(V).map(|(armature, v)| 0.5 * armature * v * v).sum();
    assert!((kinetic(&driven) - kinetic(&plain) - of_rotors).abs() < 1e-13);
}

#[test]
fn compiled_functions_are_those_at_run_time() {
    let (bushing, [q, v, a]) = (generic(), [Q.to_vec(), V.to_vec(), A.to_vec()]);
    assert_close(
        &Bushing::inverse_dynamics(&Q, &V, &A),
        &redysim::InverseDynamics::inverse_dynamics(&bushing, &q, &v, &a),
        1e-13,
    );
    assert_close(&Bushing::forward_dynamics(&Q, &V, &A), &bushing.forward_dynamics(&q, &v, &a), 1e-12);
    assert_close(&Bushing::passive_forces(&Q, &V), &bushing.passive_forces(&q, &v), 1e-13);
    assert_close(&Bushing::bias_forces(&Q, &V), &bushing.bias_forces(&q, &v), 1e-13);
    let [found, expected]: [f64; 2] =
        [ConfigurationSpace::<f64>::dissipated_power(&Bushing, &Q, &V), bushing.dissipated_power(&q, &v)];
    assert_close(&[found], &[expected], 1e-14);
    let [found, expected] = [Bushing::energy(&Q, &V).potential, bushing.energy(&q, &v).potential];
    assert_close(&[found], &[expected], 1e-13);
}

#[test]
fn parameters_of_joints_of_several_freedoms_have_a_name_for_each_component() {
    let names =
        |owner: &str, components: &[&str]| components.iter().map(|name| format!("{owner}.{name}")).collect::<Vec<_>>();
    let twist = ["vx", "vy", "vz", "wx", "wy", "wz"];
    let expected = [
        names("hull.damping", &twist),
        names("ball.stiffness", &["wx", "wy", "wz"]),
        names("ball.rest", &["qx", "qy", "qz", "qw"]),
        names("cross.armature", &["phi", "theta"]),
        names("cross.rest", &["phi", "theta"]),
        names("hull.friction", &twist),
    ];
    assert_eq!(Worn::<f64>::PARAMETER_NAMES.to_vec(), expected.concat());
    assert_eq!(Worn::<f64>::PARAMETERS[6..13], [6.0, 6.0, 6.0, 0.0, 0.3, 0.0, 0.9]);
    assert_close(&Worn::<f64>::default().forward_dynamics(&Q, &V, &A), &Bushing::forward_dynamics(&Q, &V, &A), 1e-12);
}

#[test]
fn a_mechanism_with_other_numbers_in_its_joints_is_the_generic_one_with_them() {
    let mut parameters = Worn::<f64>::PARAMETERS;
    for (i, value) in parameters.iter_mut().enumerate() {
        *value = 0.3 + 0.1 * i as f64;
    }
    let part = |range: std::ops::Range<usize>| redysim::generic::PerVelocity::Each(parameters[range].to_vec());
    let mut model = generic().model().clone();
    model.links[0].physics.damping = part(0..6);
    model.links[1].physics.stiffness = part(6..9);
    model.links[1].physics.rest = parameters[9..13].to_vec();
    model.links[2].physics.armature = part(13..15);
    model.links[2].physics.rest = parameters[15..17].to_vec();
    model.links[0].physics.friction = part(17..23);
    let (worn, expected) = (Worn::new(&parameters), GenericMechanism::new(model));
    let [q, v, a] = [Q.to_vec(), V.to_vec(), A.to_vec()];
    assert_close(&worn.passive_forces(&Q, &V), &expected.passive_forces(&q, &v), 1e-13);
    assert_close(&worn.forward_dynamics(&Q, &V, &A), &expected.forward_dynamics(&q, &v, &a), 1e-12);
    parameters[9..13].fill(0.0);
    let error = Worn::try_new(&parameters).map(|_| ()).unwrap_err();
    assert_eq!((error.name, error.rule), ("ball.rest.qx", ParameterRule::Quaternion));
}

/// The derivative by which implicit methods and warnings of stability know how stiff a bushing is.
#[test]
fn derivatives_of_a_mechanism_on_springs_are_limits_of_differences() {
    let (h, slopes) = (1e-6, A);
    let rates = |x: [f64; 13], sign: f64| std::array::from_fn::<f64, 13, _>(|i| x[i] + sign * h * A[i % 11]);
    let coordinate_slopes: [f64; 13] = std::array::from_fn(|i| A[i % 11]);
    let tangent = ForwardDynamics::<f64>::forward_dynamics_tangent(
        &Bushing,
        (&Q, &V, &A),
        (&coordinate_slopes, &slopes, &slopes),
    )
    .expect("compiled");
    let [above, below] = [1.0, -1.0].map(|sign| {
        let along = |x: [f64; 11]| std::array::from_fn::<f64, 11, _>(|i| x[i] + sign * h * A[i]);
        Bushing::forward_dynamics(&rates(Q, sign), &along(V), &along(A))
    });
    let difference: [f64; 11] = std::array::from_fn(|i| (above[i] - below[i]) / (2.0 * h));
    assert_close(&tangent, &difference, 1e-7);
}
