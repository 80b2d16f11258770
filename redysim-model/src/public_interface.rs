//! The public interface of a generated type: its names, sizes and functions.

use crate::model::Model;
use crate::options::CodegenOptions;
use crate::tree::Tree;
use redysim_runtime::Functions;
use redysim_runtime::function::Dimension;

/// The public interface of a generated type: its names, sizes and functions. A model whose file has faults has one as
/// far as the file can be read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PublicInterface {
    /// Name of the mechanism; empty if it cannot be read.
    pub name: String,
    /// Names of the links; "link #2" stands for one that cannot be read.
    pub links: Vec<String>,
    /// Names of the joints that move, among them joints whose kind cannot be read.
    pub joints: Vec<String>,
    /// Whether each of these has an actuator.
    pub actuated: Vec<bool>,
    /// For each row of the loops, the name of its loop.
    pub loop_rows: Vec<String>,
    /// Mass of all links, kg; zero if it cannot be read.
    pub mass: f64,
    /// The functions of the type.
    pub functions: Functions,
}

impl PublicInterface {
    /// A size of the mechanism.
    pub fn size(&self, dimension: Dimension) -> usize {
        match dimension {
            Dimension::Coordinates | Dimension::Velocities => self.joints.len(),
            Dimension::Links => self.links.len(),
            Dimension::LoopRows => self.loop_rows.len(),
        }
    }

    /// The interface of the type that is generated from a checked model with the given options.
    pub fn new(model: &Model, options: &CodegenOptions) -> Self {
        PublicInterface {
            name: model.name.clone(),
            links: model.links.iter().map(|link| link.name.clone()).collect(),
            joints: model.moving_links().map(|link| link.joint_name.clone()).collect(),
            actuated: model.moving_links().map(|link| link.actuated).collect(),
            loop_rows: Tree::new(model).loops_of_rows().map(|index| model.loops[index].name.clone()).collect(),
            mass: model.mass(),
            functions: options.functions,
        }
    }
}
