//! The methods of Gauss and Legendre, for motion that conserves.

use core::array::from_fn;

use super::bootstrap::{self, Bootstrap};
use super::extrapolate;
use crate::integrate::algorithm::{Algorithm, Formula};
use crate::integrate::fixed::FixedStep;
use crate::integrate::integration::{Integration, Progress, zeros};
use crate::integrate::step::{Step, weighted_sum};
use crate::integrate::tolerance::Tolerances;
use crate::integrate::{IntegrationError, Ode};
use crate::vector::entry;
use crate::{Real, Vector};

/// The iteration ends with an error if it has not converged by then: it would be contracting by less than 0.7.
const LARGEST_ITERATION: u32 = 100;
/// Turns without a change smaller than all before that say that the iteration stagnates. A single one says nothing: the
/// complex eigenvalues of the coefficients make changes rise and fall.
const IDLE_TURNS: u32 = 2;
/// Turns without a smaller change that say that it diverges, if changes are not of rounding size.
const HOPELESS_TURNS: u32 = 5;
/// An iteration that stagnates has converged if its last change is below so many roundoff units of the state.
const ROUNDOFF_UNITS: f64 = 1024.0;

/// The method of Gauss and Legendre with 2 stages, of order 4, with steps of one given size: for long conservative
/// motion that is not stiff.
///
/// It is symmetric, so that a step of −h undoes one of h, conserves quadratic invariants, and in canonical coordinates
/// is symplectic: the energy of an oscillation oscillates, but does not drift (E. Hairer, C. Lubich and G. Wanner,
/// *Geometric Numerical Integration*, 2nd ed., Springer (2006), sections II.1.3, IV.2 and IX). A state [q, q̇] is
/// canonical where the mass matrix is constant; elsewhere the motion forward and backward in time being alike keeps the
/// energy of regular motion from drifting.
///
/// The stages are iterated until they no longer change, two evaluations each time, and roundoff is kept from adding up
/// as E. Hairer, R. I. McLachlan and A. Razakarivony demand, *Achieving Brouwer's law with implicit Runge-Kutta
/// methods*, BIT 48 (2008), so that what remains of it is a random walk. The iteration contracts where h ‖∂f/∂y‖ is
/// below 2; where it does not, [`IntegrationError::NotConverged`] asks for smaller steps, or for
/// [`Radau5`](crate::Radau5). Between the ends of its steps the solution is a polynomial of degree 7, as accurate as
/// the ends; dense output costs ten evaluations a step.
///
/// ```
/// use redysim_runtime::{Gauss4, Integrator};
///
/// let mut oscillator = |_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| *dydt = [y[1], -y[0]];
/// let end = Gauss4::new(0.1).integrate(&mut oscillator, (0.0, 1000.0), [1.0, 0.0])?;
/// assert!((end.y[0].powi(2) + end.y[1].powi(2) - 1.0).abs() < 1e-14);
/// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
/// ```
pub type Gauss4<S> = FixedStep<S, GaussLegendre2>;

/// The method of Gauss and Legendre with 3 stages, of order 6, with steps of one given size: as [`Gauss4`], with three
/// evaluations for each iteration.
///
/// ```
/// use redysim_runtime::{Gauss6, Integrator};
///
/// let mut oscillator = |_t: f64, y: &[f64; 2], dydt: &mut [f64; 2]| *dydt = [y[1], -y[0]];
/// let end = Gauss6::new(0.05).integrate(&mut oscillator, (0.0, 10.0), [1.0, 0.0])?;
/// assert!((end.y[0] - 10.0_f64.cos()).abs() < 1e-11);
/// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
/// ```
pub type Gauss6<S> = FixedStep<S, GaussLegendre3>;

/// The method of [`GAUSS_LEGENDRE_2`].
#[derive(Clone, Copy, Debug)]
pub enum GaussLegendre2 {}

/// The method of [`GAUSS_LEGENDRE_3`].
#[derive(Clone, Copy, Debug)]
pub enum GaussLegendre3 {}

/// A method of Gauss and Legendre, in a form that keeps its geometry in spite of rounding.
///
/// A Runge-Kutta method is symplectic and conserves quadratic invariants if b_i a_ij + b_j a_ji = b_i b_j, that is, if
/// a_ij = b_j (1/2 + s_ij) with s_ij = −s_ji. Kept as b and s, that holds of the rounded coefficients, too: they belong
/// to a method whose order is only nearly that of the exact one, but which conserves exactly. With a itself rounded,
/// invariants would drift. (Hairer, McLachlan and Razakarivony split coefficients in two parts to the same end.)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GaussTableau<const STAGES: usize> {
    /// c, the times of the stages in units of the step.
    pub nodes: [f64; STAGES],
    /// b. The sum of the rounded weights is exactly 1.
    pub weights: [f64; STAGES],
    /// s.
    pub skew: [[f64; STAGES]; STAGES],
    /// The polynomials b_k of the collocation polynomial, u(t + θ h) = y + h Σ b_k(θ) f_k: coefficients of θ, θ², …
    pub dense: [&'static [f64]; STAGES],
}

const SQRT_3: f64 = 1.732_050_807_568_877_2;
const SQRT_15: f64 = 3.872_983_346_207_417;

/// The 2 stages of order 4: *Solving Ordinary Differential Equations I*, table II.7.3.
pub const GAUSS_LEGENDRE_2: GaussTableau<2> = GaussTableau {
    nodes: [0.5 - SQRT_3 / 6.0, 0.5 + SQRT_3 / 6.0],
    weights: [0.5, 0.5],
    skew: [[0.0, -SQRT_3 / 3.0], [SQRT_3 / 3.0, 0.0]],
    dense: [&[(SQRT_3 + 1.0) / 2.0, -SQRT_3 / 2.0], &[(1.0 - SQRT_3) / 2.0, SQRT_3 / 2.0]],
};

/// The 3 stages of order 6: *Solving Ordinary Differential Equations I*, table II.7.4.
pub const GAUSS_LEGENDRE_3: GaussTableau<3> = GaussTableau {
    nodes: [0.5 - SQRT_15 / 10.0, 0.5, 0.5 + SQRT_15 / 10.0],
    weights: [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0],
    skew: [
        [0.0, -3.0 * SQRT_15 / 20.0, -3.0 * SQRT_15 / 25.0],
        [3.0 * SQRT_15 / 20.0, 0.0, -3.0 * SQRT_15 / 20.0],
        [3.0 * SQRT_15 / 25.0, 3.0 * SQRT_15 / 20.0, 0.0],
    ],
    dense: [
        &[(5.0 + SQRT_15) / 6.0, -(10.0 + SQRT_15) / 6.0, 10.0 / 9.0],
        &[-2.0 / 3.0, 10.0 / 3.0, -20.0 / 9.0],
        &[(5.0 - SQRT_15) / 6.0, -(10.0 - SQRT_15) / 6.0, 10.0 / 9.0],
    ],
};

macro_rules! method {
    ($name:ident, $stages:literal, $tableau:ident) => {
        impl Algorithm for $name {
            type Formula<S: Real, Y: Vector<S>> = Gauss<S, Y, $stages>;

            fn start<S: Real, Y: Vector<S>, O: Ode<S, Y> + ?Sized>(
                integration: &mut Integration<'_, S, Y, O>,
            ) -> Result<Self::Formula<S, Y>, IntegrationError<S>> {
                Gauss::new(&$tableau, integration)
            }
        }
    };
}

method!(GaussLegendre2, 2, GAUSS_LEGENDRE_2);
method!(GaussLegendre3, 3, GAUSS_LEGENDRE_3);

/// Takes the steps of a method of Gauss and Legendre.
#[derive(Clone, Debug)]
pub struct Gauss<S, Y, const STAGES: usize> {
    tableau: &'static GaussTableau<STAGES>,
    /// The derivative at the start.
    rate: Y,
    /// f_i.
    rates: [Y; STAGES],
    /// z_i: stage i is evaluated at y + z_i.
    increments: [Y; STAGES],
    /// The size of the attempted step.
    size: S,
    /// The size of the step that the rates belong to, if they belong to one that was accepted.
    last_size: Option<S>,
    bootstrap: Bootstrap<Y>,
    scratch: Y,
}

impl<S: Real, Y: Vector<S>, const STAGES: usize> Gauss<S, Y, STAGES> {
    /// Evaluates the derivative at the start, and makes all room that the steps will need.
    ///
    /// # Errors
    /// If the derivative is infinite or not a number.
    pub fn new<O: Ode<S, Y> + ?Sized>(
        tableau: &'static GaussTableau<STAGES>,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<Self, IntegrationError<S>> {
        let zero = zeros(&integration.progress.y);
        let mut this = Self {
            tableau,
            rate: zero.clone(),
            rates: from_fn(|_| zero.clone()),
            increments: from_fn(|_| zero.clone()),
            size: S::zero(),
            last_size: None,
            bootstrap: Bootstrap::new(&zero),
            scratch: zero,
        };
        integration.evaluate(integration.progress.t, &mut this.rate)?;
        Ok(this)
    }

    /// Writes to the increments what is known before the first iteration.
    fn predict(&mut self) {
        let Self { tableau, increments, .. } = self;
        match self.last_size.take() {
            Some(last) => {
                extrapolate((&tableau.dense, &tableau.nodes), self.size / last, last, &self.rates, increments);
            }
            None => increments.iter_mut().for_each(|z| z.as_mut().fill(S::zero())),
        }
    }

    fn evaluate<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<(), IntegrationError<S>> {
        for ((rate, z), &node) in self.rates.iter_mut().zip(&self.increments).zip(&self.tableau.nodes) {
            integration.progress.advance_by(z);
            integration.evaluate(integration.progress.time_at(node), rate)?;
        }
        Ok(())
    }

    /// Moves the increments to h Σ a_ij f_j = Σ g_j / 2 + Σ s_ij g_j with g_j = h b_j f_j, and returns how far: as the
    /// tolerances measure it, and as a plain number.
    fn correct(&mut self, progress: &Progress<S, Y>, tolerances: &Tolerances<'_, S>) -> (S, S) {
        let Self { tableau, rates, increments, scratch, .. } = self;
        let h = progress.step_size();
        let half = S::from_f64(0.5);
        let (mut change, mut largest) = (S::zero(), S::zero());
        for (z, skew) in increments.iter_mut().zip(&tableau.skew) {
            for (j, (z, change)) in z.as_mut().iter_mut().zip(scratch.as_mut()).enumerate() {
                let (mut sum, mut skew_sum) = (S::zero(), S::zero());
                for ((rate, &weight), &skew) in rates.iter().zip(&tableau.weights).zip(skew) {
                    // The same rounded g_j for every stage: were it h a_ij f_j, rounding would not keep the symmetry.
                    let g = h * (S::from_f64(weight) * entry(rate, j));
                    sum += g;
                    skew_sum += S::from_f64(skew) * g;
                }
                let new = half * sum + skew_sum;
                *change = new - *z;
                *z = new;
                largest = largest.maximum(change.abs());
            }
            change = change.maximum(tolerances.norm(scratch, &progress.y, &progress.y_new));
        }
        (change, largest)
    }

    /// Iterates until the increments do not change any more but by roundoff. To stop at a tolerance, however small,
    /// would leave an error with a bias, which adds up.
    fn solve<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<(), IntegrationError<S>> {
        let mut smallest = S::from_f64(f64::INFINITY);
        let mut idle = 0;
        for _ in 0..LARGEST_ITERATION {
            self.evaluate(integration)?;
            let Integration { progress, tolerances, .. } = &*integration;
            let (change, largest) = self.correct(progress, tolerances);
            if change == S::zero() {
                return Ok(());
            }
            if change < smallest {
                (smallest, idle) = (change, 0);
                continue;
            }
            idle += 1;
            let state = progress.y.as_ref().iter().chain(progress.y_new.as_ref());
            let size = state.fold(S::zero(), |size, y| size.maximum(y.abs()));
            if idle >= IDLE_TURNS && largest <= S::from_f64(ROUNDOFF_UNITS) * S::EPSILON * size {
                return Ok(());
            }
            if idle >= HOPELESS_TURNS {
                break;
            }
        }
        Err(IntegrationError::NotConverged { t: integration.progress.t, step: integration.progress.step_size() })
    }
}

impl<S: Real, Y: Vector<S>, const STAGES: usize> Formula<S, Y> for Gauss<S, Y, STAGES> {
    fn rate(&self) -> &Y {
        &self.rate
    }

    fn attempt<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<(), IntegrationError<S>> {
        self.size = integration.progress.step_size();
        self.bootstrap.clear();
        self.predict();
        self.solve(integration)?;
        weighted_sum(self.tableau.weights.iter().map(|&b| S::from_f64(b)), &self.rates, &mut self.scratch);
        for value in self.scratch.as_mut() {
            *value = self.size * *value;
        }
        integration.progress.advance_by(&self.scratch);
        Ok(())
    }

    fn prepare_dense_output<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
    ) -> Result<(), IntegrationError<S>> {
        self.bootstrap.build(integration, (&self.tableau.dense, &self.rates))
    }

    fn aside(&self) -> Option<Self> {
        Some(self.clone())
    }

    fn step<'a>(&'a self, progress: &'a Progress<S, Y>) -> Step<'a, S, Y> {
        match self.bootstrap.slopes() {
            Some(slopes) => progress.step(self.size, slopes, &bootstrap::DENSE),
            None => progress.step(self.size, &self.rates, &self.tableau.dense),
        }
    }

    /// Only the start of the next iteration depends on the last step; the state before a correction is near enough.
    fn advance<O: Ode<S, Y> + ?Sized>(
        &mut self,
        _integration: &mut Integration<'_, S, Y, O>,
        _corrected: bool,
    ) -> Result<(), IntegrationError<S>> {
        self.last_size = Some(self.size);
        Ok(())
    }
}
