//! The rounding errors of a function, measured at sampled states of the robot.
//!
//! The reference values come from the recursions on the model's own tree, in [double-double](double_double) arithmetic.
//! Errors are taken in the metric of the mass matrix, in which a heavy joint and a light one count alike: of
//! accelerations √M_ii |Δa_i| as a share of the largest √M_jj |a_j|, of forces |Δτ_i| / √M_ii as a share of the largest
//! |τ_j| / √M_jj, of the mass matrix |ΔM_ij| as a share of √(M_ii M_jj).

#[cfg(feature = "source")]
pub(crate) mod both;
pub mod double_double;
pub mod rounding;
pub mod with_error;

use crate::random::Random;
use double_double::{DoubleDouble, exact, rounded};
use redysim_model::denoc::{self, Trace, Untraced};
use redysim_model::inertia::Sym3;
use redysim_model::pseudo::PseudoInertia;
use redysim_model::{Function, Tree};
use redysim_runtime::function::{Argument, Shape};
use std::cell::OnceCell;
use std::f64::consts::PI;

/// Joints times states of each motion: how much is measured.
const JOINT_STATES: usize = 240;
/// The most states of each motion.
const MOST_STATES: usize = 16;
/// The fewest states of each motion.
const FEWEST_STATES: usize = 2;
/// The relative size of perturbations: a few roundings.
const PERTURBATION: f64 = f64::EPSILON;
/// With more joints the mass matrix is left out: its n² elements in double-double take seconds.
const LARGEST_MATRIX: usize = 100;

/// The functions whose losses are measured.
pub const MEASURED: [Function; 5] = [
    Function::InverseDynamics,
    Function::BiasForces,
    Function::GravityForces,
    Function::MassMatrix,
    Function::ForwardDynamics,
];

/// The exact values of a robot's functions at states spread over its workspace.
///
/// They are computed when they are first needed.
pub struct Reference<'a> {
    tree: &'a Tree,
    seed: u64,
    states: OnceCell<Vec<State>>,
}

/// A motion in which a robot is measured. A loss is the largest error in the states of one motion as a share of the
/// largest value in them, so that a sum which happens to vanish in one state does not count as large.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Motion {
    /// All joints move at like speeds.
    LikeSpeeds,
    /// All joints move with like energies. This shows errors of light links between heavy ones that like speeds hide.
    LikeEnergies,
    /// At rest, without joint forces.
    Rest,
}

impl Motion {
    const ALL: [Motion; 3] = [Motion::LikeSpeeds, Motion::LikeEnergies, Motion::Rest];
}

struct State {
    motion: Motion,
    q: Vec<f64>,
    v: Vec<f64>,
    a: Vec<f64>,
    /// The joint forces of forward dynamics.
    tau: Vec<f64>,
    /// √M_ii.
    weights: Vec<f64>,
    /// The exact values of measured functions, without the mass matrix of a large robot.
    exact: Vec<(Function, Vec<f64>)>,
}

/// Rotates by the angles of a joint one after the other, as generated code does: the rounding errors are then those of
/// generated code.
struct AsGenerated;

impl Trace<f64> for AsGenerated {}

impl<'a> Reference<'a> {
    /// The robot `tree`, at positions within ±π rad or ±1 m of the zero position.
    pub fn new(tree: &'a Tree) -> Self {
        Reference::at(tree, 0)
    }

    /// The same at other states, one set for each `seed`.
    pub fn at(tree: &'a Tree, seed: u64) -> Self {
        Reference { tree, seed, states: OnceCell::new() }
    }

    /// States at which a number is not finite, as where the mass matrix is singular, are left out.
    fn states(&self) -> &[State] {
        self.states.get_or_init(|| {
            let count = (JOINT_STATES / self.tree.nv().max(1)).clamp(FEWEST_STATES, MOST_STATES);
            let motions = (0..count).flat_map(|index| Motion::ALL.map(|motion| (index, motion)));
            motions.filter_map(|(index, motion)| State::new(self.tree, self.seed, index, motion)).collect()
        })
    }

    /// The loss of the recursion for `function` in `f64` on `tree`, another description of the robot.
    pub fn loss_on(&self, tree: &Tree, function: Function) -> f64 {
        self.loss_by(function, |x| denoc::evaluate_dynamics(function, tree, &AsGenerated, x))
    }

    /// The loss of `function` in any description: that of the recursion on the model's own, with its numbers as they
    /// are and with each perturbed by a few roundings.
    ///
    /// A mechanism that lies in a plane of space, or a link whose centre of mass nearly balances another's, depends so
    /// much on the last digits of its numbers that no other description has the digits of the model's own.
    pub fn least_loss(&self, function: Function) -> f64 {
        let others = [1, 2].map(|seed| perturbed(self.tree, seed));
        let losses = others.iter().chain([self.tree]).map(|tree| self.loss_on(tree, function));
        losses.fold(0.0, |largest, loss| if loss.is_finite() { largest.max(loss) } else { largest })
    }

    /// The loss of `computed`, which computes `function` from its arguments; zero for a function that is not
    /// [`MEASURED`].
    pub fn loss_by(&self, function: Function, computed: impl Fn(&[&[f64]]) -> Vec<f64>) -> f64 {
        self.losses_by(function, computed).into_iter().fold(0.0, worse)
    }

    /// The loss for each motion: at like speeds of the joints, with like energies, and at rest. An algorithm that loses
    /// nothing in one of them may lose all digits in another.
    pub fn losses_by(&self, function: Function, computed: impl Fn(&[&[f64]]) -> Vec<f64>) -> [f64; 3] {
        self.losses(|state| {
            let Some(exact) = state.exact(function) else { return Extremes::default() };
            let weights = &state.weights;
            let weight = |k: usize| match function.signature().result {
                Shape::Forces => 1.0 / weights[k],
                Shape::Accelerations => weights[k],
                Shape::MassMatrix => 1.0 / (weights[k / weights.len()] * weights[k % weights.len()]),
                Shape::Energy
                | Shape::Power
                | Shape::CoriolisMatrix
                | Shape::CenterOfMass
                | Shape::Momentum
                | Shape::HybridMotion
                | Shape::Links
                | Shape::LoopRows
                | Shape::LoopJacobian
                | Shape::Coordinates
                | Shape::Displacement
                | Shape::Frames
                | Shape::FrameJacobians
                | Shape::FrameAccelerations => 1.0,
            };
            extremes(&computed(&state.arguments(function)), exact, weight)
        })
    }

    fn losses(&self, extremes: impl Fn(&State) -> Extremes) -> [f64; 3] {
        let of_motion = |motion: Motion| {
            let states = self.states().iter().filter(|state| state.motion == motion);
            let worst = states.map(&extremes).fold(Extremes::default(), |a, b| Extremes {
                error: worse(a.error, b.error),
                size: a.size.max(b.size),
            });
            if worst.error == 0.0 { 0.0 } else { worst.error / worst.size }
        };
        Motion::ALL.map(of_motion)
    }
}

impl State {
    /// State number `index` of a motion; `None` if a value is not finite there.
    fn new(tree: &Tree, seed: u64, index: usize, motion: Motion) -> Option<Self> {
        let nv = tree.nv();
        let mut random = Random::new(1000 * seed + 10 * index as u64 + motion as u64 + 1);
        let mut shares = || (0..nv).map(|_| random.share(false)).collect::<Vec<f64>>();
        let [mut displacement, mut v, mut a] = [shares(), shares(), shares()];
        for body in tree.independent_bodies() {
            for (displacement, screw) in displacement[body.v.clone()].iter_mut().zip(body.joint.screws()) {
                *displacement *= if screw.turn == 0.0 { 1.0 } else { PI };
            }
        }
        let q = denoc::integrate(tree, &denoc::neutral::<f64>(tree), &displacement);
        let diagonal = denoc::mass_matrix(tree, &AsGenerated, &q).into_iter().enumerate().map(|(i, row)| row[i]);
        let weights: Vec<f64> = diagonal.map(f64::sqrt).collect();
        for (i, weight) in weights.iter().enumerate() {
            let speed = match motion {
                Motion::LikeSpeeds => 1.0,
                Motion::LikeEnergies => 1.0 / weight,
                Motion::Rest => 0.0,
            };
            v[i] *= 3.0 * speed;
            a[i] *= 10.0 * speed;
        }
        let exactly = |function: Function, state: &State| {
            let arguments: Vec<Vec<DoubleDouble>> = state.arguments(function).into_iter().map(exact).collect();
            let arguments: Vec<&[DoubleDouble]> = arguments.iter().map(Vec::as_slice).collect();
            rounded(denoc::evaluate_dynamics(function, tree, &Untraced, &arguments))
        };
        let mut state = State { motion, q, v, a, tau: vec![0.0; nv], weights, exact: Vec::new() };
        if motion != Motion::Rest {
            state.tau = exactly(Function::InverseDynamics, &state);
        }
        for function in MEASURED {
            if function != Function::MassMatrix || nv <= LARGEST_MATRIX {
                state.exact.push((function, exactly(function, &state)));
            }
        }
        let positive = state.weights.iter().all(|&weight| weight > 0.0);
        let finite = state.exact.iter().flat_map(|(_, values)| values).all(|value| value.is_finite());
        (positive && finite).then_some(state)
    }

    /// The exact values of a function, if they are known.
    fn exact(&self, function: Function) -> Option<&[f64]> {
        self.exact.iter().find(|(known, _)| *known == function).map(|(_, values)| values.as_slice())
    }

    /// The arguments of a function.
    fn arguments(&self, function: Function) -> Vec<&[f64]> {
        let of = |argument: &Argument| match argument {
            Argument::Coordinates | Argument::Start | Argument::End => self.q.as_slice(),
            Argument::Velocities | Argument::Displacement => &self.v,
            Argument::Accelerations => &self.a,
            Argument::Forces | Argument::Given => &self.tau,
            // No function that is measured takes wrenches.
            Argument::Wrenches => &[],
        };
        function.signature().arguments.iter().map(of).collect()
    }
}

/// The largest weighted difference, and the largest weighted value.
#[derive(Default)]
struct Extremes {
    error: f64,
    size: f64,
}

fn extremes(found: &[f64], expected: &[f64], weight: impl Fn(usize) -> f64) -> Extremes {
    let of =
        |values: &mut dyn Iterator<Item = f64>| values.enumerate().map(|(i, x)| x.abs() * weight(i)).fold(0.0, worse);
    let error = of(&mut found.iter().zip(expected).map(|(x, y)| x - y));
    Extremes { error, size: of(&mut expected.iter().copied()) }
}

/// The robot with numbers that differ from those of `tree` by a few roundings: in lengths and moments relative to the
/// largest component of their vector or tensor, as after a change of axes.
fn perturbed(tree: &Tree, seed: u64) -> Tree {
    let mut random = Random::new(seed);
    let mut tree = tree.clone();
    for body in &mut tree.bodies {
        let PseudoInertia { mass, moment, second } = &mut body.inertia;
        perturb(&mut random, &mut body.placement.position.0);
        perturb(&mut random, body.placement.rotation.0.as_flattened_mut());
        perturb(&mut random, std::slice::from_mut(mass));
        perturb(&mut random, &mut moment.0);
        let mut elements = [second.xx, second.yy, second.zz, second.xy, second.yz, second.xz];
        perturb(&mut random, &mut elements);
        let [xx, yy, zz, xy, yz, xz] = elements;
        *second = Sym3 { xx, yy, zz, xy, yz, xz };
    }
    for spring in &mut tree.springs {
        perturb(&mut random, &mut spring.a.point.0);
        perturb(&mut random, &mut spring.b.point.0);
    }
    tree
}

fn perturb(random: &mut Random, numbers: &mut [f64]) {
    let largest = numbers.iter().fold(0.0_f64, |largest, number| largest.max(number.abs()));
    numbers.iter_mut().for_each(|number| *number += PERTURBATION * largest * random.share(false));
}

/// The larger of two errors; NaN counts as infinite.
fn worse(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::INFINITY } else { a.max(b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use redysim_model::Model;

    /// Joints of two coordinates and one velocity, of which only the first coordinate moves.
    #[test]
    fn a_joint_may_have_more_coordinates_than_velocities() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/gripper.toml");
        let tree = Tree::new(&Model::load(path).unwrap().model);
        let mut wider = tree.clone();
        for (index, body) in wider.bodies.iter_mut().enumerate() {
            body.q = 2 * index..2 * index + 2;
        }
        let known = State::new(&tree, 0, 0, Motion::LikeSpeeds).unwrap();
        let state = State::new(&wider, 0, 0, Motion::LikeSpeeds).unwrap();
        assert_eq!((state.q.len(), state.v.len()), (2 * tree.nv(), tree.nv()));
        for (narrow, body) in tree.bodies.iter().zip(&wider.bodies) {
            assert_eq!(state.q[body.q.clone()], [known.q[narrow.q.start], 0.0]);
        }
        assert_eq!(state.exact, known.exact);
    }
}
