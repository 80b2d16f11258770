//! How far a pruned function is from the whole one.

use super::columns::{Columns, evaluate, live, sign};
use super::states::{Sampled, States};
use crate::expressions::Expressions;
use crate::graph::{Edge, Graph};
use redysim_runtime::function::Shape;
use std::ops::Range;

/// States that are evaluated together: their values stay in the cache.
const BLOCK: usize = 250;

/// For each output, the largest size it has and the largest error.
#[derive(Clone)]
struct Extremes {
    sizes: Vec<f64>,
    errors: Vec<f64>,
}

/// The largest error of `pruned` in `count` states against `whole`, or against the accelerations of the motion, as a
/// share of the [scale](scales) of its output.
pub fn worst_error(
    whole: &Expressions,
    pruned: &Expressions,
    shape: Shape,
    states: &States,
    count: usize,
    seed: u64,
) -> f64 {
    let both = merged([whole, pruned]);
    let blocks = count.div_ceil(BLOCK);
    let threads = std::thread::available_parallelism().map_or(1, |threads| threads.get()).min(blocks);
    let share = blocks.div_ceil(threads);
    let parts = std::thread::scope(|scope| {
        let start = |thread: usize| {
            let part = thread * share..((thread + 1) * share).min(blocks);
            let both = &both;
            scope.spawn(move || extremes(both, states, part, seed))
        };
        let running: Vec<_> = (0..threads).map(start).collect();
        let done = running.into_iter().map(|thread| thread.join().expect("evaluation does not panic"));
        done.collect::<Vec<_>>()
    });
    let largest = |of: fn(&Extremes) -> &Vec<f64>| {
        let empty = vec![0.0; whole.outputs.len()];
        parts.iter().fold(empty, |most: Vec<f64>, part| most.iter().zip(of(part)).map(|(a, &b)| a.max(b)).collect())
    };
    let (sizes, errors) = (largest(|part| &part.sizes), largest(|part| &part.errors));
    let shares = errors.iter().zip(scales(shape, states, &sizes)).map(|(&error, scale)| share_of(error, scale));
    shares.fold(0.0, f64::max)
}

/// An error of 0 is a share of 0, even of a scale of 0; NaN counts as infinite.
fn share_of(error: f64, scale: f64) -> f64 {
    let share = if error == 0.0 { 0.0 } else { error / scale };
    if share.is_nan() { f64::INFINITY } else { share }
}

/// The scale of each output, of which its error is a share: of a joint force, the force that the joint's range states,
/// if any; of an element of the mass matrix, √(M_ii M_jj) at its largest; else the largest size of the output.
pub fn scales(shape: Shape, states: &States, sizes: &[f64]) -> Vec<f64> {
    let of_forces = |sizes: &[f64]| -> Vec<f64> {
        let stated = states.ranges.iter().map(|range| range.force);
        stated.zip(sizes).map(|(stated, &size)| stated.unwrap_or(size)).collect()
    };
    match shape {
        Shape::Forces => of_forces(sizes),
        Shape::HybridMotion => {
            let (accelerations, forces) = sizes.split_at(states.ranges.len());
            [accelerations, &of_forces(forces)].concat()
        }
        Shape::MassMatrix => {
            let order = sizes.len().isqrt();
            let diagonal = |i: usize| sizes[i * (order + 1)];
            (0..sizes.len()).map(|k| (diagonal(k / order) * diagonal(k % order)).sqrt()).collect()
        }
        _ => sizes.to_vec(),
    }
}

/// The extremes in the given blocks of states; `both` has the outputs of the whole function, then those of the pruned
/// one.
fn extremes(both: &Expressions, states: &States, blocks: Range<usize>, seed: u64) -> Extremes {
    let live = live(both);
    let velocities = states.ranges.len();
    let mut values = Columns::new(both.graph.len(), BLOCK);
    let (whole, pruned) = both.outputs.split_at(both.outputs.len() / 2);
    let mut extremes = Extremes { sizes: vec![0.0; whole.len()], errors: vec![0.0; whole.len()] };
    for block in blocks {
        // Of accelerations the exact values are known: those that the forces were computed for.
        let Sampled { arguments, exact } = states.sampled(BLOCK, seed + block as u64);
        evaluate(both, &live, &arguments, &mut values);
        for (output, (&old, &new)) in whole.iter().zip(pruned).enumerate() {
            let old = match &exact {
                Some(vectors) => (1.0, vectors[output / velocities].column(output % velocities)),
                None => (sign(old), values.column(old.node())),
            };
            let (size, error) = size_and_difference(old, (sign(new), values.column(new.node())));
            extremes.sizes[output] = extremes.sizes[output].max(size);
            extremes.errors[output] = extremes.errors[output].max(error);
        }
    }
    extremes
}

/// Two functions as one, so that what they have in common is computed once.
fn merged(functions: [&Expressions; 2]) -> Expressions {
    let mut graph = Graph::default();
    let mut outputs = Vec::new();
    for function in functions {
        let mut made: Vec<Edge> = Vec::with_capacity(function.graph.len());
        for node in (0..function.graph.len()).map(|index| function.graph.node(index)) {
            let edge = graph.rebuild(node, |edge| made[edge.node()].flipped_if(edge.is_negative()));
            made.push(edge);
        }
        outputs.extend(function.outputs.iter().map(|edge| made[edge.node()].flipped_if(edge.is_negative())));
    }
    Expressions { graph, outputs }
}

/// The largest size of the first column and the largest difference of the two, each column times a sign; NaN counts as
/// infinite.
fn size_and_difference((old, before): (f64, &[f64]), (new, after): (f64, &[f64])) -> (f64, f64) {
    let (mut size, mut error) = (0.0_f64, 0.0_f64);
    let mut i = 0;
    while i < before.len() {
        let difference = (new * after[i] - old * before[i]).abs();
        let absolute = before[i].abs();
        if absolute > size {
            size = absolute;
        }
        if difference > error || difference.is_nan() {
            error = if difference.is_nan() { f64::INFINITY } else { difference };
        }
        i += 1;
    }
    (size, error)
}
