//! The mechanisms of the study.

use redysim::redysim;

redysim! {
    /// Six joints in a row, whose ranges the model states.
    pub struct Kr5("../../models/test/kr5_ranges.toml");
}

/// The same with less than all digits, for its ranges.
pub mod pruned {
    use redysim::redysim;

    macro_rules! kr5 {
        ($($name:ident, $tolerance:literal;)*) => {$(
            redysim! {
                #[doc = concat!("KR5 to ", $tolerance, " of each joint's largest force.")]
                pub struct $name(
                    "../../models/test/kr5_ranges.toml",
                    functions = [inverse_dynamics, forward_dynamics],
                    tolerance = $tolerance,
                );
            }
        )*};
    }
    kr5! {
        To1e6, 1e-6;
        To1e5, 1e-5;
        To1e4, 1e-4;
        To1e3, 1e-3;
        To1e2, 1e-2;
        To1e1, 1e-1;
    }
}

redysim! {
    /// Two fingers on a common first link.
    pub struct Gripper("../../models/gripper.toml");
}

redysim! {
    /// Crank, rocker and coupler.
    pub struct Fourbar("../../models/fourbar.toml");
}

redysim! {
    /// Two rods, one hung from the other.
    pub struct DoublePendulum("../../models/double_pendulum.toml");
}

/// Joints of KR5.
pub const DOF: usize = Kr5::NV;
