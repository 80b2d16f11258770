//! Mechanisms around another mechanism: what they take from it, method by method.
//!
//! The lists stand once, so that no wrapper is left with the default of a method.

/// The methods of [`Mechanism`](crate::Mechanism), from the field `$mechanism`.
macro_rules! names_and_sizes_of {
    ($mechanism:ident) => {
        fn name(&self) -> &str {
            self.$mechanism.name()
        }
        fn nq(&self) -> usize {
            self.$mechanism.nq()
        }
        fn nv(&self) -> usize {
            self.$mechanism.nv()
        }
        fn nl(&self) -> usize {
            self.$mechanism.nl()
        }
        fn link_name(&self, index: usize) -> Option<&str> {
            self.$mechanism.link_name(index)
        }
        fn joint_name(&self, index: usize) -> Option<&str> {
            self.$mechanism.joint_name(index)
        }
        fn coordinate_name(&self, index: usize) -> Option<&str> {
            self.$mechanism.coordinate_name(index)
        }
        fn velocity_name(&self, index: usize) -> Option<&str> {
            self.$mechanism.velocity_name(index)
        }
        fn is_actuated(&self, index: usize) -> bool {
            self.$mechanism.is_actuated(index)
        }
        fn coordinate_of_velocity(&self, index: usize) -> Option<usize> {
            self.$mechanism.coordinate_of_velocity(index)
        }
        fn coordinates_of_velocity(&self, index: usize) -> crate::VelocityCoordinates {
            self.$mechanism.coordinates_of_velocity(index)
        }
        fn nf(&self) -> usize {
            self.$mechanism.nf()
        }
        fn frame_name(&self, index: usize) -> Option<&str> {
            self.$mechanism.frame_name(index)
        }
    };
}

/// The types and methods of [`ConfigurationSpace`](crate::ConfigurationSpace) but `dissipated_power`, from the field
/// `$mechanism`.
macro_rules! coordinates_of {
    ($mechanism:ident) => {
        type Coordinates = M::Coordinates;
        type Velocities = M::Velocities;
        type State = M::State;
        type Matrix = M::Matrix;
        type Links = M::Links;

        fn coordinate_rates(&self, q: &M::Coordinates, v: &M::Velocities) -> M::Coordinates {
            self.$mechanism.coordinate_rates(q, v)
        }
        fn coordinate_rates_tangent(
            &self,
            q: &M::Coordinates,
            v: &M::Velocities,
            dq: &M::Coordinates,
        ) -> Option<M::Coordinates> {
            self.$mechanism.coordinate_rates_tangent(q, v, dq)
        }
        fn integrate(&self, q: &M::Coordinates, dv: &M::Velocities) -> M::Coordinates {
            self.$mechanism.integrate(q, dv)
        }
        fn difference(&self, q0: &M::Coordinates, q1: &M::Coordinates) -> M::Velocities {
            self.$mechanism.difference(q0, q1)
        }
        fn neutral(&self) -> M::Coordinates {
            self.$mechanism.neutral()
        }
    };
}

pub(crate) use coordinates_of;
pub(crate) use names_and_sizes_of;
