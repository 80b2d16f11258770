//! All faults of a model are found at once.

redysim::redysim! {
    pub struct Robot("../../../models/fail/many_faults.toml");
}

fn main() {}
