//! A compiled mechanism computes what the generic path computes, at a thousand random states of each model, of which tests for
//! every processor take the first three hundred.
//!
//! Both run in double-double here. In `f64`, a thousand states hold a few components that are small differences of
//! large terms, of which neither path has twelve digits; in 31 digits, what is left between the two is the roundoff of
//! the constants that code generation and base parameters have folded. How much `f64` and `f32` add to that is the
//! matter of `tests/dynamics/roundings.rs`.
#![cfg(feature = "generic")]

use crate::NATIVE;
use crate::c::bits::{BallFourbar, Cuts, Fourbar, Machine};
use crate::common::call::*;
use crate::common::comparison::Comparison;
use crate::common::double_double::{DoubleDouble, exact, rounded};
use crate::common::models::generic;
use crate::common::random::{Random, State};
use crate::robots::{Gantry, Gripper, Kr5, Kr5Drives};
use crate::robots_in_space::{Floating, Pendulum, Series};
use redysim::{
    CenterOfMass, ConfigurationSpace, Energy, Frames, Function, HybridDynamics, HybridMotion, LinkState, LoopClosure,
    Mechanism, Momentum, TreeDynamics, Vector, Wrench, redysim,
};
use std::f64::consts::PI;

redysim! { struct Springs("models/test/springs.toml"); }
redysim! { struct Mimics("models/parallel_gripper.toml"); }

const SAMPLE: usize = 1000;
const STATES: usize = if NATIVE { SAMPLE } else { 100 };

fn states(mechanism: &impl Mechanism) -> impl Iterator<Item = State> {
    let mut random = Random::new(1);
    (0..STATES).map(move |_| state(&mut random, mechanism))
}

/// In the ranges of [`Random::state`]; quaternions are of any length.
fn state(random: &mut Random, mechanism: &impl Mechanism) -> State {
    let (nq, nv) = (mechanism.nq(), mechanism.nv());
    State { q: random.vector(nq, PI), v: random.vector(nv, 3.0), a: random.vector(nv, 10.0) }
}

/// The roundoff of constants is that of the largest terms, 1e-16 of them; the smallest components that count are 1e-6.
const CONSTANTS: f64 = 1e-12;
/// Springs add terms of hundreds of N m, which cancel more.
const CONSTANTS_WITH_SPRINGS: f64 = 1e-11;
/// The mass matrix of an arm on a platform has elements from 1e2 to those of its wrist.
const CONSTANTS_WITH_PLATFORM: f64 = 1e-11;
/// Accelerations take the condition of the mass matrix, too.
const ACCELERATIONS: f64 = 1e-10;
/// Some of the samples are within a degree of the gimbal of Euler angles.
const ACCELERATIONS_NEAR_A_GIMBAL: f64 = 1e-9;

/// The error of a force as a share of the largest that its joint takes in all states, per unit of the tolerance for
/// single components: five roundings of a constant.
const OF_THE_LARGEST: f64 = 1e-3;

/// Adds a sample of each component.
fn add_each(comparisons: &mut [Comparison], computed: &[f64], expected: &[f64]) {
    for (index, comparison) in comparisons.iter_mut().enumerate() {
        comparison.add(&computed[index..=index], &expected[index..=index]);
    }
}

/// Compares every function of `compiled` with the one of `generic`.
fn assert_same_functions(
    compiled: &impl TreeDynamics<DoubleDouble>,
    generic: &impl TreeDynamics<DoubleDouble>,
    constants: f64,
    accelerations: f64,
) {
    let name = generic.name().to_string();
    let new = |function: &str| Comparison::new(format!("{name} {function}"));
    let [mut inverse, mut forward, mut matrix, mut bias, mut coriolis, mut gravity, mut passive] =
        ["inverse", "forward", "mass matrix", "bias", "coriolis matrix", "gravity", "passive"].map(new);
    let [mut kinetic, mut potential] = ["kinetic", "potential"].map(new);
    let of_joints = |function: &str| -> Vec<Comparison> {
        let joint = |i| new(&format!("{function}, force {i} of its largest")).with_floor(1.0);
        (0..generic.nv()).map(joint).collect()
    };
    let [mut inverse_of_joints, mut bias_of_joints] = ["inverse", "bias"].map(of_joints);
    for State { q, v, a } in states(generic) {
        let (q, v, a) = (exact(&q), exact(&v), exact(&a));
        let tau = inverse_dynamics(generic, &q, &v, &a);
        let ours = rounded(inverse_dynamics(compiled, &q, &v, &a));
        inverse.add(&ours, &rounded(&tau));
        add_each(&mut inverse_of_joints, &ours, &rounded(&tau));
        let ours = forward_dynamics(compiled, &q, &v, &tau);
        forward.add(&rounded(ours), &rounded(forward_dynamics(generic, &q, &v, &tau)));
        matrix.add(&rounded(mass_matrix(compiled, &q).concat()), &rounded(mass_matrix(generic, &q).concat()));
        let [ours, theirs] = [rounded(bias_forces(compiled, &q, &v)), rounded(bias_forces(generic, &q, &v))];
        bias.add(&ours, &theirs);
        add_each(&mut bias_of_joints, &ours, &theirs);
        let ours = coriolis_matrix(compiled, &q, &v).concat();
        coriolis.add(&rounded(ours), &rounded(coriolis_matrix(generic, &q, &v).concat()));
        gravity.add(&rounded(gravity_forces(compiled, &q)), &rounded(gravity_forces(generic, &q)));
        passive.add(&rounded(passive_forces(compiled, &q, &v)), &rounded(passive_forces(generic, &q, &v)));
        let (ours, theirs) = (energy(compiled, &q, &v), energy(generic, &q, &v));
        kinetic.add(&rounded([ours.kinetic]), &rounded([theirs.kinetic]));
        potential.add(&rounded([ours.potential]), &rounded([theirs.potential]));
    }
    let all = [matrix, gravity, passive, kinetic, potential];
    all.iter().for_each(|comparison| comparison.assert_within(constants));
    // A few components of the forces and elements of the Coriolis matrix are smaller than what their terms cancel to.
    [&inverse, &bias].iter().for_each(|comparison| comparison.assert_within(4.0 * constants));
    let of_their_largest = inverse_of_joints.iter().chain(&bias_of_joints);
    of_their_largest.for_each(|comparison| comparison.assert_within(OF_THE_LARGEST * constants));
    coriolis.assert_within(10.0 * constants);
    // The mass matrix of KR5 has condition 1e7, which is what multiplies the roundoff of constants here.
    forward.assert_within(accelerations);
}

/// Compares positions and velocities of all links.
fn assert_same_kinematics(compiled: &impl TreeDynamics<DoubleDouble>, generic: &impl TreeDynamics<DoubleDouble>) {
    type Part = fn(&LinkState<DoubleDouble>) -> Vec<DoubleDouble>;
    let parts: [(&str, Part); 5] = [
        ("rotation", |link| link.rotation.concat()),
        ("origin", |link| link.origin.to_vec()),
        ("com", |link| link.com.to_vec()),
        ("velocity", |link| link.velocity.to_vec()),
        ("angular velocity", |link| link.angular_velocity.to_vec()),
    ];
    for (part, values) in parts {
        let mut comparison = Comparison::new(format!("{} {part}", generic.name()));
        let all = |links: Vec<LinkState<DoubleDouble>>| rounded(links.iter().flat_map(values).collect::<Vec<_>>());
        for State { q, v, .. } in states(generic) {
            let (q, v) = (exact(&q), exact(&v));
            comparison.add(&all(link_kinematics(compiled, &q, &v)), &all(link_kinematics(generic, &q, &v)));
        }
        comparison.assert_within(1e-12);
    }
}

/// The same in `f64`, for fifteen samples of a thousand states.
///
/// Where a force is a small difference of large terms, neither path has all its digits, and of some 6,000 components of
/// a sample the worst is a matter of luck: most samples stay below 1e-12 in inverse dynamics, some have one or two
/// components beyond. The worst may be off by the roundoff of the largest force, however small it is itself. What roundoff
/// can do at most is bounded in `tests/dynamics/roundings.rs`.
fn assert_same_dynamics_in_f64(compiled: &impl TreeDynamics<f64>, generic: &impl TreeDynamics<f64>) {
    const WORST: f64 = 2e-11;
    let sample = |seed: u64| {
        let mut random = Random::new(seed);
        let mut inverse = Comparison::new(format!("{} inverse in f64, sample {seed}", generic.name()));
        for State { q, v, a } in (0..SAMPLE).map(|_| state(&mut random, generic)) {
            inverse.add(&inverse_dynamics(compiled, &q, &v, &a), &inverse_dynamics(generic, &q, &v, &a));
        }
        let (worst, _) = inverse.worst();
        inverse.with_floor(f64::EPSILON / WORST).assert_within(WORST);
        worst
    };
    let mut errors: Vec<f64> = (1..=15).map(sample).collect();
    errors.sort_by(f64::total_cmp);
    println!("{} inverse in f64: median {:.1e}", generic.name(), errors[7]);
    assert!(errors[7] <= 1e-12, "{}: the typical sample is at {:e}", generic.name(), errors[7]);

    let mut forward = Comparison::new(format!("{} forward in f64", generic.name()));
    for State { q, v, a } in states(generic) {
        let tau = inverse_dynamics(generic, &q, &v, &a);
        forward.add(&forward_dynamics(compiled, &q, &v, &tau), &forward_dynamics(generic, &q, &v, &tau));
    }
    forward.assert_within(1e-10);
}

fn assert_same_outside(compiled: &impl TreeDynamics<f64>, generic: &impl TreeDynamics<f64>) {
    assert_eq!(compiled.name(), generic.name());
    assert_eq!(compiled.nq(), generic.nq());
    assert_eq!(compiled.nv(), generic.nv());
    assert_eq!(compiled.nl(), generic.nl());
    for index in 0..=generic.nl() {
        assert_eq!(compiled.link_name(index), generic.link_name(index), "link {index}");
        assert_eq!(compiled.joint_name(index), generic.joint_name(index), "joint {index}");
    }
    for index in 0..=generic.nq() {
        assert_eq!(compiled.coordinate_name(index), generic.coordinate_name(index), "coordinate {index}");
        assert_eq!(compiled.velocity_name(index), generic.velocity_name(index), "velocity {index}");
        assert_eq!(compiled.is_actuated(index), generic.is_actuated(index), "velocity {index}");
        assert_eq!(compiled.coordinate_of_velocity(index), generic.coordinate_of_velocity(index), "velocity {index}");
        assert_eq!(compiled.coordinates_of_velocity(index), generic.coordinates_of_velocity(index), "velocity {index}");
    }
}

#[test]
fn kr5_compiled_is_kr5_generic() {
    assert_same_outside(&Kr5, &generic("kr5"));
    assert_same_functions(&Kr5, &generic("kr5"), CONSTANTS, ACCELERATIONS);
    assert_same_kinematics(&Kr5, &generic("kr5"));
    assert_same_dynamics_in_f64(&Kr5, &generic("kr5"));
}

#[test]
fn kr5_with_drives_compiled_is_kr5_with_drives_generic() {
    assert_same_outside(&Kr5Drives, &generic("kr5_drives"));
    assert_same_functions(&Kr5Drives, &generic("kr5_drives"), CONSTANTS, ACCELERATIONS);
}

#[test]
fn arms_with_springs_between_points_are_compiled_as_they_are_generic() {
    assert_same_outside(&Springs, &generic("test/springs"));
    assert_same_functions(&Springs, &generic("test/springs"), CONSTANTS_WITH_SPRINGS, ACCELERATIONS);
}

#[test]
fn gripper_compiled_is_gripper_generic() {
    assert_same_outside(&Gripper, &generic("gripper"));
    assert_same_functions(&Gripper, &generic("gripper"), CONSTANTS, ACCELERATIONS);
    assert_same_kinematics(&Gripper, &generic("gripper"));
    assert_same_dynamics_in_f64(&Gripper, &generic("gripper"));
}

#[test]
fn gantry_compiled_is_gantry_generic() {
    assert_same_outside(&Gantry, &generic("test/gantry"));
    assert_same_functions(&Gantry, &generic("test/gantry"), CONSTANTS, ACCELERATIONS);
    assert_same_kinematics(&Gantry, &generic("test/gantry"));
    assert_same_dynamics_in_f64(&Gantry, &generic("test/gantry"));
}

/// How coordinates move: as both paths run the same code, they agree to the roundoff of double-double.
fn assert_same_positions(compiled: &impl TreeDynamics<DoubleDouble>, generic: &impl TreeDynamics<DoubleDouble>) {
    let [mut rates, mut integrated, mut differences] = ["coordinate rates", "integrate", "difference"]
        .map(|what| Comparison::new(format!("{} {what}", generic.name())));
    for State { q, v, a } in states(generic) {
        let (q, v, a) = (exact(&q), exact(&v), exact(&a));
        rates.add(&rounded(coordinate_rates(compiled, &q, &v)), &rounded(coordinate_rates(generic, &q, &v)));
        let moved = integrate(generic, &q, &a);
        integrated.add(&rounded(integrate(compiled, &q, &a)), &rounded(moved.clone()));
        differences.add(&rounded(difference(compiled, &q, &moved)), &rounded(difference(generic, &q, &moved)));
    }
    [rates, integrated, differences].iter().for_each(|comparison| comparison.assert_within(1e-15));
    assert_eq!(rounded(neutral(compiled)), rounded(neutral(generic)));
}

#[test]
fn a_floating_arm_compiled_is_the_same_generic() {
    assert_same_outside(&Floating, &generic("kr5_floating"));
    assert_same_functions(&Floating, &generic("kr5_floating"), CONSTANTS_WITH_PLATFORM, ACCELERATIONS);
    assert_same_kinematics(&Floating, &generic("kr5_floating"));
    assert_same_positions(&Floating, &generic("kr5_floating"));
}

/// Four legs side by side, in `f64` in lanes and in double-double one after the other. Their code takes long to compile:
/// `.ci/run` alone has them, for any processor with the feature `deterministic`.
#[test]
#[cfg(any(feature = "deterministic", target_feature = "fma", not(target_arch = "x86_64")))]
fn a_quadruped_compiled_is_the_same_generic() {
    redysim! { struct Quadruped("models/quadruped.toml"); }
    assert_same_functions(&Quadruped, &generic("quadruped"), CONSTANTS_WITH_PLATFORM, ACCELERATIONS);
    assert_same_dynamics_in_f64(&Quadruped, &generic("quadruped"));
    assert_same_kinematics(&Quadruped, &generic("quadruped"));
}

#[test]
fn a_spherical_pendulum_compiled_is_the_same_generic() {
    assert_same_outside(&Pendulum, &generic("spherical_pendulum"));
    assert_same_functions(&Pendulum, &generic("spherical_pendulum"), CONSTANTS, ACCELERATIONS);
    assert_same_kinematics(&Pendulum, &generic("spherical_pendulum"));
    assert_same_positions(&Pendulum, &generic("spherical_pendulum"));
}

#[test]
fn loops_through_a_ball_compiled_are_the_same_generic() {
    assert_same_outside(&BallFourbar, &generic("ball_fourbar"));
    assert_same_functions(&BallFourbar, &generic("ball_fourbar"), CONSTANTS, ACCELERATIONS);
    assert_same_kinematics(&BallFourbar, &generic("ball_fourbar"));
    assert_same_positions(&BallFourbar, &generic("ball_fourbar"));
}

#[test]
fn joints_in_series_compiled_are_the_same_generic() {
    assert_same_outside(&Series, &generic("test/joints_in_series"));
    assert_same_functions(
        &Series,
        &generic("test/joints_in_series"),
        CONSTANTS_WITH_PLATFORM,
        ACCELERATIONS_NEAR_A_GIMBAL,
    );
    assert_same_kinematics(&Series, &generic("test/joints_in_series"));
    assert_same_positions(&Series, &generic("test/joints_in_series"));
}

#[test]
fn joints_that_mimic_others_compiled_are_the_same_generic() {
    assert_same_outside(&Mimics, &generic("parallel_gripper"));
    assert_same_functions(&Mimics, &generic("parallel_gripper"), CONSTANTS, ACCELERATIONS);
    assert_same_kinematics(&Mimics, &generic("parallel_gripper"));
    assert_same_positions(&Mimics, &generic("parallel_gripper"));
}

/// What a function gives at a state, with the accelerations or forces `a`.
type Values<'a> = &'a mut dyn FnMut(Function, Vec<DoubleDouble>);

/// Calls `see` with the values of each function that every tree has.
fn of_trees(robot: &impl TreeDynamics<DoubleDouble>, [q, v, a]: [&[DoubleDouble]; 3], see: Values<'_>) {
    let one = |values: &[[DoubleDouble; 3]]| values.concat();
    see(Function::InverseDynamics, inverse_dynamics(robot, q, v, a));
    see(Function::ForwardDynamics, forward_dynamics(robot, q, v, a));
    see(Function::MassMatrix, mass_matrix(robot, q).concat());
    see(Function::BiasForces, bias_forces(robot, q, v));
    see(Function::CoriolisMatrix, coriolis_matrix(robot, q, v).concat());
    see(Function::GravityForces, gravity_forces(robot, q));
    see(Function::PassiveForces, passive_forces(robot, q, v));
    let Energy { kinetic, potential } = energy(robot, q, v);
    see(Function::Energy, vec![kinetic, potential]);
    let CenterOfMass { position, velocity } = center_of_mass(robot, q, v);
    see(Function::CenterOfMass, one(&[position, velocity]));
    let Momentum { linear, angular } = momentum(robot, q, v);
    see(Function::Momentum, one(&[linear, angular]));
    let links = link_kinematics(robot, q, v).into_iter().flat_map(|link| {
        let LinkState { rotation, origin, com, velocity, angular_velocity, .. } = link;
        [rotation.concat(), one(&[origin, com, velocity, angular_velocity])].concat()
    });
    see(Function::LinkKinematics, links.collect());
    see(Function::CoordinateRates, coordinate_rates(robot, q, v));
    see(Function::Integrate, integrate(robot, q, a));
    see(Function::Difference, difference(robot, q, &integrate(robot, q, v)));
    let numbers = |values: &[DoubleDouble]| values.to_vec();
    see(Function::DissipatedPower, numbers(&[dissipated_power(robot, q, v)]));
    see(Function::Neutral, neutral(robot));
}

fn of_hybrid(robot: &impl HybridDynamics<DoubleDouble>, [q, v, a]: [&[DoubleDouble]; 3], see: Values<'_>) {
    let HybridMotion { a, tau } = hybrid_dynamics(robot, q, v, a);
    see(Function::HybridDynamics, [a.as_ref(), tau.as_ref()].concat());
}

fn of_frames<M: Frames<DoubleDouble>>(robot: &M, [q, v, a]: [&[DoubleDouble]; 3], see: Values<'_>) {
    let number = |i: usize| a[i % a.len()];
    let wrenches = M::Wrenches::from_fn(robot.nf(), |frame| Wrench {
        force: [number(frame), number(frame + 1), number(frame + 2)],
        moment: [number(frame + 3), number(frame + 4), number(frame + 5)],
    });
    let [kinematics, jacobians, bias, forces] = frames(robot, q, v, &wrenches);
    see(Function::FrameKinematics, kinematics);
    see(Function::FrameJacobians, jacobians);
    see(Function::FrameBias, bias);
    see(Function::FrameForces, forces);
}

fn of_loops<M>(robot: &M, [q, v, _]: [&[DoubleDouble]; 3], see: Values<'_>)
where
    M: ConfigurationSpace<DoubleDouble> + LoopClosure<DoubleDouble, M>,
{
    see(Function::LoopResidual, loop_residual(robot, q));
    see(Function::LoopJacobian, loop_jacobian(robot, q).concat());
    see(Function::LoopBias, loop_bias(robot, q, v));
}

/// Robots that together have every function, at states with quaternions of any length: what the compiled and the generic
/// path give differs by roundings of constants, of the largest value that a function has in all states.
#[test]
fn every_function_of_the_table_is_compiled_as_it_is_generic() {
    let mut covered: Vec<Function> = Vec::new();
    macro_rules! compare {
        ($robot:expr, $generic:expr, [$($values:ident),*]) => {{
            let generic = generic($generic);
            let mut values: [Vec<(Function, Vec<Vec<f64>>)>; 2] = [vec![], vec![]];
            for State { q, v, a } in states(&generic).take(100) {
                let state = [exact(&q), exact(&v), exact(&a)];
                let state = state.each_ref().map(Vec::as_slice);
                let [ours, theirs] = &mut values;
                $($values($robot, state, &mut |function, found| add(ours, function, found));)*
                $($values(&generic, state, &mut |function, found| add(theirs, function, found));)*
            }
            let [ours, theirs] = values;
            assert_eq!(ours.len(), theirs.len());
            for ((function, found), (_, expected)) in ours.iter().zip(&theirs) {
                let mut comparison = Comparison::new(format!("{} {function:?}", $generic)).with_floor(1.0);
                found.iter().zip(expected).for_each(|(found, expected)| comparison.add(found, expected));
                let of_accelerations = [Function::ForwardDynamics, Function::HybridDynamics].contains(function);
                comparison.assert_within(if of_accelerations { ACCELERATIONS } else { 1e-14 });
                covered.push(*function);
            }
        }};
    }
    fn add(values: &mut Vec<(Function, Vec<Vec<f64>>)>, function: Function, found: Vec<DoubleDouble>) {
        match values.iter_mut().find(|(of, _)| *of == function) {
            Some((_, all)) => all.push(rounded(found)),
            None => values.push((function, vec![rounded(found)])),
        }
    }
    compare!(&Floating, "kr5_floating", [of_trees, of_hybrid]);
    compare!(&Series, "test/joints_in_series", [of_trees, of_hybrid]);
    compare!(&Kr5Drives, "kr5_drives", [of_trees]);
    compare!(&Machine, "test/frames", [of_trees, of_frames]);
    compare!(&Fourbar, "fourbar", [of_trees, of_loops]);
    compare!(&BallFourbar, "ball_fourbar", [of_trees, of_loops]);
    compare!(&Cuts, "test/cuts", [of_loops]);
    let missing: Vec<_> = Function::ALL.iter().filter(|function| !covered.contains(function)).collect();
    assert!(missing.is_empty(), "{missing:?} are not compared");
}

#[test]
fn coordinates_are_in_the_order_of_the_file() {
    assert_eq!(Gantry::LINK_NAMES[..3], ["gripper", "tool", "carriage"]);
    assert_eq!(Gantry::JOINT_NAMES, ["gripper", "along", "across", "swivel", "forearm", "camera", "boom"]);
    let mut v = [0.0; Gantry::NV];
    v[2] = 1.0;
    let links: [LinkState<f64>; Gantry::NL] = Gantry::link_kinematics(&[0.0; Gantry::NQ], &v);
    for (name, link) in Gantry::LINK_NAMES.iter().zip(links) {
        let speed = link.velocity.iter().map(|x| x * x).sum::<f64>().sqrt();
        let expected = if *name == "rail" { 0.0 } else { 1.0 };
        assert!((speed - expected).abs() < 1e-15, "the bridge carries all but the rail, not {name} at {speed}");
    }
}
