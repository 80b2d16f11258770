//! Terms that do not matter are left out, and nothing else is.

#[path = "../common/random.rs"]
#[allow(dead_code)]
mod random;

use random::Random;
use redysim::Real;
use redysim_codegen::functions::{TracedFunction, trace_model, trace_of};
use redysim_codegen::passes::Passes;
use redysim_codegen::{implementation_with, source_file_with};
use redysim_model::{CodegenOptions, Frame, Function, Functions, JointRange, Link, Model, Tree, denoc};
use redysim_runtime::OperationCount;

fn model(name: &str) -> Model {
    let path = format!("{}/models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Model::load(path).unwrap_or_else(|faults| panic!("{faults}")).model
}

fn with_range(mut model: Model, range: JointRange) -> Model {
    model.links.iter_mut().for_each(|link| link.range = vec![range; link.joint.dof()]);
    model
}

/// The functions with nothing left out.
fn whole(model: &Model, functions: &[&str]) -> Vec<TracedFunction> {
    let functions = Functions::named(functions.iter().copied()).unwrap();
    let options = CodegenOptions { functions, ..CodegenOptions::default() };
    trace_of(&Tree::new(model), &options, &Passes::all()).expect("no pass changes a value")
}

fn traced(model: &Model, functions: &[&str], tolerance: f64) -> Vec<TracedFunction> {
    let functions = Functions::named(functions.iter().copied()).unwrap();
    trace_model(
        model,
        &CodegenOptions { functions, tolerance: Some(tolerance), ..CodegenOptions::default() },
        &Passes::all(),
    )
    .unwrap()
}

/// The worst error of a function at other states than those it was pruned at, as a share of the largest value, or of the mass
/// matrix of √(M_ii M_jj) at its largest. Forces that are given are those that `inverse` needs.
fn worst(
    whole: &TracedFunction,
    pruned: &TracedFunction,
    inverse: &TracedFunction,
    range: JointRange,
    tree: &Tree,
) -> f64 {
    let JointRange { position: [least, largest], velocity, acceleration: Some(acceleration), .. } = range else {
        panic!("{range:?} has no acceleration");
    };
    let (joints, neutral, actuated) = (tree.nv(), denoc::neutral::<f64>(tree), tree.actuated());
    let (mut sizes, mut errors) = (Vec::new(), Vec::new());
    let mut random = Random::new(1);
    for state in 0..20_000 {
        // In every other state rates are at their limits, where joint forces are largest.
        let mut vector = |bound: f64, at_limit: bool| -> Vec<f64> {
            let values = random.vector(joints, bound);
            if at_limit { values.iter().map(|value| bound.copysign(*value)).collect() } else { values }
        };
        let q = vector(0.5 * (largest - least), false).iter().map(|x| x + 0.5 * (least + largest)).collect::<Vec<_>>();
        let q = denoc::integrate(tree, &neutral, &q);
        let (v, mut given) = (vector(velocity, state % 2 == 0), vector(acceleration, state % 2 == 0));
        if matches!(whole.function, Function::ForwardDynamics | Function::HybridDynamics) {
            let forces = inverse.expressions.evaluate(&[&q, &v, &given]);
            for (velocity, force) in forces.into_iter().enumerate() {
                if whole.function == Function::ForwardDynamics || !actuated[velocity] {
                    given[velocity] = force;
                }
            }
        }
        let arguments = &[&q[..], &v, &given][..whole.function.signature().arguments.len()];
        let [whole, pruned] = [whole, pruned].map(|function| function.expressions.evaluate(arguments));
        sizes.resize(whole.len(), 0.0_f64);
        errors.resize(whole.len(), 0.0_f64);
        for (index, (whole, pruned)) in whole.iter().zip(&pruned).enumerate() {
            sizes[index] = sizes[index].max(whole.abs());
            errors[index] = errors[index].max((whole - pruned).abs());
        }
    }
    let scale = |index: usize| match whole.function {
        Function::MassMatrix => (sizes[index / joints * (joints + 1)] * sizes[index % joints * (joints + 1)]).sqrt(),
        _ => sizes[index],
    };
    let shares = errors.iter().enumerate().filter(|(_, error)| **error > 0.0);
    shares.map(|(index, error)| error / scale(index)).fold(0.0, Real::maximum)
}

#[test]
fn joint_forces_of_other_robots_stay_within_the_tolerance() {
    let range = JointRange { position: [-1.0, 2.0], velocity: 2.0, acceleration: Some(5.0), force: None };
    // A debug build takes the first.
    let robots = [
        "test/joints_in_series",
        "floating_three_link",
        "gripper",
        "test/gantry",
        "andrews",
        "kr5_floating",
        "parallel_gripper",
    ];
    for name in robots.into_iter().take(if cfg!(debug_assertions) { 1 } else { robots.len() }) {
        let model = with_range(model(name), range);
        let whole = whole(&model, &["inverse_dynamics"]).swap_remove(0);
        for tolerance in [1e-2, 1e-4] {
            let pruned = traced(&model, &["inverse_dynamics"], tolerance).swap_remove(0);
            let (before, after) = (whole.expressions.count(), pruned.expressions.count());
            let error = worst(&whole, &pruned, &whole, range, &Tree::new(&model));
            println!("{name} to {tolerance:e}: {} of {} flops, {error:.2e}", after.flops(), before.flops());
            assert!(error <= tolerance, "{name} to {tolerance:e}: {error:e}");
            // Sums that are associated once terms have been collected may take a few operations less.
            let stated = pruned.pruning.expect("pruned").before.flops();
            assert!((after.flops()..=before.flops()).contains(&stated), "{name}: {stated} of {}", before.flops());
            assert!(10 * stated >= 8 * before.flops(), "{name}: {stated} of {}", before.flops());
        }
        assert!(whole.pruning.is_none());
    }
}

/// A ball joint on an arm: its coordinates are a quaternion, and its parent moves.
#[test]
fn forces_accelerations_and_masses_of_a_spherical_joint_on_an_arm_stay_within_the_tolerance() {
    let range = JointRange { position: [-1.0, 1.5], velocity: 2.0, acceleration: Some(5.0), force: None };
    let (mut model, ball) = (model("two_link"), model("spherical_pendulum").links.swap_remove(0));
    model.links.push(Link { parent: Some(1), ..ball });
    let (model, tree) = (with_range(model.clone(), range), Tree::new(&model));
    let names = ["inverse_dynamics", "forward_dynamics", "mass_matrix"];
    let whole = whole(&model, &names);
    let tolerances: &[f64] = if cfg!(debug_assertions) { &[1e-1] } else { &[1e-1, 1e-3] };
    for &tolerance in tolerances {
        for (whole_function, pruned) in whole.iter().zip(traced(&model, &names, tolerance)) {
            let function = pruned.function;
            let (before, after) = (whole_function.expressions.count(), pruned.expressions.count());
            let error = worst(whole_function, &pruned, &whole[0], range, &tree);
            println!("{function} to {tolerance:e}: {} of {} flops, {error:.2e}", after.flops(), before.flops());
            assert!(error <= tolerance, "{function} to {tolerance:e}: {error:e}");
            assert!(pruned.pruning.is_some_and(|pruning| pruning.holds), "{function} to {tolerance:e}");
            assert!(tolerance < 0.1 || after.flops() < before.flops(), "{function}: nothing is left out");
        }
    }
}

/// The motion of the base is found, whose joint has no actuators, and the forces of the joints.
#[test]
fn hybrid_dynamics_of_a_robot_on_a_free_base_stays_within_the_tolerance() {
    let range = JointRange { position: [-1.0, 1.5], velocity: 2.0, acceleration: Some(5.0), force: None };
    let model = with_range(model("floating_three_link"), range);
    let names = ["inverse_dynamics", "hybrid_dynamics"];
    let [inverse, whole] = whole(&model, &names).try_into().unwrap();
    let tolerances: &[f64] = if cfg!(debug_assertions) { &[1e-1] } else { &[1e-1, 1e-3] };
    for &tolerance in tolerances {
        let pruned = traced(&model, &["hybrid_dynamics"], tolerance).swap_remove(0);
        let (before, after) = (whole.expressions.count().flops(), pruned.expressions.count().flops());
        let error = worst(&whole, &pruned, &inverse, range, &Tree::new(&model));
        println!("to {tolerance:e}: {after} of {before} flops, {error:.2e}");
        assert!(error <= tolerance, "to {tolerance:e}: {error:e}");
        assert!(pruned.pruning.is_some_and(|pruning| pruning.holds), "to {tolerance:e}");
        assert!(tolerance < 0.1 || after < before, "nothing is left out");
    }
}

/// Within a tenth of a degree the mass matrix is a constant, and sines and cosines are not needed.
#[test]
fn narrow_ranges_need_no_sines() {
    let range = JointRange { position: [-0.002, 0.002], velocity: 0.01, acceleration: Some(0.1), force: None };
    let matrix = traced(&with_range(model("kr5"), range), &["mass_matrix"], 0.01).swap_remove(0);
    assert_eq!(matrix.expressions.count(), OperationCount::NONE);
}

/// Against motors that are made for more, more can be left out.
#[test]
fn a_stated_force_is_what_the_tolerance_is_a_share_of() {
    let model = model("test/kr5_ranges");
    let mut strong = model.clone();
    let motors = [400.0, 400.0, 200.0, 30.0, 20.0, 10.0];
    strong.links.iter_mut().zip(motors).for_each(|(link, force)| {
        link.range[0].force = Some(force);
    });
    let whole = whole(&model, &["inverse_dynamics"]).swap_remove(0);
    let own = traced(&model, &["inverse_dynamics"], 0.01).swap_remove(0).expressions.count();
    let pruned = traced(&strong, &["inverse_dynamics"], 0.01).swap_remove(0);
    let count = pruned.expressions.count();
    println!(
        "{} of {} flops, {} where each joint's own force counts",
        count.flops(),
        whole.expressions.count().flops(),
        own.flops()
    );
    assert!(count.flops() + 30 <= own.flops());
    let mut random = Random::new(2);
    for _ in 0..2000 {
        let vector = |argument: usize| -> Vec<f64> {
            let ranges = model.links.iter().map(|link| link.range[0]);
            ranges
                .map(|JointRange { position: [a, b], velocity, acceleration, .. }| match argument {
                    0 => 0.5 * (a + b) + random.within(0.5 * (b - a)),
                    1 => random.within(velocity),
                    _ => random.within(acceleration.expect("the model's ranges have accelerations")),
                })
                .collect()
        };
        let arguments = [0, 1, 2].map(vector);
        let arguments = arguments.each_ref().map(Vec::as_slice);
        let [whole, pruned] = [&whole, &pruned].map(|function| function.expressions.evaluate(&arguments));
        for ((whole, pruned), force) in whole.iter().zip(&pruned).zip(motors) {
            assert!((whole - pruned).abs() <= 0.01 * force, "{pruned} instead of {whole}");
        }
    }
}

/// The published model at 1 % took 305 operations, a fifth of the explicit one. Here most of that is saved without any
/// tolerance.
#[test]
fn the_puma_takes_no_more_operations_than_recorded_at_a_tolerance_of_one_percent() {
    let model = model("test/puma560");
    let functions = traced(&model, &["inverse_dynamics", "forward_dynamics", "mass_matrix", "bias_forces"], 0.01);
    let counts: Vec<[u32; 2]> = functions
        .iter()
        .map(|function| [function.pruning.unwrap().before.flops(), function.expressions.count().flops()])
        .collect();
    assert!(functions.iter().all(|function| function.pruning.unwrap().worst <= 0.01));
    println!("{counts:?}");
    for ([before, after], most) in counts.into_iter().zip([[263, 108], [476, 409], [132, 86], [227, 72]]) {
        assert!(before <= most[0] && after <= most[1], "{before} -> {after}, not {most:?}");
    }
}

#[test]
fn energies_places_frames_coordinates_and_loops_are_exact() {
    let range = JointRange { position: [-1.0, 1.0], velocity: 1.0, acceleration: Some(1.0), force: None };
    let mut model = with_range(model("fourbar"), range);
    model.frames = vec![Frame { name: "tip".into(), link: Some(2), placement: model.links[2].placement }];
    let of_coordinates = ["coordinate_rates", "integrate", "difference", "neutral"];
    let exact = ["energy", "link_kinematics", "loop_residual", "loop_jacobian", "loop_bias"];
    let of_frames = ["frame_kinematics", "frame_jacobians", "frame_bias", "frame_forces"];
    let exact = [exact.as_slice(), &of_frames, &of_coordinates].concat();
    let whole = whole(&model, &exact);
    for function in traced(&model, &exact, 0.1) {
        let whole = whole.iter().find(|whole| whole.function == function.function).unwrap();
        assert_eq!(function.expressions.count(), whole.expressions.count());
        assert!(function.pruning.is_none());
    }
}

#[test]
fn the_documentation_states_the_tolerance_and_the_worst_error() {
    let functions = Functions::named(["inverse_dynamics"]).unwrap();
    let options = CodegenOptions { functions, tolerance: Some(0.01), ..CodegenOptions::default() };
    let source = source_file_with(&model("test/kr5_ranges"), "Kr5", &options).unwrap();
    assert!(source.contains(
        "/// Pruned to a tolerance of 0.01: 330 flops and 5 sine-cosine pairs before. The worst error of 100000"
    ));
    assert!(source.contains("/// - `joint1`: -2.7053 to 2.7053 rad, ±2.6878 rad/s, ±8.0000 rad/s²"));
    assert_eq!(source, source_file_with(&model("test/kr5_ranges"), "Kr5", &options).unwrap());
}

#[test]
fn without_a_range_nothing_is_pruned_with_a_warning() {
    let functions = Functions::named(["gravity_forces"]).unwrap();
    let options = CodegenOptions { functions, tolerance: Some(0.01), ..CodegenOptions::default() };
    let (name, runtime) = (quote::format_ident!("Kr5"), quote::quote!(::redysim_runtime));
    let generated =
        implementation_with(&model("kr5"), &name, &runtime, &options, &Passes::all()).expect("no pass changes a value");
    assert_eq!(
        generated.warnings,
        ["nothing is pruned: a tolerance needs a range with an acceleration for every joint, but joint `joint1` does \
          not have one: give its link a `range`"]
    );
    assert!(source_file_with(&model("kr5"), "Kr5", &options).unwrap().contains("// Warning: nothing is pruned"));
}

#[test]
fn a_function_for_which_the_tolerance_does_not_hold_is_left_whole() {
    let model = model("test/too_fast");
    let whole = whole(&model, &["forward_dynamics"]).swap_remove(0);
    let function = traced(&model, &["forward_dynamics"], 0.01).swap_remove(0);
    assert_eq!(function.pruning.map(|pruning| pruning.holds), Some(false));
    assert_eq!(function.expressions.count(), whole.expressions.count());
}

/// At one position and at rest, at rates that overflow, and far away.
#[test]
fn odd_ranges_do_no_harm() {
    let still = JointRange { position: [0.3, 0.3], velocity: 0.0, acceleration: Some(0.0), force: None };
    let fast = JointRange { velocity: 1e100, acceleration: Some(1e100), ..still };
    let far = JointRange { position: [-1e100, 1e100], velocity: 1.0, acceleration: Some(1.0), force: Some(1e-100) };
    let functions = ["inverse_dynamics", "forward_dynamics", "mass_matrix", "gravity_forces"];
    for range in [still, fast, far] {
        for function in traced(&with_range(model("gripper"), range), &functions, 0.01) {
            let pruning = function.pruning.unwrap();
            assert!(!pruning.holds || pruning.worst <= 0.01);
            assert!(function.expressions.count().flops() <= pruning.before.flops());
        }
    }
}
