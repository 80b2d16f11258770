//! Pruning: terms that do not matter within the ranges of the joints are left out.
//!
//! What a value does to an output is, to first order, its change times the derivative of the output by it. Both are
//! known in a sample of states, corners of the ranges among them, so that the effect of leaving something out is a
//! column of numbers, and effects add up with their signs. Rounds follow each other until nothing more can be left out;
//! then the error is measured, without approximation, in a hundred thousand other states. Where it exceeds the
//! tolerance, the rounds are repeated with a smaller aim.
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
use states::Sampled;
pub use states::{Given, StateRange, States};

/// What pruning has done to a function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pruning {
    /// The error allowed, as a share of each output's scale.
    pub tolerance: f64,
    /// Operations without pruning.
    pub before: OperationCount,
    /// The largest error found, as such a share.
    pub worst: f64,
    /// The number of states in which it was measured.
    pub states: usize,
    /// Whether the tolerance holds, with a tenth of it to spare for other states. If not, the function is not pruned,
    /// and `worst` is that of the last attempt.
    pub holds: bool,
}

/// Sampled states in which the error of a pruned function is measured.
const VALIDATION_SAMPLES: usize = 100_000;
/// The share of the tolerance that the error in these may reach; the rest is for states that were not sampled.
const BUDGET_SHARE: f64 = 0.9;
/// The most rounds; each starts from what the one before has left.
const ROUNDS: usize = 6;
/// The most aims that are tried.
const ATTEMPTS: usize = 8;
/// Bisection ends where the ratio of the smallest aim that fails to the largest that holds is less.
const BISECTION_RATIO: f64 = 1.15;
/// The most and the fewest states of the sample from which terms are judged, and the most numbers that are stored for
/// it.
const LARGEST_SAMPLE: usize = 1000;
const SMALLEST_SAMPLE: usize = 60;
const LARGEST_STORE: usize = 8_000_000;

/// `whole` without the terms that do not matter to `tolerance`.
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
    let bound = BUDGET_SHARE * tolerance;
    let measured = |candidate: &Expressions, seed: u64| {
        let in_states = |count: usize| {
            let worst = worst_error(whole, candidate, shape, states, count, seed);
            Pruning { tolerance, before, worst, states: count, holds: worst <= bound }
        };
        // A part of the states is often enough to refute a candidate.
        let few = in_states(VALIDATION_SAMPLES / 20);
        if few.holds { in_states(VALIDATION_SAMPLES) } else { few }
    };
    // The sample may miss the worst states. So the error aimed at in the sample is found by bisection, between the
    // largest aim with which the bound holds in the validation samples and the smallest with which it does not.
    let (mut aim, mut holding, mut failing) = (bound, 0.0, f64::INFINITY);
    let mut cheapest: Option<(Expressions, Pruning)> = None;
    let mut last = Pruning { tolerance, before, worst: f64::INFINITY, states: 0, holds: false };
    for attempt in 0..ATTEMPTS {
        sample.allowed = scales.iter().map(|scale| aim * scale).collect();
        let candidate = rounds(whole, &sample, passes)?;
        if cheapest.as_ref().is_some_and(|(cheapest, _)| candidate.price() >= cheapest.price()) {
            holding = aim;
        } else {
            last = measured(&candidate, 1 << (40 + attempt));
            if last.holds {
                holding = aim;
                cheapest = Some((candidate, last));
            } else {
                failing = aim;
            }
        }
        if failing < BISECTION_RATIO * holding || failing.is_infinite() {
            break;
        }
        aim = if holding > 0.0 { 0.5 * (holding + failing) } else { aim * (0.95 * bound / last.worst).max(0.1) };
    }
    Ok(cheapest.unwrap_or((whole.clone(), last)))
}

/// The sample on which replacements are judged. The allowed error of each output is its scale, as for a tolerance of 1.
fn sample(whole: &Expressions, shape: Shape, states: &States) -> Sample {
    let mut outputs: Vec<usize> = Vec::new();
    for (index, output) in whole.outputs.iter().enumerate() {
        if outputs.iter().all(|&other| whole.outputs[other] != *output) {
            outputs.push(index);
        }
    }
    let live = live(whole);
    let fitting = LARGEST_STORE / (outputs.len() * live.len()).max(1);
    let Sampled { arguments, .. } = states.sampled(fitting.clamp(SMALLEST_SAMPLE, LARGEST_SAMPLE), 1);
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

/// Rounds of pruning, until one saves nothing.
fn rounds(whole: &Expressions, sample: &Sample, passes: &Passes) -> Result<Expressions, PassError> {
    let mut cheapest = whole.clone();
    for _ in 0..ROUNDS {
        let pruned = round(&cheapest, sample);
        if cfg!(debug_assertions) {
            well_formed("pruning", &cheapest, &pruned)?;
        }
        let next = simplified(pruned, passes)?;
        if next.price() >= cheapest.price() {
            break;
        }
        cheapest = next;
    }
    Ok(cheapest)
}
