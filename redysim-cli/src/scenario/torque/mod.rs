//! What the actuators do.

mod faults;
mod impedance;
mod payload;
mod read;

use redysim_model::GenericMechanism;
use redysim_runtime::{
    ClosedLoop, ClosedLoopComputedTorque, ComputedTorque, HybridComputedTorque, Limited, Pd, PdGravity, Pid,
    Proportional, SetPoint, TrackingPd, ZeroTorque,
};

use super::Ground;
use super::forces::Forces;
use super::initial::Initial;
use super::law::Law;
use super::subject::spread;
use super::trajectory::Prescribed;
use crate::layout::Layout;
pub use impedance::HeldFrame;

/// A torque law, as the scenario has it: its values are those of the velocities that it drives.
#[derive(Clone, Debug)]
pub enum Torque {
    Zero,
    P {
        driven: Vec<usize>,
        target: Vec<f64>,
        kp: Vec<f64>,
    },
    Pd {
        driven: Vec<usize>,
        target: Vec<f64>,
        kp: Vec<f64>,
        kd: Vec<f64>,
    },
    Pid {
        driven: Vec<usize>,
        target: Vec<f64>,
        kp: Vec<f64>,
        ki: Vec<f64>,
        kd: Vec<f64>,
        tracking_rate: Vec<f64>,
    },
    PdGravity {
        driven: Vec<usize>,
        target: Vec<f64>,
        kp: Vec<f64>,
        kd: Vec<f64>,
        /// The model with the payload that the law assumes, if it assumes one.
        laden: Option<Box<GenericMechanism>>,
    },
    /// Springs and dampers on a frame.
    Impedance(HeldFrame),
    /// A law within the limits of the actuators, one for each of the velocities that it drives.
    Limited {
        law: Box<Torque>,
        driven: Vec<usize>,
        limits: Vec<f64>,
    },
    /// A spring and a damper to a motion.
    TrackingPd {
        driven: Vec<usize>,
        trajectory: Prescribed,
        kp: Vec<f64>,
        kd: Vec<f64>,
    },
    /// The same, with the model; its gains are those of the velocities that are prescribed, of closed loops the independent
    /// ones.
    Computed {
        /// The velocities that have an actuator.
        actuated: Vec<usize>,
        trajectory: Prescribed,
        kp: Vec<f64>,
        kd: Vec<f64>,
    },
    /// Forces over time.
    Table {
        driven: Vec<usize>,
        forces: Forces,
    },
}

impl Torque {
    /// The velocities that the law drives, given or by default.
    pub fn driven(&self) -> Option<&[usize]> {
        match self.unlimited() {
            Torque::Zero | Torque::Computed { .. } | Torque::Limited { .. } => None,
            Torque::P { driven, .. }
            | Torque::Pd { driven, .. }
            | Torque::Pid { driven, .. }
            | Torque::PdGravity { driven, .. }
            | Torque::Impedance(HeldFrame { driven, .. })
            | Torque::TrackingPd { driven, .. }
            | Torque::Table { driven, .. } => Some(driven),
        }
    }

    /// The law without the limits of its forces.
    pub fn unlimited(&self) -> &Torque {
        match self {
            Torque::Limited { law, .. } => law,
            law => law,
        }
    }

    /// What the law follows, if it follows a motion.
    pub fn followed(&self) -> Option<&Prescribed> {
        match self.unlimited() {
            Torque::TrackingPd { trajectory, .. } | Torque::Computed { trajectory, .. } => Some(trajectory),
            _ => None,
        }
    }

    /// The law as it acts on the mechanism on `ground`, which starts at `initial`.
    pub fn law<'a>(&'a self, ground: &'a Ground<'a>, layout: &'a Layout, initial: &Initial) -> Law<'a> {
        let mechanism = ground.mechanism();
        let positions =
            |driven: &[usize], values: &[f64]| spread(&layout.coordinates_along(driven), values, &layout.coordinates);
        let whole = |driven: &[usize], values: &[f64]| spread(driven, values, &layout.velocities);
        match self {
            Torque::Zero => Law::total(ZeroTorque),
            Torque::P { driven, target, kp } => {
                Law::total(Proportional { target: positions(driven, target), kp: whole(driven, kp) })
            }
            Torque::Pd { driven, target, kp, kd } => {
                let [kp, kd] = [kp, kd].map(|gains| whole(driven, gains));
                Law::total(Pd { target: positions(driven, target), kp, kd })
            }
            Torque::Pid { driven, target, kp, ki, kd, tracking_rate } => {
                let [kp, ki, kd, tracking] = [kp, ki, kd, tracking_rate].map(|gains| whole(driven, gains));
                let trajectory = SetPoint::new(mechanism, positions(driven, target));
                Law::total(Pid { trajectory, kp, ki, kd, tracking, integral: vec![0.0; layout.nv()] })
            }
            Torque::PdGravity { driven, target, kp, kd, laden } => {
                let [kp, kd] = [kp, kd].map(|gains| whole(driven, gains));
                let trajectory = SetPoint::new(mechanism, positions(driven, target));
                let law = PdGravity { mechanism: laden.as_deref().unwrap_or(mechanism), trajectory, kp, kd };
                Law::total(Limited { law, limits: only(driven, layout) })
            }
            Torque::Impedance(held) => {
                Law::total(Limited { law: held.law(mechanism, initial), limits: only(&held.driven, layout) })
            }
            Torque::Limited { law, driven, limits } => {
                let mut all = vec![f64::INFINITY; layout.nv()];
                for (&velocity, &limit) in driven.iter().zip(limits) {
                    all[velocity] = limit;
                }
                Law::limited(law.law(ground, layout, initial), all)
            }
            Torque::TrackingPd { driven, trajectory, kp, kd } => {
                let [kp, kd] = [kp, kd].map(|gains| whole(driven, gains));
                Law::total(TrackingPd { trajectory: trajectory.spread(layout), kp, kd })
            }
            Torque::Computed { actuated, trajectory, kp, kd } if mechanism.model().loops.is_empty() => {
                let [kp, kd] = [kp, kd].map(|gains| whole(&trajectory.velocities, gains));
                let trajectory = trajectory.spread(layout);
                if actuated.len() == layout.nv() {
                    return Law::total(ComputedTorque { mechanism, trajectory, kp, kd });
                }
                let actuated: Vec<_> = (0..layout.nv()).map(|velocity| actuated.contains(&velocity)).collect();
                let external = |q: &Vec<f64>, v: &Vec<f64>| ground.ground_forces(q, v);
                Law::total(HybridComputedTorque { mechanism, trajectory, kp, kd, actuated, external })
            }
            Torque::Computed { actuated, trajectory, kp, kd } => {
                let (loops, gains) = (ClosedLoop::new(mechanism), [kp.clone(), kd.clone()]);
                let law = ClosedLoopComputedTorque::new(loops, &trajectory.velocities, trajectory, gains);
                Law::OfLoops(law.actuated(actuated))
            }
            Torque::Table { forces, .. } => Law::total(forces),
        }
    }
}

/// Limits that leave the velocities `driven` alone and let nothing act on the others.
fn only(driven: &[usize], layout: &Layout) -> Vec<f64> {
    let mut limits = vec![0.0; layout.nv()];
    for &velocity in driven {
        limits[velocity] = f64::INFINITY;
    }
    limits
}
