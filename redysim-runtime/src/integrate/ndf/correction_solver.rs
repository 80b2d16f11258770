//! The simplified Newton iteration for the end of an implicit step.

use super::differences::add;
use crate::integrate::implicit::lu::Lu;
use crate::integrate::integration::{Integration, Progress, zeros};
use crate::integrate::{IntegrationError, Ode};
use crate::{Real, Vector};

/// The iteration does not go on beyond this: a smaller step or a new Jacobian costs less.
const MOST_ITERATIONS: i32 = 4;
/// The iteration stops when its error is estimated at this part of the tolerance …
const ACCURACY: f64 = 0.5;
/// … or at this part after the first change already, when the rate of convergence is that of steps before.
const ACCURACY_BY_OLD_RATE: f64 = 0.05;
/// Changes in relation to those before by which the iteration counts as not converging.
const SLOWEST_RATE: f64 = 0.9;
/// How much of an observed rate is still believed after a better one.
const MEMORY_OF_RATE: f64 = 0.9;
/// What roundoff leaves of a change, in roundoff units.
const ROUNDOFF_UNITS: f64 = 100.0;

/// d = c f(t_new, y + `predicted` + d) − `known`, an equation for d.
pub struct Equation<S, Y> {
    /// Σ_{m=1}^k ∇^m y.
    pub predicted: Y,
    /// Σ_{m=1}^k γ_m ∇^m y / ((1 − κ) γ_k).
    pub known: Y,
    /// c = h / ((1 − κ) γ_k).
    pub factor: S,
    /// c as far as the matrix needs it: without the rounding errors of times, so that it stays the same from step to
    /// step.
    pub matrix_factor: S,
}

/// Solves an [`Equation`] by d ← d + (I − c J)⁻¹ (c f(y + predicted + d) − known − d), with a Jacobian J and a
/// decomposed matrix of earlier steps as long as they do.
pub struct CorrectionSolver<S, Y: Vector<S>> {
    /// J; `None` before it was evaluated.
    jacobian: Option<Y::Of<Y>>,
    /// I − c J, and its c.
    matrix: Option<(Lu<S, Y>, S)>,
    /// How many times smaller changes become with this matrix.
    rate: Option<S>,
    change: Y,
    /// d.
    pub correction: Y,
}

impl<S: Real, Y: Vector<S>> CorrectionSolver<S, Y> {
    /// Room for vectors like `like`.
    pub fn new(like: &Y) -> Self {
        Self { jacobian: None, matrix: None, rate: None, change: zeros(like), correction: zeros(like) }
    }

    /// The Jacobian, if it has been evaluated.
    pub fn jacobian(&self) -> Option<&Y::Of<Y>> {
        self.jacobian.as_ref()
    }

    /// The memory of the Jacobian, for another one. The solver has no Jacobian until
    /// [`set_jacobian`](Self::set_jacobian).
    pub fn take_jacobian(&mut self) -> Y::Of<Y> {
        self.matrix = None;
        let (zero, len) = (&self.change, self.change.as_ref().len());
        self.jacobian.take().unwrap_or_else(|| Y::Of::<Y>::from_fn(len, |_| zero.clone()))
    }

    /// Sets the Jacobian.
    pub fn set_jacobian(&mut self, jacobian: Y::Of<Y>) {
        self.jacobian = Some(jacobian);
    }

    /// Iterates from d = 0 until the tolerances are met, and leaves y + predicted + d in `y_new` of the progress.
    /// `false` if it does not converge, or not soon enough.
    ///
    /// # Errors
    /// If the state or its derivative becomes infinite or not a number.
    pub fn solve<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
        equation: &Equation<S, Y>,
    ) -> Result<bool, IntegrationError<S>> {
        if self.matrix.as_ref().is_none_or(|(_, factor)| *factor != equation.matrix_factor) {
            self.decompose(&mut integration.progress, equation.matrix_factor);
        }
        let Some((matrix, _)) = &self.matrix else { return Ok(false) };
        let tolerances = integration.tolerances;
        let rtol = tolerances.relative();
        self.correction.as_mut().fill(S::zero());
        let progress = &mut integration.progress;
        move_to(progress, equation, &self.correction);
        let roundoff =
            S::from_f64(ROUNDOFF_UNITS) * S::EPSILON * tolerances.norm(&progress.y_new, &progress.y, &progress.y_new);
        let mut previous = None;
        for left in (0..MOST_ITERATIONS).rev() {
            integration.evaluate(integration.progress.t_new, &mut self.change)?;
            let parts = equation.known.as_ref().iter().zip(self.correction.as_ref());
            for (change, (&known, &d)) in self.change.as_mut().iter_mut().zip(parts) {
                *change = equation.factor * *change - known - d;
            }
            matrix.solve(&mut self.change);
            let size = integration.error_norm(&self.change);
            add(&mut self.correction, S::one(), &self.change);
            move_to(&mut integration.progress, equation, &self.correction);
            if size <= roundoff {
                return Ok(true);
            }
            // The changes to come are at most a geometric series.
            let rest = |rate: S| size * rate / (S::one() - rate);
            if let Some(previous) = previous {
                if size > S::from_f64(SLOWEST_RATE) * previous {
                    return Ok(false);
                }
                let observed = size / previous;
                let rate = self.rate.map_or(observed, |rate| observed.maximum(S::from_f64(MEMORY_OF_RATE) * rate));
                self.rate = Some(rate);
                let accuracy = S::from_f64(ACCURACY) * rtol;
                if rest(rate) <= accuracy {
                    return Ok(true);
                }
                if rest(rate) * rate.powf(S::from_f64(f64::from(left))) > accuracy {
                    return Ok(false);
                }
            } else if self.rate.is_some_and(|rate| rest(rate) <= S::from_f64(ACCURACY_BY_OLD_RATE) * rtol) {
                return Ok(true);
            }
            previous = Some(size);
        }
        Ok(false)
    }

    /// Decomposes I − c J; leaves no matrix if it is singular.
    fn decompose(&mut self, progress: &mut Progress<S, Y>, factor: S) {
        self.rate = None;
        self.matrix = None;
        let Some(mut rows) = self.jacobian.clone() else { return };
        for (i, row) in rows.as_mut().iter_mut().enumerate() {
            for (j, element) in row.as_mut().iter_mut().enumerate() {
                *element = if i == j { S::one() } else { S::zero() } - factor * *element;
            }
        }
        progress.statistics.decompositions += 1;
        self.matrix = Lu::new(rows).map(|lu| (lu, factor));
    }
}

/// Makes `y_new` the state y + predicted + d.
fn move_to<S: Real, Y: Vector<S>>(progress: &mut Progress<S, Y>, equation: &Equation<S, Y>, correction: &Y) {
    progress.increment.clone_from(&equation.predicted);
    add(&mut progress.increment, S::one(), correction);
    progress.add_increment();
}
