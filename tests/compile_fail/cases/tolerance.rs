//! A tolerance needs ranges, is a share, and may not hold: that is a warning.
#![deny(deprecated)]

redysim::redysim! {
    pub struct NoRanges("../../../models/gripper.toml", tolerance = 1e-3);
}

redysim::redysim! {
    pub struct NoShare("../../../models/test/kr5_ranges.toml", tolerance = 2);
}

redysim::redysim! {
    pub struct NotANumber("../../../models/test/kr5_ranges.toml", tolerance = small);
}

redysim::redysim! {
    pub struct TooFast("../../../models/test/too_fast.toml", tolerance = 0.01, functions = [forward_dynamics]);
}

fn main() {}
