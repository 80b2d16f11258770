//! Loops through joints that mimic others: a five-bar with geared cranks against plane geometry, Kane's equations and the same
//! linkage whose gear is a constraint, and a four-bar behind a gear against one whose crank has the wheel's inertia as armature.
#![cfg(feature = "generic")]

use crate::common::kane::kane;
use crate::common::kane_loops::loop_rows;
use crate::common::models::generic;
use crate::common::random::Random;
use nalgebra::{DMatrix, DVector, Vector2};
use redysim::Real;
use redysim::generic::{GenericMechanism, Inertia, JointKind, Link, Model};
use redysim::{
    Assembly, ClosedLoop, ClosedLoopInverse, ClosedLoopSimulation, Dop853, Integrator, LoopClosure, LoopRows, Motion,
    ZeroTorque, redysim,
};
use redysim_model::Mimic;
use redysim_model::joint::JointPhysics;

redysim! {
    /// A crank, its coupler, and the other coupler; the other crank mimics the first.
    struct FiveBar(
        "models/test/geared_five_bar.toml",
        functions = [
            inverse_dynamics, mass_matrix, bias_forces, link_kinematics, loop_residual, loop_jacobian, loop_bias
        ]
    );
}

const RATIO: f64 = -2.0;
const OFFSET: f64 = 0.7;
/// Solves of systems whose condition is below 1e4.
const ROUNDOFF: f64 = 1e-11;

fn largest<'v>(values: impl IntoIterator<Item = &'v f64>) -> f64 {
    values.into_iter().fold(0.0, |largest, x| Real::maximum(largest, x.abs()))
}

fn assert_near(found: &[f64], expected: &[f64], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let worst = found.iter().zip(expected).map(|(x, y)| (x - y).abs()).fold(0.0, Real::maximum);
    assert!(worst < ROUNDOFF * largest(expected).max(1.0), "{what}: off by {worst:e}, {found:?} for {expected:?}");
}

/// The linkage with the crank held at an angle and a rate.
fn closed(angle: f64, rate: f64) -> Assembly<f64, [f64; 3], [f64; 3]> {
    let [_, coupler, other] = by_circles(angle);
    // Off by a few degrees.
    let guess = [angle, coupler + 0.05, other - 0.04];
    ClosedLoop::new(&FiveBar).assemble(&guess, &[rate, 0.0, 0.0], &[0]).expect("the couplers meet")
}

/// The coordinates at an angle of the crank: the couplers meet at the upper of the points that two circles about the tips of
/// the cranks share.
fn by_circles(angle: f64) -> [f64; 3] {
    let geared = RATIO * angle + OFFSET;
    let at = |angle: f64, length: f64| Vector2::new(angle.cos(), angle.sin()) * length;
    let (tip, other_tip) = (at(angle, 0.1), Vector2::new(0.3, 0.0) + at(geared, 0.08));
    let way = other_tip - tip;
    let distance = way.norm();
    let inner = ((distance * distance + 0.4 * 0.4 - 0.35 * 0.35) / (2.0 * 0.4 * distance)).acos();
    let along = way.y.atan2(way.x) + inner;
    let meeting = tip + at(along, 0.4) - other_tip;
    [angle, along - angle, meeting.y.atan2(meeting.x) - geared]
}

#[test]
fn geared_cranks_close_where_circles_about_their_tips_meet() {
    for k in 0..48 {
        let angle = 0.13 * f64::from(k);
        let found = closed(angle, 3.0);
        assert_eq!((found.q[0], found.v[0], found.rank), (angle, 3.0, 2));
        assert!(found.position_residual <= 1e-14, "{:e} m", found.position_residual);
        assert!(largest(&FiveBar::loop_residual(&found.q)) <= 1e-14);
        for (found, expected) in found.q.iter().zip(by_circles(angle)) {
            assert!((found - expected).sin().abs() < 1e-13 && (found - expected).cos() > 0.0, "{found} for {expected}");
        }
        // By a central difference of the geometry, of order 2.
        let [before, after] = [-1e-5, 1e-5].map(|step| by_circles(angle + step));
        for i in 0..3 {
            let slope = (after[i] - before[i]).sin() / 2e-5;
            assert!((found.v[i] - 3.0 * slope).abs() < 1e-8, "{} for {slope}", found.v[i]);
        }
        let geared = FiveBar::link_kinematics(&found.q, &found.v)[2];
        let (sin, cos) = (RATIO * angle + OFFSET).sin_cos();
        assert_near(&[geared.rotation[1][0], geared.rotation[0][0]], &[sin, cos], "direction of the geared crank");
        assert_near(&geared.angular_velocity, &[0.0, 0.0, RATIO * 3.0], "angular velocity of the geared crank");
    }
}

/// Accelerations and multipliers from M a + h = τ + Jᵀλ and J a = −J̇ v with all terms of Kane's equations and kinematics.
fn by_kane(model: &Model, q: &[f64], v: &[f64], tau: &[f64]) -> [Vec<f64>; 2] {
    let (equations, nv) = (kane(model, q, v), v.len());
    // In the plane of the linkage.
    let rows = loop_rows(model, &equations, nv).rows(0, 2).into_owned();
    let [a, b] = &equations.loops[0];
    let bias = (b.acceleration - a.acceleration).xy();
    let mut system = DMatrix::zeros(nv + 2, nv + 2);
    system.view_mut((0, 0), (nv, nv)).copy_from(&equations.matrix);
    system.view_mut((0, nv), (nv, 2)).copy_from(&-rows.transpose());
    system.view_mut((nv, 0), (2, nv)).copy_from(&rows);
    let of_tree = DVector::from_column_slice(tau) - &equations.bias;
    let right = DVector::from_iterator(nv + 2, of_tree.iter().copied().chain([-bias.x, -bias.y]));
    let found = system.lu().solve(&right).expect("a regular position");
    [found.as_slice()[..nv].to_vec(), found.as_slice()[nv..].to_vec()]
}

/// What acts in the joint of the geared crank is felt by the other, too.
fn with_losses(mut model: Model) -> Model {
    model.links[2].physics = JointPhysics {
        armature: 0.002.into(),
        damping: 0.05.into(),
        friction: 0.3.into(),
        friction_velocity: 0.2.into(),
        stiffness: 2.0.into(),
        rest: vec![0.4],
    };
    model
}

#[test]
fn a_linkage_with_geared_cranks_accelerates_as_kanes_equations_have_it() {
    let plain = generic("test/geared_five_bar");
    let lossy = GenericMechanism::new(with_losses(plain.model().clone()));
    let mut random = Random::new(1);
    for _ in 0..40 {
        let start = closed(random.within(3.0), random.within(6.0));
        let tau: [f64; 3] = core::array::from_fn(|_| random.within(5.0));
        let found = ClosedLoop::new(&FiveBar).dynamics(&start.q, &start.v, &tau).expect("regular");
        let [a, lambda] = by_kane(plain.model(), &start.q, &start.v, &tau);
        assert_near(&found.accelerations, &a, "accelerations");
        assert_near(&found.multipliers, &lambda, "multipliers");
        let [q, v, tau] = [start.q, start.v, tau].map(|x| x.to_vec());
        let found = ClosedLoop::new(&lossy).dynamics(&q, &v, &tau).expect("regular");
        let [with_losses, lambda] = by_kane(lossy.model(), &q, &v, &tau);
        assert_near(&found.accelerations, &with_losses, "accelerations with losses");
        assert_near(&found.multipliers, &lambda, "multipliers with losses");
        assert!((with_losses[0] - a[0]).abs() > 1e-3, "{} and {}", with_losses[0], a[0]);
    }
}

#[test]
fn inverse_dynamics_of_geared_cranks_returns_the_forces_that_were_applied() {
    let loops = ClosedLoop::new(&FiveBar);
    let mut random = Random::new(2);
    for _ in 0..40 {
        let start = closed(random.within(3.0), random.within(6.0));
        // A motor on the crank, or on the joint of a coupler behind the geared crank.
        for motor in [[0], [2]] {
            let mut tau = [0.0; 3];
            tau[motor[0]] = random.within(5.0);
            let forward = loops.dynamics(&start.q, &start.v, &tau).expect("regular");
            let (q, v, a) = ([start.q[0]], [start.v[0]], [forward.accelerations[0]]);
            let mut inverse = ClosedLoopInverse::new(loops, &[0], start.q).actuated(&motor);
            let found = inverse.at(0.0, &|_: f64| Motion { q, v, a }).expect("it moves");
            assert_near(&found.motion.a, &forward.accelerations, "accelerations");
            assert_near(&found.forces, &tau, "forces");
            assert_near(&found.multipliers, &forward.multipliers, "multipliers");
        }
    }
}

/// Ten seconds of free motion. With one degree of freedom and without losses, the energy and closed loops determine it.
#[test]
fn free_motion_of_geared_cranks_keeps_its_energy_and_its_loop_closed() {
    let judge = generic("test/geared_five_bar");
    let energy = |q: &[f64; 3], v: &[f64; 3]| {
        let equations = kane(judge.model(), q, v);
        (equations.kinetic, equations.kinetic + equations.potential)
    };
    let start = closed(0.4, 9.0);
    let mut simulation = ClosedLoopSimulation::new(ClosedLoop::new(&FiveBar), ZeroTorque);
    let copy = ClosedLoopSimulation::new(ClosedLoop::new(&FiveBar), ZeroTorque);
    let state: [f64; 7] = simulation.assembled(&start);
    let at_start = energy(&start.q, &start.v).1;
    let (mut residual, mut change, mut scale, mut turned) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    let on_step = |step: &redysim::Step<'_, f64, _>| {
        let now = copy.split(step.end().1);
        let (kinetic, total) = energy(&now.q, &now.v);
        residual = residual.max(largest(&FiveBar::loop_residual(&now.q)));
        change = Real::maximum(change, (total - at_start).abs());
        (scale, turned) = (scale.max(kinetic), turned.max((now.q[0] - start.q[0]).abs()));
    };
    let method = Dop853::new().rtol(1e-12).atol(1e-13);
    method.each_step(&mut simulation, (0.0, 10.0), state, on_step).expect("it moves");
    println!("residual {residual:.1e} m, energy {change:.1e} of {scale:.1} J, turned {turned:.1} rad");
    assert!(turned > 20.0, "it turns over: {turned} rad");
    // Roundings of the geared crank's 200 rad, 3e-14, at lengths of 0.4 m.
    assert!(residual <= 1e-13, "{residual:e} m");
    assert!(change <= 1e-10 * scale, "{change:e} J of {scale} J");
}

/// The linkage without `mimic`, and the gear as one more constraint.
struct WithGear<'m>(&'m GenericMechanism);

impl LoopRows for WithGear<'_> {
    fn nc(&self) -> usize {
        self.0.nc() + 1
    }
}

impl LoopClosure<f64, GenericMechanism> for WithGear<'_> {
    type Rows = Vec<f64>;
    type Jacobian = Vec<Vec<f64>>;
    type Gram = Vec<Vec<f64>>;

    fn loop_residual(&self, q: &Vec<f64>) -> Vec<f64> {
        [self.0.loop_residual(q), vec![q[2] - RATIO * q[0] - OFFSET]].concat()
    }
    fn loop_jacobian(&self, q: &Vec<f64>) -> Vec<Vec<f64>> {
        [self.0.loop_jacobian(q), vec![vec![-RATIO, 0.0, 1.0, 0.0]]].concat()
    }
    fn loop_bias(&self, q: &Vec<f64>, v: &Vec<f64>) -> Vec<f64> {
        [self.0.loop_bias(q, v), vec![0.0]].concat()
    }
}

/// A force at the geared crank counts at the other by the ratio.
#[test]
fn cranks_that_mimic_move_as_cranks_with_the_gear_as_a_constraint() {
    let mut model = generic("test/geared_five_bar").model().clone();
    model.links[2].mimic = None;
    let open = GenericMechanism::new(model);
    let gear = WithGear(&open);
    let (mimicking, constrained) = (ClosedLoop::new(&FiveBar), ClosedLoop::with_closure(&open, &gear));
    let mut random = Random::new(3);
    for _ in 0..20 {
        let start = closed(random.within(3.0), random.within(6.0));
        let (q, v) = (start.q, start.v);
        let all_q = vec![q[0], q[1], RATIO * q[0] + OFFSET, q[2]];
        let all_v = vec![v[0], v[1], RATIO * v[0], v[2]];
        let forces: Vec<f64> = random.vector(4, 5.0);
        let tau = [forces[0] + RATIO * forces[2], forces[1], forces[3]];
        let found = mimicking.dynamics(&q, &v, &tau).expect("regular");
        let expected = constrained.dynamics(&all_q, &all_v, &forces).expect("regular");
        let a = found.accelerations;
        assert_near(&[a[0], a[1], RATIO * a[0], a[2]], &expected.accelerations, "accelerations");
        assert_near(&found.multipliers, &expected.multipliers[..2], "multipliers");
    }
    let start = closed(0.4, 9.0);
    let (q, v) = (start.q, start.v);
    let mut one = ClosedLoopSimulation::new(mimicking, ZeroTorque);
    let mut other = ClosedLoopSimulation::new(constrained, ZeroTorque);
    let from = other
        .start(&vec![q[0], q[1], RATIO * q[0] + OFFSET, q[2]], &vec![v[0], v[1], RATIO * v[0], v[2]])
        .expect("a closed start");
    let method = Dop853::new().rtol(1e-12).atol(1e-13);
    let state: [f64; 7] = one.assembled(&start);
    let found = method.integrate(&mut one, (0.0, 2.0), state).expect("it moves").y;
    let expected = method.integrate(&mut other, (0.0, 2.0), from).expect("it moves").y;
    let found = [found[0], found[1], RATIO * found[0] + OFFSET, found[2]];
    let worst = found.iter().zip(&expected).map(|(x, y)| (x - y).abs()).fold(0.0, Real::maximum);
    println!("{worst:.1e} rad after 2 s");
    // Errors of 1e-12 a step, over a few hundred steps.
    assert!(worst < 1e-9, "{worst:e} rad: {found:?} instead of {expected:?}");
}

/// Turns of the motor for one of the crank.
const REDUCTION: f64 = 50.0;
/// The moment of inertia of the motor about its axis, kg m².
const WHEEL: f64 = 2e-5;

/// The paper's four-bar with a balanced wheel whose joint the crank mimics; and with that wheel as the crank's armature.
fn behind_a_gear() -> [GenericMechanism; 2] {
    let plain = generic("fourbar").model().clone();
    let mut geared = plain.clone();
    for link in &mut geared.links {
        link.parent = link.parent.map(|parent| parent + 1);
    }
    for side in geared.loops.iter_mut().flat_map(|cut| [&mut cut.a, &mut cut.b]) {
        side.link = side.link.map(|link| link + 1);
    }
    geared.links[0].mimic = Some(Mimic { link: 0, multiplier: 1.0 / REDUCTION, offset: 0.3 });
    let inertia = Inertia { xx: WHEEL, yy: WHEEL, zz: WHEEL, ..Inertia::default() };
    geared.links.insert(0, Link { mass: 0.4, inertia, ..Link::new("motor", None, JointKind::Revolute) });
    let mut armature = plain;
    armature.links[0].physics.armature = (REDUCTION * REDUCTION * WHEEL).into();
    [geared, armature]
        .map(|model| GenericMechanism::new(model.check().unwrap_or_else(|faults| panic!("{faults}")).model))
}

#[test]
fn a_crank_that_mimics_its_motor_moves_as_one_with_the_motor_as_armature() {
    let [geared, armature] = behind_a_gear();
    let [of_geared, of_armature] = [&geared, &armature].map(ClosedLoop::new);
    let at_motor = |crank: f64| REDUCTION * (crank - 0.3);
    let mut random = Random::new(4);
    for _ in 0..20 {
        let (angle, rate) = (random.within(3.0), random.within(6.0));
        let crank = of_armature.assemble(&vec![angle, 1.1, 4.2], &vec![rate, 0.0, 0.0], &[0]).expect("it closes");
        let guess = vec![at_motor(angle), crank.q[1] + 0.02, crank.q[2] - 0.02];
        let motor = of_geared.assemble(&guess, &vec![REDUCTION * rate, 0.0, 0.0], &[0]).expect("it closes");
        assert!(motor.position_residual <= 1e-14, "{:e} m", motor.position_residual);
        assert_near(&motor.q[1..], &crank.q[1..], "coordinates");
        assert_near(&motor.v[1..], &crank.v[1..], "velocities");
        let torque = random.within(0.5);
        let found = of_geared.dynamics(&motor.q, &motor.v, &vec![torque, 0.0, 0.0]).expect("regular");
        let expected = of_armature.dynamics(&crank.q, &crank.v, &vec![REDUCTION * torque, 0.0, 0.0]).expect("regular");
        let a = &found.accelerations;
        assert_near(&[a[0] / REDUCTION, a[1], a[2]], &expected.accelerations, "accelerations");
        assert_near(&found.multipliers, &expected.multipliers, "multipliers");
        let motion = |_: f64| Motion { q: vec![motor.q[0]], v: vec![motor.v[0]], a: vec![a[0]] };
        let inverse = ClosedLoopInverse::new(of_geared, &[0], motor.q.clone()).at(0.0, &motion).expect("it moves");
        assert_near(&inverse.forces, &[torque, 0.0, 0.0], "forces");
    }
    let crank = of_armature.assemble(&vec![0.0, 0.98, 4.31], &vec![4.7, 0.0, 0.0], &[0]).expect("it closes");
    let mut one = ClosedLoopSimulation::new(of_geared, ZeroTorque);
    let mut other = ClosedLoopSimulation::new(of_armature, ZeroTorque);
    let q = [&[at_motor(crank.q[0])], &crank.q[1..]].concat();
    let v = [&[REDUCTION * crank.v[0]], &crank.v[1..]].concat();
    let from = one.start(&q, &v).expect("a closed start");
    let method = Dop853::new().rtol(1e-12).atol(1e-13);
    let found = method.integrate(&mut one, (0.0, 2.0), from).expect("it moves").y;
    let start = other.assembled(&crank);
    let expected = method.integrate(&mut other, (0.0, 2.0), start).expect("it moves").y;
    let worst = largest(&[found[0] / REDUCTION + 0.3 - expected[0], found[1] - expected[1], found[2] - expected[2]]);
    println!("{worst:.1e} rad after 2 s, the crank at {:.1} rad", expected[0]);
    assert!(worst < 1e-9, "{worst:e} rad: {found:?} instead of {expected:?}");
}
