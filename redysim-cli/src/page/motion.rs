//! How every joint moves, instant by instant; where the links are, the page computes.

use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

use redysim_model::{GenericMechanism, Model};
use redysim_runtime::LoopClosure;
use serde::Serialize;

use crate::failure::Failure;
use crate::layout::{Component, Joint, Layout};
use crate::number::rounded;
use crate::recorded::{Recorded, evenly};
use crate::table::{Column, Table};

/// Coordinates and rates that a page holds at most: some three megabytes of them.
const NUMBERS: usize = 200_000;
/// From one instant to the next, more than this can hardly be followed.
const QUARTER_TURN: f64 = FRAC_PI_2;

/// All coordinates over time. Between two instants each is the cubic that has both coordinates and both rates.
#[derive(Serialize)]
pub struct Keyframes {
    /// The instants, s.
    t: Vec<f64>,
    /// A list for each coordinate: rad, m or 1.
    q: Vec<Vec<f64>>,
    /// Its rates: per s.
    v: Vec<Vec<f64>>,
}

/// The motion that the run has written, at as many instants as a page can hold.
///
/// # Errors
/// If it is not there, or not that of the model.
pub fn of(recorded: &Recorded, model: &Model, layout: &Layout) -> Result<(Keyframes, Vec<String>), Failure> {
    let Some(table) = recorded.motion()? else {
        return Err(recorded.lacks("no motion, neither statevar.csv nor traj.csv"));
    };
    let motion = recorded_motion(&table, layout)?;
    let rows = &motion.t;
    let mut notes = Vec::new();
    if rows.len() < table.t.len() {
        notes.push(format!("{} of {} instants are kept", rows.len(), table.t.len()));
    }
    notes.extend(layout.joints.iter().filter_map(|joint| fast(joint, layout, &motion.q)));
    if !model.loops.is_empty() {
        let residual = rounded(motion.residual_between(&GenericMechanism::new(model.clone())));
        notes.push(format!("between instants the loops open by at most {residual} m"));
    }
    Ok((motion, notes))
}

/// The coordinates in a table, and their rates: those that belong to the recorded velocities.
fn recorded_motion(table: &Table, layout: &Layout) -> Result<Keyframes, Failure> {
    let rows = evenly(table.t.len(), NUMBERS / (2 * layout.nq()).max(1));
    let pick = |symbol: &str, component: &Component| -> Result<Vec<f64>, Failure> {
        let column = column(table, symbol, &component.name)?;
        rows.iter().map(|&row| finite(table, column, row)).collect()
    };
    let all = |symbol: &str, components: &[Component]| -> Result<Vec<Vec<f64>>, Failure> {
        components.iter().map(|component| pick(symbol, component)).collect()
    };
    let t: Vec<f64> = rows.iter().map(|&row| table.t[row]).collect();
    let (mut q, mut v) = (Vec::new(), Vec::new());
    for joint in &layout.joints {
        let values = all("q", &layout.coordinates[joint.q.clone()])?;
        let velocities = all("v", &layout.velocities[joint.v.clone()])?;
        let at = |lists: &[Vec<f64>], k: usize| lists.iter().map(|list| list[k]).collect::<Vec<f64>>();
        let mut recorded = vec![vec![0.0; t.len()]; values.len()];
        for k in 0..t.len() {
            let mut now = vec![0.0; values.len()];
            joint.motion.coordinate_rates(&at(&values, k), &at(&velocities, k), &mut now);
            recorded.iter_mut().zip(now).for_each(|(recorded, now)| recorded[k] = now);
        }
        v.extend(values.iter().zip(&recorded).map(|(values, recorded)| rates(&t, values, recorded)));
        q.extend(values);
    }
    Ok(Keyframes { t, q, v })
}

fn column<'t>(table: &'t Table, symbol: &str, name: &str) -> Result<&'t Column, Failure> {
    table.of(symbol).find(|column| column.name == name.trim()).ok_or_else(|| {
        Failure::input(format!("{}:1: the column `{symbol} {name} [..]` is missing", table.path.display()))
            .help(format!("the folder's model.toml has `{name}`: are both from the same run?"))
    })
}

fn finite(table: &Table, column: &Column, row: usize) -> Result<f64, Failure> {
    let value = column.values[row];
    if value.is_finite() {
        return Ok(value);
    }
    let fault = table.fault(row, format!("`{}` must be a finite number, found {value}", column.header()));
    Err(fault.help("did the run fail there? End it before, or make its tolerances tighter"))
}

/// The rates `v` where they fit the coordinates. Where a motion is too fast for its instants, they would carry the
/// cubics far beyond all that was recorded: there, the mean rates between the neighbours.
fn rates(t: &[f64], q: &[f64], v: &[f64]) -> Vec<f64> {
    let fit = |k: usize| {
        let time = t[k + 1] - t[k];
        let apart = q[k + 1] - q[k] - 0.5 * time * (v[k] + v[k + 1]);
        apart.abs() <= 0.25 * time * v[k].abs().max(v[k + 1].abs())
    };
    let rate = |k: usize| match neighbours(t, k).all(fit) {
        true => v[k],
        false => mean_rate(t, q, k).unwrap_or(v[k]),
    };
    (0..t.len()).map(rate).collect()
}

/// The instants from the one before to the one after, without the last.
fn neighbours(t: &[f64], k: usize) -> Range<usize> {
    k.saturating_sub(1)..(k + 1).min(t.len() - 1)
}

/// The mean rate between the neighbours of an instant; `None` if no time passes between them.
fn mean_rate(t: &[f64], q: &[f64], k: usize) -> Option<f64> {
    let Range { start, end } = neighbours(t, k);
    let time = t[end] - t[start];
    (time != 0.0).then(|| (q[end] - q[start]) / time)
}

/// That a joint turns so far between instants that its motion cannot be followed.
fn fast(joint: &Joint, layout: &Layout, q: &[Vec<f64>]) -> Option<String> {
    let most = match joint.is_in_space() {
        true => most_turned(&q[joint.orientation()]),
        false => {
            let angles = joint.q.clone().filter(|&coordinate| layout.coordinates[coordinate].turns());
            let turned = angles.flat_map(|angle| q[angle].windows(2)).map(|pair| (pair[1] - pair[0]).abs());
            turned.fold(0.0, f64::max)
        }
    };
    (most > QUARTER_TURN).then(|| {
        let (name, turns) = (&joint.name, rounded(most.to_degrees()));
        format!("joint `{name}` turns by up to {turns} deg from one instant to the next: what lies between is a guess")
    })
}

/// The largest angle between quaternions that follow each other, rad.
fn most_turned(quaternion: &[Vec<f64>]) -> f64 {
    let product = |k: usize, l: usize| quaternion.iter().map(|component| component[k] * component[l]).sum::<f64>();
    let cosine = |k: usize| (product(k - 1, k) / (product(k - 1, k - 1) * product(k, k)).sqrt()).abs().min(1.0);
    (1..quaternion[0].len()).map(|k| 2.0 * cosine(k).acos()).fold(0.0, f64::max)
}

impl Keyframes {
    /// How far loops open between instants: as far as in the middle, where cubics are furthest from the truth.
    fn residual_between(&self, mechanism: &GenericMechanism) -> f64 {
        let middle = |k: usize| {
            let time = self.t[k + 1] - self.t[k];
            let of_coordinate =
                |(q, v): (&Vec<f64>, &Vec<f64>)| 0.5 * (q[k] + q[k + 1]) + 0.125 * time * (v[k] - v[k + 1]);
            self.q.iter().zip(&self.v).map(of_coordinate).collect::<Vec<f64>>()
        };
        let residuals = (1..self.t.len()).map(|k| mechanism.loop_residual(&middle(k - 1)));
        residuals.flatten().fold(0.0, |most: f64, residual: f64| most.max(residual.abs()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::tests::free_base_with_arm;

    #[test]
    fn coordinates_of_a_free_joint_move_at_the_rates_of_its_velocities() {
        let layout = free_base_with_arm();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("statevar.csv");
        let header = |symbol: &str, components: &[Component]| -> String {
            components.iter().map(|of| format!(",{symbol} {} [1]", of.name)).collect()
        };
        let mut text = format!("t [s]{}{}\n", header("q", &layout.coordinates), header("v", &layout.velocities));
        // It turns about z at 1 rad/s, while it moves along its own x axis at 2 m/s.
        for k in 0..21 {
            let t = 0.05 * f64::from(k);
            let ((sin, cos), (s, c)) = (t.sin_cos(), (0.5 * t).sin_cos());
            let q = [2.0 * sin, 2.0 - 2.0 * cos, 0.0, 0.0, 0.0, s, c, 3.0 * t];
            let q: String = q.iter().map(|q| format!(",{q:?}")).collect();
            text += &format!("{t:?}{q},2,0,0,0,0,1,3\n");
        }
        std::fs::write(&path, text).unwrap();
        let motion = recorded_motion(&Table::read(&path).unwrap(), &layout).unwrap();
        assert_eq!((motion.q.len(), motion.v.len()), (8, 8));
        for (k, &t) in motion.t.iter().enumerate() {
            let ((sin, cos), (s, c)) = (t.sin_cos(), (0.5 * t).sin_cos());
            let expected = [2.0 * cos, 2.0 * sin, 0.0, 0.0, 0.0, 0.5 * c, -0.5 * s, 3.0];
            let found = motion.v.iter().map(|v| v[k]);
            assert!(found.zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-14), "{:?}", motion.v);
        }
        assert_eq!(layout.joints.iter().find_map(|joint| fast(joint, &layout, &motion.q)), None);
    }

    #[test]
    fn orientations_that_turn_too_far_between_instants_are_reported() {
        let layout = free_base_with_arm();
        let mut q = vec![vec![0.0; 3]; 8];
        q[6] = vec![1.0, 0.6, -0.28];
        q[3] = vec![0.0, 0.8, 0.96];
        let note = fast(&layout.joints[0], &layout, &q).unwrap();
        assert!(note.starts_with("joint `base` turns by up to 106"), "{note}");
    }

    #[test]
    fn rates_are_those_recorded_where_instants_can_show_the_motion() {
        let swing = |step: f64| -> [Vec<f64>; 3] {
            let t: Vec<f64> = (0..40).map(|k| step * f64::from(k)).collect();
            [t.clone(), t.iter().map(|t| t.sin()).collect(), t.iter().map(|t| t.cos()).collect()]
        };
        let [t, q, v] = swing(0.2);
        assert_eq!(rates(&t, &q, &v), v);
        // Three periods and a quarter from each instant to the next.
        let [t, q, v] = swing(6.5 * std::f64::consts::PI);
        let largest = rates(&t, &q, &v).into_iter().fold(0.0, |most: f64, rate| most.max(rate.abs()));
        assert!(largest < 0.1, "{largest}");
        assert_eq!(rates(&[1.0], &[2.0], &[3.0]), [3.0]);
    }
}
