//! A body without a moment whose rotation is nearly all about its middle axis turns over again and again, as Jacobi's elliptic
//! functions do (Dzhanibekov's effect; Landau and Lifshitz, *Mechanics*, § 37): about a point that a spherical joint holds, and
//! about its centre of mass on a free joint.
#![cfg(feature = "generic")]

use super::free_bodies::{Body, rotation, tensor, turn};
use crate::common::elliptic::jacobi;
use crate::common::models::generic;
use crate::common::quadrature::integral;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};
use redysim::Real;
use redysim::generic::Link;
use redysim::{Dop8, ForwardSimulation, Integrator, Step, ZeroTorque, redysim};

redysim! {
    /// A body that moves freely.
    struct FreeBody(
        "models/parcel.toml",
        functions = [forward_dynamics, link_kinematics],
        parameters = ["gravity", "parcel.mass", "parcel.com", "parcel.inertia"]
    );
}

#[test]
fn the_elliptic_functions_are_those_of_the_tables() {
    // Circular functions for k = 0; k² = 1/2 in 30 digits, rounded.
    let [sn, cn, dn] = jacobi(0.7, 1.0);
    assert!((sn - 0.7_f64.sin()).abs() < 1e-15 && (cn - 0.7_f64.cos()).abs() < 1e-15 && dn == 1.0);
    let found = jacobi(1.0, 0.5_f64.sqrt());
    for (found, expected) in found.iter().zip(SN_CN_DN_OF_ONE) {
        assert!((found - expected).abs() < 1e-15, "{found} instead of {expected}");
    }
}

const SN_CN_DN_OF_ONE: [f64; 3] = [0.803_001_824_895_643_9, 0.595_976_567_672_140_7, 0.823_161_001_631_596_3];

/// An error of the start grows by 1/(1 − k²), fifty, until the body turns over.
const K_SQUARED: f64 = 0.98;
/// The rotation about the third axis where there is the most of it, rad/s.
const ABOUT_THIRD: f64 = 8.0;
/// The motion that is followed, s.
const DURATION: f64 = 20.0;

/// The solution of Euler's equations with moments I₁ < I₂ < I₃.
struct ClosedForm {
    tensor: Matrix3<f64>,
    moments: Vector3<f64>,
    /// The principal axes in those of the body, as columns.
    principal: Matrix3<f64>,
    /// The largest rotation about each of them, and the rate of the argument of the functions.
    largest: Vector3<f64>,
    rate: f64,
}

impl ClosedForm {
    fn new(tensor: Matrix3<f64>) -> Self {
        let eigen = tensor.symmetric_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| eigen.eigenvalues[i].total_cmp(&eigen.eigenvalues[j]));
        let [i1, i2, i3] = order.map(|i| eigen.eigenvalues[i]);
        let [e1, e2, _] = order.map(|i| eigen.eigenvectors.column(i).into_owned());
        let about_first = ABOUT_THIRD * (K_SQUARED * (i3 - i2) * i3 / ((i2 - i1) * i1)).sqrt();
        let about_second = about_first * (i1 * (i3 - i1) / (i2 * (i3 - i2))).sqrt();
        ClosedForm {
            tensor,
            moments: Vector3::new(i1, i2, i3),
            principal: Matrix3::from_columns(&[e1, e2, e1.cross(&e2)]),
            largest: Vector3::new(about_first, about_second, ABOUT_THIRD),
            rate: ABOUT_THIRD * ((i3 - i2) * (i3 - i1) / (i1 * i2)).sqrt(),
        }
    }

    /// The angular velocity in the principal axes.
    fn about_principal(&self, t: f64) -> Vector3<f64> {
        let [sn, cn, dn] = jacobi(self.rate * t, (1.0 - K_SQUARED).sqrt());
        self.largest.component_mul(&Vector3::new(cn, sn, dn))
    }

    /// The angular velocity in the axes of the body.
    fn angular_velocity(&self, t: f64) -> Vector3<f64> {
        self.principal * self.about_principal(t)
    }

    /// When sn is 0.999: near the middle axis.
    fn start(&self) -> f64 {
        let start = 3.2 / self.rate;
        let w = self.about_principal(start);
        assert!(w.y > 0.95 * w.norm(), "{w}");
        start
    }

    /// The principal axes in axes whose z is along the momentum, turned about it by `about`: angles of the sequence zxz, of
    /// which the last two are those of the momentum in the principal axes.
    fn in_momentum(&self, t: f64, about: f64) -> Matrix3<f64> {
        let [m1, m2, m3]: [f64; 3] = self.about_principal(t).component_mul(&self.moments).into();
        turn(2, about) * turn(0, m1.hypot(m2).atan2(m3)) * turn(2, m1.atan2(m2))
    }

    /// The rate about the momentum L: L (I₁ ω₁² + I₂ ω₂²)/(I₁² ω₁² + I₂² ω₂²).
    fn rate_about_momentum(&self, t: f64) -> f64 {
        let (moments, w) = (self.moments, self.about_principal(t));
        let momentum = w.component_mul(&moments).norm();
        let (first, second) = (moments.x * w.x * w.x, moments.y * w.y * w.y);
        momentum * (first + second) / (moments.x * first + moments.y * second)
    }
}

/// How far a motion from `START` on is from the closed form.
struct Followed<'c> {
    closed: &'c ClosedForm,
    /// The momentum at the start, and axes whose z is along it.
    momentum: Vector3<f64>,
    axes_of_momentum: Matrix3<f64>,
    /// How far the body has turned about the momentum.
    about: f64,
    turnovers: u32,
    /// The sign of the rotation about the middle axis.
    side: f64,
    /// The largest errors: of the angular velocity in rad/s, of its momentum in space as a share, and of an element of the
    /// rotation.
    errors: [f64; 3],
}

/// The quaternion at the start, but for its length.
const START: [f64; 4] = [0.1, -0.3, 0.5, 0.8];

fn start() -> UnitQuaternion<f64> {
    let [x, y, z, w] = START;
    UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z))
}

impl<'c> Followed<'c> {
    fn new(closed: &'c ClosedForm) -> Self {
        let (t, attitude) = (closed.start(), start().to_rotation_matrix().into_inner());
        Followed {
            closed,
            momentum: attitude * closed.tensor * closed.angular_velocity(t),
            axes_of_momentum: attitude * closed.principal * closed.in_momentum(t, 0.0).transpose(),
            about: 0.0,
            turnovers: 0,
            side: 1.0,
            errors: [0.0; 3],
        }
    }

    /// A step, and the rotation and the angular velocity in the axes of the body at its end.
    fn step(&mut self, [from, t]: [f64; 2], attitude: &Matrix3<f64>, w: &Vector3<f64>) {
        let closed = self.closed;
        self.about += integral(|t| closed.rate_about_momentum(t), from, t);
        let expected = self.axes_of_momentum * closed.in_momentum(t, self.about) * closed.principal.transpose();
        let turned = attitude * closed.tensor * w - self.momentum;
        let errors = [
            (w - closed.angular_velocity(t)).norm(),
            turned.norm() / self.momentum.norm(),
            (attitude - expected).amax(),
        ];
        self.errors = core::array::from_fn(|i| Real::maximum(self.errors[i], errors[i]));
        if w.dot(&closed.principal.column(1)) * self.side < -0.5 * closed.largest[1] {
            (self.turnovers, self.side) = (self.turnovers + 1, -self.side);
        }
    }

    fn assert_within_roundings(&self) {
        let ([velocity, momentum, attitude], size) = (self.errors, self.first_speed());
        println!(
            "velocity {velocity:.1e} of {size:.1} rad/s, momentum {momentum:.1e}, attitude {attitude:.1e} after {:.1} rad \
             about the momentum, {} turnovers",
            self.about, self.turnovers
        );
        assert!(self.turnovers >= 3, "{}", self.turnovers);
        // Roundings of the moments, which differ by a twentieth at least, are phases of up to 46 rad and ten turnovers later.
        assert!(velocity <= 1e-11 * size, "{velocity:e} rad/s");
        assert!(momentum <= 1e-12, "the angular momentum turned in space by {momentum:e}");
        // The same errors of the angular velocity, over 20 s.
        assert!(attitude <= 1e-11, "the attitude is off by {attitude:e}");
    }

    /// The size of the angular velocity at the start, rad/s.
    fn first_speed(&self) -> f64 {
        self.closed.angular_velocity(self.closed.start()).norm()
    }
}

/// Of order 8, with steps so short that roundings are left.
fn method() -> Dop8<f64> {
    Dop8::new(2.0_f64.powi(-8))
}

/// The link of the spherical pendulum, which is in general position.
fn link() -> Link {
    generic("spherical_pendulum").model().links[0].clone()
}

#[test]
fn a_body_without_a_moment_turns_over_about_a_point_as_jacobis_functions_do() {
    let link = link();
    let mut parameters = Body::PARAMETERS;
    parameters[..3].fill(0.0);
    let body = Body::new(&parameters);
    let com = Vector3::from(link.com.0);
    let about_point = link.mass * (Matrix3::identity() * com.norm_squared() - com * com.transpose());
    let closed = ClosedForm::new(tensor(link.inertia) + about_point);
    let mut followed = Followed::new(&closed);
    let from = closed.start();
    let mut simulation = ForwardSimulation::new(&body, ZeroTorque);
    let copy = simulation;
    let state = simulation.state(&start().coords.into(), &closed.angular_velocity(from).into());
    let on_step = |step: &Step<'_, f64, _>| {
        let (t, state) = step.end();
        let now = copy.split(state);
        let attitude = rotation(&body.link_kinematics(&now.q, &now.v)[0]);
        followed.step([step.start().0, t], &attitude, &Vector3::from(now.v));
    };
    method().each_step(&mut simulation, (from, from + DURATION), state, on_step).expect("it turns for 20 s");
    followed.assert_within_roundings();
}

/// The frame of the link is 26 cm from the centre of mass, so that forces and moments of every acceleration are coupled. The
/// centre of mass moves steadily without gravity, and is thrown up and falls back in it; the attitude is the same.
#[test]
fn a_free_body_turns_over_as_jacobis_functions_do_about_a_centre_of_mass_on_a_parabola() {
    let link = link();
    let (com, closed) = (Vector3::from(link.com.0), ClosedForm::new(tensor(link.inertia)));
    let (origin, velocity) = (Vector3::new(0.4, -0.7, 0.2), Vector3::new(1.5, -0.9, 98.1));
    for gravity in [Vector3::zeros(), Vector3::new(0.0, 0.0, -9.81)] {
        let mut parameters = [gravity.as_slice(), &[link.mass], com.as_slice(), &[0.0; 6]].concat();
        let i = link.inertia;
        parameters[7..].copy_from_slice(&[i.xx, i.yy, i.zz, i.xy, i.yz, i.xz]);
        let body = FreeBody::new(&parameters.try_into().expect("all parameters"));
        let mut followed = Followed::new(&closed);
        let (from, attitude) = (closed.start(), start());
        let w = closed.angular_velocity(from);
        // That of the frame's origin, in the axes of the link.
        let linear = attitude.inverse() * velocity - w.cross(&com);
        let path = |t: f64| origin + attitude * com + velocity * t + gravity * (0.5 * t * t);
        let mut simulation = ForwardSimulation::new(&body, ZeroTorque);
        let copy = simulation;
        let q = [origin.as_slice(), attitude.coords.as_slice()].concat().try_into().expect("seven coordinates");
        let v = [linear.as_slice(), w.as_slice()].concat().try_into().expect("six velocities");
        let state = simulation.state(&q, &v);
        let (mut off, mut length) = (0.0_f64, 0.0);
        let on_step = |step: &Step<'_, f64, _>| {
            let ((before, _), (t, state)) = (step.start(), step.end());
            let now = copy.split(state);
            let found = body.link_kinematics(&now.q, &now.v)[0];
            let [_, _, _, x, y, z] = now.v;
            followed.step([before, t], &rotation(&found), &Vector3::new(x, y, z));
            off = Real::maximum(off, (Vector3::from(found.com) - path(t - from)).norm());
            length += (path(t - from) - path(before - from)).norm();
        };
        method().each_step(&mut simulation, (from, from + DURATION), state, on_step).expect("it moves for 20 s");
        println!("centre of mass {off:.1e} m of {length:.0} m");
        assert!(off <= 1e-11 * length, "{off:e} m of {length} m");
        followed.assert_within_roundings();
    }
}
