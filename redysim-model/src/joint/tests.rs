//! Every joint against its own transform, by differences.

use super::*;
use crate::inertia::Sym3;
use crate::spatial::Mat3;

/// Every joint; a new one is added here.
const JOINTS: [Joint; 6] = [
    Joint::Revolute,
    Joint::Prismatic,
    Joint::Helical { pitch: 0.3 },
    Joint::Helical { pitch: -0.7 },
    Joint::Spherical,
    Joint::Free,
];
/// Step of the differences, whose error is a sixth of its square.
const STEP: f64 = 1e-4;
/// For third derivatives of up to 60; velocities are at most 2.
const TOLERANCE: f64 = 1e-7;

/// A joint at coordinates and velocities in general position.
#[derive(Debug)]
struct Motion {
    joint: Joint,
    q: Vec<f64>,
    v: Vec<f64>,
}

/// Three motions of every joint; the first starts near the zero position.
fn motions() -> impl Iterator<Item = Motion> {
    let starts = [(0.1, 1.0), (0.4, -2.0), (-2.0, 0.7)];
    JOINTS.into_iter().flat_map(move |joint| {
        starts.map(|(displacement, velocity)| {
            // Several angular velocities stay below half a turn together, beyond which the shorter way is another.
            let share = 1.0 / joint.nv() as f64;
            let spread =
                |first: f64, step: f64| (0..joint.nv()).map(|i| share * (first + step * i as f64)).collect::<Vec<_>>();
            let q = integrated(joint, &neutral(joint), &spread(displacement, 0.3));
            Motion { joint, q, v: spread(velocity, -0.5) }
        })
    })
}

fn neutral(joint: Joint) -> Vec<f64> {
    let mut q = vec![f64::NAN; joint.nq()];
    joint.neutral(&mut q);
    q
}

fn integrated(joint: Joint, q: &[f64], dv: &[f64]) -> Vec<f64> {
    let mut moved = vec![f64::NAN; joint.nq()];
    joint.integrate(q, dv, &mut moved);
    moved
}

fn rates(joint: Joint, q: &[f64], v: &[f64]) -> Vec<f64> {
    let mut rates = vec![f64::NAN; joint.nq()];
    joint.coordinate_rates(q, v, &mut rates);
    rates
}

impl Motion {
    /// The coordinates after a time at constant velocity.
    fn at(&self, time: f64) -> Vec<f64> {
        integrated(self.joint, &self.q, &self.v.iter().map(|v| v * time).collect::<Vec<_>>())
    }

    fn transform(&self, time: f64) -> Pose<f64> {
        self.joint.transform(&self.at(time))
    }

    fn assert_near(&self, found: &[f64], expected: &[f64], tolerance: f64) {
        assert_eq!(found.len(), expected.len(), "{self:?}");
        for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
            let error = (found - expected).abs();
            assert!(error <= tolerance, "{self:?}, component {i}: {found} instead of {expected}");
        }
    }
}

/// The derivative of `f` at zero.
fn derivative(f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    f(STEP).into_iter().zip(f(-STEP)).map(|(after, before)| (after - before) / (2.0 * STEP)).collect()
}

fn derivative_of_vector(f: impl Fn(f64) -> Vec3<f64>) -> Vec3<f64> {
    Vec3(derivative(|time| f(time).0.to_vec()).try_into().expect("three components"))
}

fn components(twist: Twist<f64>) -> Vec<f64> {
    [twist.angular.0, twist.linear.0].concat()
}

/// The twist of a moving pose in its own axes, by differences.
fn twist(at: impl Fn(f64) -> Pose<f64>) -> Twist<f64> {
    let to_body = at(0.0).rotation.transpose();
    let rates = [0, 1, 2].map(|axis| derivative_of_vector(|time| at(time).rotation.column(axis)).0);
    let spin = to_body * Mat3(rates).transpose();
    let angular = Vec3([spin.0[2][1], spin.0[0][2], spin.0[1][0]]);
    Twist { angular, linear: to_body * derivative_of_vector(|time| at(time).position) }
}

#[test]
fn the_transform_is_a_rotation_and_a_displacement() {
    for motion in motions() {
        let rotation = motion.joint.transform(&motion.q).rotation;
        let product = rotation.transpose() * rotation;
        motion.assert_near(product.0.as_flattened(), Mat3::identity().0.as_flattened(), 1e-15);
    }
}

#[test]
fn the_velocity_across_a_joint_is_the_derivative_of_its_transform() {
    for motion in motions() {
        let found = motion.joint.added(Twist::zero(), &motion.v);
        motion.assert_near(&components(found), &components(twist(|time| motion.transform(time))), TOLERANCE);
    }
}

#[test]
fn the_velocity_across_a_joint_is_added_to_what_carries_it() {
    let carried = Twist { angular: Vec3([0.3, -0.5, 0.8]), linear: Vec3([1.1, 0.2, -0.4]) };
    for motion in motions() {
        let found = motion.joint.added(carried, &motion.v);
        let expected = carried + motion.joint.added(Twist::zero(), &motion.v);
        motion.assert_near(&components(found), &components(expected), 1e-15);
    }
}

/// On a parent that turns at a constant rate about its origin, which is also the origin of the joint.
#[test]
fn the_bias_acceleration_is_the_derivative_of_the_velocity_at_a_constant_rate() {
    let parent = Vec3([0.3, -0.5, 0.8]);
    for motion in motions() {
        let carried = |time: f64| {
            let pose = motion.transform(time);
            let to_body = pose.rotation.transpose();
            Twist { angular: to_body * parent, linear: to_body * parent.cross(pose.position) }
        };
        let velocity = |time: f64| motion.joint.added(carried(time), &motion.v);
        // Seen from the base: the derivative in the body's axes and what their rotation adds.
        let now = velocity(0.0);
        let expected = Twist {
            angular: derivative_of_vector(|time| velocity(time).angular),
            linear: derivative_of_vector(|time| velocity(time).linear) + now.angular.cross(now.linear),
        };
        let pose = motion.transform(0.0);
        let centripetal = pose.rotation.transpose() * parent.cross(parent.cross(pose.position));
        let found = motion.joint.bias(carried(0.0).angular, &motion.v);
        let found = Twist { linear: found.linear + centripetal, ..found };
        motion.assert_near(&components(found), &components(expected), TOLERANCE);
    }
}

#[test]
fn the_joint_forces_of_a_wrench_are_its_power_at_unit_velocities() {
    let wrench: Wrench<f64> = Wrench { moment: Vec3([0.2, -0.4, 1.1]), force: Vec3([0.7, 0.9, -0.6]) };
    for motion in motions() {
        let nv = motion.joint.nv();
        let mut forces = vec![f64::NAN; nv];
        motion.joint.project(wrench, &mut forces);
        let unit = |i: usize| (0..nv).map(|j| if i == j { 1.0 } else { 0.0 }).collect::<Vec<f64>>();
        let power = |i: usize| wrench.dot(motion.joint.added(Twist::zero(), &unit(i)));
        motion.assert_near(&forces, &(0..nv).map(power).collect::<Vec<_>>(), 1e-15);
    }
}

#[test]
fn a_wrench_takes_known_joint_forces() {
    let wrench: Wrench<f64> = Wrench { moment: Vec3([0.2, -0.4, 1.1]), force: Vec3([0.7, 0.9, -0.6]) };
    for motion in motions() {
        let mut found = vec![f64::NAN; motion.joint.nv()];
        let with_force = |wrench, (screw, &force): (Screw, &f64)| screw.with_force(wrench, force);
        motion.joint.project(motion.joint.screws().zip(&motion.v).fold(wrench, with_force), &mut found);
        motion.assert_near(&found, &motion.v, 1e-15);
    }
}

#[test]
fn the_rates_of_coordinates_are_the_derivative_of_their_motion() {
    for motion in motions() {
        let found = rates(motion.joint, &motion.q, &motion.v);
        motion.assert_near(&found, &derivative(|time| motion.at(time)), TOLERANCE);
    }
}

#[test]
fn the_difference_of_two_positions_leads_from_one_to_the_other() {
    for motion in motions() {
        let mut back = vec![f64::NAN; motion.joint.nv()];
        motion.joint.difference(&motion.q, &motion.at(1.0), &mut back);
        motion.assert_near(&back, &motion.v, 1e-15);
    }
}

#[test]
fn the_neutral_position_is_the_zero_of_the_transform() {
    for joint in JOINTS {
        assert_eq!(joint.transform(&neutral(joint)), Pose::identity(), "{joint:?}");
    }
}

#[test]
fn mass_on_the_axis_belongs_to_both_bodies_of_a_joint_that_turns_about_it_alone() {
    for joint in JOINTS {
        let screws: Vec<Screw> = joint.screws().collect();
        assert_eq!(joint.shares_axis_mass(), screws == [Screw::rotation(2)], "{joint:?}");
    }
}

/// The shared inertia is the same in the parent's axes at every position of the joint, and resists no motion of it.
#[test]
fn shared_inertia_does_not_depend_on_the_joint() {
    let inertia = PseudoInertia::from_central(
        2.0,
        Vec3([0.3, -0.2, 0.5]),
        Sym3 { xx: 0.9, yy: 0.8, zz: 0.7, xy: 0.1, yz: -0.05, xz: 0.02 },
    );
    for motion in motions() {
        for vanishing in [Vanishing::TensorYy, Vanishing::SecondMomentZz] {
            let (own, shared) = motion.joint.split(inertia, vanishing);
            assert!(own.second.full() + shared.second.full() == inertia.second.full(), "{motion:?}");
            let near = shared.transformed(motion.joint.transform(&neutral(motion.joint)));
            let far = shared.transformed(motion.transform(0.0));
            motion.assert_near(&far.moment.0, &near.moment.0, 1e-15);
            motion.assert_near(far.second.full().0.as_flattened(), near.second.full().0.as_flattened(), 1e-15);
            assert!(motion.joint.meets(shared) == 0.0, "{motion:?}");
        }
    }
}
