//! Prescribed motions.

use std::ops::Range;
use std::sync::Arc;

use redysim_model::{GenericMechanism, Mobility};
use redysim_runtime::{
    ConstantDirection, Cycloid, ManifoldSpline, Mechanism, Motion, TangentTrajectory, Trajectory, TrajectoryError,
};
use redysim_toml::{Key, Kind, Message, Reader, Spanned};

use super::chosen::chosen;
use super::joints::{Quantity, points, values};
use super::keys;
use super::space::{alone, part_of_quaternion, whole_orientations};
use super::subject::{Dynamics, Subject, given, spread};
use super::swing;
use super::table::InputTable;
use crate::failure::Failure;
use crate::layout::{Component, Layout};
use crate::number::counted;

/// A prescribed motion along some velocities; its components are in the order of `coordinates` and `velocities`.
#[derive(Clone, Debug)]
pub struct Prescribed {
    /// The coordinates that the velocities change.
    pub coordinates: Vec<usize>,
    /// The velocities that it prescribes, which determine all others of closed loops.
    pub velocities: Vec<usize>,
    /// The place of its speed, or of the whole table.
    pub place: Range<usize>,
    /// The table that it is read from, if it is.
    pub table: Option<InputTable>,
    motion: Path,
}

#[derive(Clone, Debug)]
enum Path {
    /// Of joints of one coordinate; its last position is `to` exactly.
    Cycloid(Cycloid<f64, Vec<f64>>),
    Screw(Screw<Cycloid<f64, [f64; 1]>>),
    ConstantSpeed(Screw<TimeLaw>),
    ViaPoints(Spline),
}

/// s(t), its rate and its acceleration, as the motion of one coordinate.
type TimeLaw = fn(f64) -> Motion<[f64; 1], [f64; 1]>;
/// q₀ ⊞ s(t) w: a turn about a fixed axis, or a screw motion.
type Screw<L> = TangentTrajectory<Arc<GenericMechanism>, Vec<f64>, ConstantDirection<Vec<f64>, L>>;
type Spline = ManifoldSpline<Arc<GenericMechanism>, Vec<f64>, Vec<f64>, Vec<f64>, f64>;

#[derive(Clone, Copy)]
enum Tag {
    Cycloid,
    ConstantSpeed,
    Via(Smooth),
    Table,
}

/// Which motion through points.
#[derive(Clone, Copy)]
enum Smooth {
    LeastJerk,
    Cubic,
}

const SMOOTH: [(&str, Smooth); 2] = [(USUAL_THROUGH, Smooth::LeastJerk), ("cubic", Smooth::Cubic)];
/// The default of `through`.
pub const USUAL_THROUGH: &str = "minimum-jerk";
const KINDS: [Kind<Tag>; 5] = [
    Kind::new("cycloid", Tag::Cycloid, &keys::CYCLOID),
    Kind::new("constant-speed", Tag::ConstantSpeed, &keys::CONSTANT_SPEED),
    Kind::new("minimum-jerk", Tag::Via(Smooth::LeastJerk), &keys::VIA_POINTS),
    Kind::new("cubic", Tag::Via(Smooth::Cubic), &keys::VIA_POINTS),
    Kind::new("csv", Tag::Table, &keys::MOTION_TABLE),
];

impl Prescribed {
    /// Reads the table `trajectory`, if there is one. By default it prescribes all velocities of a tree, and the actuated ones
    /// of closed loops.
    pub fn read(reader: &mut Reader<'_, '_>, subject: &Subject<'_>) -> Option<Option<Prescribed>> {
        let layout = subject.layout;
        let usual = || match subject.loops() {
            true => whole_orientations(layout, subject.actuated()),
            false => (0..layout.nv()).collect(),
        };
        let mut place = None;
        let field =
            reader.table_of_kind(&keys::TRAJECTORY, &keys::MOTION_KIND, &KINDS, &KINDS[0], |mut reader, tag| {
                let field = chosen(&mut reader, &keys::PRESCRIBED, layout);
                let named = field.spanned().map(Spanned::span);
                let of_v = field.value_or(usual())?;
                if let Some(part) = layout.part_of_quaternion(&of_v) {
                    return part_of_quaternion(&mut reader, named, layout, part);
                }
                let of_q = layout.coordinates_along(&of_v);
                let space = Arc::new(alone(layout, &of_v));
                let coordinates = |reader: &mut Reader<'_, '_>, key: &Key| {
                    let read = |reader: &mut _, key: &_| values(reader, key, Quantity::Coordinate, layout, &of_q);
                    reader.required(key, read).value().cloned()
                };
                let mut table = None;
                let motion = match tag {
                    Tag::Cycloid => {
                        let (from, to) = (coordinates(&mut reader, &keys::FROM), coordinates(&mut reader, &keys::TO));
                        let duration = reader.required(&keys::DURATION, Reader::positive);
                        let spanned = duration.spanned()?;
                        let (from, to, duration) = (from?, to?, *spanned.get_ref());
                        if space.nq() == space.nv() {
                            Path::Cycloid(accepted(&mut reader, spanned, Cycloid::new(from, to, duration))?)
                        } else {
                            let law = Cycloid::new([0.0], [1.0], duration);
                            let screw = law.and_then(|law| TangentTrajectory::along_screw(space, from, &to, law));
                            Path::Screw(accepted(&mut reader, spanned, screw)?)
                        }
                    }
                    Tag::ConstantSpeed => {
                        let from = coordinates(&mut reader, &keys::FROM);
                        let speed = |reader: &mut _, key: &_| values(reader, key, Quantity::Rate, layout, &of_v);
                        let speed = reader.required(&keys::SPEED, speed);
                        place = speed.spanned().map(Spanned::span);
                        let way = ConstantDirection { way: speed.value()?.clone(), law: uniform as fn(f64) -> _ };
                        Path::ConstantSpeed(TangentTrajectory { mechanism: space, from: from?, way })
                    }
                    Tag::Via(smooth) => {
                        let times = reader.required(&keys::TIMES, Reader::numbers);
                        let points = |reader: &mut _, key: &_| points(reader, key, layout, &of_q);
                        let points = reader.required(&keys::POINTS, points);
                        let spanned = times.spanned()?;
                        let through = smooth.through(space, spanned.get_ref().clone(), points.value()?.clone());
                        Path::ViaPoints(accepted(&mut reader, spanned, through)?)
                    }
                    Tag::Table => {
                        let smooth = reader.choice(&keys::THROUGH, &SMOOTH).value_or(SMOOTH[0].1);
                        let read = subject.table(&mut reader, &keys::MOTION_FILE, |table| {
                            let smooth = smooth.unwrap_or(SMOOTH[0].1);
                            let through = from_table(&table, layout, space, [&of_q, &of_v], smooth)?;
                            Ok((table, through))
                        });
                        let (read, through) = read.filter(|_| smooth.is_some())?;
                        table = Some(read);
                        Path::ViaPoints(through)
                    }
                };
                let prescribed = Prescribed { coordinates: of_q, velocities: of_v, place: 0..0, table, motion };
                let checked = match subject.dynamics {
                    Dynamics::Inverse => prescribed.check_joints(subject),
                    // A law that follows a trajectory checks it by itself.
                    Dynamics::Forward => Ok(()),
                };
                match checked {
                    Ok(()) => Some(prescribed),
                    Err((fault, help)) => {
                        let title = format!("{}: {fault}", reader.item());
                        reader.error_of_table(Message { title, label: "prescribes this".into(), help })
                    }
                }
            });
        if let Some(read) = field.spanned()
            && let Some((what, help)) = read.get_ref().as_ref().and_then(|motion| swing::of(motion, layout))
        {
            let title = format!("{}: {what}", reader.item());
            reader.warning_at(read.span(), Message { title, label: "swings".into(), help });
        }
        let place = place.or(field.spanned().map(Spanned::span)).unwrap_or_default();
        Some(given(field)?.map(|prescribed| Prescribed { place, ..prescribed }))
    }

    /// Fails, with what is wrong and what to do, unless it prescribes how all of a mechanism moves and nothing twice: a
    /// tree every joint, closed loops as many as they leave free.
    pub fn check_joints(&self, subject: &Subject<'_>) -> Result<(), (String, String)> {
        let layout = subject.layout;
        if !subject.loops() {
            let free: Vec<usize> = (0..layout.nv()).filter(|velocity| !self.velocities.contains(velocity)).collect();
            let Some(first) = layout.first_of(&free) else { return Ok(()) };
            let help = "name all joints among its `joints`; or have the others move as forces make them, by `prescribed` of \
                        `[forward]`";
            return Err((format!("the trajectory does not prescribe {first}"), help.into()));
        }
        let Mobility { mobility: free, position_residual, .. } = *subject.mobility();
        let prescribed = self.velocities.len();
        // Loops that were not closed from anywhere may leave another number free where they are.
        if prescribed == free || position_residual.is_some() {
            return Ok(());
        }
        let what = format!(
            "the trajectory prescribes {} ({}), but the loops leave {free} free",
            freedoms(prescribed),
            layout.names(&self.velocities).join(", ")
        );
        let help = match free {
            0 => "as the model is, nothing moves: `redysim check` reports which constraints do not follow from others"
                .into(),
            _ => format!("name joints of {} among its `joints`: the others follow from the loops", freedoms(free)),
        };
        Err((what, help))
    }

    /// The times at which it begins, passes its points and ends, s; none of a constant speed.
    pub fn times(&self) -> Vec<f64> {
        let span = |cycloid: (f64, f64)| vec![cycloid.0, cycloid.1];
        match &self.motion {
            Path::Cycloid(cycloid) => span(cycloid.span()),
            Path::Screw(screw) => span(screw.way.law.span()),
            Path::ConstantSpeed(_) => Vec::new(),
            Path::ViaPoints(through) => through.times().to_vec(),
        }
    }

    /// The motion with all components of `layout`; those that it does not prescribe stay in the neutral
    /// position.
    pub fn spread<'a>(&'a self, layout: &'a Layout) -> Spread<'a> {
        Spread { prescribed: self, coordinates: &layout.coordinates, velocities: &layout.velocities }
    }
}

impl Trajectory<f64, Vec<f64>, Vec<f64>> for Prescribed {
    fn at(&self, t: f64) -> Motion<Vec<f64>, Vec<f64>> {
        match &self.motion {
            Path::Cycloid(cycloid) => cycloid.at(t),
            Path::Screw(screw) => screw.at(t),
            Path::ConstantSpeed(screw) => screw.at(t),
            Path::ViaPoints(through) => through.at(t),
        }
    }
}

impl Trajectory<f64, Vec<f64>, Vec<f64>> for &Prescribed {
    fn at(&self, t: f64) -> Motion<Vec<f64>, Vec<f64>> {
        (*self).at(t)
    }
}

/// See [`Prescribed::spread`].
#[derive(Clone, Copy, Debug)]
pub struct Spread<'a> {
    prescribed: &'a Prescribed,
    coordinates: &'a [Component],
    velocities: &'a [Component],
}

impl Trajectory<f64, Vec<f64>, Vec<f64>> for Spread<'_> {
    fn at(&self, t: f64) -> Motion<Vec<f64>, Vec<f64>> {
        let Motion { q, v, a } = self.prescribed.at(t);
        let Prescribed { coordinates, velocities, .. } = self.prescribed;
        let [v, a] = [v, a].map(|values| spread(velocities, &values, self.velocities));
        Motion { q: spread(coordinates, &q, self.coordinates), v, a }
    }
}

impl Smooth {
    fn through(
        self,
        space: Arc<GenericMechanism>,
        times: Vec<f64>,
        points: Vec<Vec<f64>>,
    ) -> Result<Spline, TrajectoryError<f64>> {
        match self {
            Smooth::LeastJerk => ManifoldSpline::minimum_jerk(space, times, points),
            Smooth::Cubic => ManifoldSpline::cubic(space, times, points),
        }
    }
}

/// "1 degree of freedom", "2 degrees of freedom".
pub fn freedoms(count: usize) -> String {
    format!("{} of freedom", counted(count, "degree"))
}

/// What was made of the value at a place, or a fault there.
fn accepted<T, V>(reader: &mut Reader<'_, '_>, at: &Spanned<V>, made: Result<T, TrajectoryError<f64>>) -> Option<T> {
    made.map_err(|error| {
        let title = format!("{}: {error}", reader.item());
        let help = "times are in s, and as many as there are points".to_owned();
        reader.error_at::<()>(at.span(), Message { title, label: "here".into(), help })
    })
    .ok()
}

/// The time law of a constant speed, s(t) = t.
fn uniform(t: f64) -> Motion<[f64; 1], [f64; 1]> {
    Motion { q: [t], v: [1.0], a: [0.0] }
}

/// Gives the quaternions of the coordinates `of` length 1; fails with the first coordinate of one that is zero.
fn normalise(layout: &Layout, of: &[usize], q: &mut [f64]) -> Result<(), usize> {
    for joint in layout.joints.iter().filter(|joint| joint.is_in_space()) {
        let Some(first) = of.iter().position(|&coordinate| coordinate == joint.orientation().start) else { continue };
        let quaternion = &mut q[first..first + 4];
        let length = quaternion.iter().map(|component| component * component).sum::<f64>().sqrt();
        if length == 0.0 {
            return Err(first);
        }
        quaternion.iter_mut().for_each(|component| *component /= length);
    }
    Ok(())
}

/// A motion of the given coordinates and velocities through the rows of a table, with its velocities and accelerations;
/// without them, as `smooth` selects.
fn from_table(
    table: &InputTable,
    layout: &Layout,
    space: Arc<GenericMechanism>,
    [of_q, of_v]: [&[usize]; 2],
    smooth: Smooth,
) -> Result<Spline, Failure> {
    let q = table.of_components("q", &layout.coordinates, of_q, Some(""));
    let [v, a] = [("v", "/s"), ("a", "/s^2")]
        .map(|(symbol, per)| table.of_components(symbol, &layout.velocities, of_v, Some(per)));
    let mut q = q?;
    for (row, q) in q.iter_mut().flatten().enumerate() {
        let Err(coordinate) = normalise(layout, of_q, q) else { continue };
        let (t, joint) = (table.t[row], layout.coordinates[of_q[coordinate]].joint);
        let message = format!("at t = {t:?} s the quaternion of the joint `{}` is zero", layout.joints[joint].name);
        return Err(table.fault(&message, "a quaternion is x, y, z, w, of any length but zero: 0, 0, 0, 1 for none"));
    }
    let through = match (q, v?, a?) {
        (None, ..) => return Err(table.fault("it has no coordinates", "add a column `q <joint> [rad]` for each joint")),
        (Some(q), None, None) => smooth.through(space, table.t.clone(), q),
        (Some(q), Some(v), Some(a)) => {
            let rows = q.into_iter().zip(v).zip(a).map(|((q, v), a)| Motion { q, v, a });
            ManifoldSpline::through(space, table.t.clone(), rows.collect())
        }
        (Some(_), v, _) => {
            let (there, missing) = if v.is_some() { ("velocities", "a") } else { ("accelerations", "v") };
            let message = format!("it has {there}, but no column `{missing} <joint> […]`");
            return Err(table.fault(&message, "give velocities and accelerations, or neither"));
        }
    };
    through.map_err(|error| table.fault(&error.to_string(), "look at the column `t [s]`"))
}

#[cfg(test)]
mod tests {
    use super::super::subject::tests::with_free_base;
    use super::*;

    /// Checks a trajectory of `joints`, one of them a free joint, against loops with a mobility of six.
    fn checked(joints: &[&str]) -> (Prescribed, Result<(), (String, String)>) {
        let (from, to) = (["0.5"; 8], ["1"; 8]);
        let count = joints.iter().map(|joint| if *joint == "base" { 7 } else { 1 }).sum::<usize>();
        let [from, to] = [from, to].map(|values| values[..count].join(", "));
        let text = format!("trajectory = {{ joints = {joints:?}, from = [{from}], to = [{to}], duration = 1.0 }}");
        let read = |mut reader: Reader<'_, '_>| {
            with_free_base(|subject| {
                let prescribed = Prescribed::read(&mut reader, subject)??;
                let checked = prescribed.check_joints(subject);
                Some((prescribed, checked))
            })
        };
        redysim_toml::read(text, "scenario.toml", &keys::SCENARIO, "the scenario", read).unwrap().0
    }

    #[test]
    fn what_loops_leave_free_is_compared_with_the_velocities_of_a_trajectory_behind_a_free_joint() {
        let (arm, checked_arm) = checked(&["arm"]);
        assert_eq!(arm.velocities, [6]);
        let (title, help) = checked_arm.unwrap_err();
        assert_eq!(title, "the trajectory prescribes 1 degree of freedom (arm), but the loops leave 6 free");
        assert_eq!(help, "name joints of 6 degrees of freedom among its `joints`: the others follow from the loops");
    }

    #[test]
    fn a_trajectory_of_loops_prescribes_a_joint_of_several_coordinates_by_all_its_velocities() {
        let (base, checked_base) = checked(&["base"]);
        assert_eq!(base.velocities, [0, 1, 2, 3, 4, 5]);
        assert_eq!(checked_base, Ok(()));
    }

    #[test]
    fn coordinates_that_a_trajectory_does_not_prescribe_stay_in_the_neutral_position() {
        let (arm, _) = checked(&["arm"]);
        let layout = crate::layout::tests::free_base_with_arm();
        let Motion { q, v, a } = arm.spread(&layout).at(1.0);
        assert_eq!(q, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0]);
        assert_eq!((v.len(), a.len()), (7, 7));
    }
}
