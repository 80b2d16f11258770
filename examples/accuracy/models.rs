//! The mechanisms of the study.

use redysim::redysim;

redysim! {
    /// Six joints in a row.
    pub struct Kr5("models/kr5.toml");
}

redysim! {
    /// Two fingers on a common first link.
    pub struct Gripper("models/gripper.toml");
}

redysim! {
    /// Crank, rocker and coupler.
    pub struct Fourbar("models/fourbar.toml");
}

redysim! {
    /// Two rods, one hung from the other.
    pub struct DoublePendulum("models/double_pendulum.toml");
}

/// Joints of KR5.
pub const DOF: usize = Kr5::NV;
