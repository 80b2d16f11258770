//! The mechanisms that tests run on, compiled.
#![allow(dead_code, reason = "each test uses a part")]

use redysim::redysim;

redysim! {
    /// Six joints in a row.
    pub struct Kr5("models/kr5.toml");
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
