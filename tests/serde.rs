//! Models, results, torque laws and trajectories as other programs read and write them.

use redysim::generic::{CodegenOptions, GenericMechanism, Loaded, Model};
use redysim::{
    ClosedLoop, Compensation, ConstrainedMotion, Cycloid, Energy, ForwardDynamics, ForwardSimulation, FrameGains,
    FrameJacobian, FrameState, Frames, Function, Functions, Integrator, Limited, LinkKinematics, LinkState,
    MechanicalEnergy, Motion, Ode4, Ode45, OperationCount, Pid, SetPoint, SimulationState, Solution, Stabilisation,
    TorqueLaw, TrackingPd, Trajectory, ViaPoints, redysim,
};
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::{Value, from_str, from_value, json, to_string, to_value};
use std::fmt::Debug;
use std::path::Path;

redysim! { struct Kr5("models/kr5_tool.toml"); }

/// What another program reads of a value is the value, to the bit: `Debug` has the digits that tell one.
fn kept<T: Serialize + DeserializeOwned + Debug>(value: &T) -> T {
    let text = to_string(value).unwrap();
    let again: T = from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
    assert_eq!(format!("{again:?}"), format!("{value:?}"));
    again
}

fn load(name: &str) -> Loaded {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("models").join(name);
    Model::load(path).unwrap_or_else(|faults| panic!("{faults}"))
}

#[test]
fn every_model_and_its_options_keep_their_bits() {
    for name in ["kr5_drives.toml", "kr5_tool.toml", "gripper.toml", "fourbar.toml", "flyball.toml", "andrews.toml"] {
        let Loaded { model, options, .. } = load(name);
        kept(&model);
        kept(&options);
    }
    let options = CodegenOptions {
        functions: Functions::of([Function::InverseDynamics, Function::FrameJacobians]),
        tolerance: Some(1e-3),
        ..CodegenOptions::default()
    };
    kept(&options);
    assert_eq!(to_value(&options).unwrap()["functions"], json!(["inverse_dynamics", "frame_jacobians"]));
}

#[test]
fn functions_have_their_names() {
    for function in Function::ALL {
        assert_eq!(to_value(function).unwrap(), json!(function.name()));
    }
    let error = from_value::<Functions>(json!(["inverse_dynamic"])).unwrap_err().to_string();
    assert!(error.contains("`inverse_dynamic`"), "{error}");
}

#[test]
fn a_model_is_checked_when_it_is_read() {
    let good = to_value(&load("kr5_drives.toml").model).unwrap();
    let error = |change: fn(&mut Value)| {
        let mut value = good.clone();
        change(&mut value);
        from_value::<Model>(value).expect_err("a fault").to_string()
    };
    let negative = error(|model| model["links"][2]["mass"] = json!(-1.0));
    assert!(negative.contains("link `link3`") && negative.contains("mass"), "{negative}");
    let orphan = error(|model| model["links"][2]["parent"] = json!(17));
    assert!(orphan.contains("`links[17]`"), "{orphan}");
    let skew = error(|model| model["links"][2]["placement"]["rotation"][0][0] = json!(0.5));
    assert!(skew.contains("is not a rotation"), "{skew}");
    let both = error(|model| {
        model["links"][0]["mass"] = json!(-1.0);
        model["links"][1]["physics"]["damping"] = json!(-1.0);
    });
    assert!(both.contains("link `link1`") && both.contains("link `link2`"), "{both}");
    let unknown = error(|model| model["links"][0]["damping"] = json!(0.1));
    assert!(unknown.contains("unknown field `damping`"), "{unknown}");
    let missing = error(|model| _ = model.as_object_mut().unwrap().remove("gravity"));
    assert!(missing.contains("missing field `gravity`"), "{missing}");
}

#[test]
fn results_of_compiled_mechanisms_keep_their_bits() {
    let (q, v) = ([0.1, -0.7, 1.3, 0.2, 0.5, -1.0 / 3.0], [0.3, 0.1, -0.2, 0.6, 1e-300, -0.0]);
    kept::<Energy<f64>>(&Kr5.energy(&q, &v));
    kept::<[LinkState<f64>; 6]>(&Kr5.link_kinematics(&q, &v));
    kept::<[FrameState<f64>; 1]>(&Kr5.frame_kinematics(&q, &v));
    kept::<[FrameJacobian<[f64; 6]>; 1]>(&Kr5.frame_jacobians(&q));
    kept::<OperationCount>(&Kr5::OPS.inverse_dynamics);
    let mut simulation = ForwardSimulation::new(&Kr5, Kr5Hold::law());
    let start = simulation.state(&q, &v);
    let solution: Solution<f64, _> = Ode45::new().integrate(&mut simulation, (0.0, 0.1), start).unwrap();
    let again = kept(&solution);
    assert_eq!(again, solution);
    let parts: SimulationState<f64, [f64; 6], [f64; 6]> = simulation.split(&solution.y);
    assert_eq!(kept(&parts), parts);
}

#[test]
fn results_of_closed_loops_keep_their_bits() {
    let fourbar = GenericMechanism::new(load("fourbar.toml").model);
    let loops = ClosedLoop::new(&fourbar);
    let assembly = loops.assemble(&vec![0.5, -0.5, 0.5], &vec![0.2, 0.0, 0.0], &[0]).unwrap();
    kept(&assembly);
    let motion: ConstrainedMotion<Vec<f64>, Vec<f64>> =
        loops.dynamics(&assembly.q, &assembly.v, &vec![0.1, 0.0, 0.0]).unwrap();
    assert_eq!(kept(&motion), motion);
}

struct Kr5Hold;

impl Kr5Hold {
    fn law() -> TrackingPd<Cycloid<f64, [f64; 6]>, [f64; 6]> {
        let trajectory = Cycloid::new([0.0; 6], [0.3; 6], 2.0).unwrap();
        TrackingPd { trajectory, kp: [400.0; 6], kd: [40.0; 6] }
    }
}

#[test]
fn torque_laws_and_trajectories_ask_for_the_same_forces_after_they_are_read() {
    let (q, v) = ([0.2; 6], [0.1; 6]);
    let mut law = Kr5Hold::law();
    let asked: [f64; 6] = law.torque(&Kr5, 0.7, &q, &v);
    assert_eq!(kept(&law).torque(&Kr5, 0.7, &q, &v), asked);
    let pid = Pid {
        trajectory: Kr5Hold::law().trajectory,
        kp: [1.0; 6],
        ki: [0.1; 6],
        kd: [0.2; 6],
        tracking: [0.3; 6],
        integral: [0.5; 6],
    };
    assert_eq!(kept(&pid), pid);
    let through = ViaPoints::minimum_jerk([0.0, 1.0, 3.0], [[0.0], [0.7], [1.0 / 3.0]]).unwrap();
    let text = to_string(&through).unwrap();
    let again: ViaPoints<f64, [f64; 1], [f64; 3]> = from_str(&text).unwrap();
    let Motion { q, v, a } = through.at(1.9);
    assert_eq!(again.at(1.9), Motion { q, v, a });
    kept(&Stabilisation::Baumgarte { alpha: 20.0 });
    assert_eq!(to_value(Stabilisation::<f64>::Projection).unwrap(), json!("projection"));
    kept(&Compensation::Gravity);
    kept(&FrameGains { linear: [1.0, 2.0, 3.0], angular: [0.1; 3] });
}

type HoldingPid = Pid<SetPoint<[f64; 6], [f64; 6]>, [f64; 6]>;

/// What a program simulates, of parts that serialise.
#[derive(serde::Serialize, serde::Deserialize)]
struct Scenario<I> {
    integrator: I,
    law: Limited<HoldingPid, [f64; 6]>,
    start: [[f64; 6]; 2],
    end: f64,
}

impl<I: Integrator<f64>> Scenario<I> {
    fn run(&self) -> Solution<f64, Vec<f64>> {
        let [q, v] = &self.start;
        let mut simulation = ForwardSimulation::new(&Kr5, self.law);
        let start = simulation.extended_state(q, v);
        self.integrator.integrate(&mut simulation, (0.0, self.end), start).unwrap()
    }
}

#[test]
fn a_scenario_of_a_program_ends_in_the_same_bits_after_it_is_read() {
    fn check<I: Integrator<f64> + Serialize + DeserializeOwned>(integrator: I) {
        let trajectory = SetPoint::new(&Kr5, [0.1, -0.2, 0.3, 0.4, 0.5, 0.6]);
        let [kp, ki, kd, tracking, integral] = [400.0, 60.0, 40.0, 1.2, 0.0].map(|gain| [gain; 6]);
        let law = Limited { law: Pid { trajectory, kp, ki, kd, tracking, integral }, limits: [30.0; 6] };
        let scenario = Scenario { integrator, law, start: [[0.0; 6], [0.1; 6]], end: 0.2 };
        let again: Scenario<I> = from_str(&to_string(&scenario).unwrap()).unwrap();
        let [expected, found] = [scenario.run(), again.run()];
        assert!(expected.statistics.steps > 3);
        assert_eq!(found, expected);
        kept(&found);
    }
    check(Ode45::new().rtol(1e-7).atol(1e-9).max_step(0.01));
    check(Ode4::new(0.004));
}

#[test]
fn tolerances_of_each_component_are_written_but_borrowed_and_cannot_be_read() {
    let each = to_string(&Ode45::new().atol_each(&[1e-6, 1e-9])).unwrap();
    assert!(each.contains(r#"{"each":[1e-6,1e-9]}"#), "{each}");
    assert!(from_str::<Ode45<'static, f64>>(&each).unwrap_err().to_string().contains("`each`"));
}

#[test]
fn a_trajectory_that_could_not_be_made_cannot_be_read() {
    let cycloid = json!({ "from": [0.0], "to": [1.0], "duration": -1.0 });
    let error = from_value::<Cycloid<f64, [f64; 1]>>(cycloid).unwrap_err().to_string();
    assert!(error.contains("duration"), "{error}");
    let rest = json!({ "q": [0.0], "v": [0.0], "a": [0.0] });
    let backward = json!({ "times": [1.0, 0.0], "points": [rest, rest] });
    assert!(from_value::<ViaPoints<f64, [f64; 1], [f64; 2]>>(backward).is_err());
}

#[test]
fn an_example_of_a_model_as_json_is_readable() {
    let model: Model = from_str(
        r#"{
            "name": "pendulum", "gravity": [0.0, 0.0, -9.81],
            "links": [{
                "name": "rod", "joint_name": "pivot", "parent": null, "joint": "revolute",
                "placement": { "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "position": [0, 0, 0] },
                "axis": [0, 2, 0], "offset": 0, "pitch": 0,
                "frame": { "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "position": [0, 0, 0] },
                "mass": 1.0, "com": [0.5, 0, 0], "actuated": true, "range": null,
                "inertia": { "xx": 0, "yy": 0, "zz": 0, "xy": 0, "yz": 0, "xz": 0 },
                "physics": { "armature": 0, "damping": 0, "friction": 0, "friction_velocity": 0.01, "stiffness": 0, "rest": 0 }
            }]
        }"#,
    )
    .unwrap();
    assert_eq!(model.links[0].axis.0, [0.0, 1.0, 0.0]);
    let pendulum = GenericMechanism::new(model);
    let a: Vec<f64> = pendulum.forward_dynamics(&vec![0.0], &vec![0.0], &vec![0.0]);
    assert!((a[0] - 9.81 / 0.5).abs() < 1e-12);
}
