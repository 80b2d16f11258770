//! Robots that stand on the ground or float.

use super::{close, folder_with, import, import_from};
use redysim_runtime::{MassMatrix, Mechanism};

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

#[test]
fn an_empty_root_under_floating_links_is_the_ground_and_does_not_float() {
    let urdf = "<robot name=\"drone\">\n<link name=\"world\"/>\n<link name=\"hull\"><inertial><mass value=\"2\"/>\
                <inertia ixx=\"0.1\" iyy=\"0.2\" izz=\"0.3\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>\n\
                <joint name=\"flight\" type=\"floating\"><parent link=\"world\"/><child link=\"hull\"/></joint></robot>";
    let run = import_from(&folder_with(urdf), &["--base", "free"]);
    assert_eq!(run.code, 1, "{}", run.stderr);
    for words in ["robot.urdf:2: the root link `world` has no inertia", "leave out `--base free`"] {
        assert!(run.stderr.contains(words), "`{words}` in:\n{}", run.stderr);
    }
    let (mechanism, _) = import(urdf, &[]);
    assert_eq!(mechanism.model().links[0].joint_name, "flight");
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
