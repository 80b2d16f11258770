//! Steps of the numerical differentiation formulas: their error, size and order.

use super::coefficients::{Coefficients, DENSE, GAMMA};
use super::correction_solver::{CorrectionSolver, Equation};
use super::differences::{Differences, add};
use crate::integrate::algorithm::Formula;
use crate::integrate::implicit::jacobian::jacobian;
use crate::integrate::integration::{Integration, Progress, zeros};
use crate::integrate::step::weighted_sum;
use crate::integrate::{IntegrationError, Ode, Step};
use crate::{Real, Vector};

/// The largest correction of a state with which the past is kept, in units of the error that a step is allowed. A
/// projection may move a state further than the step was wrong, and in components that were not.
const LARGEST_CORRECTION: f64 = 10.0;
/// The largest change of h f by a larger correction with which the past is kept, in the same unit: what the iteration
/// leaves open changes h f by that much.
const LARGEST_CHANGE_OF_SLOPE: f64 = 2.0;

/// What is evaluated at the state that is reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Evaluated {
    Nothing,
    Derivative,
    Jacobian,
}

/// Takes steps of numerical differentiation formulas of variable order.
pub struct NdfFormula<S, Y: Vector<S>> {
    /// κ of each order there is.
    kappas: &'static [f64],
    differences: Differences<S, Y>,
    newton: CorrectionSolver<S, Y>,
    equation: Equation<S, Y>,
    evaluated: Evaluated,
    /// The derivative at the state, if it is evaluated.
    rate: Y,
    /// The end of the last step before the equation corrected it.
    end: Y,
    scratch: Y,
    /// rtol over the error that the attempted step would have had with the order below and with the order above; zero
    /// for an order that does not exist.
    neighbours: [S; 2],
    /// Whether the differences were reset after the correction of the last step.
    restarted: bool,
}

impl<S: Real, Y: Vector<S>> NdfFormula<S, Y> {
    /// Evaluates the derivative at the start, and makes all room that the steps will need.
    ///
    /// # Errors
    /// If the derivative is infinite or not a number.
    pub fn new<O: Ode<S, Y> + ?Sized>(
        kappas: &'static [f64],
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<Self, IntegrationError<S>> {
        let zero = zeros(&integration.progress.y);
        let mut rate = zero.clone();
        integration.evaluate(integration.progress.t, &mut rate)?;
        let [factor, matrix_factor] = [S::zero(); 2];
        Ok(Self {
            kappas,
            differences: Differences::new(&rate),
            newton: CorrectionSolver::new(&zero),
            equation: Equation { predicted: zero.clone(), known: zero.clone(), factor, matrix_factor },
            evaluated: Evaluated::Derivative,
            rate,
            end: zero.clone(),
            scratch: zero,
            neighbours: [S::zero(); 2],
            restarted: false,
        })
    }

    /// Goes on from a past that is known.
    #[cfg(test)]
    pub fn set_past(&mut self, differences: Differences<S, Y>) {
        self.differences = differences;
    }

    /// Evaluates the derivative at the state, if it is not.
    fn evaluate<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<(), IntegrationError<S>> {
        if self.evaluated < Evaluated::Derivative {
            integration.evaluate_at_state(&mut self.rate)?;
            self.evaluated = Evaluated::Derivative;
        }
        Ok(())
    }

    /// Evaluates the Jacobian at the state.
    fn linearise<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<(), IntegrationError<S>> {
        self.evaluate(integration)?;
        let mut rows = self.newton.take_jacobian();
        jacobian(integration, &self.rate, &mut rows)?;
        self.newton.set_jacobian(rows);
        self.evaluated = Evaluated::Jacobian;
        Ok(())
    }

    /// Writes ÿ = ∂f/∂t + J f at the state to the scratch, with ∂f/∂t from a difference towards `reach`, and returns
    /// its size.
    pub(in crate::integrate) fn second_derivative<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
        reach: S,
    ) -> Result<S, IntegrationError<S>> {
        self.linearise(integration)?;
        let Progress { t, .. } = integration.progress;
        let small = S::EPSILON.sqrt() * t.abs().maximum((t + reach).abs());
        let later = t + if small < reach.abs() { if reach < S::zero() { -small } else { small } } else { reach };
        integration.progress.y_new.clone_from(&integration.progress.y);
        integration.evaluate(later, &mut self.scratch)?;
        let rows = self.newton.jacobian().map_or(&[][..], |rows| rows.as_ref());
        let ends = self.scratch.as_mut().iter_mut().zip(self.rate.as_ref());
        for ((second, &rate), row) in ends.zip(rows) {
            let products = row.as_ref().iter().zip(self.rate.as_ref());
            *second = products.fold((*second - rate) / (later - t), |sum, (&element, &rate)| sum + element * rate);
        }
        Ok(integration.norm_at_state(&self.scratch))
    }

    /// The backward differences of the past.
    pub(in crate::integrate) fn differences(&self) -> &Differences<S, Y> {
        &self.differences
    }

    /// Sets the order of the next step.
    pub(in crate::integrate) fn set_order(&mut self, order: usize) {
        self.differences.set_order(order);
    }

    /// The tolerance over the error that the attempted step would have had with the order below and with the order
    /// above; zero for an order that does not exist.
    pub(in crate::integrate) fn neighbours(&self) -> [S; 2] {
        self.neighbours
    }

    /// Whether the differences were reset after the correction of the last step.
    pub(in crate::integrate) fn restarted(&self) -> bool {
        self.restarted
    }

    /// Sets up the equation for the end of the step.
    fn set_equation(&mut self, step: S) {
        let (differences, order) = (&self.differences, self.differences.order());
        let share =
            Coefficients::new(self.kappas, order).map_or(S::zero(), |formula| S::one() / S::from_f64(formula.leading));
        weighted_sum((0..order).map(|_| S::one()), differences.all(), &mut self.equation.predicted);
        let gammas = GAMMA.iter().take(order).map(|&gamma| S::from_f64(gamma) * share);
        weighted_sum(gammas, differences.all(), &mut self.equation.known);
        self.equation.factor = step * share;
        self.equation.matrix_factor = differences.size() * share;
    }

    /// The error of a step of `order` where ∇^{order + 1} is `difference`; `None` if the method does not have that order.
    fn error_of<O: Ode<S, Y> + ?Sized>(
        &self,
        order: usize,
        difference: Option<&Y>,
        integration: &Integration<'_, S, Y, O>,
    ) -> Option<S> {
        let formula = Coefficients::new(self.kappas, order)?;
        Some(S::from_f64(formula.error) * integration.error_norm(difference?))
    }

    /// Whether the scratch, a difference of states at the end of the last step, is at most `most` errors that the
    /// tolerances allow.
    fn is_allowed<O: Ode<S, Y> + ?Sized>(&self, most: f64, integration: &Integration<'_, S, Y, O>) -> bool {
        let Integration { ode, tolerances, progress: Progress { y_new: old, .. } } = integration;
        ode.error_norm(tolerances, &self.scratch, old, &self.end) <= S::from_f64(most) * tolerances.relative()
    }

    /// Whether a correction of the state is of the size of errors of steps.
    fn is_correction_small<O: Ode<S, Y> + ?Sized>(&mut self, integration: &Integration<'_, S, Y, O>) -> bool {
        let Progress { y, y_new: old, increment, .. } = &integration.progress;
        self.end.clone_from(old);
        add(&mut self.end, S::one(), increment);
        self.scratch.clone_from(y);
        add(&mut self.scratch, -S::one(), &self.end);
        self.is_allowed(LARGEST_CORRECTION, integration)
    }

    /// Whether h f at the corrected state is that at the end of the step, which by the formula of order k was
    /// Σ_{m=1}^k (1/m) ∇^m y_{n+1} − κ γ_k d.
    fn keeps_its_slope<O: Ode<S, Y> + ?Sized>(&mut self, integration: &Integration<'_, S, Y, O>) -> bool {
        let order = self.differences.order();
        let Some(formula) = Coefficients::new(self.kappas, order) else { return false };
        let shares = (1..=order).map(|m| S::one() / S::from_f64(m as f64));
        weighted_sum(shares, self.differences.all(), &mut self.scratch);
        let kappa_gamma = S::from_f64(formula.error - 1.0 / (order as f64 + 1.0));
        add(&mut self.scratch, -kappa_gamma, &self.newton.correction);
        add(&mut self.scratch, -self.differences.size(), &self.rate);
        self.is_allowed(LARGEST_CHANGE_OF_SLOPE, integration)
    }
}

impl<S: Real, Y: Vector<S>> Formula<S, Y> for NdfFormula<S, Y> {
    fn rate(&self) -> &Y {
        &self.rate
    }

    fn attempt<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<(), IntegrationError<S>> {
        let Progress { t, t_new, .. } = integration.progress;
        let step = integration.progress.step_size();
        // Steps that are meant to be alike differ by the rounding errors of the times at both ends.
        self.differences.resize(step, (S::EPSILON + S::EPSILON) * t.abs().maximum(t_new.abs()));
        if self.newton.jacobian().is_none() {
            self.linearise(integration)?;
        }
        self.set_equation(step);
        let mut converged = self.newton.solve(integration, &self.equation)?;
        if !converged && self.evaluated < Evaluated::Jacobian {
            // A smaller step is no remedy for an old Jacobian.
            self.linearise(integration)?;
            converged = self.newton.solve(integration, &self.equation)?;
        }
        if !converged {
            return Err(IntegrationError::NotConverged { t, step });
        }
        self.differences.correct(&self.newton.correction);
        Ok(())
    }

    fn error<O: Ode<S, Y> + ?Sized>(&mut self, integration: &Integration<'_, S, Y, O>) -> S {
        let order = self.differences.order();
        // The error of the order below goes with ∇^k at the end of the step.
        if let Some(old) = self.differences.get(order) {
            self.scratch.clone_from(old);
            add(&mut self.scratch, S::one(), &self.newton.correction);
        }
        let error_of = |order, difference| self.error_of(order, difference, integration);
        let lower = error_of(order.saturating_sub(1), Some(&self.scratch));
        let higher = error_of(order + 1, self.differences.get(order + 2));
        let error = error_of(order, self.differences.get(order + 1)).unwrap_or(S::from_f64(f64::INFINITY));
        let rtol = integration.tolerances.relative();
        self.neighbours = [lower, higher].map(|error| error.map_or(S::zero(), |error| rtol / error));
        error
    }

    fn step<'a>(&'a self, progress: &'a Progress<S, Y>) -> Step<'a, S, Y> {
        let dense = self.differences.order().checked_sub(1).and_then(|index| DENSE.get(index)).copied().unwrap_or(&[]);
        progress.step(S::one(), self.differences.all(), dense)
    }

    fn advance<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
        corrected: bool,
    ) -> Result<(), IntegrationError<S>> {
        self.differences.advance();
        self.evaluated = Evaluated::Nothing;
        self.restarted = false;
        // A small correction moves the whole past along: y_n changes and ∇^j y_n, j ≥ 1, stay. For the formula that is
        // an error like those of steps, and where it is of their order the method keeps its own: E. Eich, *Convergence
        // results for a coordinate projection method applied to mechanical systems with algebraic constraints*, SIAM J.
        // Numer. Anal. 30 (1993). The next correction d changes by at most about what was corrected, so that the
        // estimate of the error notices if that is too much. A larger one moves the past along, too, where the
        // derivative stays what it was: near a singular position of closed loops a projection moves velocities by
        // rounding errors over the distance from it, step after step, whatever their size. After any other the past is
        // that of another solution, and nothing but the derivative is left of it.
        if corrected && !self.is_correction_small(integration) {
            self.evaluate(integration)?;
            if !self.keeps_its_slope(integration) {
                self.differences.restart(&self.rate);
                self.restarted = true;
            }
        }
        Ok(())
    }
}
