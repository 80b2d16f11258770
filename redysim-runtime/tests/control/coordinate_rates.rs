//! Tangents of simulations whose coordinates' rates depend on the position: a pendulum whose hinge has cosine and sine
//! for coordinates.

use crate::mechanisms::GRAVITY;
use redysim_runtime::{
    Arguments, ConfigurationSpace, Dual, ForwardDynamics, ForwardSimulation, Integrator, LinkState, Mechanism, Ode,
    Radau5, Scalar, coordinate_rates_tangent, forward_dynamics_tangent,
};

/// A scalar with an arc tangent.
trait Angle: Scalar {
    fn atan2(self, x: Self) -> Self;
}

impl Angle for f64 {
    fn atan2(self, x: f64) -> f64 {
        f64::atan2(self, x)
    }
}

impl Angle for Dual<f64> {
    fn atan2(self, x: Self) -> Self {
        let slope = (x.value * self.slope - self.value * x.slope) / (x.value * x.value + self.value * self.value);
        Dual { value: self.value.atan2(x.value), slope }
    }
}

/// A pendulum of 0.5 m, q = [cos, sin] of its angle from straight down. `DUAL`: N(q) is differentiated by dual numbers,
/// not by differences.
///
/// N(q) = (−sin, cos) (3 − |q|²)/2, which on the circle is (−sin, cos), is not linear in q.
struct Pendulum<const DUAL: bool>;

const LENGTH: f64 = 0.5;

impl<const DUAL: bool> Mechanism for Pendulum<DUAL> {
    without_names!("pendulum", 2, 1);
}

/// The pendulum over `$scalar`, with the tangents that it has there.
macro_rules! pendulum {
    ($scalar:ty, $($rates_tangent:item $forward_tangent:item)?) => {
        impl<const DUAL: bool> ConfigurationSpace<$scalar> for Pendulum<DUAL> {
            type Coordinates = [$scalar; 2];
            type Velocities = [$scalar; 1];
            type State = [$scalar; 4];
            type Matrix = [[$scalar; 1]; 1];
            type Links = [LinkState<$scalar>; 1];

            fn coordinate_rates(&self, q: &[$scalar; 2], v: &[$scalar; 1]) -> [$scalar; 2] {
                let [c, s] = *q;
                let toward = (<$scalar>::from_f64(3.0) - c * c - s * s) * <$scalar>::from_f64(0.5) * v[0];
                [-(s * toward), c * toward]
            }
            $($rates_tangent)?
            fn integrate(&self, q: &[$scalar; 2], dv: &[$scalar; 1]) -> [$scalar; 2] {
                let (s, c) = Scalar::sin_cos(dv[0]);
                [q[0] * c - q[1] * s, q[1] * c + q[0] * s]
            }
            fn difference(&self, q0: &[$scalar; 2], q1: &[$scalar; 2]) -> [$scalar; 1] {
                [Angle::atan2(q0[0] * q1[1] - q0[1] * q1[0], q0[0] * q1[0] + q0[1] * q1[1])]
            }
            fn neutral(&self) -> [$scalar; 2] {
                [1.0, 0.0].map(<$scalar>::from_f64)
            }
        }

        impl<const DUAL: bool> ForwardDynamics<$scalar> for Pendulum<DUAL> {
            fn forward_dynamics(&self, q: &[$scalar; 2], _: &[$scalar; 1], tau: &[$scalar; 1]) -> [$scalar; 1] {
                let sin = q[1] / Scalar::sqrt(q[0] * q[0] + q[1] * q[1]);
                let of_tau = tau[0] * <$scalar>::from_f64(1.0 / (LENGTH * LENGTH));
                [of_tau - sin * <$scalar>::from_f64(GRAVITY / LENGTH)]
            }
            $($forward_tangent)?
        }
    };
}

pendulum! { Dual<f64>, }
pendulum! {
    f64,
    fn coordinate_rates_tangent(&self, q: &[f64; 2], v: &[f64; 1], dq: &[f64; 2]) -> Option<[f64; 2]> {
        DUAL.then(|| coordinate_rates_tangent(self, q, v, dq))
    }
    fn forward_dynamics_tangent(
        &self,
        at: Arguments<'_, f64, Self>,
        slopes: Arguments<'_, f64, Self>,
    ) -> Option<[f64; 1]> {
        Some(forward_dynamics_tangent(self, at, slopes))
    }
}

const DIRECTIONS: [[f64; 4]; 5] =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0], [0.4, -1.3, 2.0, 0.7]];

fn tangents_are_differences_of_the_derivative<const DUAL: bool>() {
    let law = |_: f64, q: &[f64; 2], v: &[f64; 1]| [2.0 * q[0] * q[1] - 0.3 * v[0]];
    let mut simulation = ForwardSimulation::new(&Pendulum::<DUAL>, law);
    for (angle, length, v) in [(0.4_f64, 1.0, -1.1), (2.9, 1.05, 3.0), (-1.6, 0.9, 0.0)] {
        let y = [length * angle.cos(), length * angle.sin(), v, 0.2];
        for direction in DIRECTIONS {
            let mut slope = [f64::NAN; 4];
            assert!(simulation.tangent(0.0, &y, &direction, &mut slope));
            let h = 1e-5;
            let mut derivative = |by: f64| {
                let mut rate = [f64::NAN; 4];
                simulation.derivative(0.0, &std::array::from_fn(|i| y[i] + by * direction[i]), &mut rate);
                rate
            };
            let (ahead, behind) = (derivative(h), derivative(-h));
            for i in 0..4 {
                // Truncation h²/6 of third derivatives below 200, rounding 1e-14/h.
                let difference = (ahead[i] - behind[i]) / (2.0 * h);
                assert!((slope[i] - difference).abs() < 1e-8, "{i} at {y:?} along {direction:?}: {slope:?}");
            }
        }
    }
}

#[test]
fn tangents_by_differences_are_differences_of_the_derivative() {
    tangents_are_differences_of_the_derivative::<false>();
}

#[test]
fn tangents_by_dual_numbers_are_differences_of_the_derivative() {
    tangents_are_differences_of_the_derivative::<true>();
}

/// ∂/∂q of (−s, c) v (3 − c² − s²)/2 along dq.
#[test]
fn the_derivative_of_the_rates_by_dual_numbers_is_the_formula() {
    let ([c, s], v, [dc, ds]) = ([0.8, -0.7], 1.3, [0.4, 2.1]);
    let (factor, dfactor) = ((3.0 - c * c - s * s) / 2.0, -(c * dc + s * ds));
    let exact = [-v * (ds * factor + s * dfactor), v * (dc * factor + c * dfactor)];
    let found: [f64; 2] = coordinate_rates_tangent(&Pendulum::<true>, &[c, s], &[v], &[dc, ds]);
    for (found, exact) in found.iter().zip(exact) {
        assert!((found - exact).abs() < 1e-15, "{found}, not {exact}");
    }
}

/// An implicit method has its Jacobian from tangents.
#[test]
fn an_implicit_method_swings_the_hinge_of_two_coordinates_as_that_of_one() {
    let reference = crate::mechanisms::Pendulum { mass: 1.0, length: LENGTH };
    let mut by_angle = ForwardSimulation::new(&reference, |_: f64, _: &[f64; 1], _: &[f64; 1]| [0.0]);
    let mut by_cosine = ForwardSimulation::new(&Pendulum::<false>, |_: f64, _: &[f64; 2], _: &[f64; 1]| [0.0]);
    let method = || Radau5::new().rtol(1e-10).atol(1e-12);
    let start = by_angle.state::<f64>(&[2.0], &[0.5]);
    let angle = method().integrate(&mut by_angle, (0.0, 1.0), start).unwrap();
    let start = by_cosine.state::<f64>(&[2.0_f64.cos(), 2.0_f64.sin()], &[0.5]);
    let cosine = method().integrate(&mut by_cosine, (0.0, 1.0), start).unwrap();
    let (s, c) = angle.y[0].sin_cos();
    // Some tens of steps of 1e-10 each, which the motion spreads.
    for (found, expected) in cosine.y.iter().zip([c, s, angle.y[1], 0.0]) {
        assert!((found - expected).abs() < 1e-8, "{:?}, not {expected}", cosine.y);
    }
}
