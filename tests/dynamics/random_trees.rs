//! On random trees the recursions, the base parameters and the traced expressions agree with Kane's equations.
//!
//! Two hundred trees of up to twelve joints: revolute, prismatic, helical and fixed, branching, oblique, links in
//! scrambled order; in half of them with rotors, damping, friction and springs in the joints, in half with springs and
//! dampers between points. Each has three frames of interest, on links or on the ground.

use crate::common::dual::{Dual, moving};
use crate::common::kane::{Kane, kane};
use crate::common::random::{Random, State};
use crate::common::styles::{Style, inertia, link, offset, placed};
use nalgebra::{DMatrix, DVector, Matrix3, Rotation3, Unit, Vector3};
use redysim_codegen::accuracy::Reference;
use redysim_codegen::functions::{TracedFunction, trace};

use redysim_model::denoc::{self, Method, Untraced};
use redysim_model::joint::{JointPhysics, Vanishing};
use redysim_model::regroup::base_parameters;
use redysim_model::spatial::{Pose, Vec3};
use redysim_model::{Frame, Function, JointKind, Link, LinkPoint, Model, Spring, Tree};
use std::collections::BTreeMap;

const TREES: u64 = 200;
const STATES: usize = 3;

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
        *worst = worst.max(error);
    }

    /// The same with one added to each component, so that what happens to vanish is held against numbers of size one.
    fn add_to_one(&mut self, what: &str, computed: &[f64], expected: &[f64], tolerance: f64) {
        let from_one = |values: &[f64]| values.iter().map(|x| x + 1.0).collect::<Vec<_>>();
        self.add(what, &from_one(computed), &from_one(expected), tolerance);
    }
}

fn rotation(random: &mut Random) -> Matrix3<f64> {
    // A third of all rotations are quarter turns, as in most machines.
    let angle = if random.below(3) == 0 { std::f64::consts::FRAC_PI_2 } else { random.within(3.0) };
    *Rotation3::from_axis_angle(&Unit::new_normalize(axis(random)), angle).matrix()
}

fn axis(random: &mut Random) -> Vector3<f64> {
    match random.below(4) {
        0 => Vector3::z(),
        1 => [Vector3::x(), Vector3::y(), -Vector3::x(), -Vector3::y()][random.below(4)],
        _ => Vector3::from_fn(|_, _| random.within(1.0)).normalize(),
    }
}

/// A tree of up to twelve links on joints of all kinds.
fn random_model(random: &mut Random) -> Model {
    let count = 1 + random.below(12);
    let links = random.tree(count, |random, grown, parent| {
        let joint = match random.below(5) {
            0 if grown > 0 => JointKind::Fixed,
            1 => JointKind::Prismatic,
            2 if grown % 3 != 1 => JointKind::Helical,
            _ => JointKind::Revolute,
        };
        let turned = rotation(random);
        let at = Vec3::from_fn(|_| random.within(0.5));
        let frame = if random.below(2) == 0 {
            Pose::identity()
        } else {
            placed(&rotation(random), Vec3::from_fn(|_| random.within(0.3)))
        };
        // A body of a few kilogrammes and decimetres.
        Link {
            axis: Vec3(axis(random).into()),
            frame,
            offset: offset(random),
            pitch: if joint == JointKind::Helical { 0.4 - 0.1 * grown as f64 } else { 0.0 },
            mass: 1.5 + random.within(1.0),
            com: Vec3::from_fn(|_| random.within(0.2)),
            inertia: {
                let shares = [0; 3].map(|_| 0.01 + random.within(0.009));
                inertia(&rotation(random), shares)
            },
            ..link(grown, parent, joint, placed(&turned, at))
        }
    });
    Model {
        name: "random".into(),
        gravity: Vec3::from_fn(|_| random.within(10.0)),
        links,
        loops: Vec::new(),
        frames: Vec::new(),
        springs: Vec::new(),
    }
}

/// What acts in a joint: each of its parts in half of the joints.
fn joint_physics(random: &mut Random) -> JointPhysics {
    let mut some = |largest: f64| if random.below(2) == 0 { 0.0 } else { 0.5 * largest + random.within(0.5 * largest) };
    JointPhysics {
        armature: some(0.5),
        damping: some(2.0),
        friction: some(4.0),
        friction_velocity: 0.05 + some(0.2),
        stiffness: some(20.0),
        rest: some(1.0),
    }
}

/// A frame somewhere on a link, or on the ground; a third of them stand on the origin of the link's frame.
fn frame(random: &mut Random, model: &Model, index: usize) -> Frame {
    let link = random.below(model.links.len() + 1).checked_sub(1);
    let at = if random.below(3) == 0 { Vec3::zero() } else { Vec3::from_fn(|_| random.within(0.3)) };
    Frame { name: format!("frame{index}"), link, placement: placed(&rotation(random), at) }
}

/// A spring between points of two links, or of a link and the ground. One in four has no stiffness, one in four no
/// damping, one in three no free length.
fn spring(random: &mut Random, model: &Model) -> Spring {
    let count = model.links.len() + 1;
    let first = random.below(count);
    // Another link: between points of one link, Kane's equations know no direction where the points coincide.
    let second = (first + 1 + random.below(count - 1)) % count;
    let [a, b] = [first, second]
        .map(|link| LinkPoint { link: link.checked_sub(1), point: Vec3::from_fn(|_| random.within(0.4)) });
    let acts = random.below(4);
    Spring {
        name: None,
        a,
        b,
        stiffness: if acts == 0 { 0.0 } else { 30.0 + random.within(20.0) },
        damping: if acts == 1 { 0.0 } else { 3.0 + random.within(2.0) },
        length: if random.below(3) == 0 { 0.0 } else { 0.5 + random.within(0.4) },
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
    on_trees(0..TREES, check);
}

/// The same with the trees of these seeds: odd ones have rotors, damping, friction and springs in their joints.
fn on_trees(seeds: impl Iterator<Item = u64>, mut check: impl FnMut(&Model, &Tree, &State, &Kane)) {
    for seed in seeds {
        let mut random = Random::new(seed);
        let mut model = random_model(&mut random);
        if seed % 2 == 1 {
            let moving = model.links.iter_mut().filter(|link| link.joint != JointKind::Fixed);
            moving.for_each(|link| link.physics = joint_physics(&mut random));
        }
        if seed % 4 >= 2 {
            model.springs = (0..3).map(|_| spring(&mut random, &model)).collect();
        }
        model.frames = (0..3).map(|index| frame(&mut random, &model, index)).collect();
        let tree = Tree::new(&model);
        for _ in 0..STATES {
            let state = random.state(model.dof());
            let expected = kane(&model, &state.q, &state.v);
            check(&model, &tree, &state, &expected);
        }
    }
}

/// The accelerations that Kane's equations give, and how many roundings the condition of M makes of one.
fn accelerations(expected: &Kane, tau: &DVector<f64>) -> (DVector<f64>, f64) {
    let eigenvalues = expected.matrix.clone().symmetric_eigenvalues();
    let accelerations = expected.matrix.clone().cholesky().expect("positive definite").solve(&(tau - &expected.bias));
    (accelerations, eigenvalues.max() / eigenvalues.min())
}

/// What passive forces may be off by: those of joints are a few operations, springs between points take the positions
/// of their ends.
fn of_passive(tree: &Tree, of_joints: f64) -> f64 {
    if tree.springs.is_empty() { of_joints } else { 1e-12 }
}

fn forces(expected: &Kane, a: &[f64]) -> DVector<f64> {
    &expected.matrix * DVector::from_row_slice(a) + &expected.bias
}

#[test]
fn recursions_agree_with_kanes_equations() {
    let mut errors = Errors::default();
    on_random_trees(|_, tree, State { q, v, a }, expected| {
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
            let (wanted, condition) = accelerations(expected, &tau);
            for method in [Method::Factorisation, Method::Recursion] {
                let found = denoc::forward_dynamics(method, tree, &Untraced, q, v, tau.as_slice());
                add(&format!("{method:?}"), &found, wanted.as_slice(), 1e-15 * condition.max(1e3));
            }
        }
    });
    println!("{:?}", errors.0);
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

/// M(q), and its derivative along `v`, by dual numbers.
fn mass_matrix_along(tree: &Tree, q: &[f64], v: &[f64]) -> [DMatrix<f64>; 2] {
    let rows = denoc::mass_matrix(tree, &Untraced, &moving(q, v)).concat();
    let parts: [fn(&Dual<f64>) -> f64; 2] = [|x| x.value, |x| x.rate];
    parts.map(|part| DMatrix::from_row_iterator(v.len(), v.len(), rows.iter().map(part)))
}

/// C_ij = ½ Σ_k (∂M_ij/∂q_k + ∂M_ik/∂q_j − ∂M_jk/∂q_i) v_k.
fn christoffel(tree: &Tree, q: &[f64], v: &[f64]) -> DMatrix<f64> {
    let unit = |k: usize| (0..v.len()).map(|i| f64::from(u8::from(i == k))).collect::<Vec<_>>();
    let slopes: Vec<DMatrix<f64>> = (0..v.len()).map(|k| mass_matrix_along(tree, q, &unit(k))[1].clone()).collect();
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
        add("Christoffel symbols", matrix.as_slice(), christoffel(tree, q, v).as_slice());
        let forces = &matrix * DVector::from_row_slice(v);
        add("C v", forces.as_slice(), (&expected.bias - &expected.gravity - &expected.passive).as_slice());
        let skew = &mass_matrix_along(tree, q, v)[1] - 2.0 * &matrix;
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
    traced_expressions_agree((0..TREES).step_by(2));
}

#[test]
fn traced_expressions_agree_with_kanes_equations_where_joints_have_physics() {
    traced_expressions_agree((1..TREES).step_by(2));
}

fn traced_expressions_agree(seeds: impl Iterator<Item = u64>) {
    let (mut errors, mut random) = (Errors::default(), Random::new(1));
    let mut traced: Option<(Tree, Vec<TracedFunction>)> = None;
    on_trees(seeds, |_, tree, State { q, v, a }, expected| {
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
        errors.add_to_one("coriolis_matrix", &coriolis, christoffel(tree, q, v).transpose().as_slice(), 1e-12);
        let mut add = |name: &str, arguments: &[&[f64]], expected: &[f64], tolerance| {
            errors.add(name, &evaluated(functions, name, arguments), expected, tolerance);
        };
        let (wanted, condition) = accelerations(expected, &tau);
        add("forward_dynamics", &[q, v, tau.as_slice()], wanted.as_slice(), 1e-15 * condition.max(1e3));
        let energies = evaluated(functions, "energy", &[q, v]);
        errors.add("kinetic", &energies[..1], &[expected.kinetic], 1e-12);
        errors.add("potential", &[energies[1] - expected.potential + 1.0], &[1.0], 1e-12);
        let links = evaluated(functions, "link_kinematics", &[q, v]);
        let wanted = expected.links.iter().flat_map(|body| {
            let vectors = [&body.origin, &body.com, &body.velocity, &body.angular_velocity];
            let rotation = body.rotation.transpose();
            rotation.iter().copied().chain(vectors.into_iter().flatten().copied()).collect::<Vec<_>>()
        });
        errors.add("link_kinematics", &links, &wanted.collect::<Vec<_>>(), 1e-13);
        let wrenches = wrenches(&mut random, tree.frames.len());
        for (function, expected) in frame_functions(expected, q.len(), &wrenches) {
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
            let functions = trace(&tree).expect("no pass changes a value");
            let reference = Reference::at(&tree, 1);
            let computed = [Function::InverseDynamics, Function::MassMatrix, Function::ForwardDynamics];
            for (worst, function) in worst.iter_mut().zip(computed) {
                *worst = worst.max(reference.loss_by(function, |x| evaluated(&functions, function.name(), x)));
            }
        }
        println!("{style:?}: forces {:.1e}, matrix {:.1e}, accelerations {:.1e}", worst[0], worst[1], worst[2]);
        assert!(worst[0] <= of_forces && worst[1] <= of_forces, "{style:?}: {worst:?}");
        assert!(worst[2] <= of_accelerations, "{style:?}: {worst:?}");
    }
}
