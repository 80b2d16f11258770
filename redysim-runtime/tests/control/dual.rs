//! Derivatives by dual numbers against formulas and against differences.

use crate::mechanisms::{GRAVITY, Pendulum};
use redysim_runtime::{Dual, ForwardSimulation, Ode, Pd, Scalar, TorqueLaw, ZeroTorque};

fn slope(f: impl Fn(Dual<f64>) -> Dual<f64>, x: f64) -> f64 {
    f(Dual { value: x, slope: 1.0 }).slope
}

#[test]
fn every_operation_has_its_derivative() {
    let c = Dual::from_f64(3.0);
    for x in [0.3, 1.7, -2.5] {
        let cases: [(f64, f64); 10] = [
            (slope(|x| x + c * x, x), 4.0),
            (slope(|x| c - x, x), -1.0),
            (slope(|x| -(x * x * x), x), -3.0 * x * x),
            (slope(|x| c / x, x), -3.0 / (x * x)),
            (slope(|x| x / (x * x + c), x), (3.0 - x * x) / (x * x + 3.0).powi(2)),
            (slope(|x| x.sin_cos().0, x), x.cos()),
            (slope(|x| x.sin_cos().1, x), -x.sin()),
            (slope(|x| Dual::sin_cos_all([x, x * x]).0[1], x), 2.0 * x * (x * x).cos()),
            (slope(|x| Dual::sin_cos_all([x, x * x]).1[1], x), -2.0 * x * (x * x).sin()),
            (slope(|x| (x * x + c).sqrt(), x), x / (x * x + 3.0).sqrt()),
        ];
        for (number, (found, exact)) in cases.into_iter().enumerate() {
            assert!(
                (found - exact).abs() <= 4e-16 * exact.abs().max(1.0),
                "case {number} at {x}: {found}, not {exact}"
            );
        }
        let mut sum = Dual { value: x, slope: 1.0 };
        sum += sum * sum;
        sum -= c;
        assert!((sum.slope - (1.0 + 2.0 * x)).abs() < 1e-15);
        let fused = Dual { value: x, slope: 1.0 }.mul_add(c, Dual { value: x, slope: 1.0 });
        assert!((fused.slope - 4.0).abs() < 1e-15);
    }
}

/// The pendulum's q̈ = τ/(m l²) − (g/l) sin q, and the power τ q̇.
#[test]
fn the_tangent_of_a_simulation_is_its_linearisation() {
    let pendulum = Pendulum { mass: 2.0, length: 0.5 };
    let law = Pd { target: [1.0], kp: [7.0], kd: [3.0] };
    let (q, v) = (0.4_f64, -1.1);
    let tau = 7.0 * (1.0 - q) - 3.0 * v;
    let expected = |dq: f64, dv: f64| {
        let dtau = -7.0 * dq - 3.0 * dv;
        [dv, dtau / 0.5 - GRAVITY / 0.5 * q.cos() * dq, dtau * v + tau * dv]
    };
    let by_law = |law: &mut dyn FnMut([f64; 3]) -> Option<[f64; 3]>, tolerance: f64| {
        for direction in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-0.3, 2.0, 5.0]] {
            let exact = expected(direction[0], direction[1]);
            let found = law(direction).expect("a pendulum has tangents");
            for (found, exact) in found.iter().zip(exact) {
                assert!((found - exact).abs() <= tolerance, "along {direction:?}: {found}, not {exact}");
            }
        }
    };
    let tangent = |simulation: &mut dyn Ode<f64, [f64; 3]>, direction: [f64; 3]| {
        let mut slope = [f64::NAN; 3];
        simulation.tangent(0.0, &[q, v, 0.2], &direction, &mut slope).then_some(slope)
    };
    let mut with_law = ForwardSimulation::new(&pendulum, law);
    by_law(&mut |direction| tangent(&mut with_law, direction), 1e-14);
    // A law that is only a function of f64 is differenced; the mechanism is not.
    let closure = |t: f64, q: &[f64; 1], v: &[f64; 1]| law.clone().torque(&pendulum, t, q, v);
    let mut with_closure = ForwardSimulation::new(&pendulum, closure);
    by_law(&mut |direction| tangent(&mut with_closure, direction), 1e-9);
}

#[test]
fn coordinates_come_first_and_their_rates_are_the_velocities() {
    let pendulum = Pendulum { mass: 2.0, length: 0.5 };
    let mut simulation = ForwardSimulation::new(&pendulum, ZeroTorque);
    let mut rates = [f64::NAN; 3];
    assert_eq!(simulation.coordinate_rates(0.0, &[0.1, 0.7, 0.0], &mut rates), 1);
    assert_eq!(rates[0], 0.7);
}
