//! The Jacobian of the right-hand side.

use crate::integrate::integration::{Integration, zeros};
use crate::integrate::{IntegrationError, Ode};
use crate::vector::entry;
use crate::{Real, Vector};

/// Evaluates ∂f/∂y at the state that is reached, where the derivative is `rate`, by rows: from the tangents of the
/// equation, or from forward differences where it does not define them. `y_new` of the progress is used up.
///
/// # Errors
/// If an element is infinite or not a number.
pub fn jacobian<S: Real, Y: Vector<S>, O: Ode<S, Y> + ?Sized>(
    integration: &mut Integration<'_, S, Y, O>,
    rate: &Y,
    rows: &mut Y::Of<Y>,
) -> Result<(), IntegrationError<S>> {
    integration.progress.statistics.jacobians += 1;
    let t = integration.progress.t;
    let mut direction = zeros(rate);
    let mut column = zeros(rate);
    let mut has_tangent = true;
    for j in 0..rate.as_ref().len() {
        if has_tangent {
            set(&mut direction, j, S::one());
            has_tangent = integration.ode.tangent(t, &integration.progress.y, &direction, &mut column);
            set(&mut direction, j, S::zero());
        }
        if !has_tangent {
            difference(integration, rate, j, &mut column)?;
        }
        for (component, row) in rows.as_mut().iter_mut().enumerate() {
            let element = entry(&column, component);
            if !element.is_finite() {
                return Err(IntegrationError::NonFiniteDerivative { t, component });
            }
            set(row, j, element);
        }
    }
    Ok(())
}

/// Column `j` by a difference over √ε of the component, or of what the tolerances say is small.
fn difference<S: Real, Y: Vector<S>, O: Ode<S, Y> + ?Sized>(
    integration: &mut Integration<'_, S, Y, O>,
    rate: &Y,
    j: usize,
    column: &mut Y,
) -> Result<(), IntegrationError<S>> {
    let Integration { progress, tolerances, .. } = &mut *integration;
    progress.y_new.clone_from(&progress.y);
    let Some(&old) = progress.y.as_ref().get(j) else { return Ok(()) };
    let step = S::EPSILON.sqrt() * old.abs().maximum(tolerances.threshold(j));
    let new = old + if old < S::zero() { -step } else { step };
    set(&mut progress.y_new, j, new);
    integration.evaluate(integration.progress.t, column)?;
    for (element, &rate) in column.as_mut().iter_mut().zip(rate.as_ref()) {
        // The difference that was taken, not the one that was meant.
        *element = (*element - rate) / (new - old);
    }
    Ok(())
}

fn set<S, Y: AsMut<[S]>>(vector: &mut Y, index: usize, value: S) {
    if let Some(element) = vector.as_mut().get_mut(index) {
        *element = value;
    }
}
