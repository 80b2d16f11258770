//! Whether steps are small for stability rather than for accuracy: then an explicit method reports a stiff equation.

use super::algorithm::Formula;
use super::integration::Integration;
use super::stability::Linearised;
use super::{IntegrationError, Ode};
use crate::{Real, Vector};

/// Steps between looks while nothing is suspected.
const INTERVAL: u64 = 100;
/// As many looks that find a step at the limit make it worth the price of eigenvalues.
const HITS: u32 = 15;
/// As many in a row that do not take the suspicion away.
const MISSES: u32 = 6;
/// Estimates at this part of the limit count: at the limit of stability, sizes vary about it.
const NEAR: f64 = 0.95;
/// The eigenvalues confirm the suspicion if the mean size reaches this part of the limit.
const CONFIRMED: f64 = 0.8;

/// Finds out whether stability limits the steps of an adaptive integration.
///
/// The estimate is that of E. Hairer and G. Wanner, *Solving Ordinary Differential Equations II*, 2nd ed., Springer
/// (1996), section IV.2: two stages at the end of a step differ by Δy in the state and Δf in the derivative, and |Δf| /
/// |Δy| tends to the largest eigenvalue where that is not resolved. It may also be large by chance, as where an
/// oscillation turns back, so that the eigenvalues of the Jacobian have the last word: only an equation whose motions
/// are damped at the limit of stability is stiff, however fast it swings.
///
/// Nothing is looked at while the rest of the interval takes fewer steps than the limit. After that six in a hundred
/// steps cost two sums over their stages, and the eigenvalues, if ever, one Jacobian.
pub(super) struct StiffnessTest<S> {
    /// The number of steps that are too many for the rest of the interval; none if `None`.
    limit: Option<u64>,
    wait: u64,
    hits: u32,
    misses: u32,
    /// The sizes of the steps that were hits, added up.
    sizes: S,
}

impl<S: Real> StiffnessTest<S> {
    pub fn new(limit: Option<u64>) -> Self {
        Self { limit, wait: INTERVAL, hits: 0, misses: 0, sizes: S::zero() }
    }

    /// Looks at an attempted step that is good, before it is accepted; `rest` is what is left of the interval after it.
    /// Returns the limit of stability when it is time for [`confirm`](Self::confirm).
    pub fn suspects<Y: Vector<S>, O: Ode<S, Y> + ?Sized>(
        &mut self,
        formula: &mut impl Formula<S, Y>,
        integration: &Integration<'_, S, Y, O>,
        rest: S,
    ) -> Option<S> {
        let size = integration.progress.step_size().abs();
        if rest.to_f64() <= self.limit? as f64 * size.to_f64() {
            return None;
        }
        self.wait = self.wait.saturating_sub(1);
        if self.wait > 0 {
            return None;
        }
        let Some(estimate) = formula.stability(integration) else {
            self.limit = None;
            return None;
        };
        if estimate.size > S::from_f64(NEAR) * estimate.limit {
            (self.misses, self.hits) = (0, self.hits + 1);
            self.sizes += size;
        } else {
            // Sizes about the limit of stability come in cycles: one look alone may always meet the small ones.
            self.misses += 1;
            if self.misses == MISSES {
                self.start_over(INTERVAL);
            }
        }
        (self.hits == HITS).then_some(estimate.limit)
    }

    /// Compares the steps with the limit of stability by the eigenvalues at the state that is reached, where the
    /// derivative is `rate`, with `rest` left of the interval.
    ///
    /// # Errors
    /// [`IntegrationError::Stiff`] if the equation is stiff. Where there are no eigenvalues, nothing is known.
    pub fn confirm<Y: Vector<S>, O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
        rate: &Y,
        stability_limit: S,
        rest: S,
    ) -> Result<(), IntegrationError<S>> {
        let step = self.sizes / S::from_f64(f64::from(HITS));
        // Where this was not it, the price is not to be paid again soon.
        self.start_over(10 * INTERVAL);
        let linearised = integration.aside(|aside| Linearised::<S, Y>::new(aside, rate));
        let Ok(linearised) = linearised else { return Ok(()) };
        let fastest = linearised.damped().fold(S::zero(), |fastest, (re, im)| {
            let size = (re * re + im * im).sqrt();
            // What swings more than it is damped is to be followed, not stepped over.
            if -re >= im { fastest.maximum(size) } else { fastest }
        });
        if step * fastest < S::from_f64(CONFIRMED) * stability_limit {
            return Ok(());
        }
        let remaining = libm::ceil(rest.to_f64() / step.to_f64()) as u64;
        Err(IntegrationError::Stiff { t: integration.progress.t, step, remaining })
    }

    fn start_over(&mut self, wait: u64) {
        (self.wait, self.hits, self.misses, self.sizes) = (wait, 0, 0, S::zero());
    }
}
