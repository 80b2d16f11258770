//! The public interface of a generated type: its names, sizes and functions.

use crate::joint::Joint;
use crate::model::Model;
use crate::options::CodegenOptions;
use crate::run_time::RunTimeParameter;
use crate::tree::Tree;
use redysim_runtime::function::Dimension;
use redysim_runtime::{Functions, ParameterRule};

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
    /// Number of its coordinates.
    pub nq: usize,
    /// Number of its velocities.
    pub nv: usize,
    /// Whether it has an actuator.
    pub actuated: bool,
}

impl MovingJoint {
    /// The joint `name` with the sizes of `joint`. A joint whose kind cannot be read is `None` and has one coordinate.
    pub(crate) fn new(name: String, joint: Option<Joint>, actuated: bool) -> Self {
        let [nq, nv] = joint.map_or([1, 1], |joint| [joint.nq(), joint.nv()]);
        MovingJoint { name, nq, nv, actuated }
    }
}

impl PublicInterface {
    /// A size of the mechanism.
    pub fn size(&self, dimension: Dimension) -> usize {
        match dimension {
            Dimension::Coordinates => self.joints.iter().map(|joint| joint.nq).sum(),
            Dimension::Velocities => self.joints.iter().map(|joint| joint.nv).sum(),
            Dimension::Links => self.links.len(),
            Dimension::LoopRows => self.loop_rows.len(),
            Dimension::Frames => self.frames.len(),
        }
    }

    /// Whether each velocity has an actuator: that of its joint.
    pub fn actuated(&self) -> impl Iterator<Item = bool> {
        self.joints.iter().flat_map(|joint| std::iter::repeat_n(joint.actuated, joint.nv))
    }

    /// The interface of the type that is generated from a checked model with the given options.
    pub fn new(model: &Model, options: &CodegenOptions) -> Self {
        let joints =
            model.moving_links().map(|link| MovingJoint::new(link.joint_name.clone(), Joint::of(link), link.actuated));
        let numbers = |parameter: &RunTimeParameter| {
            let (rule, named) = (parameter.quantity.rule(), parameter.names(model).zip(parameter.values(model)));
            named.map(move |(name, value)| ParameterNumber { name, value, rule })
        };
        PublicInterface {
            is_valid: true,
            name: model.name.clone(),
            links: model.links.iter().map(|link| link.name.clone()).collect(),
            joints: joints.collect(),
            loop_rows: Tree::new(model).loops_of_rows().map(|index| model.loops[index].name.clone()).collect(),
            frames: model.frames.iter().map(|frame| frame.name.clone()).collect(),
            mass: model.mass(),
            functions: options.functions.with_frames(model.frames.len()),
            parameters: options.parameters.iter().flat_map(numbers).collect(),
        }
    }
}
