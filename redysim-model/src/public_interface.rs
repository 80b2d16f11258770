//! The public interface of a generated type: its names, sizes and functions.

use crate::joint::{Joint, LinkJoint};
use crate::model::{Link, Model};
use crate::options::CodegenOptions;
use crate::run_time::RunTimeParameter;
use crate::tree::Tree;
use redysim_runtime::function::Dimension;
use redysim_runtime::{Functions, ParameterRule, VelocityCoordinates};

/// The public interface of a generated type: its names, sizes and functions. A model whose file has faults has one as
/// far as the file can be read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PublicInterface {
    /// Whether the model is valid. What the sizes of one with faults are meant to be is unknown.
    pub is_valid: bool,
    /// Name of the mechanism; empty if it cannot be read.
    pub name: String,
    /// Names of the links; "link #2" stands for one that cannot be read.
    pub links: Vec<String>,
    /// The joints that move, among them joints whose kind cannot be read.
    pub joints: Vec<MovingJoint>,
    /// For each row of the loops, the name of its loop.
    pub loop_rows: Vec<String>,
    /// Names of the frames; "frame #2" stands for one that cannot be read.
    pub frames: Vec<String>,
    /// Mass of all links, kg; zero if it cannot be read.
    pub mass: f64,
    /// The functions of the type.
    pub functions: Functions,
    /// The numbers that the type is given at run time; one without a name stands for those that cannot be read.
    pub parameters: Vec<ParameterNumber>,
}

/// A number that a type is given at run time.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterNumber {
    /// Its name.
    pub name: String,
    /// Its value in the model; zero if it cannot be read.
    pub value: f64,
    /// What it must fulfil.
    pub rule: ParameterRule,
}

/// A joint that moves, as users of a generated type see it.
#[derive(Clone, Debug, PartialEq)]
pub struct MovingJoint {
    /// Its name.
    pub name: String,
    /// Names of its coordinates.
    pub coordinates: Vec<String>,
    /// Names of its velocities.
    pub velocities: Vec<String>,
    /// Whether each of its velocities has an actuator.
    pub actuated: Vec<bool>,
}

impl MovingJoint {
    /// The joint `name` that moves as `joint` does. A joint whose kind cannot be read is `None` and has one coordinate.
    pub(crate) fn new(name: String, joint: Option<LinkJoint>, actuated: Vec<bool>) -> Self {
        let joint = joint.unwrap_or(Joint::Revolute.into());
        MovingJoint {
            coordinates: component_names(&name, joint.coordinate_names()),
            velocities: component_names(&name, joint.velocity_names()),
            name,
            actuated,
        }
    }

    /// The moving joints of a checked model, in its order.
    pub fn all(model: &Model) -> Vec<MovingJoint> {
        let joint =
            |link: &Link| MovingJoint::new(link.joint_name.clone(), LinkJoint::of(link), link.actuated_velocities());
        model.moving_links().map(joint).collect()
    }
}

/// The names of the coordinates or velocities of the joint `name`. A single one has the joint's name.
fn component_names(name: &str, components: &[&str]) -> Vec<String> {
    match components {
        [_] => vec![name.to_owned()],
        _ => components.iter().map(|component| format!("{name}.{component}")).collect(),
    }
}

impl PublicInterface {
    /// A size of the mechanism.
    pub fn size(&self, dimension: Dimension) -> usize {
        match dimension {
            Dimension::Coordinates => self.coordinate_names().count(),
            Dimension::Velocities => self.velocity_names().count(),
            Dimension::Links => self.links.len(),
            Dimension::LoopRows => self.loop_rows.len(),
            Dimension::Frames => self.frames.len(),
        }
    }

    /// The names of the coordinates, in the model's order.
    pub fn coordinate_names(&self) -> impl Iterator<Item = &str> {
        self.joints.iter().flat_map(|joint| &joint.coordinates).map(String::as_str)
    }

    /// The names of the velocities, in the model's order.
    pub fn velocity_names(&self) -> impl Iterator<Item = &str> {
        self.joints.iter().flat_map(|joint| &joint.velocities).map(String::as_str)
    }

    /// For each velocity, the coordinate whose rate it is, if there is one: not of a joint with a quaternion, which has more
    /// coordinates than velocities.
    pub fn coordinates_of_velocities(&self) -> Vec<Option<usize>> {
        let own = |moved| if let VelocityCoordinates::One(coordinate) = moved { Some(coordinate) } else { None };
        self.moved_coordinates().into_iter().map(own).collect()
    }

    /// For each velocity, the coordinates that it changes. A joint that has more coordinates than velocities ends with the
    /// quaternion of an orientation; what it has before is a position.
    pub fn moved_coordinates(&self) -> Vec<VelocityCoordinates> {
        let mut first = 0;
        let of_joint = |joint: &MovingJoint| {
            let (before, nq, nv) = (first, joint.coordinates.len(), joint.velocities.len());
            first += nq;
            (0..nv).map(move |i| match nq == nv {
                true => VelocityCoordinates::One(before + i),
                false if i + 3 < nv => VelocityCoordinates::Position(before),
                false => VelocityCoordinates::Quaternion(before + nq - 4),
            })
        };
        self.joints.iter().flat_map(of_joint).collect()
    }

    /// Whether each velocity has an actuator.
    pub fn actuated(&self) -> impl Iterator<Item = bool> {
        self.joints.iter().flat_map(|joint| joint.actuated.iter().copied())
    }

    /// The interface of the type that is generated from a checked model with the given options.
    pub fn new(model: &Model, options: &CodegenOptions) -> Self {
        let numbers = |parameter: &RunTimeParameter| {
            let numbers = parameter.numbers(model).zip(parameter.values(model));
            numbers.map(|((name, rule), value)| ParameterNumber { name, value, rule })
        };
        PublicInterface {
            is_valid: true,
            name: model.name.clone(),
            links: model.links.iter().map(|link| link.name.clone()).collect(),
            joints: MovingJoint::all(model),
            loop_rows: Tree::new(model).loops_of_rows().map(|index| model.loops[index].name.clone()).collect(),
            frames: model.frames.iter().map(|frame| frame.name.clone()).collect(),
            mass: model.mass(),
            functions: options
                .functions
                .with_frames(model.frames.len())
                .with_passive_joints(model.has_passive_joints()),
            parameters: options.parameters.iter().flat_map(numbers).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_joint_of_one_coordinate_gives_it_its_own_name() {
        assert_eq!(component_names("base", &["q"]), ["base"]);
        assert_eq!(component_names("base", &["x", "y", "qw"]), ["base.x", "base.y", "base.qw"]);
    }

    #[test]
    fn velocities_of_joints_with_one_coordinate_have_that_coordinate() {
        let joints = [("tail", Joint::Revolute), ("base", Joint::Free), ("head", Joint::Prismatic)];
        let joints = joints.map(|(name, joint)| MovingJoint::new(name.into(), Some(joint.into()), vec![true])).into();
        let interface = PublicInterface { joints, ..PublicInterface::default() };
        let free = [None; 6];
        assert_eq!(interface.coordinates_of_velocities(), [&[Some(0)][..], &free, &[Some(8)]].concat());
        let (position, orientation) = (VelocityCoordinates::Position(1), VelocityCoordinates::Quaternion(4));
        let [tail, head] = [0, 8].map(VelocityCoordinates::One);
        let expected = [&[tail][..], &[position; 3], &[orientation; 3], &[head]].concat();
        assert_eq!(interface.moved_coordinates(), expected);
    }
}
