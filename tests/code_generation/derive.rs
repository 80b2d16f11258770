//! `#[derive(Mechanism)]` and `redysim!` are the same code.

use redysim::{InverseDynamics, Mechanism, Operations, redysim};

redysim! {
    /// The gripper, declared by the macro; the path is taken from this file.
    #[derive(Clone, PartialEq, Debug)]
    struct ByMacro("../../models/gripper.toml");
}

/// The gripper, declared here; the path is taken from the package.
#[derive(Mechanism)]
#[mechanism("models/gripper.toml")]
struct ByDerive;

redysim! {
    /// Of a feature that is off: the struct and all that belongs to it are left out.
    #[cfg(any())]
    struct LeftOut("models/there_is_no_such_model.toml");
}

#[test]
fn the_derive_gives_what_the_macro_gives() {
    let (q, v, a) = ([0.3, -0.8, 1.1, 2.0], [1.0, -2.0, 0.5, 3.0], [0.7, 0.1, -4.0, 2.0]);
    assert_eq!(ByDerive::inverse_dynamics(&q, &v, &a), ByMacro::inverse_dynamics(&q, &v, &a));
    assert_eq!(ByDerive.inverse_dynamics(&q, &v, &a), ByMacro.inverse_dynamics(&q, &v, &a));
    assert_eq!((ByDerive::NAME, ByDerive::LINK_NAMES), (ByMacro::NAME, ByMacro::LINK_NAMES));
    let operations: Operations = ByDerive::OPS;
    assert_eq!(operations, ByMacro::OPS);
}

#[test]
fn traits_that_the_declaration_derives_are_left_to_it() {
    assert_eq!(ByMacro, ByMacro.clone());
}

#[test]
fn constants_are_those_of_the_model() {
    assert_eq!(ByMacro::NAME, "gripper");
    assert_eq!((ByMacro::NQ, ByMacro::NV, ByMacro::NL, ByMacro::NC), (4, 4, 4, 0));
    assert_eq!(ByMacro::ACTUATED, [true; 4]);
    assert_eq!(ByMacro.joint_name(3), Some(ByMacro::JOINT_NAMES[3]));
    assert_eq!(ByMacro.link_name(4), None);
}
