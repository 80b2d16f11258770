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
use std::cell::OnceCell;

/// What a function costs on a tree, in operations.
pub type Cost<'a> = &'a dyn Fn(&Tree) -> u32;

/// The same robot as different functions want it. What no function asks for is never made.
pub struct Trees<'a> {
    tree: &'a Tree,
    passes: &'a Passes,
    plain: OnceCell<Tree>,
    base: OnceCell<Tree>,
    matrix: OnceCell<Tree>,
    bias: OnceCell<Tree>,
}

impl<'a> Trees<'a> {
    /// What the given passes make of one tree.
    pub fn new(tree: &'a Tree, passes: &'a Passes) -> Self {
        let [plain, base, matrix, bias] = [const { OnceCell::new() }; 4];
        Trees { tree, passes, plain, base, matrix, bias }
    }

    /// With the inertias as they are.
    pub fn plain(&self) -> &Tree {
        self.plain.get_or_init(|| {
            if self.passes.frames {
                frames::chosen(self.tree, &|tree| inverse_price(tree) + matrix_price(tree))
            } else {
                self.tree.clone()
            }
        })
    }

    /// Of base parameters: joint forces, the mass matrix and the energies of the whole mechanism are the same for them.
    fn base(&self) -> &Tree {
        self.base.get_or_init(|| {
            if self.passes.base_parameters {
                base_parameters(self.plain(), Vanishing::SecondMomentZz)
            } else {
                self.plain().clone()
            }
        })
    }

    /// For the energies, one to be chosen.
    pub fn energy(&self) -> Vec<Tree> {
        let plain = self.plain();
        let own = if self.passes.base_parameters { base_parameters(plain, Vanishing::TensorYy) } else { plain.clone() };
        vec![own, self.matrix().clone()]
    }

    /// For positions and velocities, one to be chosen.
    pub fn kinematics(&self) -> Vec<Tree> {
        let still = if self.passes.parallel_axes { still::everywhere(self.tree) } else { None };
        std::iter::once(self.tree.clone()).chain(still).collect()
    }

    /// For the mass matrix and for gravity.
    pub fn matrix(&self) -> &Tree {
        self.matrix.get_or_init(|| {
            let mut matrix = self.base().clone();
            if self.passes.parallel_axes {
                matrix = still::stilled(&matrix, &matrix_price);
            }
            if self.passes.units {
                matrix = units::chosen(&matrix, &mass_matrix(&matrix));
            }
            matrix
        })
    }

    /// For inverse dynamics and bias forces.
    pub fn bias(&self) -> &Tree {
        self.bias.get_or_init(|| {
            let mut bias = self.base().clone();
            if self.passes.parallel_axes {
                bias = still::stilled(&bias, &inverse_price);
            }
            if self.passes.base_parameters && self.passes.axis_masses {
                bias = axis_masses::placed(&bias, &inverse_price);
            }
            if self.passes.units {
                bias = units::chosen(&bias, &inverse_dynamics(&bias));
            }
            bias
        })
    }
}

fn inverse_price(tree: &Tree) -> u32 {
    inverse_dynamics(tree).price()
}

fn matrix_price(tree: &Tree) -> u32 {
    mass_matrix(tree).price()
}

/// What inverse dynamics and the mass matrix cost, without the passes over expressions: these take most of the time,
/// and what they gain differs little from choice to choice.
fn inverse_dynamics(tree: &Tree) -> Expressions {
    traced(tree, &Passes::none(), 3, |x| denoc::inverse_dynamics(tree, x[0], x[1], x[2]))
}

fn mass_matrix(tree: &Tree) -> Expressions {
    traced(tree, &Passes::none(), 1, |x| denoc::mass_matrix(tree, x[0]).concat())
}
