//! How far joints may move in a run: what numbers of 64 bits resolve, and what loops can be followed over.

use redysim_runtime::{Motion, Trajectory};
use redysim_toml::{MOST_ANGLE, Message, Reader};

use super::initial::Initial;
use super::resolution::unresolved;
use super::span::Span;
use super::subject::{Dynamics, Subject};
use super::trajectory::Prescribed;
use crate::layout::Component;

/// The farthest that a prescribed joint of closed loops moves from row to row, rad or m: `ClosedLoopInverse` closes the
/// loops at every 0.1 rad or m of the way, but no more than 10,000 times, and beyond that leaves the branch unnoticed.
const MOST_MOVE: f64 = 1e3;

/// Fails where a joint starts so fast that it would turn farther in `span` than angles are resolved.
pub fn check_start(reader: &mut Reader<'_, '_>, subject: &Subject<'_>, initial: &Initial, span: Span) -> Option<()> {
    let length = span.length();
    let too_fast = |(component, v): &(&Component, &f64)| component.turns() && v.abs() * length > MOST_ANGLE;
    let Some((component, v)) = subject.layout.velocities.iter().zip(&initial.v).find(too_fast) else { return Some(()) };
    let title = format!(
        "{}: the joint `{}` starts with {v:?} rad/s and would turn by {:.1e} rad in the {length:?} s of the run; an \
         angle is at most {MOST_ANGLE:e} rad",
        reader.item(),
        component.name,
        v.abs() * length
    );
    let help = unresolved("start more slowly, or end earlier");
    reader.error_at(initial.place_of_v.clone(), Message { title, label: "too fast for this run".into(), help })
}

/// Fails where a prescribed motion is not finite within `span`, or farther than angles are resolved or loops are
/// followed.
pub fn check_motion(
    reader: &mut Reader<'_, '_>,
    subject: &Subject<'_>,
    initial: &Initial,
    (prescribed, span): (&Prescribed, Span),
) -> Option<()> {
    let followed = subject.loops() && subject.dynamics == Dynamics::Inverse;
    let layout = subject.layout;
    let mut before: Vec<f64> = prescribed.coordinates.iter().map(|&coordinate| initial.q[coordinate]).collect();
    for t in (0..span.count()).map(|k| span.instant(k)) {
        let Motion { q, v, a } = prescribed.at(t);
        let coordinates = prescribed.coordinates.iter().map(|&index| &layout.coordinates[index]);
        let velocities = prescribed.velocities.iter().map(|&index| &layout.velocities[index]);
        let item = reader.item();
        let mut motion = coordinates.clone().zip(&q).chain(velocities.clone().zip(&v)).chain(velocities.zip(&a));
        let fault = motion.find(|(_, value)| !value.is_finite()).map(|(component, _)| {
            let title = format!(
                "{item}: the motion of the joint `{}` is infinite or not a number at t = {t:?} s",
                component.name
            );
            (title, "prescribe a slower motion; times are in s".to_owned())
        });
        let fault = fault.or_else(|| {
            coordinates.zip(q.iter().zip(&before)).find_map(|(coordinate, (&q, &before))| {
                let way = (q - before).abs();
                let leaves_branch = followed && way > MOST_MOVE;
                too_far(item, coordinate, (t, q))
                    .or_else(|| leaves_branch.then(|| too_fast(item, coordinate, (t, way))))
            })
        });
        if let Some((title, help)) = fault {
            return reader.error_at(prescribed.place.clone(), Message::new(title, "too fast or too far", help));
        }
        before = q;
    }
    Some(())
}

/// Why a coordinate may not be `q` at `t`, and what to do, if it is an angle that is not resolved.
fn too_far(item: &str, coordinate: &Component, (t, q): (f64, f64)) -> Option<(String, String)> {
    (coordinate.turns() && q.abs() > MOST_ANGLE).then(|| {
        let title = format!(
            "{item}: the joint `{}` is prescribed to be at {q:.1e} rad at t = {t:?} s, and an angle is at most \
             {MOST_ANGLE:e} rad",
            coordinate.name
        );
        (title, unresolved("prescribe a slower motion (speeds are in rad/s), or end earlier"))
    })
}

/// Why a coordinate of closed loops may not move by `way` up to `t`, and what to do.
fn too_fast(item: &str, coordinate: &Component, (t, way): (f64, f64)) -> (String, String) {
    let (name, unit) = (&coordinate.name, coordinate.unit());
    let title = format!(
        "{item}: the joint `{name}` is prescribed to move by {way:.1e} {unit} up to t = {t:?} s, and closed loops are \
         followed over {MOST_MOVE:?} {unit} from one row to the next"
    );
    let help = format!(
        "prescribe a slower motion (speeds are in {unit}/s), give `inverse` a smaller `step`, or begin with \
         `initial.q` nearer"
    );
    (title, help)
}
