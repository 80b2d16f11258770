//! What came with later versions of URDF: quaternions with 1.1, limits that are infinite unless given with 1.2.

use super::faults::{BODY, refused};
use super::{close, import, pendulum};
use redysim_model::JointRange;
use redysim_runtime::MassMatrix;

fn of_version(version: &str, urdf: &str) -> String {
    urdf.replace("<robot", &format!("<robot version=\"{version}\""))
}

/// Half the angle, of a length that is not 1.
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

#[test]
fn a_quaternion_that_is_zero_beside_angles_or_of_an_early_version_is_refused() {
    let with = |version: &str, origin: &str| {
        of_version(version, &pendulum(&format!("\n<origin {origin}/>"), BODY).replace("</joint>", "\n</joint>"))
    };
    let fault = "robot.urdf:2: joint `hinge`: `quat_xyzw` of its <origin>";
    refused(&with("1.0", &about_x(1.0)), &[fault, "is of URDF 1.1", "version=\"1.1\""]);
    refused(&with("1.1", "quat_xyzw=\"0 0 0 0\""), &[fault, "is zero", "\"0 0 0 1\""]);
    refused(&with("1.1", &format!("rpy=\"0 0 0\" {}", about_x(1.0))), &[fault, "stands beside `rpy`"]);
    refused(&with("1.1", "quat_xyzw=\"0 0 1\""), &[fault, "must be 4 finite numbers, found \"0 0 1\""]);
}

/// Before 1.2 a position that is not given is zero.
#[test]
fn a_limit_that_is_not_given_is_infinite_from_version_1_2_on() {
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
