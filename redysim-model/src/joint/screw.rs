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
    #[inline(always)]
    pub fn turn<S: Scalar>(self, x: S) -> Option<S> {
        times(self.turn, x)
    }

    /// How much of `x` is displacement along the axis; `None` if the screw does not slide.
    #[inline(always)]
    pub fn slide<S: Scalar>(self, x: S) -> Option<S> {
        times(self.slide, x)
    }

    /// Which of the six axes (angular x, y, z, linear x, y, z) S is, if it is one.
    #[inline(always)]
    pub fn unit_axis(self) -> Option<usize> {
        match (self.turn, self.slide) {
            (1.0, 0.0) => Some(self.axis),
            (0.0, 1.0) => Some(self.axis + 3),
            _ => None,
        }
    }

    /// The wrench for a unit of the velocity, of those for a unit rotation and a unit displacement.
    #[inline(always)]
    pub fn combined<S: Scalar>(self, turn: Wrench<S>, slide: Wrench<S>) -> Wrench<S> {
        match self.unit_axis() {
            Some(0..3) => turn,
            Some(_) => slide,
            None => turn.scale(S::from_f64(self.turn)) + slide.scale(S::from_f64(self.slide)),
        }
    }

    /// S as a motion at the body's origin.
    #[inline(always)]
    pub fn motion<S: Scalar>(self) -> Twist<S> {
        self.motion_at(Vec3::zero())
    }

    /// The motion of a point at `arm` from the joint's origin, for a unit of the velocity.
    #[inline(always)]
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
    #[inline(always)]
    pub fn project_along<S: Scalar>(self, axis: Vec3<S>, wrench: Wrench<S>) -> S {
        let [turn, slide] = [self.turn(wrench.moment.fused_dot(axis)), self.slide(wrench.force.fused_dot(axis))];
        turn.unwrap_or(S::zero()) + slide.unwrap_or(S::zero())
    }

    /// Sᵀ w, the joint force of a wrench.
    #[inline(always)]
    pub fn project<S: Scalar>(self, wrench: Wrench<S>) -> S {
        match (self.turn(wrench.moment.component(self.axis)), self.slide(wrench.force.component(self.axis))) {
            (Some(moment), Some(force)) => moment + force,
            (Some(component), None) | (None, Some(component)) => component,
            (None, None) => S::zero(),
        }
    }

    /// `twist` + S `x`, for a velocity or an acceleration `x`.
    #[inline(always)]
    pub fn added<S: Scalar>(self, Twist { angular, linear }: Twist<S>, x: S) -> Twist<S> {
        let plus = |v: Vec3<S>, along: Option<S>| {
            along.map_or(v, |along| v.with_component(self.axis, v.component(self.axis) + along))
        };
        Twist { angular: plus(angular, self.turn(x)), linear: plus(linear, self.slide(x)) }
    }

    /// The bias acceleration of a joint with this freedom alone, (ω × turn; 2 ω × slide) for the velocity `qd`, where the parent's angular
    /// velocity is `angular` in the body's axes.
    #[inline(always)]
    pub fn bias<S: Scalar>(self, angular: Vec3<S>, qd: S) -> Twist<S> {
        let of = |along: S| (-across(self.axis, angular)).scale(along);
        Twist {
            angular: self.turn(qd).map_or(Vec3::zero(), of),
            linear: self.slide(qd).map_or(Vec3::zero(), |slide| of(slide + slide)),
        }
    }

    /// The wrench with its projection on S set to `along`, the exact joint force.
    #[inline(always)]
    pub fn with_force<S: Scalar>(self, Wrench { moment, force }: Wrench<S>, along: S) -> Wrench<S> {
        match self.unit_axis() {
            Some(axis) => Wrench { moment, force }.with_component(axis, along),
            None => {
                let missing = along - self.project(Wrench { moment, force });
                let turn = moment.component(self.axis) + missing * S::from_f64(1.0 / self.turn);
                Wrench { moment: moment.with_component(self.axis, turn), force }
            }
        }
    }
}

/// e × v, where e is an axis.
#[inline(always)]
pub fn across<S: Scalar>(axis: usize, v: Vec3<S>) -> Vec3<S> {
    let Vec3([x, y, z]) = v;
    match axis {
        0 => Vec3([S::zero(), -z, y]),
        1 => Vec3([z, S::zero(), -x]),
        _ => Vec3([-y, x, S::zero()]),
    }
}

#[inline(always)]
fn times<S: Scalar>(coefficient: f64, x: S) -> Option<S> {
    match coefficient {
        0.0 => None,
        1.0 => Some(x),
        other => Some(S::from_f64(other) * x),
    }
}
