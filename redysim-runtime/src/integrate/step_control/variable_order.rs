//! The control of size and order of numerical differentiation formulas.

use super::{SHRINKAGE_WITHOUT_ESTIMATE, SMALLEST_SHRINKAGE, StepControl, Trial, root};
use crate::integrate::integration::Integration;
use crate::integrate::ndf::NdfFormula;
use crate::integrate::{IntegrationError, Ode};
use crate::{Real, Vector};

/// The factor to a step size for which the iteration did not converge.
const SHRINKAGE_WITHOUT_CONVERGENCE: f64 = 0.3;
/// The largest factor between the sizes of two steps.
const LARGEST_GROWTH: f64 = 10.0;
/// How many times smaller than the estimated error allows a step of the same order is made, one of the order below, and
/// one of the order above, whose estimates are less certain.
const SAFETY: [f64; 3] = [1.2, 1.3, 1.4];
/// A first step aims at an error of 0.8² of the tolerance.
const SAFETY_OF_START: f64 = 0.8;
/// The smallest factor by which a step grows after a correction that has reset the differences.
const WORTH_AN_EARLY_CHANGE: f64 = 2.0;

/// Takes the order, of three neighbours, that allows the largest step, as MATLAB's `ode15s` does.
#[derive(Clone, Copy, Debug, Default)]
pub struct VariableOrder;

impl<S: Real, Y: Vector<S>> StepControl<S, Y, NdfFormula<S, Y>> for VariableOrder {
    /// The size with which the error ½ h² ÿ of a step of order 1 is 0.8² of the tolerance.
    fn first_size<O: Ode<S, Y> + ?Sized>(
        &self,
        formula: &mut NdfFormula<S, Y>,
        integration: &mut Integration<'_, S, Y, O>,
        reach: S,
    ) -> Result<S, IntegrationError<S>> {
        let second = formula.second_derivative(integration, reach)?;
        let two = S::one() + S::one();
        Ok(S::from_f64(SAFETY_OF_START) * (two * integration.tolerances.relative() / second).sqrt())
    }

    fn shrink(&mut self, formula: &mut NdfFormula<S, Y>, Trial { ratio, rejections, .. }: Trial<S>) -> S {
        if ratio == S::zero() {
            return S::from_f64(SHRINKAGE_WITHOUT_CONVERGENCE);
        }
        if rejections > 0 {
            return S::from_f64(SHRINKAGE_WITHOUT_ESTIMATE);
        }
        let (order, factor) = best(formula, ratio, 2, |factor| factor.maximum(S::from_f64(SMALLEST_SHRINKAGE)));
        formula.set_order(order);
        factor.minimum(S::one())
    }

    fn grow(&mut self, formula: &mut NdfFormula<S, Y>, Trial { ratio, rejections, .. }: Trial<S>) -> S {
        if rejections > 0 {
            return S::one();
        }
        let limited = |factor: S| factor.minimum(S::from_f64(LARGEST_GROWTH));
        // Only then are all differences that choose the order those of steps of one size.
        if formula.differences().steps() < formula.differences().order() + 2 {
            // Where corrections reset the differences step after step, there never are so many, and steps would stay as
            // small as they once became.
            let (_, factor) = best(formula, ratio, 1, limited);
            let grows = formula.restarted() && factor >= S::from_f64(WORTH_AN_EARLY_CHANGE);
            return if grows { factor } else { S::one() };
        }
        let (order, factor) = best(formula, ratio, 3, limited);
        if factor > S::one() {
            formula.set_order(order);
            factor
        } else {
            S::one()
        }
    }
}

/// The order among the first `candidates` of this one, the one below and the one above that allows the largest step,
/// and the factor to its size, each `limited`, where the error is 1/`ratio` times the tolerance.
fn best<S: Real, Y: Vector<S>>(
    formula: &NdfFormula<S, Y>,
    ratio: S,
    candidates: usize,
    limited: impl Fn(S) -> S,
) -> (usize, S) {
    let order = formula.differences().order();
    let [lower, higher] = formula.neighbours();
    let ratios = [(order, ratio), (order.saturating_sub(1), lower), (order + 1, higher)];
    let factors = ratios.iter().zip(SAFETY).take(candidates);
    factors.fold((order, S::zero()), |best, (&(order, ratio), safety)| {
        let factor = limited(ratio.powf(root(order as u32 + 1)) / S::from_f64(safety));
        if factor > best.1 { (order, factor) } else { best }
    })
}
