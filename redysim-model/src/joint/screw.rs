//! The motion of one freedom of a joint, about and along an axis of the body's frame.

use crate::spatial::{Twist, Vec3, Wrench};
use redysim_runtime::Scalar;

/// A column (turn e; slide e) of the motion subspace S of a joint, where e is an axis of the body's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screw {
    /// The axis e: 0 for x, 1 for y, 2 for z.
    pub axis: usize,
    /// Rotation about the axis for a unit of the velocity.
    pub turn: f64,
    /// Displacement along the axis for a unit of the velocity.
    pub slide: f64,
}

impl Screw {
    /// A rotation about an axis.
    pub const fn rotation(axis: usize) -> Screw {
        Screw { axis, turn: 1.0, slide: 0.0 }
    }

    /// A displacement along an axis.
    pub const fn translation(axis: usize) -> Screw {
        Screw { axis, turn: 0.0, slide: 1.0 }
    }

    /// How much of `x` is rotation about the axis; `None` if the screw does not turn.
    #[inline]
    pub fn turn<S: Scalar>(self, x: S) -> Option<S> {
        times(self.turn, x)
    }

    /// How much of `x` is displacement along the axis; `None` if the screw does not slide.
    #[inline]
    pub fn slide<S: Scalar>(self, x: S) -> Option<S> {
        times(self.slide, x)
    }

    /// Which of the six axes (angular x, y, z, linear x, y, z) S is, if it is one.
    #[inline]
    pub fn unit_axis(self) -> Option<usize> {
        match (self.turn, self.slide) {
            (1.0, 0.0) => Some(self.axis),
            (0.0, 1.0) => Some(self.axis + 3),
            _ => None,
        }
    }

    /// The wrench for a unit of the velocity, of those for a unit rotation and a unit displacement.
    #[inline]
    pub fn combined<S: Scalar>(self, turn: Wrench<S>, slide: Wrench<S>) -> Wrench<S> {
        match self.unit_axis() {
            Some(0..3) => turn,
            Some(_) => slide,
            None => turn.scale(S::from_f64(self.turn)) + slide.scale(S::from_f64(self.slide)),
        }
    }

    /// S as a motion at the body's origin.
    #[inline]
    pub fn motion<S: Scalar>(self) -> Twist<S> {
        self.motion_at(Vec3::zero())
    }

    /// The motion of a point at `arm` from the joint's origin, for a unit of the velocity.
    #[inline]
    pub fn motion_at<S: Scalar>(self, arm: Vec3<S>) -> Twist<S> {
        let mut motion = Twist::zero();
        motion.angular[self.axis] = S::from_f64(self.turn);
        if let Some(turn) = self.turn(S::one()) {
            motion.linear = across(self.axis, arm).scale(turn);
        }
        motion.linear[self.axis] = S::from_f64(self.slide);
        motion
    }

    /// Sᵀ w, the joint force of a wrench about a point of the axis, in axes in which the screw's is `axis`.
    #[inline]
    pub fn project_along<S: Scalar>(self, axis: Vec3<S>, wrench: Wrench<S>) -> S {
        let [turn, slide] = [self.turn(wrench.moment.fused_dot(axis)), self.slide(wrench.force.fused_dot(axis))];
        turn.unwrap_or(S::zero()) + slide.unwrap_or(S::zero())
    }

    /// Sᵀ w, the joint force of a wrench.
    #[inline]
    pub fn project<S: Scalar>(self, wrench: Wrench<S>) -> S {
        match (self.turn(wrench.moment[self.axis]), self.slide(wrench.force[self.axis])) {
            (Some(moment), Some(force)) => moment + force,
            (Some(component), None) | (None, Some(component)) => component,
            (None, None) => S::zero(),
        }
    }

    /// `twist` + S `x`, for a velocity or an acceleration `x`.
    #[inline]
    pub fn added<S: Scalar>(self, mut twist: Twist<S>, x: S) -> Twist<S> {
        if let Some(turn) = self.turn(x) {
            twist.angular[self.axis] += turn;
        }
        if let Some(slide) = self.slide(x) {
            twist.linear[self.axis] += slide;
        }
        twist
    }

    /// The bias acceleration of a joint with this freedom alone, (ω × turn; 2 ω × slide) for the velocity `qd`, where the parent's angular
    /// velocity is `angular` in the body's axes.
    #[inline]
    pub fn bias<S: Scalar>(self, angular: Vec3<S>, qd: S) -> Twist<S> {
        let of = |along: S| (-across(self.axis, angular)).scale(along);
        Twist {
            angular: self.turn(qd).map_or(Vec3::zero(), of),
            linear: self.slide(qd).map_or(Vec3::zero(), |slide| of(slide + slide)),
        }
    }

    /// `wrench` with the joint force set to `force`, its exact value.
    #[inline]
    pub fn with_force<S: Scalar>(self, mut wrench: Wrench<S>, force: S) -> Wrench<S> {
        match self.unit_axis() {
            Some(axis) => *wrench.component_mut(axis) = force,
            None => {
                let missing = force - self.project(wrench);
                wrench.moment[self.axis] += missing * S::from_f64(1.0 / self.turn);
            }
        }
        wrench
    }
}

/// e × v, where e is an axis.
#[inline]
pub fn across<S: Scalar>(axis: usize, v: Vec3<S>) -> Vec3<S> {
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut product = Vec3::zero();
    (product[next], product[last]) = (-v[last], v[next]);
    product
}

#[inline]
fn times<S: Scalar>(coefficient: f64, x: S) -> Option<S> {
    match coefficient {
        0.0 => None,
        1.0 => Some(x),
        other => Some(S::from_f64(other) * x),
    }
}
