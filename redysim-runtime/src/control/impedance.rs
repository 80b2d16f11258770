//! Impedance control of a frame.

use super::rotation_vector::rotation_vector;
use crate::linear_algebra::{add_scaled, dot, product, zeros};
use crate::vector::entry;
use crate::{
    BiasForces, ConfigurationSpace, FrameState, Frames, GravityForces, LengthMismatch, MassMatrix, OperationalSpace,
    Real, TorqueLaw, Vector, Wrench,
};

/// The desired motion of a frame. Implemented by closures `Fn(S) -> FrameState<S>` and, as a constant, by
/// [`FrameState`].
pub trait FrameTrajectory<S> {
    /// Position and velocity of the frame at time `t`, s, in the base frame.
    fn at(&self, t: S) -> FrameState<S>;
}

impl<S: Clone> FrameTrajectory<S> for FrameState<S> {
    fn at(&self, _t: S) -> FrameState<S> {
        self.clone()
    }
}

impl<S, F: Fn(S) -> FrameState<S>> FrameTrajectory<S> for F {
    fn at(&self, t: S) -> FrameState<S> {
        self(t)
    }
}

/// Gains along and about the axes of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct FrameGains<S> {
    /// Of displacements, N/m, or of velocities, N s/m.
    pub linear: [S; 3],
    /// Of rotations, N m/rad, or of angular velocities, N m s/rad.
    pub angular: [S; 3],
}

/// What a law adds to its feedback from the model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
pub enum Compensation {
    /// g(q), the [gravity forces](GravityForces). The robot with the law is passive: its kinetic energy and that of the
    /// spring change by the work of other forces, less what the damping takes. Springs and other passive forces of the
    /// robot are not compensated: the static deflection K⁻¹ F holds without springs.
    #[default]
    Gravity,
    /// The whole [bias](BiasForces): Coriolis and centrifugal forces, gravity, and what damping, friction and springs
    /// take. The accelerations are those of the feedback alone, Λ ẍ = F for a task of constant Jacobian.
    Bias,
}

/// Impedance control: springs and dampers tie a frame of the robot to another that is where it should be.
///
/// The forces are (N. Hogan, *Impedance control: an approach to manipulation*, J. Dyn. Syst. Meas. Control 107, 1985)
///
/// F = K (x_d − x) + D (ẋ_d − ẋ), m = K_r φ + D_r (ω_d − ω), τ = Jᵀ [F; m] + c(q, v) − d Nᵀ M v.
///
/// x and ω are the position of the frame's origin and its angular velocity in the base frame, φ is the rotation vector of
/// R_d Rᵀ (|φ| ≤ π), about which the frame is to turn. The gains are diagonal in the axes of the desired frame: K stands
/// for R_d diag(k) R_dᵀ. Under a constant wrench the frame rests off its place by K⁻¹ F and K_r⁻¹ m. The springs have
/// the potential ½ (x_d − x)ᵀ K (x_d − x) + ½ κ φᵀ φ where the three rotational gains are one number κ; where they
/// differ, their moment is a gradient for small rotations only.
///
/// c(q, v) is the [`Compensation`]. J is the [frame's Jacobian](crate::FrameJacobian), M the mass matrix.
///
/// The last term damps motions that leave alone what has gains: N is the
/// [null-space projector](crate::OperationalSpace::projector) of the directions with a stiffness or a damping, and where
/// J loses rank, of those that are attainable. It acts as −d M N v, so that it takes energy from these motions,
/// 2 d times theirs in a unit of time, and accelerates nothing else. It matters for robots with more joints than the
/// task needs.
///
/// `mechanism` is the robot as the controller knows it, which may be another type than the one that moves, for example
/// with an assumed payload.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impedance<'m, S, M, X> {
    /// The mechanism as the controller knows it.
    pub mechanism: &'m M,
    /// Which of its frames, counted from 0 as in [`frame_name`](crate::Mechanism::frame_name).
    pub frame: usize,
    /// Where the frame should be.
    pub target: X,
    /// K and K_r.
    pub stiffness: FrameGains<S>,
    /// D and D_r.
    pub damping: FrameGains<S>,
    /// c(q, v).
    pub compensation: Compensation,
    /// d, 1/s; zero for none.
    pub null_space_damping: S,
}

impl<S: Real, M, X: FrameTrajectory<S>> Impedance<'_, S, M, X> {
    /// The wrench of springs and dampers on the frame in the state `state` at time `t`: at the frame's origin, in the
    /// axes of the base frame.
    pub fn wrench(&self, t: S, state: &FrameState<S>) -> Wrench<S> {
        let target = self.target.at(t);
        let apart = |to: [S; 3], from: [S; 3]| [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
        // R_d Rᵀ
        let turn = target.rotation.map(|to| state.rotation.map(|from| dot(&to, &from)));
        let part = |stiffness: [S; 3], displacement: [S; 3], damping: [S; 3], velocity: [S; 3]| {
            let mut wrench = [S::zero(); 3];
            for (axis, (k, d)) in stiffness.into_iter().zip(damping).enumerate() {
                let direction = target.rotation.map(|row| entry(&row, axis));
                let size = k * dot(&direction, &displacement) + d * dot(&direction, &velocity);
                add_scaled(&mut wrench, size, &direction);
            }
            wrench
        };
        let (stiffness, damping) = (&self.stiffness, &self.damping);
        Wrench {
            force: part(
                stiffness.linear,
                apart(target.origin, state.origin),
                damping.linear,
                apart(target.velocity, state.velocity),
            ),
            moment: part(
                stiffness.angular,
                rotation_vector(&turn),
                damping.angular,
                apart(target.angular_velocity, state.angular_velocity),
            ),
        }
    }

    /// The rows of the Jacobian, given by `linear` and `angular` rows in base axes, along the axes of the desired frame
    /// that have gains; rows of zeros for the others.
    fn task<V: Vector<S>>(&self, t: S, linear: &[V; 3], angular: &[V; 3], nv: usize) -> [V; 6] {
        let rotation = self.target.at(t).rotation;
        let row = |rows: &[V; 3], axis: usize, stiffness: &[S; 3], damping: &[S; 3]| {
            let mut sum: V = zeros(nv);
            if entry(stiffness, axis) != S::zero() || entry(damping, axis) != S::zero() {
                for (row, of_axes) in rows.iter().zip(&rotation) {
                    add_scaled(sum.as_mut(), entry(of_axes, axis), row.as_ref());
                }
            }
            sum
        };
        let (stiffness, damping) = (&self.stiffness, &self.damping);
        let [x, y, z] = [0, 1, 2].map(|axis| row(linear, axis, &stiffness.linear, &damping.linear));
        let [rx, ry, rz] = [0, 1, 2].map(|axis| row(angular, axis, &stiffness.angular, &damping.angular));
        [x, y, z, rx, ry, rz]
    }
}

impl<S, M, N, X> TorqueLaw<S, M> for Impedance<'_, S, N, X>
where
    S: Real,
    M: ConfigurationSpace<S>,
    N: Frames<S, Coordinates = M::Coordinates, Velocities = M::Velocities>
        + GravityForces<S>
        + BiasForces<S>
        + MassMatrix<S>,
    X: FrameTrajectory<S>,
{
    /// Returns NaN if the frame does not exist or, with null-space damping, if [`OperationalSpace::new`] fails (mass
    /// matrix not positive definite, or Jacobian not finite).
    fn torque(&mut self, _mechanism: &M, t: S, q: &M::Coordinates, v: &M::Velocities) -> M::Velocities {
        let nv = self.mechanism.nv();
        let not_a_number = || M::Velocities::from_fn(nv, |_| S::from_f64(f64::NAN));
        let (states, jacobians) = (self.mechanism.frame_kinematics(q, v), self.mechanism.frame_jacobians(q));
        let (Some(state), Some(jacobian)) = (states.as_ref().get(self.frame), jacobians.as_ref().get(self.frame))
        else {
            return not_a_number();
        };
        let mut tau = match self.compensation {
            Compensation::Gravity => self.mechanism.gravity_forces(q),
            Compensation::Bias => self.mechanism.bias_forces(q, v),
        };
        let Wrench { force, moment } = self.wrench(t, state);
        for (row, component) in jacobian.linear.iter().zip(force).chain(jacobian.angular.iter().zip(moment)) {
            add_scaled(tau.as_mut(), component, row.as_ref());
        }
        if self.null_space_damping != S::zero() {
            let mass_matrix = self.mechanism.mass_matrix(q);
            let task = self.task(t, &jacobian.linear, &jacobian.angular, nv);
            let Ok(space) = OperationalSpace::new(mass_matrix.clone(), task) else { return not_a_number() };
            let momentum: M::Velocities = product(mass_matrix.as_ref(), space.null_velocity(v).as_ref());
            add_scaled(tau.as_mut(), -self.null_space_damping, momentum.as_ref());
        }
        tau
    }

    fn check_lengths(&self, _t: S, _mechanism: &M) -> Result<(), LengthMismatch> {
        let length = self.mechanism.nf();
        let expected = self.frame.saturating_add(1);
        if self.frame < length { Ok(()) } else { Err(LengthMismatch { vector: "frames", length, expected }) }
    }
}
