//! A tolerance needs ranges, and is a share.

redysim::redysim! {
    pub struct NoRanges("../../models/gripper.toml", tolerance = 1e-3);
}

redysim::redysim! {
    pub struct NoShare("../../models/test/kr5_ranges.toml", tolerance = 2);
}

redysim::redysim! {
    pub struct NotANumber("../../models/test/kr5_ranges.toml", tolerance = small);
}

fn main() {}
