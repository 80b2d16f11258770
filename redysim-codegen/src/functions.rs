//! The functions of a compiled mechanism: from a model to expressions, step by step.

use crate::accuracy::Reference;
use crate::expressions::Expressions;
use crate::forward_dynamics;
pub use crate::forward_dynamics::{MethodChoice, MethodFigures};
use crate::lumping::{lumped, tree_with_parameters};
use crate::passes::{PassError, Passes, applied, simplified};
use crate::policies::LONGEST_CHAIN_BY_FACTORISATION;
use crate::pruning::{Given, Pruning, StateRange, States, pruned};
use crate::reroll;
use crate::siblings::{self, Siblings};
use crate::symbol::{Symbol, SymbolicTree, Tracer};
use crate::tracing::{simplified_on, traced};
use crate::trees::Trees;
use redysim_model::denoc::EliminationOrder;
use redysim_model::{CodegenOptions, Function, Link, Model, Tree, denoc};
use redysim_runtime::function::Shape;
use std::cell::{LazyCell, OnceCell};

/// One traced function.
#[derive(Clone, Debug)]
pub struct TracedFunction {
    /// Which function of a mechanism it is.
    pub function: Function,
    /// By which algorithm it is computed, if there are several.
    pub method: Option<MethodChoice>,
    /// Its expressions.
    pub expressions: Expressions,
    /// The result of pruning, if it was pruned.
    pub pruning: Option<Pruning>,
}

/// Traces and simplifies every function, with all passes.
///
/// # Errors
///
/// As [`trace_of`].
pub fn trace(tree: &Tree) -> Result<Vec<TracedFunction>, PassError> {
    trace_with(tree, &Passes::default())
}

/// Traces and simplifies every function, with the given passes.
///
/// # Errors
///
/// As [`trace_of`].
pub fn trace_with(tree: &Tree, passes: &Passes) -> Result<Vec<TracedFunction>, PassError> {
    trace_of(tree, &CodegenOptions::default(), passes)
}

/// Traces and simplifies the functions that `options` select, in the order of [`Function::ALL`]. Nothing is pruned.
///
/// # Errors
///
/// In debug builds passes over expressions are verified, and one that changes a value or breaks the graph is reported.
///
/// Parameters of the options are those of a model, and so have no effect.
pub fn trace_of(tree: &Tree, options: &CodegenOptions, passes: &Passes) -> Result<Vec<TracedFunction>, PassError> {
    let symbolic = &tree.map(Symbol::Constant);
    let pipeline = Pipeline { tree, symbolic, options, passes, reference: &Reference::new(tree), pruning: None };
    pipeline.run()
}

/// Traces and simplifies the functions that `options` select. With a tolerance, joint forces, accelerations and the
/// mass matrix are pruned.
///
/// All other functions are always exact, and so are those that are too long to be unrolled.
///
/// # Errors
///
/// If there is a tolerance and a joint without a range that has an acceleration; as [`trace_of`].
pub fn trace_model(
    model: &Model,
    options: &CodegenOptions,
    passes: &Passes,
) -> Result<Vec<TracedFunction>, TraceError> {
    let tree = Tree::new(model);
    let ranges = |link: &Link| {
        let all: Option<Vec<StateRange>> = link.range.iter().map(StateRange::of).collect();
        all.filter(|all| all.len() == link.dof()).ok_or_else(|| TraceError::NoRange { joint: link.joint_name.clone() })
    };
    let pruning = match options.tolerance {
        Some(tolerance) => {
            let of_joints = model.moving_links().map(ranges).collect::<Result<Vec<_>, _>>()?;
            Some((tolerance, of_joints.concat()))
        }
        None => None,
    };
    let symbolic = &tree.map(Symbol::Constant);
    Pipeline { tree: &tree, symbolic, options, passes, reference: &Reference::new(&tree), pruning }
        .run()
        .map_err(Into::into)
}

/// The functions of a mechanism with run-time parameters.
#[derive(Clone, Debug)]
pub struct ParametricFunctions {
    /// The functions. Their parameters are the outputs of `lumped`.
    pub functions: Vec<TracedFunction>,
    /// What depends on the parameters alone, as a function of them.
    pub lumped: Expressions,
}

/// Traces and simplifies the functions that `options` select, with the numbers that they name as parameters. Nothing is
/// pruned.
///
/// # Errors
///
/// As [`trace_of`].
pub fn trace_with_parameters(
    model: &Model,
    options: &CodegenOptions,
    passes: &Passes,
) -> Result<ParametricFunctions, PassError> {
    let (tree, tracer) = (&Tree::new(model), Tracer::default());
    let mut functions = {
        let symbolic = &tree_with_parameters(model, &options.parameters, &tracer);
        let pipeline = Pipeline { tree, symbolic, options, passes, reference: &Reference::new(tree), pruning: None };
        pipeline.run()?
    };
    let lumped = lumped(functions.iter_mut().map(|function| &mut function.expressions), tracer);
    Ok(ParametricFunctions { functions, lumped })
}

/// The inputs from which all functions of a mechanism are made.
struct Pipeline<'a, 'p> {
    /// The robot with the numbers of the model.
    tree: &'a Tree,
    /// The robot with symbols in place of the numbers that are given at run time.
    symbolic: &'a SymbolicTree<'p>,
    options: &'a CodegenOptions,
    passes: &'a Passes,
    /// The exact numbers of the robot, by which the loss of digits is measured.
    reference: &'a Reference<'a>,
    /// The tolerance, and the ranges of the joints within which it holds.
    pruning: Option<(f64, Vec<StateRange>)>,
}

impl<'p> Pipeline<'_, 'p> {
    /// Makes every selected function by the same steps:
    ///
    /// 1. It is traced on the cheapest description of the robot that keeps its digits; forward dynamics by the method
    ///    that [`forward_dynamics`] chooses.
    /// 2. Where it is too long to be unrolled, it is also traced without the passes that make uniform bodies differ,
    ///    and the shorter code is taken.
    /// 3. Where branches are alike, it is also traced without the passes that make them differ, and if computing them
    ///    side by side [pays](siblings), the shorter code is taken.
    /// 4. Where it has a tolerance and can be unrolled, terms that do not matter within the ranges of the joints are
    ///    left out.
    fn run(&self) -> Result<Vec<TracedFunction>, PassError> {
        // Terms are left out as the recursions have them; how the rest is associated is chosen after that.
        let passes = &if self.pruning.is_some() { self.passes.unassociated() } else { *self.passes };
        let trees = Trees::new(self.symbolic, passes, self.reference);
        let [uniform_passes, alike_passes] = [passes.uniform(), passes.alike()];
        let uniform_trees = LazyCell::new(|| Trees::new(self.symbolic, &uniform_passes, self.reference));
        let alike_trees = LazyCell::new(|| Trees::new(self.symbolic, &alike_passes, self.reference));
        let are_computed = passes.siblings && self.pruning.is_none();
        let siblings = if are_computed { Siblings::of(self.tree) } else { Vec::new() };
        let unpruned = |function: Function| {
            let unrolled = self.simplified(function, &trees, passes)?;
            if !siblings.is_empty() && siblings::may_pay(&unrolled.expressions) {
                let mut alike = self.simplified(function, &alike_trees, &alike_passes)?;
                for siblings in &siblings {
                    let pass = |before: &Expressions| siblings::by_branches(before, function, siblings);
                    alike.expressions = applied("sums by branches", true, pass, alike.expressions)?;
                }
                let code_size = |traced: &TracedFunction| siblings::code_size(&traced.expressions, function, &siblings);
                let (alike_size, size) = (code_size(&alike), code_size(&unrolled));
                if let Some(alike_size) = alike_size
                    && size.is_none_or(|size| alike_size < size)
                {
                    return Ok(alike);
                }
                if size.is_some() {
                    return Ok(unrolled);
                }
            }
            if !(passes.loops && unrolled.expressions.is_long()) {
                return Ok(unrolled);
            }
            let uniform = self.simplified(function, &uniform_trees, &uniform_passes)?;
            let shorter = reroll::code_size(&uniform.expressions) < reroll::code_size(&unrolled.expressions);
            Ok(if shorter { uniform } else { unrolled })
        };
        let forces: OnceCell<Expressions> = OnceCell::new();
        let make = |function: Function| {
            let whole: TracedFunction = unpruned(function)?;
            if function == Function::InverseDynamics {
                let _ = forces.set(whole.expressions.clone());
            }
            let Some((tolerance, ranges)) = &self.pruning else { return Ok(whole) };
            let associated = self.associated(&whole.expressions)?;
            if whole.expressions.is_long() || !has_tolerance(function) {
                return Ok(TracedFunction { expressions: associated, ..whole });
            }
            // Forces that are given are those of motions within the ranges.
            let forces = || match forces.get() {
                Some(forces) => Ok(forces),
                None => {
                    let computed = unpruned(Function::InverseDynamics)?.expressions;
                    Ok(forces.get_or_init(|| computed))
                }
            };
            let shape = function.signature().result;
            let actuated = self.tree.actuated();
            let given = match shape {
                Shape::Accelerations => Given::Forces(forces()?),
                Shape::HybridMotion => Given::Hybrid(forces()?, &actuated),
                _ => Given::Accelerations,
            };
            let states = States { tree: self.tree, ranges, given };
            let (expressions, pruning) = pruned(&whole.expressions, shape, &states, *tolerance, passes)?;
            let pruning = Pruning { before: associated.count(), ..pruning };
            Ok(TracedFunction { expressions: self.associated(&expressions)?, pruning: Some(pruning), ..whole })
        };
        let functions = self.options.functions.with_frames(self.tree.frames.len());
        functions.with_passive_joints(self.tree.has_passive_joints()).iter().map(make).collect()
    }

    /// The expressions with sums and products associated anew where that is cheaper.
    fn associated(&self, expressions: &Expressions) -> Result<Expressions, PassError> {
        let other = simplified(expressions.clone(), self.passes)?;
        Ok(if other.price() < expressions.price() { other } else { expressions.clone() })
    }

    /// The function on the description of the robot on which it is best computed.
    fn simplified(
        &self,
        function: Function,
        trees: &Trees<'_, 'p>,
        passes: &Passes,
    ) -> Result<TracedFunction, PassError> {
        let (expressions, method) = match function {
            Function::ForwardDynamics => {
                let side_by_side = passes.siblings && !(passes.sums || passes.factors);
                let siblings = if side_by_side { Siblings::of(self.tree) } else { Vec::new() };
                let price = |expressions: &Expressions| {
                    siblings::code_size(expressions, function, &siblings)
                        .unwrap_or(expressions.count().flops() as usize)
                };
                let (expressions, choice) =
                    forward_dynamics::choose(trees, self.options.forward_dynamics, passes, price)?;
                (expressions, Some(choice))
            }
            Function::InverseDynamics | Function::BiasForces | Function::GravityForces | Function::MassMatrix => {
                (trees.keeping_digits(function)?, None)
            }
            Function::CoriolisMatrix => (cheapest(&trees.dynamics(), function, passes)?, None),
            Function::Energy => (cheapest(&trees.energy(), function, passes)?, None),
            Function::Momentum => (cheapest(&trees.moments(), function, passes)?, None),
            Function::HybridDynamics => (hybrid_dynamics(trees, passes)?, None),
            Function::CenterOfMass => (cheapest(&trees.moments(), function, passes)?, None),
            Function::LinkKinematics
            | Function::FrameKinematics
            | Function::FrameJacobians
            | Function::FrameBias
            | Function::FrameForces
            | Function::LoopResidual
            | Function::LoopJacobian
            | Function::LoopBias => (cheapest(&trees.kinematics(), function, passes)?, None),
            Function::PassiveForces
            | Function::DissipatedPower
            | Function::CoordinateRates
            | Function::Integrate
            | Function::Difference
            | Function::Neutral => (simplified_on(self.symbolic, function, passes)?, None),
        };
        Ok(TracedFunction { function, method, expressions, pruning: None })
    }
}

/// Hybrid dynamics by the method that takes fewer operations: for a few passive joints that is the mass matrix.
fn hybrid_dynamics(trees: &Trees<'_, '_>, passes: &Passes) -> Result<Expressions, PassError> {
    let recursion = simplified_on(trees.plain(), Function::HybridDynamics, passes)?;
    if trees.plain().depth() > LONGEST_CHAIN_BY_FACTORISATION {
        return Ok(recursion);
    }
    let [forces, matrix] = [trees.bias(), trees.matrix()];
    let factorisations = EliminationOrder::all_of(matrix).map(|order| {
        let traced = traced(matrix, Function::HybridDynamics, |tracer, x| {
            let trees = [&tracer.tree(forces), &tracer.tree(matrix)];
            let found = denoc::hybrid_dynamics_by_factorisation(order, trees, tracer, x[0], x[1], x[2]);
            [found.a, found.tau].concat()
        });
        simplified(traced, passes)
    });
    let all = factorisations.chain([Ok(recursion)]).collect::<Result<Vec<_>, _>>()?;
    Ok(all.into_iter().min_by_key(Expressions::price).expect("at least the recursion"))
}

/// A function on the tree on which it costs least.
fn cheapest(trees: &[SymbolicTree], function: Function, passes: &Passes) -> Result<Expressions, PassError> {
    let all = trees.iter().map(|tree| simplified_on(tree, function, passes)).collect::<Result<Vec<_>, _>>()?;
    Ok(all.into_iter().min_by_key(Expressions::price).expect("at least one tree"))
}

/// Whether a tolerance bounds the errors of a function. Wrenches have no ranges within which it could.
fn has_tolerance(function: Function) -> bool {
    !function.needs_frames()
        && matches!(
            function.signature().result,
            Shape::Forces | Shape::Accelerations | Shape::MassMatrix | Shape::HybridMotion
        )
}

/// Why the functions of a model cannot be traced with the given options.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TraceError {
    /// A tolerance needs a range with an acceleration for every joint, but a joint does not have one.
    NoRange {
        /// The joint.
        joint: String,
    },
    /// A pass over expressions is wrong.
    Pass(PassError),
}

impl From<PassError> for TraceError {
    fn from(error: PassError) -> Self {
        TraceError::Pass(error)
    }
}

impl std::fmt::Display for TraceError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            TraceError::NoRange { joint } => {
                write!(
                    f,
                    "a tolerance needs a range with an acceleration for every joint, but joint `{joint}` does not have \
                     one: give its link a `range`"
                )
            }
            TraceError::Pass(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for TraceError {}
