//! Steps of the numerical differentiation formulas: their error, size and order.

use super::differences::{Differences, add};
use super::formulas::{DENSE, Formula, GAMMA};
use super::newton::{Equation, Newton};
use crate::integrate::implicit::jacobian::jacobian;
use crate::integrate::method::{Stepper, root};
use crate::integrate::progress::{Progress, zeros};
use crate::integrate::step::weighted_sum;
use crate::integrate::{IntegrationError, Ode, Step, Tolerances};
use crate::{Real, Vector};

/// The factor to a step size for which the iteration did not converge.
const SHRINKAGE_WITHOUT_CONVERGENCE: f64 = 0.3;
/// The smallest factor after the first failure of a step.
const SMALLEST_SHRINKAGE: f64 = 0.1;
/// The factor after further ones, which say that the estimate cannot be trusted.
const SHRINKAGE_WITHOUT_TRUST: f64 = 0.5;
/// The largest factor between the sizes of two steps.
const LARGEST_GROWTH: f64 = 10.0;
/// How many times smaller than the estimated error allows a step of the same order is made, one of the order below, and
/// one of the order above, whose estimates are less certain.
const SAFETY: [f64; 3] = [1.2, 1.3, 1.4];
/// A first step aims at an error of 0.8² of the tolerance.
const SAFETY_OF_START: f64 = 0.8;

/// The largest correction of a state with which the past is kept, in units of the error that a step is allowed. A
/// projection may move a state further than the step was wrong, and in components that were not.
const LARGEST_CORRECTION: f64 = 10.0;
/// The largest change of h f by a larger correction with which the past is kept, in the same unit: what the iteration
/// leaves open changes h f by that much.
const LARGEST_CHANGE_OF_SLOPE: f64 = 2.0;
/// The smallest factor by which a step grows after a correction that has taken the past away.
const WORTH_AN_EARLY_CHANGE: f64 = 2.0;

/// What is evaluated at the state that is reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Evaluated {
    Nothing,
    Derivative,
    Jacobian,
}

/// Takes steps of numerical differentiation formulas of variable order.
pub struct NdfStepper<S, Y: Vector<S>> {
    /// κ of each order there is.
    kappas: &'static [f64],
    progress: Progress<S, Y>,
    differences: Differences<S, Y>,
    newton: Newton<S, Y>,
    equation: Equation<S, Y>,
    evaluated: Evaluated,
    /// The derivative at the state, if it is evaluated.
    rate: Y,
    /// rtol max(|y_i|, |y_new,i|, atol_i / rtol), the error that the last step was allowed.
    allowed: Y,
    scratch: Y,
    /// rtol over the error that the attempted step would have had with the order below and with the order above; 0 if
    /// there is none.
    neighbours: [S; 2],
    /// Whether the correction of the last step has taken the past away.
    restarted: bool,
}

impl<S: Real, Y: Vector<S>> NdfStepper<S, Y> {
    /// Takes the start, evaluates the derivative there, and makes all room that the steps will need.
    ///
    /// # Errors
    /// If the state or its derivative is infinite or not a number.
    pub fn new(
        kappas: &'static [f64],
        ode: &mut (impl Ode<S, Y> + ?Sized),
        t: S,
        y: Y,
    ) -> Result<Self, IntegrationError<S>> {
        let zero = zeros(&y);
        let mut progress = Progress::new(t, y)?;
        let mut rate = zero.clone();
        progress.evaluate(ode, t, &mut rate)?;
        let [factor, matrix_factor] = [S::zero(); 2];
        Ok(Self {
            kappas,
            progress,
            differences: Differences::new(&rate),
            newton: Newton::new(&zero),
            equation: Equation { predicted: zero.clone(), known: zero.clone(), factor, matrix_factor },
            evaluated: Evaluated::Derivative,
            rate,
            allowed: zero.clone(),
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
    fn evaluate(&mut self, ode: &mut (impl Ode<S, Y> + ?Sized)) -> Result<(), IntegrationError<S>> {
        if self.evaluated < Evaluated::Derivative {
            self.progress.y_new.clone_from(&self.progress.y);
            self.progress.evaluate(ode, self.progress.t, &mut self.rate)?;
            self.evaluated = Evaluated::Derivative;
        }
        Ok(())
    }

    /// Evaluates the Jacobian at the state.
    fn linearise(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        tolerances: &Tolerances<'_, S>,
    ) -> Result<(), IntegrationError<S>> {
        self.evaluate(ode)?;
        let mut rows = self.newton.take_jacobian();
        jacobian(ode, &mut self.progress, &self.rate, tolerances, &mut rows)?;
        self.newton.set_jacobian(rows);
        self.evaluated = Evaluated::Jacobian;
        Ok(())
    }

    /// Sets up the equation for the end of the step.
    fn set_equation(&mut self) {
        let (differences, order) = (&self.differences, self.differences.order());
        let share =
            Formula::new(self.kappas, order).map_or(S::zero(), |formula| S::one() / S::from_f64(formula.leading));
        weighted_sum((0..order).map(|_| S::one()), differences.all(), &mut self.equation.predicted);
        let gammas = GAMMA.iter().take(order).map(|&gamma| S::from_f64(gamma) * share);
        weighted_sum(gammas, differences.all(), &mut self.equation.known);
        self.equation.factor = self.progress.step_size() * share;
        self.equation.matrix_factor = differences.size() * share;
    }

    /// Notes what error the tolerances allow between the ends of the attempted step.
    fn allow(&mut self, tolerances: &Tolerances<'_, S>) {
        let sizes = self.progress.y.as_ref().iter().zip(self.progress.y_new.as_ref());
        for (component, (allowed, (y, z))) in self.allowed.as_mut().iter_mut().zip(sizes).enumerate() {
            let size = y.abs().maximum(z.abs()).maximum(tolerances.threshold(component));
            *allowed = tolerances.relative() * size;
        }
    }

    /// The error of a step of `order` where ∇^{order + 1} is `difference`; `None` if there is no such order.
    fn error_of(&self, order: usize, difference: Option<&Y>, tolerances: &Tolerances<'_, S>) -> Option<S> {
        let formula = Formula::new(self.kappas, order)?;
        Some(S::from_f64(formula.error) * tolerances.norm(difference?, &self.progress.y, &self.progress.y_new))
    }

    /// The order among the first `candidates` of this one, the one below and the one above that allows the largest
    /// step, and the factor to its size, each `limited`, where the error is 1/`ratio` times the tolerance.
    fn best(&self, ratio: S, candidates: usize, limited: impl Fn(S) -> S) -> (usize, S) {
        let order = self.differences.order();
        let [lower, higher] = self.neighbours;
        let ratios = [(order, ratio), (order.saturating_sub(1), lower), (order + 1, higher)];
        let factors = ratios.iter().zip(SAFETY).take(candidates);
        factors.fold((order, S::zero()), |best, (&(order, ratio), safety)| {
            let factor = limited(ratio.powf(root(order as u32 + 1)) / S::from_f64(safety));
            if factor > best.1 { (order, factor) } else { best }
        })
    }

    /// Whether a correction of the state is of the size of errors of steps.
    fn is_correction_small(&self) -> bool {
        let Progress { y, y_new: old, increment, .. } = &self.progress;
        let ends = y.as_ref().iter().zip(old.as_ref().iter().zip(increment.as_ref()));
        let most = S::from_f64(LARGEST_CORRECTION);
        ends.zip(self.allowed.as_ref())
            .all(|((&y, (&old, &increment)), &allowed)| (y - (old + increment)).abs() <= most * allowed)
    }

    /// Whether h f at the corrected state is that at the end of the step, which by the formula of order k was
    /// Σ_{m=1}^k (1/m) ∇^m y_{n+1} − κ γ_k d.
    fn keeps_its_slope(&mut self) -> bool {
        let order = self.differences.order();
        let Some(formula) = Formula::new(self.kappas, order) else { return false };
        let shares = (1..=order).map(|m| S::one() / S::from_f64(m as f64));
        weighted_sum(shares, self.differences.all(), &mut self.scratch);
        let kappa_gamma = S::from_f64(formula.error - 1.0 / (order as f64 + 1.0));
        add(&mut self.scratch, -kappa_gamma, &self.newton.correction);
        let slopes = self.scratch.as_ref().iter().zip(self.rate.as_ref());
        let (size, most) = (self.differences.size(), S::from_f64(LARGEST_CHANGE_OF_SLOPE));
        slopes
            .zip(self.allowed.as_ref())
            .all(|((&slope, &rate), &allowed)| (size * rate - slope).abs() <= most * allowed)
    }
}

impl<S: Real, Y: Vector<S>> Stepper<S, Y> for NdfStepper<S, Y> {
    fn progress(&self) -> &Progress<S, Y> {
        &self.progress
    }

    fn progress_mut(&mut self) -> &mut Progress<S, Y> {
        &mut self.progress
    }

    fn rate(&self) -> &Y {
        &self.rate
    }

    /// The size with which the error ½ h² ÿ of a step of order 1 is 0.8² of the tolerance, with ÿ = ∂f/∂t + J f and
    /// ∂f/∂t from a difference.
    fn first_size(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        reach: S,
        tolerances: &Tolerances<'_, S>,
    ) -> Result<S, IntegrationError<S>> {
        self.linearise(ode, tolerances)?;
        let Progress { t, .. } = self.progress;
        let small = S::EPSILON.sqrt() * t.abs().maximum((t + reach).abs());
        let later = t + if small < reach.abs() { if reach < S::zero() { -small } else { small } } else { reach };
        self.progress.y_new.clone_from(&self.progress.y);
        self.progress.evaluate(ode, later, &mut self.scratch)?;
        let rows = self.newton.jacobian().map_or(&[][..], |rows| rows.as_ref());
        let ends = self.scratch.as_mut().iter_mut().zip(self.rate.as_ref());
        for ((second, &rate), row) in ends.zip(rows) {
            let products = row.as_ref().iter().zip(self.rate.as_ref());
            *second = products.fold((*second - rate) / (later - t), |sum, (&element, &rate)| sum + element * rate);
        }
        let second = tolerances.norm(&self.scratch, &self.progress.y, &self.progress.y);
        let two = S::one() + S::one();
        Ok(S::from_f64(SAFETY_OF_START) * (two * tolerances.relative() / second).sqrt())
    }

    fn attempt(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        t_new: S,
        tolerances: &Tolerances<'_, S>,
    ) -> Result<(), IntegrationError<S>> {
        self.progress.t_new = t_new;
        let Progress { t, .. } = self.progress;
        let step = self.progress.step_size();
        // Steps that are meant to be alike differ by the rounding errors of the times at both ends.
        self.differences.resize(step, (S::EPSILON + S::EPSILON) * t.abs().maximum(t_new.abs()));
        if self.newton.jacobian().is_none() {
            self.linearise(ode, tolerances)?;
        }
        self.set_equation();
        let mut converged = self.newton.solve(ode, &mut self.progress, &self.equation, tolerances)?;
        if !converged && self.evaluated < Evaluated::Jacobian {
            // A smaller step is no remedy for an old Jacobian.
            self.linearise(ode, tolerances)?;
            converged = self.newton.solve(ode, &mut self.progress, &self.equation, tolerances)?;
        }
        if !converged {
            return Err(IntegrationError::NotConverged { t, step });
        }
        self.differences.correct(&self.newton.correction);
        self.allow(tolerances);
        Ok(())
    }

    fn error(&mut self, tolerances: &Tolerances<'_, S>) -> S {
        let order = self.differences.order();
        // The error of the order below goes with ∇^k at the end of the step.
        if let Some(old) = self.differences.get(order) {
            self.scratch.clone_from(old);
            add(&mut self.scratch, S::one(), &self.newton.correction);
        }
        let lower = self.error_of(order.saturating_sub(1), Some(&self.scratch), tolerances);
        let higher = self.error_of(order + 1, self.differences.get(order + 2), tolerances);
        self.neighbours = [lower, higher].map(|error| error.map_or(S::zero(), |error| tolerances.relative() / error));
        self.error_of(order, self.differences.get(order + 1), tolerances).unwrap_or(S::from_f64(f64::INFINITY))
    }

    fn error_exponent(&self) -> u32 {
        self.differences.order() as u32 + 1
    }

    fn step(&self) -> Step<'_, S, Y> {
        let Progress { t, y, t_new, y_new, .. } = &self.progress;
        let dense = self.differences.order().checked_sub(1).and_then(|index| DENSE.get(index)).copied().unwrap_or(&[]);
        Step::new((*t, y), (*t_new, y_new), S::one(), self.differences.all(), dense)
    }

    fn accept(&mut self) {
        self.progress.accept();
        self.differences.advance();
        self.evaluated = Evaluated::Nothing;
    }

    fn renew(&mut self, ode: &mut (impl Ode<S, Y> + ?Sized)) -> Result<(), IntegrationError<S>> {
        let small = self.is_correction_small();
        // A small correction moves the whole past along: y_n changes and ∇^j y_n, j ≥ 1, stay. For the formula that is
        // an error like those of steps, and where it is of their order the method keeps its own: E. Eich, *Convergence
        // results for a coordinate projection method applied to mechanical systems with algebraic constraints*, SIAM J.
        // Numer. Anal. 30 (1993). The next correction d changes by at most about what was corrected, so that the
        // estimate of the error notices if that is too much. A larger one moves the past along, too, where the
        // derivative stays what it was: near a singular position of closed loops a projection moves velocities by
        // rounding errors over the distance from it, step after step, whatever their size. After any other the past is
        // that of another solution, and nothing but the derivative is left of it.
        self.restarted = false;
        if self.progress.take_correction() && !small {
            self.evaluate(ode)?;
            if !self.keeps_its_slope() {
                self.differences.restart(&self.rate);
                self.restarted = true;
            }
        }
        Ok(())
    }

    fn shrinkage(&mut self, ratio: S, failures: u32) -> S {
        if ratio == S::zero() {
            return S::from_f64(SHRINKAGE_WITHOUT_CONVERGENCE);
        }
        if failures > 0 {
            return S::from_f64(SHRINKAGE_WITHOUT_TRUST);
        }
        let (order, factor) = self.best(ratio, 2, |factor| factor.maximum(S::from_f64(SMALLEST_SHRINKAGE)));
        self.differences.set_order(order);
        factor.minimum(S::one())
    }

    fn growth(&mut self, ratio: S) -> S {
        let order = self.differences.order();
        let limited = |factor: S| factor.minimum(S::from_f64(LARGEST_GROWTH));
        // Only then are all differences that choose the order those of steps of one size.
        if self.differences.steps() < order + 2 {
            // Where corrections take the past away step after step, there never are so many, and steps would stay as
            // small as they once became.
            let (_, factor) = self.best(ratio, 1, limited);
            let grows = self.restarted && factor >= S::from_f64(WORTH_AN_EARLY_CHANGE);
            return if grows { factor } else { S::one() };
        }
        let (order, factor) = self.best(ratio, 3, limited);
        if factor > S::one() {
            self.differences.set_order(order);
            factor
        } else {
            S::one()
        }
    }
}
