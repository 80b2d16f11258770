//! The derive says what it needs.

use redysim::Mechanism;

#[derive(Mechanism)]
pub struct NoModel;

#[derive(Mechanism)]
#[mechanism("../../../models/gripper.toml")]
pub struct NotUnit {
    field: f64,
}

#[derive(Mechanism)]
#[mechanism("../../../models/fail/unknown_parent.toml")]
pub struct BadModel;

fn main() {}
