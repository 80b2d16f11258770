//! Friction at zero speed: Coulomb's law, made continuous.

use core::f64::consts::FRAC_2_PI;

use crate::Real;

/// The arctangent rule of ReDySim in one direction: −L atan(C v/L) with L = (2/π) μ |N|.
///
/// At small speeds it is the damper −C v, at large ones the force of Coulomb, μ |N|, which it never exceeds.
pub fn by_arctangent<S: Real>(coefficient: S, normal: S, damping: S, velocity: S) -> S {
    let limit = S::from_f64(FRAC_2_PI) * coefficient * normal.abs();
    if limit == S::zero() {
        return S::zero();
    }
    -(limit * S::from_f64(libm::atan((damping * velocity / limit).to_f64())))
}

/// Coulomb friction in the plane, −μ |N| v/√(|v|² + ε²): against the velocity, at most μ |N|, and −(μ |N|/ε) v at
/// speeds far below ε.
pub fn regularised<S: Real>(coefficient: S, normal: S, slip_velocity: S, [x, y]: [S; 2]) -> [S; 2] {
    let size = (x * x + y * y + slip_velocity * slip_velocity).sqrt();
    let factor = -(coefficient * normal.abs() / size);
    [factor * x, factor * y]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arctangent_is_a_damper_at_small_speeds_and_coulombs_force_at_large_ones() {
        let (mu, normal, damping) = (0.7, -30.0, 1500.0);
        let slow = 1e-6_f64;
        // The next term of the arctangent is a third of the square of C v/L, 1.3e-8.
        assert!((by_arctangent(mu, normal, damping, slow) / (-damping * slow) - 1.0).abs() < 1e-8);
        // It falls short of Coulomb's force by about (2/π) L/(C v) of it.
        assert!((by_arctangent(mu, normal, damping, 1e6) / (-mu * 30.0) - 1.0_f64).abs() < 1e-8);
        for velocity in [-2.0, -1e-3, 0.0, 1e-2, 1e300] {
            let force = by_arctangent(mu, normal, damping, velocity);
            assert!(force.abs() <= mu * 30.0 && force * velocity <= 0.0, "{velocity}: {force}");
        }
        assert_eq!(by_arctangent(mu, 0.0, damping, 1.0), 0.0);
        assert_eq!(by_arctangent(0.0, normal, damping, 1.0), 0.0);
    }

    #[test]
    fn regularised_friction_is_against_the_velocity_within_coulombs_cone() {
        let (mu, normal, slip) = (0.5, 20.0, 0.01);
        for [x, y] in [[0.0, 0.0], [3e-3, 4e-3], [0.3, -0.4], [3e4, 4e4]] {
            let [fx, fy] = regularised(mu, normal, slip, [x, y]);
            let (speed, size) = (f64::hypot(x, y), f64::hypot(fx, fy));
            assert!((size - mu * normal * speed / f64::hypot(speed, slip)).abs() < 1e-14, "{x} {y}");
            assert!(size <= mu * normal && (fx * y - fy * x).abs() < 1e-10 && fx * x + fy * y <= 0.0);
        }
        let [slow, _] = regularised(mu, normal, slip, [1e-8_f64, 0.0]);
        assert!((slow / (-mu * normal / slip * 1e-8) - 1.0).abs() < 1e-12);
    }
}
