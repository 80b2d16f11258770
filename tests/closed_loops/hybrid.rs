//! Hybrid dynamics of closed loops: against their dynamics and inverse dynamics, which are solved in other ways, and against
//! the momentum of a linkage that floats.
#![cfg(feature = "generic")]

use crate::common::dual::moving;
use crate::common::random::Random;
use crate::linkages::{Fourbar, ThreeRrr};
use crate::redundant::FourbarSpatial;
use redysim::Real;
use redysim::generic::{GenericMechanism, Link, Model};
use redysim::{
    ClosedLoop, ClosedLoopInverse, ConstrainedHybridMotion, HybridDynamics, HybridMotion, LoopError, Mechanism, Motion,
};
use redysim_model::denoc::{self, Untraced};
use redysim_model::spatial::Vec3;
use redysim_model::{Inertia, JointKind};

const GUESS: [f64; 3] = [0.0, 0.9844, 4.3144];
/// Solves of systems whose condition is below 1e4.
const ROUNDOFF: f64 = 1e-11;

fn assert_near(found: &[f64], expected: &[f64], what: &str) {
    let size = expected.iter().fold(1.0_f64, |size, x| size.max(x.abs()));
    let worst = found.iter().zip(expected).map(|(x, y)| (x - y).abs()).fold(0.0, Real::maximum);
    assert!(worst < ROUNDOFF * size, "{what}: {found:?} instead of {expected:?}");
}

/// The position at which the first joints stand so, and the motion of all by these rates and accelerations of them; the
/// joint forces by inverse dynamics of closed loops, and what hybrid dynamics finds with the `driven` joints given.
macro_rules! by_inverse_and_hybrid {
    ($mechanism:expr, $independent:expr, $guess:expr, $start:expr, $rates:expr, $accelerations:expr, $driven:expr) => {{
        let loops = ClosedLoop::new(&$mechanism);
        let motion = |_: f64| Motion { q: $start, v: $rates, a: $accelerations };
        let inverse = ClosedLoopInverse::new(loops, &$independent, $guess).at(0.0, &motion).expect("it closes");
        let (Motion { q, v, a }, forces) = (inverse.motion, inverse.forces);
        let u = core::array::from_fn(|i| if $driven.contains(&i) { a[i] } else { forces[i] });
        let found = loops.hybrid_dynamics(&q, &v, &u, &$driven).expect("the loops allow it");
        let forward = loops.dynamics(&q, &v, &found.motion.tau).expect("the loops allow it");
        assert_near(&forward.accelerations, &found.motion.a, "forward dynamics under the forces found");
        (found, a, forces)
    }};
}

#[test]
fn a_driven_crank_takes_the_torque_of_inverse_dynamics() {
    let (start, rates, accelerations) = ([0.7], [3.0], [5.0]);
    let (found, a, forces) = by_inverse_and_hybrid!(Fourbar, [0], GUESS, start, rates, accelerations, [0]);
    assert_near(&found.motion.a, &a, "accelerations");
    assert_near(&found.motion.tau, &forces, "forces");
    let (redundant, a, forces) = by_inverse_and_hybrid!(FourbarSpatial, [0], GUESS, start, rates, accelerations, [0]);
    assert_near(&redundant.motion.a, &a, "accelerations with a redundant row");
    assert_near(&redundant.motion.tau, &forces, "forces with a redundant row");
}

/// A platform on three cranks with three degrees of freedom: the motion is the same with one, two or all cranks driven, if
/// the others have the forces that it takes, and with none it is that of forward dynamics.
#[test]
fn whichever_cranks_are_driven_the_motion_and_its_forces_are_the_same() {
    let first = include_str!("../reference/golden_octave_ID_3-RRR_Parallel_robot.csv");
    let first = first.lines().find(|line| !line.starts_with('#')).expect("a row");
    let first: Vec<f64> = first.split(',').map(|x| x.parse().expect("a number")).collect();
    let guess: [f64; 7] = core::array::from_fn(|i| first[1 + i]);
    let cranks = [0, 3, 5];
    let start = cranks.map(|crank| guess[crank]);
    let choices: [&[usize]; 4] = [&[], &[3], &[5, 0], &cranks];
    for driven in choices {
        let (found, a, forces) =
            by_inverse_and_hybrid!(ThreeRrr, cranks, guess, start, [0.4, -0.3, 0.2], [1.0, 2.0, -1.5], driven);
        assert_near(&found.motion.a, &a, "accelerations");
        assert_near(&found.motion.tau, &forces, "forces");
    }
}

#[test]
fn accelerations_that_the_loops_do_not_admit_are_an_error() {
    let loops = ClosedLoop::new(&Fourbar);
    let start = loops.assemble(&GUESS, &[0.0; 3], &[0]).expect("it closes");
    let both = loops.hybrid_dynamics(&start.q, &[0.0; 3], &[1.0, 1.0, 1.0], &[0, 1, 2]);
    assert!(matches!(both, Err(LoopError::InconsistentVelocity { .. })), "{both:?}");
    let twice = loops.hybrid_dynamics(&start.q, &[0.0; 3], &[1.0; 3], &[0, 0]);
    assert_eq!(twice, Err(LoopError::RepeatedVelocity { velocity: 0 }));
    let missing = loops.hybrid_dynamics(&start.q, &[0.0; 3], &[1.0; 3], &[3]);
    assert_eq!(missing, Err(LoopError::VelocityOutOfRange { velocity: 3, count: 3 }));
}

/// The paper's four-bar on a satellite of 4 kg, without gravity.
fn floating_linkage() -> GenericMechanism {
    let mut model = Model::load("models/fourbar.toml").expect("a valid model").model;
    model.gravity = Vec3::zero();
    for link in &mut model.links {
        link.parent = Some(link.parent.map_or(0, |parent| parent + 1));
    }
    for side in model.loops.iter_mut().flat_map(|cut| [&mut cut.a, &mut cut.b]) {
        side.link = Some(side.link.map_or(0, |link| link + 1));
    }
    let inertia = Inertia { xx: 0.03, yy: 0.02, zz: 0.04, ..Inertia::default() };
    let base = Link { mass: 4.0, inertia, actuated: false.into(), ..Link::new("satellite", None, JointKind::Free) };
    model.links.insert(0, base);
    GenericMechanism::new(model.check().unwrap_or_else(|faults| panic!("{faults}")).model)
}

#[test]
fn the_base_under_a_driven_linkage_moves_so_that_momentum_stays() {
    let mechanism = floating_linkage();
    let (loops, tree) = (ClosedLoop::new(&mechanism), mechanism.tree());
    let mut random = Random::new(3);
    let guess = [vec![0.1, -0.2, 0.3, 0.0, 0.0, 0.6, 0.8], GUESS.to_vec()].concat();
    for _ in 0..10 {
        let [velocity, u]: [Vec<f64>; 2] = [2.0, 10.0].map(|size| random.vector(9, size));
        // The seven first velocities, the base's and the crank's, determine the others.
        let closed = loops.assemble(&guess, &velocity, &[0, 1, 2, 3, 4, 5, 6]).expect("it closes");
        let u: Vec<f64> = (0..9).map(|i| if i == 6 { u[i] } else { 0.0 }).collect();
        let found = loops.hybrid_dynamics(&closed.q, &closed.v, &u, &[6]).expect("the loops allow it");
        let ConstrainedHybridMotion { motion: HybridMotion { a, tau }, rank, .. } = found;
        assert_eq!((a[6], rank), (u[6], 2));
        assert!(tau.iter().enumerate().all(|(i, tau)| i == 6 || *tau == 0.0), "{tau:?}");
        let rates = denoc::coordinate_rates(tree, &closed.q, &closed.v);
        let momentum = denoc::momentum(tree, &Untraced, &moving(&closed.q, &rates), &moving(&closed.v, &a));
        let scale = 4.0 * a.iter().fold(0.0_f64, |most, a| Real::maximum(most, a.abs()));
        let changes = momentum.linear.iter().chain(&momentum.angular).map(|component| component.rate.abs());
        assert!(changes.fold(0.0, Real::maximum) < ROUNDOFF * scale, "{momentum:?}");
    }
}

/// Without rows, what is left is the hybrid dynamics of the tree.
#[test]
fn without_loops_it_is_the_hybrid_dynamics_of_the_tree() {
    let tree = GenericMechanism::new(Model::load("models/kr5_floating.toml").expect("a valid model").model);
    let mut random = Random::new(4);
    let q = denoc::integrate(tree.tree(), &denoc::neutral(tree.tree()), &random.vector(12, 1.0));
    let [v, u] = [1.0, 5.0].map(|size| random.vector(12, size));
    let driven: Vec<usize> = (0..12).filter(|&i| tree.is_actuated(i)).collect();
    let closed = ClosedLoop::new(&tree).hybrid_dynamics(&q, &v, &u, &driven).expect("regular");
    let expected = tree.hybrid_dynamics(&q, &v, &u);
    assert_near(&closed.motion.a, &expected.a, "accelerations");
    assert_near(&closed.motion.tau, &expected.tau, "forces");
}
