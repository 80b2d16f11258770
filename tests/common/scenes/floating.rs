//! KR5 on a platform that floats without gravity, its joints without torques, with a unit quaternion and with Euler angles.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use redysim::generic::{GenericMechanism, Model, Vec3};
use redysim::{ConfigurationSpace, ForwardDynamics, Scalar, redysim};
use redysim_codegen::accuracy::double_double::{DoubleDouble, exact, rounded};
use redysim_model::joint::EulerSequence;

use super::extrapolation::extrapolated;

redysim! {
    /// KR5 on a platform that floats.
    pub struct FloatingArm(
        "../../../models/kr5_floating.toml",
        functions = [forward_dynamics, energy, momentum],
        parameters = ["gravity"],
    );
}

/// Coordinates and velocities with a unit quaternion.
pub type State = ([f64; FloatingArm::NQ], [f64; FloatingArm::NV]);

/// Length of the motion, s.
pub const DURATION: f64 = 4.0;

/// Where it starts.
pub const START: State = (
    [0.2, -0.1, 0.4, 0.1, 0.3, -0.3, 0.9, 0.3, -0.8, 1.1, 0.7, -0.4, 0.9],
    [0.02, -0.03, 0.01, 0.1, -0.2, 0.15, 0.5, -0.4, 0.6, 0.8, -0.7, 0.3],
);

/// The arm with a unit quaternion.
pub fn arm() -> FloatingArm {
    FloatingArm::new(&[0.0; 3])
}

/// The same arm on the generic path, with a unit quaternion or with Euler angles.
pub fn generic(coordinates: Option<EulerSequence>) -> GenericMechanism {
    let text = include_str!("../../../models/kr5_floating.toml");
    let mut model = Model::from_toml(text, "kr5_floating.toml").expect("a model").model;
    model.gravity = Vec3([0.0; 3]);
    model.links[0].coordinates = coordinates;
    GenericMechanism::new(model)
}

/// Where a motion is after `time`, by extrapolation in double-double.
pub fn after(time: f64, (q, v): &State) -> State {
    let arm = generic(None);
    let nq = q.len();
    let rates = |y: &[DoubleDouble]| {
        let (q, v) = (y[..nq].to_vec(), y[nq..].to_vec());
        let a = arm.forward_dynamics(&q, &v, &exact(&[0.0; FloatingArm::NV]));
        [arm.coordinate_rates(&q, &v), a].concat()
    };
    // Steps of 0.1 s, of order 20.
    let steps = (10.0 * time).ceil() as u32;
    let end = rounded(extrapolated(rates, exact(&[&q[..], v].concat()), DoubleDouble::from_f64(time), (steps, 10)));
    (std::array::from_fn(|i| end[i]), std::array::from_fn(|i| end[nq + i]))
}

/// Changes of momentum and of energy from [`START`] to `end`, as shares: of the linear momentum and of the angular one the
/// larger.
pub fn drifts(end: &State) -> [f64; 2] {
    let arm = arm();
    let [before, after] = [&START, end].map(|(q, v)| (arm.momentum(q, v), arm.energy(q, v).kinetic));
    let share = |before: [f64; 3], after: [f64; 3]| {
        let [before, after] = [before, after].map(Vector3::from);
        (after - before).norm() / before.norm()
    };
    let [one, other] = [before.0, after.0];
    let momentum = share(one.linear, other.linear).max(share(one.angular, other.angular));
    [momentum, (after.1 / before.1 - 1.0).abs()]
}

/// The motion with the angles z, x, y, in axes of the base that are turned so that halfway it passes the gimbal.
pub struct PastGimbal {
    pub mechanism: GenericMechanism,
    pub start: (Vec<f64>, Vec<f64>),
    pub end: [f64; FloatingArm::NQ],
}

impl PastGimbal {
    /// At `distance`, rad; `halfway` and `end` are states of the motion from [`START`].
    pub fn at(distance: f64, halfway: &State, end: &State) -> Self {
        let turn = turn_to_the_gimbal(distance, halfway);
        let (end, _) = turned(&turn, end);
        PastGimbal { mechanism: generic(Some(EulerSequence::Zxy)), start: in_angles(&turned(&turn, &START)), end }
    }

    /// The error of the coordinates `q` at the end, in angles.
    pub fn error(&self, q: &[f64]) -> f64 {
        apart(&in_quaternion(q), &self.end)
    }
}

fn quaternion(q: &[f64]) -> UnitQuaternion<f64> {
    UnitQuaternion::from_quaternion(Quaternion::new(q[3], q[0], q[1], q[2]))
}

/// A turn of the axes of the base after which the y axis of the platform passes the z axis of the base halfway, where the
/// angles z, x, y lose a freedom, at `distance`, rad.
fn turn_to_the_gimbal(distance: f64, (q, v): &State) -> UnitQuaternion<f64> {
    let attitude = quaternion(&q[3..7]);
    let axis = attitude * Vector3::y();
    let motion = attitude * Vector3::new(v[3], v[4], v[5]).cross(&Vector3::y());
    // Beside the way of the axis.
    let aside = UnitQuaternion::from_scaled_axis(motion.normalize() * distance) * axis;
    UnitQuaternion::rotation_between(&aside, &Vector3::z()).expect("the axis does not point straight down")
}

/// A state in axes of the base that are turned.
fn turned(turn: &UnitQuaternion<f64>, (q, v): &State) -> State {
    let mut q = *q;
    let position = turn * Vector3::new(q[0], q[1], q[2]);
    let attitude = turn * quaternion(&q[3..7]);
    q[..3].copy_from_slice(position.as_slice());
    q[3..7].copy_from_slice(attitude.coords.as_slice());
    (q, *v)
}

/// A state in the angles z, x, y: coordinates and velocities.
pub fn in_angles((q, v): &State) -> (Vec<f64>, Vec<f64>) {
    let attitude = quaternion(&q[3..7]);
    let r = attitude.to_rotation_matrix();
    let angles = [f64::atan2(-r[(0, 1)], r[(1, 1)]), r[(2, 1)].asin(), f64::atan2(-r[(2, 0)], r[(2, 2)])];
    // ω in the axes before the last rotation is (θ', ψ' + φ' sin θ, φ' cos θ).
    let before = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), angles[2]);
    let w = before * Vector3::new(v[3], v[4], v[5]);
    let (sin, cos) = angles[1].sin_cos();
    let rates = [w.z / cos, w.x, w.y - w.z / cos * sin];
    let velocity = attitude * Vector3::new(v[0], v[1], v[2]);
    ([&q[..3], &angles, &q[7..]].concat(), [velocity.as_slice(), &rates, &v[6..]].concat())
}

/// Coordinates with a unit quaternion, from those in angles z, x, y.
pub fn in_quaternion(q: &[f64]) -> [f64; FloatingArm::NQ] {
    let turns = [Vector3::z_axis(), Vector3::x_axis(), Vector3::y_axis()];
    let turns = turns.iter().zip(&q[3..6]).map(|(axis, &angle)| UnitQuaternion::from_axis_angle(axis, angle));
    let attitude = turns.fold(UnitQuaternion::identity(), |all, turn| all * turn);
    let all = [&q[..3], attitude.coords.as_slice(), &q[6..]].concat();
    std::array::from_fn(|i| all[i])
}

/// The largest component of the difference of two configurations on the tangent, rad or m.
pub fn apart(one: &[f64; FloatingArm::NQ], other: &[f64; FloatingArm::NQ]) -> f64 {
    arm().difference(one, other).iter().fold(0.0, |most, part| part.abs().max(most))
}
