//! One typo in the model is one error, though the type is used, and by other sizes than the file seems to have.

redysim::redysim! {
    pub struct Robot("../../../models/fail/unknown_key.toml");
}

fn main() {
    let _: [f64; 2] = Robot::inverse_dynamics(&[0.0; 2], &[0.0; 2], &[0.0; 2]);
    let _: [f64; 3] = Robot::gravity_forces(&[0.0; 3]);
    let _ = Robot::link_kinematics(&[0.0_f64; 2], &[0.0; 2]);
    println!("{} {} {}", Robot::NAME, Robot::NV, Robot::OPS.inverse_dynamics.flops());
}
