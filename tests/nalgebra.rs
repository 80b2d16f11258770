//! The functions over nalgebra's types are those over arrays.

use nalgebra::{SVector, Vector3, Vector6};
use redysim::nalgebra as dynamics;
use redysim::redysim;

redysim! { struct Kr5("models/kr5.toml"); }
redysim! { struct Kr5Drives("models/kr5_drives.toml"); }
redysim! { struct Fourbar("models/fourbar.toml"); }

const Q: [f64; 6] = [0.3, -0.7, 1.1, 0.2, -0.9, 2.0];
const V: [f64; 6] = [1.0, -2.0, 0.5, 3.0, -1.5, 0.7];
const A: [f64; 6] = [-4.0, 2.0, 1.0, 5.0, -3.0, 8.0];

fn state() -> [Vector6<f64>; 3] {
    [Q, V, A].map(Vector6::from)
}

#[test]
fn vectors_and_matrices_hold_the_numbers_of_the_arrays() {
    let [q, v, a] = state();
    let tau = dynamics::inverse_dynamics(&Kr5, &q, &v, &a);
    assert_eq!(tau, Vector6::from(Kr5::inverse_dynamics(&Q, &V, &A)));
    let torques: [f64; 6] = tau.into();
    assert_eq!(dynamics::forward_dynamics(&Kr5, &q, &v, &tau), Vector6::from(Kr5::forward_dynamics(&Q, &V, &torques)));
    assert_eq!(dynamics::bias_forces(&Kr5, &q, &v), Vector6::from(Kr5::bias_forces(&Q, &V)));
    assert_eq!(dynamics::gravity_forces(&Kr5, &q), Vector6::from(Kr5::gravity_forces(&Q)));
    let passive = dynamics::passive_forces(&Kr5Drives, &q, &v);
    assert!(passive == Vector6::from(Kr5Drives::passive_forces(&Q, &V)) && passive.norm() > 1.0);
    assert_eq!(dynamics::energy(&Kr5, &q, &v), Kr5::energy(&Q, &V));
    let (matrix, rows) = (dynamics::mass_matrix(&Kr5, &q), Kr5::mass_matrix(&Q));
    assert!((0..6).all(|i| (0..6).all(|j| matrix[(i, j)] == rows[i][j])));
    let (coriolis, rows) = (dynamics::coriolis_matrix(&Kr5, &q, &v), Kr5::coriolis_matrix(&Q, &V));
    assert!((0..6).all(|i| (0..6).all(|j| coriolis[(i, j)] == rows[i][j])));
    let residual = matrix * a + dynamics::bias_forces(&Kr5, &q, &v) - tau;
    assert!(residual.norm() < 1e-13 * tau.norm());
}

#[test]
fn positions_move_by_velocities() {
    let [q, v, _] = state();
    let moved = dynamics::integrate(&Kr5, &q, &v);
    assert_eq!(moved, q + v);
    assert!((dynamics::difference(&Kr5, &q, &moved) - v).norm() < 1e-15);
    assert_eq!(dynamics::coordinate_rates(&Kr5, &q, &v), v);
    assert_eq!(dynamics::neutral::<f64, _, 6>(&Kr5), Vector6::zeros());
}

/// The pose takes the origin, the axes and the velocities of points of a link to the base frame.
#[test]
fn the_pose_of_a_link_is_its_origin_and_rotation() {
    let [q, v, _] = state();
    let links = dynamics::link_kinematics(&Kr5, &q, &v);
    for (link, state) in links.iter().zip(Kr5::link_kinematics(&Q, &V)) {
        assert_eq!(link.pose.translation.vector, Vector3::from(state.origin));
        for (axis, unit) in [Vector3::x(), Vector3::y(), Vector3::z()].iter().enumerate() {
            let column = Vector3::from(state.rotation.map(|row| row[axis]));
            assert!((link.pose * unit - column).norm() < 1e-15);
        }
        assert_eq!((link.com.coords, link.velocity), (Vector3::from(state.com), Vector3::from(state.velocity)));
        assert_eq!(link.angular_velocity, Vector3::from(state.angular_velocity));
    }
    let center = dynamics::center_of_mass(&Kr5, &q, &v);
    let expected = Kr5::center_of_mass(&Q, &V);
    assert_eq!(
        (center.position.coords, center.velocity),
        (Vector3::from(expected.position), Vector3::from(expected.velocity))
    );
}

#[test]
fn the_jacobian_of_loops_has_a_row_for_each_row_of_the_residual() {
    let (q, v) = ([0.4, 0.9, 4.0], [1.0, -0.3, 0.8]);
    let [at, velocity] = [q, v].map(SVector::<f64, 3>::from);
    let residual = dynamics::loop_residual(&Fourbar, &at);
    assert_eq!(residual, SVector::from(Fourbar::loop_residual(&q)));
    let (jacobian, rows) = (dynamics::loop_jacobian(&Fourbar, &at), Fourbar::loop_jacobian(&q));
    assert!((0..2).all(|i| (0..3).all(|j| jacobian[(i, j)] == rows[i][j])));
    assert_eq!(dynamics::loop_bias(&Fourbar, &at, &velocity), SVector::from(Fourbar::loop_bias(&q, &v)));
    let ahead = dynamics::loop_residual(&Fourbar, &(at + velocity * 1e-7));
    assert!(((ahead - residual) / 1e-7 - jacobian * velocity).norm() < 1e-6);
}
