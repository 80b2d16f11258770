//! How every joint moves, instant by instant; where the links are, the page computes.

use std::f64::consts::FRAC_PI_2;

use redysim_model::{GenericMechanism, Link, Model};
use redysim_runtime::LoopClosure;
use serde::Serialize;

use crate::failure::Failure;
use crate::number::rounded;
use crate::recorded::{Recorded, evenly};
use crate::table::{Column, Table};

/// Coordinates and rates that a page holds at most: some three megabytes of them.
const NUMBERS: usize = 200_000;
/// From one instant to the next, more than this can hardly be followed.
const QUARTER_TURN: f64 = FRAC_PI_2;

/// The coordinates of all moving joints over time. Between two instants each is the cubic that has both coordinates and
/// both rates.
#[derive(Serialize)]
pub struct Motion {
    /// The instants, s.
    t: Vec<f64>,
    /// A list for each joint: rad or m.
    q: Vec<Vec<f64>>,
    /// A list for each joint: rad/s or m/s.
    v: Vec<Vec<f64>>,
}

/// The motion that the run has written, at as many instants as a page can hold.
///
/// # Errors
/// If it is not there, or not that of the model.
pub fn of(recorded: &Recorded, model: &Model) -> Result<(Motion, Vec<String>), Failure> {
    let Some(table) = recorded.motion()? else {
        return Err(recorded.lacks("no motion, neither statevar.csv nor traj.csv"));
    };
    let joints: Vec<&Link> = model.moving_links().collect();
    let rows = evenly(table.t.len(), NUMBERS / (2 * joints.len()).max(1));
    let pick = |symbol: &str, joint: &Link| -> Result<Vec<f64>, Failure> {
        let column = column(&table, symbol, &joint.joint_name)?;
        rows.iter().map(|&row| finite(&table, column, row)).collect()
    };
    let t: Vec<f64> = rows.iter().map(|&row| table.t[row]).collect();
    let q = joints.iter().map(|joint| pick("q", joint)).collect::<Result<Vec<_>, _>>()?;
    let mut v = joints.iter().map(|joint| pick("v", joint)).collect::<Result<Vec<_>, _>>()?;
    v.iter_mut().zip(&q).for_each(|(v, q)| *v = rates(&t, q, v));
    let motion = Motion { t, q, v };
    let mut notes = Vec::new();
    if rows.len() < table.t.len() {
        notes.push(format!("{} of {} instants are kept", rows.len(), table.t.len()));
    }
    notes.extend(joints.iter().zip(&motion.q).filter_map(|(joint, q)| fast(joint, q)));
    if !model.loops.is_empty() {
        let gap = rounded(motion.gap_between(&GenericMechanism::new(model.clone())));
        notes.push(format!("between instants the loops open by at most {gap} m"));
    }
    Ok((motion, notes))
}

fn column<'t>(table: &'t Table, symbol: &str, joint: &str) -> Result<&'t Column, Failure> {
    table.of(symbol).find(|column| column.name == joint.trim()).ok_or_else(|| {
        Failure::input(format!("{}:1: there is no column `{symbol} {joint} [..]`", table.path.display()))
            .help(format!("the folder's model.toml has `{joint}`: are both from the same run?"))
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
    let rate = |k: usize| {
        let (before, after) = (k.saturating_sub(1), (k + 1).min(t.len() - 1));
        let time = t[after] - t[before];
        if (before..after).all(fit) || time == 0.0 { v[k] } else { (q[after] - q[before]) / time }
    };
    (0..t.len()).map(rate).collect()
}

/// That a joint turns so far between instants that its motion cannot be followed.
fn fast(joint: &Link, q: &[f64]) -> Option<String> {
    let most = q.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
    let too_fast = joint.joint.turns() && most > QUARTER_TURN;
    too_fast.then(|| {
        let (name, turns) = (&joint.joint_name, rounded(most.to_degrees()));
        format!("joint `{name}` turns by up to {turns} deg from one instant to the next: what lies between is a guess")
    })
}

impl Motion {
    /// How far loops open between instants: as far as in the middle, where cubics are furthest from the truth.
    fn gap_between(&self, mechanism: &GenericMechanism) -> f64 {
        let middle = |k: usize| {
            let time = self.t[k + 1] - self.t[k];
            let of_joint = |(q, v): (&Vec<f64>, &Vec<f64>)| 0.5 * (q[k] + q[k + 1]) + 0.125 * time * (v[k] - v[k + 1]);
            self.q.iter().zip(&self.v).map(of_joint).collect::<Vec<f64>>()
        };
        let gaps = (1..self.t.len()).map(|k| mechanism.loop_residual(&middle(k - 1)));
        gaps.flatten().fold(0.0, |most: f64, gap: f64| most.max(gap.abs()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
