//! How far a joint is from where its springs are relaxed.

use super::quaternion::Logarithm;
use super::spherical::{four, three};
use super::{Joint, MOST_FREEDOMS, quaternion};
use crate::spatial::{Mat3, Vec3};
use redysim_runtime::Scalar;

/// The displacement e of a joint from where its springs are relaxed, with a component for each velocity. Springs of
/// stiffness k have the energy ½ Σ k e².
pub(crate) enum Stretch<S> {
    /// That of the one coordinate.
    Coordinate(S),
    /// The rotation vector.
    Rotation(Logarithm<S>),
    /// The displacement of the body's origin, in the body's axes where the springs are relaxed, and the rotation vector.
    Motion {
        displacement: Vec3<S>,
        rotation: Logarithm<S>,
        /// The body's axes, in those where the springs are relaxed.
        axes: Mat3<S>,
    },
}

impl Joint {
    /// The displacement from the coordinates `rest` to `q`.
    #[inline]
    pub(crate) fn stretch<S: Scalar>(self, q: &[S], rest: &[S]) -> Stretch<S> {
        match self {
            Joint::Revolute | Joint::Prismatic | Joint::Helical { .. } => Stretch::Coordinate(q[0] - rest[0]),
            Joint::Spherical => Stretch::Rotation(quaternion::difference(four(rest), four(q))),
            Joint::Free => {
                let [relaxed, axes] = [rest, q].map(|q| quaternion::rotation(four(&q[3..])));
                Stretch::Motion {
                    displacement: relaxed.transpose() * (three(q) - three(rest)),
                    rotation: quaternion::difference(four(&rest[3..]), four(&q[3..])),
                    axes: relaxed.transpose() * axes,
                }
            }
        }
    }
}

impl<S: Scalar> Stretch<S> {
    /// The component for a velocity.
    pub fn component(&self, velocity: usize) -> S {
        match self {
            Stretch::Coordinate(stretch) => *stretch,
            Stretch::Rotation(rotation) => rotation.vector[velocity],
            Stretch::Motion { displacement, rotation, .. } => {
                if velocity < 3 {
                    displacement[velocity]
                } else {
                    rotation.vector[velocity - 3]
                }
            }
        }
    }

    /// The joint forces (∂e/∂v)ᵀ p against the `loads` p = k e of springs, where v are the velocities; `None` of
    /// velocities on which no spring acts. `isotropic` are the springs if all of a rotation have one stiffness.
    ///
    /// A rotation vector φ has the rate φ' = J⁻¹ ω with the right Jacobian J(φ) of SO(3), whose inverse transposed is that
    /// of the left one. Of loads along φ, those of isotropic springs, it makes the loads themselves.
    pub fn forces(&self, loads: [Option<S>; MOST_FREEDOMS], isotropic: bool) -> [Option<S>; MOST_FREEDOMS] {
        match self {
            Stretch::Coordinate(_) => loads,
            Stretch::Rotation(rotation) => {
                let [x, y, z, ..] = loads;
                let [x, y, z] = moments(rotation, [x, y, z], isotropic);
                [x, y, z, None, None, None]
            }
            Stretch::Motion { rotation, axes, .. } => {
                let [fx, fy, fz, x, y, z] = loads;
                let [fx, fy, fz] = transformed([fx, fy, fz], |force| axes.transpose() * force);
                let [x, y, z] = moments(rotation, [x, y, z], isotropic);
                [fx, fy, fz, x, y, z]
            }
        }
    }
}

fn moments<S: Scalar>(rotation: &Logarithm<S>, loads: [Option<S>; 3], isotropic: bool) -> [Option<S>; 3] {
    if isotropic { loads } else { transformed(loads, |moment| rotation.velocity(moment)) }
}

fn transformed<S: Scalar>(loads: [Option<S>; 3], f: impl Fn(Vec3<S>) -> Vec3<S>) -> [Option<S>; 3] {
    if loads.iter().all(Option::is_none) {
        return loads;
    }
    f(Vec3(loads.map(|load| load.unwrap_or(S::zero())))).0.map(Some)
}
