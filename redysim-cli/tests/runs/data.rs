//! Scenarios as data: what is written reads back, to the bit, and bad data have the faults of files.

use std::fs;
use std::path::Path;

use crate::common::{names, root, scratch, succeed};
use redysim_cli::{
    AbsoluteTolerance, AxisGains, Compensation, Dynamics, FixedStep, Forward, Impedance, Initial, Integrator, Limits,
    Payload, Results, Scenario, Span, Stabilisation, Target, Through, Tolerances, Torque, Trajectory, Values,
};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// What another program reads of a value is the value.
fn kept<T: Serialize + DeserializeOwned + PartialEq + std::fmt::Debug>(value: &T) {
    let text = serde_json::to_string(value).unwrap();
    let again: T = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
    same(&again, value, &text);
}

/// Equal, with zeros of the same sign: `Debug` has the digits and signs that tell one number from another.
fn same<T: PartialEq + std::fmt::Debug>(found: &T, expected: &T, text: &str) {
    assert_eq!(found, expected, "{text}");
    assert_eq!(format!("{found:?}"), format!("{expected:?}"), "{text}");
}

fn models() -> String {
    root().join("models").display().to_string()
}

/// The text of a scenario reads back to it; so does what another program keeps of it.
fn reads_back(scenario: &Scenario) {
    let text = scenario.to_toml();
    let again = Scenario::from_toml(&*text, format!("{}/trial.toml", models()));
    same(&again.unwrap_or_else(|fault| panic!("{fault}\n{text}")), scenario, &text);
    kept(scenario);
}

/// Numbers whose shortest decimals are long.
struct Digits(u64);

impl Digits {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        0.1 + (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn each(&mut self, count: usize) -> Values {
        (0..count).map(|_| self.next()).collect::<Vec<_>>().into()
    }

    fn named(&mut self, joint: &str) -> Values {
        Values::Named([(joint.to_owned(), self.next())].into())
    }
}

fn two_link(forward: Forward) -> Scenario {
    Scenario { name: Some("trial".into()), forward: Some(forward), ..Scenario::new("two_link.toml") }
}

#[test]
fn every_shipped_scenario_reads_back_and_runs_to_the_same_bits() {
    let folder = scratch("data-shipped");
    let mut runs = 0;
    for name in names(&root().join("scenarios")).iter().filter(|name| name.ends_with(".toml")) {
        let shipped = root().join("scenarios").join(name);
        let read = Scenario::load(&shipped).unwrap_or_else(|fault| panic!("{fault}"));
        assert_eq!(Scenario::from_toml(read.to_toml(), &shipped).unwrap(), read, "{name}");
        kept(&read);
        // Runs that take no time; unoptimised, two of them.
        let short = ["rp.toml", "fourbar.toml", "kuka.toml", "three_rrr_circle.toml", "flyball.toml"];
        let count = if cfg!(debug_assertions) { 2 } else { short.len() };
        if !short[..count].contains(&name.as_str()) {
            continue;
        }
        let absolute = |path: &str| root().join("scenarios").join(path).display().to_string();
        let mut written = Scenario { model: absolute(&read.model), ..read.clone() };
        if let Some(Trajectory::Csv { file, .. }) = &mut written.trajectory {
            *file = absolute(file);
        }
        fs::write(folder.join(name), written.to_toml()).unwrap();
        let of = |given: bool, run: &str| given.then(|| run.to_owned());
        for command in [of(read.inverse.is_some(), "inverse"), of(read.forward.is_some(), "forward")].iter().flatten() {
            let [first, second] = [&shipped.display().to_string(), name].map(|path| {
                let out = format!("{command}-{}", Path::new(path).is_absolute());
                succeed(&folder, &[command, path, "-o", &out, "--force"]);
                Results::load(folder.join(out)).unwrap_or_else(|fault| panic!("{fault}"))
            });
            assert_eq!(first.tables, second.tables, "{name}");
            runs += 1;
        }
    }
    assert!(runs >= if cfg!(debug_assertions) { 3 } else { 7 }, "{runs} runs");
}

#[test]
fn short_forms_of_a_file_are_read_as_what_they_stand_for() {
    let text = "model = 'two_link.toml'\ninitial = { q = { joint2 = '90 deg' }, v = ['180 deg/s', 1] }\n\
                [trajectory]\nfrom = [0, 0]\nto = ['45 deg', '0.5 rad']\nduration = 2\n\
                [forward]\nend = 1\nstep = 0.5\nintegrator = 1\ntorque = 'free'\nstabilisation = 'none'\n\
                [run]\nredysim = '0.1.0'\n";
    let path = format!("{}/short.toml", models());
    let read = Scenario::from_toml(text, &path).unwrap();
    let pi = std::f64::consts::PI;
    assert_eq!(
        read,
        Scenario {
            name: Some("short".into()),
            initial: Some(Initial {
                q: Some(Values::Named([("joint2".to_owned(), pi / 2.0)].into())),
                v: Some([pi, 1.0].into()),
                ..Initial::default()
            }),
            trajectory: Some(Trajectory::Cycloid {
                joints: None,
                from: [0.0, 0.0].into(),
                to: [pi / 4.0, 0.5].into(),
                duration: 2.0
            }),
            forward: Some(Forward {
                integrator: Some(Integrator::Ode15s(Tolerances::default())),
                torque: Some(Torque::Free),
                stabilisation: Some(Stabilisation::None),
                ..Forward::new(1.0, 0.5)
            }),
            ..Scenario::new("two_link.toml")
        }
    );
    let usual = |forward: &str| {
        let text = format!("model = 'two_link.toml'\n[forward]\nend = 1\nstep = 0.5\n{forward}\n");
        Scenario::from_toml(text, &path).unwrap_or_else(|fault| panic!("{fault}")).forward.unwrap()
    };
    let tolerances = Tolerances { rtol: Some(1e-6), ..Tolerances::default() };
    assert_eq!(usual("integrator = { rtol = 1e-6 }").integrator, Some(Integrator::Ode45(tolerances)));
    let euler = usual("integrator = { method = 'Euler', step = 0.01 }").integrator;
    assert_eq!(euler, Some(Integrator::SemiImplicitEuler(FixedStep { step: 0.01 })));
    assert_eq!(
        usual("integrator = { method = 2, step = 1 }").integrator,
        Some(Integrator::Ode5(FixedStep { step: 1.0 }))
    );
    assert_eq!(usual("torque = {}").torque, Some(Torque::Free));
    assert_eq!(usual("stabilisation = {}").stabilisation, Some(Stabilisation::Projection));
    assert_eq!(usual(""), Forward::new(1.0, 0.5));
}

#[test]
fn every_trajectory_reads_back_to_the_same_bits() {
    let mut digits = Digits(1);
    let joints = || Some(vec!["joint2".to_owned(), "joint1".to_owned()]);
    let file = scratch_file("data-trajectories", "motion.csv", "t [s],q joint1 [rad],q joint2 [rad]\n0,0,0\n9,1,1\n");
    let times = vec![0.0, digits.next(), 3.0 + digits.next()];
    let points = vec![digits.each(2), digits.named("joint1"), digits.each(2)];
    for trajectory in [
        Trajectory::Cycloid { joints: None, from: digits.each(2), to: digits.named("joint2"), duration: digits.next() },
        Trajectory::ConstantSpeed { joints: joints(), from: digits.each(2), speed: digits.each(2) },
        Trajectory::MinimumJerk { joints: joints(), times: times.clone(), points: points.clone() },
        Trajectory::Cubic { joints: None, times, points },
        Trajectory::Csv { joints: None, file: file.clone(), through: Some(Through::Cubic) },
        Trajectory::Csv { joints: joints(), file, through: Some(Through::MinimumJerk) },
    ] {
        let inverse = Some(Span { start: Some(digits.next()), end: 2.0 + digits.next(), step: digits.next() });
        let initial = Initial { q: Some(digits.each(2)), v: Some(digits.named("joint1")), ..Initial::default() };
        let trial = two_link(Forward::new(2.0, digits.next()));
        reads_back(&Scenario { trajectory: Some(trajectory), inverse, initial: Some(initial), ..trial });
    }
}

/// A file in a scratch folder, by its path.
fn scratch_file(folder: &str, name: &str, text: &str) -> String {
    let path = scratch(folder).join(name);
    fs::write(&path, text).unwrap();
    path.display().to_string()
}

#[test]
fn every_integrator_reads_back_to_the_same_bits() {
    let mut digits = Digits(2);
    let step = FixedStep { step: 0.1 * digits.next() };
    let adaptive = |atol| Tolerances { rtol: Some(1e-3 / 7.0), atol, max_step: Some(1.0 / 3.0) };
    let each = AbsoluteTolerance::Each { position: Some(1e-9 / 3.0), velocity: None, work: Some(0.1 + 0.2) };
    for integrator in [
        Integrator::SemiImplicitEuler(step),
        Integrator::Ode4(step),
        Integrator::Ode5(step),
        Integrator::Dop8(step),
        Integrator::Gauss4(step),
        Integrator::Gauss6(step),
        Integrator::Ode45(Tolerances::default()),
        Integrator::Dop853(adaptive(Some(AbsoluteTolerance::Uniform(1e-100)))),
        Integrator::Ode15s(adaptive(Some(each))),
        Integrator::Radau5(adaptive(None)),
    ] {
        reads_back(&two_link(Forward { integrator: Some(integrator), ..Forward::new(2.0, 0.5) }));
    }
}

#[test]
fn every_law_reads_back_to_the_same_bits() {
    let mut digits = Digits(3);
    let file = scratch_file("data-laws", "forces.csv", "t [s],tau joint1 [N m],tau joint2 [N m]\n0,0,0\n9,1,-1\n");
    let joints = || Some(vec!["joint2".to_owned()]);
    let payload = Payload { link: "link2".into(), mass: digits.next(), com: Some([digits.next(), 0.0, -0.0]) };
    let limits = || Some(Limits::Values(Values::Uniform(f64::INFINITY)));
    let (kp, ki, kd) = (digits.each(2), digits.named("joint1"), Values::Uniform(digits.next()));
    let target = digits.each(2);
    let trajectory = Trajectory::Cycloid { joints: None, from: digits.each(2), to: digits.each(2), duration: 1.0 };
    for torque in [
        Torque::Free,
        Torque::P { joints: joints(), target: [0.1 + 0.2].into(), kp: 7.0.into(), limits: None },
        Torque::Pd { joints: None, target: target.clone(), kp: kp.clone(), kd: kd.clone(), limits: None },
        Torque::Pid {
            joints: None,
            target: target.clone(),
            kp: kp.clone(),
            ki,
            kd: kd.clone(),
            tracking_rate: Some(digits.each(2)),
            limits: Some(Limits::Values(digits.named("joint2"))),
        },
        Torque::PdGravity {
            joints: None,
            target,
            kp: kp.clone(),
            kd: kd.clone(),
            payload: Some(payload),
            limits: Some(Limits::Values(digits.each(2))),
        },
        Torque::TrackingPd { joints: joints(), kp: [1.0 / 3.0].into(), kd: [2.0 / 3.0].into(), limits: None },
        Torque::ComputedTorque { kp, kd, limits: Some(Limits::Values(Values::Uniform(digits.next()))) },
        Torque::Csv { joints: None, file, limits: None },
    ] {
        let trial = two_link(Forward { torque: Some(torque), ..Forward::new(2.0, 0.5) });
        reads_back(&Scenario { trajectory: Some(trajectory.clone()), ..trial });
    }
    // TOML has no infinite limits in a scenario: leaving a joint out is to have none.
    let endless = two_link(Forward {
        torque: Some(Torque::P { joints: None, target: [0.0; 2].into(), kp: 1.0.into(), limits: limits() }),
        ..Forward::new(2.0, 0.5)
    });
    let fault = endless.check(models()).unwrap_err().to_string();
    assert!(fault.contains("`forward.torque.limits`") && fault.contains("inf"), "{fault}");
}

#[test]
fn an_impedance_and_the_limits_of_a_range_read_back_to_the_same_bits() {
    let mut digits = Digits(4);
    let impedance = Impedance {
        joints: None,
        frame: "tip".into(),
        target: Some(Target { xyz: Some([digits.next(); 3]), rpy: Some([digits.next(), 0.0, 1.0 / 3.0]) }),
        stiffness: AxisGains::Each([digits.next(), digits.next(), 900.0]),
        angular_stiffness: Some(AxisGains::Uniform(digits.next())),
        damping: AxisGains::Uniform(digits.next()),
        angular_damping: None,
        compensation: Some(Compensation::Bias),
        null_space_damping: Some(digits.next()),
        payload: None,
        limits: None,
    };
    let of = |model: &str, torque| Scenario {
        name: Some("trial".into()),
        forward: Some(Forward { torque: Some(torque), ..Forward::new(0.5, 0.25) }),
        ..Scenario::new(model)
    };
    let frame = redysim_model::Model::load(format!("{}/kr5_tool.toml", models())).unwrap().model.frames[0].name.clone();
    let impedance = Impedance { frame, ..impedance };
    reads_back(&of("kr5_tool.toml", Torque::Impedance(Box::new(impedance.clone()))));
    let least =
        Impedance { target: Some(Target::default()), compensation: None, null_space_damping: None, ..impedance };
    reads_back(&of("kr5_tool.toml", Torque::Impedance(Box::new(least))));

    let model = "name = 'arm'\ngravity = [0, 0, -9.81]\n[[link]]\nname = 'upper'\nparent = 'base'\njoint = 'revolute'\n\
                 dh = { a = 0, alpha = 0, b = 0, theta = 0 }\nmass = 1.0\ncom = [0.5, 0, 0]\n\
                 range = { position = [-3, 3], velocity = 9, acceleration = 9, force = 4.0 }\n";
    let path = scratch_file("data-range", "arm.toml", model);
    let torque = Torque::P { joints: None, target: [1.0].into(), kp: 2.0.into(), limits: Some(Limits::Range) };
    reads_back(&of(&path, torque));
}

#[test]
fn settings_of_closed_loops_read_back_to_the_same_bits() {
    let mut digits = Digits(5);
    for stabilisation in
        [Stabilisation::Projection, Stabilisation::None, Stabilisation::Baumgarte { alpha: digits.next() }]
    {
        let initial = Initial {
            q: Some([0.0, 0.9844, 4.3144].into()),
            assemble: Some(true),
            held: Some(vec!["crank".into()]),
            ..Initial::default()
        };
        let forward = Forward { stabilisation: Some(stabilisation), ..Forward::new(0.5, 0.25) };
        reads_back(&Scenario {
            name: Some("trial".into()),
            initial: Some(initial),
            forward: Some(forward),
            ..Scenario::new("fourbar.toml")
        });
    }
}

#[test]
fn a_scenario_built_in_rust_has_the_faults_of_files() {
    let swing = two_link(Forward::new(1.0, 0.1));
    assert_eq!(swing.check(models()).unwrap(), [""; 0]);
    let p = |joints: Option<Vec<String>>, target: Values| Torque::P { joints, target, kp: 1.0.into(), limits: None };
    let driven = |torque| two_link(Forward { torque: Some(torque), ..Forward::new(1.0, 0.1) });
    let started = |initial| Scenario { initial: Some(initial), ..swing.clone() };
    for (scenario, fault) in [
        (Scenario { model: "nowhere.toml".into(), ..swing.clone() }, "cannot read the model file"),
        (
            Scenario { name: Some("a/b".into()), ..swing.clone() },
            "`name` is `a/b`, which cannot be the name of a folder",
        ),
        (
            started(Initial { q: Some([0.0].into()), ..Initial::default() }),
            "`initial.q` must have 2 values, one for each",
        ),
        (started(Initial { q: Some(1.0.into()), ..Initial::default() }), "an array with a value for each joint"),
        (started(Initial { v: Some([f64::NAN, 0.0].into()), ..Initial::default() }), "`initial.v[0]`"),
        (two_link(Forward::new(0.0, 0.1)), "the run must end after its start"),
        (two_link(Forward::new(f64::INFINITY, 0.1)), "`forward.end`"),
        (driven(p(Some(vec!["elbow".into()]), [0.0].into())), "`elbow`"),
        (driven(p(None, Values::Named([("joint3".to_owned(), 1.0)].into()))), "`joint3`"),
        (
            driven(Torque::TrackingPd { joints: None, kp: 1.0.into(), kd: 1.0.into(), limits: None }),
            "follows a trajectory",
        ),
    ] {
        let failure = scenario.check(models()).expect_err(fault);
        let shown = failure.to_string();
        assert!(shown.contains(fault), "{fault}: {shown}");
        assert!(shown.contains("help: "), "{shown}");
        // The same text as a file has the same faults.
        let text = scenario.to_toml();
        let of_file = Scenario::from_toml(text, format!("{}/trial.toml", models())).unwrap_err();
        let titles =
            |shown: &str| shown.lines().filter(|line| line.starts_with("error")).map(str::to_owned).collect::<Vec<_>>();
        assert_eq!(titles(&shown), titles(&of_file.to_string()));
        assert!(!titles(&shown).is_empty(), "{shown}");
    }
    let quick = Initial { q: Some([0.0, 90.0].into()), ..Initial::default() };
    let warnings = started(quick).check(models()).unwrap();
    assert!(warnings.len() == 1 && warnings[0].contains("`initial.q[1]`"), "{warnings:?}");
    let both = Scenario { inverse: Some(Span { start: None, end: 1.0, step: -1.0 }), ..swing.clone() };
    assert!(both.check(models()).unwrap_err().to_string().contains("`inverse.step`"));
    let missing = Scenario::load("nowhere.toml").unwrap_err();
    assert!(missing.message().contains("cannot read nowhere.toml"), "{missing}");
    let first = scratch("data-load-for").join("first.toml");
    let rest = "inverse = { end = 1, step = 0.1 }\ntrajectory = { from = [0, 0], to = [1, 1], duration = 1 }\n\
                forward = { end = 1, step = 0.1, torque = { law = 'csv', file = 'not-yet.csv' } }\n";
    fs::write(&first, format!("model = '{}/two_link.toml'\n{rest}", models())).unwrap();
    let fault = Scenario::load(&first).unwrap_err().to_string();
    assert!(fault.contains("not-yet.csv"), "{fault}");
    let inverse = Scenario::load_for(&first, Dynamics::Inverse).unwrap();
    assert!(inverse.inverse.is_some() && inverse.forward.is_none());
}

#[test]
fn what_another_program_has_misspelt_is_reported() {
    fn fault<T: DeserializeOwned + std::fmt::Debug>(json: &str) -> String {
        serde_json::from_str::<T>(json).expect_err(json).to_string()
    }
    for (fault, parts) in [
        (fault::<Tolerances>(r#"{ "atol": { "positon": 1e-9 } }"#), ["a number", "position, velocity and work"]),
        (fault::<Torque>(r#"{ "law": "free", "kp": 49 }"#), ["`kp`", "unknown field"]),
        (fault::<Torque>(r#"{ "law": "pdd" }"#), ["`pdd`", "`pd-gravity`"]),
        (fault::<Stabilisation>(r#"{ "kind": "none", "alpha": 20 }"#), ["`alpha`", "unknown field"]),
        (fault::<Initial>(r#"{ "q": ["60 deg", 0] }"#), ["an array of numbers", "angles are in rad"]),
        (fault::<AxisGains>("[1, 2]"), ["a number", "an array of 3 numbers"]),
    ] {
        assert!(parts.iter().all(|part| fault.contains(part)), "{fault}");
    }
    assert_eq!(serde_json::from_str::<Torque>(r#"{ "law": "free" }"#).unwrap(), Torque::Free);
    let unknown =
        serde_json::from_str::<Scenario>("{ \"model\": \"a.toml\", \"intial\": {} }").unwrap_err().to_string();
    assert!(unknown.contains("`intial`") && unknown.contains("`initial`"), "{unknown}");
}
