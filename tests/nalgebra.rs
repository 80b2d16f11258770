//! The functions over nalgebra's types are those over arrays.

use nalgebra::{Isometry3, SMatrix, SVector, Vector3, Vector5, Vector6};
use redysim::nalgebra::{self as dynamics, OperationalSpace, Wrench};
use redysim::{ConfigurationSpace, OperationalSpaceError, TaskStatus, redysim};

redysim! { struct Kr5("models/kr5.toml"); }
redysim! { struct CartPole("models/cart_pole.toml"); }
redysim! { struct Kr5Drives("models/kr5_drives.toml"); }
redysim! { struct Kr5Tool("models/kr5_tool.toml"); }
redysim! { struct Fourbar("models/fourbar.toml"); }
redysim! { struct Machine("models/test/frames.toml"); }

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
    let lost = dynamics::dissipated_power(&Kr5Drives, &q, &v);
    assert!(lost == Kr5Drives.dissipated_power(&Q, &V) && lost > 1.0);
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

/// The pose takes the origin and the axes of its frame to where the arrays have them.
fn assert_pose(pose: &Isometry3<f64>, origin: [f64; 3], rotation: [[f64; 3]; 3]) {
    assert_eq!(pose.translation.vector, Vector3::from(origin));
    for (axis, unit) in [Vector3::x(), Vector3::y(), Vector3::z()].iter().enumerate() {
        let column = Vector3::from(rotation.map(|row| row[axis]));
        assert!((pose * unit - column).norm() < 1e-15);
    }
}

#[test]
fn the_pose_of_a_link_is_its_origin_and_rotation() {
    let [q, v, _] = state();
    let links = dynamics::link_kinematics(&Kr5, &q, &v);
    for (link, state) in links.iter().zip(Kr5::link_kinematics(&Q, &V)) {
        assert_pose(&link.pose, state.origin, state.rotation);
        assert_eq!((link.com.coords, link.velocity), (Vector3::from(state.com), Vector3::from(state.velocity)));
        assert_eq!(link.angular_velocity, Vector3::from(state.angular_velocity));
    }
    let center = dynamics::center_of_mass(&Kr5, &q, &v);
    let expected = Kr5::center_of_mass(&Q, &V);
    assert_eq!(
        (center.position.coords, center.velocity),
        (Vector3::from(expected.position), Vector3::from(expected.velocity))
    );
    let momentum = dynamics::momentum(&Kr5, &q, &v);
    let expected = Kr5::momentum(&Q, &V);
    assert_eq!((momentum.linear, momentum.angular), (Vector3::from(expected.linear), Vector3::from(expected.angular)));
}

#[test]
fn hybrid_dynamics_has_vectors_of_accelerations_and_forces() {
    let [q, v, u] = [[0.3, 0.4], [0.8, -1.7], [3.0, 0.0]];
    let [at, velocity, given] = [q, v, u].map(SVector::<f64, 2>::from);
    let motion = dynamics::hybrid_dynamics(&CartPole, &at, &velocity, &given);
    let expected = CartPole::hybrid_dynamics(&q, &v, &u);
    assert_eq!((motion.a, motion.tau), (SVector::from(expected.a), SVector::from(expected.tau)));
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

/// Coordinates and velocities of the machine.
const AT: [f64; 5] = [0.4, -0.8, 2.0, 0.5, -2.5];
const MOVING: [f64; 5] = [0.3, 1.2, -0.7, 2.0, 0.9];

#[test]
fn a_frame_moves_at_the_velocities_that_its_jacobian_gives() {
    let (q, v) = (Vector5::from(AT), Vector5::from(MOVING));
    let frames = dynamics::frame_kinematics(&Machine, &q, &v);
    let jacobians = dynamics::frame_jacobians(&Machine, &q);
    let states = Machine::frame_kinematics(&AT, &MOVING);
    for ((frame, jacobian), state) in frames.iter().zip(jacobians).zip(states) {
        assert_pose(&frame.pose, state.origin, state.rotation);
        assert_eq!(frame.velocity, Vector3::from(state.velocity));
        assert_eq!(frame.angular_velocity, Vector3::from(state.angular_velocity));
        // Sums of five products of numbers below ten.
        assert!((jacobian * v - frame.twist()).norm() < 1e-14, "{jacobian} {frame:?}");
        assert_eq!(frame.twist().fixed_rows::<3>(0), frame.velocity);
    }
    assert!(frames[0].velocity.norm() > 0.1 && frames[0].angular_velocity.norm() > 0.1);
}

#[test]
fn the_bias_of_a_frame_is_its_acceleration_at_constant_joint_velocities() {
    let (q, v) = (Vector5::from(AT), Vector5::from(MOVING));
    let twists = |q: Vector5<f64>| dynamics::frame_kinematics(&Machine, &q, &v).map(|frame| frame.twist());
    let step = 1e-5;
    let (before, after) = (twists(q - v * step), twists(q + v * step));
    let bias = dynamics::frame_bias(&Machine, &q, &v);
    for ((before, after), bias) in before.iter().zip(&after).zip(&bias) {
        // Accelerations of some ten m/s²; roundoff of a twist over the step, 1e-10, is more than what is truncated.
        assert!(((after - before) / (2.0 * step) - bias).norm() < 1e-8, "{bias}");
    }
    assert!(bias[0].fixed_rows::<3>(0).norm() > 0.1 && bias[0].fixed_rows::<3>(3).norm() > 0.1);
}

#[test]
fn the_joint_forces_of_wrenches_are_those_of_transposed_jacobians() {
    let q = Vector5::from(AT);
    let wrenches = [0.0, 1.0, 2.0, 3.0, 4.0]
        .map(|k| Wrench { force: Vector3::new(5.0 - k, 2.0 * k, -3.0), moment: Vector3::new(0.5, -k, 0.1 * k) });
    let jacobians = dynamics::frame_jacobians(&Machine, &q);
    let sum: Vector5<f64> = jacobians.iter().zip(wrenches).map(|(j, wrench)| j.tr_mul(&Vector6::from(wrench))).sum();
    let found = dynamics::frame_forces(&Machine, &q, &wrenches);
    assert!((found - sum).norm() < 1e-14 * sum.norm(), "{found} instead of {sum}");
    let vector = Vector6::from(wrenches[1]);
    assert_eq!((vector, Wrench::from(vector)), (Vector6::new(4.0, 2.0, -3.0, 0.5, -1.0, 0.1), wrenches[1]));
}

/// The mass matrix of the robot with a tool, and the Jacobian of the tool.
fn tool(q: &Vector6<f64>) -> (SMatrix<f64, 6, 6>, SMatrix<f64, 6, 6>) {
    let [jacobian] = dynamics::frame_jacobians(&Kr5Tool, q);
    (dynamics::mass_matrix(&Kr5Tool, q), jacobian)
}

/// `found` and `expected` differ by roundoff of well-conditioned solves.
fn close<const R: usize, const C: usize>(what: &str, found: SMatrix<f64, R, C>, expected: SMatrix<f64, R, C>) {
    let scale = expected.amax().max(1.0);
    assert!((found - expected).amax() < 1e-12 * scale, "{what}: {found} instead of {expected}");
}

/// M⁻¹ Jᵀ and J M⁻¹ Jᵀ by nalgebra's Cholesky decomposition, which shares nothing with the runtime's.
#[test]
fn the_operational_space_of_a_tip_is_that_of_a_cholesky_decomposition() {
    let [q, v, a] = state();
    let (m, jacobian) = tool(&q);
    let j = jacobian.fixed_rows::<3>(0).into_owned();
    let decomposed = m.cholesky().expect("a mass matrix is positive definite");
    let mobility = j * decomposed.solve(&j.transpose());
    let inertia = mobility.cholesky().expect("the tip moves in all directions").inverse();
    let inverse = decomposed.solve(&j.transpose()) * inertia;
    let projector = SMatrix::<f64, 6, 6>::identity() - inverse * j;
    let task = OperationalSpace::new(&m, &j).expect("a good position");
    assert_eq!((task.rank(), task.status()), (3, TaskStatus::Full));
    close("Λ", task.inertia(), inertia);
    close("Λ⁻¹", task.inertia().cholesky().expect("positive definite").inverse(), mobility);
    close("J̄", task.inverse(), inverse);
    close("N", task.projector(), projector);
    let x = Vector3::new(0.3, -1.0, 0.7);
    close("Λ ẍ", task.force_of_acceleration(&x), inertia * x);
    close("J̄ ẋ", task.joint_velocity(&x), inverse * x);
    close("J̄ᵀ τ", task.task_force(&a), inverse.transpose() * a);
    close("Jᵀ f", task.joint_force(&x), j.transpose() * x);
    close("J v", task.task_velocity(&v), j * v);
    close("N v", task.null_velocity(&v), projector * v);
    close("Nᵀ τ", task.null_force(&a), projector.transpose() * a);
    close("J J̄ ẋ", task.attainable(&x), x);
}

#[test]
fn the_operational_space_reads_the_lower_triangle_of_the_mass_matrix() {
    let (m, j) = tool(&Vector6::from(Q));
    let [whole, lower] = [m, m.lower_triangle()].map(|m| OperationalSpace::new(&m, &j).expect("a good position"));
    assert_eq!(whole.inertia(), lower.inertia());
}

/// With joint 5 straight, axes 4 and 6 are one line: the wrist is singular.
#[test]
fn a_singular_wrist_leaves_the_inertia_of_the_directions_that_are_attainable() {
    let (m, j) = tool(&Vector6::new(0.3, -0.7, 1.1, 0.2, 0.0, 0.5));
    let task = OperationalSpace::new(&m, &j).expect("any rank is good");
    let TaskStatus::Deficient { rank, rows } = task.status() else { panic!("{:?}", task.status()) };
    assert_eq!((task.rank(), rank, rows.iter().count()), (5, 5, 1));
    let mobility = j * m.cholesky().expect("a mass matrix is positive definite").solve(&j.transpose());
    let inertia = task.inertia();
    close("A Λ A", mobility * inertia * mobility, mobility);
    close("J N", j * task.projector(), SMatrix::zeros());
    let coarse = OperationalSpace::with_tolerance(&m, &j, 0.9).expect("any rank is good");
    assert!(coarse.rank() < 5, "{}", coarse.rank());
}

#[test]
fn a_task_without_positive_inertia_or_with_a_jacobian_that_is_not_finite_is_refused() {
    let (m, j) = tool(&Vector6::from(Q));
    let error = |m, j| OperationalSpace::new(&m, &j).err();
    let (mut singular, mut lost) = (m, j);
    (singular[(4, 4)], lost[(2, 3)]) = (0.0, f64::NAN);
    assert_eq!(error(singular, j), Some(OperationalSpaceError::SingularInertia { velocity: 4 }));
    assert_eq!(error(m, lost), Some(OperationalSpaceError::NotFinite));
}
