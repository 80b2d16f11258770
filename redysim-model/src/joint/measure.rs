//! What coordinates and velocities measure, with their units.

/// What a coordinate measures, or the integral of a velocity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// An angle, rad.
    Angle,
    /// A length, m.
    Length,
    /// A number, as of a unit quaternion.
    Number,
}

impl Measure {
    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Measure::Angle => "rad",
            Measure::Length => "m",
            Measure::Number => "1",
        }
    }

    /// The unit of a force that works along it.
    pub fn unit_of_force(self) -> &'static str {
        match self {
            Measure::Angle => "N m",
            Measure::Length => "N",
            Measure::Number => "J",
        }
    }
}
