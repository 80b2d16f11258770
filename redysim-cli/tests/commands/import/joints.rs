//! The kinds of joints of a URDF, and those that mimic others.

use super::faults::BODY;
use super::{import, pendulum};
use crate::common::{Run, fail, scratch};
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use redysim_model::GenericMechanism;
use redysim_runtime::{LinkKinematics, MassMatrix, Mechanism};
use std::fs;

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

/// Whatever its normal, the link moves in the plane through the joint's origin, and turns about the normal.
#[test]
fn a_planar_joint_of_a_urdf_moves_its_link_across_the_axis_and_turns_it_about_that() {
    for axis in ["1 0 0", "0 0 1", "0 0 -2", "0.48 -0.6 0.64", "3e200 4e200 0", "1.2e-200 0 -1.6e-200"] {
        let normal = Vector3::from_iterator(axis.split(' ').map(|x| x.parse::<f64>().unwrap()));
        let normal = (normal / normal.amax()).normalize();
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
