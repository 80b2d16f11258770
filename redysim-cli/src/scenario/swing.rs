//! Motions through points that swing far beyond them: smooth ones do, between points of which others are very close in time.

use redysim_runtime::Trajectory;

use super::trajectory::Prescribed;
use crate::layout::Layout;
use crate::number::size;

/// How many times longer than the one beside it an interval is, at least, in which the motion can swing.
const LONGER: f64 = 4.0;
/// Instants of an interval that are looked at.
const INSTANTS: usize = 8;

/// The smallest range that swings are measured by, rad or m, so that noise does not count as a swing.
const SMALLEST_RANGE: f64 = 1e-3;

/// The interval, s, and the coordinate of the widest swing, the value that it reaches, and the range of all points, from which it
/// departs by more than the length of that range.
struct Swing {
    interval: [f64; 2],
    coordinate: usize,
    reached: f64,
    range: [f64; 2],
}

/// What to report of a motion that swings, and what to do.
pub fn of(motion: &Prescribed, layout: &Layout) -> Option<(String, String)> {
    let Swing { interval: [from, to], coordinate, reached, range: [least, largest] } = widest(motion, layout)?;
    let component = &layout.coordinates[motion.coordinates[coordinate]];
    let (name, unit) = (&component.name, component.unit());
    let what = format!(
        "between t = {from:?} s and {to:?} s the trajectory swings to {} {unit} at `{name}`, whose points are all from {} to {} {unit}",
        size(reached),
        size(least),
        size(largest)
    );
    let help = "points that are much closer in time than others make a smooth motion swing: leave some out, or give times that are \
                more even";
    Some((what, help.into()))
}

fn widest(motion: &Prescribed, layout: &Layout) -> Option<Swing> {
    let times = motion.times();
    let length = |k: usize| times[k + 1] - times[k];
    let intervals = times.len().checked_sub(1)?;
    let is_long = |k: usize| {
        let beside = [k.checked_sub(1), (k + 1 < intervals).then_some(k + 1)];
        beside.into_iter().flatten().any(|other| length(k) > LONGER * length(other))
    };
    let long: Vec<usize> = (0..intervals).filter(|&k| is_long(k)).collect();
    if long.is_empty() {
        return None;
    }
    let points: Vec<Vec<f64>> = times.iter().map(|&t| motion.at(t).q).collect();
    let ranges: Vec<[f64; 2]> = (0..motion.coordinates.len())
        .map(|coordinate| {
            let values = points.iter().map(|point| point[coordinate]);
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, largest], q| [least.min(q), largest.max(q)])
        })
        .collect();
    let mut widest: Option<(f64, Swing)> = None;
    for k in long {
        for instant in 1..=INSTANTS {
            let t = times[k] + length(k) * instant as f64 / (INSTANTS + 1) as f64;
            for (coordinate, (&reached, &range)) in motion.at(t).q.iter().zip(&ranges).enumerate() {
                let [least, largest] = range;
                let outside = (least - reached).max(reached - largest) / (largest - least).max(SMALLEST_RANGE);
                // The components of a quaternion do not move from point to point as those of other coordinates.
                let is_length_or_angle = layout.coordinates[motion.coordinates[coordinate]].unit() != "1";
                if is_length_or_angle && outside > widest.as_ref().map_or(1.0, |(most, _)| *most) {
                    let interval = [times[k], times[k + 1]];
                    widest = Some((outside, Swing { interval, coordinate, reached, range }));
                }
            }
        }
    }
    widest.map(|(_, swing)| swing)
}
