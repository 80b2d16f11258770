//! `redysim import`: the model describes the mechanism of the URDF, and everything left out is reported.

mod bases;
mod faults;
mod findings;
mod fusing;
mod joints;
mod kinematics;
mod versions;

use crate::common::{Run, call, fail, scratch, succeed};
use faults::BODY;
use kinematics::{Numbers, positions, tree, urdf};
use redysim_model::joint::JointPhysics;
use redysim_model::{GenericMechanism, Model};
use redysim_runtime::{LinkKinematics, MassMatrix, MechanicalEnergy, Mechanism};
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;

/// A folder of the running test's own, whose thread has its name, with `robot.urdf` alone.
fn folder_with(urdf: impl AsRef<[u8]>) -> PathBuf {
    let folder = scratch(&thread::current().name().unwrap().replace("::", "-"));
    fs::write(folder.join("robot.urdf"), urdf).unwrap();
    folder
}

/// Imports the `robot.urdf` of a folder.
fn import_from(folder: &Path, options: &[&str]) -> Run {
    call(folder, &[&["import", "robot.urdf"], options].concat())
}

/// Imports the text of a URDF; the model, which has no faults, and the run.
fn import(urdf: &str, options: &[&str]) -> (GenericMechanism, Run) {
    let run = import_from(&folder_with(urdf), options);
    assert_eq!(run.code, 0, "{}", run.stderr);
    let model = Model::from_toml(run.stdout.clone(), "robot.toml").unwrap_or_else(|faults| panic!("{faults}")).model;
    (GenericMechanism::new(model), run)
}

/// A link on a joint with the given inside.
fn pendulum(inside_of_joint: &str, inertial: &str) -> String {
    format!(
        "<robot name=\"pendulum\"><link name=\"world\"/><link name=\"rod\">{inertial}</link>\
         <joint name=\"hinge\" type=\"continuous\"><parent link=\"world\"/><child link=\"rod\"/>{inside_of_joint}</joint></robot>"
    )
}

/// nᵀ R I Rᵀ n + m |n × c|²: the moment about the joint's axis, by hand.
#[test]
fn inertias_are_turned_into_the_links_axes() {
    let angle: f64 = 0.7;
    let urdf = pendulum(
        "<axis xyz=\"0 0 2\"/>",
        &format!(
            "<inertial><origin xyz=\"0.3 -0.4 5\" rpy=\"{angle} 0 0\"/><mass value=\"2\"/>\
             <inertia ixx=\"9\" iyy=\"3\" izz=\"7\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>"
        ),
    );
    let (mechanism, _) = import(&urdf, &[]);
    let moment = 3.0 * angle.sin().powi(2) + 7.0 * angle.cos().powi(2);
    let expected = moment + 2.0 * 0.25;
    assert!((mechanism.mass_matrix(&vec![0.4])[0][0] - expected).abs() < 1e-14);
    let inertia = mechanism.model().links[0].inertia;
    // Of R diag(9, 3, 7) Rᵀ about x: yz = (3 − 7) sin cos.
    assert!((inertia.yz + 4.0 * angle.sin() * angle.cos()).abs() < 1e-15 && inertia.xx == 9.0);
}

#[test]
fn what_a_urdf_leaves_out_has_the_defaults_of_urdf() {
    let (mechanism, _) = import(&pendulum("", BODY), &[]);
    // The axis is x unless given; the origin is the parent's.
    assert_eq!(mechanism.model().links[0].axis.0, [1.0, 0.0, 0.0]);
    assert_eq!(mechanism.model().links[0].placement.position.0, [0.0; 3]);
    assert_eq!(mechanism.model().links[0].joint_name, "hinge");
    assert_eq!(mechanism.model().gravity.0, [0.0, 0.0, -9.81]);
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-13 * (1.0 + a.abs().max(b.abs()))
}

/// Origins, centres of mass, and with them the potential energy, against quaternions in this test.
#[test]
fn every_link_is_where_the_urdf_has_it() {
    let mut numbers = Numbers::new(1);
    for round in 0..20 {
        let joints = tree(&mut numbers, 3 + round);
        let (mechanism, _) = import(&urdf(&joints), &["--keep-fixed"]);
        let moving: Vec<usize> = (0..joints.len()).filter(|&index| joints[index].kind != "fixed").collect();
        let q: Vec<f64> = moving.iter().map(|_| numbers.within(3.0)).collect();
        let all: Vec<f64> = (0..joints.len())
            .map(|joint| moving.iter().position(|&m| m == joint).map_or(0.0, |place| q[place]))
            .collect();
        let states = mechanism.link_kinematics(&q, &vec![0.0; q.len()]);
        let mut potential = 0.0;
        for (((joint, state), link), (origin, com)) in
            joints.iter().zip(&states).zip(&mechanism.model().links).zip(positions(&joints, &all))
        {
            assert_eq!((&link.name, link.mass), (&joint.link, joint.mass));
            for axis in 0..3 {
                assert!(close(state.origin[axis], origin[axis]), "{}: {:?} {origin:?}", link.name, state.origin);
                assert!(close(state.com[axis], com[axis]), "{}: {:?} {com:?}", link.name, state.com);
            }
            potential += joint.mass * 9.81 * com[2];
        }
        assert!(close(mechanism.energy(&q, &vec![0.0; q.len()]).potential, potential));
    }
}

const LOSSY: &str = r#"<?xml version="1.0"?>
<robot name="lossy">
  <material name="red"/>
  <link name="torso"><inertial><mass value="5"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="base">
    <visual><geometry><teapot/></geometry></visual>
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="finger"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="tool"/>
  <link name="puck"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="waist" type="prismatic"><parent link="torso"/><child link="base"/><axis xyz="0 0 1"/>
    <origin rpy="0 1.5708 0"/>
    <limit lower="-1" upper="1" effort="40" velocity="2"/><dynamics damping="0.1" friction="0.25"/></joint>
  <joint name="knuckle" type="revolute"><parent link="base"/><child link="finger"/><mimic joint="waist" multiplier="2"/>
    <limit lower="-1" upper="1" effort="40"/></joint>
  <joint name="spin" type="continuous"><parent link="finger"/><child link="tool"/></joint>
  <joint name="loose" type="floating"><parent link="torso"/><child link="puck"/></joint>
  <transmission name="t"/>
  <transmission name="u"/>
  <gazebo><plugin/></gazebo>
</robot>
"#;

#[test]
fn what_is_lost_is_reported_in_the_file_and_on_standard_error() {
    let (mechanism, run) = import(LOSSY, &[]);
    let reports = [
        "its 5 kg never move",
        "link `base` is called `base_link` here",
        "joint `spin` moves no mass",
        "the limits of 1 joint do not limit the motion",
        "left out: <gazebo>, on line 21",
        "left out: <material>, on line 3",
        "left out: <transmission>, 2 of them, the first on line 19",
        "left out: <visual> in a <link>, on line 6",
    ];
    for report in reports {
        assert!(
            run.stdout.contains(report) && run.stderr.contains(report),
            "{report}:\n{}\n{}",
            run.stdout,
            run.stderr
        );
    }
    assert!(run.stderr.contains("warning: link `base_link`: `origin.rpy[1]` is 1.5708 rad"), "{}", run.stderr);
    assert!(run.stdout.contains("range = { position = [-1.0, 1.0], velocity = 2.0, force = 40.0 }"), "{}", run.stdout);
    // What moves otherwise is no side note, and heads the model.
    let change = "joint `spin` moves no mass";
    assert!(run.stderr.contains(&format!("warning: {change}")), "{change}: {}", run.stderr);
    let head = run.stdout.split("[[link]]").next().unwrap();
    assert!(head.contains(&format!("# - {change}")), "{change}: {head}");
    let fused = import(LOSSY, &["--fuse-fixed"]).1;
    for report in reports.iter().chain(&["link `tool` is a part of `finger`"]) {
        assert!(fused.stdout.contains(report) && fused.stderr.contains(report), "{report}:\n{}", fused.stdout);
    }
    let kinds: Vec<usize> = mechanism.model().links.iter().map(|link| link.joint.dof()).collect();
    assert_eq!(kinds, [1, 1, 0, 6]);
    let quiet = import(LOSSY, &["--quiet"]).1;
    assert_eq!((quiet.stderr.as_str(), quiet.stdout), ("", run.stdout));
}

/// A joint that is fixed has no use for limits and resistance, nor a transmission without its joint; zeros tell nothing.
#[test]
fn numbers_that_nothing_can_use_are_kept_as_comments() {
    let fixed = |name: &str, inside: &str| {
        format!(
            "<link name=\"{name}\">{BODY}</link><joint name=\"{name}_mount\" type=\"fixed\"><parent link=\"arm\"/>\
             <child link=\"{name}\"/>{inside}</joint>"
        )
    };
    let urdf = format!(
        "<robot name=\"spare\"><link name=\"world\"/><link name=\"arm\">{BODY}</link><joint name=\"shoulder\" \
         type=\"continuous\"><parent link=\"world\"/><child link=\"arm\"/></joint>{}{}<transmission name=\"spare\"><joint \
         name=\"nowhere\"/><actuator name=\"motor\"><mechanicalReduction>50</mechanicalReduction></actuator></transmission></robot>",
        fixed("brake", "<dynamics damping=\"0.7\" friction=\"0.3\"/><limit effort=\"30\" velocity=\"2\"/>"),
        fixed("plate", "<dynamics damping=\"0\"/><limit effort=\"0.0\" velocity=\"0\"/>"),
    );
    let (_, run) = import(&urdf, &[]);
    let comments: Vec<&str> =
        run.stdout.split("[[link]]").skip(1).flat_map(str::lines).filter(|line| line.starts_with('#')).collect();
    assert_eq!(
        comments,
        [
            "# limit: effort = 30, velocity = 2; the joint is fixed",
            "# dynamics: damping = 0.7, friction = 0.3; the joint is fixed"
        ]
    );
    let lost = "left out: transmission `spare`: motor.mechanicalReduction = 50";
    assert!(run.stdout.contains(&format!("# - {lost}")) && run.stderr.contains(lost), "{}", run.stdout);
}

/// Each sentence of the help, and what shows that it holds.
#[test]
fn the_help_of_import_states_what_import_does() {
    let help = succeed(&scratch("import-help"), &["import", "--help"]);
    let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
    let limit = "<limit lower=\"-1\" upper=\"2\" effort=\"40\" velocity=\"3\" acceleration=\"7\"/>";
    let kinds = ["continuous", "floating", "planar", "spherical"];
    let of_kind = |kind: &str| {
        let hand = format!(
            "<link name=\"hand\">{BODY}</link><joint name=\"wrist\" type=\"revolute\"><parent link=\"rod\"/>\
             <child link=\"hand\"/>{limit}</joint></robot>"
        );
        let urdf = pendulum("", BODY).replace("<robot", "<robot version=\"1.2\"").replace("continuous", kind);
        import(&urdf.replace("</robot>", &hand), &[])
    };
    let imported = kinds.map(of_kind);
    let first_joint = |index: usize| imported[index].0.model().links[0].joint.name();
    assert!(
        help.contains("Continuous joints become revolute. Floating joints become free, and planar ones stay planar")
    );
    assert!(help.contains("both without an actuator. Spherical joints stay spherical."));
    assert_eq!([0, 1, 2, 3].map(first_joint), ["revolute", "free", "planar", "spherical"]);
    let actuated = |index: usize| imported[index].0.model().links[0].actuated_velocities();
    assert_eq!([0, 1, 2, 3].map(actuated), [vec![true], vec![false; 6], vec![false; 3], vec![true; 3]]);

    let (mechanism, run) = import(LOSSY, &[]);
    let link = |joint: &str| mechanism.model().links.iter().find(|link| link.joint_name == joint).unwrap();
    assert!(help.contains("The root link becomes the ground, or with `--base free` a link on a free joint `base`"));
    assert_eq!(link("waist").parent, None);
    assert!(help.contains("Joints that mimic others do so here if both have one coordinate."));
    let mimic = link("knuckle").mimic.unwrap();
    assert_eq!(mechanism.model().links[mimic.link].joint_name, "waist");
    assert_eq!((mimic.multiplier, mimic.offset, mechanism.nv()), (2.0, 0.0, 7));
    assert!(run.stdout.contains("mimic = { joint = \"waist\", multiplier = 2.0 }"), "{}", run.stdout);
    assert!(help.contains("Joints that move no mass become fixed, unless one that moves with them moves some."));
    assert_eq!(link("spin").joint.name(), "fixed");
    assert!(help.contains("Limits of positions and velocity become a `range`."));
    assert_eq!(imported[0].0.model().links[1].range[0].acceleration, Some(7.0));
    assert_eq!(link("waist").range[0].acceleration, None);
    assert!(link("spin").range.is_empty());
    assert!(help.contains("Damping and friction are kept, but of floating and planar joints as comments."));
    let damped = |kind: &str| {
        let urdf = pendulum("<dynamics damping=\"0.5\" friction=\"0.25\"/>", BODY);
        import(&urdf.replace("<robot", "<robot version=\"1.2\"").replace("continuous", kind), &[])
    };
    let (ball, _) = damped("spherical");
    let expected_of_ball = JointPhysics { damping: 0.5.into(), friction: 0.25.into(), ..JointPhysics::default() };
    assert_eq!(ball.model().links[0].physics, expected_of_ball);
    for kind in ["floating", "planar"] {
        let (mechanism, run) = damped(kind);
        assert_eq!(mechanism.model().links[0].physics, JointPhysics::default());
        let comment = "# dynamics: damping = 0.5, friction = 0.25; `damping` and `friction` of this joint are arrays";
        assert!(run.stdout.contains(comment), "{kind}: {}", run.stdout);
    }
    let expected = JointPhysics { damping: 0.1.into(), friction: 0.25.into(), ..JointPhysics::default() };
    assert_eq!((link("waist").physics.clone(), link("spin").physics.clone()), (expected, JointPhysics::default()));
    assert!(help.contains(
        "Other numbers, such as transmission ratios, other limits and what a joint that becomes fixed had, stay as \
         comments beside their links; those of the root stay in the model's head."
    ));
    let rich = import(RICH, &[]).1.stdout;
    for kept in
        ["motor.mechanicalReduction = -100.5", "limit: jerk", "axis: xyz = [0, 0.6, 0.8]", "its 5 kg never move"]
    {
        assert!(rich.contains(kept), "{kept}: {rich}");
    }
    assert!(help.contains("Visuals and collisions are left out."));
    let head = run.stdout.split("[[link]]").next().unwrap();
    assert!(head.contains("<visual>") && run.stderr.contains("<visual>"), "{head}");
}

const RICH: &str = r#"<robot name="rich">
  <link name="plinth"><inertial><origin xyz="0 0 0.5"/><mass value="5"/>
    <inertia ixx="1" iyy="2" izz="2.5" ixy="0" ixz="0" iyz="0.25"/></inertial></link>
  <link name="arm"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <contact><rolling_friction value="0.001"/></contact><visual><origin xyz="1 2 3"/><geometry/></visual></link>
  <link name="slide"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="flag"/>
  <joint name="shoulder" type="revolute"><parent link="plinth"/><child link="arm"/>
    <limit lower="-1" upper="1" effort="40" velocity="2" jerk="900"/><calibration rising="0.125"/>
    <dynamics damping="0.5" friction="0.25" spring_stiffness="70"/>
    <safety_controller soft_lower_limit="-0.9" soft_upper_limit="0.9" k_position="15" k_velocity="3"/></joint>
  <joint name="rail" type="prismatic"><parent link="arm"/><child link="slide"/><axis xyz="0 1 0"/>
    <limit effort="7" lower="0" upper="0.5"/><mimic joint="shoulder" multiplier="-0.5" offset="0.125"/></joint>
  <joint name="pole" type="continuous"><parent link="slide"/><child link="flag"/><axis xyz="0 0.6 0.8"/>
    <limit effort="3" velocity="4"/><dynamics damping="0.0625"/></joint>
  <transmission name="gear"><type>transmission_interface/SimpleTransmission</type><joint name="shoulder"/>
    <actuator name="motor"><mechanicalReduction>-100.5</mechanicalReduction></actuator></transmission>
  <gazebo reference="slide"><mu1>0.9</mu1></gazebo>
</robot>
"#;

#[test]
fn numbers_that_a_model_has_no_place_for_are_comments_beside_their_links() {
    let (mechanism, run) = import(RICH, &[]);
    let parts: Vec<&str> = run.stdout.split("[[link]]\n").collect();
    let [head, shoulder, rail, pole] = parts.as_slice() else { panic!("{}", run.stdout) };
    let comments =
        |part: &str| part.lines().filter(|line| line.starts_with("# ")).map(String::from).collect::<Vec<_>>();
    assert!(head.contains(
        "its 5 kg never move and are left out: com = [0.0, 0.0, 0.5] m, \
         inertia = { xx = 1.0, yy = 2.0, zz = 2.5, yz = 0.25 } kg m²"
    ));
    assert_eq!(
        comments(shoulder),
        [
            "# limit: jerk = 900 rad/s³",
            "# dynamics: spring_stiffness = 70",
            "# contact: rolling_friction.value = 0.001",
            "# calibration: rising = 0.125 rad",
            "# safety_controller: soft_lower_limit = -0.9 rad, soft_upper_limit = 0.9 rad, k_position = 15 1/s, \
             k_velocity = 3 N m s/rad",
            "# transmission `gear`: motor.mechanicalReduction = -100.5; `armature` = rotor inertia × \
             mechanicalReduction²",
        ]
    );
    assert_eq!(
        comments(rail),
        [
            "# limit: effort = 7 N, lower = 0 m, upper = 0.5 m; the range of the joint that it mimics holds",
            "# gazebo: mu1 = 0.9",
        ]
    );
    assert_eq!(
        comments(pole)[1..],
        [
            "# axis: xyz = [0, 0.6, 0.8]",
            "# limit: effort = 3 N m, velocity = 4 rad/s",
            "# dynamics: damping = 0.0625 N m s/rad",
        ]
    );
    assert_eq!(mechanism.model().links[0].physics.damping, 0.5.into());
    // Pictures are left out; what is kept is not.
    assert!(head.contains("left out: <visual> in a <link>, on line 5") && !head.contains("left out: <transmission>"));
    assert!(run.stderr.contains("note: numbers without a key in the model are kept as comments: 11 lines"));
    // Where a fixed link becomes a part of another, its comments go along.
    let fused = import(RICH, &["--fuse-fixed"]).1.stdout;
    let slide = fused.split("[[link]]\n").nth(2).unwrap();
    assert!(slide.contains("# joint `pole`: dynamics: damping = 0.0625 N m s/rad"), "{slide}");
    assert!(slide.contains("link `flag` is a part of `slide`: origin = {}"), "{slide}");
}

#[test]
fn odd_names_stay_what_they_are() {
    let urdf = pendulum("<limit velocity=\"1\"/>", BODY)
        .replace("hinge", "a &quot;b&quot; \\ ' # é&#10;x")
        .replace("rod", "&lt;]]&gt;");
    let (mechanism, _) = import(&urdf, &[]);
    assert_eq!(mechanism.model().links[0].joint_name, "a \"b\" \\ ' # é\nx");
    assert_eq!(mechanism.model().links[0].name, "<]]>");
}

#[test]
fn an_existing_model_stays_unless_forced() {
    let folder = folder_with(LOSSY);
    let model = folder.join("robot.toml");
    fs::write(&model, "mine").unwrap();
    fail(&folder, &["import", "robot.urdf", "-o", "robot.toml"], 3);
    assert_eq!(fs::read_to_string(&model).unwrap(), "mine");
    succeed(&folder, &["import", "robot.urdf", "-o", "robot.toml", "--force"]);
    assert!(Model::load(&model).is_ok());
    succeed(&folder, &["check", "--quiet", "robot.toml"]);
}
