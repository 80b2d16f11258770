//! Passes over trees whose gain is counted: each tries a few ways to describe the same robot and keeps the cheapest.
//!
//! What a choice at one body costs shows in its [neighbourhood](neighbourhood::neighbourhood), so the time taken grows
//! with the number of bodies and no faster.

pub mod axis_masses;
pub mod frames;
pub mod neighbourhood;
pub mod still;
pub mod units;

use crate::accuracy::{MEASURED, Reference};
use crate::expressions::Expressions;
use crate::passes::{PassError, Passes};
use crate::policies::{MOST_LOST_BY_DESCRIPTION, ROUNDINGS};
use crate::tracing::{simplified_on, traced_on};
use redysim_model::joint::Vanishing;
use redysim_model::regroup::move_to_parent;
use redysim_model::{Function, Tree};
use std::cell::OnceCell;

/// What a function costs on a tree, in operations.
pub type Cost<'a> = &'a dyn Fn(&Tree) -> u32;
/// Whether a tree keeps the digits that the model's own description has.
pub type Keeps<'a> = &'a dyn Fn(&Tree) -> bool;

/// What is computed on the tree for inverse dynamics and bias forces.
const FORCES: &[Function] = &[Function::InverseDynamics, Function::BiasForces];
/// What is computed on the tree for the mass matrix and gravity.
const MATRIX: &[Function] = &[Function::MassMatrix, Function::GravityForces];

/// The same robot as different functions want it. What no function asks for is never made.
///
/// A pass that would cost digits is taken as far as it does not: for the whole robot if that keeps them, else body by
/// body.
pub struct Trees<'a> {
    tree: &'a Tree,
    passes: &'a Passes,
    reference: &'a Reference<'a>,
    /// What is lost in any case, of each function.
    lost: [OnceCell<f64>; Function::ALL.len()],
    plain: OnceCell<Tree>,
    base: OnceCell<Tree>,
    matrix: OnceCell<Tree>,
    bias: OnceCell<Tree>,
}

impl<'a> Trees<'a> {
    /// What the given passes make of one tree, of which `reference` has the exact numbers.
    pub fn new(tree: &'a Tree, passes: &'a Passes, reference: &'a Reference<'a>) -> Self {
        let [plain, base, matrix, bias] = [const { OnceCell::new() }; 4];
        Trees {
            tree,
            passes,
            reference,
            lost: [const { OnceCell::new() }; Function::ALL.len()],
            plain,
            base,
            matrix,
            bias,
        }
    }

    /// The exact numbers of the robot.
    pub fn reference(&self) -> &Reference<'a> {
        self.reference
    }

    /// Whether a description of the robot keeps the digits of what is computed on it.
    fn keeps(&self, tree: &Tree, functions: &[Function]) -> bool {
        functions.iter().all(|&function| self.reference.lost_on(tree, function) <= self.bearable(function))
    }

    /// How much of a function may be lost.
    fn bearable(&self, function: Function) -> f64 {
        let least = *self.lost[function as usize].get_or_init(|| self.reference.least_loss(function));
        // Accelerations are quotients: even a small robot's have some more roundings.
        let few = if function == Function::ForwardDynamics { 4.0 * ROUNDINGS } else { ROUNDINGS };
        MOST_LOST_BY_DESCRIPTION * least.max(few)
    }

    /// The descriptions on which a function may be computed, from the cheapest to the model's own.
    fn descriptions(&self, function: Function) -> [&Tree; 3] {
        let cheapest = if FORCES.contains(&function) {
            self.bias()
        } else if MATRIX.contains(&function) {
            self.matrix()
        } else {
            self.plain()
        };
        [cheapest, self.plain(), self.tree]
    }

    /// A function on the cheapest description of the robot on which it keeps its digits; in the end on the model's own,
    /// without passes over expressions. Forward dynamics is by the recursion.
    pub fn keeping_digits(&self, function: Function) -> Result<Expressions, PassError> {
        let bearable = self.bearable(function);
        for tree in self.descriptions(function) {
            let expressions = simplified_on(tree, function, self.passes)?;
            if self.reference.lost_by(function, |x| expressions.evaluate(x)) <= bearable {
                return Ok(expressions);
            }
        }
        simplified_on(self.tree, function, &Passes { loops: self.passes.loops, ..Passes::none() })
    }

    /// With the inertias as they are.
    pub fn plain(&self) -> &Tree {
        self.plain.get_or_init(|| {
            if self.passes.frames {
                let cost = |tree: &Tree| inverse_price(tree) + matrix_price(tree);
                self.as_far_as_kept(&MEASURED, |keeps| frames::chosen(self.tree, &cost, keeps))
            } else {
                self.tree.clone()
            }
        })
    }

    /// What `pass` makes of the robot if nothing stops it; where that costs digits, what it makes if each of its steps
    /// must keep them.
    fn as_far_as_kept(&self, functions: &[Function], pass: impl Fn(Keeps) -> Tree) -> Tree {
        let all = pass(&|_| true);
        if self.keeps(&all, functions) { all } else { pass(&|tree| self.keeps(tree, functions)) }
    }

    /// Of base parameters: joint forces, the mass matrix and the energies of the whole mechanism are the same for them.
    fn base(&self) -> &Tree {
        self.base.get_or_init(|| self.regrouped(Vanishing::SecondMomentZz))
    }

    fn regrouped(&self, vanishing: Vanishing) -> Tree {
        let plain = self.plain();
        if !self.passes.base_parameters {
            return plain.clone();
        }
        self.as_far_as_kept(&[FORCES, MATRIX].concat(), |keeps| {
            let mut tree = plain.clone();
            for body in (0..tree.bodies.len()).rev() {
                let mut other = tree.clone();
                move_to_parent(&mut other, body, vanishing);
                if keeps(&other) {
                    tree = other;
                }
            }
            tree
        })
    }

    /// For the energies, one to be chosen.
    pub fn energy(&self) -> Vec<Tree> {
        vec![self.regrouped(Vanishing::TensorYy), self.matrix().clone()]
    }

    /// For the centre of mass, one to be chosen: with the inertias as they are, or with mass moved towards the ground.
    pub fn moments(&self) -> Vec<Tree> {
        self.kinematics().into_iter().chain([self.regrouped(Vanishing::TensorYy)]).collect()
    }

    /// For positions and velocities, one to be chosen.
    pub fn kinematics(&self) -> Vec<Tree> {
        let still = if self.passes.parallel_axes { still::everywhere(self.tree) } else { None };
        std::iter::once(self.tree.clone()).chain(still).collect()
    }

    /// For the mass matrix and for gravity.
    pub fn matrix(&self) -> &Tree {
        self.matrix.get_or_init(|| {
            let stilled = self.stilled(MATRIX, &matrix_price);
            self.in_unit(MATRIX, stilled, mass_matrix)
        })
    }

    /// For inverse dynamics and bias forces.
    pub fn bias(&self) -> &Tree {
        self.bias.get_or_init(|| {
            let mut bias = self.stilled(FORCES, &inverse_price);
            if self.passes.base_parameters && self.passes.axis_masses {
                bias = self.as_far_as_kept(FORCES, |keeps| axis_masses::placed(&bias, &inverse_price, keeps));
            }
            self.in_unit(FORCES, bias, inverse_dynamics)
        })
    }

    fn stilled(&self, functions: &[Function], cost: Cost) -> Tree {
        if self.passes.parallel_axes {
            self.as_far_as_kept(functions, |keeps| still::stilled(self.base(), cost, keeps))
        } else {
            self.base().clone()
        }
    }

    fn in_unit(&self, functions: &[Function], tree: Tree, expressions: fn(&Tree) -> Expressions) -> Tree {
        if !self.passes.units {
            return tree;
        }
        let other = units::chosen(&tree, &expressions(&tree));
        if self.keeps(&other, functions) { other } else { tree }
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
    traced_on(tree, Function::InverseDynamics)
}

fn mass_matrix(tree: &Tree) -> Expressions {
    traced_on(tree, Function::MassMatrix)
}
