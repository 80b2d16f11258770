//! The motion of a joint with one freedom, about and along z.

use crate::spatial::{Twist, Vec3, Wrench};
use redysim_runtime::Scalar;

/// The motion subspace S = (turn e₃; slide e₃) of a joint with one freedom, in its body's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screw {
    /// Rotation about z for a unit of the coordinate.
    pub turn: f64,
    /// Displacement along z for a unit of the coordinate.
    pub slide: f64,
}

impl Screw {
    /// How much of `x` is rotation about z; `None` if the joint does not turn.
    #[inline]
    pub fn turn<S: Scalar>(self, x: S) -> Option<S> {
        times(self.turn, x)
    }

    /// How much of `x` is displacement along z; `None` if the joint does not slide.
    #[inline]
    pub fn slide<S: Scalar>(self, x: S) -> Option<S> {
        times(self.slide, x)
    }

    /// Which of the six axes (angular x, y, z, linear x, y, z) S is, if it is one.
    #[inline]
    pub fn unit_axis(self) -> Option<usize> {
        match (self.turn, self.slide) {
            (1.0, 0.0) => Some(2),
            (0.0, 1.0) => Some(5),
            _ => None,
        }
    }

    /// The wrench for a unit of the coordinate, of those for a unit rotation and a unit displacement.
    #[inline]
    pub fn combined<S: Scalar>(self, turn: Wrench<S>, slide: Wrench<S>) -> Wrench<S> {
        match self.unit_axis() {
            Some(2) => turn,
            Some(_) => slide,
            None => turn.scale(S::from_f64(self.turn)) + slide.scale(S::from_f64(self.slide)),
        }
    }

    /// S as a motion at the body's origin.
    #[inline]
    pub fn motion<S: Scalar>(self) -> Twist<S> {
        self.motion_at(Vec3::zero())
    }

    /// The motion of a point at `arm` from the joint's origin, for a unit of the coordinate.
    #[inline]
    pub fn motion_at<S: Scalar>(self, arm: Vec3<S>) -> Twist<S> {
        let across = |x: S| self.turn(x).unwrap_or(S::zero());
        let (turn, slide) = (S::from_f64(self.turn), S::from_f64(self.slide));
        Twist { angular: Vec3([S::zero(), S::zero(), turn]), linear: Vec3([-across(arm[1]), across(arm[0]), slide]) }
    }

    /// Sᵀ w, the joint force of a wrench about a point of the axis, in axes in which the joint's is `axis`.
    #[inline]
    pub fn project_along<S: Scalar>(self, axis: Vec3<S>, wrench: Wrench<S>) -> S {
        let [turn, slide] = [self.turn(wrench.moment.dot(axis)), self.slide(wrench.force.dot(axis))];
        turn.unwrap_or(S::zero()) + slide.unwrap_or(S::zero())
    }

    /// Sᵀ w, the joint force of a wrench.
    #[inline]
    pub fn project<S: Scalar>(self, wrench: Wrench<S>) -> S {
        match (self.turn(wrench.moment[2]), self.slide(wrench.force[2])) {
            (Some(moment), Some(force)) => moment + force,
            (Some(component), None) | (None, Some(component)) => component,
            (None, None) => S::zero(),
        }
    }

    /// `twist` + S `x`, for a velocity or an acceleration `x` of the joint.
    #[inline]
    pub fn added<S: Scalar>(self, mut twist: Twist<S>, x: S) -> Twist<S> {
        if let Some(turn) = self.turn(x) {
            twist.angular[2] += turn;
        }
        if let Some(slide) = self.slide(x) {
            twist.linear[2] += slide;
        }
        twist
    }

    /// The bias acceleration of the joint, (ω × turn; 2 ω × slide) for the velocity `qd`, where the parent's angular
    /// velocity is `angular` in the body's axes.
    #[inline]
    pub fn bias<S: Scalar>(self, angular: Vec3<S>, qd: S) -> Twist<S> {
        let [x, y, _] = angular.0;
        let across = |along: S| Vec3([y * along, -(x * along), S::zero()]);
        Twist {
            angular: self.turn(qd).map_or(Vec3::zero(), across),
            linear: self.slide(qd).map_or(Vec3::zero(), |slide| across(slide + slide)),
        }
    }

    /// `wrench` with the joint force set to `force`, its exact value.
    #[inline]
    pub fn with_force<S: Scalar>(self, mut wrench: Wrench<S>, force: S) -> Wrench<S> {
        match self.unit_axis() {
            Some(axis) => *wrench.component_mut(axis) = force,
            None => {
                let missing = force - self.project(wrench);
                wrench.moment[2] += missing * S::from_f64(1.0 / self.turn);
            }
        }
        wrench
    }
}

#[inline]
fn times<S: Scalar>(coefficient: f64, x: S) -> Option<S> {
    match coefficient {
        0.0 => None,
        1.0 => Some(x),
        other => Some(S::from_f64(other) * x),
    }
}
