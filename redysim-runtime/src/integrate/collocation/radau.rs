//! The method Radau IIA of order 5, for stiff equations.

use core::array::from_fn;
use core::mem::swap;

use super::extrapolate;
use super::radau_tableau::{CHECKED_NODE, RADAU_IIA_5, WITHIN, WITHIN_NODES};
pub(in crate::integrate) use super::stage_solver::LARGEST_TURN;
use super::stage_solver::{Outcome, StageSolver};
use crate::integrate::adaptive::Adaptive;
use crate::integrate::algorithm::{Algorithm, Formula};
use crate::integrate::integration::{Integration, Progress, zeros};
use crate::integrate::step::{Step, weighted_sum, without_constant};
use crate::integrate::step_control::{EstimatesErrors, Predictive};
use crate::integrate::{IntegrationError, Ode};
use crate::{Real, Vector};

/// The estimated error, raised to the order of the error of the step, is proportional to this power of the step size.
const ERROR_EXPONENT: u32 = 6;

/// The method Radau IIA of order 5 with 3 stages and steps chosen from tolerances: for stiff equations, whose fast
/// motion has died down or is damped, such as joints with stiff springs and dampers, contacts, or chemical reactions.
///
/// The method is L-stable: no step is too large for stability, only for accuracy (E. Hairer and G. Wanner, *Solving
/// Ordinary Differential Equations II*, 2nd ed., Springer (1996), section IV.8, the source of all that follows). The
/// stages are found by simplified Newton iteration, which takes the Jacobian ∂f/∂y along the
/// [tangent space](Ode::project_onto_tangent) of the states from [`Ode::tangent`] or from differences, keeps it as long as
/// the iteration converges fast, and decomposes one real and one complex matrix of the size of the state for each new
/// step size or Jacobian. The start of the iteration and the sizes of the steps come from the collocation polynomial and
/// from the errors of the last two steps.
///
/// The estimate e of the error has order 3. As the solution has order 5, it is not e but (10 e)^(3/2), of the order of
/// the error of the step, that must meet the tolerance; where the equation is stiff, the error itself is the smaller.
/// Each step costs 3 evaluations for each turn of the iteration, of which there are 2 to 4, and one more.
///
/// The solution within a step that is observed there is the polynomial of degree 6 through the ends of two shorter
/// steps from its start, to a quarter and five eighths of it, and its own end, with the derivatives there. It does not
/// use the derivative at the start, which a fast transient may have made large. A third shorter step, to a twelfth,
/// compares it with the solution. Where the polynomial meets the tolerance, it is as accurate as the ends of steps, for
/// three or four times the work. Where it does not, because the equation is stiff and steps are long, its order is 3;
/// [times to save at](crate::Integrator::solve) and [events](crate::Integrator::solve_with_events) are then each the
/// end of a shorter step, as accurate as the ends of steps.
///
/// ```
/// use redysim_runtime::{Integrator, Radau5};
///
/// // ẏ = −10⁶ (y − cos t) − sin t from y(0) = 1 has the solution cos t, which ode45 would need 10⁶ steps for.
/// let mut stiff = |t: f64, y: &[f64; 1], dydt: &mut [f64; 1]| dydt[0] = -1e6 * (y[0] - t.cos()) - t.sin();
/// let end = Radau5::new().rtol(1e-8).atol(1e-8).integrate(&mut stiff, (0.0, 3.0), [1.0])?;
/// assert!((end.y[0] - 3.0_f64.cos()).abs() < 1e-8);
/// assert!(end.statistics.steps < 100);
/// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
/// ```
pub type Radau5<'a, S> = Adaptive<'a, S, RadauIIA>;

/// The method of [`RADAU_IIA_5`].
#[derive(Clone, Copy, Debug)]
pub enum RadauIIA {}

impl EstimatesErrors for RadauIIA {
    type Control<S: Real, Y: Vector<S>> = Predictive<S>;

    fn control<S: Real, Y: Vector<S>>() -> Predictive<S> {
        Predictive::new(ERROR_EXPONENT)
    }
}

impl Algorithm for RadauIIA {
    type Formula<S: Real, Y: Vector<S>> = Radau<S, Y>;

    fn start<S: Real, Y: Vector<S>, O: Ode<S, Y> + ?Sized>(
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<Self::Formula<S, Y>, IntegrationError<S>> {
        Radau::new(integration)
    }
}

/// Takes the steps of [`Radau5`].
#[derive(Clone)]
pub struct Radau<S: Real, Y: Vector<S>> {
    /// The derivative at the state.
    rate: Y,
    /// z_k: stage k of the attempted step is y + z_k.
    increments: [Y; 3],
    newton: StageSolver<S, Y>,
    estimate: Y,
    /// The size of the attempted step.
    size: S,
    /// Turns of its iteration.
    turns: u32,
    /// The size of the last accepted step.
    last_size: Option<S>,
    /// Its z_k.
    last_increments: [Y; 3],
    /// The factor to the size of a step for which the iteration failed.
    retreat: Option<S>,
    /// What [`WITHIN`] is multiplied by, once dense output is prepared: how far the solution is from the start at the
    /// [`WITHIN_NODES`] and at the end, and h times its derivatives there.
    within: [Y; 6],
    /// Whether that is known of the attempted step, and whether the polynomial through it meets the tolerance.
    interpolation: Interpolation,
}

/// The polynomial through the values and slopes within a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Interpolation {
    /// Not evaluated, or the stages of a shorter step were not found.
    Absent,
    /// Evaluated, and at [`CHECKED_NODE`] further from the solution than the tolerance: the equation is stiff.
    Coarse,
    /// Evaluated, and as accurate as the ends of steps.
    Accurate,
}

impl<S: Real, Y: Vector<S>> Radau<S, Y> {
    /// Evaluates the derivative at the start, and makes all room that the steps will need.
    ///
    /// # Errors
    /// If the derivative is infinite or not a number.
    pub fn new<O: Ode<S, Y> + ?Sized>(integration: &mut Integration<'_, S, Y, O>) -> Result<Self, IntegrationError<S>> {
        let zero = zeros(&integration.progress.y);
        let mut this = Self {
            rate: zero.clone(),
            increments: from_fn(|_| zero.clone()),
            last_increments: from_fn(|_| zero.clone()),
            newton: StageSolver::new(&zero),
            within: from_fn(|_| zero.clone()),
            interpolation: Interpolation::Absent,
            estimate: zero,
            size: S::zero(),
            turns: 0,
            last_size: None,
            retreat: None,
        };
        integration.evaluate(integration.progress.t, &mut this.rate)?;
        Ok(this)
    }

    /// Turns of the iteration of the attempted step.
    pub(in crate::integrate) fn turns(&self) -> u32 {
        self.turns
    }

    /// Whether the next step will use the Jacobian of this one.
    pub(in crate::integrate) fn keeps_its_jacobian(&self) -> bool {
        self.newton.keeps_its_jacobian()
    }

    /// The factor to the size of a step for which the iteration failed, once.
    pub(in crate::integrate) fn take_retreat(&mut self) -> Option<S> {
        self.retreat.take()
    }

    /// Writes to the increments what is known before the iteration.
    fn predict(&mut self) {
        match self.last_size {
            Some(last) => {
                let ratio = self.size / last;
                let shape = (&RADAU_IIA_5.dense, &RADAU_IIA_5.nodes);
                extrapolate(shape, ratio, S::one(), &self.last_increments, &mut self.increments);
            }
            None => self.begin_at_the_state(),
        }
    }

    fn begin_at_the_state(&mut self) {
        for z in &mut self.increments {
            z.as_mut().fill(S::zero());
        }
    }

    /// Solves for the stages from the increments at hand. Where the iteration fails with a Jacobian of an earlier
    /// state, it begins anew with that of this state.
    fn solve<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<(), IntegrationError<S>> {
        loop {
            let Self { rate, increments, newton, .. } = self;
            newton.prepare(integration, rate)?;
            match newton.iterate(integration, increments)? {
                Outcome::Solved { turns } => {
                    self.turns = turns;
                    return Ok(());
                }
                Outcome::Failed { .. } if newton.outdate() => self.begin_at_the_state(),
                Outcome::Failed { retreat } => {
                    self.retreat = Some(retreat);
                    let Progress { t, .. } = integration.progress;
                    return Err(IntegrationError::NotConverged { t, step: integration.progress.step_size() });
                }
            }
        }
    }

    /// Takes a step of the part `node` of the attempted one from its start, and writes what it adds to the state and h
    /// times the derivative at its end; `false` if its stages are not found.
    fn shorter<O: Ode<S, Y> + ?Sized>(
        &self,
        integration: &mut Integration<'_, S, Y, O>,
        node: f64,
        [increment, slope]: [&mut Y; 2],
    ) -> Result<bool, IntegrationError<S>> {
        let mut shorter = self.clone();
        for (start, &c) in shorter.increments.iter_mut().zip(&RADAU_IIA_5.nodes) {
            let theta = S::from_f64(node * c);
            let weights = RADAU_IIA_5.dense.iter().map(|p| without_constant(p, theta));
            weighted_sum(weights, &self.increments, start);
        }
        let outcome = integration.aside(|aside| {
            aside.progress.t_new = aside.progress.time_at(node);
            shorter.solve(aside)
        });
        let [.., end] = &shorter.increments;
        increment.clone_from(end);
        slope_at_end(&shorter.increments, node, slope);
        match outcome {
            Ok(()) => Ok(true),
            Err(IntegrationError::NotConverged { .. }) => Ok(false),
            Err(fault) => Err(fault),
        }
    }

    /// Estimates the error of the step whose end is `y_new`, from the derivative `rate`, or from that at the state if
    /// `rate` is `None`: the difference from an embedded formula of order 3, filtered so that it stays small where the
    /// equation is stiff.
    fn estimate(&mut self, rate: Option<&Y>) {
        let h = self.size;
        weighted_sum(RADAU_IIA_5.error.iter().map(|&e| S::from_f64(e) / h), &self.increments, &mut self.estimate);
        for (estimate, &rate) in self.estimate.as_mut().iter_mut().zip(rate.unwrap_or(&self.rate).as_ref()) {
            *estimate += rate;
        }
        self.newton.filter(&mut self.estimate);
    }

    /// The norm of the estimate, raised to a power that is proportional to h⁶.
    fn measure<O: Ode<S, Y> + ?Sized>(&self, integration: &Integration<'_, S, Y, O>) -> S {
        let error = S::from_f64(10.0) * integration.error_norm(&self.estimate);
        error * error.sqrt()
    }
}

/// Writes h times the derivative at the end of a step, which is the part `node` of h long, from its stages: the
/// derivative of the collocation polynomial satisfies the equation there, and unlike f(t, y) it does not multiply what
/// the iteration has left by the stiffness.
fn slope_at_end<S: Real, Y: Vector<S>>(increments: &[Y; 3], node: f64, slope: &mut Y) {
    let at_end = |p: &&[f64]| (1..).zip(p.iter()).fold(0.0, |sum, (power, c)| sum + f64::from(power) * c);
    weighted_sum(RADAU_IIA_5.dense.iter().map(|p| S::from_f64(at_end(p) / node)), increments, slope);
}

impl<S: Real, Y: Vector<S>> Formula<S, Y> for Radau<S, Y> {
    fn rate(&self) -> &Y {
        &self.rate
    }

    fn attempt<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<(), IntegrationError<S>> {
        self.size = integration.progress.step_size();
        self.interpolation = Interpolation::Absent;
        let again = integration.progress.rejections > 0;
        if again {
            self.newton.outdate();
        }
        self.predict();
        self.solve(integration)?;
        let [.., end] = &self.increments;
        integration.progress.advance_by(end);
        self.estimate(None);
        let first_or_again = self.last_size.is_none() || again;
        if first_or_again && self.measure(integration) > integration.tolerances.relative() {
            // A fast transient makes the first estimate far too large; one from the derivative at y + e does not.
            let mut rate = zeros(&self.rate);
            integration.progress.advance_by(&self.estimate);
            let evaluated = integration.evaluate(integration.progress.t, &mut rate).is_ok();
            let [.., end] = &self.increments;
            integration.progress.advance_by(end);
            if evaluated {
                self.estimate(Some(&rate));
            }
        }
        Ok(())
    }

    /// The estimate e has order 3; (10 e)^(3/2) has the order of the error of the step.
    fn error<O: Ode<S, Y> + ?Sized>(&mut self, integration: &Integration<'_, S, Y, O>) -> S {
        self.measure(integration)
    }

    /// Where the stages of a shorter step are not found, as about a jump of the derivative, the collocation polynomial
    /// remains.
    fn prepare_dense_output<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<(), IntegrationError<S>> {
        let mut within = self.within.clone();
        let [first, second, end, first_slope, second_slope, end_slope] = &mut within;
        let (mut checked, mut unused) = (zeros(end), zeros(end));
        let shorter_steps = [
            (WITHIN_NODES[0], [first, first_slope]),
            (WITHIN_NODES[1], [second, second_slope]),
            (CHECKED_NODE, [&mut checked, &mut unused]),
        ];
        for (node, values) in shorter_steps {
            if !self.shorter(integration, node, values)? {
                return Ok(());
            }
        }
        let [.., last] = &self.increments;
        end.clone_from(last);
        slope_at_end(&self.increments, 1.0, end_slope);
        self.within = within;

        let mut error = unused;
        let weights = WITHIN.iter().map(|p| without_constant(p, S::from_f64(CHECKED_NODE)));
        weighted_sum(weights, &self.within, &mut error);
        for (error, &value) in error.as_mut().iter_mut().zip(checked.as_ref()) {
            *error -= value;
        }
        let accurate = integration.error_norm(&error) <= integration.tolerances.relative();
        self.interpolation = if accurate { Interpolation::Accurate } else { Interpolation::Coarse };
        Ok(())
    }

    fn dense_output_suffices(&self) -> bool {
        self.interpolation == Interpolation::Accurate
    }

    fn aside(&self) -> Option<Self> {
        Some(self.clone())
    }

    fn step<'a>(&'a self, progress: &'a Progress<S, Y>) -> Step<'a, S, Y> {
        match self.interpolation {
            Interpolation::Absent => progress.step(S::one(), &self.increments, &RADAU_IIA_5.dense),
            _ => progress.step(S::one(), &self.within, &WITHIN),
        }
    }

    fn advance<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
        _corrected: bool,
    ) -> Result<(), IntegrationError<S>> {
        self.newton.leave();
        swap(&mut self.increments, &mut self.last_increments);
        self.last_size = Some(self.size);
        integration.evaluate_at_state(&mut self.rate)
    }
}
