//! The versions of URDF: 1.1 adds quaternions, and in 1.2 limits are infinite by default.

use super::faults::{BODY, refused};
use super::{close, import, pendulum};
use redysim_model::JointRange;
use redysim_runtime::MassMatrix;

fn of_version(version: &str, urdf: &str) -> String {
    urdf.replace("<robot", &format!("<robot version=\"{version}\""))
}

/// A rotation about x, as a quaternion of length 3.
fn about_x(angle: f64) -> String {
    let (sin, cos) = (angle / 2.0).sin_cos();
    format!("quat_xyzw=\"{} 0 0 {}\"", 3.0 * sin, 3.0 * cos)
}

#[test]
fn an_origin_is_turned_by_its_quaternion() {
    let angle: f64 = 0.7;
    let inertial = |turn: &str| {
        format!(
            "<inertial><origin xyz=\"0.3 -0.4 5\" {turn}/><mass value=\"2\"/>\
             <inertia ixx=\"9\" iyy=\"3\" izz=\"7\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>"
        )
    };
    let joint = |turn: &str| format!("<origin xyz=\"1 2 3\" {turn}/><axis xyz=\"0 0 2\"/>");
    let urdf = of_version("1.1", &pendulum(&joint(&about_x(angle)), &inertial(&about_x(angle))));
    let (mechanism, _) = import(&urdf, &[]);
    let moment = 3.0 * angle.sin().powi(2) + 7.0 * angle.cos().powi(2) + 2.0 * 0.25;
    assert!(close(mechanism.mass_matrix(&vec![0.4])[0][0], moment));
    let placement = mechanism.model().links[0].placement;
    let rows = [[1.0, 0.0, 0.0], [0.0, angle.cos(), -angle.sin()], [0.0, angle.sin(), angle.cos()]];
    for (found, expected) in placement.rotation.0.as_flattened().iter().zip(rows.as_flattened()) {
        assert!(close(*found, *expected), "{placement:?}");
    }
    assert_eq!(placement.position.0, [1.0, 2.0, 3.0]);
}

/// v + 2 w (u × v) + 2 u × (u × v), for the unit quaternion (u, w). Near a pitch of 90°, roll and yaw are nearly about one
/// axis.
#[test]
fn every_quaternion_but_zero_gives_its_rotation_to_roundoff() {
    let (sin, cos) = 44.95_f64.to_radians().sin_cos();
    for quaternion in [[0.1, -0.7, 0.3, 0.5], [0.0, 1.0, 0.0, 1.0], [0.0, sin, 0.0, cos], [0.3, -sin, 0.2, -cos]] {
        let length = quaternion.iter().map(|x| x * x).sum::<f64>().sqrt();
        let [x, y, z, w] = quaternion.map(|x| x / length);
        for size in [1.0, 1e-170, 1e170] {
            let numbers = quaternion.map(|x| format!("{:e}", size * x)).join(" ");
            let inside = format!("<origin quat_xyzw=\"{numbers}\"/>");
            let (mechanism, _) = import(&of_version("1.1", &pendulum(&inside, BODY)), &[]);
            let found = mechanism.model().links[0].placement.rotation.0;
            for column in 0..3 {
                let v = [0, 1, 2].map(|row| f64::from(u8::from(row == column)));
                let cross = |a: [f64; 3], b: [f64; 3]| [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i]);
                let (once, twice) = (cross([x, y, z], v), cross([x, y, z], cross([x, y, z], v)));
                for row in 0..3 {
                    let expected = v[row] + 2.0 * w * once[row] + 2.0 * twice[row];
                    assert!((found[row][column] - expected).abs() < 1e-14, "{quaternion:?}, {size:e}: {found:?}");
                }
            }
        }
    }
}

#[test]
fn a_quaternion_is_invalid_if_it_is_zero_conflicts_with_angles_or_comes_before_version_1_1() {
    let with = |version: &str, origin: &str| {
        of_version(version, &pendulum(&format!("\n<origin {origin}/>"), BODY).replace("</joint>", "\n</joint>"))
    };
    let fault = "robot.urdf:2: joint `hinge`: `quat_xyzw` of its <origin>";
    refused(
        &with("1.0", &about_x(1.0)),
        &[fault, "requires URDF 1.1, but the file has an earlier version", "version=\"1.1\""],
    );
    refused(&with("1.0", "quat_xyzw=\"0 0 1\""), &[fault, "requires URDF 1.1"]);
    refused(&with("1.0", &format!("rpy=\"0 0 0\" {}", about_x(1.0))), &[fault, "conflicts with `rpy`"]);
    refused(
        &with("1.1", "quat_xyzw=\"0 0 0 0\""),
        &[fault, "is zero, which is not a rotation", "the identity is", "\"0 0 0 1\""],
    );
    refused(&with("1.1", &format!("rpy=\"0 0 0\" {}", about_x(1.0))), &[fault, "conflicts with `rpy`"]);
    refused(&with("1.1", "quat_xyzw=\"0 0 1\""), &[fault, "must be 4 finite numbers, found \"0 0 1\""]);
}

/// Before 1.2, positions are zero by default.
#[test]
fn limits_are_infinite_by_default_in_version_1_2() {
    let urdf =
        pendulum("<limit upper=\"2\" velocity=\"3\" acceleration=\"7\"/>", BODY).replace("continuous", "revolute");
    let (mechanism, run) = import(&urdf, &[]);
    let range = JointRange { acceleration: None, force: None, ..mechanism.model().links[0].range[0] };
    assert_eq!(mechanism.model().links[0].range, [range]);
    assert_eq!((range.position, range.velocity), ([0.0, 2.0], 3.0));
    assert!(run.stdout.contains("# limit: acceleration = 7 rad/s²\n"), "{}", run.stdout);
    let (mechanism, run) = import(&of_version("1.2", &urdf), &[]);
    assert!(mechanism.model().links[0].range.is_empty());
    assert!(run.stdout.contains("acceleration = 7 rad/s²; a `range` needs positions and a velocity"), "{}", run.stdout);
}

#[test]
fn limits_of_version_1_2_require_no_velocity_and_negative_ones_are_reported() {
    let reported = |limit: &str, wanted: &str| {
        let urdf = pendulum(&format!("<limit {limit}/>"), BODY).replace("continuous", "revolute");
        let (_, run) = import(&of_version("1.2", &urdf), &[]);
        assert!(run.stderr.contains(wanted), "no `{wanted}` in: {}", run.stderr);
    };
    reported("lower=\"2\" upper=\"1\"", "its lower limit, 2 rad, is above its upper one, 1 rad");
    reported("velocity=\"3\" acceleration=\"-7\"", "its limit of acceleration is -7, which is negative");
}

#[test]
fn an_unknown_version_is_reported_with_the_version_by_which_the_file_is_read() {
    for (version, read_as) in [("v1.2", "1.0"), ("1.1.0", "1.1"), ("2.0", "1.2"), ("1", "1.0"), ("", "1.0")] {
        let (_, run) = import(&of_version(version, &pendulum("", BODY)), &[]);
        let warning =
            format!("warning: robot.urdf:1: unknown URDF version `{version}`: the file is read as version {read_as}");
        assert!(run.stderr.contains(&warning), "{version}: {}", run.stderr);
    }
    for version in ["1.0", "1.1", " 1.2 "] {
        let (_, run) = import(&of_version(version, &pendulum("", BODY)), &[]);
        assert!(!run.stderr.contains("version"), "{version}: {}", run.stderr);
    }
}
