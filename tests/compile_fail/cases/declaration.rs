//! The macro says what it needs.

redysim::redysim! {
    pub struct Robot("../../../models/gripper.toml", locked);
}

fn main() {}
