//! Loops with spherical and free joints: their forward and inverse dynamics, with these joints passive, independent, or both,
//! against Kane's equations, the balance of energy, hybrid dynamics, and the same mechanism cut elsewhere.
#![cfg(feature = "generic")]

use crate::common::call::{coordinate_rates, energy, loop_bias};
use crate::common::dual::moving;
use crate::common::kane::kane;
use crate::common::kane_loops::loop_rows;
use crate::common::models::generic;
use crate::common::random::Random;
use crate::linkages::BallFourbar;
use nalgebra::DVector;
use redysim::Real;
use redysim::generic::{CutKind, CutSide, GenericMechanism, JointKind, Loop, Vec3};
use redysim::{
    ClosedLoop, ClosedLoopComputedTorque, ClosedLoopInverse, ClosedLoopSimulation, ConfigurationSpace, Dop853,
    Integrator, LoopError, LoopForces, Motion, redysim,
};

redysim! {
    /// Three loops through one ball, which three actuators turn.
    pub struct BallPlatform(
        "models/ball_platform.toml",
        functions = [inverse_dynamics, mass_matrix, bias_forces, loop_residual, loop_jacobian, loop_bias]
    );
}

/// Solves of systems whose condition is below 1e4.
const ROUNDOFF: f64 = 1e-11;
/// The crank of the four-bar is its first velocity, the ball of its coupler are the last three.
const CRANK: [usize; 1] = [0];
/// The ball under the platform.
const BALL: [usize; 3] = [0, 1, 2];
const RODS: [usize; 3] = [5, 8, 11];

/// A guess of the four-bar: the crank at zero, the coupler on its way to it.
const FOURBAR: [f64; 6] = [0.0, 0.0, 0.0, -0.32, 0.0, 0.95];

/// A guess of the platform, level.
fn platform() -> [f64; 13] {
    let leg = [-0.33, -0.36, 0.07];
    let [leg1, leg2, leg3] = [leg; 3];
    core::array::from_fn(|i| [&[0.0, 0.0, 0.0, 1.0][..], &leg1, &leg2, &leg3].concat()[i])
}

/// An orientation near level and its velocity and acceleration.
fn tilted(random: &mut Random) -> Motion<[f64; 4], [f64; 3]> {
    let mut of = |size: f64| core::array::from_fn(|_| random.within(size));
    let [x, y, z] = of(0.2);
    let w = (1.0 - x * x - y * y - z * z).sqrt();
    Motion { q: [x, y, z, w], v: of(2.0), a: of(10.0) }
}

fn largest<'v>(values: impl IntoIterator<Item = &'v f64>) -> f64 {
    values.into_iter().fold(0.0, |largest, x| Real::maximum(largest, x.abs()))
}

fn assert_near(found: &[f64], expected: &[f64], what: &str) {
    let size = largest(expected).max(1.0);
    assert_eq!(found.len(), expected.len(), "{what}");
    let worst = found.iter().zip(expected).map(|(x, y)| (x - y).abs()).fold(0.0, Real::maximum);
    assert!(worst < ROUNDOFF * size, "{what}: off by {worst:e}, {found:?} instead of {expected:?}");
}

/// M a + h − τ − Jᵀλ and J a + J̇ v vanish, where M, h and J are those of Kane's equations; λ multiplies every row.
fn assert_obeys_kane<V: AsRef<[f64]>, R: AsRef<[f64]>>(
    mechanism: &GenericMechanism,
    Motion { q, v, a }: &Motion<impl AsRef<[f64]>, V>,
    forces: &V,
    multipliers: &R,
) {
    let (q, v, a) = (q.as_ref(), v.as_ref(), DVector::from_column_slice(a.as_ref()));
    let equations = kane(mechanism.model(), q, v);
    let rows = loop_rows(mechanism.model(), &equations, v.len());
    let vector = |values: &[f64]| DVector::from_column_slice(values);
    let by_loops = rows.transpose() * vector(multipliers.as_ref());
    let of_tree = &equations.matrix * &a + &equations.bias;
    let left = (&of_tree - vector(forces.as_ref()) - &by_loops).amax();
    assert!(left < ROUNDOFF * of_tree.amax().max(by_loops.amax()), "{left:e} of {of_tree} is not balanced");
    let bias = vector(&loop_bias(mechanism, q, v));
    let left = (&rows * &a + &bias).amax();
    assert!(left < ROUNDOFF * bias.amax().max(a.amax()), "the loops open at {left:e} of {bias}");
}

/// The power of the joint forces, less what the energy grows by in a unit of time; the size of its terms.
fn unbalanced_power<Q: AsRef<[f64]>, V: AsRef<[f64]>, R>(
    mechanism: &GenericMechanism,
    LoopForces { motion: Motion { q, v, a }, forces, .. }: &LoopForces<Q, V, R>,
) -> (f64, f64) {
    let (q, v, a) = (q.as_ref(), v.as_ref(), a.as_ref());
    let rates = coordinate_rates(mechanism, q, v);
    let energy = energy(mechanism, &moving(q, &rates), &moving(v, a));
    let power: f64 = forces.as_ref().iter().zip(v).map(|(force, speed)| force * speed).sum();
    let (kinetic, potential) = (energy.kinetic.rate, energy.potential.rate);
    (power - kinetic - potential, largest(&[power, kinetic, potential]))
}

/// Forward dynamics gives the accelerations back that inverse dynamics took, and so does hybrid dynamics, whether it is given
/// the accelerations of the independent joints and finds no other force there, or those of the actuated ones and finds theirs.
macro_rules! assert_inverse_of_forward {
    ($loops:expr, $found:expr, $independent:expr, $actuated:expr) => {{
        let (LoopForces { motion: Motion { q, v, a }, forces, multipliers, .. }, loops) = (&$found, $loops);
        let forward = loops.dynamics(q, v, forces).expect("regular");
        assert_near(&forward.accelerations, a, "accelerations under the forces of inverse dynamics");
        assert_near(&forward.multipliers, multipliers, "multipliers");
        for driven in [&$independent[..], &$actuated[..]] {
            let u = core::array::from_fn(|i| if driven.contains(&i) { a[i] } else { forces[i] });
            let hybrid = loops.hybrid_dynamics(q, v, &u, driven).expect("the loops allow it");
            assert_near(&hybrid.motion.a, a, "accelerations of hybrid dynamics");
            assert_near(&hybrid.motion.tau, forces, "forces of hybrid dynamics");
        }
    }};
}

#[test]
fn a_crank_that_drives_a_passive_ball_gives_all_the_power_and_obeys_kanes_equations() {
    let (mechanism, loops) = (generic("ball_fourbar"), ClosedLoop::new(&BallFourbar));
    let mut inverse = ClosedLoopInverse::new(loops, &CRANK, FOURBAR);
    let turn = |t: f64| Motion { q: [5.0 * t + t * t], v: [5.0 + 2.0 * t], a: [2.0] };
    for step in 0..40 {
        let found = inverse.at(0.03 * f64::from(step), &turn).expect("the crank turns freely");
        assert_eq!((found.rank, found.redundancy, &found.forces[1..]), (4, 0, &[0.0; 4][..]));
        assert_obeys_kane(&mechanism, &found.motion, &found.forces, &found.multipliers);
        let (left, size) = unbalanced_power(&mechanism, &found);
        assert!(left.abs() < ROUNDOFF * size, "{left:e} W of {size} W");
        assert_inverse_of_forward!(loops, found, CRANK, CRANK);
    }
}

#[test]
fn rods_that_turn_a_platform_on_a_passive_ball_give_all_the_power_and_obey_kanes_equations() {
    let (mechanism, loops) = (generic("ball_platform"), ClosedLoop::new(&BallPlatform));
    let mut inverse = ClosedLoopInverse::new(loops, &BALL, platform()).actuated(&RODS);
    let mut random = Random::new(1);
    for _ in 0..20 {
        let motion = tilted(&mut random);
        let found = inverse.at(0.0, &|_: f64| motion).expect("within reach");
        assert_near(&found.motion.q[..4], &motion.q, "the orientation of the trajectory");
        assert_eq!((&found.motion.v[..3], &found.motion.a[..3]), (&motion.v[..], &motion.a[..]));
        assert!(found.forces.iter().enumerate().all(|(i, force)| RODS.contains(&i) || *force == 0.0), "{found:?}");
        assert_obeys_kane(&mechanism, &found.motion, &found.forces, &found.multipliers);
        let (left, size) = unbalanced_power(&mechanism, &found);
        assert!(left.abs() < ROUNDOFF * size, "{left:e} W of {size} W");
        assert_inverse_of_forward!(loops, found, BALL, RODS);
        // The motion that the rods prescribe takes the same.
        let of_rods = |values: &[f64; 12]| RODS.map(|rod| values[rod]);
        let Motion { q, v, a } = &found.motion;
        let by_rods = Motion { q: RODS.map(|rod| q[rod + 1]), v: of_rods(v), a: of_rods(a) };
        let again = ClosedLoopInverse::new(loops, &RODS, *q).at(0.0, &|_: f64| by_rods).expect("within reach");
        assert_near(&again.motion.a, a, "accelerations by the rods");
        assert_near(&again.forces, &found.forces, "forces by the rods");
    }
}

/// Virtual work: the moment of the ball along each of its velocities is the power of M a + h there.
#[test]
fn an_actuator_in_the_ball_takes_the_power_of_all_bodies_along_its_velocities() {
    let (mechanism, loops) = (generic("ball_platform"), ClosedLoop::new(&BallPlatform));
    let mut inverse = ClosedLoopInverse::new(loops, &BALL, platform());
    let mut random = Random::new(2);
    for _ in 0..20 {
        let motion = tilted(&mut random);
        let found = inverse.at(0.0, &|_: f64| motion).expect("within reach");
        let Motion { q, v, a } = &found.motion;
        let equations = kane(mechanism.model(), q, v);
        let needed = equations.matrix * DVector::from_column_slice(a) + equations.bias;
        let free = loops.independent_motion::<f64, [f64; 3]>(q, &BALL).expect("regular");
        let moment = free.restricted(&core::array::from_fn(|i| needed[i]));
        assert_near(&found.forces[..3], &moment, "moments");
        assert_inverse_of_forward!(loops, found, BALL, BALL);
    }
}

/// The platform on a free joint, and the ball a cut.
fn cut_at_the_ball() -> GenericMechanism {
    let mut model = generic("ball_platform").model().clone();
    model.links[0].joint = JointKind::Free;
    model.links[0].placement.position = Vec3::zero();
    let side = |link, point| CutSide { link, point, axis: Vec3([0.0, 0.0, 1.0]) };
    let (a, b) = (side(None, Vec3([0.0, 0.0, 0.5])), side(Some(0), Vec3::zero()));
    model.loops.push(Loop { name: "ball".into(), joint: CutKind::Spherical, a, b });
    GenericMechanism::new(model)
}

/// Of a free joint, the orientation may be independent while the position follows from the loops, and both may be.
#[test]
fn the_same_platform_on_a_free_joint_cut_at_the_ball_takes_the_same_forces() {
    let (floating, rods) = (cut_at_the_ball(), RODS.map(|rod| rod + 3));
    let guess = [&[0.01, -0.02, 0.51], &platform()[..]].concat();
    let mut inverse = ClosedLoopInverse::new(ClosedLoop::new(&floating), &[3, 4, 5], guess).actuated(&rods);
    let mut in_tree = ClosedLoopInverse::new(ClosedLoop::new(&BallPlatform), &BALL, platform()).actuated(&RODS);
    let mut random = Random::new(3);
    for _ in 0..20 {
        let motion = tilted(&mut random);
        let expected = in_tree.at(0.0, &|_: f64| motion).expect("within reach");
        let Motion { q, v, a } = motion;
        let motion = Motion { q: q.to_vec(), v: v.to_vec(), a: a.to_vec() };
        let found = inverse.at(0.0, &|_: f64| motion.clone()).expect("within reach");
        assert_near(&found.motion.q, &[&[0.0, 0.0, 0.5], &expected.motion.q[..]].concat(), "coordinates");
        assert_near(&found.motion.a[3..], &expected.motion.a, "accelerations");
        assert_near(&found.forces, &[&[0.0; 3], &expected.forces[..]].concat(), "forces");
        assert_obeys_kane(&floating, &found.motion, &found.forces, &found.multipliers);

        let whole = Motion {
            q: found.motion.q[..7].to_vec(),
            v: found.motion.v[..6].to_vec(),
            a: found.motion.a[..6].to_vec(),
        };
        let mut by_all =
            ClosedLoopInverse::new(ClosedLoop::new(&floating), &[0, 1, 2, 3, 4, 5], found.motion.q.clone());
        by_all = by_all.actuated(&rods);
        let again = by_all.at(0.0, &|_: f64| whole.clone()).expect("within reach");
        assert_near(&again.forces, &found.forces, "forces for position and orientation");
        // The coordinates stand in the order of the velocities.
        let [position, orientation] = [whole.q[..3].to_vec(), whole.q[3..].to_vec()];
        let turned_round = |values: &[f64]| [&values[3..], &values[..3]].concat();
        let other =
            Motion { q: [orientation, position].concat(), v: turned_round(&whole.v), a: turned_round(&whole.a) };
        let mut other_order =
            ClosedLoopInverse::new(ClosedLoop::new(&floating), &[3, 4, 5, 0, 1, 2], found.motion.q.clone());
        other_order = other_order.actuated(&rods);
        let again = other_order.at(0.0, &|_: f64| other.clone()).expect("within reach");
        assert_near(&again.forces, &found.forces, "forces in another order");
    }
}

/// Loops of every kind of cut under joint forces at random.
#[test]
fn links_that_slide_and_turn_along_loops_obey_kanes_equations() {
    let mechanism = generic("test/cuts");
    let loops = ClosedLoop::new(&mechanism);
    let mut random = Random::new(4);
    for _ in 0..20 {
        let guess = mechanism.integrate(&mechanism.neutral(), &random.vector(21, 0.3));
        let start = loops.assemble(&guess, &random.vector(21, 2.0), &[]).expect("it closes");
        let tau = random.vector(21, 5.0);
        let found = loops.dynamics(&start.q, &start.v, &tau).expect("regular");
        assert_eq!(found.rank, 16);
        let motion = Motion { q: start.q, v: start.v, a: found.accelerations };
        assert_obeys_kane(&mechanism, &motion, &tau, &found.multipliers);
    }
}

/// From one instant to a far one the platform turns the shortest way, which is that through many instants between; a
/// quaternion of another sign and length is the same orientation.
#[test]
fn a_ball_is_followed_to_far_orientations_on_its_branch() {
    let loops = ClosedLoop::new(&BallPlatform);
    let about_a_diagonal = |t: f64| {
        let (sin, cos) = (0.5 * t).sin_cos();
        let [x, y, z] = [0.48, 0.6, 0.64].map(|axis| axis * sin);
        Motion { q: [x, y, z, cos], v: [0.48, 0.6, 0.64], a: [0.0; 3] }
    };
    let mut in_steps = ClosedLoopInverse::new(loops, &BALL, platform()).actuated(&RODS);
    let mut at_once = ClosedLoopInverse::new(loops, &BALL, platform()).actuated(&RODS);
    let expected = (0..=100).map(|k| in_steps.at(0.01 * f64::from(k), &about_a_diagonal).expect("within reach")).last();
    let expected = expected.expect("an instant");
    let scaled = |t: f64| {
        let Motion { q, v, a } = about_a_diagonal(t);
        Motion { q: q.map(|component| -3.0 * component), v, a }
    };
    let found = at_once.at(1.0, &scaled).expect("within reach");
    assert_near(&found.motion.q[4..], &expected.motion.q[4..], "coordinates of the legs");
    assert_near(&found.motion.v, &expected.motion.v, "velocities");
    assert_near(&found.forces, &expected.forces, "forces");
}

/// While the platform turns about one axis, its error is an angle that obeys ë + 20 ė + 100 e = 0.
#[test]
fn the_error_of_a_ball_under_computed_torque_dies_away_as_that_of_a_damped_spring() {
    let loops = ClosedLoop::new(&BallPlatform);
    let (axis, start) = ([0.48, 0.6, 0.64], 0.5_f64);
    let turned_by = |angle: f64| {
        let (sin, cos) = (0.5 * angle).sin_cos();
        [axis[0] * sin, axis[1] * sin, axis[2] * sin, cos]
    };
    let mut guess = platform();
    guess[..4].copy_from_slice(&turned_by(start));
    let start_state = loops.assemble(&guess, &[0.0; 12], &BALL).expect("it closes");
    let rest = move |_: f64| Motion { q: turned_by(-0.1), v: [0.0; 3], a: [0.0; 3] };
    let law = ClosedLoopComputedTorque::new(loops, &BALL, rest, [[100.0; 3], [20.0; 3]]).actuated(&RODS);
    let mut controlled = ClosedLoopSimulation::new(loops, law);
    let state = controlled.assembled(&start_state);
    let end = Dop853::new().rtol(1e-10).atol(1e-12).integrate(&mut controlled, (0.0, 0.3), state).expect("it goes on");
    let expected = turned_by(-0.1 + 0.6 * (1.0 + 10.0 * 0.3) * (-10.0_f64 * 0.3).exp());
    let worst = largest(&[0, 1, 2, 3].map(|i| end.y[i] - expected[i]));
    assert!(worst < 1e-9, "{worst:e}");
}

#[test]
fn a_part_of_a_balls_velocities_is_refused() {
    let rest = |_: f64| Motion { q: vec![0.0; 4], v: vec![0.0; 2], a: vec![0.0; 2] };
    let loops = ClosedLoop::new(&BallPlatform);
    let error = ClosedLoopInverse::new(loops, &[0, 2], platform()).at(0.0, &rest).unwrap_err();
    assert_eq!(error, LoopError::PartOfJoint { velocity: 0, missing: 1 });
    let message = loops.with_names(error).to_string();
    assert!(message.contains("without velocity 1 of the same joint"), "{message}");
    assert!(message.ends_with("velocity 0 is that of the joint `platform.wx`"), "{message}");
    let law = ClosedLoopComputedTorque::new(loops, &[2, 0], rest, [vec![1.0; 2], vec![1.0; 2]]);
    let error = law.forces(0.0, &platform(), &[0.0; 12]).unwrap_err();
    assert_eq!(error, LoopError::PartOfJoint { velocity: 2, missing: 1 });
    // The linear velocities of a free joint are in the axes of its link.
    let floating = cut_at_the_ball();
    let guess = [&[0.0, 0.0, 0.5], &platform()[..]].concat();
    let rest = |_: f64| Motion { q: vec![0.0; 3], v: vec![0.0; 3], a: vec![0.0; 3] };
    let error = ClosedLoopInverse::new(ClosedLoop::new(&floating), &[0, 1, 2], guess).at(0.0, &rest).unwrap_err();
    assert_eq!(error, LoopError::PartOfJoint { velocity: 0, missing: 3 });
}

#[test]
fn an_independent_ball_takes_a_quaternion_that_is_not_zero() {
    let loops = ClosedLoop::new(&BallPlatform);
    let short = |_: f64| Motion { q: [0.0; 3], v: [0.0; 3], a: [0.0; 3] };
    let error = ClosedLoopInverse::new(loops, &BALL, platform()).at(0.0, &short).unwrap_err();
    let message = error.to_string();
    assert!(
        message.starts_with("`trajectory.q` must have 4 elements, but it has 3; give one for each coor"),
        "{message}"
    );
    let zero = |_: f64| Motion { q: [0.0; 4], v: [0.0; 3], a: [0.0; 3] };
    let error = ClosedLoopInverse::new(loops, &BALL, platform()).at(0.0, &zero).unwrap_err();
    assert_eq!(error, LoopError::NotFinite);
}
