//! A model that is not there.

redysim::redysim! {
    pub struct Robot("../../models/kr6.toml");
}

fn main() {}
