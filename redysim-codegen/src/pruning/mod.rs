//! Terms that do not matter within the ranges of the joints, left out.
//!
//! What a value does to an output is, to first order, its change times the derivative of the output by it. Both are
//! known in a sample of states, corners of the ranges among them, so that the effect of leaving something out is a
//! column of numbers, and effects add up with their signs. Rounds of this go on until nothing more can be left out;
//! then the error is measured in a hundred thousand other states, without any approximation. Where it exceeds the
//! tolerance, all is done again for less.
//!
//! Published precedent: "customized" dynamics of the PUMA 560, in which terms below 1 % of the largest torque were left
//! out (Armstrong, Khatib & Burdick, "The explicit dynamic model and inertial parameters of the PUMA 560 arm", Proc.
//! IEEE Int. Conf. on Robotics and Automation, 1986).

mod columns;
mod measure;
mod replacement;
mod round;
mod states;

use crate::expressions::Expressions;
use crate::graph::Edge;
use crate::passes::{PassError, Passes, simplified, well_formed};
use columns::{Columns, evaluate, live, sign};
use measure::{scales, worst_error};
use redysim_runtime::OperationCount;
use redysim_runtime::function::Shape;
use round::{Sample, round};
pub use states::States;

/// What pruning has done to a function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pruning {
    /// The error allowed, as a share of each output's scale.
    pub tolerance: f64,
    /// Operations without pruning.
    pub before: OperationCount,
    /// The largest error found, as such a share.
    pub worst: f64,
    /// In how many states that was looked for.
    pub states: usize,
    /// Whether the tolerance holds, with a tenth of it to spare for other states. If not, the function is left whole,
    /// and `worst` is that of the last attempt.
    pub holds: bool,
}

/// States in which the error of a pruned function is measured.
const MEASURED: usize = 100_000;
/// The part of the tolerance that a pruned function may use up in these; the rest is for states in which it was not
/// measured.
const USED: f64 = 0.9;
/// Rounds at most; each sees what the one before has made possible.
const ROUNDS: usize = 6;
/// How many aims are tried at most.
const ATTEMPTS: usize = 8;
/// Two aims are the same if their quotient is less.
const NARROW: f64 = 1.15;
/// Of a sample from which terms are judged, the largest number of states, and of numbers that are kept for it.
const LARGEST_SAMPLE: usize = 1000;
const SMALLEST_SAMPLE: usize = 60;
const KEPT_NUMBERS: usize = 8_000_000;

/// A function without what does not matter to `tolerance`.
pub fn pruned(
    whole: &Expressions,
    shape: Shape,
    states: &States,
    tolerance: f64,
    passes: &Passes,
) -> Result<(Expressions, Pruning), PassError> {
    let before = whole.count();
    let mut sample = sample(whole, shape, states);
    let scales = sample.allowed.clone();
    let bound = USED * tolerance;
    let measured = |candidate: &Expressions, seed: u64| {
        let in_states = |states_asked: usize| {
            let worst = worst_error(whole, candidate, shape, states, states_asked, seed);
            Pruning { tolerance, before, worst, states: states_asked, holds: worst <= bound }
        };
        // Where a part of the states is enough to refute it, the others need not be asked.
        let few = in_states(MEASURED / 20);
        if few.holds { in_states(MEASURED) } else { few }
    };
    // The sample may miss the worst states. So what is aimed at there is found by bisection, between the largest aim
    // with which the bound holds elsewhere and the smallest with which it does not.
    let (mut aim, mut held, mut broken) = (bound, 0.0, f64::INFINITY);
    let mut least: Option<(Expressions, Pruning)> = None;
    let mut last = Pruning { tolerance, before, worst: f64::INFINITY, states: 0, holds: false };
    for attempt in 0..ATTEMPTS {
        sample.allowed = scales.iter().map(|scale| aim * scale).collect();
        let candidate = rounds(whole, &sample, passes)?;
        if least.as_ref().is_some_and(|(least, _)| candidate.price() >= least.price()) {
            held = aim;
        } else {
            last = measured(&candidate, 1 << (40 + attempt));
            if last.holds {
                held = aim;
                least = Some((candidate, last));
            } else {
                broken = aim;
            }
        }
        if broken < NARROW * held || broken.is_infinite() {
            break;
        }
        aim = if held > 0.0 { 0.5 * (held + broken) } else { aim * (0.95 * bound / last.worst).max(0.1) };
    }
    Ok(least.unwrap_or((whole.clone(), last)))
}

/// The sample on which a function is judged; of its outputs the scale stands for what is allowed.
fn sample(whole: &Expressions, shape: Shape, states: &States) -> Sample {
    let mut outputs: Vec<usize> = Vec::new();
    for (index, output) in whole.outputs.iter().enumerate() {
        if outputs.iter().all(|&other| whole.outputs[other] != *output) {
            outputs.push(index);
        }
    }
    let live = live(whole);
    let fitting = KEPT_NUMBERS / (outputs.len() * live.len()).max(1);
    let arguments = states.arguments(fitting.clamp(SMALLEST_SAMPLE, LARGEST_SAMPLE), 1);
    let mut values = Columns::new(whole.graph.len(), arguments[0].states());
    evaluate(whole, &live, &arguments, &mut values);
    let of = |output: Edge| values.column(output.node()).iter().map(move |value| sign(output) * value);
    let sizes = whole.outputs.iter().map(|&output| of(output).fold(0.0, |size: f64, value| size.max(value.abs())));
    let scales = scales(shape, states, &sizes.collect::<Vec<_>>());
    Sample {
        exact: outputs.iter().map(|&output| of(whole.outputs[output]).collect()).collect(),
        allowed: outputs.iter().map(|&output| scales[output]).collect(),
        outputs,
        arguments,
    }
}

fn rounds(whole: &Expressions, sample: &Sample, passes: &Passes) -> Result<Expressions, PassError> {
    let mut least = whole.clone();
    for _ in 0..ROUNDS {
        let pruned = round(&least, sample);
        if cfg!(debug_assertions) {
            well_formed("pruning", &least, &pruned)?;
        }
        let next = simplified(pruned, passes)?;
        if next.price() >= least.price() {
            break;
        }
        least = next;
    }
    Ok(least)
}
