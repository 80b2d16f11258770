//! Contacts with the ground.

use serde::{Deserialize, Serialize};

/// A plane that contacts meet: the ground, or a wall.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ground {
    /// A point of it in the base frame, m; by default the origin.
    pub point: Option<[f64; 3]>,
    /// The direction out of the ground, of any length; by default z.
    pub normal: Option<[f64; 3]>,
}

/// A frame that may touch the ground, or several of them, and the law of the force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "law", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Contact {
    /// ReDySim's law: [`redysim_runtime::ReDySimContact`].
    #[serde(rename = "redysim")]
    ReDySim {
        /// What the contact is called; by default as its frame.
        name: Option<String>,
        /// The frame, or several of them.
        frame: FrameNames,
        /// The plane that it meets; by default the ground of the scenario.
        ground: Option<Ground>,
        /// K, N/m.
        stiffness: f64,
        /// C_v, N s/m.
        damping: f64,
        /// v_max, m/s.
        leaving_speed: f64,
        /// μ.
        friction: f64,
        /// C_h, N s/m.
        sliding_damping: f64,
    },
    /// The law of Hunt and Crossley: [`redysim_runtime::HuntCrossleyContact`].
    HuntCrossley {
        /// What the contact is called; by default as its frame.
        name: Option<String>,
        /// The frame, or several of them.
        frame: FrameNames,
        /// The plane that it meets; by default the ground of the scenario.
        ground: Option<Ground>,
        /// k, N/mⁿ.
        stiffness: f64,
        /// n; by default 1.5.
        exponent: Option<f64>,
        /// d, s/m.
        damping: f64,
        /// μ.
        friction: f64,
        /// ε, m/s.
        slip_velocity: f64,
    },
}

/// A frame of the model, or several of them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged, expecting = "expected the name of a frame, or an array of names")]
pub enum FrameNames {
    /// One.
    One(String),
    /// Several, each with a contact of its own.
    Several(Vec<String>),
}
