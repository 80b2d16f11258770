//! Operational space: the dynamics of a task, such as the motion of a tool, and the motions that leave it alone.

use core::fmt;

use crate::linear_algebra::{
    MassMetric, NotFinite, NotPositiveDefinite, RowSet, WeightedRows, add_scaled, product, rank_tolerance, zeros,
};
use crate::vector::entry;
use crate::{Real, Vector};

/// A vector over the rows of the Jacobian `J`, whose rows are `V`: `[S; m]`.
type Rows<S, V, J> = <J as Vector<V>>::Of<S>;
/// A square matrix over them, by rows: `[[S; m]; m]`.
type Square<S, V, J> = <J as Vector<V>>::Of<Rows<S, V, J>>;
/// J in the metric of M.
type Weighted<S, V, A, J> = WeightedRows<S, V, Rows<S, V, J>, A, J, Square<S, V, J>>;

/// The dynamics of a task with velocity ẋ = J v at one position, from the mass matrix M and the Jacobian J (m × NV).
///
/// | function | formula | what it is |
/// |---|---|---|
/// | [`inertia`](Self::inertia) | Λ = (J M⁻¹ Jᵀ)⁻¹ | operational-space inertia: the force f = Λ ẍ that accelerates the task |
/// | [`inverse`](Self::inverse) | J̄ = M⁻¹ Jᵀ Λ | dynamically consistent inverse: J J̄ = 1, of all v with J v = ẋ the one of least kinetic energy |
/// | [`projector`](Self::projector) | N = 1 − J̄ J | null-space projector of velocities and accelerations: J N = 0, N² = N |
/// | its transpose | Nᵀ = 1 − Jᵀ J̄ᵀ | the same of joint forces: J M⁻¹ Nᵀ = 0, they do not accelerate the task |
///
/// Kinetic energy splits: vᵀ M v = ẋᵀ Λ ẋ + (N v)ᵀ M (N v). Source: O. Khatib, *A unified approach for motion and force
/// control of robot manipulators: the operational space formulation*, IEEE J. Robotics and Automation 3 (1987).
///
/// # Singular positions and redundant rows
///
/// J may have any rank. [`rank`](Self::rank) is the number of directions that the task can move in, and
/// [`status`](Self::status) names the rows that depend on others. Then Λ and J̄ are those of the attainable directions:
/// the Moore-Penrose inverse of J M⁻¹ Jᵀ, and the inverse for which J J̄ is the orthogonal projector onto the attainable
/// directions; N keeps its properties. Between two positions of different rank, Λ and J̄ jump.
///
/// A direction counts as unattainable where what remains of a row of J, in the metric of M⁻¹, when its dependence on
/// other rows is taken away, is at most 10⁻⁵ of the longest row (`f32`: 3.5·10⁻⁴). Controllers do well to leave a
/// direction earlier, since forces of the size 1/remainder² act in it: [`with_tolerance`](Self::with_tolerance).
///
/// Rows of J are in any units; the task's forces are in those for which force times velocity is power. Of a
/// [`FrameJacobian`](crate::FrameJacobian) [`rows`](crate::FrameJacobian::rows) has all six, in the base frame's axes.
///
/// ```
/// use redysim_runtime::{OperationalSpace, TaskStatus};
///
/// // Two masses of 2 kg and 3 kg on a rail; the task is where their centre is.
/// let masses = [[2.0, 0.0], [0.0, 3.0]];
/// let task = OperationalSpace::new(masses, [[0.4, 0.6]])?;
/// assert_eq!(task.status(), TaskStatus::Full);
/// let [[inertia]] = task.inertia();
/// assert!((inertia - 5.0_f64).abs() < 1e-12);
/// // What leaves the centre where it is: the masses move apart, as 3 : 2.
/// let [first, second] = task.null_velocity(&[1.0, 0.0]);
/// assert!((first - 0.6_f64).abs() < 1e-12 && (second + 0.4_f64).abs() < 1e-12);
/// # Ok::<(), redysim_runtime::OperationalSpaceError>(())
/// ```
#[derive(Clone)]
pub struct OperationalSpace<S: Real, V: Vector<S>, A: Vector<V>, J: Vector<V>> {
    jacobian: J,
    weighted: Weighted<S, V, A, J>,
}

/// Whether a task can move in all its directions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TaskStatus {
    /// In all of them.
    Full,
    /// In fewer directions than the Jacobian has rows.
    Deficient {
        /// In how many.
        rank: usize,
        /// The rows of the Jacobian that depend on the others.
        rows: RowSet,
    },
}

/// Why there is no operational space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum OperationalSpaceError {
    /// The mass matrix is not positive definite.
    SingularInertia {
        /// The velocity of the first pivot that is not positive.
        velocity: usize,
    },
    /// An element of the Jacobian, or of what the mass matrix makes of it, is infinite or not a number.
    NotFinite,
}

impl fmt::Display for OperationalSpaceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SingularInertia { velocity } => write!(
                f,
                "the mass matrix is not positive definite at velocity {velocity}; give the links that its joint moves \
                 a mass and an inertia"
            ),
            Self::NotFinite => f.write_str(
                "an element of the Jacobian is infinite or not a number; look at the position that it is of",
            ),
        }
    }
}

impl core::error::Error for OperationalSpaceError {}

impl From<NotPositiveDefinite> for OperationalSpaceError {
    fn from(NotPositiveDefinite { velocity }: NotPositiveDefinite) -> Self {
        Self::SingularInertia { velocity }
    }
}

impl From<NotFinite> for OperationalSpaceError {
    fn from(_: NotFinite) -> Self {
        Self::NotFinite
    }
}

impl<S: Real, V: Vector<S>, A: Vector<V>, J: Vector<V>> OperationalSpace<S, V, A, J> {
    /// The operational space of the mass matrix M, of which the lower triangle is looked at, and the Jacobian J, both by
    /// rows.
    ///
    /// # Errors
    /// If M is not positive definite, or J not finite.
    pub fn new(mass_matrix: A, jacobian: J) -> Result<Self, OperationalSpaceError> {
        Self::with_tolerance(mass_matrix, jacobian, rank_tolerance())
    }

    /// As [`new`](Self::new), with another part of the longest row below which a row counts as dependent.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn with_tolerance(mass_matrix: A, jacobian: J, tolerance: S) -> Result<Self, OperationalSpaceError> {
        let count = mass_matrix.as_ref().len();
        let weighted = WeightedRows::new(MassMetric::new(mass_matrix)?, jacobian.clone(), count, tolerance)?;
        Ok(Self { jacobian, weighted })
    }

    /// The number of velocities.
    fn nv(&self) -> usize {
        self.weighted.decomposition.count()
    }

    /// The number of rows of J.
    fn len(&self) -> usize {
        self.jacobian.as_ref().len()
    }

    /// In how many directions the task can move.
    pub fn rank(&self) -> usize {
        self.weighted.decomposition.rank()
    }

    /// Whether the task can move in all its directions.
    pub fn status(&self) -> TaskStatus {
        let rank = self.rank();
        if rank == self.len() {
            return TaskStatus::Full;
        }
        TaskStatus::Deficient { rank, rows: self.weighted.decomposition.dependent_rows() }
    }

    /// The operational-space inertia Λ = (J M⁻¹ Jᵀ)⁻¹, by rows: symmetric; `[[S; m]; m]`.
    pub fn inertia(&self) -> Square<S, V, J> {
        Square::<S, V, J>::from_fn(self.len(), |i| self.force_of_acceleration(&self.unit(i)))
    }

    /// The dynamically consistent inverse J̄ = M⁻¹ Jᵀ Λ, by rows: `[[S; m]; NV]`.
    pub fn inverse(&self) -> V::Of<Rows<S, V, J>> {
        let mut inverse = V::Of::<Rows<S, V, J>>::from_fn(self.nv(), |_| zeros(self.len()));
        for column in 0..self.len() {
            let joint = self.joint_velocity(&self.unit(column));
            for (row, &value) in inverse.as_mut().iter_mut().zip(joint.as_ref()) {
                if let Some(element) = row.as_mut().get_mut(column) {
                    *element = value;
                }
            }
        }
        inverse
    }

    /// The null-space projector N = 1 − J̄ J of velocities and accelerations, by rows: `[[S; NV]; NV]`. That of joint
    /// forces is its transpose.
    pub fn projector(&self) -> A {
        let nv = self.nv();
        // Row i of N is Nᵀ applied to the force eᵢ.
        A::from_fn(nv, |i| self.null_force(&V::from_fn(nv, |j| if i == j { S::one() } else { S::zero() })))
    }

    /// Λ ẍ: the task's force that gives it the acceleration `acceleration`, where it moves freely.
    pub fn force_of_acceleration(&self, acceleration: &Rows<S, V, J>) -> Rows<S, V, J> {
        let decomposition = &self.weighted.decomposition;
        decomposition.multipliers(&decomposition.solve(acceleration))
    }

    /// J̄ ẋ: the joint velocities, or accelerations, of least kinetic energy that move the task by `task`.
    pub fn joint_velocity(&self, task: &Rows<S, V, J>) -> V {
        self.weighted.least_norm(task)
    }

    /// J̄ᵀ τ: the force on the task that has the effect of the joint forces `tau` on it.
    pub fn task_force(&self, tau: &V) -> Rows<S, V, J> {
        let decomposition = &self.weighted.decomposition;
        decomposition.multipliers(&decomposition.coordinates(&self.scaled(tau)))
    }

    /// Jᵀ f: the joint forces that have the effect of the force `task` on the task.
    pub fn joint_force(&self, task: &Rows<S, V, J>) -> V {
        let mut force: V = zeros(self.nv());
        for (row, &component) in self.jacobian.as_ref().iter().zip(task.as_ref()) {
            add_scaled(force.as_mut(), component, row.as_ref());
        }
        force
    }

    /// J v: the velocity of the task.
    pub fn task_velocity(&self, v: &V) -> Rows<S, V, J> {
        product(self.jacobian.as_ref(), v.as_ref())
    }

    /// N v: the part of a velocity, or acceleration, that does not move the task.
    pub fn null_velocity(&self, v: &V) -> V {
        let part = self.weighted.normal_velocity(v);
        V::from_fn(self.nv(), |i| entry(v, i) - entry(&part, i))
    }

    /// Nᵀ τ: the part of joint forces that does not accelerate the task.
    pub fn null_force(&self, tau: &V) -> V {
        let decomposition = &self.weighted.decomposition;
        let mut part = decomposition.combination(&decomposition.coordinates(&self.scaled(tau)));
        self.weighted.metric.unscale_force(&mut part);
        V::from_fn(self.nv(), |i| entry(tau, i) - entry(&part, i))
    }

    /// J J̄ ẋ: the part of a task's velocity, or acceleration, that is attainable; all of it if the status is full.
    pub fn attainable(&self, task: &Rows<S, V, J>) -> Rows<S, V, J> {
        let missed = self.weighted.decomposition.unreachable(task);
        Rows::<S, V, J>::from_fn(self.len(), |i| entry(task, i) - entry(&missed, i))
    }

    fn scaled(&self, tau: &V) -> V {
        let mut scaled = tau.clone();
        self.weighted.metric.scale(&mut scaled);
        scaled
    }

    fn unit(&self, row: usize) -> Rows<S, V, J> {
        Rows::<S, V, J>::from_fn(self.len(), |i| if i == row { S::one() } else { S::zero() })
    }
}
