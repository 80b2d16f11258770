//! Orientations of joints with Euler angles, given as a quaternion, by roll, pitch and yaw, or by an axis and an angle: they
//! are those of the same joint with a quaternion.

use std::fs;
use std::path::Path;

use redysim_cli::{Initial, Scenario, Torque, Values};
use redysim_model::joint::EulerSequence;
use redysim_model::rotation::roll_pitch_yaw;

use crate::common::{Table, deviation, fail, scenario, scratch, succeed};

const IN_SERIES: &str = "test/joints_in_series.toml";
const RUN: &str = "[forward]\nend = 0.001\nstep = 0.001\nintegrator = { method = 'Ode4', step = 0.001 }\n";

/// A body on a joint `joint` that stands turned, with further keys of its link.
fn body(folder: &Path, joint: &str, more: &str) {
    let link = format!(
        "name = 'body'\ngravity = [0, 0, 0]\nallow = ['other-gravity']\n[[link]]\nname = 'body'\nparent = 'base'\n\
         joint = '{joint}'\norigin = {{ xyz = [0.1, 0.2, 0.3], rpy = [0.3, -0.2, 0.9] }}\nmass = 1.0\n\
         inertia = {{ xx = 0.1, yy = 0.1, zz = 0.1 }}\n{more}\n"
    );
    fs::write(folder.join("body.toml"), link).unwrap();
}

/// The table `name` of `redysim command` with the model of [`body`].
fn run(folder: &Path, command: &str, rest: &str, name: &str) -> Table {
    fs::write(folder.join("trial.toml"), format!("model = 'body.toml'\n{rest}")).unwrap();
    succeed(folder, &[command, "trial.toml", "-o", "run", "--force", "--quiet"]);
    Table::csv(&folder.join("run").join(format!("{name}.csv")))
}

/// Where the body is and how it is turned at the start.
fn placed(folder: &Path, position: &str) -> Vec<f64> {
    let start = format!("[initial]\nq = {{ body = {{ {position} }} }}\n");
    let row = &run(folder, "forward", &format!("{start}{RUN}"), "kinematics").rows[0];
    [&row[1..4], &row[7..16]].concat()
}

#[test]
fn the_body_starts_as_on_a_joint_with_a_quaternion_for_every_sequence_and_every_form_of_an_orientation() {
    let folder = scratch("orientations-start");
    for (joint, xyz) in [("spherical", ""), ("free", "xyz = [1.5, -2.5, 0.75], ")] {
        let forms = [
            format!("{xyz}rpy = ['40 deg', -0.6, 2.9]"),
            format!("{xyz}quaternion = [0.3, -1.2, 0.4, 0.8]"),
            format!("{xyz}axis = [1, 2, -0.5], angle = '-130 deg'"),
        ];
        body(&folder, joint, "");
        let expected = forms.clone().map(|form| placed(&folder, &form));
        assert!(deviation(&expected[..1], &expected[1..2]) > 0.1, "they differ");
        for (name, _) in EulerSequence::ALL {
            body(&folder, joint, &format!("coordinates = '{name}'"));
            for (form, expected) in forms.iter().zip(&expected) {
                let off = deviation(&[placed(&folder, form)], std::slice::from_ref(expected));
                assert!(off < 4e-15, "{joint} {name}, {form}: {off:e}");
            }
        }
    }
}

#[test]
fn what_a_free_joint_leaves_out_is_neutral_and_quarter_turns_are_exact() {
    let folder = scratch("orientations-neutral");
    body(&folder, "free", "coordinates = 'yxz'");
    let q = |position: &str| {
        let start = format!("[initial]\nq = {{ body = {{ {position} }} }}\n");
        run(&folder, "forward", &format!("{start}{RUN}"), "statevar").rows[0][1..7].to_vec()
    };
    assert_eq!(q("xyz = [1, 2, 3]"), [1.0, 2.0, 3.0, 0.0, 0.0, 0.0]);
    let quarter = std::f64::consts::FRAC_PI_2;
    assert_eq!(q("rpy = [0, '90 deg', 0]"), [0.0, 0.0, 0.0, quarter, 0.0, 0.0]);
}

#[test]
fn a_motion_goes_from_orientation_to_orientation_and_through_its_points() {
    let folder = scratch("orientations-motion");
    body(&folder, "spherical", "coordinates = 'zxy'");
    let stand = roll_pitch_yaw([0.3, -0.2, 0.9]);
    let turned = |rpy: [f64; 3]| (stand * roll_pitch_yaw(rpy)).0.concat();
    let span = "[inverse]\nend = 2.0\nstep = 1.0\n";
    let [first, last] = [[0.2, -0.3, 0.5], [1.0, 0.4, -0.7]];
    let cycloid = format!(
        "[trajectory]\nfrom = {{ body = {{ rpy = {first:?} }} }}\nto = {{ body = {{ rpy = {last:?} }} }}\nduration = 2.0\n{span}"
    );
    let rows = run(&folder, "inverse", &cycloid, "kinematics").rows;
    let found = [rows[0][7..16].to_vec(), rows[2][7..16].to_vec()];
    assert!(deviation(&found, &[turned(first), turned(last)]) < 1e-14, "{rows:?}");
    let points = format!(
        "[trajectory]\nkind = 'cubic'\ntimes = [0, 1, 2]\npoints = [{{ body = {{ rpy = {first:?} }} }}, \
         {{ body = {{ axis = [0, 0, 2], angle = '30 deg' }} }}, {{ body = {{ rpy = {last:?} }} }}]\n{span}"
    );
    let rows = run(&folder, "inverse", &points, "kinematics").rows;
    let found: Vec<Vec<f64>> = rows.iter().map(|row| row[7..16].to_vec()).collect();
    let middle = turned([0.0, 0.0, 30_f64.to_radians()]);
    assert!(deviation(&found, &[turned(first), middle, turned(last)]) < 1e-14, "{rows:?}");
}

/// Yaw, pitch and roll are the angles of zyx, one after the other.
#[test]
fn a_spring_pulls_each_angle_to_that_of_the_target() {
    let folder = scratch("orientations-target");
    body(&folder, "spherical", "coordinates = 'zyx'");
    let law = "torque = { law = 'p', target = { body = { rpy = [0.3, '-20 deg', 1.25] } }, kp = [2, 3, 4] }\n";
    let forces = &run(&folder, "forward", &format!("{RUN}{law}"), "tor").rows[0];
    let expected = [2.0 * 1.25, -3.0 * 20_f64.to_radians(), 4.0 * 0.3];
    assert!(deviation(&[forces[1..].to_vec()], &[expected.to_vec()]) < 4e-15, "{forces:?}");
}

#[test]
fn data_have_the_angles_of_an_orientation_and_the_components_of_every_joint_in_series() {
    let path = format!("{}/trial.toml", crate::common::root().join("models").display());
    let text = format!(
        "model = '{IN_SERIES}'\n[initial]\nq = {{ swivel = ['30 deg', -0.4], probe = {{ xyz = [1, 2, 3], rpy = [0, 0, '40 deg'] }} }}\n\
         v = {{ carriage = [1, 2, 3] }}\n[forward]\nend = 1.0\nstep = 0.1\n\
         torque = {{ law = 'p', joints = ['swivel.theta', 'swivel.phi'], target = {{ swivel = [0.1, 0.2] }}, kp = 1 }}\n"
    );
    let read = Scenario::from_toml(text, &path).unwrap();
    let Some(Initial { q: Some(Values::Named(q)), v: Some(Values::Named(v)), .. }) = &read.initial else {
        panic!("{read:?}");
    };
    assert_eq!((q.len(), q["swivel.phi"], q["swivel.theta"]), (8, 30_f64.to_radians(), -0.4));
    // The sequence of the probe is zxy.
    assert_eq!((q["probe.y"], q["probe.phi"], q["probe.theta"]), (2.0, 40_f64.to_radians(), 0.0));
    assert_eq!((v.len(), v["carriage.angle"]), (3, 3.0));
    let Some(Torque::P { target: Values::Named(target), .. }) = &read.forward.as_ref().unwrap().torque else {
        panic!("{read:?}");
    };
    assert_eq!((target["swivel.phi"], target["swivel.theta"]), (0.1, 0.2));
    assert_eq!(Scenario::from_toml(read.to_toml(), &path).unwrap(), read);
}

#[test]
fn positions_of_joints_in_series_that_are_none_are_refused_with_what_to_do() {
    let folder = scratch("orientations-refused");
    for (initial, faults) in [
        (
            "q = { swivel = { rpy = [0, 0, 0] } }",
            &[
                "`initial.q.swivel` must be an array, not a table, with a value for each of swivel.phi, swivel.theta",
                "help: write for example `swivel = [0, 0]`, or by one name `\"swivel.phi\" = 0`",
                "trial.toml:3:16",
            ][..],
        ),
        ("q = { wrist = { xyz = [0, 0, 1] } }", &["unknown key `initial.q.wrist.xyz`"]),
        (
            "q = { wrist = { quaternion = [0, 0, 0, 0] } }",
            &["gives the joint `wrist` the quaternion [0, 0, 0, 0], which is invalid"],
        ),
        (
            "q = { wrist = { rpy = [0, 0, 0], quaternion = [0, 0, 0, 1] } }",
            &["gives its orientation twice, by `quaternion` and by `rpy`"],
        ),
        ("v = { wrist = { rpy = [0, 0, 1] } }", &["`initial.v.wrist` must be an array", "wrist = [0, 0, 0]"]),
        ("q = { wrist = [0, 0] }", &["3 values, one for each of wrist.phi, wrist.theta, wrist.psi"]),
        (
            "q = { wrist = { rpy = [0, 1, 0] }, 'wrist.psi' = 1 }",
            &["`initial.q` gives `wrist.psi` twice, once by itself and once with its joint"],
        ),
    ] {
        let path = scenario(&folder, IN_SERIES, &format!("[initial]\n{initial}\n[forward]\nend = 1.0\nstep = 0.1\n"));
        let shown = fail(&folder, &["forward", &path], 1);
        for fault in faults {
            assert!(shown.contains(fault), "{initial}: no {fault} in {shown}");
        }
        let is_table = faults[0].contains("must be an array");
        assert!(!(is_table && shown.contains("base = {")), "{initial}: the help shows what is refused: {shown}");
    }
}
