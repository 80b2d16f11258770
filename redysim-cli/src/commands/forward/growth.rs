//! Motions that grow without bound, because the gains of their torque law are wrong or the steps are too large.

use redysim_runtime::Trajectory;

use crate::failure::Failure;
use crate::layout::Layout;
use crate::number::size;
use crate::scenario::{Forward, Integrator, Scenario, Torque};

/// A joint is not held that is so many times as far from where its law wants it as at the start, or as 1 rad or 1 m. It
/// has turned 160 times then.
const FAR: f64 = 1e3;

/// A motion that grows is ended where, at the pace of so many steps, the rest would take more than `ENDLESS` of them.
const PACE: u64 = 10_000;
const ENDLESS: f64 = 1e6;

/// A joint that is far from where its law wants it.
pub struct Growth {
    /// When, and after how many steps.
    pub seen: (f64, u64),
    /// When, where and how far.
    pub warning: String,
    /// What to do about it.
    pub help: String,
    /// Whether the energy that moves it has come from nowhere: steps that are too large may be the reason.
    pub from_nowhere: bool,
}

impl Growth {
    /// Why the run is to be ended at `t`, after so many steps: a motion without bound takes ever smaller ones.
    pub fn why_endless(&self, (t, steps): (f64, u64), end: f64) -> Option<Failure> {
        let (since, before) = self.seen;
        let taken = steps - before;
        let rest = (end - t) / (t - since) * taken as f64;
        (taken >= PACE && rest > ENDLESS).then(|| {
            let at = size(t);
            let message = format!("{}, and at t = {at} s the rest would take {rest:.0e} steps", self.warning);
            Failure::input(message).help(&self.help)
        })
    }
}

/// The distances of joints from where their law wants them.
pub struct Distances {
    /// At the start, one for each coordinate that the law leads.
    start: Option<Vec<f64>>,
}

impl Distances {
    pub fn new() -> Self {
        Distances { start: None }
    }

    /// Looks at the position `q` at `t`. `from_nowhere` is whether energy has come from nowhere so far.
    pub fn see(
        &mut self,
        scenario: &Scenario,
        forward: &Forward,
        (t, q, steps): (f64, &[f64], u64),
        from_nowhere: bool,
    ) -> Option<Growth> {
        let layout = &scenario.layout;
        let wanted = wanted(forward.torque.unlimited(), t, layout);
        let distances: Vec<f64> = wanted.iter().map(|(index, wanted)| (q[*index] - wanted).abs()).collect();
        let start = self.start.get_or_insert_with(|| distances.clone());
        let far = |(distance, start): (&f64, &f64)| *distance > FAR * (1.0 + start);
        let joint = distances.iter().zip(start.iter()).position(far)?;
        let component = &layout.coordinates[wanted[joint].0];
        let warning = format!(
            "the motion grows without bound: at t = {} s the joint `{}` is {} {} from where the torque law wants it",
            size(t),
            component.name,
            size(distances[joint]),
            component.unit()
        );
        let Gains { help, drive_away } = Gains::of(forward.torque.unlimited());
        // Tolerances bound the errors of a step, so that what grows is the motion.
        let from_nowhere = from_nowhere && matches!(forward.integrator, Integrator::Fixed(..)) && !drive_away;
        Some(Growth { seen: (t, steps), warning, help, from_nowhere })
    }
}

/// The coordinates that a law leads, and where it wants them at `t`.
fn wanted(law: &Torque, t: f64, layout: &Layout) -> Vec<(usize, f64)> {
    match law {
        Torque::P { driven, target, .. }
        | Torque::Pd { driven, target, .. }
        | Torque::Pid { driven, target, .. }
        | Torque::PdGravity { driven, target, .. } => {
            layout.coordinates_along(driven).into_iter().zip(target.iter().copied()).collect()
        }
        Torque::TrackingPd { trajectory, driven, .. } => {
            let led = layout.coordinates_along(driven);
            let all = trajectory.coordinates.iter().copied().zip(trajectory.at(t).q);
            all.filter(|(index, _)| led.contains(index)).collect()
        }
        Torque::Computed { trajectory, .. } => trajectory.coordinates.iter().copied().zip(trajectory.at(t).q).collect(),
        Torque::Zero | Torque::Impedance(_) | Torque::Limited { .. } | Torque::Table { .. } => Vec::new(),
    }
}

/// What is known of the gains of a law whose motion grows.
pub struct Gains {
    pub help: String,
    /// Whether one is negative.
    pub drive_away: bool,
}

impl Gains {
    /// Of the gains of a law.
    pub fn of(law: &Torque) -> Gains {
        let none = &Vec::new();
        let (kp, ki, kd) = match law {
            Torque::P { kp, .. } => (kp, none, none),
            Torque::Pid { kp, ki, kd, .. } => (kp, ki, kd),
            Torque::Pd { kp, kd, .. }
            | Torque::PdGravity { kp, kd, .. }
            | Torque::TrackingPd { kp, kd, .. }
            | Torque::Computed { kp, kd, .. } => (kp, none, kd),
            Torque::Zero | Torque::Impedance(_) | Torque::Limited { .. } | Torque::Table { .. } => (none, none, none),
        };
        let named = [("`kp`", kp), ("`ki`", ki), ("`kd`", kd)];
        let negative: Vec<_> =
            named.iter().filter(|(_, gains)| gains.iter().any(|gain| *gain < 0.0)).map(|(name, _)| *name).collect();
        let help = match &negative[..] {
            [] => "the gains of `torque` may be wrong in size, or a gain that damps is missing".into(),
            negative => {
                let have = if negative.len() == 1 { "has" } else { "have" };
                format!(
                    "the gains of `torque` may be wrong: {} {have} the sign that drives away",
                    negative.join(" and ")
                )
            }
        };
        Gains { help, drive_away: !negative.is_empty() }
    }
}
