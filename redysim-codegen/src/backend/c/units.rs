//! The units of a mechanism's coordinates, velocities, accelerations, joint forces and run-time parameters.

use redysim_model::joint::{LinkJoint, Measure};
use redysim_model::{Model, Quantity, RunTimeParameter};

/// Units in the model's order; "1" is that of a component of a quaternion.
pub struct Units {
    pub coordinates: Vec<String>,
    pub velocities: Vec<String>,
    pub accelerations: Vec<String>,
    pub forces: Vec<String>,
    /// Of each number of each parameter.
    pub parameters: Vec<String>,
}

impl Units {
    /// The units of a model with run-time parameters.
    pub fn of(model: &Model, parameters: &[RunTimeParameter]) -> Units {
        let joints = || model.moving_links().filter_map(LinkJoint::of);
        let velocities: Vec<Measure> = joints().flat_map(LinkJoint::velocity_measures).collect();
        let of_velocities =
            |suffix: &str| velocities.iter().map(|measure| format!("{}{suffix}", measure.unit())).collect();
        Units {
            coordinates: joints().flat_map(LinkJoint::coordinate_measures).map(|of| of.unit().into()).collect(),
            velocities: of_velocities("/s"),
            accelerations: of_velocities("/s²"),
            forces: velocities.iter().map(|measure| measure.unit_of_force().into()).collect(),
            parameters: parameters.iter().flat_map(|parameter| of_parameter(*parameter, model)).collect(),
        }
    }
}

/// The units of the numbers of a parameter.
fn of_parameter(parameter: RunTimeParameter, model: &Model) -> Vec<String> {
    let joint = parameter.link.and_then(|link| LinkJoint::of(&model.links[link]));
    let by_velocity = |of: fn(Measure) -> String| -> Vec<String> {
        joint.map(LinkJoint::velocity_measures).unwrap_or_default().into_iter().map(of).collect()
    };
    match parameter.quantity {
        Quantity::Gravity => vec!["m/s²".into(); 3],
        Quantity::Mass => vec!["kg".into()],
        Quantity::Com => vec!["m".into(); 3],
        Quantity::Inertia => vec!["kg m²".into(); 6],
        Quantity::Armature => by_velocity(|measure| if measure == Measure::Angle { "kg m²" } else { "kg" }.into()),
        Quantity::Damping => by_velocity(|measure| match measure {
            Measure::Angle => "N m s/rad".into(),
            _ => "N s/m".into(),
        }),
        Quantity::Friction => by_velocity(|measure| measure.unit_of_force().into()),
        Quantity::FrictionVelocity => by_velocity(|measure| format!("{}/s", measure.unit())),
        Quantity::Stiffness => by_velocity(|measure| format!("{}/{}", measure.unit_of_force(), measure.unit())),
        Quantity::Rest => {
            let measures = joint.map(LinkJoint::coordinate_measures).unwrap_or_default();
            measures.into_iter().map(|measure| measure.unit().into()).collect()
        }
        // The unit of a quantity that is not listed is 1 in C and in the FMU.
        _ => vec!["1".into(); parameter.values(model).len()],
    }
}
