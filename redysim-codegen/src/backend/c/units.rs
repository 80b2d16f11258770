//! The units of a mechanism's coordinates, velocities, accelerations and joint forces.

use redysim_model::Model;
use redysim_model::joint::{LinkJoint, Measure};

/// Units in the model's order; "1" is that of a component of a quaternion.
pub struct Units {
    pub coordinates: Vec<String>,
    pub velocities: Vec<String>,
    pub accelerations: Vec<String>,
    pub forces: Vec<String>,
}

impl Units {
    /// The units of a model.
    pub fn of(model: &Model) -> Units {
        let joints = || model.moving_links().filter_map(LinkJoint::of);
        let velocities: Vec<Measure> = joints().flat_map(LinkJoint::velocity_measures).collect();
        let of_velocities =
            |suffix: &str| velocities.iter().map(|measure| format!("{}{suffix}", measure.unit())).collect();
        Units {
            coordinates: joints().flat_map(LinkJoint::coordinate_measures).map(|of| of.unit().into()).collect(),
            velocities: of_velocities("/s"),
            accelerations: of_velocities("/s²"),
            forces: velocities.iter().map(|measure| measure.unit_of_force().into()).collect(),
        }
    }
}
