//! A warning beside a fault stays a warning, and a name that generated code needs is refused.

redysim::redysim! {
    pub struct Robot("../../../models/fail/fault_and_warning.toml");
}

redysim::redysim! {
    pub struct S("../../../models/gripper.toml");
}

fn main() {}
