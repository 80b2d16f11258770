//! Springs and dampers between two points, against closed forms, the balance of energy and what they cost.
//! `random_trees.rs` has them against Kane's equations.
#![cfg(feature = "generic")]

use crate::common::random::Random;
use crate::common::text::{flops, mechanism};
use redysim::generic::{GenericMechanism, Model};
use redysim::{
    BiasForces, ClosedLoop, ClosedLoopSimulation, ConfigurationSpace, Dual, ForwardDynamics, ForwardSimulation,
    Integrator, InverseDynamics, MechanicalEnergy, Ode4, Ode45, PassiveForces, Radau5, Scalar, SimulationState,
    ZeroTorque, redysim,
};

redysim! { struct Springs("models/test/springs.toml", functions = [forward_dynamics, energy]); }

fn shipped(name: &str) -> String {
    let path = format!("{}/models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("a model")
}

/// A block of 2 kg on a level rail along x, 0.3 m beside which a spring is fixed to the ground.
fn block(spring: &str) -> GenericMechanism {
    mechanism(&format!(
        "name = 'block'\ngravity = [0, 0, -9.81]\n[[link]]\nname = 'block'\nparent = 'base'\njoint = 'prismatic'\n\
         axis = [1, 0, 0]\nmass = 2.0\n[[spring]]\nlink_a = 'block'\nlink_b = 'base'\n{spring}"
    ))
}

/// m ẍ + c ẋ + k (x − ℓ₀) = 0 while the block stays on one side of the spring's other end.
#[test]
fn a_block_on_a_spring_along_its_rail_moves_as_its_closed_form() {
    let oscillator = block("stiffness = 40.0\ndamping = 1.5\nlength = 0.9");
    let (mass, damping, stiffness, rest): (f64, f64, f64, f64) = (2.0, 1.5, 40.0, 0.9);
    let decay = damping / (2.0 * mass);
    let frequency = (stiffness / mass - decay * decay).sqrt();
    let (q, v, time) = (1.2, -0.3, 1.7_f64);
    let (sin, cos) = f64::sin_cos(frequency * time);
    let (a, b) = (q - rest, (v + decay * (q - rest)) / frequency);
    let shrunk = (-decay * time).exp();
    let expected = [
        rest + shrunk * (a * cos + b * sin),
        shrunk * ((b * frequency - decay * a) * cos - (a * frequency + decay * b) * sin),
    ];
    let mut simulation = ForwardSimulation::new(&oscillator, ZeroTorque);
    let start = simulation.state(&vec![q], &vec![v]);
    let end = Ode45::new().rtol(1e-11).atol(1e-13).integrate(&mut simulation, (0.0, time), start).expect("it moves").y;
    for (found, expected) in end.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-9, "{found} instead of {expected}");
    }
}

/// A pendulum of the length l that hangs below a point at the height h, to which a spring is fixed:
/// ℓ² = h² + l² + 2 h l cos q from the hanging position, τ = m l² a + m g l sin q + (k (ℓ − ℓ₀) + c ℓ̇) dℓ/dq.
#[test]
fn a_pendulum_on_a_spring_takes_the_torque_of_its_lagrangian() {
    let (mass, arm, height, stiffness, damping, free) = (1.3, 0.7, 0.4, 60.0, 4.0, 0.5);
    let pendulum = mechanism(&format!(
        "name = 'pendulum'\ngravity = [0, 0, -9.81]\n[[link]]\nname = 'rod'\nparent = 'base'\njoint = 'revolute'\n\
         origin = {{ xyz = [0.2, 0, 1] }}\naxis = [0, 1, 0]\nmass = {mass}\ncom = [0, 0, -{arm}]\n[[spring]]\n\
         link_a = 'base'\npoint_a = [0.2, 0, {}]\nlink_b = 'rod'\npoint_b = [0, 0, -{arm}]\nstiffness = {stiffness:?}\n\
         damping = {damping:?}\nlength = {free}",
        1.0 + height
    ));
    let mut random = Random::new(5);
    for _ in 0..100 {
        let [q, v, a]: [f64; 3] = [3.0, 4.0, 9.0].map(|range| random.within(range));
        let length = (height * height + arm * arm + 2.0 * height * arm * q.cos()).sqrt();
        let slope = -height * arm * q.sin() / length;
        let tension = stiffness * (length - free) + damping * slope * v;
        let expected = mass * arm * arm * a + mass * 9.81 * arm * q.sin() + tension * slope;
        let found = pendulum.inverse_dynamics(&vec![q], &vec![v], &vec![a])[0];
        assert!((found - expected).abs() < 1e-12, "{found} instead of {expected}");
        let passive = pendulum.passive_forces(&vec![q], &vec![v])[0];
        assert!((passive - tension * slope).abs() < 1e-12);
        let back: f64 = pendulum.forward_dynamics(&vec![q], &vec![v], &vec![found])[0];
        assert!((back - a).abs() < 1e-11, "{back} instead of {a}");
        let energy = 0.5 * stiffness * (length - free).powi(2) + mass * 9.81 * (1.0 - arm * q.cos());
        assert!((pendulum.energy(&vec![q], &vec![v]).potential - energy).abs() < 1e-12);
        let power: f64 = pendulum.dissipated_power(&vec![q], &vec![v]);
        assert!((power - damping * (slope * v).powi(2)).abs() < 1e-12);
    }
}

/// The spring balance of lamps and arms: with k h r = m g l, the moments of weight and spring cancel at every position.
#[test]
fn a_spring_without_free_length_balances_a_beam_at_every_position() {
    let (mass, com, height, arm) = (4.0, 0.6, 0.5, 0.3);
    let stiffness = mass * 9.81 * com / (height * arm);
    let beam = mechanism(&format!(
        "name = 'beam'\ngravity = [0, 0, -9.81]\n[[link]]\nname = 'beam'\nparent = 'base'\njoint = 'revolute'\n\
         axis = [0, 1, 0]\nmass = {mass:?}\ncom = [{com}, 0, 0]\n[[spring]]\nlink_a = 'base'\npoint_a = [0, 0, {height}]\n\
         link_b = 'beam'\npoint_b = [{arm}, 0, 0]\nstiffness = {stiffness:?}\nlength = 0"
    ));
    for step in 0..100 {
        let q = 0.07 * f64::from(step);
        let torque = beam.bias_forces(&vec![q], &vec![0.0])[0];
        assert!(torque.abs() < 1e-13 * mass * 9.81, "{torque} N m at {q} rad");
    }
}

/// The joint force, the acceleration, the energy and the dissipated power where the block is at the spring's other end.
fn at_the_end<S: Scalar>(spring: &str, v: f64) -> [S; 4] {
    let block = block(spring);
    let (q, v) = (vec![S::zero()], vec![S::from_f64(v)]);
    let force = BiasForces::<S>::bias_forces(&block, &q, &v)[0];
    let acceleration = ForwardDynamics::<S>::forward_dynamics(&block, &q, &v, &vec![S::zero()])[0];
    [force, acceleration, block.energy(&q, &v).potential, block.dissipated_power(&q, &v)]
}

#[test]
fn a_spring_whose_ends_meet_has_no_force_and_its_functions_are_finite() {
    let springs = ["stiffness = 1e6\nlength = 0.5", "stiffness = 1e6\ndamping = 1e4\nlength = 0", "damping = 1e4"];
    for (spring, energy) in springs.into_iter().zip([0.5 * 1e6 * 0.25, 0.0, 0.0]) {
        assert_eq!(at_the_end::<f64>(spring, 2.0).map(f64::abs)[..2], [0.0; 2], "{spring}");
        let [_, _, found, power] = at_the_end::<f64>(spring, 2.0);
        assert!((found - energy).abs() < 1e-9 && power == 0.0, "{spring}: {found} J, {power} W");
        let single = at_the_end::<f32>(spring, 2.0);
        assert!(single.iter().all(|x| x.is_finite()), "{spring}: {single:?}");
        let moving = at_the_end::<Dual<f64>>(spring, 2.0);
        assert!(moving.iter().all(|x| x.slope.is_finite()), "{spring}: {moving:?}");
    }
    // Without free length and damper the force of a spring is its stiffness times the vector between its ends.
    let slope = |q: f64| block("stiffness = 70.0\nlength = 0").bias_forces(&vec![q], &vec![0.0])[0];
    assert_eq!([slope(1e-200), slope(-0.25)], [70e-200, -17.5]);
}

#[test]
fn energy_falls_by_what_dampers_between_points_take() {
    let (q, v) = ([0.3, 0.9, -0.7, 0.4, 1.1], [1.0, -0.6, 0.8, 2.0, -1.5]);
    let mut simulation = ForwardSimulation::new(&Springs, ZeroTorque);
    let start = simulation.state(&q, &v);
    let explicit = Ode45::new().rtol(1e-10).atol(1e-10).integrate(&mut simulation, (0.0, 1.0), start);
    let implicit = Radau5::new().rtol(1e-10).atol(1e-10).integrate(&mut simulation, (0.0, 1.0), start);
    let before = Springs::energy(&q, &v).total();
    let ends = [explicit, implicit].map(|end| end.expect("it moves").y);
    for end in ends {
        let SimulationState { q, v, actuator_energy: taken } = simulation.split(&end);
        let change: f64 = Springs::energy(&q, &v).total() - before;
        assert!(change < -10.0, "{change} J");
        assert!((change - taken).abs() < 1e-6, "{change} J, of which {taken} J are known");
    }
    for (explicit, implicit) in ends[0].iter().zip(ends[1]) {
        assert!((explicit - implicit).abs() < 1e-6, "{ends:?}");
    }
}

#[test]
fn a_four_bar_with_a_damped_spring_across_its_loop_loses_what_the_damper_takes() {
    let spring = "[[spring]]\nlink_a = 'coupler'\npoint_a = [0.05, 0.02, 0]\nlink_b = 'base'\npoint_b = [0.03, 0.15, 0]\n\
                  stiffness = 800.0\ndamping = 12.0\nlength = 0.1\n";
    let sprung = mechanism(&format!("{}\n{spring}", shipped("fourbar")));
    let mut fall = ClosedLoopSimulation::new(ClosedLoop::new(&sprung), ZeroTorque);
    let q = vec![0.0, 0.984_373_060_839_76, 4.314_439_185_500_066];
    let start = fall.start(&q, &vec![0.0; 3]).expect("a closed start");
    let before = sprung.energy(&q, &vec![0.0; 3]).total();
    let end = Ode45::new().rtol(1e-10).atol(1e-12).integrate(&mut fall, (0.0, 0.5), start).expect("it falls").y;
    let SimulationState { q, v, actuator_energy: taken } = fall.split(&end);
    let change: f64 = sprung.energy(&q, &v).total() - before;
    assert!(change < -0.1, "{change} J");
    assert!((change - taken).abs() < 1e-7, "{change} J, of which {taken} J are known");
}

/// ω = √(k/m) = 1000/s: Runge and Kutta's method is stable up to steps of 2.8/ω.
#[test]
fn steps_too_large_for_a_stiff_spring_are_warned_of() {
    let stiff = block("stiffness = 2e6\nlength = 0.5");
    let mut simulation = ForwardSimulation::new(&stiff, ZeroTorque);
    let state = simulation.state(&vec![0.6], &vec![0.0]);
    let mut warns = |step: f64| simulation.step_warning(&Ode4::new(step), 0.0, &state).expect("a state").is_some();
    assert!(warns(3e-3));
    assert!(!warns(2.5e-3));
}

/// The joints between the ends of the balancer and of the strut are locked.
#[test]
fn a_spring_between_links_that_locked_joints_make_one_body_has_no_effect() {
    let springs = Model::from_toml(shipped("test/springs"), "springs.toml").expect("a model").model;
    let locked = springs.locked(&[("fore", 0.4), ("upper", 0.2)]).expect("joints");
    let mut without = locked.clone();
    without.springs.retain(|spring| !["balancer", "strut"].map(Some).contains(&spring.name.as_deref()));
    assert_eq!(without.springs.len(), 2);
    let [locked, without] = [locked, without].map(GenericMechanism::new);
    let [q, v, a] = [vec![0.3, -0.4, 0.8], vec![1.0, 2.0, -0.5], vec![0.0, 3.0, 1.0]];
    assert_eq!(locked.inverse_dynamics(&q, &v, &a), without.inverse_dynamics(&q, &v, &a));
    let options = "locked = { fore = 0.4, upper = 0.2 }";
    assert!(Model::from_toml_with(shipped("test/springs"), "springs.toml", options).is_ok());
}

/// Of a spring over one joint, the line is what the joint turns, and the lever one product across it; of one over all six
/// joints, the points and the line pass each.
#[test]
fn a_spring_costs_kr5_what_its_joints_need() {
    let plain = shipped("peers/kr5");
    let with = |a: &str, b: &str, numbers: &str| {
        let spring = format!("[[spring]]\n{a}\n{b}\npoint_b = [0.2, 0.1, 0.05]\n{numbers}\n");
        let (plain, sprung) = (flops(&plain), flops(&format!("{plain}\n{spring}")));
        [0, 1, 2].map(|k| sprung[k] as i64 - i64::from(plain[k]))
    };
    let (one, six) = ("link_a = 'link1'\npoint_a = [0.1, 0, 0.3]", "link_a = 'base'\npoint_a = [0.1, 0, 0.3]");
    let found = [
        with(one, "link_b = 'link2'", "stiffness = 1e4\nlength = 0"),
        with(one, "link_b = 'link2'", "stiffness = 1e4\ndamping = 500.0\nlength = 0.2"),
        with(six, "link_b = 'link6'", "stiffness = 1e4\ndamping = 500.0\nlength = 0.2"),
    ];
    assert_eq!(found, [[13, 13, 0], [24, 24, 0], [110, 110, 0]]);
}
