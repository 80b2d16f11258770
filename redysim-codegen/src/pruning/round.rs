//! One round of pruning: the replacements that save most for the error they make, as long as all of them together stay
//! within the error allowed.

use super::columns::{Columns, derivatives, evaluate, live, sign};
use super::replacement::{Replacement, Simplification, candidates};
use crate::expressions::Expressions;

/// What a round is measured by.
pub struct Sample {
    /// The arguments in each state.
    pub arguments: Vec<Columns>,
    /// The outputs that are compared: equal ones once.
    pub outputs: Vec<usize>,
    /// What these are without pruning.
    pub exact: Vec<Vec<f64>>,
    /// The largest error that each of these may have.
    pub allowed: Vec<f64>,
}

/// Replacements whose error is a smaller share of what is allowed are ranked by what they save alone.
const NEGLIGIBLE: f64 = 1e-6;

/// Expressions with fewer operations, whose errors on the sample stay, to first order, within what is allowed.
pub fn round(expressions: &Expressions, sample: &Sample) -> Expressions {
    let live = live(expressions);
    let states = sample.arguments[0].states();
    let mut values = Columns::new(expressions.graph.len(), states);
    evaluate(expressions, &live, &sample.arguments, &mut values);
    let mut outputs: Vec<Output> = Vec::new();
    for ((&output, exact), &allowed) in sample.outputs.iter().zip(&sample.exact).zip(&sample.allowed) {
        let edge = expressions.outputs[output];
        let error = values.column(edge.node()).iter().zip(exact).map(|(now, exact)| sign(edge) * now - exact).collect();
        outputs.push(Output { error, allowed, derivatives: derivatives(expressions, edge, &values) });
    }
    let mut simplification = Simplification::new(expressions);
    let mut change = vec![0.0; states];
    let mut ranked: Vec<(f64, Replacement)> = Vec::new();
    for replacement in candidates(&expressions.graph, &live, &values) {
        replacement.change(&values, &mut change);
        let share = outputs.iter().map(|output| output.largest_share(&replacement, &change)).fold(0.0, f64::max);
        if share <= 1.0 {
            ranked.push((f64::from(simplification.saving(&replacement)) / share.max(NEGLIGIBLE), replacement));
        }
    }
    ranked.sort_by(|(a, _), (b, _)| b.total_cmp(a));
    for (_, replacement) in ranked {
        if simplification.saving(&replacement) == 0 {
            continue;
        }
        replacement.change(&values, &mut change);
        if outputs.iter().all(|output| output.fits_budget(&replacement, &change)) {
            outputs.iter_mut().for_each(|output| output.commit(&replacement, &change));
            simplification.replace(replacement);
        }
    }
    simplification.rebuilt()
}

/// One output, with the error of the replacements made so far.
struct Output {
    /// Its error in each state.
    error: Vec<f64>,
    allowed: f64,
    /// By each node.
    derivatives: Vec<Option<Vec<f64>>>,
}

impl Output {
    fn derivative(&self, replacement: &Replacement) -> Option<&[f64]> {
        self.derivatives.get(replacement.node)?.as_deref()
    }

    /// The largest effect of the change, as a share of what is allowed; infinite once it exceeds that.
    fn largest_share(&self, replacement: &Replacement, change: &[f64]) -> f64 {
        let Some(derivative) = self.derivative(replacement) else { return 0.0 };
        let mut largest = 0.0_f64;
        let mut i = 0;
        while i < change.len() {
            let effect = (derivative[i] * change[i]).abs();
            if effect > largest || effect.is_nan() {
                largest = effect;
                if !within(effect, self.allowed) {
                    return f64::INFINITY;
                }
            }
            i += 1;
        }
        if largest == 0.0 { 0.0 } else { largest / self.allowed }
    }

    /// Whether the error stays within what is allowed after the replacement.
    fn fits_budget(&self, replacement: &Replacement, change: &[f64]) -> bool {
        let Some(derivative) = self.derivative(replacement) else { return true };
        let mut i = 0;
        while i < change.len() {
            if !within(self.error[i] + derivative[i] * change[i], self.allowed) {
                return false;
            }
            i += 1;
        }
        true
    }

    /// Adds the effect of the replacement to the error.
    fn commit(&mut self, replacement: &Replacement, change: &[f64]) {
        let Some(Some(derivative)) = self.derivatives.get(replacement.node) else { return };
        let mut i = 0;
        while i < change.len() {
            self.error[i] += derivative[i] * change[i];
            i += 1;
        }
    }
}

/// False for NaN.
fn within(value: f64, bound: f64) -> bool {
    value.abs() <= bound
}
