//! Where a mechanism starts.

use std::ops::Range;

use redysim_toml::{Reader, Spanned};

use super::joints::{Quantity, some, values};
use super::keys;
use super::subject::{Subject, given};

/// A start.
pub struct Initial {
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    /// Where the scenario says so, if it does.
    pub place_of_v: Range<usize>,
    /// Whether closed loops are closed from there.
    pub assemble: bool,
    /// The joints that stay where they are while loops are closed.
    pub held: Vec<usize>,
}

impl Initial {
    /// Reads the table `initial`; without one, all coordinates and velocities are zero.
    pub fn read(reader: &mut Reader<'_, '_>, subject: &Subject<'_>) -> Option<Initial> {
        let (joints, actuated) = (subject.joints, subject.actuated());
        let all: Vec<usize> = (0..joints.len()).collect();
        let rest = || vec![0.0; joints.len()];
        let field = reader.table(&keys::INITIAL, |mut reader| {
            let q = values(&mut reader, &keys::Q, Quantity::Coordinate, joints, &all).value_or(rest());
            let v = values(&mut reader, &keys::V, Quantity::Rate, joints, &all);
            let (v, place_of_v) = (v.value_or(rest()), v.spanned().map_or(0..0, Spanned::span));
            let assemble = reader.flag(&keys::ASSEMBLE);
            subject.expect_loops(&mut reader, "initial.assemble", &assemble);
            let held = some(&mut reader, &keys::HELD, joints);
            subject.expect_loops(&mut reader, "initial.held", &held);
            let (assemble, held) = (assemble.value_or(true), held.value_or(actuated.clone()));
            Some(Initial { q: q?, v: v?, place_of_v, assemble: assemble?, held: held? })
        });
        match given(field)? {
            Some(initial) => Some(initial),
            None => Some(Initial { q: rest(), v: rest(), place_of_v: 0..0, assemble: true, held: actuated }),
        }
    }
}
