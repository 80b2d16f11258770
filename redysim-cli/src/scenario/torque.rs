//! What the actuators do.

use std::path::{Path, PathBuf};

use redysim_model::GenericMechanism;
use redysim_model::document::{Message, Reader, Shape};
use redysim_runtime::{
    ClosedLoop, ClosedLoopComputedTorque, ComputedTorque, Free, LoopError, Proportional, ProportionalDerivative,
    TorqueLaw, TrackingPd,
};

use super::joints::{Joint, Quantity, some, values};
use super::spread;
use super::table::Table;
use super::trajectory::{Prescribed, Spread};
use crate::failure::Failure;

/// A torque law, as the scenario has it: with one entry for each coordinate, zero where no actuator is.
#[derive(Clone, Debug)]
pub enum Actuation {
    Free,
    P {
        target: Vec<f64>,
        kp: Vec<f64>,
    },
    Pd {
        target: Vec<f64>,
        kp: Vec<f64>,
        kd: Vec<f64>,
    },
    /// A spring and a damper to the scenario's trajectory.
    TrackingPd {
        kp: Vec<f64>,
        kd: Vec<f64>,
    },
    /// The same, with the model; of closed loops, for the independent coordinates that the trajectory prescribes.
    ComputedTorque {
        kp: Vec<f64>,
        kd: Vec<f64>,
        actuated: Vec<usize>,
    },
    /// Forces over time.
    Table(Forces),
}

/// Joint forces over time, with straight lines between the rows of a table.
#[derive(Clone, Debug)]
pub struct Forces {
    /// Where they were read from.
    pub path: PathBuf,
    t: Vec<f64>,
    rows: Vec<Vec<f64>>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Tag {
    Free,
    P,
    Pd,
    TrackingPd,
    ComputedTorque,
    Table,
}

const FREE: Shape = Shape { owner: "The law `free`", keys: &["law"] };
const P: Shape = Shape { owner: "The law `p`", keys: &["law", "joints", "target", "kp"] };
const PD: Shape = Shape { owner: "The law `pd`", keys: &["law", "joints", "target", "kp", "kd"] };
const TRACKING: Shape = Shape { owner: "The law `tracking-pd`", keys: &["law", "joints", "kp", "kd"] };
const COMPUTED: Shape = Shape { owner: "The law `computed-torque`", keys: &["law", "kp", "kd"] };
const TABLE: Shape = Shape { owner: "The law `csv`", keys: &["law", "joints", "file"] };
const LAWS: [(&str, (Tag, &Shape)); 6] = [
    ("free", (Tag::Free, &FREE)),
    ("p", (Tag::P, &P)),
    ("pd", (Tag::Pd, &PD)),
    ("tracking-pd", (Tag::TrackingPd, &TRACKING)),
    ("computed-torque", (Tag::ComputedTorque, &COMPUTED)),
    ("csv", (Tag::Table, &TABLE)),
];

impl Actuation {
    /// Reads the table `torque`; without one, nothing drives the joints. A table of numbers is looked for in `folder`;
    /// what is wrong with it goes to `failure`.
    pub fn read(
        reader: &mut Reader<'_, '_>,
        joints: &[Joint],
        loops: bool,
        trajectory: Option<&Prescribed>,
        folder: &Path,
        failure: &mut Option<Failure>,
    ) -> Option<Actuation> {
        let actuated: Vec<usize> = super::indices(joints, |joint| joint.actuated);
        let field = reader.table_of_kind("torque", "law", &LAWS, LAWS[0].1, |mut reader, tag| {
            if tag == Tag::Free {
                return Some(Actuation::Free);
            }
            let usual = match (tag, trajectory) {
                (Tag::TrackingPd | Tag::ComputedTorque, None) => return unfollowed(&mut reader),
                (Tag::TrackingPd | Tag::ComputedTorque, Some(trajectory)) => &trajectory.joints,
                _ => &actuated,
            };
            let chosen = some(&mut reader, "joints", joints).value_or(usual.clone())?;
            if tag == Tag::Table {
                let file = reader.text("file");
                let file = reader.required("file", file);
                match Forces::read(&folder.join(file.value()?), joints, &chosen) {
                    Ok(forces) => return Some(Actuation::Table(forces)),
                    Err(fault) => *failure = Some(fault),
                }
                return None;
            }
            let mut of = |key: &str, quantity: Quantity| {
                let field = values(&mut reader, key, quantity, joints, &chosen);
                Some(spread(&chosen, reader.required(key, field).value()?, joints.len()))
            };
            let kp = of("kp", Quantity::Gain);
            let law = match tag {
                Tag::P => Actuation::P { target: of("target", Quantity::Coordinate)?, kp: kp? },
                Tag::Pd => {
                    let (target, kd) = (of("target", Quantity::Coordinate), of("kd", Quantity::Gain));
                    Actuation::Pd { target: target?, kp: kp?, kd: kd? }
                }
                Tag::TrackingPd => Actuation::TrackingPd { kp: kp?, kd: of("kd", Quantity::Gain)? },
                _ => Actuation::ComputedTorque { kp: kp?, kd: of("kd", Quantity::Gain)?, actuated: actuated.clone() },
            };
            let prescribed = trajectory.map_or(&[][..], |trajectory| &trajectory.joints);
            match (tag, chosen.iter().find(|joint| !prescribed.contains(joint))) {
                (Tag::TrackingPd | Tag::ComputedTorque, Some(&joint)) => astray(&mut reader, &joints[joint]),
                (Tag::ComputedTorque, None) if !loops => check_tree(&mut reader, joints, prescribed).map(|()| law),
                _ => Some(law),
            }
        });
        if field.is_missing() { Some(Actuation::Free) } else { field.value()?.clone() }
    }

    /// The joints that the key `joints` stands for where it is not there; none of laws that have no such key.
    pub fn usual_joints(&self, joints: &[Joint], trajectory: Option<&Prescribed>) -> Option<Vec<usize>> {
        match self {
            Actuation::Free | Actuation::ComputedTorque { .. } => None,
            Actuation::TrackingPd { .. } => trajectory.map(|trajectory| trajectory.joints.clone()),
            Actuation::P { .. } | Actuation::Pd { .. } | Actuation::Table(_) => {
                Some(super::indices(joints, |joint| joint.actuated))
            }
        }
    }

    /// Whether it follows the scenario's trajectory.
    pub fn follows(&self) -> bool {
        matches!(self, Actuation::TrackingPd { .. } | Actuation::ComputedTorque { .. })
    }

    /// The law as it acts on `mechanism`.
    pub fn law<'a>(&'a self, mechanism: &'a GenericMechanism, trajectory: Option<&'a Prescribed>) -> Law<'a> {
        let count = mechanism.model().dof();
        match (self, trajectory) {
            (Actuation::P { target, kp }, _) => Law::P(Proportional { target: target.clone(), kp: kp.clone() }),
            (Actuation::Pd { target, kp, kd }, _) => {
                Law::Pd(ProportionalDerivative { target: target.clone(), kp: kp.clone(), kd: kd.clone() })
            }
            (Actuation::TrackingPd { kp, kd }, Some(trajectory)) => {
                Law::TrackingPd(TrackingPd { trajectory: trajectory.spread(count), kp: kp.clone(), kd: kd.clone() })
            }
            (Actuation::ComputedTorque { kp, kd, .. }, Some(trajectory)) if mechanism.model().loops.is_empty() => {
                let trajectory = trajectory.spread(count);
                Law::ComputedTorque(ComputedTorque { mechanism, trajectory, kp: kp.clone(), kd: kd.clone() })
            }
            (Actuation::ComputedTorque { kp, kd, actuated }, Some(trajectory)) => {
                let independent = trajectory.joints.as_slice();
                let gains = [kp, kd].map(|gains| independent.iter().map(|&joint| gains[joint]).collect());
                let law = ClosedLoopComputedTorque::new(ClosedLoop::new(mechanism), independent, trajectory, gains);
                Law::LoopComputedTorque(law.actuated(actuated))
            }
            (Actuation::Table(forces), _) => Law::Table(forces),
            // Reading a scenario has made sure that there is a trajectory to follow.
            (Actuation::Free | Actuation::TrackingPd { .. } | Actuation::ComputedTorque { .. }, _) => Law::Free(Free),
        }
    }

    /// Fails unless a table, where the forces come from one, goes from `start` to `end`.
    pub fn cover(&self, start: f64, end: f64) -> Result<(), Failure> {
        match self {
            Actuation::Table(forces) => Table::read(&forces.path)?.cover(start, end),
            _ => Ok(()),
        }
    }
}

/// A law on a mechanism.
pub enum Law<'a> {
    Free(Free),
    P(Proportional<Vec<f64>, Vec<f64>>),
    Pd(ProportionalDerivative<Vec<f64>, Vec<f64>>),
    TrackingPd(TrackingPd<Spread<'a>, Vec<f64>>),
    ComputedTorque(ComputedTorque<'a, GenericMechanism, Spread<'a>, Vec<f64>>),
    LoopComputedTorque(ClosedLoopComputedTorque<'a, f64, GenericMechanism, &'a Prescribed, Vec<f64>>),
    Table(&'a Forces),
}

type Pair<'a> = (&'a Vec<f64>, &'a Vec<f64>);

impl Law<'_> {
    /// Why the forces asked for last are not numbers, if the law knows.
    pub fn last_error(&self) -> Option<LoopError<f64>> {
        match self {
            Law::LoopComputedTorque(law) => law.last_error(),
            _ => None,
        }
    }

    fn inner(&mut self) -> &mut dyn TorqueLaw<f64, GenericMechanism> {
        match self {
            Law::Free(law) => law,
            Law::P(law) => law,
            Law::Pd(law) => law,
            Law::TrackingPd(law) => law,
            Law::ComputedTorque(law) => law,
            Law::LoopComputedTorque(law) => law,
            Law::Table(law) => law,
        }
    }
}

impl TorqueLaw<f64, GenericMechanism> for Law<'_> {
    fn torque(&mut self, t: f64, q: &Vec<f64>, v: &Vec<f64>) -> Vec<f64> {
        self.inner().torque(t, q, v)
    }

    fn torque_tangent(&mut self, t: f64, at: Pair<'_>, slopes: Pair<'_>) -> Option<Vec<f64>> {
        self.inner().torque_tangent(t, at, slopes)
    }
}

impl Forces {
    fn read(path: &Path, joints: &[Joint], chosen: &[usize]) -> Result<Forces, Failure> {
        let table = Table::read(path)?;
        let of: Vec<&Joint> = chosen.iter().map(|&joint| &joints[joint]).collect();
        let rows = table.of_joints("tau", &of, None)?;
        let rows =
            rows.ok_or_else(|| table.fault("it has no forces", "add a column `tau <joint> [N m]` for each joint"))?;
        let rows = rows.iter().map(|row| spread(chosen, row, joints.len())).collect();
        Ok(Forces { path: table.path().to_owned(), t: table.t, rows })
    }

    fn at(&self, t: f64) -> Vec<f64> {
        let right = self.t.partition_point(|&time| time <= t).clamp(1, self.t.len() - 1);
        let (from, to) = (&self.rows[right - 1], &self.rows[right]);
        // Beyond the ends, by rounding or within a last step, the forces are those of the ends.
        let part = ((t - self.t[right - 1]) / (self.t[right] - self.t[right - 1])).clamp(0.0, 1.0);
        from.iter().zip(to).map(|(from, to)| from + part * (to - from)).collect()
    }
}

impl TorqueLaw<f64, GenericMechanism> for &Forces {
    fn torque(&mut self, t: f64, _q: &Vec<f64>, _v: &Vec<f64>) -> Vec<f64> {
        self.at(t)
    }

    fn torque_tangent(&mut self, _t: f64, _at: Pair<'_>, (_, dv): Pair<'_>) -> Option<Vec<f64>> {
        Some(vec![0.0; dv.len()])
    }
}

fn unfollowed<T>(reader: &mut Reader<'_, '_>) -> Option<T> {
    reader.fault_of_table(Message {
        title: format!("{}: the torque law follows a trajectory, and there is none", reader.item()),
        label: "follows what?".into(),
        help: "add a table `[trajectory]`".into(),
    })
}

fn astray<T>(reader: &mut Reader<'_, '_>, joint: &Joint) -> Option<T> {
    reader.fault_of_table(Message {
        title: format!(
            "{}: the trajectory does not prescribe the joint `{}` that the torque law drives",
            reader.item(),
            joint.name
        ),
        label: "follows what?".into(),
        help: "name it among the `joints` of `[trajectory]`, or drive fewer".into(),
    })
}

/// Computed torque drives every joint of a tree.
fn check_tree(reader: &mut Reader<'_, '_>, joints: &[Joint], prescribed: &[usize]) -> Option<()> {
    let passive = joints.iter().find(|joint| !joint.actuated);
    let free = joints.iter().enumerate().find(|(index, _)| !prescribed.contains(index)).map(|(_, joint)| joint);
    let (joint, what, help) = match (passive, free) {
        (Some(joint), _) => (joint, "has no actuator", "take the law `tracking-pd`, or actuate every joint"),
        (None, Some(joint)) => (joint, "is not prescribed", "name all joints among the `joints` of `[trajectory]`"),
        (None, None) => return Some(()),
    };
    reader.fault_of_table(Message {
        title: format!(
            "{}: computed torque moves every joint of a tree, but the joint `{}` {what}",
            reader.item(),
            joint.name
        ),
        label: "not for this model".into(),
        help: help.into(),
    })
}
