//! How far joints may move in a run: what numbers of 64 bits resolve, and what loops can be followed over.

use redysim_runtime::{Motion, Trajectory};
use redysim_toml::{Message, Reader};

use super::initial::Initial;
use super::joints::Joint;
use super::resolution::{MOST_ANGLE, unresolved};
use super::span::Span;
use super::subject::{Dynamics, Subject};
use super::trajectory::Prescribed;

/// The farthest that a prescribed joint of closed loops moves from row to row, rad or m: `ClosedLoopInverse` closes the
/// loops at every 0.1 rad or m of the way, but no more than 10,000 times, and beyond that leaves the branch unnoticed.
const MOST_MOVE: f64 = 1e3;

/// Fails where a joint starts so fast that it would turn farther in `span` than angles are resolved.
pub fn check_start(reader: &mut Reader<'_, '_>, subject: &Subject<'_>, initial: &Initial, span: Span) -> Option<()> {
    let length = span.length();
    let too_fast = |(joint, v): &(&Joint, &f64)| joint.turns && v.abs() * length > MOST_ANGLE;
    let Some((joint, v)) = subject.joints.iter().zip(&initial.v).find(too_fast) else { return Some(()) };
    let title = format!(
        "{}: the joint `{}` starts with {v:?} rad/s and would turn by {:.1e} rad in the {length:?} s of the run; an angle is \
         at most {MOST_ANGLE:e} rad",
        reader.item(),
        joint.name,
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
    let mut before: Vec<f64> = prescribed.joints.iter().map(|&joint| initial.q[joint]).collect();
    for t in (0..span.count()).map(|k| span.instant(k)) {
        let Motion { q, v, a } = prescribed.at(t);
        for (i, &joint) in prescribed.joints.iter().enumerate() {
            let joint = &subject.joints[joint];
            let (name, unit, item, way) = (&joint.name, joint.unit(), reader.item(), (q[i] - before[i]).abs());
            let (title, help) = if ![q[i], v[i], a[i]].iter().all(|value| value.is_finite()) {
                let title =
                    format!("{item}: the motion of the joint `{name}` is infinite or not a number at t = {t:?} s");
                (title, "prescribe a slower motion; times are in s".to_owned())
            } else if joint.turns && q[i].abs() > MOST_ANGLE {
                let title = format!(
                    "{item}: the joint `{name}` is prescribed to be at {:.1e} rad at t = {t:?} s, and an angle is at most \
                     {MOST_ANGLE:e} rad",
                    q[i]
                );
                (title, unresolved("prescribe a slower motion (speeds are in rad/s), or end earlier"))
            } else if followed && way > MOST_MOVE {
                let title = format!(
                    "{item}: the joint `{name}` is prescribed to move by {way:.1e} {unit} up to t = {t:?} s, and closed loops \
                     are followed over {MOST_MOVE:?} {unit} from one row to the next"
                );
                let help = format!(
                    "prescribe a slower motion (speeds are in {unit}/s), give `inverse` a smaller `step`, or begin with \
                     `initial.q` nearer"
                );
                (title, help)
            } else {
                continue;
            };
            return reader
                .error_at(prescribed.place.clone(), Message { title, label: "too fast or too far".into(), help });
        }
        before = q;
    }
    Some(())
}
