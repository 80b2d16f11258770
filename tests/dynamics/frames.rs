//! Frames of interest: what they are to each other, to the links and to the energy of a mechanism.
#![cfg(feature = "generic")]

use crate::common::call::frames;
use crate::common::double_double::{DoubleDouble, exact, rounded};
use crate::common::dual::{Dual, moving};
use crate::common::random::{Random, State};
use crate::robots::Gripper;
use redysim::generic::{Frame, GenericMechanism, Link, Model, Pose};
use redysim::{Dispatch, FrameState, Frames, GravityForces, LinkKinematics, Mechanism, Scalar, Wrench};
use redysim::{OperationCount, redysim};
use redysim_codegen::operations;

redysim! {
    /// A rail, a screw and two arms, with five frames.
    pub struct Machine("models/test/frames.toml");
}

/// The text of a model file.
fn text(name: &str) -> String {
    std::fs::read_to_string(format!("{}/models/{name}.toml", env!("CARGO_MANIFEST_DIR"))).expect("a model file")
}

fn model(text: &str) -> Model {
    Model::from_toml(text, "model.toml").expect("a good model").model
}

fn states() -> impl Iterator<Item = State> {
    let mut random = Random::new(3);
    (0..50).map(move |_| random.state(Machine::NV))
}

/// `found` and `expected` differ by at most `tolerance` of the largest number expected, and of 1.
fn assert_close(what: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let scale = expected.iter().fold(1.0_f64, |scale, x| scale.max(x.abs()));
    for (x, y) in found.iter().zip(expected) {
        assert!((x - y).abs() <= tolerance * scale, "{what}: {found:?} instead of {expected:?}");
    }
}

fn times<S: Scalar>(rows: &[[S; Machine::NV]; 3], v: &[S]) -> [S; 3] {
    rows.map(|row| row.iter().zip(v).fold(S::zero(), |sum, (&x, &v)| sum + x * v))
}

fn dot<S: Scalar>(a: &[S], b: &[S]) -> S {
    a.iter().zip(b).fold(S::zero(), |sum, (&a, &b)| sum + a * b)
}

fn wrenches(random: &mut Random) -> [Wrench<f64>; Machine::NF] {
    [(); Machine::NF]
        .map(|()| Wrench { force: [(); 3].map(|()| random.within(9.0)), moment: [(); 3].map(|()| random.within(2.0)) })
}

#[test]
fn a_mechanism_has_the_frames_of_its_file() {
    let names = ["tool", "camera", "elbow", "rim", "bench"];
    assert_eq!((Machine::NF, Machine::FRAME_NAMES), (5, names));
    let generic = GenericMechanism::new(model(&text("test/frames")));
    for mechanism in [&Machine as &dyn Mechanism, &generic, &Machine.dispatched()] {
        assert_eq!(mechanism.nf(), 5);
        let found: Vec<_> = (0..=5).map(|index| mechanism.frame_name(index)).collect();
        assert_eq!(found, names.map(Some).into_iter().chain([None]).collect::<Vec<_>>());
    }
}

#[test]
fn a_mechanism_without_frames_has_no_functions_of_frames() {
    assert_eq!((Gripper::NF, Gripper::FRAME_NAMES), (0, [""; 0]));
    assert_eq!(Gripper::OPS.frame_jacobians, OperationCount::NONE);
    let model = model(&text("gripper"));
    let counted = operations(&model, &Default::default()).expect("no pass changes a value").operations;
    assert!(counted.iter().all(|(function, _)| !function.needs_frames()));
}

#[test]
fn a_frame_moves_as_a_link_that_is_fixed_there() {
    let mut model = model(&text("test/frames"));
    let palm = model.links[4].clone();
    let fixed =
        model.frames.iter().map(|frame| Link { parent: frame.link, placement: frame.placement, ..palm.clone() });
    model.links.extend(fixed.collect::<Vec<_>>());
    let generic = GenericMechanism::new(model);
    for State { q, v, .. } in states() {
        let (q, v) = (q.try_into().unwrap(), v.try_into().unwrap());
        let links = generic.link_kinematics(&Vec::from(q), &Vec::from(v));
        for (frame, link) in Machine::frame_kinematics(&q, &v).iter().zip(&links[Machine::NL..]) {
            assert_close("rotation", &frame.rotation.concat(), &link.rotation.concat(), 1e-14);
            assert_close("origin", &frame.origin, &link.origin, 1e-14);
            assert_close("velocity", &frame.velocity, &link.velocity, 1e-14);
            assert_close("angular velocity", &frame.angular_velocity, &link.angular_velocity, 1e-14);
        }
    }
}

#[test]
fn a_jacobian_times_joint_velocities_is_the_velocity_of_its_frame() {
    for State { q, v, .. } in states() {
        let (q, v) = (q.try_into().unwrap(), v.try_into().unwrap());
        for (state, jacobian) in Machine::frame_kinematics(&q, &v).iter().zip(Machine::frame_jacobians(&q)) {
            assert_close("velocity", &times(&jacobian.linear, &v), &state.velocity, 1e-14);
            assert_close("angular velocity", &times(&jacobian.angular, &v), &state.angular_velocity, 1e-14);
        }
    }
}

/// By dual numbers along q̇ = v.
#[test]
fn velocity_is_the_derivative_of_position_and_bias_that_of_velocity_at_constant_joint_velocities() {
    for State { q, v, .. } in states() {
        let along: [Dual<f64>; Machine::NQ] = moving(&q, &v).try_into().unwrap();
        let constant: [Dual<f64>; Machine::NV] = moving(&v, &[0.0; Machine::NV]).try_into().unwrap();
        let bias = Machine::frame_bias(&q.try_into().unwrap(), &v.clone().try_into().unwrap());
        let rates = |vector: [Dual<f64>; 3]| vector.map(|x| x.rate);
        let values = |vector: [Dual<f64>; 3]| vector.map(|x| x.value);
        for (state, bias) in Machine::frame_kinematics(&along, &constant).into_iter().zip(bias) {
            assert_close("velocity", &rates(state.origin), &values(state.velocity), 1e-13);
            assert_close("acceleration", &bias.linear, &rates(state.velocity), 1e-13);
            assert_close("angular acceleration", &bias.angular, &rates(state.angular_velocity), 1e-13);
            // Ṙ Rᵀ = ω ×
            let turning =
                |i: usize, j: usize| (0..3).map(|k| state.rotation[i][k].rate * state.rotation[j][k].value).sum();
            let spin: [f64; 3] = [turning(2, 1), turning(0, 2), turning(1, 0)];
            assert_close("angular velocity", &spin, &values(state.angular_velocity), 1e-13);
        }
        // J̇ v, with the derivative of the Jacobian itself.
        for (jacobian, bias) in Machine::frame_jacobians(&along).into_iter().zip(bias) {
            assert_close("linear", &rates(times(&jacobian.linear, &constant)), &bias.linear, 1e-13);
            assert_close("angular", &rates(times(&jacobian.angular, &constant)), &bias.angular, 1e-13);
        }
    }
}

/// By central differences, whose error is of second order in the step.
#[test]
fn a_jacobian_takes_joint_velocities_to_differences_of_positions() {
    const STEP: f64 = 1e-5;
    for State { q, v, .. } in states() {
        let [behind, ahead] = [-STEP, STEP].map(|step| {
            let q: [f64; Machine::NQ] = std::array::from_fn(|joint| q[joint] + step * v[joint]);
            Machine::frame_kinematics(&q, &[0.0; Machine::NV]).map(|state| state.origin)
        });
        for (frame, jacobian) in Machine::frame_jacobians(&q.try_into().unwrap()).iter().enumerate() {
            let difference = [0, 1, 2].map(|k| (ahead[frame][k] - behind[frame][k]) / (2.0 * STEP));
            assert_close("velocity", &difference, &times(&jacobian.linear, &v), 1e-7);
        }
    }
}

#[test]
fn joint_forces_of_wrenches_have_the_power_of_the_wrenches() {
    let mut random = Random::new(5);
    for State { q, v, .. } in states() {
        let (q, v) = (q.try_into().unwrap(), v.try_into().unwrap());
        let wrenches = wrenches(&mut random);
        let states = Machine::frame_kinematics(&q, &v);
        let power = |(wrench, state): (&Wrench<f64>, &FrameState<f64>)| {
            dot(&wrench.force, &state.velocity) + dot(&wrench.moment, &state.angular_velocity)
        };
        let expected: f64 = wrenches.iter().zip(&states).map(power).sum();
        assert_close("power", &[dot(&Machine::frame_forces(&q, &wrenches), &v)], &[expected], 1e-14);
    }
}

#[test]
fn weights_at_the_centres_of_mass_are_balanced_by_the_gravity_forces() {
    let mut weighed = model(&text("test/frames"));
    let at_mass = |(index, link): (usize, &Link)| Frame {
        name: link.name.clone(),
        link: Some(index),
        placement: Pose { position: link.com, ..Pose::identity() },
    };
    weighed.frames = weighed.links.iter().enumerate().map(at_mass).collect();
    let weight = |link: &Link| Wrench { force: weighed.gravity.0.map(|g| link.mass * g), moment: [0.0; 3] };
    let weights = weighed.links.iter().map(weight).collect();
    let weighed = GenericMechanism::new(weighed);
    for State { q, .. } in states() {
        let forces: Vec<f64> = weighed.frame_forces(&q, &weights);
        let gravity = weighed.gravity_forces(&q).iter().map(|force| -force).collect::<Vec<f64>>();
        assert_close("weights", &forces, &gravity, 1e-14);
    }
}

#[test]
fn compiled_and_dispatched_types_compute_what_the_run_time_path_computes() {
    let generic = GenericMechanism::new(model(&text("test/frames")));
    let mut random = Random::new(6);
    for State { q, v, .. } in states() {
        let wrenches = wrenches(&mut random);
        let expected = frames(&generic, &q, &v, &wrenches.to_vec());
        let compiled = frames(&Machine, &q, &v, &wrenches);
        let dispatched = frames(&Machine.dispatched(), &q, &v, &wrenches);
        for ((expected, compiled), dispatched) in expected.iter().zip(&compiled).zip(&dispatched) {
            assert_close("compiled", compiled, expected, 1e-14);
            assert_eq!(compiled, dispatched);
        }
        // In double-double only the roundoff of constants that code generation folds is left.
        let exactly = |numbers: [f64; 3]| numbers.map(DoubleDouble::from_f64);
        let precise =
            wrenches.map(|Wrench { force, moment }| Wrench { force: exactly(force), moment: exactly(moment) });
        let (q, v) = (exact(&q), exact(&v));
        let expected = frames(&generic, &q, &v, &precise.to_vec());
        for (expected, compiled) in expected.into_iter().zip(frames(&Machine, &q, &v, &precise)) {
            assert_close("in double-double", &rounded(compiled), &rounded(expected), 1e-15);
        }
    }
}

#[test]
fn functions_of_frames_take_precomputed_sines_and_cosines() {
    let q = [0.3, -0.4, 0.5, 0.6, -0.7];
    let (v, wrenches) = ([0.1, 0.2, -0.3, 0.4, -0.5], wrenches(&mut Random::new(7)));
    let trig = Machine::joint_trig(&q);
    assert_eq!(Machine::frame_jacobians_with_trig(&trig), Machine::frame_jacobians(&q));
    assert_eq!(Machine::frame_bias_with_trig(&trig, &v), Machine::frame_bias(&q, &v));
    assert_eq!(Machine::frame_forces_with_trig(&trig, &wrenches), Machine::frame_forces(&q, &wrenches));
}

#[test]
fn a_jacobian_costs_nothing_for_joints_that_do_not_carry_its_frame() {
    let on_ground = text("peers/kr5") + "\n[[frame]]\nname = \"bench\"\nlink = \"base\"\norigin = { xyz = [1, 2, 3] }";
    let on_first =
        text("peers/kr5") + "\n[[frame]]\nname = \"shoulder\"\nlink = \"link1\"\norigin = { xyz = [0.18, 0, 0] }";
    let count = |text: &str| {
        let operations = operations(&model(text), &Default::default()).expect("no pass changes a value").operations;
        let (_, count) = operations.into_iter().find(|(function, _)| function.name() == "frame_jacobians").unwrap();
        (count.flops(), count.trig)
    };
    assert_eq!(count(&on_ground), (0, 0));
    assert_eq!(count(&on_first), (2, 1));
}

#[test]
fn frames_stay_on_their_links_where_joints_are_locked() {
    redysim! {
        struct Held("models/test/frames.toml", locked = { hand = "20 deg", fore = 0.4 }, functions = [frame_kinematics]);
    }
    let at = |[rail, upper, nut]: [f64; 3], wrist: [f64; 2]| [rail, upper, wrist[0], wrist[1], nut];
    let (q, v) = ([0.3, -0.5, 0.7], [1.1, 0.2, -0.6]);
    let held = Held::frame_kinematics(&q, &v);
    let free = Machine::frame_kinematics(&at(q, [0.4, 20_f64.to_radians()]), &at(v, [0.0; 2]));
    for (held, free) in held.iter().zip(&free) {
        assert_close("rotation", &held.rotation.concat(), &free.rotation.concat(), 1e-15);
        assert_close("origin", &held.origin, &free.origin, 1e-15);
        assert_close("velocity", &held.velocity, &free.velocity, 1e-15);
    }
}

/// The axes take 27 operations: two for each of the arm's, six or nine for those of the wrist. The rest are the columns.
#[test]
fn the_jacobian_of_the_tip_of_kr5_takes_70_operations() {
    let flange = text("peers/kr5") + "\n[[frame]]\nname = \"tip\"\nlink = \"link6\"\norigin = { xyz = [0, 0, 0.158] }";
    let operations = operations(&model(&flange), &Default::default()).expect("no pass changes a value").operations;
    let count = |name: &str| operations.iter().find(|(function, _)| function.name() == name).unwrap().1;
    let jacobian: OperationCount = count("frame_jacobians");
    assert!(jacobian.flops() <= 70 && jacobian.trig == 5, "{jacobian:?}");
}
