//! The source file that redysim prints is Rust, and the same mechanism as the macro's.

use super::operation_counts::Gripper;

mod printed {
    include!("../generated/gripper.rs");
}

#[test]
fn the_printed_source_computes_the_same_bits_as_the_macro() {
    let (q, v, a) = ([0.3, -0.8, 1.1, 2.0], [1.0, -2.0, 0.5, 3.0], [0.7, 0.1, -4.0, 2.0]);
    assert_eq!(printed::Gripper::inverse_dynamics(&q, &v, &a), Gripper::inverse_dynamics(&q, &v, &a));
    assert_eq!(printed::Gripper::forward_dynamics(&q, &v, &a), Gripper::forward_dynamics(&q, &v, &a));
    assert_eq!(printed::Gripper::link_kinematics(&q, &v), Gripper::link_kinematics(&q, &v));
    assert_eq!(printed::Gripper::OPS, Gripper::OPS);
}
