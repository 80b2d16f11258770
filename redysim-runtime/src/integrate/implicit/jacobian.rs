//! The Jacobian of the right-hand side.

use crate::integrate::integration::{Integration, zeros};
use crate::integrate::{IntegrationError, Ode};
use crate::linear_algebra::largest;
use crate::vector::entry;
use crate::{Real, Vector};

/// Evaluates (∂f/∂y) P at the state that is reached, where the derivative is `rate`, by rows, with the
/// [projection](Ode::project_onto_tangent) P onto the tangent space: from the tangents of the equation, or from forward
/// differences where it does not define them. `y_new` of the progress is used up.
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
        direction.as_mut().fill(S::zero());
        set(&mut direction, j, S::one());
        integration.ode.project_onto_tangent(&integration.progress.y, &mut direction);
        if has_tangent {
            has_tangent = integration.ode.tangent(t, &integration.progress.y, &direction, &mut column);
        }
        if !has_tangent {
            difference(integration, rate, &direction, &mut column)?;
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

/// The derivative along `direction` by a forward difference: where the direction is largest, the state changes by √ε of its
/// component, or of what the tolerances take as small.
fn difference<S: Real, Y: Vector<S>, O: Ode<S, Y> + ?Sized>(
    integration: &mut Integration<'_, S, Y, O>,
    rate: &Y,
    direction: &Y,
    slope: &mut Y,
) -> Result<(), IntegrationError<S>> {
    let (size, largest) = largest(direction.as_ref().iter().copied());
    if size == S::zero() {
        slope.as_mut().fill(S::zero());
        return Ok(());
    }
    let value = entry(direction, largest);
    let Integration { progress, tolerances, .. } = &mut *integration;
    progress.y_new.clone_from(&progress.y);
    let old = entry(&progress.y, largest);
    let step = S::EPSILON.sqrt() * old.abs().maximum(tolerances.threshold(largest));
    let step = if old < S::zero() { -step } else { step };
    for (new, &part) in progress.y_new.as_mut().iter_mut().zip(direction.as_ref()) {
        *new += step * (part / value);
    }
    let new = entry(&progress.y_new, largest);
    integration.evaluate(integration.progress.t, slope)?;
    for (element, &rate) in slope.as_mut().iter_mut().zip(rate.as_ref()) {
        // The difference that was taken, not the one that was meant.
        *element = (*element - rate) / (new - old) * value;
    }
    Ok(())
}

fn set<S, Y: AsMut<[S]>>(vector: &mut Y, index: usize, value: S) {
    if let Some(element) = vector.as_mut().get_mut(index) {
        *element = value;
    }
}
