//! What limits the steps of each method.

use super::{Linearised, StabilityFunction, spectral_radius};
use crate::integrate::algorithm::Algorithm;
use crate::integrate::complex::Complex;
use crate::integrate::tableau::{DORMAND_PRINCE, DORMAND_PRINCE_853, RUNGE_KUTTA_4, Tableau};
use crate::integrate::{DormandPrince, DormandPrince853, IntegrationError, RungeKutta4, SymplecticEuler};
use crate::{Real, Vector};

/// How much a step of the semi-implicit method may enlarge what does not grow by itself: eigenvalues that coincide, as
/// those of a free motion do, are known to less than roundoff.
const SLACK: f64 = 1e-4;

/// The largest stable step of a linearised equation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StabilityLimit<S> {
    /// The size, s; infinite if nothing limits it.
    pub step: S,
    /// Real and imaginary part of the eigenvalue that limits it, 1/s, if one does.
    pub eigenvalue: Option<(S, S)>,
}

/// A method whose steps of a linear equation can be told stable from unstable.
pub trait LinearStability: Algorithm {
    /// The largest stable step of a linearised equation.
    ///
    /// # Errors
    /// If the method cannot take steps of this equation, or if no eigenvalues are found.
    fn largest_step<S: Real, Y: Vector<S>>(
        equation: &Linearised<S, Y>,
    ) -> Result<StabilityLimit<S>, IntegrationError<S>>;
}

impl LinearStability for RungeKutta4 {
    fn largest_step<S: Real, Y: Vector<S>>(
        equation: &Linearised<S, Y>,
    ) -> Result<StabilityLimit<S>, IntegrationError<S>> {
        Ok(of_explicit(&RUNGE_KUTTA_4, equation))
    }
}

impl LinearStability for DormandPrince {
    fn largest_step<S: Real, Y: Vector<S>>(
        equation: &Linearised<S, Y>,
    ) -> Result<StabilityLimit<S>, IntegrationError<S>> {
        Ok(of_explicit(&DORMAND_PRINCE, equation))
    }
}

impl LinearStability for DormandPrince853 {
    fn largest_step<S: Real, Y: Vector<S>>(
        equation: &Linearised<S, Y>,
    ) -> Result<StabilityLimit<S>, IntegrationError<S>> {
        Ok(of_explicit(&DORMAND_PRINCE_853, equation))
    }
}

fn of_explicit<S: Real, Y: Vector<S>, const STAGES: usize>(
    tableau: &Tableau<STAGES>,
    equation: &Linearised<S, Y>,
) -> StabilityLimit<S> {
    let function = StabilityFunction::new(tableau);
    let unlimited = StabilityLimit { step: S::from_f64(f64::INFINITY), eigenvalue: None };
    equation.damped().fold(unlimited, |limit, (re, im)| {
        let reach = S::from_f64(function.reach((re.to_f64(), im.to_f64())));
        if reach < limit.step { StabilityLimit { step: reach, eigenvalue: Some((re, im)) } } else { limit }
    })
}

/// The stability of this method is that of v_new = v + h (K q + D v), q_new = q + h (G q + N v_new), and no function of
/// h λ: the largest step follows from the eigenvalues of that map, by bisection.
impl LinearStability for SymplecticEuler {
    fn largest_step<S: Real, Y: Vector<S>>(
        equation: &Linearised<S, Y>,
    ) -> Result<StabilityLimit<S>, IntegrationError<S>> {
        let (coordinates, len) = (equation.coordinates, equation.rows.as_ref().len());
        if coordinates == 0 {
            return Err(IntegrationError::NoCoordinates);
        }
        let unit = |i: usize, j: usize| if i == j { S::one() } else { S::zero() };
        let growth = equation.growth();
        let stable = |h: S| {
            let explicit = |i: usize, j: usize| unit(i, j) + h * equation.element(i, j);
            let radius = spectral_radius::<S, Y>(len, |i, j| {
                if i >= coordinates {
                    return explicit(i, j);
                }
                let own = if j < coordinates { equation.element(i, j) } else { S::zero() };
                (coordinates..len)
                    .fold(unit(i, j) + h * own, |sum, k| sum + h * equation.element(i, k) * explicit(k, j))
            });
            // What grows as e^(α t) may grow somewhat faster in steps of order 1; what is not stable soon outgrows
            // that.
            let grown = S::from_f64(core::f64::consts::E).powf(S::from_f64(2.0) * h * growth);
            radius.is_some_and(|radius| radius <= grown * S::from_f64(1.0 + SLACK))
        };
        let fastest = equation.damped().fold((S::zero(), S::zero()), |fastest, value| {
            if magnitude(value) > magnitude(fastest) { value } else { fastest }
        });
        let two = S::from_f64(2.0);
        let unlimited = StabilityLimit { step: S::from_f64(f64::INFINITY), eigenvalue: None };
        let rate = magnitude(fastest);
        let mut inside = S::from_f64(1e-2) / rate;
        if rate == S::zero() || !inside.is_finite() {
            return Ok(unlimited);
        }
        let Some(_) = (0..20).find(|_| {
            let next = stable(two * inside);
            if next {
                inside = two * inside;
            }
            !next
        }) else {
            return Ok(unlimited);
        };
        let mut outside = two * inside;
        for _ in 0..20 {
            let middle = (inside + outside) / two;
            *if stable(middle) { &mut inside } else { &mut outside } = middle;
        }
        Ok(StabilityLimit { step: inside, eigenvalue: Some(fastest) })
    }
}

fn magnitude<S: Real>((re, im): (S, S)) -> S {
    Complex { re, im }.abs()
}
