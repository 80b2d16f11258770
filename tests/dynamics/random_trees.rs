//! On random trees the recursions, the base parameters and the traced expressions agree with Kane's equations.
//!
//! Two hundred trees of up to twelve joints: revolute, prismatic, helical and fixed, branching, oblique, links in
//! scrambled order; in half of them with rotors, damping, friction and springs in the joints, in half with springs and
//! dampers between points. Each has three frames of interest, on links or on the ground. Sixty trees more have spherical
//! and free joints as well, anywhere, at quaternions of any length; and sixty more joints of every kind, with quaternions
//! and with Euler angles of any sequence. In sixty more, joints with one degree of freedom mimic others; in half of these, some of
//! such joints move no mass by themselves. A debug build takes a thirtieth of each.

pub mod models;

use crate::common::dual::moving;
use crate::common::kane::{Kane, kane};
use crate::common::random::{Random, State};
use crate::common::styles::Style;
use crate::common::traced::traced;
use models::{Joints, empty_some, mimic_some, random_model};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use redysim::Real;
use redysim_codegen::accuracy::Reference;
use redysim_codegen::functions::{TracedFunction, trace};
use redysim_model::denoc::{self, Method, Untraced};
use redysim_model::joint::{LinkJoint, Measure, Vanishing};
use redysim_model::regroup::base_parameters;
use redysim_model::{Function, JointKind, Model, Tree};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::ops::Range;

/// The seeds of trees whose joints have one degree of freedom each: odd ones have rotors, damping, friction and springs in their
/// joints.
const OF_ONE_FREEDOM: Range<u64> = 0..200;
/// The seeds of trees that have spherical and free joints as well.
const IN_SPACE: Range<u64> = 1000..1060;
/// The seeds of trees that have joints of every kind, spherical and free ones in quaternions and in Euler angles.
const IN_SERIES: Range<u64> = 2000..2060;
/// The seeds of trees in which joints mimic others.
const WITH_MIMICS: Range<u64> = 3000..3060;
/// Those of them in which such joints need not move mass by themselves.
const WITH_EMPTY_MIMICS: Range<u64> = 3030..3060;
const STATES: usize = 3;

/// These seeds, or the first thirtieth of them where code is not optimised.
fn sample(seeds: Range<u64>) -> impl Iterator<Item = u64> {
    let count = (seeds.end - seeds.start) as usize;
    seeds.take(if cfg!(debug_assertions) { count / 30 } else { count })
}

/// A sample of all trees in which joints mimic others.
fn with_mimics() -> impl Iterator<Item = u64> {
    sample(WITH_MIMICS.start..WITH_EMPTY_MIMICS.start).chain(sample(WITH_EMPTY_MIMICS))
}

/// The largest error of each quantity.
#[derive(Default)]
struct Errors(BTreeMap<String, f64>);

impl Errors {
    /// |computed − expected| / |expected| in the norm of the largest component. The terms of a component are as large
    /// as the largest component, and so are their roundings; one component alone may be their small difference.
    fn add(&mut self, what: &str, computed: &[f64], expected: &[f64], tolerance: f64) {
        assert_eq!(computed.len(), expected.len(), "{what}");
        let size = expected.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
        let difference = computed.iter().zip(expected).map(|(x, y)| (x - y).abs());
        let difference = difference.fold(0.0_f64, |most, x| if most.is_nan() || x <= most { most } else { x });
        let error = if difference == 0.0 { 0.0 } else { difference / size };
        assert!(error <= tolerance, "{what}: error {error:.1e}\n{computed:?}\n{expected:?}");
        let worst = self.0.entry(what.to_string()).or_default();
        *worst = Real::maximum(*worst, error);
    }

    /// The same with one added to each component, so that what happens to vanish is held against numbers of size one.
    fn add_to_one(&mut self, what: &str, computed: &[f64], expected: &[f64], tolerance: f64) {
        let from_one = |values: &[f64]| values.iter().map(|x| x + 1.0).collect::<Vec<_>>();
        self.add(what, &from_one(computed), &from_one(expected), tolerance);
    }
}

/// A wrench on each frame, by its numbers: force, then moment.
fn wrenches(random: &mut Random, frames: usize) -> Vec<f64> {
    (0..6 * frames).map(|_| random.within(10.0)).collect()
}

/// What the functions of frames are by Kane's Jacobians and accelerations, in the order of the table of functions.
fn frame_functions(expected: &Kane, dof: usize, wrenches: &[f64]) -> [(Function, Vec<f64>); 4] {
    let (mut states, mut jacobians, mut biases, mut forces) = (vec![], vec![], vec![], DVector::zeros(dof));
    for (frame, wrench) in expected.frames.iter().zip(wrenches.chunks(6)) {
        let vectors = [&frame.origin, &frame.velocity, &frame.angular_velocity];
        states.extend(frame.rotation.transpose().iter().copied());
        states.extend(vectors.into_iter().flatten());
        let (linear, angular) = frame.jacobians(dof);
        jacobians.extend([&linear, &angular].into_iter().flat_map(|j| j.transpose().as_slice().to_vec()));
        biases.extend([frame.acceleration, frame.angular_acceleration].iter().flatten());
        let (force, moment) = wrench.split_at(3);
        forces += linear.transpose() * Vector3::from_row_slice(force);
        forces += angular.transpose() * Vector3::from_row_slice(moment);
    }
    [
        (Function::FrameKinematics, states),
        (Function::FrameJacobians, jacobians),
        (Function::FrameBias, biases),
        (Function::FrameForces, forces.as_slice().to_vec()),
    ]
}

/// Calls `check` with each tree and Kane's answer at a few states.
fn on_random_trees(check: impl FnMut(&Model, &Tree, &State, &Kane)) {
    on_trees(sample(OF_ONE_FREEDOM).chain(sample(IN_SPACE)).chain(sample(IN_SERIES)).chain(with_mimics()), check);
}

/// The same with the trees of these seeds.
fn on_trees(seeds: impl Iterator<Item = u64>, mut check: impl FnMut(&Model, &Tree, &State, &Kane)) {
    for seed in seeds {
        let mut random = Random::new(seed);
        let joints = match seed {
            seed if IN_SERIES.contains(&seed) => Joints::InSeries,
            seed if IN_SPACE.contains(&seed) => Joints::InSpace,
            seed if WITH_MIMICS.contains(&seed) && seed % 3 == 0 => Joints::InSpace,
            _ => Joints::OfOneFreedom,
        };
        let mut model = random_model(&mut random, joints, seed % 2 == 1, seed % 4 >= 2);
        if WITH_MIMICS.contains(&seed) {
            mimic_some(&mut random, &mut model);
        }
        if WITH_EMPTY_MIMICS.contains(&seed) {
            empty_some(&mut random, &mut model);
        }
        let tree = Tree::new(&model);
        for _ in 0..STATES {
            let state = match joints {
                Joints::OfOneFreedom => random.state(model.dof()),
                Joints::InSpace | Joints::InSeries => state_in_space(&mut random, &model),
            };
            let expected = kane(&model, &state.q, &state.v);
            check(&model, &tree, &state, &expected);
        }
    }
}

/// A state in the same ranges, with quaternions of lengths from 1e-3 to 1e3.
pub fn state_in_space(random: &mut Random, model: &Model) -> State {
    let mut q = Vec::new();
    for link in model.moving_links() {
        q.extend(match link.joint {
            _ if link.joint.dof() > 1 && LinkJoint::of(link).is_some_and(LinkJoint::is_linear) => {
                let measures = LinkJoint::of(link).map(LinkJoint::coordinate_measures).unwrap_or_default();
                measures
                    .iter()
                    .map(|&measure| random.within(if measure == Measure::Angle { PI } else { 1.0 }))
                    .collect()
            }
            JointKind::Spherical => quaternion(random),
            JointKind::Free => [random.vector(3, 1.0), quaternion(random)].concat(),
            other => random.vector(other.dof(), PI),
        });
    }
    State { q, v: random.vector(model.dof(), 3.0), a: random.vector(model.dof(), 10.0) }
}

fn quaternion(random: &mut Random) -> Vec<f64> {
    let size = 10.0_f64.powf(random.within(3.0));
    random.vector(4, size)
}

/// Position and velocity of the centre of mass, and linear momentum and angular momentum about it, by the partial velocities
/// of each link: Σ m J_v v and Σ (c − C) × m J_v v + I J_ω v.
fn center_and_momentum(model: &Model, expected: &Kane, v: &[f64]) -> [Vec<f64>; 2] {
    let velocities = DVector::from_row_slice(v);
    let [mut weighted, mut linear, mut angular] = [Vector3::zeros(); 3];
    let parts: Vec<_> = model.links.iter().zip(&expected.links).collect();
    let mass: f64 = model.links.iter().map(|link| link.mass).sum();
    for (link, body) in &parts {
        weighted += link.mass * body.com;
        linear += link.mass * body.jacobians(v.len()).0 * &velocities;
    }
    let center = weighted / mass;
    for (link, body) in parts {
        let (translation, rotation) = body.jacobians(v.len());
        let i = link.inertia;
        let own = Matrix3::new(i.xx, i.xy, i.xz, i.xy, i.yy, i.yz, i.xz, i.yz, i.zz);
        let velocity = Vector3::from_column_slice((translation * &velocities).as_slice());
        angular += (body.com - center).cross(&(link.mass * velocity));
        angular += body.rotation * own * body.rotation.transpose() * rotation * &velocities;
    }
    let two = |a: Vector3<f64>, b: Vector3<f64>| a.iter().chain(b.iter()).copied().collect::<Vec<f64>>();
    [two(center, linear / mass), two(linear, angular)]
}

/// The accelerations that Kane's equations give, and how many roundings the condition of M makes of one.
fn accelerations(expected: &Kane, tau: &DVector<f64>) -> (DVector<f64>, f64) {
    let eigenvalues = expected.matrix.clone().symmetric_eigenvalues();
    let accelerations = expected.matrix.clone().cholesky().expect("positive definite").solve(&(tau - &expected.bias));
    (accelerations, eigenvalues.max() / eigenvalues.min())
}

/// What passive forces may be off by: those of joints on an axis are a few operations, springs between points take the
/// positions of their ends, and those of rotations the logarithm of two quaternions, near half a turn from small sines.
fn of_passive(tree: &Tree, of_joints: f64) -> f64 {
    let in_space = tree.bodies.iter().any(|body| body.physics.is_some() && !body.joint.is_on_axis());
    match tree.springs.is_empty() {
        true if in_space => 1e-13,
        true => of_joints,
        false => 1e-12,
    }
}

fn forces(expected: &Kane, a: &[f64]) -> DVector<f64> {
    &expected.matrix * DVector::from_row_slice(a) + &expected.bias
}

#[test]
fn recursions_agree_with_kanes_equations() {
    let mut errors = Errors::default();
    on_random_trees(|model, tree, State { q, v, a }, expected| {
        for (path, tree) in [("tree", tree), ("base parameters", &base_parameters(tree, Vanishing::TensorYy))] {
            let mut add = |what: &str, computed: &[f64], expected: &[f64], tolerance| {
                errors.add(&format!("{path}: {what}"), computed, expected, tolerance);
            };
            let tau = forces(expected, a);
            add("inverse", &denoc::inverse_dynamics(tree, &Untraced, q, v, a), tau.as_slice(), 1e-12);
            add("matrix", &denoc::mass_matrix(tree, &Untraced, q).concat(), expected.matrix.as_slice(), 1e-12);
            add("bias", &denoc::bias_forces(tree, &Untraced, q, v), expected.bias.as_slice(), 1e-12);
            add("gravity", &denoc::gravity_forces(tree, &Untraced, q), expected.gravity.as_slice(), 1e-12);
            let passive = denoc::passive_forces(tree, &Untraced, q, v);
            add("passive", &passive, expected.passive.as_slice(), of_passive(tree, 1e-15));
            let dissipated = denoc::dissipated_power(tree, &Untraced, q, v);
            add("dissipated", &[dissipated], &[expected.dissipated], of_passive(tree, 1e-14));
            let energy = denoc::energy(tree, &Untraced, q, v);
            add("kinetic", &[energy.kinetic], &[expected.kinetic], 1e-12);
            add("potential", &[energy.potential - expected.potential + 1.0], &[1.0], 1e-12);
            if path == "tree" {
                // Of what is regrouped, the dynamics is the same and the centre of mass another.
                let [center, momentum] = center_and_momentum(model, expected, v);
                let computed = denoc::evaluate(Function::CenterOfMass, tree, &Untraced, &[q, v]);
                add("centre of mass", &computed, &center, 1e-12);
                add("momentum", &denoc::evaluate(Function::Momentum, tree, &Untraced, &[q, v]), &momentum, 1e-12);
            }
            let (wanted, condition) = accelerations(expected, &tau);
            for method in [Method::Factorisation, Method::Recursion] {
                let found = denoc::forward_dynamics(method, tree, &Untraced, q, v, tau.as_slice());
                add(&format!("{method:?}"), &found, wanted.as_slice(), 1e-15 * condition.max(1e3));
            }
        }
    });
    println!("{:?}", errors.0);
}

/// The recursion has to find the motion of trees in which the mass matrix over all joints is singular, and only folded over
/// joints that mimic others is regular.
#[test]
fn some_random_trees_have_mass_for_groups_of_joints_only() {
    let mut singular = 0;
    on_trees(WITH_EMPTY_MIMICS, |_, tree, State { q, .. }, _| {
        let each = Tree { mimics: Vec::new(), ..tree.clone() };
        let all: Vec<f64> = (0..each.nq()).map(|i| q.get(i).copied().unwrap_or(0.3)).collect();
        let rows = denoc::mass_matrix(&each, &Untraced, &all).concat();
        let eigenvalues = DMatrix::from_row_slice(each.nv(), each.nv(), &rows).symmetric_eigenvalues();
        singular += usize::from(eigenvalues.min() < 1e-14 * eigenvalues.max());
    });
    assert!(singular > 20, "{singular} of {} states", 3 * WITH_EMPTY_MIMICS.count());
}

#[test]
fn link_kinematics_agree_with_jacobians() {
    let mut errors = Errors::default();
    on_random_trees(|_, tree, State { q, v, .. }, expected| {
        for (link, body) in denoc::link_kinematics(tree, &Untraced, q, v).iter().zip(&expected.links) {
            let mut add =
                |what: &str, computed: &[f64], expected: &[f64]| errors.add_to_one(what, computed, expected, 1e-13);
            add("rotation", &link.rotation.concat(), body.rotation.transpose().as_slice());
            add("origin", &link.origin, body.origin.as_slice());
            add("com", &link.com, body.com.as_slice());
            add("velocity", &link.velocity, body.velocity.as_slice());
            add("angular velocity", &link.angular_velocity, body.angular_velocity.as_slice());
        }
    });
    println!("{:?}", errors.0);
}

#[test]
fn frames_agree_with_kanes_jacobians_and_accelerations() {
    let mut errors = Errors::default();
    let mut random = Random::new(1);
    on_random_trees(|model, tree, State { q, v, .. }, expected| {
        let wrenches = wrenches(&mut random, tree.frames.len());
        for (function, expected) in frame_functions(expected, model.dof(), &wrenches) {
            let second = if function == Function::FrameForces { &wrenches } else { v };
            let computed = denoc::evaluate(function, tree, &Untraced, &[q, second]);
            errors.add(function.name(), &computed, &expected, 1e-13);
        }
    });
    println!("{:?}", errors.0);
}

/// The derivative of M(q) at the rates q̇ of the coordinates, by dual numbers.
fn mass_matrix_along(tree: &Tree, q: &[f64], rates: &[f64]) -> DMatrix<f64> {
    let rows = denoc::mass_matrix(tree, &Untraced, &moving(q, rates)).concat();
    DMatrix::from_row_iterator(tree.nv(), tree.nv(), rows.iter().map(|x| x.rate))
}

/// C_ij = ½ Σ_k (∂M_ij/∂q_k + ∂M_ik/∂q_j − ∂M_jk/∂q_i) v_k.
fn christoffel(tree: &Tree, q: &[f64], v: &[f64]) -> DMatrix<f64> {
    let unit = |k: usize| (0..v.len()).map(|i| f64::from(u8::from(i == k))).collect::<Vec<_>>();
    let slopes: Vec<DMatrix<f64>> = (0..v.len()).map(|k| mass_matrix_along(tree, q, &unit(k))).collect();
    DMatrix::from_fn(v.len(), v.len(), |i, j| {
        let term = |k: usize| (slopes[k][(i, j)] + slopes[j][(i, k)] - slopes[i][(j, k)]) * v[k];
        0.5 * (0..v.len()).map(term).sum::<f64>()
    })
}

#[test]
fn the_coriolis_matrix_is_that_of_the_christoffel_symbols() {
    let mut errors = Errors::default();
    on_random_trees(|_, tree, State { q, v, .. }, expected| {
        let rows = denoc::coriolis_matrix(tree, &Untraced, q, v).concat();
        let matrix = DMatrix::from_row_slice(v.len(), v.len(), &rows);
        let mut add =
            |what: &str, computed: &[f64], expected: &[f64]| errors.add_to_one(what, computed, expected, 1e-12);
        // They are of coordinates that are as many as the velocities.
        if tree.nq() == tree.nv() {
            add("Christoffel symbols", matrix.as_slice(), christoffel(tree, q, v).as_slice());
        }
        let forces = &matrix * DVector::from_row_slice(v);
        add("C v", forces.as_slice(), (&expected.bias - &expected.gravity - &expected.passive).as_slice());
        let skew = &mass_matrix_along(tree, q, &denoc::coordinate_rates(tree, q, v)) - 2.0 * &matrix;
        add("M' - 2 C", skew.as_slice(), (-skew.transpose()).as_slice());
        let base = base_parameters(tree, Vanishing::TensorYy);
        add("base parameters", &denoc::coriolis_matrix(&base, &Untraced, q, v).concat(), &rows);
    });
    println!("{:?}", errors.0);
}

/// The outputs of a traced function.
fn evaluated(functions: &[TracedFunction], name: &str, arguments: &[&[f64]]) -> Vec<f64> {
    let function = functions.iter().find(|function| function.function.name() == name).expect("a function");
    function.expressions.evaluate(arguments)
}

#[test]
fn traced_expressions_agree_with_kanes_equations() {
    traced_expressions_agree(sample(OF_ONE_FREEDOM).step_by(2));
}

#[test]
fn traced_expressions_agree_with_kanes_equations_where_joints_have_physics() {
    traced_expressions_agree(sample(OF_ONE_FREEDOM).skip(1).step_by(2));
}

#[test]
fn traced_expressions_agree_with_kanes_equations_where_joints_have_several_freedoms() {
    traced_expressions_agree(sample(IN_SPACE));
}

#[test]
fn traced_expressions_agree_with_kanes_equations_where_joints_are_several_in_series() {
    traced_expressions_agree(sample(IN_SERIES));
}

#[test]
fn traced_expressions_agree_with_kanes_equations_where_joints_mimic_others() {
    traced_expressions_agree(with_mimics());
}

fn traced_expressions_agree(seeds: impl Iterator<Item = u64>) {
    let (mut errors, mut random) = (Errors::default(), Random::new(1));
    let mut traced: Option<(Tree, Vec<TracedFunction>)> = None;
    on_trees(seeds, |model, tree, State { q, v, a }, expected| {
        if traced.as_ref().is_none_or(|(of, _)| of != tree) {
            traced = Some((tree.clone(), trace(tree).expect("no pass changes a value")));
        }
        let functions = &traced.as_ref().expect("just traced").1;
        let tau = forces(expected, a);
        let mut add = |name: &str, arguments: &[&[f64]], expected: &[f64], tolerance| {
            errors.add(name, &evaluated(functions, name, arguments), expected, tolerance);
        };
        add("inverse_dynamics", &[q, v, a], tau.as_slice(), 1e-12);
        add("mass_matrix", &[q], expected.matrix.as_slice(), 1e-12);
        add("bias_forces", &[q, v], expected.bias.as_slice(), 1e-12);
        add("gravity_forces", &[q], expected.gravity.as_slice(), 1e-12);
        add("passive_forces", &[q, v], expected.passive.as_slice(), of_passive(tree, 1e-15));
        add("dissipated_power", &[q, v], &[expected.dissipated], of_passive(tree, 1e-14));
        let coriolis = evaluated(functions, "coriolis_matrix", &[q, v]);
        let wanted = match tree.nq() == tree.nv() {
            true => christoffel(tree, q, v).transpose().as_slice().to_vec(),
            false => denoc::coriolis_matrix(tree, &Untraced, q, v).concat(),
        };
        errors.add_to_one("coriolis_matrix", &coriolis, &wanted, 1e-12);
        let mut add = |name: &str, arguments: &[&[f64]], expected: &[f64], tolerance| {
            errors.add(name, &evaluated(functions, name, arguments), expected, tolerance);
        };
        let (wanted, condition) = accelerations(expected, &tau);
        add("forward_dynamics", &[q, v, tau.as_slice()], wanted.as_slice(), 1e-15 * condition.max(1e3));
        let energies = evaluated(functions, "energy", &[q, v]);
        errors.add("kinetic", &energies[..1], &[expected.kinetic], 1e-12);
        errors.add("potential", &[energies[1] - expected.potential + 1.0], &[1.0], 1e-12);
        let [center, momentum] = center_and_momentum(model, expected, v);
        errors.add("center_of_mass", &evaluated(functions, "center_of_mass", &[q, v]), &center, 1e-12);
        errors.add("momentum", &evaluated(functions, "momentum", &[q, v]), &momentum, 1e-12);
        let links = evaluated(functions, "link_kinematics", &[q, v]);
        let wanted = expected.links.iter().flat_map(|body| {
            let vectors = [&body.origin, &body.com, &body.velocity, &body.angular_velocity];
            let rotation = body.rotation.transpose();
            rotation.iter().copied().chain(vectors.into_iter().flatten().copied()).collect::<Vec<_>>()
        });
        errors.add("link_kinematics", &links, &wanted.collect::<Vec<_>>(), 1e-13);
        let moved = denoc::integrate(tree, q, a);
        let of_positions: [(Function, [&[f64]; 2]); 3] =
            [(Function::CoordinateRates, [q, v]), (Function::Integrate, [q, v]), (Function::Difference, [q, &moved])];
        for (function, arguments) in of_positions {
            let expected = denoc::evaluate(function, tree, &Untraced, &arguments);
            errors.add(function.name(), &evaluated(functions, function.name(), &arguments), &expected, 1e-14);
        }
        let wrenches = wrenches(&mut random, tree.frames.len());
        for (function, expected) in frame_functions(expected, v.len(), &wrenches) {
            let second = if function == Function::FrameForces { &wrenches } else { v };
            let arguments = [q.as_slice(), second];
            let arguments = &arguments[..function.signature().arguments.len()];
            errors.add(function.name(), &evaluated(functions, function.name(), arguments), &expected, 1e-13);
        }
    });
    println!("{:?}", errors.0);
}

/// The largest losses that are allowed on trees of a style: of joint forces and the mass matrix, and of accelerations,
/// in the metric of [`Reference`] (an error of 1e-16 is a rounding of the largest number).
///
/// Forces are sums of products: tens of roundings, and more where an axis is near a link and the frame in which the
/// link is carried is a thousand times as far: the moment about the one is what the far moments leave. Accelerations
/// are multiplied by the condition of the mass matrix, which the masses spread.
const ALLOWED: [(Style, f64, f64); 9] = [
    (Style::Ordinary, 2e-14, 1e-12),
    (Style::SpreadMasses, 5e-14, 1e-6),
    (Style::SpreadLengths, 1e-11, 1e-7),
    (Style::SpreadMassesAndLengths, 5e-11, 1e-3),
    (Style::Tilted, 2e-14, 1e-12),
    (Style::LongAndTilted, 2e-14, 1e-7),
    (Style::PointMasses, 5e-14, 1e-11),
    (Style::Rods, 2e-14, 1e-11),
    (Style::HeavyTip, 1e-13, 1e-4),
];

/// The compiled graph against the recursions in double-double arithmetic.
#[test]
fn compiled_functions_keep_their_digits_on_trees_of_every_style() {
    let trees = if cfg!(debug_assertions) { 1 } else { 40 };
    for (style, of_forces, of_accelerations) in ALLOWED {
        let mut worst = [0.0_f64; 3];
        for seed in 100..100 + trees {
            let tree = Tree::new(&style.model(&mut Random::new(seed), 12));
            let computed = [Function::InverseDynamics, Function::MassMatrix, Function::ForwardDynamics];
            let functions = traced(&tree, &computed);
            let reference = Reference::at(&tree, 1);
            for (worst, function) in worst.iter_mut().zip(computed) {
                *worst =
                    Real::maximum(*worst, reference.loss_by(function, |x| evaluated(&functions, function.name(), x)));
            }
        }
        println!("{style:?}: forces {:.1e}, matrix {:.1e}, accelerations {:.1e}", worst[0], worst[1], worst[2]);
        assert!(worst[0] <= of_forces && worst[1] <= of_forces, "{style:?}: {worst:?}");
        assert!(worst[2] <= of_accelerations, "{style:?}: {worst:?}");
    }
}
