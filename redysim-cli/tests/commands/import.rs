//! `redysim import`: the model describes the mechanism of the URDF, and everything left out is reported.

mod faults;
mod kinematics;

use crate::common::{Run, call, fail, scratch, succeed};
use faults::BODY;
use kinematics::{Numbers, positions, tree, urdf};
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use redysim_model::joint::JointPhysics;
use redysim_model::{GenericMechanism, JointRange, Model};
use redysim_runtime::Real;
use redysim_runtime::{InverseDynamics, LinkKinematics, MassMatrix, MechanicalEnergy, Mechanism};
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

/// Fused, the same forces; moving links stay where they are, and the mass that moves is there.
#[test]
fn fusing_changes_nothing_that_moves() {
    let mut numbers = Numbers::new(2);
    for round in 0..20 {
        let joints = tree(&mut numbers, 4 + round);
        let (kept, _) = import(&urdf(&joints), &[]);
        let (fused, run) = import(&urdf(&joints), &["--fuse-fixed"]);
        let n = kept.tree().nv();
        let [q, v, a] = [0; 3].map(|_| (0..n).map(|_| numbers.within(3.0)).collect::<Vec<f64>>());
        let forces = (kept.inverse_dynamics(&q, &v, &a), fused.inverse_dynamics(&q, &v, &a));
        let largest = forces.0.iter().fold(0.0_f64, |most, x| Real::maximum(most, x.abs()));
        for (a, b) in forces.0.iter().zip(&forces.1) {
            assert!((a - b).abs() < 1e-12 * largest, "{:?}", forces);
        }
        let (all, moving) = (kept.link_kinematics(&q, &v), fused.link_kinematics(&q, &v));
        let names: Vec<&str> = kept.model().links.iter().map(|link| link.name.as_str()).collect();
        for (link, state) in fused.model().links.iter().zip(&moving) {
            let before = &all[names.iter().position(|name| *name == link.name).unwrap()];
            assert!((0..3).all(|axis| close(before.origin[axis], state.origin[axis])), "{}", link.name);
        }
        assert_eq!(fused.model().links.len(), n);
        for joint in joints.iter().filter(|joint| joint.kind == "fixed") {
            assert!(run.stdout.contains(&format!("link `{}` is a part of", joint.link)), "{}", run.stdout);
        }
        let carried = |index: usize| {
            std::iter::successors(Some(index), |&at| joints[at].parent).any(|at| joints[at].kind != "fixed")
        };
        let mass = |chosen: &dyn Fn(usize) -> bool| -> f64 {
            (0..joints.len()).filter(|&index| chosen(index)).map(|index| joints[index].mass).sum()
        };
        assert!(close(fused.model().links.iter().map(|link| link.mass).sum(), mass(&carried)));
        assert!(close(kept.model().links.iter().map(|link| link.mass).sum(), mass(&|_| true)));
    }
}

/// Two equal rods end to end are one of twice the mass and length, with (2m)(2l)²/12.
#[test]
fn two_rods_fused_are_a_longer_rod() {
    let (mass, length) = (3.0, 0.8);
    let moment = mass * length * length / 12.0;
    let rod = |name: &str| {
        format!(
            "<link name=\"{name}\"><inertial><origin xyz=\"{} 0 0\"/><mass value=\"{mass}\"/><inertia ixx=\"0\" \
             iyy=\"{moment}\" izz=\"{moment}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>",
            length / 2.0
        )
    };
    let joint = |name: &str, kind: &str, parent: &str, child: &str, inside: &str| {
        format!(
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>{inside}</joint>"
        )
    };
    let urdf = [
        "<robot name=\"rods\"><link name=\"world\"/>".to_string(),
        rod("inner"),
        rod("outer"),
        joint("hinge", "continuous", "world", "inner", "<axis xyz=\"0 0 1\"/>"),
        joint("weld", "fixed", "inner", "outer", &format!("<origin xyz=\"{length} 0 0\" rpy=\"1.2 0 0\"/>")),
        "</robot>".into(),
    ]
    .concat();
    let (mechanism, _) = import(&urdf, &["--fuse-fixed"]);
    let link = &mechanism.model().links[0];
    assert_eq!((link.name.as_str(), link.mass), ("inner", 2.0 * mass));
    assert!(close(link.com[0], length) && link.com[1] == 0.0);
    assert!(close(link.inertia.zz, 2.0 * mass * (2.0 * length).powi(2) / 12.0), "{:?}", link.inertia);
    assert!(link.inertia.xx.abs() < 1e-15);
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

/// A joint that stands on the ground, and its link.
fn grounded(name: &str, kind: &str, mimic: &str, body: &str) -> String {
    let inside = if mimic.is_empty() { String::new() } else { format!("<mimic joint=\"{mimic}\" multiplier=\"-2\"/>") };
    format!(
        "<link name=\"{name}_link\">{body}</link><joint name=\"{name}\" type=\"{kind}\"><parent link=\"world\"/>\
         <child link=\"{name}_link\"/><axis xyz=\"0 1 0\"/>{inside}</joint>"
    )
}

/// The robot of such joints, what its joints are, and how it was imported.
fn import_grounded(joints: &[String]) -> (GenericMechanism, Vec<&'static str>, Run) {
    let urdf = format!("<robot name=\"lids\"><link name=\"world\"/>{}</robot>", joints.concat());
    let (mechanism, run) = import(&urdf, &[]);
    let kinds = mechanism.model().links.iter().map(|link| link.joint.name()).collect();
    (mechanism, kinds, run)
}

/// A motor without mass, and a pointer that follows it: they move with the lid, which has some. The flag does not, nor what
/// mimics it.
#[test]
fn joints_that_move_no_mass_keep_their_motion_where_they_move_with_one_that_does() {
    let joints = [
        grounded("motor", "continuous", "", ""),
        grounded("lid", "continuous", "motor", BODY),
        grounded("pointer", "prismatic", "lid", ""),
        grounded("flag", "continuous", "", ""),
        grounded("pole", "continuous", "flag", ""),
    ];
    let (mechanism, kinds, run) = import_grounded(&joints);
    assert_eq!(kinds, ["revolute", "revolute", "prismatic", "fixed", "fixed"], "{}", run.stderr);
    assert_eq!(mechanism.nv(), 1);
    for fixed in ["flag", "pole"] {
        assert!(run.stderr.contains(&format!("joint `{fixed}` moves no mass")), "{}", run.stderr);
    }
    let [[inertia]] = [mechanism.mass_matrix(&vec![0.3])].map(|rows: Vec<Vec<f64>>| [rows[0][0]]);
    let a: Vec<f64> =
        redysim_runtime::ForwardDynamics::forward_dynamics(&mechanism, &vec![0.3], &vec![0.0], &vec![1.0]);
    let weight: Vec<f64> = redysim_runtime::GravityForces::gravity_forces(&mechanism, &vec![0.3]);
    assert!(inertia > 0.0 && (a[0] - (1.0 - weight[0]) / inertia).abs() < 1e-12 * a[0].abs());
}

/// What cannot mimic a joint has a coordinate of its own, which others may mimic: it moves their mass, and they its own.
#[test]
fn joints_mimic_one_that_cannot_mimic_itself() {
    for (kind, body) in [("fixed", BODY), ("floating", BODY), ("planar", BODY), ("fixed", "")] {
        let joints = [
            grounded("stop", kind, "", body),
            grounded("motor", "continuous", "stop", ""),
            grounded("lid", "continuous", "motor", BODY),
            grounded("hinge", "continuous", "stop", BODY),
            grounded("pointer", "prismatic", "hinge", ""),
        ];
        let (mechanism, kinds, run) = import_grounded(&joints);
        assert_eq!(kinds[1..], ["revolute", "revolute", "revolute", "prismatic"], "{kind}: {}", run.stderr);
        let mimicked = |link: usize| mechanism.model().links[link].mimic.map(|mimic| mimic.link);
        assert_eq!([1, 2, 3, 4].map(mimicked), [None, Some(1), None, Some(3)], "{kind}");
        for joint in ["motor", "hinge"] {
            let own =
                format!("joint `{joint}` mimics `stop` in the URDF (-2 times its value, plus 0 rad): it is free here");
            assert!(run.stderr.contains(&own), "{}", run.stderr);
        }
    }
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

/// Whatever its normal, the link moves in the plane through the joint's origin, and turns about the normal.
#[test]
fn a_planar_joint_of_a_urdf_moves_its_link_across_the_axis_and_turns_it_about_that() {
    for axis in ["1 0 0", "0 0 1", "0 0 -2", "0.48 -0.6 0.64"] {
        let normal = Vector3::from_iterator(axis.split(' ').map(|x| x.parse::<f64>().unwrap())).normalize();
        let inside = format!("<origin xyz=\"0.1 0.2 0.3\" rpy=\"0.3 -0.2 0.9\"/><axis xyz=\"{axis}\"/>");
        let urdf = pendulum(&inside, BODY).replace("continuous", "planar");
        let mechanism = import(&urdf, &[]).0;
        assert_eq!(mechanism.model().links[0].joint.name(), "planar", "{axis}");
        let at = |q: [f64; 3]| mechanism.link_kinematics(&q.to_vec(), &vec![0.0; 3])[0];
        let turned = |q| Matrix3::from_fn(|i, j| at(q).rotation[i][j]);
        let (zero, moved) = (at([0.0; 3]), at([0.3, -0.4, 0.9]));
        // The axis is that of the joint's frame, which the URDF places on the parent.
        let normal_here = turned([0.0; 3]) * normal;
        let way = Vector3::from(moved.origin) - Vector3::from(zero.origin);
        assert!(way.dot(&normal_here).abs() < 1e-15 && (way.norm() - 0.5).abs() < 1e-15, "{axis}: {way}");
        let expected = Rotation3::from_axis_angle(&Unit::new_normalize(normal_here), 0.9) * turned([0.0; 3]);
        assert!((turned([0.3, -0.4, 0.9]) - expected).amax() < 1e-15, "{axis}: {expected}");
    }
}

#[test]
fn a_joint_whose_axis_is_zero_is_one_error_at_its_axis() {
    for (kind, what) in [
        ("planar", "its `axis`, the normal of the plane in which it moves, is zero"),
        ("prismatic", "its `axis` is zero"),
    ] {
        let urdf = pendulum("<axis xyz=\"0 0.0 -0\"/>", BODY).replace("continuous", kind);
        let folder = scratch(&format!("import-zero-axis-{kind}"));
        fs::write(folder.join("robot.urdf"), urdf).unwrap();
        let shown = fail(&folder, &["import", "robot.urdf"], 1);
        assert!(shown.contains(what) && shown.contains("as in xyz=\"0 0 1\""), "{shown}");
        assert!(shown.matches("error: ").count() == 1 && !shown.contains("NaN"), "{shown}");
    }
}

#[test]
fn rounded_quarter_turns_are_exact_where_asked_for() {
    let (mechanism, run) = import(LOSSY, &["--quarter-turns"]);
    assert_eq!(mechanism.model().links[0].placement.rotation.0[2], [-1.0, 0.0, 0.0]);
    assert!(run.stderr.contains("1 angle made a multiple of 90°, changed by 3.7e-6 rad at most"), "{}", run.stderr);
    assert!(!run.stderr.contains("1.5708 rad"), "{}", run.stderr);
}

#[test]
fn warnings_of_rounded_quarter_turns_name_the_option_that_makes_them_exact() {
    let (_, run) = import(LOSSY, &[]);
    assert!(run.stderr.contains("1.5708 rad") && run.stderr.contains("help: --quarter-turns makes"), "{}", run.stderr);
    let (_, run) = import(LOSSY, &["--quarter-turns"]);
    assert!(!run.stderr.contains("--quarter-turns makes"), "{}", run.stderr);
    let shown = call(&folder_with(LOSSY), &["show", "robot.urdf", "-o", "page.html"]);
    assert!(shown.stderr.contains("`redysim import --quarter-turns` makes"), "{}", shown.stderr);
}

/// Imports the pendulum with a chain of `count` links, each with `body`, at its end.
fn import_chain(count: usize, body: &str) -> Run {
    let link = |k: usize| {
        let parent = if k == 0 { "rod".into() } else { format!("part{}", k - 1) };
        format!(
            "<link name=\"part{k}\">{body}</link><joint name=\"joint{k}\" type=\"continuous\">\
             <parent link=\"{parent}\"/><child link=\"part{k}\"/></joint>\n"
        )
    };
    let links: String = (0..count).map(link).collect();
    import_from(&folder_with(pendulum("", BODY).replace("</robot>", &(links + "</robot>"))), &[])
}

#[test]
fn of_very_many_errors_of_a_urdf_the_first_20_are_shown() {
    let faulty = BODY.replace("<mass value=\"", "<mass value=\"-");
    assert_ne!(faulty, BODY);
    let run = import_chain(50, &faulty);
    assert_eq!((run.code, run.stderr.matches("error: ").count()), (1, 20), "{}", run.stderr);
    assert!(run.stderr.ends_with("\nand 30 more errors\n"), "{}", run.stderr);
}

#[test]
fn of_very_many_warnings_of_a_urdf_the_first_20_are_shown() {
    let odd = "<inertial><mass value=\"1\"/><inertia ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.1\" iyz=\"0\" izz=\"0.3\"/></inertial>";
    let run = import_chain(21, odd);
    assert_eq!((run.code, run.stderr.matches("warning: link `part").count()), (0, 20), "{}", run.stderr);
    assert!(run.stderr.contains("\nand 1 more warning\n"), "{}", run.stderr);
}

/// The antennas of Tiago, as its makers publish them: their products of inertia exceed what their moments permit.
#[test]
fn a_negative_moment_of_a_small_part_is_a_warning() {
    let antenna = "<inertial><mass value=\"0.000001\"/><inertia ixx=\"2.371e-8\" ixy=\"6.119e-8\" ixz=\"1.179e-8\" \
                   iyy=\"2.833e-8\" iyz=\"0.774e-8\" izz=\"3.849e-8\"/></inertial>";
    for carrier in ["world", "rod"] {
        let fixed = format!(
            "<link name=\"antenna\">{antenna}</link><joint name=\"mount\" type=\"fixed\">\
             <parent link=\"{carrier}\"/><child link=\"antenna\"/></joint></robot>"
        );
        let urdf = pendulum("", BODY).replace("</robot>", &fixed);
        let (mechanism, run) = import(&urdf, &[]);
        assert_eq!(mechanism.model().links.len(), 2);
        assert!(run.stderr.contains("link `antenna`: `inertia` has a negative principal moment"), "{}", run.stderr);
        assert!(mechanism.mass_matrix(&vec![0.3])[0][0] > 0.0);
    }
}

/// As a program writes zero: no body has products of inertia without moments, but this one is meant to have none.
#[test]
fn an_inertia_of_roundoff_is_left_out() {
    let inertial = "<inertial><origin xyz=\"0 0.2 0\"/><mass value=\"1.5\"/><inertia ixx=\"0\" iyy=\"0\" izz=\"0\" ixy=\"0\" \
                    ixz=\"1.4e-20\" iyz=\"0\"/></inertial>";
    let (mechanism, run) = import(&pendulum("", inertial), &[]);
    assert_eq!(mechanism.model().links[0].inertia, Default::default());
    assert!(run.stderr.contains("the inertia of link `rod` is roundoff"), "{}", run.stderr);
    assert!(close(mechanism.mass_matrix(&vec![1.0])[0][0], 1.5 * 0.2 * 0.2));
}

#[test]
fn limits_are_a_range_with_the_acceleration_that_the_urdf_has() {
    let urdf = pendulum("<limit lower=\"-1\" upper=\"2\" effort=\"40\" velocity=\"3\" acceleration=\"7\"/>", BODY);
    let urdf = urdf.replace("<robot", "<robot version=\"1.2\"").replace("continuous", "revolute");
    let (mechanism, _) = import(&urdf, &[]);
    let range = mechanism.model().links[0].range[0];
    assert_eq!((range.position, range.velocity, range.acceleration), ([-1.0, 2.0], 3.0, Some(7.0)));
    assert_eq!(range.force, Some(40.0));
    let (mechanism, _) = import(&urdf.replace(" acceleration=\"7\"", ""), &[]);
    assert_eq!(mechanism.model().links[0].range[0], JointRange { acceleration: None, ..range });
}

/// What makes no sense is not dropped either.
#[test]
fn limits_whose_lower_one_is_not_below_the_upper_are_kept_as_they_are() {
    let urdf = pendulum("<limit lower=\"2\" upper=\"1\" effort=\"-10\" velocity=\"3\"/>", BODY);
    let (_, run) = import(&urdf.replace("continuous", "revolute"), &[]);
    let kept = "# limit: lower = 2 rad, upper = 1 rad, effort = -10 N m, velocity = 3 rad/s; \
                the lower one is not below the upper";
    assert!(run.stdout.contains(kept), "{}", run.stdout);
    let lost = "has no range here: its lower limit, 2 rad, is above its upper one, 1 rad";
    let warned = run.stderr.lines().any(|line| line.starts_with("warning: joint") && line.contains(lost));
    assert!(warned, "{}", run.stderr);
}

#[test]
fn what_of_a_urdf_is_probably_misspelled_or_impossible_is_warned_of() {
    let warned = |urdf: &str, wanted: &[&str]| {
        let (_, run) = import(urdf, &[]);
        let warnings: Vec<&str> = run.stderr.lines().filter(|line| line.starts_with("warning: ")).collect();
        for part in wanted {
            assert!(warnings.iter().any(|line| line.contains(part)), "no `{part}` in: {}", run.stderr);
        }
        assert_eq!(warnings.len(), wanted.len(), "{}", run.stderr);
    };
    let limit = |limit: &str| pendulum(limit, BODY).replace("continuous", "revolute");
    warned(&limit("<limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"3\"/>"), &[]);
    warned(
        &limit("<limit lowr=\"-1\" upper=\"1\" effort=\"1\" velocity=\"3\"/><axsi xyz=\"0 1 0\"/>"),
        &["<limit> has the unknown attribute `lowr`: did you mean `lower`?", "<axsi> is unknown: did you mean <axis>?"],
    );
    warned(
        &limit("<limit effort=\"-10\" velocity=\"3\"/>"),
        &["has no range here: its limit of effort is -10, which is negative"],
    );
    warned(&limit("<limit effort=\"1\" velocity=\"-3\"/>"), &["its limit of velocity is -3, which is negative"]);
    warned(&limit("<mimic joint=\"nobody\"/>"), &["mimics `nobody`, which does not exist, in the URDF"]);
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

/// A satellite of 5 kg with an arm of 1 kg on an axis through (0.3, 0, 0).
const SATELLITE: &str = r#"<robot name="satellite">
  <link name="bus"><inertial><origin xyz="0.1 0 0"/><mass value="5"/><inertia ixx="0.1" iyy="0.2" izz="0.3" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="boom"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="panel"><inertial><mass value="2"/><inertia ixx="0.02" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="hinge" type="revolute"><parent link="bus"/><child link="boom"/><origin xyz="0.3 0 0"/><axis xyz="0 0 1"/></joint>
  <link name="tip"/>
  <joint name="end" type="fixed"><parent link="boom"/><child link="tip"/></joint>
  <joint name="weld" type="fixed"><parent link="bus"/><child link="panel"/><origin xyz="-1 0 0"/></joint>
</robot>
"#;

#[test]
fn the_root_of_a_robot_with_a_free_base_floats_on_a_joint_without_an_actuator() {
    for options in [&["--base", "free"][..], &["--base", "free", "--fuse-fixed"]] {
        let (mechanism, run) = import(SATELLITE, options);
        let [bus, boom, ..] = &mechanism.model().links[..] else { panic!("{}", run.stdout) };
        assert_eq!((bus.name.as_str(), bus.joint_name.as_str(), bus.joint.name()), ("bus", "base", "free"));
        assert_eq!(
            (bus.parent, boom.parent, bus.actuated_velocities(), boom.actuated_velocities()),
            (None, Some(0), vec![false; 6], vec![true])
        );
        assert_eq!((mechanism.nq(), mechanism.nv(), mechanism.model().mass()), (8, 7, 8.0));
        let tip = mechanism.model().links.iter().find(|link| link.name == "tip");
        assert!(tip.is_none_or(|tip| tip.parent == Some(1)), "{}", run.stdout);
        assert!(run.stderr.contains("the root link `bus` floats on a free joint"), "{}", run.stderr);
        assert!(!run.stderr.contains("warning"), "{}", run.stderr);
        // All of it moves along x like one body, whatever is fused.
        let matrix = mechanism.mass_matrix(&vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        assert!(close(matrix[0][0], 8.0) && close(matrix[5][1], 5.0 * 0.1 + 0.3 - 2.0), "{matrix:?}");
    }
    let (fixed, _) = import(SATELLITE, &["--base", "fixed"]);
    assert_eq!(fixed.model().dof(), 1);
}

#[test]
fn the_free_joint_of_a_base_has_a_name_that_no_other_joint_has() {
    let (mechanism, _) = import(&SATELLITE.replace("hinge", "base"), &["--base", "free"]);
    assert_eq!(mechanism.model().links[0].joint_name, "base1");
}

#[test]
fn a_fault_of_the_root_link_of_a_floating_robot_is_reported_on_its_line() {
    let folder = folder_with(SATELLITE.replacen("ixx=\"0.1\"", "ixx=\"-1\"", 1));
    let run = import_from(&folder, &["--base", "free"]);
    assert!(run.code == 1 && run.stderr.contains("robot.urdf:2: link `bus`"), "{}", run.output());
}

/// A body of 2 kg whose centre of mass is 0.1 m above its origin.
#[test]
fn a_robot_of_one_link_without_joints_floats_on_a_free_base_and_is_refused_on_a_fixed_one() {
    let urdf = "<robot name=\"drone\">\n<link name=\"hull\"><inertial><origin xyz=\"0 0 0.1\"/><mass value=\"2\"/>\
                <inertia ixx=\"0.1\" iyy=\"0.2\" izz=\"0.3\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link></robot>";
    for options in [&["--base", "free"][..], &["--base", "free", "--fuse-fixed"]] {
        let (mechanism, run) = import(urdf, options);
        let [hull] = &mechanism.model().links[..] else { panic!("{}", run.stdout) };
        assert_eq!((hull.name.as_str(), hull.joint_name.as_str(), hull.joint.name()), ("hull", "base", "free"));
        assert_eq!(hull.actuated_velocities(), [false; 6]);
        assert!(!run.stderr.contains("warning"), "{}", run.stderr);
        let matrix = mechanism.mass_matrix(&vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
        assert!(close(matrix[0][0], 2.0) && close(matrix[3][3], 0.1 + 0.02) && close(matrix[5][5], 0.3), "{matrix:?}");
    }
    let run = import_from(&folder_with(urdf), &[]);
    assert_eq!(run.code, 1, "{}", run.stderr);
    for words in ["robot.urdf:1: the robot has no joints: nothing of it moves", "`--base free`"] {
        assert!(run.stderr.contains(words), "`{words}` in:\n{}", run.stderr);
    }
}
