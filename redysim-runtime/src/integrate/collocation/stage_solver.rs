//! Simplified Newton iteration for the stages of Radau IIA: *Solving Ordinary Differential Equations II*, section IV.8.
//!
//! The stages y + z_i solve z = h (a ⊗ I) F(z). With the Jacobian J of one state for all stages, Newton's correction
//! satisfies (h⁻¹ a⁻¹ ⊗ I − I ⊗ J) Δz = F(z) − h⁻¹ (a⁻¹ ⊗ I) z, 3n equations. A left eigenvector w of a⁻¹, with
//! eigenvalue λ, takes n of them out, (λ/h I − J) Δu = Σ w_i f_i − λ/h Σ w_i z_i, and Δz = Σ v Δu over the right
//! eigenvectors v, of which those of the complex eigenvalues are conjugate, so that one real and one complex system do.

use core::array::from_fn;

use super::radau_tableau::RADAU_IIA_5;
use crate::integrate::complex::Complex;
use crate::integrate::implicit::jacobian::jacobian;
use crate::integrate::implicit::lu::Lu;
use crate::integrate::integration::{Integration, zeros};
use crate::integrate::{IntegrationError, Ode};
use crate::vector::entry;
use crate::{Real, Vector};

/// The iteration takes at most so many turns.
pub(in crate::integrate) const LARGEST_TURN: u32 = 7;
/// What the iteration may leave, in units of the tolerance.
const REST: f64 = 0.03;
/// What it may leave at the least, in roundoff units.
const ROUNDOFF_UNITS: f64 = 10.0;
/// An iteration that contracts as fast needs no newer Jacobian.
const FAST: f64 = 1e-3;
/// Decompositions serve step sizes that differ by so much: it costs no more than that in the speed of convergence.
/// Sizes that are meant to be equal differ by the rounding of times.
const SAME_SIZE: f64 = 1e-4;

/// Vectors of complex numbers in place of `Y`.
type ComplexVector<S, Y> = <Y as Vector<S>>::Of<Complex<S>>;

/// The iteration, and what it keeps from step to step.
#[derive(Clone)]
pub(super) struct StageSolver<S: Real, Y: Vector<S>> {
    jacobian: Y::Of<Y>,
    age: Age,
    decomposed: Option<Decomposed<S, Y>>,
    /// θ, the factor by which the last turns have brought the correction down.
    contraction: S,
    /// The quotient of the last two corrections.
    quotient: S,
    /// θ/(1 − θ): what is left after a turn, in units of its correction.
    rest: S,
    rates: [Y; 3],
    real: Y,
    complex: ComplexVector<S, Y>,
    change: Y,
}

/// Which state a Jacobian belongs to.
#[derive(Clone, Copy, PartialEq)]
enum Age {
    /// The one that is reached.
    Current,
    /// An earlier one, but the iteration has converged fast with it.
    Earlier,
    /// It is to be evaluated again.
    Outdated,
}

/// λ/h I − J for both eigenvalues.
#[derive(Clone)]
struct Decomposed<S: Real, Y: Vector<S>> {
    step_size: S,
    real: Lu<S, Y>,
    complex: Lu<Complex<S>, ComplexVector<S, Y>>,
}

/// How an iteration ended.
pub(super) enum Outcome<S> {
    /// Well within the tolerances, after so many turns.
    Solved { turns: u32 },
    /// Not at all, or not in time; with a step smaller by `retreat` it should.
    Failed { retreat: S },
}

impl<S: Real, Y: Vector<S>> StageSolver<S, Y> {
    /// Room for states as long as `zero`, a vector of zeros.
    pub fn new(zero: &Y) -> Self {
        let len = zero.as_ref().len();
        let nothing = Complex { re: S::zero(), im: S::zero() };
        Self {
            jacobian: Y::Of::from_fn(len, |_| zero.clone()),
            age: Age::Outdated,
            decomposed: None,
            contraction: S::zero(),
            quotient: S::one(),
            rest: S::one(),
            rates: from_fn(|_| zeros(zero)),
            real: zero.clone(),
            complex: Y::Of::from_fn(len, |_| nothing),
            change: zero.clone(),
        }
    }

    /// Makes the Jacobian and the decompositions ready for the attempted step, if those at hand will not do.
    ///
    /// # Errors
    /// If a derivative is infinite or not a number, or a matrix is singular.
    pub fn prepare<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
        rate: &Y,
    ) -> Result<(), IntegrationError<S>> {
        if self.age == Age::Outdated {
            self.decomposed = None;
            jacobian(integration, rate, &mut self.jacobian)?;
            self.age = Age::Current;
        }
        let progress = &mut integration.progress;
        let h = progress.step_size();
        let serves = |d: &Decomposed<S, Y>| (d.step_size - h).abs() <= S::from_f64(SAME_SIZE) * h.abs();
        if !self.decomposed.as_ref().is_some_and(serves) {
            progress.statistics.decompositions += 2;
            self.decomposed = Decomposed::new(&self.jacobian, h);
        }
        match &self.decomposed {
            Some(_) => Ok(()),
            None => Err(IntegrationError::NotConverged { t: progress.t, step: h }),
        }
    }

    /// Moves `increments` to where they solve the equations.
    ///
    /// # Errors
    /// If a state or a derivative is infinite or not a number.
    pub fn iterate<O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
        increments: &mut [Y; 3],
    ) -> Result<Outcome<S>, IntegrationError<S>> {
        let rtol = integration.tolerances.relative();
        let allowed = (S::from_f64(REST) * rtol).maximum(S::from_f64(ROUNDOFF_UNITS) * S::EPSILON);
        // Before a second turn tells, the last iteration is trusted, though not entirely.
        self.rest = self.rest.maximum(S::EPSILON).powf(S::from_f64(0.8));
        self.contraction = S::zero();
        let mut last_size = None;
        for turn in 1..=LARGEST_TURN {
            for ((rate, z), &node) in self.rates.iter_mut().zip(&*increments).zip(&RADAU_IIA_5.nodes) {
                integration.progress.advance_by(z);
                integration.evaluate(integration.progress.time_at(node), rate)?;
            }
            let size = self.correct(integration, increments);
            if let Some(last_size) = last_size
                && let Some(retreat) = self.retreat(turn, size / last_size, size / allowed)
            {
                self.rest = S::one();
                return Ok(Outcome::Failed { retreat });
            }
            if self.rest * size <= allowed {
                return Ok(Outcome::Solved { turns: turn });
            }
            last_size = Some(size);
        }
        Ok(Outcome::Failed { retreat: S::from_f64(0.5) })
    }

    /// Learns from the quotient of the last two corrections. If the iteration will not be done in time, the factor to
    /// the step size with which it should; `size` is that of the last correction in units of what is allowed.
    fn retreat(&mut self, turn: u32, quotient: S, size: S) -> Option<S> {
        let theta = if turn == 2 { quotient } else { (quotient * self.quotient).sqrt() };
        self.quotient = quotient;
        // Not a number does not contract.
        let contracts = theta < S::from_f64(0.99);
        if !contracts {
            return Some(S::from_f64(0.5));
        }
        (self.contraction, self.rest) = (theta, theta / (S::one() - theta));
        let turns_left = S::from_f64(f64::from(LARGEST_TURN - turn));
        let excess = self.rest * size * theta.powf(turns_left);
        if excess <= S::one() {
            return None;
        }
        let power = -S::one() / (S::from_f64(4.0) + turns_left);
        Some(S::from_f64(0.8) * excess.minimum(S::from_f64(20.0)).powf(power))
    }

    /// Moves the increments by one correction, and returns its size as the tolerances measure it.
    fn correct<O: Ode<S, Y> + ?Sized>(&mut self, integration: &Integration<'_, S, Y, O>, increments: &mut [Y; 3]) -> S {
        let Self { rates, real, complex, change, .. } = self;
        let Some(decomposed) = &self.decomposed else { return S::from_f64(f64::INFINITY) };
        let (r, c) = (&RADAU_IIA_5.real, &RADAU_IIA_5.complex);
        // Of this step, whichever the decompositions are of: they decide how fast it converges, not where to.
        let scaled = |x: f64| S::from_f64(x) / integration.progress.step_size();
        let (lambda, re, im) = (scaled(r.value), scaled(c.value.re), scaled(c.value.im));
        for (i, (real, complex)) in real.as_mut().iter_mut().zip(complex.as_mut()).enumerate() {
            let sum = |weights: [f64; 3], vectors: &[Y; 3]| {
                weights.iter().zip(vectors).fold(S::zero(), |sum, (&w, y)| sum + S::from_f64(w) * entry(y, i))
            };
            let complex_sum =
                |vectors| Complex { re: sum(c.left.map(|w| w.re), vectors), im: sum(c.left.map(|w| w.im), vectors) };
            *real = sum(r.left, rates) - lambda * sum(r.left, increments);
            *complex = complex_sum(rates) - Complex { re, im } * complex_sum(increments);
        }
        decomposed.real.solve(real);
        decomposed.complex.solve(complex);
        let mut size = S::zero();
        for ((z, &v), &w) in increments.iter_mut().zip(&r.right).zip(&c.right) {
            // w Δu + its conjugate.
            let (v, re, im) = (S::from_f64(v), S::from_f64(2.0 * w.re), S::from_f64(2.0 * w.im));
            let parts = real.as_ref().iter().zip(complex.as_ref());
            for ((change, z), (&real, complex)) in change.as_mut().iter_mut().zip(z.as_mut()).zip(parts) {
                *change = v * real + (re * complex.re - im * complex.im);
                *z += *change;
            }
            size = size.maximum(integration.error_norm(change));
        }
        size
    }

    /// Replaces b by (λ/h I − J)⁻¹ b, λ the real eigenvalue.
    pub fn filter(&self, b: &mut Y) {
        if let Some(decomposed) = &self.decomposed {
            decomposed.real.solve(b);
        }
    }

    /// The state is another one now.
    pub fn leave(&mut self) {
        self.age = if self.keeps_its_jacobian() { Age::Earlier } else { Age::Outdated };
    }

    /// Whether the next step will use the Jacobian of this one.
    pub fn keeps_its_jacobian(&self) -> bool {
        self.contraction <= S::from_f64(FAST)
    }

    /// Has the Jacobian evaluated again, unless it is that of the state; tells whether it will.
    pub fn outdate(&mut self) -> bool {
        let earlier = self.age == Age::Earlier;
        if earlier {
            self.age = Age::Outdated;
        }
        earlier
    }
}

impl<S: Real, Y: Vector<S>> Decomposed<S, Y> {
    fn new(jacobian: &Y::Of<Y>, step_size: S) -> Option<Self> {
        let len = jacobian.as_ref().len();
        let (r, c) = (RADAU_IIA_5.real.value, RADAU_IIA_5.complex.value);
        let scaled = |x: f64| S::from_f64(x) / step_size;
        // Element (i, j) of `diagonal` I − J.
        let element = |i: usize, j: usize, diagonal: S| {
            let j_ij = jacobian.as_ref().get(i).map_or(S::zero(), |row| entry(row, j));
            if i == j { diagonal - j_ij } else { -j_ij }
        };
        let real = Y::Of::from_fn(len, |i| Y::from_fn(len, |j| element(i, j, scaled(r))));
        let complex = <ComplexVector<S, Y> as Vector<Complex<S>>>::Of::from_fn(len, |i| {
            Y::Of::from_fn(len, |j| Complex {
                re: element(i, j, scaled(c.re)),
                im: if i == j { scaled(c.im) } else { S::zero() },
            })
        });
        Some(Self { step_size, real: Lu::new(real)?, complex: Lu::new(complex)? })
    }
}
