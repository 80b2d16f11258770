//! The mechanisms that tests run on, compiled and generic.

use redysim::generic::{GenericMechanism, Model};
use redysim::redysim;

redysim! {
    /// Six joints in a row.
    pub struct Kr5("models/kr5.toml");
}

redysim! {
    /// The same robot, described by origins and axes.
    pub struct Kr5OriginAxis("models/test/kr5_origin_axis.toml");
}

redysim! {
    /// KR5 with rotors, damping, friction and a spring.
    pub struct Kr5Drives("models/kr5_drives.toml");
}

redysim! {
    /// Two fingers in the plane.
    pub struct Gripper("models/gripper.toml");
}

redysim! {
    /// Prismatic, fixed and oblique joints, branching, in scrambled order.
    pub struct Gantry("models/test/gantry.toml");
}

/// The mechanism of `models/<name>.toml` on the generic path.
pub fn generic(name: &str) -> GenericMechanism {
    let path = format!("{}/models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    GenericMechanism::new(Model::load(path).expect("a good model").model)
}
