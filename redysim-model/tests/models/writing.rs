//! Models that are written as text, and models that are built in Rust.

use proptest::prelude::*;
use redysim_model::joint::JointPhysics;
use redysim_model::rotation::roll_pitch_yaw;
use redysim_model::spatial::{Mat3, Pose, Vec3};
use redysim_model::{
    AccelerationMethod, CodegenOptions, CutKind, CutSide, Frame, Function, Functions, Inertia, JointKind, Link,
    LinkPoint, Loaded, Loop, Model, PublicInterface, Spring,
};
use std::path::{Path, PathBuf};

const DOWN: Vec3<f64> = Vec3([0.0, 0.0, -9.81]);

fn read(text: &str) -> Model {
    Model::from_toml(text, "test.toml").unwrap_or_else(|faults| panic!("{faults}\n{text}")).model
}

/// The model with every number in the digits that tell its bits, and -0.0 with its sign.
fn bits(model: &Model) -> String {
    format!("{model:?}")
}

fn models_in(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models").join(folder);
    let files = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    files.filter(|path| path.extension().is_some_and(|extension| extension == "toml")).collect()
}

#[test]
fn every_shipped_model_is_written_as_text_that_reads_back_to_the_same_bits_and_options() {
    let paths = ["", "test", "peers", "warn"].map(models_in).concat();
    assert!(paths.len() > 40, "{}", paths.len());
    for path in paths {
        let Loaded { model, options, .. } = Model::load(&path).unwrap_or_else(|faults| panic!("{faults}"));
        let (text, beside) = (model.to_toml(), options.to_toml(&model));
        let again = Model::from_toml_with(text.as_str(), "again.toml", beside.as_str());
        let again = again.unwrap_or_else(|faults| panic!("{}: {faults}", path.display()));
        assert_eq!(bits(&again.model), bits(&model), "{}", path.display());
        // Those that the model has.
        let of_model = |options: &CodegenOptions| -> Vec<_> {
            let functions = PublicInterface::new(&model, options).functions;
            functions.with_loops(model.loops.len()).iter().collect()
        };
        assert_eq!(of_model(&again.options), of_model(&options), "{}", path.display());
        let others = |options: CodegenOptions| CodegenOptions { functions: Functions::ALL, ..options };
        assert_eq!(others(again.options), others(options), "{}", path.display());
        assert_eq!(again.model.to_toml(), text, "{}", path.display());
    }
}

#[test]
fn a_model_with_locked_joints_is_written_with_these_fixed() {
    let kr5 = Model::load(Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/kr5.toml")).unwrap().model;
    let locked = kr5.locked(&[("joint3", 0.7), ("joint5", -1.234)]).unwrap();
    assert_eq!(bits(&read(&locked.to_toml())), bits(&locked));
}

#[test]
fn names_of_any_characters_are_written() {
    let mut model = pendulum();
    model.name = "a \"b\" \\ c".into();
    model.links[0].name = "Gelenk #1 = [ü]\u{1f916}".into();
    model.links[0].joint_name = "'joint'".into();
    let again = model.check().unwrap_or_else(|faults| panic!("{faults}")).model;
    assert_eq!(bits(&again), bits(&model));
}

fn pose() -> impl Strategy<Value = [f64; 6]> {
    proptest::array::uniform6(-7.0..7.0)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(debug_assertions) { 32 } else { 256 }))]
    #[test]
    fn joints_placed_in_any_way_are_written_with_the_bits_that_they_were_read_with(
        dh in pose(), standard in pose(), origin in pose(), axis in proptest::array::uniform3(-1.0..1.0), point in pose()
    ) {
        prop_assume!(axis.iter().any(|x: &f64| x.abs() > 1e-3));
        let [a, alpha, b, theta, pitch, _] = dh;
        let [x, y, z, roll, pitch_angle, yaw] = origin;
        let placed = [
            format!("joint = 'revolute'\ndh = {{ a = {a:?}, alpha = {alpha:?}, b = {b:?}, theta = {theta:?} }}"),
            format!("joint = 'helical'\npitch = {pitch:?}\ndh = {{ a = {a:?}, alpha = {alpha:?}, b = {b:?}, theta = {theta:?} }}"),
            format!(
                "joint = 'prismatic'\ndh_standard = {{ a = {:?}, alpha = {:?}, d = {:?}, theta = {:?} }}",
                standard[0], standard[1], standard[2], standard[3]
            ),
            format!(
                "joint = 'revolute'\norigin = {{ xyz = [{x:?}, {y:?}, {z:?}], rpy = [{roll:?}, {pitch_angle:?}, {yaw:?}] }}\naxis = {axis:?}"
            ),
            format!("joint = 'fixed'\ndh_standard = {{ a = {a:?}, alpha = {alpha:?}, d = {b:?}, theta = {theta:?} }}"),
        ];
        let links: String = placed.iter().enumerate().map(|(i, placed)| {
            let parent = if i == 0 { "base".into() } else { format!("l{}", i - 1) };
            format!("[[link]]\nname = 'l{i}'\nparent = '{parent}'\n{placed}\nmass = 1.0\ncom = {:?}\n", &point[..3])
        }).collect();
        let cut = format!(
            "[[loop]]\nname = 'cut'\njoint = 'revolute'\nlink_a = 'base'\nlink_b = 'l4'\naxis_a = {axis:?}\naxis_b = {:?}\n",
            &[point[3], point[4], 1.0]
        );
        let frame = format!("[[frame]]\nname = 'tip'\nlink = 'l2'\norigin = {{ rpy = {:?} }}\n", &origin[3..]);
        let model = read(&format!("name = 'test'\ngravity = {:?}\nallow = ['angle-units']\n{links}{cut}{frame}", &standard[3..]));
        prop_assert_eq!(bits(&read(&model.to_toml())), bits(&model));
    }
}

fn pendulum() -> Model {
    let mut pendulum = Model::new("pendulum", DOWN);
    let rod = Link::new("rod", None, JointKind::Revolute);
    let (axis, com) = (Vec3([0.0, 1.0, 0.0]), Vec3([0.5, 0.0, 0.0]));
    pendulum.links.push(Link { axis, com, mass: 1.0, ..rod });
    pendulum
}

#[test]
fn a_model_built_in_rust_is_the_model_of_its_file() {
    let file = "name = 'crane'\ngravity = [0.0, 0.0, -9.81]\n\
        [[link]]\nname = 'boom'\njoint_name = 'luff'\nparent = 'base'\njoint = 'revolute'\n\
        origin = { xyz = [0, 0, 1], rpy = [0.1, 0, 0] }\naxis = [0, 0.6, 0.8]\nmass = 20.0\ncom = [1, 0, 0]\n\
        inertia = { xx = 0.5, yy = 7.0, zz = 7.0 }\narmature = 0.2\nfriction = 1.5\nfriction_velocity = 0.05\n\
        [[link]]\nname = 'jib'\nparent = 'boom'\njoint = 'prismatic'\naxis = [1, 0, 0]\noffset = 0.25\n\
        far_end = { xyz = [0.5, 0, 0] }\nmass = 5.0\nactuated = false\n\
        [[frame]]\nname = 'hook'\nlink = 'jib'\norigin = { xyz = [0.1, 0, 0] }\n\
        [[spring]]\nlink_a = 'base'\npoint_a = [0, 0, 2]\nlink_b = 'jib'\nstiffness = 300.0\nlength = 1.5\n";
    let boom = Link {
        joint_name: "luff".into(),
        placement: Pose { rotation: roll_pitch_yaw([0.1, 0.0, 0.0]), position: Vec3([0.0, 0.0, 1.0]) },
        axis: Vec3([0.0, 0.6, 0.8]),
        mass: 20.0,
        com: Vec3([1.0, 0.0, 0.0]),
        inertia: Inertia { xx: 0.5, yy: 7.0, zz: 7.0, ..Inertia::default() },
        physics: JointPhysics {
            armature: 0.2.into(),
            friction: 1.5.into(),
            friction_velocity: 0.05.into(),
            ..JointPhysics::default()
        },
        ..Link::new("boom", None, JointKind::Revolute)
    };
    let jib = Link {
        axis: Vec3([1.0, 0.0, 0.0]),
        offset: 0.25,
        frame: Pose { position: Vec3([0.5, 0.0, 0.0]), ..Pose::identity() },
        mass: 5.0,
        actuated: false.into(),
        ..Link::new("jib", Some(0), JointKind::Prismatic)
    };
    let hook = Pose { position: Vec3([0.1, 0.0, 0.0]), ..Pose::identity() };
    let built = Model {
        links: vec![boom, jib],
        frames: vec![Frame { name: "hook".into(), link: Some(1), placement: hook }],
        springs: vec![Spring {
            name: None,
            a: LinkPoint { link: None, point: Vec3([0.0, 0.0, 2.0]) },
            b: LinkPoint { link: Some(1), point: Vec3::zero() },
            stiffness: 300.0,
            damping: 0.0,
            length: 1.5,
        }],
        ..Model::new("crane", DOWN)
    };
    assert_eq!(read(file), built);
    let checked = built.check().unwrap_or_else(|faults| panic!("{faults}"));
    assert_eq!(checked.model, built);
    let without_joint_name =
        Model { links: vec![Link { joint_name: String::new(), ..pendulum().links.remove(0) }], ..pendulum() };
    assert_eq!(without_joint_name.check().unwrap().model.links[0].joint_name, "rod");
}

#[test]
fn settings_of_friction_and_springs_that_do_not_act_are_kept() {
    let mut model = pendulum();
    model.links[0].physics =
        JointPhysics { friction_velocity: 0.05.into(), rest: vec![0.3], ..JointPhysics::default() };
    assert_eq!(bits(&model.check().unwrap_or_else(|faults| panic!("{faults}")).model), bits(&model));
}

#[test]
fn springs_and_dampers_of_any_numbers_are_kept() {
    for (stiffness, damping, length) in
        [(3.0, 0.0, 0.2), (0.0, 5.0, 0.0), (0.0, 5.0, 0.3), (0.0, 0.0, 0.3), (2.0, 1.0, 0.0)]
    {
        let end = |link, z| LinkPoint { link, point: Vec3([0.1, 0.0, z]) };
        let spring = Spring { name: None, a: end(None, 1.0), b: end(Some(0), 0.0), stiffness, damping, length };
        let model = Model { springs: vec![spring], ..pendulum() };
        assert_eq!(bits(&model.check().unwrap_or_else(|faults| panic!("{faults}")).model), bits(&model));
    }
}

/// A model with a fault, and what its message shows.
fn faulty(change: impl FnOnce(&mut Model), title: &str) {
    let mut model = pendulum();
    change(&mut model);
    let faults = model.check().expect_err(title);
    assert!(faults.errors().any(|fault| fault.title().contains(title)), "{title}:\n{faults}");
    assert!(faults.errors().all(|fault| fault.position().is_some()), "{faults}");
}

#[test]
fn a_fault_of_a_model_built_in_rust_is_that_of_its_file() {
    faulty(|model| model.links[0].mass = -1.0, "mass");
    faulty(|model| model.gravity.0[1] = f64::NAN, "gravity");
    faulty(|model| model.gravity.0[1] = f64::INFINITY, "gravity");
    faulty(|model| model.links[0].parent = Some(7), "`links[7]`");
    faulty(|model| model.links[0].parent = Some(0), "`rod`");
    faulty(|model| model.links.push(Link::new("rod", Some(0), JointKind::Fixed)), "`rod`");
    faulty(|model| model.links[0].name.clear(), "name");
    faulty(|model| model.links[0].axis = Vec3::zero(), "axis");
    faulty(|model| model.links[0].pitch = 0.1, "pitch");
    faulty(|model| model.links[0].physics.damping = (-0.1).into(), "damping");
    faulty(
        |model| model.links[0].placement.rotation.0[0][1] = 1e-3,
        "is not a rotation: an element of R Rᵀ is off by 1.0e-3",
    );
    faulty(|model| model.links[0].placement.rotation.0[2][2] = -1.0, "is a reflection: its determinant is -1");
    faulty(|model| model.links[0].placement.rotation.0[2][2] = 1e20, "is not a rotation");
    faulty(|model| model.links.clear(), "no link");
    let side = |link| CutSide { link, point: Vec3::zero(), axis: Vec3([0.0, 0.0, 1.0]) };
    let cut = |a, b| Loop { name: "cut".into(), joint: CutKind::Spherical, a: side(a), b: side(b) };
    faulty(|model| model.loops.push(cut(None, Some(3))), "`links[3]`");
    faulty(|model| model.loops.push(cut(Some(0), Some(0))), "cut");
}

#[test]
fn options_are_written_with_the_names_of_the_model() {
    let file = "name = 'arm'\ngravity = [0, 0, -9.81]\nfunctions = ['inverse_dynamics', 'energy']\n\
        forward_dynamics = 'recursion'\nparameters = ['gravity', 'rod.com', 'elbow.damping']\n\
        [[link]]\nname = 'rod'\njoint_name = 'elbow'\nparent = 'base'\njoint = 'revolute'\naxis = [0, 1, 0]\nmass = 1\ncom = [1, 0, 0]\n";
    let Loaded { model, options, .. } = Model::from_toml(file, "arm.toml").unwrap();
    assert_eq!(options.functions, Functions::of([Function::InverseDynamics, Function::Energy]));
    assert_eq!(options.forward_dynamics, AccelerationMethod::Recursion);
    let text = options.to_toml(&model);
    assert!(text.contains("parameters = [\"gravity\", \"rod.com\", \"elbow.damping\"]"), "{text}");
    assert_eq!(Model::from_toml_with(model.to_toml(), "again.toml", text.clone()).unwrap().options, options);
    assert_eq!(Model::from_toml(text + &model.to_toml(), "again.toml").unwrap().options, options);
    assert_eq!(CodegenOptions::default().to_toml(&model), "");
}

#[test]
fn a_rotation_matrix_places_a_joint_as_its_angles_do() {
    let link = |origin: &str| {
        read(&format!(
            "name = 'arm'\ngravity = [0, 0, -9.81]\n[[link]]\nname = 'rod'\nparent = 'base'\njoint = 'revolute'\n\
             origin = {{ {origin} }}\naxis = [0, 1, 0]\nmass = 1\ncom = [1, 0, 0]\n"
        ))
    };
    let Mat3(rows) = roll_pitch_yaw([0.3, -1.1, 2.0]);
    assert_eq!(link(&format!("rotation = {rows:?}")), link("rpy = [0.3, -1.1, 2.0]"));
}
