//! Positions that are quaternions: `integrate`, `difference`, `neutral` and `coordinate_rates` of compiled types and of
//! the generic path, against the quaternions of nalgebra and by their own identities.
#![cfg(feature = "generic")]

use crate::common::call;
use crate::common::dual::{Dual, moving};
use crate::common::models::generic;
use crate::common::random::Random;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use redysim::{ConfigurationSpace, Scalar, redysim};
use std::f64::consts::PI;

redysim! {
    /// A free joint under six with one degree of freedom.
    struct Floating("models/kr5_floating.toml", functions = [mass_matrix]);
}

redysim! {
    /// A spherical joint.
    struct Pendulum("models/spherical_pendulum.toml", functions = [mass_matrix]);
}

type Binary<S> = Box<dyn Fn(&[S], &[S]) -> Vec<S>>;

/// The positions of a mechanism with one quaternion.
struct Space<S> {
    name: String,
    nq: usize,
    nv: usize,
    integrate: Binary<S>,
    difference: Binary<S>,
    rates: Binary<S>,
    neutral: Vec<S>,
}

impl<S: Scalar> Space<S> {
    fn new<M: ConfigurationSpace<S> + Clone + 'static>(name: &str, mechanism: M) -> Self {
        let [first, second, third] = [(); 3].map(|()| mechanism.clone());
        Space {
            name: name.into(),
            nq: mechanism.nq(),
            nv: mechanism.nv(),
            integrate: Box::new(move |q, dv| call::integrate(&first, q, dv)),
            difference: Box::new(move |q0, q1| call::difference(&second, q0, q1)),
            rates: Box::new(move |q, v| call::coordinate_rates(&third, q, v)),
            neutral: call::neutral(&mechanism),
        }
    }

    fn all() -> [Space<S>; 4] {
        [
            Space::new("compiled kr5_floating", Floating),
            Space::new("compiled spherical_pendulum", Pendulum),
            Space::new("generic kr5_floating", generic("kr5_floating")),
            Space::new("generic spherical_pendulum", generic("spherical_pendulum")),
        ]
    }

    /// Where the quaternion is among the coordinates, and the angular velocity among the velocities.
    fn quaternion(&self) -> usize {
        if self.nq == 4 { 0 } else { 3 }
    }

    /// Coordinates in general position with the quaternion `q`, (x, y, z, w).
    fn position(&self, q: [S; 4]) -> Vec<S> {
        let mut position: Vec<S> = (0..self.nq).map(|i| S::from_f64(0.3 * i as f64 - 1.0)).collect();
        position[self.quaternion()..][..4].copy_from_slice(&q);
        position
    }

    /// Velocities in general position with the angular velocity `w`.
    fn velocity(&self, w: [S; 3]) -> Vec<S> {
        let mut velocity: Vec<S> = (0..self.nv).map(|i| S::from_f64(0.7 - 0.2 * i as f64)).collect();
        velocity[self.quaternion()..][..3].copy_from_slice(&w);
        velocity
    }

    fn angular(&self, v: &[S]) -> [S; 3] {
        std::array::from_fn(|i| v[self.quaternion() + i])
    }
}

impl Space<f64> {
    fn orientation(&self, q: &[f64]) -> UnitQuaternion<f64> {
        let q = &q[self.quaternion()..];
        UnitQuaternion::new_normalize(Quaternion::new(q[3], q[0], q[1], q[2]))
    }

    /// Compares positions: quaternions by the rotation between them, other coordinates by themselves.
    fn assert_same_position(&self, found: &[f64], expected: &[f64], tolerance: f64) {
        let [x, y] = [found, expected].map(|q| self.orientation(q).to_rotation_matrix().into_inner());
        assert!((x - y).amax() <= tolerance, "{}: {found:?} instead of {expected:?}", self.name);
        let quaternion = self.quaternion()..self.quaternion() + 4;
        for i in (0..self.nq).filter(|i| !quaternion.contains(i)) {
            let error = (found[i] - expected[i]).abs();
            assert!(error <= tolerance, "{}, coordinate {i}: {} instead of {}", self.name, found[i], expected[i]);
        }
    }
}

fn unit_vector(random: &mut Random) -> Vector3<f64> {
    Vector3::from_fn(|_, _| random.within(1.0)).normalize()
}

/// A quaternion of a length from 1e-3 to 1e3.
fn quaternion(random: &mut Random) -> [f64; 4] {
    let size = 10.0_f64.powf(random.within(3.0));
    std::array::from_fn(|_| random.within(size))
}

fn assert_near(found: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (x, y) in found.iter().zip(expected) {
        assert!((x - y).abs() <= tolerance, "{what}: {found:?} instead of {expected:?}");
    }
}

#[test]
fn the_difference_to_where_velocities_lead_is_these_velocities() {
    let mut random = Random::new(1);
    for space in Space::all() {
        for _ in 0..300 {
            let q = space.position(quaternion(&mut random));
            // Less than half a turn, beyond which the other way is shorter.
            let angle = random.within(3.1);
            let v = space.velocity((unit_vector(&mut random) * angle).into());
            let found = (space.difference)(&q, &(space.integrate)(&q, &v));
            // Velocities are up to 3.1: a few roundings of the quaternions and of positions up to 7 m away.
            assert_near(&found, &v, 2e-14, &space.name);
        }
    }
}

#[test]
fn the_difference_of_two_positions_leads_from_one_to_the_other() {
    let mut random = Random::new(2);
    for space in Space::all() {
        for _ in 0..300 {
            let [q0, q1] = [(); 2].map(|()| space.position(quaternion(&mut random)));
            let dv = (space.difference)(&q0, &q1);
            let turn = Vector3::from(space.angular(&dv)).norm();
            // Of the two ways round the shorter, as nalgebra measures it.
            let shortest = space.orientation(&q0).angle_to(&space.orientation(&q1));
            assert!((turn - shortest).abs() <= 1e-14, "{}: {turn} instead of {shortest}", space.name);
            space.assert_same_position(&(space.integrate)(&q0, &dv), &q1, 1e-14);
        }
    }
}

/// Quaternions and the rotation vectors of nalgebra.
#[test]
fn angular_velocities_of_many_turns_are_integrated() {
    let mut random = Random::new(3);
    for space in Space::all() {
        for _ in 0..300 {
            let q = space.position(quaternion(&mut random));
            let w = unit_vector(&mut random) * random.within(1000.0);
            let found = space.orientation(&(space.integrate)(&q, &space.velocity(w.into())));
            let expected = space.orientation(&q) * UnitQuaternion::from_scaled_axis(w);
            let error = (found.to_rotation_matrix().into_inner() - expected.to_rotation_matrix().into_inner()).amax();
            // The length of w is rounded to 1e-16 of up to a thousand radians.
            assert!(error <= 3e-13, "{}: {error:e}", space.name);
        }
    }
}

/// V u of a free joint is the sum of many short ways.
#[test]
fn a_long_way_is_the_sum_of_a_thousand_short_ones() {
    for space in Space::all() {
        for w in [[0.0, 0.0, 0.0], [0.5, -0.2, 1.0], [40.0, -25.0, 30.0]] {
            let (start, v) = (space.position([0.1, -0.7, 0.3, 0.4]), space.velocity(w));
            let share: Vec<f64> = v.iter().map(|v| v / 1000.0).collect();
            let walked = (0..1000).fold(start.clone(), |q, _| (space.integrate)(&q, &share));
            // The roundings of a thousand steps.
            space.assert_same_position(&(space.integrate)(&start, &v), &walked, 1e-13);
        }
    }
}

#[test]
fn a_velocity_of_zero_leads_nowhere() {
    for space in Space::all() {
        let q = space.position([0.1, -0.7, 0.5, 0.5]);
        let still = (space.integrate)(&q, &vec![0.0; space.nv]);
        assert_near(&still, &q, 1e-16, &space.name);
        assert_near(&(space.difference)(&q, &q), &vec![0.0; space.nv], 1e-16, &space.name);
        let tiny = space.velocity([1e-200, -1e-30, 1e-19]);
        let moved = (space.integrate)(&q, &tiny);
        assert!(moved.iter().all(|x| x.is_finite()), "{}: {moved:?}", space.name);
        let back = (space.difference)(&q, &moved);
        assert_near(&back, &tiny, 1e-15, &space.name);
    }
}

#[test]
fn the_neutral_position_is_zero_with_the_quaternion_of_no_rotation() {
    for space in Space::<f64>::all() {
        let mut expected = vec![0.0; space.nq];
        expected[space.quaternion() + 3] = 1.0;
        assert_eq!(space.neutral, expected, "{}", space.name);
    }
}

/// Half a turn about any axis, from any attitude: the scalar part of the quotient is a rounding of zero, or zero.
#[test]
fn half_a_turn_is_a_difference_of_length_pi() {
    let mut random = Random::new(4);
    for space in Space::all() {
        for _ in 0..300 {
            let (axis, start) = (unit_vector(&mut random), quaternion(&mut random));
            let [x, y, z, w] = start;
            let half_turn = Quaternion::new(w, x, y, z) * Quaternion::new(0.0, axis.x, axis.y, axis.z);
            let [q0, q1] = [space.position(start), space.position(half_turn.coords.into())];
            let dv = (space.difference)(&q0, &q1);
            let turn = Vector3::from(space.angular(&dv));
            assert!((turn.norm() - PI).abs() <= 4e-15, "{}: {turn:?}", space.name);
            // Both ways round are as short.
            assert!(turn.cross(&axis).norm() <= 1e-14, "{}: {turn:?} about {axis:?}", space.name);
            space.assert_same_position(&(space.integrate)(&q0, &dv), &q1, 1e-14);
        }
    }
}

#[test]
fn near_half_a_turn_the_difference_is_the_shorter_way() {
    for space in Space::all() {
        let q0 = space.position([0.0, 0.0, 0.0, 1.0]);
        for cos in [0.0, 1e-300, 1e-30, 1e-19, 1e-18, 3e-18, 1e-17, 1e-16, 1e-12, 1e-9, 1e-6, 1e-3_f64] {
            for sign in [1.0, -1.0] {
                let sin = (1.0 - cos * cos).sqrt();
                let dv = (space.difference)(&q0, &space.position([0.6 * sin, 0.0, 0.8 * sin, sign * cos]));
                let angle = PI - 2.0 * cos.asin();
                let turn = Vector3::from(space.angular(&dv));
                // A rounding of π and a few of the axis.
                assert!((turn.norm() - angle).abs() <= 2e-15, "{}, {cos:e}: {turn:?}", space.name);
                // Where the angle is π to all digits, both ways are as short.
                assert!(cos < 1e-16 || turn.z * sign > 0.0, "{}, {cos:e}: {turn:?}", space.name);
                assert!(dv.iter().all(|x| x.is_finite()), "{}: {dv:?}", space.name);
            }
        }
    }
}

/// q ⊞ v t at t = 0 moves at N(q) v. Away from length 1, q ⊞ v t starts nearer to it than q.
#[test]
fn coordinate_rates_are_the_derivative_of_the_way_that_velocities_lead() {
    let mut random = Random::new(5);
    for (space, dual) in Space::<f64>::all().iter().zip(Space::<Dual<f64>>::all()) {
        for _ in 0..100 {
            let q = UnitQuaternion::from_scaled_axis(unit_vector(&mut random) * random.within(3.0));
            let q = space.position(q.coords.into());
            let v = space.velocity(std::array::from_fn(|_| random.within(5.0)));
            let along = (dual.integrate)(&moving(&q, &vec![0.0; space.nq]), &moving(&vec![0.0; space.nv], &v));
            let found: Vec<f64> = along.iter().map(|q| q.rate).collect();
            assert_near(&(space.rates)(&q, &v), &found, 2e-15, &space.name);
        }
    }
}

/// For a rotation R(q(t)) and ω in its axes, Ṙ = R ω̂, whatever the length of the quaternion.
#[test]
fn quaternions_of_any_length_turn_at_the_angular_velocity() {
    let mut random = Random::new(6);
    for space in Space::all() {
        for _ in 0..100 {
            let q = quaternion(&mut random);
            let w: [f64; 3] = std::array::from_fn(|_| random.within(5.0));
            let rates = (space.rates)(&space.position(q), &space.velocity(w));
            let rates: [f64; 4] = std::array::from_fn(|i| rates[space.quaternion() + i]);
            let [p, dp] = [q, rates].map(|[x, y, z, w]| Quaternion::new(w, x, y, z));
            // 2 q⁻¹ q̇ is (ω; 0): the length does not change.
            let found = p.try_inverse().expect("not zero") * dp * 2.0;
            assert_near(found.coords.as_slice(), &[w[0], w[1], w[2], 0.0], 1e-14, &space.name);
        }
    }
}

#[test]
fn in_single_precision_positions_are_right_to_a_few_roundings() {
    let mut random = Random::new(7);
    let single = |q: &[f64]| q.iter().map(|&x| x as f32).collect::<Vec<f32>>();
    let double = |q: &[f32]| q.iter().map(|&x| f64::from(x)).collect::<Vec<f64>>();
    for (space, narrow) in Space::<f64>::all().iter().zip(Space::<f32>::all()) {
        for round in 0..300 {
            let axis = unit_vector(&mut random);
            let angle = [0.0, PI, 1e-20, 1e-4, random.within(3.0)][round % 5];
            let (q, v) =
                (single(&space.position(quaternion(&mut random))), single(&space.velocity((axis * angle).into())));
            let moved = (narrow.integrate)(&q, &v);
            // Roundings are 6e-8, of positions up to 7 m and angles up to 3 rad.
            space.assert_same_position(&double(&moved), &(space.integrate)(&double(&q), &double(&v)), 3e-6);
            let back = double(&(narrow.difference)(&q, &moved));
            space.assert_same_position(&(space.integrate)(&double(&q), &back), &double(&moved), 1e-5);
            if angle != PI {
                assert_near(&back, &double(&v), 1e-5, &space.name);
            }
        }
    }
}
