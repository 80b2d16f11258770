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

/// A torque law, as the scenario has it: its values are those of the joints that it drives.
#[derive(Clone, Debug)]
pub enum Torque {
    Zero,
    P {
        joints: Vec<usize>,
        target: Vec<f64>,
        kp: Vec<f64>,
    },
    Pd {
        joints: Vec<usize>,
        target: Vec<f64>,
        kp: Vec<f64>,
        kd: Vec<f64>,
    },
    Pid {
        joints: Vec<usize>,
        target: Vec<f64>,
        kp: Vec<f64>,
        ki: Vec<f64>,
        kd: Vec<f64>,
        tracking_rate: Vec<f64>,
    },
    PdGravity {
        joints: Vec<usize>,
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
        joints: Vec<usize>,
        limits: Vec<f64>,
    },
    /// A spring and a damper to a motion.
    TrackingPd {
        joints: Vec<usize>,
        trajectory: Prescribed,
        kp: Vec<f64>,
        kd: Vec<f64>,
    },
    /// The same, with the model; its gains are those of the joints that are prescribed, of closed loops the independent
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
        joints: Vec<usize>,
        forces: Forces,
    },
}

impl Torque {
    /// The joints that the law drives, given or by default.
    pub fn joints(&self) -> Option<&[usize]> {
        match self.unlimited() {
            Torque::Zero | Torque::Computed { .. } | Torque::Limited { .. } => None,
            Torque::P { joints, .. }
            | Torque::Pd { joints, .. }
            | Torque::Pid { joints, .. }
            | Torque::PdGravity { joints, .. }
            | Torque::Impedance(HeldFrame { joints, .. })
            | Torque::TrackingPd { joints, .. }
            | Torque::Table { joints, .. } => Some(joints),
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
            |joints: &[usize], values: &[f64]| spread(&layout.coordinates_of(joints), values, &layout.coordinates);
        let whole =
            |joints: &[usize], values: &[f64]| spread(&layout.velocities_of(joints), values, &layout.velocities);
        match self {
            Torque::Zero => Law::total(ZeroTorque),
            Torque::P { joints, target, kp } => {
                Law::total(Proportional { target: positions(joints, target), kp: whole(joints, kp) })
            }
            Torque::Pd { joints, target, kp, kd } => {
                let [kp, kd] = [kp, kd].map(|gains| whole(joints, gains));
                Law::total(Pd { target: positions(joints, target), kp, kd })
            }
            Torque::Pid { joints, target, kp, ki, kd, tracking_rate } => {
                let [kp, ki, kd, tracking] = [kp, ki, kd, tracking_rate].map(|gains| whole(joints, gains));
                let trajectory = SetPoint::new(mechanism, positions(joints, target));
                Law::total(Pid { trajectory, kp, ki, kd, tracking, integral: vec![0.0; layout.nv()] })
            }
            Torque::PdGravity { joints, target, kp, kd, laden } => {
                let [kp, kd] = [kp, kd].map(|gains| whole(joints, gains));
                let trajectory = SetPoint::new(mechanism, positions(joints, target));
                let law = PdGravity { mechanism: laden.as_deref().unwrap_or(mechanism), trajectory, kp, kd };
                Law::total(Limited { law, limits: only(joints, layout) })
            }
            Torque::Impedance(held) => {
                Law::total(Limited { law: held.law(mechanism, initial), limits: only(&held.joints, layout) })
            }
            Torque::Limited { law, joints, limits } => {
                let mut all = vec![f64::INFINITY; layout.nv()];
                for (velocity, &limit) in layout.velocities_of(joints).into_iter().zip(limits) {
                    all[velocity] = limit;
                }
                Law::limited(law.law(ground, layout, initial), all)
            }
            Torque::TrackingPd { joints, trajectory, kp, kd } => {
                let [kp, kd] = [kp, kd].map(|gains| whole(joints, gains));
                Law::total(TrackingPd { trajectory: trajectory.spread(layout), kp, kd })
            }
            Torque::Computed { actuated, trajectory, kp, kd } if mechanism.model().loops.is_empty() => {
                let [kp, kd] = [kp, kd].map(|gains| whole(&trajectory.joints, gains));
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

/// Limits that leave the joints `driven` alone and let nothing act on the others.
fn only(driven: &[usize], layout: &Layout) -> Vec<f64> {
    let mut limits = vec![0.0; layout.nv()];
    for velocity in layout.velocities_of(driven) {
        limits[velocity] = f64::INFINITY;
    }
    limits
}
