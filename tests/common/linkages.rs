//! The closed loops that ship with the project, for the tests that go through them all: not a part of `common`, with
//! which every test would compile them.

use redysim::redysim;

redysim! {
    /// The paper's four-bar.
    pub struct Fourbar("models/fourbar.toml");
}

redysim! {
    /// The GUI's four-bar.
    pub struct FourbarGui("models/fourbar_gui.toml");
}

redysim! {
    /// With a prismatic joint at the cut.
    pub struct SliderCrank("models/slider_crank.toml");
}

redysim! {
    /// Two loops, three actuators.
    pub struct ThreeRrr("models/three_rrr.toml");
}

redysim! {
    /// Three loops.
    pub struct Leg("models/leg.toml");
}

redysim! {
    /// Andrews' squeezing mechanism.
    pub struct Andrews("models/andrews.toml");
}

redysim! {
    /// Two windows.
    pub struct NFourbar2("models/n_fourbar_2.toml");
}

redysim! {
    /// In space, with a ball and a universal joint at the cut.
    pub struct BallFourbar("models/ball_fourbar.toml");
}
