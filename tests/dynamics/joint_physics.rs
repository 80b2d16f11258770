//! Rotors, damping, friction and springs in joints, against closed forms and the balance of energy. `random_trees.rs` has
//! them against Kane's equations.
#![cfg(feature = "generic")]

use crate::common::models::generic;
use crate::common::text::{flops, mechanism};
use crate::robots::Kr5Drives;
use redysim::generic::{GenericMechanism, Model};
use redysim::{
    ClosedLoop, ClosedLoopSimulation, ForwardDynamics, ForwardSimulation, Integrator, MechanicalEnergy, Ode4, Ode45,
    Radau5, SimulationState, ZeroTorque,
};
use redysim_codegen::source_file;

/// A block of 2 kg on a level rail, with what acts in its joint.
fn block(physics: &str) -> GenericMechanism {
    mechanism(&format!(
        "name = 'block'\ngravity = [0, 0, -9.81]\n[[link]]\nname = 'block'\nparent = 'base'\njoint = 'prismatic'\n\
         axis = [1, 0, 0]\nmass = 2.0\n{physics}"
    ))
}

/// Position and velocity after a time.
fn moved(block: &GenericMechanism, [q, v]: [f64; 2], time: f64) -> [f64; 2] {
    let mut simulation = ForwardSimulation::new(block, ZeroTorque);
    let start = simulation.state(&vec![q], &vec![v]);
    let end = Ode45::new().rtol(1e-11).atol(1e-13).integrate(&mut simulation, (0.0, time), start).expect("it moves").y;
    [end[0], end[1]]
}

/// Runge and Kutta's method is stable for steps of up to 2.79/λ where what acts damps, λ = d/m or F/(ε m), and of up to
/// 2.83/ω where it swings, ω² = k/m.
#[test]
fn steps_too_large_for_what_acts_in_a_joint_are_warned_of() {
    let cases = ["damping = 2e3", "stiffness = 2e6", "friction = 20.0\nfriction_velocity = 0.01"];
    for physics in cases {
        let block = block(physics);
        let mut simulation = ForwardSimulation::new(&block, ZeroTorque);
        let state = simulation.state(&vec![0.0], &vec![0.0]);
        let mut warns = |step: f64| simulation.step_warning(&Ode4::new(step), 0.0, &state).expect("a state").is_some();
        assert!(warns(2.9e-3) && !warns(2.7e-3), "{physics}");
    }
}

/// (m + J) ẍ + d ẋ + k (x − x₀) = 0.
#[test]
fn a_block_on_a_spring_with_a_damper_moves_as_its_closed_form() {
    let oscillator = block("armature = 0.5\ndamping = 1.5\nstiffness = 40.0\nrest = 0.2");
    let (mass, damping, stiffness, rest): (f64, f64, f64, f64) = (2.0 + 0.5, 1.5, 40.0, 0.2);
    let decay = damping / (2.0 * mass);
    let frequency = (stiffness / mass - decay * decay).sqrt();
    let ([q, v], time) = ([0.5, -0.3], 1.7_f64);
    let (sin, cos) = f64::sin_cos(frequency * time);
    let (a, b) = (q - rest, (v + decay * (q - rest)) / frequency);
    let shrunk = (-decay * time).exp();
    let expected = [
        rest + shrunk * (a * cos + b * sin),
        shrunk * ((b * frequency - decay * a) * cos - (a * frequency + decay * b) * sin),
    ];
    let found = moved(&oscillator, [q, v], time);
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-9, "{found} instead of {expected}");
    }
}

/// m v dv/dx = −f v/√(v² + ε²), so that the block comes to rest after m/f ∫ √(v² + ε²) dv; with Coulomb's friction,
/// ε = 0, after m v²/2f.
#[test]
fn a_block_slides_as_far_as_its_friction_lets_it_and_smoothing_adds_what_its_closed_form_says() {
    let (mass, friction, speed) = (2.0, 3.0, 1.2_f64);
    let coulomb = mass * speed * speed / (2.0 * friction);
    let mut beyond = Vec::new();
    for smoothing in [0.1_f64, 0.01, 0.001] {
        let sliding = block(&format!("friction = {friction:?}\nfriction_velocity = {smoothing:?}"));
        let [slid, left] = moved(&sliding, [0.0, speed], 5.0);
        let integral = speed * speed.hypot(smoothing) + smoothing * smoothing * (speed / smoothing).asinh();
        assert!((slid - mass / friction * 0.5 * integral).abs() < 1e-8, "{slid}");
        assert!(left.abs() < 1e-8, "still at {left} m/s");
        beyond.push(slid - coulomb);
    }
    assert!(beyond[0] > 50.0 * beyond[1] && beyond[1] > 50.0 * beyond[2] && beyond[2] > 0.0, "{beyond:?}");
}

/// Where f v/√(v² + ε²) is the load F, v = ε F/√(f² − F²).
#[test]
fn a_joint_under_a_load_below_its_friction_creeps() {
    let (friction, smoothing, load) = (3.0_f64, 0.01, 1.8);
    let loaded = block(&format!("friction = {friction:?}\nfriction_velocity = {smoothing:?}"));
    let creep = smoothing * load / (friction * friction - load * load).sqrt();
    let acceleration = loaded.forward_dynamics(&vec![0.0], &vec![creep], &vec![load])[0];
    assert!(acceleration.abs() < 1e-15, "{acceleration}");
}

#[test]
fn energy_falls_by_what_damping_and_friction_take() {
    let (q, v) = ([0.3, 0.9, -0.7, 0.4, 1.1, -0.2], [1.0, -0.6, 0.8, 2.0, -1.5, 3.0]);
    let mut simulation = ForwardSimulation::new(&Kr5Drives, ZeroTorque);
    let start = simulation.state(&q, &v);
    let explicit = Ode45::new().rtol(1e-10).atol(1e-10).integrate(&mut simulation, (0.0, 1.0), start);
    let implicit = Radau5::new().rtol(1e-10).atol(1e-10).integrate(&mut simulation, (0.0, 1.0), start);
    let before = Kr5Drives::energy(&q, &v).total();
    for end in [explicit, implicit] {
        let SimulationState { q, v, actuator_energy } = simulation.split(&end.expect("it falls").y);
        let change: f64 = Kr5Drives::energy(&q, &v).total() - before;
        assert!(change < -10.0, "{change} J");
        let taken: f64 = actuator_energy;
        assert!((change - taken).abs() < 1e-6, "{change} J, of which {taken} J are known");
    }
}

#[test]
fn a_four_bar_with_dampers_in_its_joints_loses_what_they_take() {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/models/fourbar.toml")).expect("a model");
    let damped = mechanism(&text.replace("\"revolute\"\ndh", "\"revolute\"\ndamping = 0.02\nfriction = 0.1\ndh"));
    assert_eq!(damped.model().links[2].physics.damping, 0.02.into());
    let mut fall = ClosedLoopSimulation::new(ClosedLoop::new(&damped), ZeroTorque);
    let q = vec![0.0, 0.984_373_060_839_76, 4.314_439_185_500_066];
    let start = fall.start(&q, &vec![0.0; 3]).expect("a closed start");
    let before = damped.energy(&q, &vec![0.0; 3]).total();
    let end = Ode45::new().rtol(1e-10).atol(1e-12).integrate(&mut fall, (0.0, 0.5), start).expect("it falls").y;
    let SimulationState { q, v, actuator_energy: taken } = fall.split(&end);
    let change: f64 = damped.energy(&q, &v).total() - before;
    assert!(change < -0.1, "{change} J");
    assert!((change - taken).abs() < 1e-7, "{change} J, of which {taken} J are known");
}

/// Constants of M's diagonal are added to others that are there. Forward dynamics starts from accelerations at which no body
/// accelerates along its own joint: those of the wrist, which are not zero, take forces for the rotors.
#[test]
fn rotors_in_all_joints_cost_kr5_eight_ten_and_three_operations() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/models/peers/kr5.toml");
    let plain = std::fs::read_to_string(path).expect("a model");
    let driven = plain.replace("mass =", "armature = 0.3\nmass =");
    let (plain, driven) = (flops(&plain), flops(&driven));
    assert_eq!([0, 1, 2].map(|k| driven[k] - plain[k]), [8, 10, 3]);
}

#[test]
fn numbers_that_are_zero_change_nothing() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/models/peers/kr5.toml");
    let plain = std::fs::read_to_string(path).expect("a model");
    let zero = plain.replace("mass =", "armature = 0\ndamping = 0\nfriction = 0\nstiffness = 0\nrest = 0.3\nmass =");
    assert_eq!(flops(&zero), flops(&plain));
    let source = |text: &str| {
        let model = Model::from_toml(text, "kr5.toml").expect("a good model").model;
        let source = source_file(&model, "Kr5").expect("no pass changes a value");
        let (head, rest) = source.split_once("\n// Model hash ").expect("the head has the model's hash");
        format!("{head}\n{}", rest.split_once('\n').expect("a line").1)
    };
    let of_plain = source(&plain);
    assert!(source(&zero) == of_plain, "but for the model's hash, the generated source is another one");
    let small = zero.replacen("damping = 0", "damping = 1e-9", 1);
    assert!(source(&small) != of_plain, "what is small is not zero");
    let (plain, zero) = (generic("peers/kr5"), mechanism(&zero));
    let [q, v, tau] = [0.4, -1.3, 7.0].map(|x: f64| (1..=6).map(|i| x * f64::from(i).cos()).collect::<Vec<f64>>());
    let bits = |values: Vec<f64>| values.into_iter().map(f64::to_bits).collect::<Vec<_>>();
    assert_eq!(bits(zero.forward_dynamics(&q, &v, &tau)), bits(plain.forward_dynamics(&q, &v, &tau)));
    let [zero, plain] = [zero, plain].map(|mechanism| mechanism.energy(&q, &v).potential.to_bits());
    assert_eq!(zero, plain);
}
