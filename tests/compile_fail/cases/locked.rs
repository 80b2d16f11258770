//! A lock that cannot be is shown where it is asked for.

redysim::redysim! {
    pub struct NoSuchJoint("../../../models/gripper.toml", locked = { joint5 = "10 deg", joint2 = "20 degrees" });
}

redysim::redysim! {
    pub struct Twice("../../../models/gripper.toml", locked = { joint2 = 0.1, link2 = 0.2 }, functions = [energy]);
}

redysim::redysim! {
    pub struct Stiff("../../../models/fourbar.toml", locked = { crank = 0.3, rocker = 0.2, coupler = -1.0 });
}

redysim::redysim! {
    pub struct NoValue("../../../models/gripper.toml", locked = { joint2 });
}

fn main() {
    let _ = Twice::energy(&[0.0_f64; 3], &[0.0; 3]);
}
