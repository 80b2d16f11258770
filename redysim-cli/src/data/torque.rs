//! Torque laws.

use serde::{Deserialize, Serialize};

use super::{Values, nothing_else};

/// What the actuators do.
///
/// `joints` are those that a law drives, or single velocities of them, such as `swivel.phi`, by default the actuated
/// velocities; values are in their order. `limits` are the largest forces on them, by default none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "law", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Torque {
    /// Nothing.
    #[serde(deserialize_with = "nothing_else")]
    Free,
    /// A spring: τ = kp (target − q).
    P {
        /// The joints that are driven.
        joints: Option<Vec<String>>,
        /// Where they are to be, rad or m.
        target: Values,
        /// Stiffnesses, N m/rad or N/m.
        kp: Values,
        /// The largest forces.
        limits: Option<Limits>,
    },
    /// A spring and a damper: τ = kp (target − q) − kd q̇.
    Pd {
        /// The joints that are driven.
        joints: Option<Vec<String>>,
        /// Where they are to be, rad or m.
        target: Values,
        /// Stiffnesses, N m/rad or N/m.
        kp: Values,
        /// Dampings, N m s/rad or N s/m.
        kd: Values,
        /// The largest forces.
        limits: Option<Limits>,
    },
    /// The same with integral action and anti-windup: [`redysim_runtime::Pid`].
    Pid {
        /// The joints that are driven.
        joints: Option<Vec<String>>,
        /// Where they are to be, rad or m.
        target: Values,
        /// Stiffnesses, N m/rad or N/m.
        kp: Values,
        /// Integral gains, N m/(rad s) or N/(m s).
        ki: Values,
        /// Dampings, N m s/rad or N s/m.
        kd: Values,
        /// Rates of anti-windup, 1/s; by default √(ki/kd), or ki/kp where kd is 0.
        tracking_rate: Option<Values>,
        /// The largest forces.
        limits: Option<Limits>,
    },
    /// A spring and a damper, and the forces that hold the weight: [`redysim_runtime::PdGravity`].
    PdGravity {
        /// The joints that are driven.
        joints: Option<Vec<String>>,
        /// Where they are to be, rad or m.
        target: Values,
        /// Stiffnesses, N m/rad or N/m.
        kp: Values,
        /// Dampings, N m s/rad or N s/m.
        kd: Values,
        /// What the law assumes that a link carries.
        payload: Option<Payload>,
        /// The largest forces.
        limits: Option<Limits>,
    },
    /// A spring and a damper between the joints and the trajectory: [`redysim_runtime::TrackingPd`].
    TrackingPd {
        /// The joints that are driven.
        joints: Option<Vec<String>>,
        /// Stiffnesses, N m/rad or N/m.
        kp: Values,
        /// Dampings, N m s/rad or N s/m.
        kd: Values,
        /// The largest forces.
        limits: Option<Limits>,
    },
    /// The forces that the trajectory takes, with feedback: [`redysim_runtime::ComputedTorque`].
    ComputedTorque {
        /// Of the error in position, 1/s².
        kp: Values,
        /// Of the error in velocity, 1/s.
        kd: Values,
        /// The largest forces.
        limits: Option<Limits>,
    },
    /// Springs and dampers on a frame: [`redysim_runtime::Impedance`].
    Impedance(Box<Impedance>),
    /// The forces of a table.
    Csv {
        /// The joints that are driven.
        joints: Option<Vec<String>>,
        /// The path of the table, from the folder of the scenario.
        file: String,
        /// The largest forces.
        limits: Option<Limits>,
    },
}

/// Springs and dampers on a frame of the model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Impedance {
    /// The joints that are driven.
    pub joints: Option<Vec<String>>,
    /// The frame that is held.
    pub frame: String,
    /// Where it is to be in the base frame; by default where it starts.
    pub target: Option<Target>,
    /// Stiffnesses along the axes of the desired frame, N/m.
    pub stiffness: AxisGains,
    /// Stiffnesses about them, N m/rad; by default 0.
    pub angular_stiffness: Option<AxisGains>,
    /// Dampings along them, N s/m.
    pub damping: AxisGains,
    /// Dampings about them, N m s/rad; by default 0.
    pub angular_damping: Option<AxisGains>,
    /// Which forces the law cancels; by default those of gravity.
    pub compensation: Option<Compensation>,
    /// Damping of what leaves the frame alone, 1/s; by default 0.
    pub null_space_damping: Option<f64>,
    /// What the law assumes that a link carries.
    pub payload: Option<Payload>,
    /// The largest forces.
    pub limits: Option<Limits>,
}

/// Where a frame is to be in the base frame; by default where it starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Target {
    /// Its origin, m.
    pub xyz: Option<[f64; 3]>,
    /// Roll, pitch and yaw, rad.
    pub rpy: Option<[f64; 3]>,
}

/// Gains along or about three axes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number or an array of 3 numbers")]
pub enum AxisGains {
    /// One number for all axes.
    Uniform(f64),
    /// One for each axis.
    Each([f64; 3]),
}

/// Which forces an impedance cancels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Compensation {
    /// Those of gravity.
    Gravity,
    /// Also Coriolis forces and the joints' own.
    Bias,
}

/// A mass at a point of a link, beyond those of the model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Payload {
    /// The link that carries it.
    pub link: String,
    /// Its mass, kg; negative for a link that is lighter than in the model.
    pub mass: f64,
    /// Where it is in the link's frame, m; by default at the origin.
    pub com: Option<[f64; 3]>,
}

/// The largest forces on the joints that a law drives, N m or N.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(expecting = "expected \"range\", a number, an array of numbers, or numbers by the names of joints")]
pub enum Limits {
    /// The `force` of each joint's `range` in the model.
    #[serde(rename = "range")]
    Range,
    /// These.
    #[serde(untagged)]
    Values(Values),
}
