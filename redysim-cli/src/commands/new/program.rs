//! The program of a new crate.

use super::robot::Robot;
use crate::closed::{closed_position, independent_velocities};
use crate::failure::Failure;
use crate::layout::Layout;
use redysim_model::{Function, GenericMechanism};
use redysim_toml::words::quoted;

const TREE: &str = include_str!("tree.rs.txt");
const LOOPS: &str = include_str!("loops.rs.txt");

/// `src/main.rs`.
///
/// # Errors
/// If the loops of the robot cannot be closed.
pub fn of(robot: &Robot) -> Result<String, Failure> {
    let layout = Layout::of(&robot.model);
    let turning = layout.velocities.iter().filter(|velocity| velocity.turns()).count();
    let (force, acceleration) = match turning {
        0 => ("N", "m/s²"),
        all if all == layout.velocities.len() => ("N m", "rad/s²"),
        _ => ("N m or N", "rad/s² or m/s²"),
    };
    let general = [
        ("{robot}", robot.title()),
        ("{Robot}", robot.type_name()),
        ("{declaration}", declaration(robot)),
        ("{force}", force.to_string()),
        ("{acceleration}", acceleration.to_string()),
    ];
    if robot.model.loops.is_empty() {
        return Ok(filled(TREE, &general));
    }
    if let Some(joint) = layout.joints.iter().find(|joint| joint.is_in_space()) {
        let name = quoted(&joint.name);
        let message = format!("the robot has closed loops, and the joint {name} has several coordinates");
        let help = "no program is made for both together: take `redysim generate`, and ClosedLoop of redysim-runtime";
        return Err(Failure::input(message).help(help));
    }
    let mechanism = GenericMechanism::new(robot.model.clone());
    let start = layout.coordinates.iter().map(|coordinate| coordinate.neutral).collect();
    let q = closed_position(&mechanism, start).map_err(|why| Failure::input(format!("the loops stay open: {why}")))?;
    let actuated: Vec<bool> = layout.velocities.iter().map(|velocity| velocity.actuated).collect();
    let independent = independent_velocities(&mechanism, &q, &actuated);
    let names: Vec<_> = independent.iter().map(|&velocity| quoted(&layout.velocities[velocity].name)).collect();
    let guess: Vec<_> = q.iter().map(|q| format!("{q:.4}")).collect();
    let of_loops = [
        ("{guess}", format!("[{}]", guess.join(", "))),
        ("{names}", names.join(", ")),
        ("{count}", independent.len().to_string()),
        ("{independent}", format!("{independent:?}")),
    ];
    Ok(filled(&filled(LOOPS, &general), &of_loops))
}

/// The model's path, and what the program needs of it otherwise than its file has it.
fn declaration(robot: &Robot) -> String {
    let needed: &[Function] = if robot.model.loops.is_empty() {
        &[Function::InverseDynamics, Function::ForwardDynamics]
    } else {
        &[
            Function::InverseDynamics,
            Function::MassMatrix,
            Function::BiasForces,
            Function::LoopResidual,
            Function::LoopJacobian,
            Function::LoopBias,
        ]
    };
    let mut declaration = format!("\"{}\"", robot.path());
    if !needed.iter().all(|function| robot.options.functions.contains(*function)) {
        let names: Vec<_> = needed.iter().map(|function| function.name()).collect();
        declaration += &format!(", functions = [{}]", names.join(", "));
    }
    if !robot.options.parameters.is_empty() {
        declaration += ", parameters = []";
    }
    declaration
}

fn filled(template: &str, values: &[(&str, String)]) -> String {
    values.iter().fold(template.to_string(), |text, (name, value)| text.replace(name, value))
}
