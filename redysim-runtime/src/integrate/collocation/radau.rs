//! The method Radau IIA of order 5, for stiff equations.

use core::array::from_fn;
use core::mem::swap;

use super::extrapolate;
use super::newton::{LARGEST_TURN, Newton, Outcome};
use super::radau_tableau::{CHECKED_NODE, WITHIN, WITHIN_NODES};
pub use super::radau_tableau::{Eigenspace, RADAU_IIA_5, RadauTableau};
use crate::integrate::adaptive::Adaptive;
use crate::integrate::method::{EstimatesErrors, Method, Stepper, root, step_aside, usual_shrinkage};
use crate::integrate::progress::{Progress, zeros};
use crate::integrate::step::{Step, weighted_sum, without_constant};
use crate::integrate::tolerance::Tolerances;
use crate::integrate::{IntegrationError, Ode, Statistics};
use crate::{Real, Vector};

/// A new step aims at 0.9^6 of the tolerance, less where the iteration took many turns.
const SAFETY: f64 = 0.9;
const SMALLEST_GROWTH: f64 = 0.2;
const LARGEST_GROWTH: f64 = 8.0;
/// A step that could be a little longer keeps its size, and with it the decompositions.
const WORTH_A_CHANGE: f64 = 1.2;
/// The largest ratio of tolerance to error that a prediction believes in.
const LARGEST_RATIO: f64 = 1000.0;

/// The method Radau IIA of order 5 with 3 stages and steps chosen from tolerances: for stiff equations, whose fast
/// motion has died down or is damped, such as joints with stiff springs and dampers, contacts, or chemical reactions.
///
/// The method is L-stable: no step is too large for stability, only for accuracy (E. Hairer and G. Wanner, *Solving
/// Ordinary Differential Equations II*, 2nd ed., Springer (1996), section IV.8, the source of all that follows). The
/// stages are found by simplified Newton iteration, which takes the Jacobian ∂f/∂y from [`Ode::tangent`] or from
/// differences, keeps it as long as the iteration converges fast, and decomposes one real and one complex matrix of the
/// size of the state for each new step size or Jacobian. The start of the iteration and the sizes of the steps come
/// from the collocation polynomial and from the errors of the last two steps.
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
/// [asked times](crate::Integrator::solve) and [events](crate::Integrator::watch) are then each the end of a shorter
/// step, as accurate as the ends of steps.
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

impl EstimatesErrors for RadauIIA {}

impl Method for RadauIIA {
    type Stepper<S: Real, Y: Vector<S>> = Radau<S, Y>;

    fn start<S: Real, Y: Vector<S>>(
        ode: &mut (impl Ode<S, Y> + ?Sized),
        t: S,
        y: Y,
    ) -> Result<Self::Stepper<S, Y>, IntegrationError<S>> {
        Radau::new(ode, t, y)
    }
}

/// Takes the steps of [`Radau5`].
#[derive(Clone)]
pub struct Radau<S: Real, Y: Vector<S>> {
    progress: Progress<S, Y>,
    /// The derivative at the state.
    rate: Y,
    /// z_k: stage k of the attempted step is y + z_k.
    increments: [Y; 3],
    newton: Newton<S, Y>,
    estimate: Y,
    /// The attempted step.
    attempted: Taken<S>,
    /// The last accepted step.
    last: Option<Taken<S>>,
    /// Its z_k.
    last_increments: [Y; 3],
    /// The accepted step before it.
    before: Option<Taken<S>>,
    /// Whether the step was rejected before.
    rejected: bool,
    /// The factor to the size of a step for which the iteration failed.
    retreat: Option<S>,
    /// What [`WITHIN`] is multiplied by, once somebody looks within the attempted step: how far the solution is from
    /// the start at the [`WITHIN_NODES`] and at the end, and h times its derivatives there.
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

/// What the choice of the next step asks of a step.
#[derive(Clone, Copy)]
struct Taken<S> {
    size: S,
    /// Tolerance over error.
    ratio: S,
    /// Turns of the iteration.
    turns: u32,
}

impl<S: Real, Y: Vector<S>> Radau<S, Y> {
    /// Takes the start, evaluates the derivative there, and makes all room that the steps will need.
    ///
    /// # Errors
    /// If the state or its derivative is infinite or not a number.
    pub fn new(ode: &mut (impl Ode<S, Y> + ?Sized), t: S, y: Y) -> Result<Self, IntegrationError<S>> {
        let zero = zeros(&y);
        let mut this = Self {
            progress: Progress::new(t, y)?,
            rate: zero.clone(),
            increments: from_fn(|_| zero.clone()),
            last_increments: from_fn(|_| zero.clone()),
            newton: Newton::new(&zero),
            within: from_fn(|_| zero.clone()),
            interpolation: Interpolation::Absent,
            estimate: zero,
            attempted: Taken { size: S::zero(), ratio: S::zero(), turns: 0 },
            last: None,
            before: None,
            rejected: false,
            retreat: None,
        };
        this.progress.evaluate(ode, t, &mut this.rate)?;
        Ok(this)
    }

    /// Writes to the increments what is known before the iteration.
    fn predict(&mut self) {
        match &self.last {
            Some(last) => {
                let ratio = self.progress.step_size() / last.size;
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
    fn solve(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        tolerances: &Tolerances<'_, S>,
    ) -> Result<u32, IntegrationError<S>> {
        loop {
            let Self { progress, rate, increments, newton, .. } = self;
            newton.prepare(ode, progress, rate, tolerances)?;
            match newton.iterate(ode, progress, increments, tolerances)? {
                Outcome::Solved { turns } => return Ok(turns),
                Outcome::Failed { .. } if newton.outdate() => self.begin_at_the_state(),
                Outcome::Failed { retreat } => {
                    self.retreat = Some(retreat);
                    return Err(IntegrationError::NotConverged { t: progress.t, step: progress.step_size() });
                }
            }
        }
    }

    /// Takes a step of the part `node` of the attempted one from its start, and writes what it adds to the state and h
    /// times the derivative at its end; `false` if its stages are not found.
    fn shorter(
        &self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        node: f64,
        tolerances: &Tolerances<'_, S>,
        [increment, slope]: [&mut Y; 2],
    ) -> (Result<bool, IntegrationError<S>>, Statistics) {
        let mut aside = self.clone();
        aside.progress.t_new = self.progress.time_at(node);
        for (start, &c) in aside.increments.iter_mut().zip(&RADAU_IIA_5.nodes) {
            let theta = S::from_f64(node * c);
            let weights = RADAU_IIA_5.dense.iter().map(|p| without_constant(p, theta));
            weighted_sum(weights, &self.increments, start);
        }
        let outcome = match aside.solve(ode, tolerances) {
            Ok(_) => Ok(true),
            Err(IntegrationError::NotConverged { .. }) => Ok(false),
            Err(fault) => Err(fault),
        };
        let [.., end] = &aside.increments;
        increment.clone_from(end);
        slope_at_end(&aside.increments, node, slope);
        (outcome, aside.progress.statistics)
    }

    /// Estimates the error of the step whose end is `y_new`, from the derivative `rate` or, if there is none, at the
    /// state: the difference from an embedded formula of order 3, filtered so that it stays small where the equation is
    /// stiff.
    fn estimate(&mut self, rate: Option<&Y>) {
        let h = self.progress.step_size();
        weighted_sum(RADAU_IIA_5.error.iter().map(|&e| S::from_f64(e) / h), &self.increments, &mut self.estimate);
        for (estimate, &rate) in self.estimate.as_mut().iter_mut().zip(rate.unwrap_or(&self.rate).as_ref()) {
            *estimate += rate;
        }
        self.newton.filter(&mut self.estimate);
    }

    /// The estimate as the tolerances measure it, and made a quantity that goes with h⁶.
    fn measure(&self, tolerances: &Tolerances<'_, S>) -> S {
        let Progress { y, y_new, .. } = &self.progress;
        let error = S::from_f64(10.0) * tolerances.norm(&self.estimate, y, y_new);
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

impl<S: Real, Y: Vector<S>> Stepper<S, Y> for Radau<S, Y> {
    fn progress(&self) -> &Progress<S, Y> {
        &self.progress
    }

    fn progress_mut(&mut self) -> &mut Progress<S, Y> {
        &mut self.progress
    }

    fn rate(&self) -> &Y {
        &self.rate
    }

    fn attempt(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        t_new: S,
        tolerances: &Tolerances<'_, S>,
    ) -> Result<(), IntegrationError<S>> {
        self.progress.t_new = t_new;
        self.interpolation = Interpolation::Absent;
        self.predict();
        let turns = self.solve(ode, tolerances)?;
        let [.., end] = &self.increments;
        self.progress.advance_by(end);
        self.estimate(None);
        let first_or_again = self.last.is_none() || self.rejected;
        if first_or_again && self.measure(tolerances) > tolerances.relative() {
            // A fast transient makes the first estimate far too large; one from the derivative at y + e does not.
            let mut rate = zeros(&self.rate);
            self.progress.advance_by(&self.estimate);
            let evaluated = self.progress.evaluate(ode, self.progress.t, &mut rate).is_ok();
            let [.., end] = &self.increments;
            self.progress.advance_by(end);
            if evaluated {
                self.estimate(Some(&rate));
            }
        }
        let ratio = tolerances.relative() / self.measure(tolerances);
        self.attempted = Taken { size: self.progress.step_size(), ratio, turns };
        Ok(())
    }

    fn error(&mut self, tolerances: &Tolerances<'_, S>) -> S {
        self.measure(tolerances)
    }

    fn error_exponent(&self) -> u32 {
        6
    }

    /// Where the stages of a shorter step are not found, as about a jump of the derivative, the collocation polynomial
    /// remains.
    fn look_within(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        tolerances: &Tolerances<'_, S>,
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
            let (outcome, statistics) = self.shorter(ode, node, tolerances, values);
            self.progress.statistics = statistics;
            if !outcome? {
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
        let Progress { y, y_new, .. } = &self.progress;
        let accurate = tolerances.norm(&error, y, y_new) <= tolerances.relative();
        self.interpolation = if accurate { Interpolation::Accurate } else { Interpolation::Coarse };
        Ok(())
    }

    fn extension_suffices(&self) -> bool {
        self.interpolation == Interpolation::Accurate
    }

    fn state_at(
        &mut self,
        ode: &mut (impl Ode<S, Y> + ?Sized),
        t: S,
        tolerances: &Tolerances<'_, S>,
    ) -> Result<Option<Y>, IntegrationError<S>> {
        step_aside(self, ode, t, tolerances)
    }

    fn step(&self) -> Step<'_, S, Y> {
        let Progress { t, y, t_new, y_new, .. } = &self.progress;
        let (start, end) = ((*t, y), (*t_new, y_new));
        match self.interpolation {
            Interpolation::Absent => Step::new(start, end, S::one(), &self.increments, &RADAU_IIA_5.dense),
            _ => Step::new(start, end, S::one(), &self.within, &WITHIN),
        }
    }

    fn accept(&mut self) {
        self.progress.accept();
        self.newton.leave();
        swap(&mut self.increments, &mut self.last_increments);
        self.before = self.last.replace(self.attempted);
        self.rejected = false;
    }

    fn renew(&mut self, ode: &mut (impl Ode<S, Y> + ?Sized)) -> Result<(), IntegrationError<S>> {
        self.progress.take_correction();
        self.progress.y_new.clone_from(&self.progress.y);
        self.progress.evaluate(ode, self.progress.t, &mut self.rate)
    }

    fn shrinkage(&mut self, ratio: S, failures: u32) -> S {
        self.rejected = true;
        self.newton.outdate();
        self.retreat.take().unwrap_or_else(|| usual_shrinkage(ratio, failures, self.error_exponent()))
    }

    /// The smaller of what the error of this step says, and of what the errors of the last two predict if their change
    /// goes on (K. Gustafsson, *Control-theoretic techniques for stepsize selection in implicit Runge-Kutta methods*,
    /// ACM Trans. Math. Softw. 20 (1994)).
    fn growth(&mut self, ratio: S) -> S {
        let power = |ratio: S| ratio.powf(root(self.error_exponent()));
        let turns = S::from_f64(f64::from(2 * LARGEST_TURN + 1) / f64::from(2 * LARGEST_TURN + self.attempted.turns));
        let mut growth = S::from_f64(SAFETY) * turns.minimum(S::one()) * power(ratio);
        if let Some(before) = &self.before {
            let trend = power(ratio * (ratio / before.ratio.minimum(S::from_f64(LARGEST_RATIO))));
            growth = growth.minimum(S::from_f64(SAFETY) * (self.attempted.size / before.size) * trend);
        }
        let worth_a_change = growth < S::one() || growth > S::from_f64(WORTH_A_CHANGE);
        if self.newton.keeps_its_jacobian() && !worth_a_change {
            return S::one();
        }
        growth.maximum(S::from_f64(SMALLEST_GROWTH)).minimum(S::from_f64(LARGEST_GROWTH))
    }
}
