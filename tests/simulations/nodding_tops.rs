//! A symmetric top that nods as it precesses, and a spherical pendulum, which is one without spin, in closed form.
//!
//! With the moments A across and C about the axis, the weight W = m g l, the spin n and the angular momentum L about the
//! vertical, u = cos θ obeys u'² = (1 − u²)(a − b u) − (c − d u)² with a = 2 E/A of the energy E without that of the spin,
//! b = 2 W/A, c = L/A and d = C n/A. Between its two lower roots, u = u₁ + (u₂ − u₁) sn² of the time; the angles of
//! precession and of spin are integrals of φ' = (c − d u)/(1 − u²) and ψ' = n − φ' u (Whittaker, *A Treatise on the
//! Analytical Dynamics of Particles and Rigid Bodies*, § 71).
#![cfg(feature = "generic")]

use super::free_bodies::{Top, rotation, turn};
use crate::common::elliptic::jacobi;
use crate::common::quadrature::integral;
use nalgebra::Matrix3;
use redysim::Real;
use redysim::{Dop8, ForwardSimulation, Integrator, ZeroTorque};

/// How a top starts, where it does not nod at that moment.
#[derive(Clone, Copy, Debug)]
struct Start {
    tilt: f64,
    precession: f64,
    spin: f64,
}

/// The motion from there.
struct ClosedForm {
    /// u₁, u₂ and the rate of the elliptic function's argument; k'.
    lower: f64,
    upper: f64,
    rate: f64,
    complement: f64,
    /// Whether it starts at u₂, its least tilt.
    falls: bool,
    spin: f64,
    momenta: [f64; 2],
}

impl ClosedForm {
    fn new(top: &Top, Start { tilt, precession, spin }: Start) -> Self {
        let (sin, start) = tilt.sin_cos();
        let d = top.about * spin / top.across;
        let c = precession * sin * sin + d * start;
        let b = 2.0 * top.weight / top.across;
        let a = (precession * sin).powi(2) + b * start;
        // One root is where it starts; the others have this sum and this product.
        let sum = (a + d * d) / b - start;
        let product = (2.0 * c * d - b) / b - start * sum;
        let third = 0.5 * (sum + (sum * sum - 4.0 * product).sqrt());
        let other = product / third;
        let [lower, upper] = if other < start { [other, start] } else { [start, other] };
        assert!(-1.0 < lower && lower < upper && upper < 1.0 && 1.0 < third, "{lower} {upper} {third}");
        ClosedForm {
            lower,
            upper,
            rate: (0.25 * b * (third - lower)).sqrt(),
            complement: ((third - upper) / (third - lower)).sqrt(),
            falls: other < start,
            spin,
            momenta: [c, d],
        }
    }

    /// cos θ.
    fn cosine(&self, t: f64) -> f64 {
        let [sn, cn, dn] = jacobi(self.rate * t, self.complement);
        // A quarter period later, sn is cn/dn.
        let sn = if self.falls { cn / dn } else { sn };
        self.lower + (self.upper - self.lower) * sn * sn
    }

    /// φ' and ψ'.
    fn rates(&self, t: f64) -> [f64; 2] {
        let (u, [c, d]) = (self.cosine(t), self.momenta);
        let precession = (c - d * u) / (1.0 - u * u);
        [precession, self.spin - precession * u]
    }

    /// The axes of the top after the precession φ and the turn ψ about its axis.
    fn attitude(&self, t: f64, [precession, own]: [f64; 2]) -> Matrix3<f64> {
        turn(2, precession) * turn(0, self.cosine(t).acos()) * turn(2, own)
    }
}

/// How long a motion is followed, s.
const END: f64 = if cfg!(debug_assertions) { 3.0 } else { 20.0 };

/// The largest error of the attitude, an element of a rotation, at all steps; how far the tilt goes, and
/// how often the top nods.
fn followed(start: Start) -> (f64, [f64; 2]) {
    let top = Top::new();
    let closed = ClosedForm::new(&top, start);
    let (sin, cos) = (0.5 * start.tilt).sin_cos();
    // Turning about the vertical has a part about the axis, which is within the spin.
    let v = [0.0, start.precession * start.tilt.sin(), start.spin];
    let mut simulation = ForwardSimulation::new(&top.body, ZeroTorque);
    let copy = simulation;
    let state = simulation.state(&[sin, 0.0, 0.0, cos], &v);
    let (mut turned, mut worst, mut tilts) = ([0.0; 2], 0.0_f64, [f64::INFINITY, 0.0_f64]);
    let on_step = |step: &redysim::Step<'_, f64, _>| {
        let ((from, _), (t, state)) = (step.start(), step.end());
        [0, 1].iter().for_each(|&i| turned[i] += integral(|t| closed.rates(t)[i], from, t));
        let now = copy.split(state);
        let found = rotation(&top.body.link_kinematics(&now.q, &now.v)[0]);
        worst = Real::maximum(worst, (found - closed.attitude(t, turned)).amax());
        let tilt = closed.cosine(t).acos();
        tilts = [tilts[0].min(tilt), tilts[1].max(tilt)];
    };
    // Of order 8, with steps so short that roundings are left.
    Dop8::new(2.0_f64.powi(-10)).each_step(&mut simulation, (0.0, END), state, on_step).expect("it moves to the end");
    println!(
        "{start:?}: attitude {worst:.1e}, precessed {:.1} rad, turned {:.1} rad, tilts {tilts:?}",
        turned[0], turned[1]
    );
    (worst, tilts)
}

/// Roundings of 20,000 steps: the angle of 1200 rad about the axis is right to some 1e-14 of it.
const TOLERANCE: f64 = 3e-11;

#[test]
fn a_heavy_top_nods_and_precesses_as_elliptic_functions_do() {
    // Let go without precession: with cusps; thrown back: with loops; thrown on: in waves that fall or that rise.
    for precession in [0.0, -2.0, 1.0, 12.0] {
        let (worst, tilts) = followed(Start { tilt: 0.6, precession, spin: 60.0 });
        assert!(tilts[1] - tilts[0] > 0.05, "it nods: {tilts:?}");
        assert!(worst <= TOLERANCE, "{worst:e}");
    }
}

/// Hanging, and thrown over the horizontal.
#[test]
fn a_spherical_pendulum_moves_as_elliptic_functions_do() {
    for (tilt, precession) in [(2.5, 6.0), (2.0, 3.0), (1.8, 9.0), (1.2, 8.0)] {
        let (worst, tilts) = followed(Start { tilt, precession, spin: 0.0 });
        assert!(tilts[1] - tilts[0] > 0.2, "it swings: {tilts:?}");
        assert!(worst <= TOLERANCE, "{worst:e}");
    }
}
