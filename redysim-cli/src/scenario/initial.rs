//! Where a mechanism starts.

use std::ops::Range;

use redysim_toml::{Reader, Spanned};

use super::chosen::chosen;
use super::joints::{Quantity, values};
use super::keys;
use super::subject::{Subject, given, neutral};

/// A start.
pub struct Initial {
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    /// The place of `v` in the scenario, if it is there.
    pub place_of_v: Range<usize>,
    /// Whether closed loops are closed from there.
    pub assemble: bool,
    /// The velocities along which nothing moves while loops are closed.
    pub held: Vec<usize>,
    /// Whether the scenario names these.
    names_held: bool,
}

impl Initial {
    /// Reads the table `initial`; without one, the mechanism rests in its neutral position.
    pub fn read(reader: &mut Reader<'_, '_>, subject: &Subject<'_>) -> Option<Initial> {
        let (layout, actuated) = (subject.layout, subject.actuated());
        let rest = || (neutral(&layout.coordinates), neutral(&layout.velocities));
        let field = reader.table(&keys::INITIAL, |mut reader| {
            let q = values(&mut reader, &keys::Q, Quantity::Coordinate, layout, &all(layout.nq()));
            let q = q.value_or(rest().0);
            let v = values(&mut reader, &keys::V, Quantity::Rate, layout, &all(layout.nv()));
            let (v, place_of_v) = (v.value_or(rest().1), v.spanned().map_or(0..0, Spanned::span));
            let assemble = reader.flag(&keys::ASSEMBLE);
            subject.expect_loops(&mut reader, "initial.assemble", &assemble);
            let held = chosen(&mut reader, &keys::HELD, layout);
            subject.expect_loops(&mut reader, "initial.held", &held);
            let names_held = !held.is_missing();
            let (assemble, held) = (assemble.value_or(true), held.value_or(actuated.clone()));
            Some(Initial { q: q?, v: v?, place_of_v, assemble: assemble?, held: held?, names_held })
        });
        match given(field)? {
            Some(initial) => Some(initial),
            None => {
                let (q, v) = rest();
                Some(Initial { q, v, place_of_v: 0..0, assemble: true, held: actuated, names_held: false })
            }
        }
    }
}

impl Initial {
    /// Holds `velocities` as well, or in the place of the actuated ones, which are only the default.
    pub fn hold(&mut self, velocities: &[usize]) {
        if !self.names_held {
            self.held.clear();
        }
        let new: Vec<usize> = velocities.iter().copied().filter(|velocity| !self.held.contains(velocity)).collect();
        self.held.extend(new);
    }
}

fn all(count: usize) -> Vec<usize> {
    (0..count).collect()
}

#[cfg(test)]
mod tests {
    use super::super::subject::tests::with_free_base;
    use super::*;

    /// Reads `initial` of a scenario of a free joint `base` and a revolute joint `arm`.
    fn read(text: &str) -> Initial {
        let read = |mut reader: Reader<'_, '_>| with_free_base(|subject| Initial::read(&mut reader, subject));
        redysim_toml::read(text.to_owned(), "scenario.toml", &keys::SCENARIO, "the scenario", read).unwrap().0
    }

    #[test]
    fn a_start_that_is_not_given_is_the_neutral_position_at_rest() {
        for text in ["", "initial = {}"] {
            let Initial { q, v, .. } = read(text);
            assert_eq!(q, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0], "{text:?}");
            assert_eq!(v, [0.0; 7], "{text:?}");
        }
    }

    #[test]
    fn coordinates_that_are_not_named_are_those_of_the_neutral_position() {
        let Initial { q, v, .. } = read("initial = { q = { arm = 0.5 }, v = { \"base.wz\" = 2.0 } }");
        assert_eq!(q, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.5]);
        assert_eq!(v, [0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0]);
    }
}
