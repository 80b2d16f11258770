//! Closed loops with redundant rows, of which the compiler warns.
#![allow(deprecated, reason = "their redundant rows are what is tested")]

use redysim::redysim;

redysim! {
    /// The paper's four-bar, oblique in space.
    pub struct FourbarSpatial("models/test/fourbar_spatial.toml");
}

redysim! {
    /// In space, with rows that align axes: five of rank four, of which the fifth follows from the others only where the
    /// loop is closed.
    pub struct Bricard("models/test/bricard.toml");
}
