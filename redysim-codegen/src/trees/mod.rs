//! Passes over trees: each tries a few descriptions of the same robot and takes the cheapest.
//!
//! The cost of a choice at one body is counted on its [neighbourhood](neighbourhood::neighbourhood), so that the time
//! grows linearly with the number of bodies.

pub mod axis_masses;
pub mod frames;
pub mod neighbourhood;
pub mod parallel_axes;
pub mod units;

use crate::accuracy::{MEASURED, Reference};
use crate::expressions::Expressions;
use crate::passes::{PassError, Passes};
use crate::policies::{MOST_LOST_BY_DESCRIPTION, ROUNDINGS};
use crate::symbol::{Symbol, SymbolicTree};
use crate::tracing::{simplified_on, traced_on};
use redysim_model::joint::Vanishing;
use redysim_model::regroup::move_to_parent;
use redysim_model::{Function, Tree};
use std::cell::OnceCell;

/// The cost of a function on a tree, in operations.
pub type Cost<'a, P> = &'a dyn Fn(&Tree<P>) -> u32;
/// Whether a tree keeps the digits that the model's own description has.
pub type KeepsDigits<'a, P> = &'a dyn Fn(&Tree<P>) -> bool;

/// The functions on the tree for inverse dynamics.
const FORCES: &[Function] = &[Function::InverseDynamics, Function::BiasForces];
/// The functions on the tree for the mass matrix.
const MATRIX: &[Function] = &[Function::MassMatrix, Function::GravityForces];

/// The descriptions of a robot for its functions, each made when it is first needed.
///
/// A pass is applied to the whole robot. If that costs digits, it is applied body by body, without the steps that do.
pub struct Trees<'a, 'p> {
    tree: &'a SymbolicTree<'p>,
    passes: &'a Passes,
    reference: &'a Reference<'a>,
    /// The loss of each function in any description.
    least_losses: [OnceCell<f64>; Function::ALL.len()],
    plain: OnceCell<SymbolicTree<'p>>,
    base: OnceCell<SymbolicTree<'p>>,
    matrix: OnceCell<SymbolicTree<'p>>,
    bias: OnceCell<SymbolicTree<'p>>,
}

impl<'a, 'p> Trees<'a, 'p> {
    /// The descriptions that the given passes make of `tree`, of which `reference` has the exact values.
    pub fn new(tree: &'a SymbolicTree<'p>, passes: &'a Passes, reference: &'a Reference<'a>) -> Self {
        let [plain, base, matrix, bias] = [const { OnceCell::new() }; 4];
        Trees {
            tree,
            passes,
            reference,
            least_losses: [const { OnceCell::new() }; Function::ALL.len()],
            plain,
            base,
            matrix,
            bias,
        }
    }

    /// The exact values of the robot's functions.
    pub fn reference(&self) -> &Reference<'a> {
        self.reference
    }

    /// Whether a description of the robot keeps the digits of the functions.
    fn keeps_digits(&self, tree: &SymbolicTree<'p>, functions: &[Function]) -> bool {
        let nominal = tree.map(Symbol::nominal);
        functions.iter().all(|&function| self.reference.loss_on(&nominal, function) <= self.allowed_loss(function))
    }

    /// The loss that a function may have.
    fn allowed_loss(&self, function: Function) -> f64 {
        let least = *self.least_losses[function as usize].get_or_init(|| self.reference.least_loss(function));
        // Accelerations are quotients, which have more roundings even for a small robot.
        let few = if function == Function::ForwardDynamics { 4.0 * ROUNDINGS } else { ROUNDINGS };
        MOST_LOST_BY_DESCRIPTION * least.max(few)
    }

    /// The descriptions on which a function may be computed, from the cheapest to the model's own.
    fn descriptions(&self, function: Function) -> [&SymbolicTree<'p>; 3] {
        let cheapest = if FORCES.contains(&function) {
            self.bias()
        } else if MATRIX.contains(&function) {
            self.matrix()
        } else {
            self.plain()
        };
        [cheapest, self.plain(), self.tree]
    }

    /// A function on the cheapest description on which it keeps its digits. If every description loses digits, the
    /// function is traced on the model's own, without passes over expressions. Forward dynamics is by the recursion.
    pub fn keeping_digits(&self, function: Function) -> Result<Expressions, PassError> {
        let allowed_loss = self.allowed_loss(function);
        for tree in self.descriptions(function) {
            let expressions = simplified_on(tree, function, self.passes)?;
            if self.reference.loss_by(function, |x| expressions.evaluate(x)) <= allowed_loss {
                return Ok(expressions);
            }
        }
        simplified_on(self.tree, function, &Passes { loops: self.passes.loops, ..Passes::none() })
    }

    /// With the inertias of the model.
    pub fn plain(&self) -> &SymbolicTree<'p> {
        self.plain.get_or_init(|| {
            if self.passes.frames {
                let cost = |tree: &SymbolicTree<'p>| inverse_price(tree) + matrix_price(tree);
                self.without_loss(&MEASURED, |keeps_digits| frames::chosen(self.tree, &cost, keeps_digits))
            } else {
                self.tree.clone()
            }
        })
    }

    /// The tree that `pass` makes. If that costs digits, the one that it makes if each of its steps must keep them.
    fn without_loss(
        &self,
        functions: &[Function],
        pass: impl Fn(KeepsDigits<Symbol<'p>>) -> SymbolicTree<'p>,
    ) -> SymbolicTree<'p> {
        let all = pass(&|_| true);
        if self.keeps_digits(&all, functions) { all } else { pass(&|tree| self.keeps_digits(tree, functions)) }
    }

    /// With base parameters, for which joint forces, the mass matrix and the total energies are the same.
    fn base(&self) -> &SymbolicTree<'p> {
        self.base.get_or_init(|| self.regrouped(Vanishing::SecondMomentZz))
    }

    fn regrouped(&self, vanishing: Vanishing) -> SymbolicTree<'p> {
        let plain = self.plain();
        if !self.passes.base_parameters {
            return plain.clone();
        }
        self.without_loss(&[FORCES, MATRIX].concat(), |keeps_digits| {
            let mut tree = plain.clone();
            for body in (0..tree.bodies.len()).rev() {
                let mut other = tree.clone();
                move_to_parent(&mut other, body, vanishing);
                if keeps_digits(&other) {
                    tree = other;
                }
            }
            tree
        })
    }

    /// The candidates for a function of M(q) and its derivatives.
    pub fn dynamics(&self) -> Vec<SymbolicTree<'p>> {
        [self.matrix(), self.bias(), self.plain()].map(Tree::clone).into()
    }

    /// The candidates for the energies.
    pub fn energy(&self) -> Vec<SymbolicTree<'p>> {
        vec![self.regrouped(Vanishing::TensorYy), self.matrix().clone()]
    }

    /// The candidates for the centre of mass: with the inertias of the model, or with mass moved towards the ground.
    pub fn moments(&self) -> Vec<SymbolicTree<'p>> {
        self.kinematics().into_iter().chain([self.regrouped(Vanishing::TensorYy)]).collect()
    }

    /// The candidates for positions and velocities.
    pub fn kinematics(&self) -> Vec<SymbolicTree<'p>> {
        let merged = if self.passes.parallel_axes { parallel_axes::merged_everywhere(self.tree) } else { None };
        std::iter::once(self.tree.clone()).chain(merged).collect()
    }

    /// For the mass matrix and gravity forces.
    pub fn matrix(&self) -> &SymbolicTree<'p> {
        self.matrix.get_or_init(|| {
            let merged = self.merged(MATRIX, &matrix_price);
            self.in_unit(MATRIX, merged, mass_matrix)
        })
    }

    /// For inverse dynamics and bias forces.
    pub fn bias(&self) -> &SymbolicTree<'p> {
        self.bias.get_or_init(|| {
            let mut bias = self.merged(FORCES, &inverse_price);
            if self.passes.base_parameters && self.passes.axis_masses {
                bias = self.with_placed_masses(&bias);
                // Which axes are best depends on where the masses are.
                if self.passes.parallel_axes
                    && let Some(carriers) = parallel_axes::merged_carriers(self.base())
                    && let other = self.with_placed_masses(&carriers)
                    && inverse_price(&other) < inverse_price(&bias)
                    && self.keeps_digits(&other, FORCES)
                {
                    bias = other;
                }
            }
            self.in_unit(FORCES, bias, inverse_dynamics)
        })
    }

    fn with_placed_masses(&self, tree: &SymbolicTree<'p>) -> SymbolicTree<'p> {
        self.without_loss(FORCES, |keeps_digits| axis_masses::placed(tree, &inverse_price, keeps_digits))
    }

    fn merged(&self, functions: &[Function], cost: Cost<Symbol<'p>>) -> SymbolicTree<'p> {
        if self.passes.parallel_axes {
            self.without_loss(functions, |keeps_digits| parallel_axes::merged(self.base(), cost, keeps_digits))
        } else {
            self.base().clone()
        }
    }

    fn in_unit(
        &self,
        functions: &[Function],
        tree: SymbolicTree<'p>,
        expressions: fn(&SymbolicTree<'p>) -> Expressions,
    ) -> SymbolicTree<'p> {
        if !self.passes.units {
            return tree;
        }
        let other = units::chosen(&tree, &expressions(&tree));
        if self.keeps_digits(&other, functions) { other } else { tree }
    }
}

fn inverse_price(tree: &SymbolicTree) -> u32 {
    inverse_dynamics(tree).price()
}

fn matrix_price(tree: &SymbolicTree) -> u32 {
    mass_matrix(tree).price()
}

/// Costs are counted without the passes over expressions, which would take most of the time and whose gain differs
/// little between descriptions.
fn inverse_dynamics(tree: &SymbolicTree) -> Expressions {
    traced_on(tree, Function::InverseDynamics)
}

fn mass_matrix(tree: &SymbolicTree) -> Expressions {
    traced_on(tree, Function::MassMatrix)
}
