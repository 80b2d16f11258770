//! Lints: what a model may have, but is rarely meant.

use redysim_toml::{LARGE_ANGLE, ROUNDED_ANGLE};
use std::fmt;

/// What a model may have, but is rarely meant. A model file lists the lints that are not reported, as in
/// `allow = ["gravity-up"]`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Lint {
    /// A plain number is an angle of more than a turn.
    AngleUnits,
    /// A plain number is nearly, but not exactly, a multiple of 90 deg.
    RoundedAngle,
    /// The range of a joint that turns goes beyond 50 rad.
    RangeUnits,
    /// A length or a centre of mass is as if in millimetres, of one link, of one spring or of all.
    LengthUnits,
    /// The heaviest link on a joint that moves has more than 1e5 times the mass of the lightest.
    MassUnits,
    /// A link's mass and inertia are those of no body of the mechanism's size, or of none that is less dense than tungsten.
    RadiusOfGyration,
    /// A principal moment of inertia exceeds the sum of the other two.
    InertiaTriangle,
    /// A principal moment of inertia of a link is slightly negative, but none of the rigid body that the link is part of.
    NegativeMoment,
    /// A heavy link has no inertia, but others have.
    MissingInertia,
    /// Gravity is as if in mm/s², ft/s² or km/s².
    GravityUnits,
    /// Gravity points up, along y or z.
    GravityUp,
    /// Denavit-Hartenberg parameters look like those of the other convention.
    DhConvention,
    /// The ends of a spring stay at one distance.
    SpringWithoutEffect,
    /// The ends of a spring with a free length coincide where all coordinates are zero.
    SpringDirection,
    /// The loops could not be closed.
    LoopOpen,
    /// The constraints of a loop hold at every position.
    LoopWithoutConstraints,
    /// Constraints of loops follow from others.
    RedundantConstraints,
    /// The loops leave nothing that moves.
    NoMobility,
    /// There are more actuated joints than the mobility.
    OverActuated,
    /// Gravity is zero.
    NoGravity,
    /// Gravity is not Earth's.
    OtherGravity,
    /// No link has an inertia.
    PointMasses,
    /// There are fewer actuated joints than the mobility.
    UnderActuated,
}

impl Lint {
    /// Every lint.
    pub const ALL: [Lint; 23] = [
        Lint::AngleUnits,
        Lint::RoundedAngle,
        Lint::RangeUnits,
        Lint::LengthUnits,
        Lint::MassUnits,
        Lint::RadiusOfGyration,
        Lint::InertiaTriangle,
        Lint::NegativeMoment,
        Lint::MissingInertia,
        Lint::GravityUnits,
        Lint::GravityUp,
        Lint::DhConvention,
        Lint::SpringWithoutEffect,
        Lint::SpringDirection,
        Lint::LoopOpen,
        Lint::LoopWithoutConstraints,
        Lint::RedundantConstraints,
        Lint::NoMobility,
        Lint::OverActuated,
        Lint::NoGravity,
        Lint::OtherGravity,
        Lint::PointMasses,
        Lint::UnderActuated,
    ];

    /// Its name in messages and in `allow`.
    pub const fn name(self) -> &'static str {
        match self {
            Lint::AngleUnits => LARGE_ANGLE,
            Lint::RoundedAngle => ROUNDED_ANGLE,
            Lint::RangeUnits => "range-units",
            Lint::LengthUnits => "length-units",
            Lint::MassUnits => "mass-units",
            Lint::RadiusOfGyration => "radius-of-gyration",
            Lint::InertiaTriangle => "inertia-triangle",
            Lint::NegativeMoment => "negative-moment",
            Lint::MissingInertia => "missing-inertia",
            Lint::GravityUnits => "gravity-units",
            Lint::GravityUp => "gravity-up",
            Lint::DhConvention => "dh-convention",
            Lint::SpringWithoutEffect => "spring-without-effect",
            Lint::SpringDirection => "spring-direction",
            Lint::LoopOpen => "loop-open",
            Lint::LoopWithoutConstraints => "loop-without-constraints",
            Lint::RedundantConstraints => "redundant-constraints",
            Lint::NoMobility => "no-mobility",
            Lint::OverActuated => "over-actuated",
            Lint::NoGravity => "no-gravity",
            Lint::OtherGravity => "other-gravity",
            Lint::PointMasses => "point-masses",
            Lint::UnderActuated => "under-actuated",
        }
    }

    /// What it reports.
    pub const fn summary(self) -> &'static str {
        match self {
            Lint::AngleUnits => "a plain number is an angle of more than a turn: degrees?",
            Lint::RoundedAngle => "a plain number is nearly, but not exactly, a multiple of 90 deg",
            Lint::RangeUnits => "the range of a joint that turns goes beyond 50 rad: degrees?",
            Lint::LengthUnits => {
                "a length or a centre of mass is as if in millimetres, of one link, of one spring or of all"
            }
            Lint::MassUnits => {
                "the heaviest link on a joint that moves has more than 1e5 times the mass of the lightest, or an arm is heavier \
                 than solid steel: kg and g?"
            }
            Lint::RadiusOfGyration => {
                "mass and inertia of a link are those of a body larger or smaller than the mechanism can have, far larger than \
                 the link, or denser than matter"
            }
            Lint::InertiaTriangle => "a principal moment of inertia exceeds the sum of the other two",
            Lint::NegativeMoment => {
                "a principal moment of inertia of a link is negative, but the link never moves, or is fixed to others with \
                 which it is a possible body, beside which it is small"
            }
            Lint::MissingInertia => "a heavy link has no inertia, but others have",
            Lint::GravityUnits => "gravity is as if in mm/s², ft/s² or km/s²",
            Lint::GravityUp => "gravity points up, along y or z",
            Lint::DhConvention => {
                "the rows under `dh` look like standard (distal) ones, or those under `dh_standard` like Khalil and \
                 Kleinfinger's"
            }
            Lint::SpringWithoutEffect => "the ends of a spring stay at one distance",
            Lint::SpringDirection => {
                "the ends of a spring with a free length coincide where all coordinates are zero: its force has no \
                 direction there"
            }
            Lint::LoopOpen => "the loops could not be closed from any of several starts",
            Lint::LoopWithoutConstraints => "the constraints of a loop hold at every position",
            Lint::RedundantConstraints => "constraints of a loop follow from others",
            Lint::NoMobility => "the loops leave nothing that moves",
            Lint::OverActuated => "more joints are actuated than the mobility",
            Lint::NoGravity => "gravity is zero",
            Lint::OtherGravity => "gravity is not Earth's",
            Lint::PointMasses => "no link has an inertia: all masses are points",
            Lint::UnderActuated => "fewer joints are actuated than the mobility",
        }
    }

    /// Whether it is a choice that people make, which `redysim check` alone notes; others are warnings.
    pub const fn is_note(self) -> bool {
        matches!(self, Lint::NoGravity | Lint::OtherGravity | Lint::PointMasses | Lint::UnderActuated)
    }

    /// The names with what they report, as a table in Markdown.
    pub(crate) fn documentation() -> String {
        let row = |lint: &Lint| {
            let level = if lint.is_note() { "note" } else { "warning" };
            format!("| `{}` | {level} | {} |\n", lint.name(), lint.summary())
        };
        let rows: String = Lint::ALL.iter().map(row).collect();
        format!(
            "Lints report what is rarely meant. Warnings are shown by the compiler and by every subcommand that reads the \
             model, notes by `redysim check` alone. `allow` has the names of those that are not reported:\n\n\
             | lint | level | what it reports |\n|---|---|---|\n{rows}"
        )
    }
}

impl fmt::Display for Lint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::Lint;

    #[test]
    fn each_lint_has_a_name_of_its_own() {
        for (index, lint) in Lint::ALL.iter().enumerate() {
            assert!(Lint::ALL[..index].iter().all(|other| other.name() != lint.name()), "{lint}");
            assert!(lint.name().chars().all(|c| c.is_ascii_lowercase() || c == '-'), "{lint}");
        }
    }
}
