//! What is asked of a model has its faults shown where they stand, and what is not asked for is not there.

redysim::redysim! {
    pub struct Misspelt("../../../models/gripper.toml", functions = [inverse_dynamics, mass_matrx]);
}

redysim::redysim! {
    pub struct NoLoops("../../../models/gripper.toml", functions = [loop_bias]);
}

#[derive(redysim::Mechanism)]
#[mechanism("../../../models/gripper.toml", function = [energy])]
pub struct MisspeltKey;

redysim::redysim! {
    /// Of a bad model: its faults are the only errors.
    pub struct Few("../../../models/fail/bad_unit.toml", functions = [inverse_dynamics, energy]);
}

fn main() {
    let _: [f64; 2] = Few::inverse_dynamics(&[0.0; 2], &[0.0; 2], &[0.0; 2]);
    let _ = Few::energy(&[0.0_f64; 2], &[0.0; 2]);
}
