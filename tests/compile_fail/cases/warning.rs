//! Warnings of a model reach the person who compiles, as a lint that can be denied or allowed.
#![deny(deprecated)]

redysim::redysim! {
    pub struct Shown("../../../models/kr5_table2.toml");
}

redysim::redysim! {
    #[allow(deprecated)]
    pub struct Accepted("../../../models/kr5_table2.toml");
}

redysim::redysim! {
    pub struct OtherRobot("../../../models/warn/standard_rows.toml");
}

redysim::redysim! {
    #[allow(deprecated)]
    pub struct AcceptedRobot("../../../models/warn/standard_rows.toml");
}

fn main() {}
