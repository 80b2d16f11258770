//! The solution within a step of a Gauss method, nearly as accurate as its ends.
//!
//! The collocation polynomial has the order of the stages, s, where the ends of steps have 2 s. Each pass of
//! bootstrapping (W. H. Enright, K. R. Jackson, S. P. Nørsett and P. G. Thomsen, *Interpolants for Runge-Kutta
//! formulas*, ACM Trans. Math. Softw. 12 (1986)) evaluates the derivative on the polynomial at hand and integrates it,
//! which makes the error smaller by one power of h. Derivatives at four points within the step and at both ends and the
//! state at the end determine a polynomial of degree 7, so that it is the passes that limit the power: s + 1 after
//! none, s + 3 after two, which is 2 s for three stages and more than that for two.

use core::array::from_fn;

use crate::integrate::integration::{Integration, zeros};
use crate::integrate::step::{weighted_sum, without_constant};
use crate::integrate::{IntegrationError, Ode};
use crate::{Real, Vector};

/// τ: fractions of low height, for which the coefficients stay small.
const NODES: [f64; 4] = [1.0 / 6.0, 1.0 / 3.0, 2.0 / 3.0, 5.0 / 6.0];
const PASSES: u32 = 2;

/// The polynomials w_k of the dense output, by their coefficients of θ, θ² and so on.
///
/// It is y(t + θ h) = y + h (Σ w_k(θ) (g_k − m) + θ m), with the derivatives g_k at 0, τ and 1 and
/// their mean m = (y_new − y)/h: ẇ_k is 1 at the node of g_k and 0 at the others, and w_k is 0 at 0 and at 1.
pub const DENSE: [&[f64]; 7] = [
    &[1.0, -881.0 / 85.0, 17881.0 / 340.0, -2367.0 / 17.0, 66069.0 / 340.0, -23031.0 / 170.0, 3159.0 / 85.0],
    &[0.0, 36.0 / 17.0, 2556.0 / 85.0, -3096.0 / 17.0, 30348.0 / 85.0, -5076.0 / 17.0, 7776.0 / 85.0],
    &[0.0, -1665.0 / 68.0, 13077.0 / 68.0, -39033.0 / 68.0, 56187.0 / 68.0, -19629.0 / 34.0, 2673.0 / 17.0],
    &[0.0, -225.0 / 17.0, 7875.0 / 68.0, -6813.0 / 17.0, 45171.0 / 68.0, -17793.0 / 34.0, 2673.0 / 17.0],
    &[0.0, -1044.0 / 85.0, 8676.0 / 85.0, -5544.0 / 17.0, 41364.0 / 85.0, -29052.0 / 85.0, 7776.0 / 85.0],
    &[0.0, -239.0 / 68.0, 10231.0 / 340.0, -6867.0 / 68.0, 55053.0 / 340.0, -4239.0 / 34.0, 3159.0 / 85.0],
    &[1.0],
];

/// The derivatives that the polynomial is made of.
#[derive(Clone, Debug)]
pub struct Bootstrap<Y> {
    /// g_k − m, and m.
    slopes: [Y; 7],
    /// Whether they are those of the attempted step.
    ready: bool,
}

impl<Y> Bootstrap<Y> {
    /// Room for states as long as `zero`.
    pub fn new(zero: &Y) -> Self
    where
        Y: Clone,
    {
        Self { slopes: from_fn(|_| zero.clone()), ready: false }
    }

    /// What the polynomials [`DENSE`] are multiplied by, if that is known of the attempted step.
    pub fn slopes(&self) -> Option<&[Y]> {
        self.ready.then_some(&self.slopes)
    }

    /// Makes ready for another step.
    pub fn clear(&mut self) {
        self.ready = false;
    }

    /// Evaluates the derivatives within the attempted step, from the collocation polynomial y + h Σ p_k(θ) f_k, given
    /// by the coefficients of the p_k and the f_k.
    ///
    /// # Errors
    /// If a state or a derivative is infinite or not a number.
    pub fn build<S: Real, O: Ode<S, Y> + ?Sized>(
        &mut self,
        integration: &mut Integration<'_, S, Y, O>,
        (polynomials, rates): (&[&[f64]], &[Y]),
    ) -> Result<(), IntegrationError<S>>
    where
        Y: Vector<S>,
    {
        let progress = &mut integration.progress;
        let end = (progress.y_new.clone(), progress.increment.clone());
        let [start, within @ .., last, mean] = &mut self.slopes;
        let h = progress.step_size();
        for (mean, &increment) in mean.as_mut().iter_mut().zip(progress.increment.as_ref()) {
            *mean = increment / h;
        }
        integration.evaluate(integration.progress.t_new, last)?;
        subtract(last, mean);
        integration.evaluate_at_state(start)?;
        subtract(start, mean);
        for (slope, node) in within.iter_mut().zip(NODES) {
            evaluate_on(integration, (polynomials, rates), node, slope)?;
            subtract(slope, mean);
        }
        for _ in 1..PASSES {
            for (index, node) in (1..).zip(NODES) {
                let mut slope = zeros(&integration.progress.y);
                evaluate_on(integration, (&DENSE, &self.slopes), node, &mut slope)?;
                let [.., mean] = &self.slopes;
                subtract(&mut slope, mean);
                if let Some(old) = self.slopes.get_mut(index) {
                    *old = slope;
                }
            }
        }
        (integration.progress.y_new, integration.progress.increment) = end;
        self.ready = true;
        Ok(())
    }
}

/// Writes the derivative at y + h Σ p_k(`node`) `slopes`_k to `slope`.
fn evaluate_on<S: Real, Y: Vector<S>, O: Ode<S, Y> + ?Sized>(
    integration: &mut Integration<'_, S, Y, O>,
    (polynomials, slopes): (&[&[f64]], &[Y]),
    node: f64,
    slope: &mut Y,
) -> Result<(), IntegrationError<S>> {
    let weights = polynomials.iter().map(|polynomial| without_constant(polynomial, S::from_f64(node)));
    weighted_sum(weights, slopes, &mut integration.progress.increment);
    integration.progress.advance_by_increment();
    integration.evaluate(integration.progress.time_at(node), slope)
}

fn subtract<S: Real, Y: Vector<S>>(from: &mut Y, what: &Y) {
    for (value, &what) in from.as_mut().iter_mut().zip(what.as_ref()) {
        *value -= what;
    }
}

#[cfg(test)]
mod tests {
    use super::super::value_and_slope;
    use super::*;

    #[test]
    fn the_polynomials_have_their_slopes_at_the_nodes_and_end_at_zero() {
        let nodes = [0.0, NODES[0], NODES[1], NODES[2], NODES[3], 1.0];
        for (k, coefficients) in DENSE.iter().take(6).enumerate() {
            assert!(value_and_slope(coefficients, 1.0).0.abs() < 1e-12, "w_{k}(1)");
            for (j, node) in nodes.into_iter().enumerate() {
                let slope = value_and_slope(coefficients, node).1;
                assert!((slope - f64::from(u8::from(j == k))).abs() < 1e-11, "w_{k} has the slope {slope} at {node}");
            }
        }
        assert_eq!(DENSE[6], [1.0]);
    }
}
