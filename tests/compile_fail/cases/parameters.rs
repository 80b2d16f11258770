//! Parameters that name nothing are shown where they stand, a derive cannot have any, and a bad model with parameters
//! has its faults as the only errors.

redysim::redysim! {
    pub struct Misspelt("../../../models/gripper.toml", parameters = ["link1.mas", "lnk2.mass"]);
}

#[derive(redysim::Mechanism)]
#[mechanism("../../../models/gripper.toml", parameters = ["gravity"])]
pub struct Derived;

redysim::redysim! {
    pub struct Loaded("../../../models/fail/bad_unit.toml", parameters = ["gravity"]);
}

fn main() {
    let robot = Loaded::new(&[0.0_f64, 0.0, -9.81]);
    let _: [f64; 2] = robot.inverse_dynamics(&[0.0; 2], &[0.0; 2], &[0.0; 2]);
    let misspelt = Misspelt::new(&[0.4_f64, 0.2]);
    let _: [f64; 4] = misspelt.inverse_dynamics(&[0.0; 4], &[0.0; 4], &[0.0; 4]);
    let _: [f64; 4] = Derived::gravity_forces(&[0.0; 4]);
}
