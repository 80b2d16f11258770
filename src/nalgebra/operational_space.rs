//! Operational space over vectors and matrices.

use ::nalgebra::{SMatrix, SVector};

use super::{Number, array, matrix, rows};
use crate::{OperationalSpaceError, Real, TaskStatus};

type OverArrays<S, const R: usize, const NV: usize> = crate::OperationalSpace<S, [S; NV], [[S; NV]; NV], [[S; NV]; R]>;

/// [`OperationalSpace`](crate::OperationalSpace) over nalgebra's vectors and matrices: the dynamics of a task with
/// velocity ẋ = J v, from the mass matrix M (NV × NV) and a Jacobian J (R × NV) of any rank.
///
/// Λ, J̄ and N, and what they are at singular positions, are explained there.
///
/// ```
/// use nalgebra::{Vector3, Vector6};
/// use redysim::nalgebra::{self as dynamics, OperationalSpace};
/// use redysim::{TaskStatus, redysim};
///
/// redysim! { struct Kr5("models/kr5_tool.toml"); }
///
/// let q = Vector6::new(0.1, 0.7, -0.4, 0.3, 0.9, -0.2);
/// let [jacobian] = dynamics::frame_jacobians(&Kr5, &q);
/// // The task is where the tip is, not how the tool points.
/// let linear = jacobian.fixed_rows::<3>(0).into_owned();
/// let mass_matrix = dynamics::mass_matrix(&Kr5, &q);
/// let tip = OperationalSpace::new(&mass_matrix, &linear)?;
/// assert_eq!(tip.status(), TaskStatus::Full);
/// // Joint forces that accelerate the tip by 1 m/s² upwards, from rest.
/// let up = Vector3::z();
/// let tau = tip.joint_force(&tip.force_of_acceleration(&up)) + dynamics::gravity_forces(&Kr5, &q);
/// let a = dynamics::forward_dynamics(&Kr5, &q, &Vector6::zeros(), &tau);
/// assert!((linear * a - up).norm() < 1e-12);
/// # Ok::<(), redysim::OperationalSpaceError>(())
/// ```
#[derive(Clone)]
pub struct OperationalSpace<S: Number + Real, const R: usize, const NV: usize>(OverArrays<S, R, NV>);

impl<S: Number + Real, const R: usize, const NV: usize> OperationalSpace<S, R, NV> {
    /// The operational space of the mass matrix M, of which the lower triangle is read, and the Jacobian J.
    ///
    /// # Errors
    /// If M is not positive definite, or J not finite.
    pub fn new(mass_matrix: &SMatrix<S, NV, NV>, jacobian: &SMatrix<S, R, NV>) -> Result<Self, OperationalSpaceError> {
        crate::OperationalSpace::new(rows(mass_matrix), rows(jacobian)).map(Self)
    }

    /// As [`new`](Self::new), with another part of the longest row below which a row counts as dependent.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_tolerance(
        mass_matrix: &SMatrix<S, NV, NV>,
        jacobian: &SMatrix<S, R, NV>,
        tolerance: S,
    ) -> Result<Self, OperationalSpaceError> {
        crate::OperationalSpace::with_tolerance(rows(mass_matrix), rows(jacobian), tolerance).map(Self)
    }

    /// The number of directions in which the task can move.
    pub fn rank(&self) -> usize {
        self.0.rank()
    }

    /// Whether the task can move in all its directions.
    pub fn status(&self) -> TaskStatus {
        self.0.status()
    }

    /// The operational-space inertia Λ = (J M⁻¹ Jᵀ)⁻¹.
    pub fn inertia(&self) -> SMatrix<S, R, R> {
        matrix(self.0.inertia())
    }

    /// The dynamically consistent inverse J̄ = M⁻¹ Jᵀ Λ.
    pub fn inverse(&self) -> SMatrix<S, NV, R> {
        matrix(self.0.inverse())
    }

    /// The null-space projector N = 1 − J̄ J of velocities and accelerations. That of joint forces is its transpose.
    pub fn projector(&self) -> SMatrix<S, NV, NV> {
        matrix(self.0.projector())
    }

    /// Λ ẍ: the task's force that gives it the acceleration `acceleration`, where it moves freely.
    pub fn force_of_acceleration(&self, acceleration: &SVector<S, R>) -> SVector<S, R> {
        self.0.force_of_acceleration(array(acceleration)).into()
    }

    /// J̄ ẋ: the joint velocities, or accelerations, of least kinetic energy that move the task by `task`.
    pub fn joint_velocity(&self, task: &SVector<S, R>) -> SVector<S, NV> {
        self.0.joint_velocity(array(task)).into()
    }

    /// J̄ᵀ τ: the force on the task that has the effect of the joint forces `tau` on it.
    pub fn task_force(&self, tau: &SVector<S, NV>) -> SVector<S, R> {
        self.0.task_force(array(tau)).into()
    }

    /// Jᵀ f: the joint forces that have the effect of the force `task` on the task.
    pub fn joint_force(&self, task: &SVector<S, R>) -> SVector<S, NV> {
        self.0.joint_force(array(task)).into()
    }

    /// J v: the velocity of the task.
    pub fn task_velocity(&self, v: &SVector<S, NV>) -> SVector<S, R> {
        self.0.task_velocity(array(v)).into()
    }

    /// N v: the part of a velocity, or acceleration, that does not move the task.
    pub fn null_velocity(&self, v: &SVector<S, NV>) -> SVector<S, NV> {
        self.0.null_velocity(array(v)).into()
    }

    /// Nᵀ τ: the part of joint forces that does not accelerate the task.
    pub fn null_force(&self, tau: &SVector<S, NV>) -> SVector<S, NV> {
        self.0.null_force(array(tau)).into()
    }

    /// J J̄ ẋ: the part of a task's velocity, or acceleration, that is attainable; all of it if the status is full.
    pub fn attainable(&self, task: &SVector<S, R>) -> SVector<S, R> {
        self.0.attainable(array(task)).into()
    }
}
