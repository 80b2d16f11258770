//! The functions of a compiled mechanism: what each computes, and how it is traced.

use crate::accuracy::{Quantity, Reference};
use crate::expressions::Expressions;
use crate::forward_dynamics;
use crate::passes::{self, ChangedValue, Passes};
use crate::pruning::{Pruning, States, pruned};
use crate::rolled;
use crate::symbol::{Symbol, Tracer};
use crate::trees::Trees;
use redysim_model::denoc;
use redysim_model::{Functions, Link, Model, Scene, Tree};
use std::cell::LazyCell;

/// What a function is called, takes and returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Signature {
    /// Its name in the contract.
    pub name: &'static str,
    /// The runtime's trait that has it.
    pub trait_name: &'static str,
    /// What it computes, with formula and units.
    pub summary: &'static str,
    /// Names of its arguments, all `&[S; NV]`.
    pub arguments: &'static [&'static str],
    /// What it returns.
    pub shape: Shape,
}

/// What a function returns, and so in what order its expressions stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// `[S; NV]`.
    Vector,
    /// `[[S; NV]; NV]`, by rows.
    Matrix,
    /// `Energy<S>`: kinetic, potential.
    Energy,
    /// `[LinkState<S>; NL]`: rotation by rows, origin, centre of mass, velocity, angular velocity.
    Links,
    /// `[S; NC]`.
    LoopRows,
    /// `[[S; NV]; NC]`, by rows.
    LoopJacobian,
}

const INVERSE_DYNAMICS: Signature = Signature {
    name: "inverse_dynamics",
    trait_name: "InverseDynamics",
    summary: "τ = M(q) a + C(q, v) v + g(q), N m or N: the joint forces of the tree.",
    arguments: &["q", "v", "a"],
    shape: Shape::Vector,
};

const FORWARD_DYNAMICS: Signature = Signature {
    name: "forward_dynamics",
    trait_name: "ForwardDynamics",
    summary: "a = M(q)⁻¹ (τ − C(q, v) v − g(q)), rad/s² or m/s²: the accelerations of the tree.",
    arguments: &["q", "v", "tau"],
    shape: Shape::Vector,
};

const MASS_MATRIX: Signature = Signature {
    name: "mass_matrix",
    trait_name: "MassMatrix",
    summary: "M(q), the generalised inertia matrix, symmetric: kg m², kg m or kg.",
    arguments: &["q"],
    shape: Shape::Matrix,
};

const BIAS_FORCES: Signature = Signature {
    name: "bias_forces",
    trait_name: "BiasForces",
    summary: "C(q, v) v + g(q), N m or N: the joint forces at zero acceleration.",
    arguments: &["q", "v"],
    shape: Shape::Vector,
};

const GRAVITY_FORCES: Signature = Signature {
    name: "gravity_forces",
    trait_name: "GravityForces",
    summary: "g(q), N m or N: the joint forces at rest.",
    arguments: &["q"],
    shape: Shape::Vector,
};

const ENERGY: Signature = Signature {
    name: "energy",
    trait_name: "MechanicalEnergy",
    summary: "Kinetic and potential energy, J; the potential is zero at the base frame's origin.",
    arguments: &["q", "v"],
    shape: Shape::Energy,
};

const LINK_KINEMATICS: Signature = Signature {
    name: "link_kinematics",
    trait_name: "LinkKinematics",
    summary: "Rotation, origin, centre of mass, velocity of the origin (m/s) and angular velocity (rad/s) of every \
              link, in the base frame.",
    arguments: &["q", "v"],
    shape: Shape::Links,
};

const LOOP_RESIDUAL: Signature = Signature {
    name: "loop_residual",
    trait_name: "LoopClosure",
    summary: "How far the loops are from closed: of each cut, the point of side b minus the point of side a in the base \
              frame, m, then what aligns directions, sines.",
    arguments: &["q"],
    shape: Shape::LoopRows,
};

const LOOP_JACOBIAN: Signature = Signature {
    name: "loop_jacobian",
    trait_name: "LoopClosure",
    summary: "J(q), by rows: the residual of the loops changes at the rates J v.",
    arguments: &["q"],
    shape: Shape::LoopJacobian,
};

const LOOP_BIAS: Signature = Signature {
    name: "loop_bias",
    trait_name: "LoopClosure",
    summary: "J̇ v: the second derivative of the residual of the loops at zero joint accelerations.",
    arguments: &["q", "v"],
    shape: Shape::LoopRows,
};

/// Every function of a mechanism, in the order of the contract.
pub const SIGNATURES: [Signature; 10] = [
    INVERSE_DYNAMICS,
    FORWARD_DYNAMICS,
    MASS_MATRIX,
    BIAS_FORCES,
    GRAVITY_FORCES,
    ENERGY,
    LINK_KINEMATICS,
    LOOP_RESIDUAL,
    LOOP_JACOBIAN,
    LOOP_BIAS,
];

/// One traced function.
#[derive(Clone, Debug)]
pub struct Function {
    /// What it is called, takes and returns.
    pub signature: Signature,
    /// How it is computed, where there is a choice.
    pub remark: Option<String>,
    /// Its expressions.
    pub expressions: Expressions,
    /// What pruning has done to them, if there was any.
    pub pruning: Option<Pruning>,
}

/// Traces and simplifies every function of [`SIGNATURES`], with all passes.
///
/// # Errors
///
/// As [`trace_of`].
pub fn trace(tree: &Tree) -> Result<Vec<Function>, ChangedValue> {
    trace_with(tree, &Passes::default())
}

/// Traces and simplifies every function of [`SIGNATURES`], with the given passes.
///
/// # Errors
///
/// As [`trace_of`].
pub fn trace_with(tree: &Tree, passes: &Passes) -> Result<Vec<Function>, ChangedValue> {
    trace_of(tree, &Scene::default(), passes)
}

/// Traces and simplifies the functions that `scene` asks for and no others, in the order of [`SIGNATURES`]. Nothing is
/// pruned.
///
/// Passes that treat every body by itself save operations but make alike bodies differ. A function that is too long to
/// be unrolled is traced without them as well, and the shorter code is taken.
///
/// # Errors
///
/// In debug builds passes over expressions are verified, and one that changes a value is reported.
pub fn trace_of(tree: &Tree, scene: &Scene, passes: &Passes) -> Result<Vec<Function>, ChangedValue> {
    let reference = Reference::new(tree);
    let trees = Trees::new(tree, passes, &reference);
    let even = passes.even();
    let even_trees = LazyCell::new(|| Trees::new(tree, &even, &reference));
    let shortest = |&signature: &Signature| {
        let own = function(signature, scene, &trees, passes)?;
        if !passes.loops || !own.expressions.is_long() {
            return Ok(own);
        }
        let alike = function(signature, scene, &even_trees, &even)?;
        Ok(if rolled::code_size(&alike.expressions) < rolled::code_size(&own.expressions) { alike } else { own })
    };
    let asked = SIGNATURES.iter().filter(|signature| scene.functions.contains(signature.name));
    asked.map(shortest).collect()
}

/// Traces and simplifies the functions that a scene asks for, and prunes those that compute joint forces, accelerations
/// and the mass matrix if it has a tolerance.
///
/// Energies, link kinematics and loops are exact in any case, and so are functions that are too long to be unrolled.
///
/// # Errors
///
/// If the scene has a tolerance and a joint no range; as [`trace_of`].
pub fn trace_scene(model: &Model, scene: &Scene, passes: &Passes) -> Result<Vec<Function>, TraceError> {
    let tree = Tree::new(model);
    let functions = trace_of(&tree, scene, passes)?;
    let Some(tolerance) = scene.tolerance else { return Ok(functions) };
    let range = |link: &Link| link.range.ok_or_else(|| TraceError::NoRange { joint: link.joint_name.clone() });
    let ranges = model.moving_links().map(range).collect::<Result<Vec<_>, _>>()?;
    let own = |functions: &[Function]| functions.iter().find(|f| f.signature == INVERSE_DYNAMICS).cloned();
    let forces = if let Some(forces) = own(&functions) {
        forces
    } else {
        let only = Functions::of([INVERSE_DYNAMICS.name]).expect("a function of a mechanism");
        own(&trace_of(&tree, &Scene { functions: only, ..*scene }, passes)?).expect("it is asked for")
    };
    let prune = |function: &Function| {
        let Function { signature, expressions, .. } = function;
        if !PRUNED.contains(signature) || expressions.is_long() {
            return Ok(function.clone());
        }
        let forces = (*signature == FORWARD_DYNAMICS).then_some(&forces.expressions);
        let states = States { ranges: &ranges, forces };
        let (expressions, pruning) = pruned(expressions, signature.shape, &states, tolerance, passes)?;
        Ok(Function { expressions, pruning: Some(pruning), ..function.clone() })
    };
    functions.iter().map(prune).collect()
}

/// The functions that a tolerance is for.
const PRUNED: [Signature; 5] = [INVERSE_DYNAMICS, FORWARD_DYNAMICS, MASS_MATRIX, BIAS_FORCES, GRAVITY_FORCES];

/// Why the functions of a model cannot be traced as a scene asks.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TraceError {
    /// A tolerance holds within ranges, and a joint has none.
    NoRange {
        /// The joint.
        joint: String,
    },
    /// A pass over expressions changes a value.
    ChangedValue(ChangedValue),
}

impl From<ChangedValue> for TraceError {
    fn from(changed: ChangedValue) -> Self {
        TraceError::ChangedValue(changed)
    }
}

impl std::fmt::Display for TraceError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            TraceError::NoRange { joint } => {
                write!(f, "a tolerance holds within ranges, but joint `{joint}` has none: give its link a `range`")
            }
            TraceError::ChangedValue(changed) => changed.fmt(f),
        }
    }
}

impl std::error::Error for TraceError {}

fn function(signature: Signature, scene: &Scene, trees: &Trees, passes: &Passes) -> Result<Function, ChangedValue> {
    let on_kinematics = |arguments, function: TreeFunction| {
        cheapest(&trees.kinematics(), |tree| traced(tree, passes, arguments, |t, x| function(tree, t, x)))
    };
    let measured = |quantity, arguments, function: TreeFunction| {
        keeping_digits(trees, passes, quantity, |tree, passes| traced(tree, passes, arguments, |t, x| function(tree, t, x)))
    };
    let expressions = match signature {
        INVERSE_DYNAMICS => measured(Quantity::Forces, 3, |tree, t, x| denoc::inverse_dynamics(tree, t, x[0], x[1], x[2])),
        FORWARD_DYNAMICS => {
            let chosen = forward_dynamics::chosen(trees, scene.forward_dynamics, passes)?;
            let remark = Some(chosen.to_string());
            return Ok(Function { signature, remark, expressions: chosen.expressions, pruning: None });
        }
        MASS_MATRIX => measured(Quantity::Matrix, 1, |tree, t, x| denoc::mass_matrix(tree, t, x[0]).concat()),
        BIAS_FORCES => measured(Quantity::BiasForces, 2, |tree, t, x| denoc::bias_forces(tree, t, x[0], x[1])),
        GRAVITY_FORCES => measured(Quantity::GravityForces, 1, |tree, t, x| denoc::gravity_forces(tree, t, x[0])),
        ENERGY => cheapest(&trees.energy(), |tree| traced(tree, passes, 2, |t, x| energy(tree, t, x[0], x[1]))),
        LINK_KINEMATICS => on_kinematics(2, |tree, t, x| link_kinematics(tree, t, x[0], x[1])),
        LOOP_RESIDUAL => on_kinematics(1, |tree, t, x| denoc::loop_residual(tree, t, x[0])),
        LOOP_JACOBIAN => on_kinematics(1, |tree, t, x| denoc::loop_jacobian(tree, t, x[0]).concat()),
        LOOP_BIAS => on_kinematics(2, |tree, t, x| denoc::loop_bias(tree, t, x[0], x[1])),
        _ => unreachable!("`{}` is none of the functions of a mechanism", signature.name),
    }?;
    Ok(Function { signature, remark: None, expressions, pruning: None })
}

/// A function of a tree and its arguments.
type TreeFunction = for<'g> fn(&Tree, &'g Tracer, &[&[Symbol<'g>]]) -> Vec<Symbol<'g>>;

/// A function on the cheapest description of the robot on which it keeps its digits; in the end on the model's own,
/// without passes over expressions.
pub(crate) fn keeping_digits(
    trees: &Trees,
    passes: &Passes,
    quantity: Quantity,
    function: impl Fn(&Tree, &Passes) -> Result<Expressions, ChangedValue>,
) -> Result<Expressions, ChangedValue> {
    let bearable = trees.bearable(quantity);
    for tree in trees.descriptions(quantity) {
        let expressions = function(tree, passes)?;
        if trees.reference().lost_by(quantity, |x| expressions.evaluate(x)) <= bearable {
            return Ok(expressions);
        }
    }
    let [.., own] = trees.descriptions(quantity);
    function(own, &Passes { loops: passes.loops, ..Passes::none() })
}

/// A function on the tree on which it costs least.
fn cheapest(
    trees: &[Tree],
    function: impl Fn(&Tree) -> Result<Expressions, ChangedValue>,
) -> Result<Expressions, ChangedValue> {
    let all = trees.iter().map(function).collect::<Result<Vec<_>, _>>()?;
    Ok(all.into_iter().min_by_key(Expressions::price).expect("at least one tree"))
}

fn energy<'g>(tree: &Tree, trace: &'g Tracer, q: &[Symbol<'g>], v: &[Symbol<'g>]) -> Vec<Symbol<'g>> {
    let energy = denoc::energy(tree, trace, q, v);
    vec![energy.kinetic, energy.potential]
}

fn link_kinematics<'g>(tree: &Tree, trace: &'g Tracer, q: &[Symbol<'g>], v: &[Symbol<'g>]) -> Vec<Symbol<'g>> {
    let links = denoc::link_kinematics(tree, trace, q, v);
    let vectors = links.into_iter().flat_map(|link| {
        link.rotation.into_iter().chain([link.origin, link.com, link.velocity, link.angular_velocity])
    });
    vectors.flatten().collect()
}

/// The expressions of a function of `arguments` vectors of length NV, simplified.
pub(crate) fn traced(
    tree: &Tree,
    passes: &Passes,
    arguments: u8,
    function: impl for<'g> Fn(&'g Tracer, &[&[Symbol<'g>]]) -> Vec<Symbol<'g>>,
) -> Result<Expressions, ChangedValue> {
    passes::simplified(as_traced(tree, arguments, function), passes)
}

/// The expressions of a function of `arguments` vectors of length NV, before any pass over them.
pub(crate) fn as_traced(
    tree: &Tree,
    arguments: u8,
    function: impl for<'g> Fn(&'g Tracer, &[&[Symbol<'g>]]) -> Vec<Symbol<'g>>,
) -> Expressions {
    let tracer = Tracer::default();
    let outputs = {
        let symbols: Vec<Vec<Symbol>> = (0..arguments).map(|argument| tracer.argument(argument, tree.dof())).collect();
        let symbols: Vec<&[Symbol]> = symbols.iter().map(Vec::as_slice).collect();
        tracer.edges(&function(&tracer, &symbols))
    };
    Expressions { graph: tracer.into_graph(), outputs }
}
