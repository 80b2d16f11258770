//! What a joint does: one file for each kind, against one interface.
//!
//! A joint moves its body along or about the z axis of the body's frame. Its file states
//!
//! | item | what it is |
//! |---|---|
//! | `SCREW`, or a function of the joint's parameters | the motion subspace S in the body's frame: velocity across the joint is S v |
//! | `split` | which inertia of the body its parent may carry as well, with the same joint forces |
//! | `meets` | which inertia alone makes the joint's diagonal element of the mass matrix positive |
//!
//! and [`Joint`] has a variant that names them and the functions by which its coordinates move, `coordinate_rates`,
//! `integrate`, `difference` and `neutral`; those of coordinates that add up are in `linear`. From S follow the
//! transform (a rotation about z by the turn of q, a displacement along z by its slide), the bias acceleration, and the
//! joint force Sᵀ w of a wrench. The recursions do not depend on the kind of a joint.

mod helical;
mod linear;
mod prismatic;
mod revolute;
mod screw;
mod shared;

use crate::model::{JointKind, Link};
use crate::parameter::Parameter;
use crate::pseudo::PseudoInertia;
use redysim_runtime::Scalar;
pub use screw::Screw;
pub use shared::{AxisMass, Vanishing};

/// What a joint of the tree does.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Joint {
    /// Turns the body about its z axis.
    Revolute,
    /// Moves the body along its z axis.
    Prismatic,
    /// Turns the body about its z axis and moves it along.
    Helical {
        /// Displacement for a unit of rotation, m/rad.
        pitch: f64,
    },
}

impl Joint {
    /// What the joint of a link does; `None` if it is fixed.
    pub fn of(link: &Link) -> Option<Joint> {
        match link.joint {
            JointKind::Revolute => Some(Joint::Revolute),
            JointKind::Prismatic => Some(Joint::Prismatic),
            JointKind::Helical => Some(Joint::Helical { pitch: link.pitch }),
            JointKind::Fixed => None,
        }
    }

    /// Number of coordinates.
    #[inline]
    pub fn nq(self) -> usize {
        1
    }

    /// Number of velocities.
    #[inline]
    pub fn nv(self) -> usize {
        1
    }

    /// The rates of its coordinates, q̇ = N(q) v.
    pub fn coordinate_rates<S: Scalar>(self, q: &[S], v: &[S], rates: &mut [S]) {
        let _ = q;
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => linear::coordinate_rates(v, rates),
        }
    }

    /// q ⊞ dv: where the joint is after a unit of time at the velocity `dv`.
    pub fn integrate<S: Scalar>(self, q: &[S], dv: &[S], moved: &mut [S]) {
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => linear::integrate(q, dv, moved),
        }
    }

    /// q₁ ⊟ q₀: the velocity that leads from `q0` to `q1` in a unit of time.
    pub fn difference<S: Scalar>(self, q0: &[S], q1: &[S], dv: &mut [S]) {
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => linear::difference(q0, q1, dv),
        }
    }

    /// The coordinates of the zero position.
    pub fn neutral<S: Scalar>(self, q: &mut [S]) {
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => linear::neutral(q),
        }
    }

    /// The motion subspace S.
    #[inline]
    pub fn screw(self) -> Screw {
        match self {
            Joint::Revolute => revolute::SCREW,
            Joint::Prismatic => prismatic::SCREW,
            Joint::Helical { pitch } => helical::screw(pitch),
        }
    }

    /// The inertia of the body as what stays with it, in which `vanishing` vanishes, and what its parent may carry:
    /// joint forces, the mass matrix and energies are then the same.
    pub fn split<P: Parameter>(
        self,
        inertia: PseudoInertia<P>,
        vanishing: Vanishing,
    ) -> (PseudoInertia<P>, PseudoInertia<P>) {
        match self {
            Joint::Revolute => revolute::split(inertia, vanishing),
            Joint::Prismatic => prismatic::split(inertia),
            Joint::Helical { .. } => helical::split(inertia, vanishing),
        }
    }

    /// How much of the body's own inertia resists the joint's motion, Sᵀ I S, as a share of what could.
    pub fn meets(self, inertia: PseudoInertia<f64>) -> f64 {
        match self {
            Joint::Revolute => revolute::meets(inertia),
            Joint::Prismatic => prismatic::meets(inertia),
            Joint::Helical { pitch } => helical::meets(pitch, inertia),
        }
    }

    /// The same joint in another unit of length, `unit` m; `None` if its coordinate is a length.
    pub fn in_unit(self, unit: f64) -> Option<Joint> {
        match self {
            Joint::Revolute => Some(self),
            Joint::Prismatic => None,
            Joint::Helical { pitch } => Some(Joint::Helical { pitch: pitch / unit }),
        }
    }
}

impl Link {
    /// The displacement of the link along its axis where the joint variable is zero, m.
    pub fn offset_along_axis(&self) -> f64 {
        Joint::of(self).and_then(|joint| joint.screw().slide(self.offset)).unwrap_or(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rotation::about_z;
    use crate::spatial::{Mat3, Pose, Twist, Vec3, Wrench};

    /// Every joint; a new one is added here.
    const JOINTS: [Joint; 4] =
        [Joint::Revolute, Joint::Prismatic, Joint::Helical { pitch: 0.3 }, Joint::Helical { pitch: -0.7 }];
    /// Step of the differences, whose error is a sixth of its square.
    const STEP: f64 = 1e-4;

    /// The body's frame in the frame in which the joint stands.
    fn transform(joint: Joint, q: f64) -> Pose<f64> {
        let screw = joint.screw();
        Pose {
            rotation: screw.turn(q).map_or(Mat3::identity(), about_z),
            position: Vec3([0.0, 0.0, screw.slide(q).unwrap_or(0.0)]),
        }
    }

    /// The twist of a moving pose in its own axes, by differences.
    fn twist(at: impl Fn(f64) -> Pose<f64>) -> Twist<f64> {
        let (pose, [before, after]) = (at(0.0), [-STEP, STEP].map(&at));
        let rates = (after.rotation - before.rotation).0.map(|row| row.map(|x| x / (2.0 * STEP)));
        let spin = pose.rotation.transpose() * Mat3(rates);
        let velocity = (after.position - before.position).scale(1.0 / (2.0 * STEP));
        Twist {
            angular: Vec3([spin.0[2][1], spin.0[0][2], spin.0[1][0]]),
            linear: pose.rotation.transpose() * velocity,
        }
    }

    fn assert_near(joint: Joint, found: Twist<f64>, expected: Twist<f64>) {
        for axis in 0..6 {
            let (found, expected) = (found.component(axis), expected.component(axis));
            assert!((found - expected).abs() < 1e-7, "{joint:?}, component {axis}: {found} instead of {expected}");
        }
    }

    #[test]
    fn the_velocity_across_a_joint_is_the_derivative_of_its_transform() {
        for joint in JOINTS {
            for (q, v) in [(0.0, 1.0), (0.4, -2.0), (-2.5, 0.7)] {
                let found = joint.screw().added(Twist::zero(), v);
                assert_near(joint, found, twist(|t| transform(joint, q + v * t)));
            }
        }
    }

    /// On a parent that turns at a constant rate about its origin, which the joint's axis passes.
    #[test]
    fn the_bias_acceleration_is_the_derivative_of_the_velocity_at_a_constant_rate() {
        let parent = Vec3([0.3, -0.5, 0.8]);
        for joint in JOINTS {
            let (q, v) = (0.6, 1.4);
            let velocity = |t: f64| {
                let pose = transform(joint, q + v * t);
                let angular = pose.rotation.transpose() * parent;
                let carried = Twist { angular, linear: pose.rotation.transpose() * parent.cross(pose.position) };
                (pose, angular, joint.screw().added(carried, v))
            };
            let (pose, angular, now) = velocity(0.0);
            let [(_, _, before), (_, _, after)] = [-STEP, STEP].map(velocity);
            let change = |after: Vec3<f64>, before: Vec3<f64>| (after - before).scale(1.0 / (2.0 * STEP));
            // Seen from the base: the derivative in the body's axes and what their rotation adds.
            let angular_acceleration = change(after.angular, before.angular);
            let acceleration = change(after.linear, before.linear) + now.angular.cross(now.linear);
            let centripetal = pose.rotation.transpose() * parent.cross(parent.cross(pose.position));
            let found = joint.screw().bias(angular, v);
            let found = Twist { linear: found.linear + centripetal, ..found };
            assert_near(joint, found, Twist { angular: angular_acceleration, linear: acceleration });
        }
    }

    #[test]
    fn the_joint_force_of_a_wrench_is_its_power_at_a_unit_velocity() {
        let wrench: Wrench<f64> = Wrench { moment: Vec3([0.2, -0.4, 1.1]), force: Vec3([0.7, 0.9, -0.6]) };
        for joint in JOINTS {
            let power = wrench.dot(joint.screw().added(Twist::zero(), 1.0));
            assert!((joint.screw().project(wrench) - power).abs() < 1e-15, "{joint:?}");
            let held = joint.screw().with_force(wrench, 2.5);
            assert!((joint.screw().project(held) - 2.5).abs() < 1e-15, "{joint:?}");
        }
    }

    /// Coordinates in general position, and a velocity.
    fn position_and_velocity(joint: Joint) -> (Vec<f64>, Vec<f64>) {
        let (mut q, mut neutral) = (vec![0.0; joint.nq()], vec![0.0; joint.nq()]);
        joint.neutral(&mut neutral);
        let to: Vec<f64> = (0..joint.nv()).map(|i| 0.4 + 0.3 * i as f64).collect();
        joint.integrate(&neutral, &to, &mut q);
        (q, (0..joint.nv()).map(|i| 0.7 - 0.5 * i as f64).collect())
    }

    #[test]
    fn the_rates_of_coordinates_are_the_derivative_of_their_motion() {
        for joint in JOINTS {
            let (q, v) = position_and_velocity(joint);
            let at = |time: f64| {
                let mut moved = vec![0.0; joint.nq()];
                joint.integrate(&q, &v.iter().map(|v| v * time).collect::<Vec<_>>(), &mut moved);
                moved
            };
            let mut rates = vec![0.0; joint.nq()];
            joint.coordinate_rates(&q, &v, &mut rates);
            for ((rate, before), after) in rates.iter().zip(at(-STEP)).zip(at(STEP)) {
                let difference = (after - before) / (2.0 * STEP);
                assert!((rate - difference).abs() < 1e-7, "{joint:?}: {rate} instead of {difference}");
            }
        }
    }

    #[test]
    fn the_difference_of_two_positions_leads_from_one_to_the_other() {
        for joint in JOINTS {
            let (q, v) = position_and_velocity(joint);
            let (mut moved, mut back) = (vec![0.0; joint.nq()], vec![0.0; joint.nv()]);
            joint.integrate(&q, &v, &mut moved);
            joint.difference(&q, &moved, &mut back);
            for (back, v) in back.iter().zip(&v) {
                assert!((back - v).abs() < 1e-15, "{joint:?}: {back} instead of {v}");
            }
        }
    }

    #[test]
    fn the_neutral_position_is_the_zero_of_the_transform() {
        for joint in JOINTS {
            let mut q = vec![f64::NAN; joint.nq()];
            joint.neutral(&mut q);
            assert_eq!(transform(joint, q[0]), Pose::identity(), "{joint:?}");
        }
    }

    /// What the parent may carry is the same in its axes wherever the joint stands, and resists no motion of the joint.
    #[test]
    fn shared_inertia_does_not_depend_on_the_joint() {
        let inertia = PseudoInertia::from_central(
            2.0,
            Vec3([0.3, -0.2, 0.5]),
            crate::inertia::Sym3 { xx: 0.9, yy: 0.8, zz: 0.7, xy: 0.1, yz: -0.05, xz: 0.02 },
        );
        for joint in JOINTS {
            for vanishing in [Vanishing::TensorYy, Vanishing::SecondMomentZz] {
                let (own, shared) = joint.split(inertia, vanishing);
                assert!(own.second.full() + shared.second.full() == inertia.second.full(), "{joint:?}");
                let [near, far] = [0.0, 1.3].map(|q| shared.transformed(transform(joint, q)));
                let (second, first) = (near.second.full() - far.second.full(), near.moment - far.moment);
                let differences = second.0.as_flattened().iter().chain(&first.0);
                assert!(differences.fold(0.0_f64, |most, x| most.max(x.abs())) < 1e-15, "{joint:?}");
                assert!(joint.meets(shared) == 0.0, "{joint:?}");
            }
        }
    }
}
