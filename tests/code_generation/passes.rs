//! Every pass keeps the values and pays for itself.

use crate::common::double_double::{DoubleDouble, exact, rounded};
use crate::common::random::{Random, State};
use crate::common::traced::{traced, traced_with};
use redysim::{Real, Scalar};
use redysim_codegen::expressions::Expressions;
use redysim_codegen::functions::{TracedFunction, trace_with};
use redysim_codegen::passes::Passes;
use redysim_model::spatial::{Mat3, Vec3};
use redysim_model::{Function, Inertia, Link, Model, Tree, rotation};
use std::fmt::Write;

/// Each one alone, but for those that need base parameters.
fn alone() -> impl Iterator<Item = (String, Passes)> {
    Passes::SWITCHES.into_iter().map(|(name, switch)| {
        let mut passes = Passes { base_parameters: name == "axis_masses", ..Passes::none() };
        *switch(&mut passes) = true;
        (format!("only {name}"), passes)
    })
}

/// The functions that run on frames that are chosen anew.
const ON_CHOSEN_FRAMES: [Function; 5] = [
    Function::InverseDynamics,
    Function::ForwardDynamics,
    Function::MassMatrix,
    Function::BiasForces,
    Function::GravityForces,
];

fn model(name: &str) -> Model {
    let path = format!("{}/models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Model::load(path).expect("a good model").model
}

/// A tree of nine joints, two of them prismatic, with oblique, parallel and antiparallel axes and offsets.
fn mixed_tree() -> Model {
    let mut text = String::from("name = \"mixed\"\ngravity = [1.0, -9.0, 3.0]\n");
    let links = [
        ("base", "revolute", "[0.3, -0.2, 0.5]", 0.0),
        ("link0", "revolute", "[0.0, 0.0, 0.4]", 0.3),
        ("link1", "prismatic", "[0.0, 0.7, 0.0]", 0.2),
        ("link2", "revolute", "[0.0, 0.0, 0.0]", 0.0),
        ("link3", "revolute", "[\"180 deg\", 0.0, 0.0]", -0.4),
        ("link1", "revolute", "[\"90 deg\", 0.0, \"90 deg\"]", 0.0),
        ("link5", "prismatic", "[0.0, 0.0, 0.2]", 0.0),
        ("link6", "revolute", "[0.0, 0.0, 0.0]", 0.1),
        ("base", "revolute", "[0.0, 0.0, 0.0]", 0.0),
    ];
    for (index, (parent, joint, rpy, offset)) in links.into_iter().enumerate() {
        let at = 0.1 * index as f64;
        let variable = if joint == "prismatic" { "b" } else { "theta" };
        let placement = if index == 8 {
            format!("dh = {{ a = 0.2, alpha = 0.3, {variable} = {offset:?} }}")
        } else {
            format!("origin = {{ xyz = [{:?}, 0.3, {at:?}], rpy = {rpy} }}\naxis = [0.0, 0.0, 1.0]", 0.5 - at)
        };
        write!(
            text,
            "[[link]]\nname = \"link{index}\"\nparent = \"{parent}\"\njoint = \"{joint}\"\n{placement}\nmass = {:?}\n\
             com = [0.1, {at:?}, -0.2]\n\
             inertia = {{ xx = 0.11, yy = 0.12, zz = 0.13, xy = 0.01, yz = -0.02, xz = 0.015 }}\n",
            1.0 + at
        )
        .unwrap();
    }
    Model::from_toml(text, "mixed.toml").unwrap_or_else(|faults| panic!("{faults}")).model
}

/// The largest difference between two sets of functions in units of the largest component of each output, in
/// double-double, so that only what the passes do to constants is left.
fn difference(before: &[TracedFunction], after: &[TracedFunction], dof: usize) -> f64 {
    let mut random = Random::new(5);
    let mut worst = 0.0_f64;
    for (before, after) in before.iter().zip(after) {
        for _ in 0..10 {
            let State { q, v, a } = random.state(dof);
            let arguments = [exact(&q), exact(&v), exact(&a)];
            let arguments: Vec<&[DoubleDouble]> = arguments.iter().map(Vec::as_slice).collect();
            let exactly = |expressions: &Expressions| {
                rounded(expressions.evaluate_with(&arguments, |_, nominal| DoubleDouble::from_f64(nominal)))
            };
            let [old, new] = [before, after].map(|function| exactly(&function.expressions));
            let scale = old.iter().fold(0.0_f64, |scale, x| scale.max(x.abs()));
            // What an ill-conditioned mass matrix makes of the constants' roundoff is no fault of a pass, nor what is
            // left where the differences of inertias in the Coriolis matrix are small.
            let condition = match before.function.name() {
                "forward_dynamics" => 1e5,
                "coriolis_matrix" => 10.0,
                _ => 1.0,
            };
            let differences = old.iter().zip(&new).map(|(x, y)| (x - y).abs());
            worst = differences.fold(worst, |worst, x| Real::maximum(worst, x / (condition * scale.max(1e-9))));
        }
    }
    worst
}

#[test]
fn every_pass_keeps_the_values() {
    let models =
        [model("peers/kr5"), model("peers/gripper"), model("test/gantry"), mixed_tree(), model("peers/humanoid30")];
    // Unoptimised, the larger robots take as long as ten times the others.
    let count = if cfg!(debug_assertions) { 2 } else { 5 };
    for model in &models[..count] {
        let tree = Tree::new(model);
        let plain = trace_with(&tree, &Passes::none()).expect("no pass changes a value");
        for (set, passes) in Passes::variations().chain(alone()) {
            let worst = difference(&plain, &trace_with(&tree, &passes).expect("no pass changes a value"), model.dof());
            println!("{} {set}: {worst:.1e}", model.name);
            assert!(worst <= 1e-14, "{} {set}: {worst:e}", model.name);
        }
    }
}

/// KR5 as it is calibrated: axes tilted and origins offset by about `error`, rad and m.
fn calibrated(error: f64) -> Model {
    let mut model = model("kr5");
    let mut random = Random::new(11);
    for link in &mut model.links {
        let tilt = rotation::about_x(random.within(error)) * rotation::about_y(random.within(error));
        link.placement.rotation = link.placement.rotation * tilt;
        link.placement.position = link.placement.position + Vec3([0.0; 3].map(|_: f64| random.within(error)));
    }
    model
}

/// The common normal of nearly parallel axes is far away, and a mass that balances a short lever is large: neither may
/// cost the digits of all else. What is left is that elements of rotations below 64 roundings count as roundoff, also
/// where they are products of two tilts.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn small_tilts_and_offsets_cost_at_most_2e_13() {
    for exponent in 2..=12 {
        let error = 10.0_f64.powi(-exponent);
        let tree = Tree::new(&calibrated(error));
        let plain = trace_with(&tree, &Passes::none()).expect("no pass changes a value");
        let worst = difference(&plain, &trace_with(&tree, &Passes::all()).expect("no pass changes a value"), tree.nv());
        println!("errors of {error:.0e}: {worst:.1e}");
        assert!(worst <= 2e-13, "errors of {error:.0e}: {worst:e}");
    }
}

/// A robot in the coordinates of a map computes what it computes at the origin. (Positions and potential energy lose
/// what large coordinates lose.)
#[test]
fn a_robot_far_from_the_origin_keeps_its_inertias() {
    let mut moved = model("kr5");
    moved.links[0].placement.position = moved.links[0].placement.position + Vec3([1e6, 3e5, -2e6]);
    let [here, far] = [model("kr5"), moved]
        .map(|model| trace_with(&Tree::new(&model), &Passes::all()).expect("no pass changes a value"));
    let forces = |functions: &[TracedFunction]| functions[..5].to_vec();
    let worst = difference(&forces(&here), &forces(&far), 6);
    assert!(worst <= 1e-14, "{worst:e}");
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_operations_with_each_pass_are_those_of_the_snapshot() {
    let functions = [&ON_CHOSEN_FRAMES[..], &[Function::Energy]].concat();
    let row = |cells: Vec<String>| cells.iter().map(|cell| format!("{cell:>18}")).collect::<String>();
    let mut table = String::new();
    for name in ["peers/kr5", "peers/gripper", "peers/humanoid30", "peers/chain10", "test/kr5_origin_axis"] {
        let tree = Tree::new(&model(name));
        writeln!(table, "{name:<22}{}", row(functions.iter().map(|function| function.name().to_owned()).collect()))
            .unwrap();
        for (set, passes) in Passes::variations() {
            let traced = traced_with(&tree, &functions, &passes);
            let flops = traced.iter().map(|function| function.expressions.count().flops().to_string()).collect();
            writeln!(table, "{set:<22}{}", row(flops)).unwrap();
        }
    }
    insta::assert_snapshot!(table);
}

/// The model with each link's frame turned and slid along its axis, as a drawing program might have placed it.
fn scrambled(model: &Model, seed: u64) -> Model {
    let mut random = Random::new(seed);
    let mut scrambled = model.clone();
    let turns: Vec<(Mat3<f64>, Vec3<f64>)> = model
        .links
        .iter()
        .map(|link| {
            let turn = rotation::roll_pitch_yaw([random.within(3.0), random.within(1.5), random.within(3.0)]);
            (turn, link.axis.scale(random.within(0.5)))
        })
        .collect();
    for (index, link) in scrambled.links.iter_mut().enumerate() {
        let (turn, slide) = turns[index];
        let back = turn.transpose();
        let placement = link.placement;
        let mut rotation = placement.rotation * turn;
        let mut position = placement.rotation * slide + placement.position;
        if let Some(parent) = link.parent {
            let (turn, slide) = turns[parent];
            rotation = turn.transpose() * rotation;
            position = turn.transpose() * (position - slide);
        }
        (link.placement.rotation, link.placement.position) = (rotation, position);
        link.axis = back * link.axis;
        link.com = back * (link.com - slide);
        link.inertia = turned(link, back);
    }
    scrambled
}

fn turned(link: &Link, turn: Mat3<f64>) -> Inertia {
    let i = link.inertia;
    let full = Mat3([[i.xx, i.xy, i.xz], [i.xy, i.yy, i.yz], [i.xz, i.yz, i.zz]]);
    let Mat3(m) = turn * full * turn.transpose();
    Inertia { xx: m[0][0], yy: m[1][1], zz: m[2][2], xy: m[0][1], yz: m[1][2], xz: m[0][2] }
}

/// Whatever frames a model has, they are chosen anew. On numbers that were round before the frames were turned, a
/// product by chance equal to another may differ from it by roundoff afterwards, and of two ways that cost the same on
/// a neighbourhood another may be taken: for that, one operation in a thousand is allowed, and one, beside KR5.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn frames_placed_anyhow_cost_what_denavit_hartenberg_frames_cost() {
    for (name, by_chance) in [("peers/kr5", 0), ("kr5", 0), ("peers/gripper", 1), ("peers/humanoid30", 6)] {
        let model = model(name);
        let expected = counts(&model);
        for seed in 0..3 {
            for ((function, found), (_, expected)) in counts(&scrambled(&model, seed)).iter().zip(&expected) {
                let off = found.abs_diff(*expected);
                assert!(off <= by_chance, "{name}, seed {seed}, {function}: {found} instead of {expected}");
            }
        }
    }
}

/// Name and operations of the functions that run on chosen frames.
fn counts(model: &Model) -> Vec<(&'static str, u32)> {
    let traced = traced(&Tree::new(model), &ON_CHOSEN_FRAMES);
    traced.iter().map(|function| (function.function.name(), function.expressions.count().flops())).collect()
}
