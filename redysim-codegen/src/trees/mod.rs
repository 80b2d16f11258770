//! Passes over trees whose gain is counted: each tries a few ways to describe the same robot and keeps the cheapest.
//!
//! What a choice at one body costs shows in its [neighbourhood](neighbourhood::neighbourhood), so the time taken grows
//! with the number of bodies and no faster.

pub mod axis_masses;
pub mod frames;
pub mod neighbourhood;
pub mod still;
pub mod units;

use crate::expressions::Expressions;
use crate::functions::traced;
use crate::passes::Passes;
use redysim_model::regroup::{Vanishing, base_parameters};
use redysim_model::{Tree, denoc};

/// What a function costs on a tree, in operations.
pub type Cost<'a> = &'a dyn Fn(&Tree) -> u32;

/// The same robot as different functions want it.
pub struct Trees {
    /// With the inertias as they are.
    pub plain: Tree,
    /// For the energies, one to be chosen.
    pub energy: Vec<Tree>,
    /// For positions and velocities, one to be chosen.
    pub kinematics: Vec<Tree>,
    /// For the mass matrix and for gravity.
    pub matrix: Tree,
    /// For inverse dynamics and bias forces.
    pub bias: Tree,
}

impl Trees {
    /// The trees that the given passes make of one.
    pub fn new(tree: &Tree, passes: &Passes) -> Self {
        let inverse = |tree: &Tree| inverse_dynamics(tree).price();
        let matrix = |tree: &Tree| mass_matrix(tree).price();
        let mut plain = tree.clone();
        if passes.frames {
            plain = frames::chosen(&plain, &|tree| inverse(tree) + matrix(tree));
        }
        // Joint forces, the mass matrix and the energies of the whole mechanism are the same for base parameters.
        let mut trees = if passes.base_parameters {
            let base = base_parameters(&plain, Vanishing::SecondMomentZz);
            let energy = vec![base_parameters(&plain, Vanishing::TensorYy)];
            Trees { energy, kinematics: vec![tree.clone()], matrix: base.clone(), bias: base, plain }
        } else {
            let [energy, kinematics] = [&plain, tree].map(|tree| vec![tree.clone()]);
            Trees { energy, kinematics, matrix: plain.clone(), bias: plain.clone(), plain }
        };
        if passes.parallel_axes {
            trees.bias = still::stilled(&trees.bias, &inverse);
            trees.matrix = still::stilled(&trees.matrix, &matrix);
            trees.kinematics.extend(still::everywhere(tree));
        }
        if passes.base_parameters && passes.axis_masses {
            trees.bias = axis_masses::placed(&trees.bias, &inverse);
        }
        if passes.units {
            trees.bias = units::chosen(&trees.bias, &inverse_dynamics(&trees.bias));
            trees.matrix = units::chosen(&trees.matrix, &mass_matrix(&trees.matrix));
        }
        trees.energy.push(trees.matrix.clone());
        trees
    }
}

/// What inverse dynamics and the mass matrix cost, without the passes over expressions: these take most of the time, and
/// what they gain differs little from choice to choice.
fn inverse_dynamics(tree: &Tree) -> Expressions {
    traced(tree, &Passes::none(), 3, |x| denoc::inverse_dynamics(tree, x[0], x[1], x[2]))
}

fn mass_matrix(tree: &Tree) -> Expressions {
    traced(tree, &Passes::none(), 1, |x| denoc::mass_matrix(tree, x[0]).concat())
}
