//! The traits a mechanism implements, one for each function, so that a program asks for what it uses and a compiled
//! type offers what it has. Compiled types and the generic path implement the same traits and can be swapped.

use core::ops::Range;

use crate::{Scalar, Vector};

/// Sizes and names of a mechanism.
pub trait Mechanism {
    /// The model's name.
    fn name(&self) -> &str;
    /// Number of coordinates, NQ.
    fn nq(&self) -> usize;
    /// Number of velocities, NV.
    fn nv(&self) -> usize;
    /// Number of links, NL.
    fn nl(&self) -> usize;
    /// Name of link `index` in the model's order; `None` past the last.
    fn link_name(&self, index: usize) -> Option<&str>;
    /// Name of the moving joint `index` in the model's order; `None` past the last.
    fn joint_name(&self, index: usize) -> Option<&str>;
    /// Name of coordinate `index` in the model's order; `None` past the last. The default is the joint's name, for
    /// joints of one coordinate each.
    fn coordinate_name(&self, index: usize) -> Option<&str> {
        self.joint_name(index)
    }
    /// Name of velocity `index` in the model's order; `None` past the last. The default is the joint's name, for joints
    /// of one velocity each.
    fn velocity_name(&self, index: usize) -> Option<&str> {
        self.joint_name(index)
    }
    /// Whether the joint of velocity `index` has an actuator; `false` past the last. The default is that every joint has.
    fn is_actuated(&self, index: usize) -> bool {
        index < self.nv()
    }
    /// The coordinate that belongs to velocity `index` alone: the coordinate of a joint that has one, whose rate is
    /// that velocity, q̇ᵢ = vⱼ, and which may be set by itself. `None` past the last, and for velocities of joints that
    /// have several coordinates (an orientation as a quaternion, an angle as cosine and sine).
    ///
    /// The default is `index` itself if NQ = NV, for joints of one coordinate each, and `None` if NQ ≠ NV. A mechanism
    /// that has joints of several coordinates and joints of one overrides it.
    fn coordinate_of_velocity(&self, index: usize) -> Option<usize> {
        (self.nq() == self.nv() && index < self.nv()).then_some(index)
    }
    /// The coordinates that velocity `index` changes. Tolerances weigh [errors](crate::Ode::error_norm) of coordinates by it,
    /// and torque laws and trajectories find orientations by it. The default is the
    /// [coordinate of that velocity alone](Self::coordinate_of_velocity), and `Unknown` where there is none. Mechanisms with
    /// quaternions must override it.
    fn coordinates_of_velocity(&self, index: usize) -> VelocityCoordinates {
        self.coordinate_of_velocity(index).map_or(VelocityCoordinates::Unknown, VelocityCoordinates::One)
    }
    /// Number of frames of interest, NF: the tables `[[frame]]` of a model. The default is none.
    fn nf(&self) -> usize {
        0
    }
    /// Name of frame `index` in the model's order; `None` past the last, and by default.
    fn frame_name(&self, index: usize) -> Option<&str> {
        let _ = index;
        None
    }
}

/// The coordinates that a velocity changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum VelocityCoordinates {
    /// The coordinate with this index, whose rate is the velocity.
    One(usize),
    /// The position of an origin in three coordinates, the first of which has this index. A quaternion follows, and the
    /// three velocities are those of the origin in its axes.
    Position(usize),
    /// The orientation as a quaternion in four coordinates, the first of which has this index. The three velocities are the
    /// angular velocity in its axes.
    Quaternion(usize),
    /// Coordinates of another kind.
    Unknown,
}

impl VelocityCoordinates {
    /// Their indices; none of coordinates of another kind.
    pub(crate) fn indices(self) -> Range<usize> {
        match self {
            Self::One(first) => first..first + 1,
            Self::Position(first) => first..first + 3,
            Self::Quaternion(first) => first..first + 4,
            Self::Unknown => 0..0,
        }
    }
}

/// Coordinates and velocities of a mechanism over the scalar `S`. The types of vectors carry their lengths: arrays for
/// compiled types, `Vec` for the generic path.
///
/// Coordinates need not be as many as velocities, nor may they be added: what moves from one position to another is a
/// velocity over a unit of time.
pub trait ConfigurationSpace<S: Scalar>: Mechanism {
    /// Joint coordinates q, in the model's order: `[S; NQ]`. Radians or metres.
    type Coordinates: Vector<S>;
    /// Joint velocities, accelerations or forces, in the model's order: `[S; NV]`.
    type Velocities: Vector<S>;
    /// The state of a simulation, [q, q̇, E_act]: `[S; NQ + NV + 1]`.
    type State: Vector<S>;
    /// A square matrix over the velocities, by rows: `[[S; NV]; NV]`.
    type Matrix: Vector<Self::Velocities>;
    /// One [`LinkState`] for each link, in the model's order: `[LinkState<S>; NL]`.
    type Links: AsRef<[LinkState<S>]>;

    /// The time derivative of the coordinates, q̇ = N(q) v; v itself for revolute, prismatic and helical joints.
    fn coordinate_rates(&self, q: &Self::Coordinates, v: &Self::Velocities) -> Self::Coordinates;
    /// The derivative of q̇ = N(q) v along `dq` at constant v, (∂N/∂q dq) v; zero for revolute, prismatic and helical
    /// joints. The generic path computes it with [dual numbers](crate::coordinate_rates_tangent); `None`, the default,
    /// leaves it to differences.
    fn coordinate_rates_tangent(
        &self,
        q: &Self::Coordinates,
        v: &Self::Velocities,
        dq: &Self::Coordinates,
    ) -> Option<Self::Coordinates> {
        let _ = (q, v, dq);
        None
    }
    /// q ⊞ dv, the coordinates that the velocities `dv`, constant over a unit of time, lead to from `q`; q + dv for
    /// revolute, prismatic and helical joints.
    ///
    /// Where coordinates are constrained, as those of a unit quaternion, the result is nearer to the constraint than
    /// `q`: simulations take q ⊞ 0 after each step.
    fn integrate(&self, q: &Self::Coordinates, dv: &Self::Velocities) -> Self::Coordinates;
    /// q₁ ⊟ q₀, the velocities that lead from `q0` to `q1` in a unit of time: the inverse of
    /// [`integrate`](Self::integrate).
    fn difference(&self, q0: &Self::Coordinates, q1: &Self::Coordinates) -> Self::Velocities;
    /// The coordinates at which every joint is at its zero position.
    fn neutral(&self) -> Self::Coordinates;
    /// The power that damping and friction take, W, by which the energy of the mechanism grows less than by the work of
    /// its actuators; zero by default.
    fn dissipated_power(&self, q: &Self::Coordinates, v: &Self::Velocities) -> S {
        let _ = (q, v);
        S::zero()
    }
}

/// Coordinates, velocities, and accelerations or joint forces of the mechanism `M`, or derivatives of them.
pub type Arguments<'a, S, M> = (
    &'a <M as ConfigurationSpace<S>>::Coordinates,
    &'a <M as ConfigurationSpace<S>>::Velocities,
    &'a <M as ConfigurationSpace<S>>::Velocities,
);

/// Joint forces from motion.
pub trait InverseDynamics<S: Scalar>: ConfigurationSpace<S> {
    /// τ = M(q) a + bias(q, v), N m or N: the joint forces of the tree, with the [bias](BiasForces).
    fn inverse_dynamics(&self, q: &Self::Coordinates, v: &Self::Velocities, a: &Self::Velocities) -> Self::Velocities;

    /// The derivative of τ along `slopes`, (∂τ/∂q) dq + (∂τ/∂v) dv + (∂τ/∂a) da at `at` = (q, v, a). Compiled types and
    /// the generic path compute it with [dual numbers](crate::Dual); `None`, the default, leaves it to differences.
    fn inverse_dynamics_tangent(
        &self,
        at: Arguments<'_, S, Self>,
        slopes: Arguments<'_, S, Self>,
    ) -> Option<Self::Velocities> {
        let _ = (at, slopes);
        None
    }
}

/// Accelerations from joint forces.
pub trait ForwardDynamics<S: Scalar>: ConfigurationSpace<S> {
    /// a = M(q)⁻¹ (τ − bias(q, v)), rad/s² or m/s²: the accelerations of the tree (loops, if any, open).
    fn forward_dynamics(&self, q: &Self::Coordinates, v: &Self::Velocities, tau: &Self::Velocities)
    -> Self::Velocities;

    /// The derivative of a along `slopes`, (∂a/∂q) dq + (∂a/∂v) dv + (∂a/∂τ) dτ at `at` = (q, v, τ). Compiled types and
    /// the generic path compute it with [dual numbers](crate::Dual); `None`, the default, leaves it to differences.
    fn forward_dynamics_tangent(
        &self,
        at: Arguments<'_, S, Self>,
        slopes: Arguments<'_, S, Self>,
    ) -> Option<Self::Velocities> {
        let _ = (at, slopes);
        None
    }
}

/// The generalised inertia matrix.
pub trait MassMatrix<S: Scalar>: ConfigurationSpace<S> {
    /// M(q), symmetric and positive definite: kg m², kg m or kg. Where a link has no mass and only loops hold it, M(q)
    /// is singular, and the mechanism has no [`ForwardDynamics`].
    fn mass_matrix(&self, q: &Self::Coordinates) -> Self::Matrix;
}

/// Forces that do not depend on accelerations.
pub trait BiasForces<S: Scalar>: ConfigurationSpace<S> {
    /// C(q, v) v + g(q) and the [passive forces](PassiveForces), N m or N.
    fn bias_forces(&self, q: &Self::Coordinates, v: &Self::Velocities) -> Self::Velocities;
}

/// The Coriolis matrix.
pub trait CoriolisMatrix<S: Scalar>: ConfigurationSpace<S> {
    /// C(q, v), by rows: C v are the joint forces that the velocities take, N m or N, without those of gravity and of
    /// damping, friction and springs. It is the matrix of the Christoffel symbols, for which Ṁ − 2 C is skew-symmetric,
    /// as adaptive control and the observation of momentum need it: Ṁ = C + Cᵀ.
    fn coriolis_matrix(&self, q: &Self::Coordinates, v: &Self::Velocities) -> Self::Matrix;
}

/// Forces that hold the mechanism against gravity.
pub trait GravityForces<S: Scalar>: ConfigurationSpace<S> {
    /// g(q), N m or N: of gravity alone, without springs.
    fn gravity_forces(&self, q: &Self::Coordinates) -> Self::Velocities;
}

/// Forces of what acts in the joints without an actuator.
pub trait PassiveForces<S: Scalar>: ConfigurationSpace<S> {
    /// The part of the bias that damping, friction and springs take, N m or N: d v + f v/√(v² + ε²) + k (q − q₀) in each
    /// joint. The force that acts on the joint is its negative.
    fn passive_forces(&self, q: &Self::Coordinates, v: &Self::Velocities) -> Self::Velocities;
}

/// Kinetic and potential energy.
pub trait MechanicalEnergy<S: Scalar>: ConfigurationSpace<S> {
    /// Both energies of the tree, J; the potential is zero at the origin of the base frame.
    fn energy(&self, q: &Self::Coordinates, v: &Self::Velocities) -> Energy<S>;
}

/// The centre of mass of a whole mechanism.
pub trait MassCenter<S: Scalar>: ConfigurationSpace<S> {
    /// Position and velocity of the centre of mass of all links, those that do not move among them, in the base frame.
    fn center_of_mass(&self, q: &Self::Coordinates, v: &Self::Velocities) -> CenterOfMass<S>;
}

/// The momentum of a whole mechanism.
pub trait TotalMomentum<S: Scalar>: ConfigurationSpace<S> {
    /// Linear momentum, and angular momentum about the [centre of mass](MassCenter), of all links in the axes of the
    /// base frame. Without external forces both are constant.
    fn momentum(&self, q: &Self::Coordinates, v: &Self::Velocities) -> Momentum<S>;
}

/// Forward dynamics of some joints and inverse dynamics of the others.
pub trait HybridDynamics<S: Scalar>: ConfigurationSpace<S> {
    /// Accelerations and joint forces from what `u` gives of each velocity: where the joint has an actuator the
    /// acceleration, rad/s² or m/s², and else the force, N m or N (Featherstone, *Rigid Body Dynamics Algorithms*,
    /// Springer 2008, section 9.2). For a free base it is the inverse dynamics of a floating robot, for a cart-pole that
    /// of the cart under a free pole.
    fn hybrid_dynamics(
        &self,
        q: &Self::Coordinates,
        v: &Self::Velocities,
        u: &Self::Velocities,
    ) -> HybridMotion<Self::Velocities>;
}

/// Where every link is and how it moves.
pub trait LinkKinematics<S: Scalar>: ConfigurationSpace<S> {
    /// Position and velocity of every link, in the base frame, in the model's order.
    fn link_kinematics(&self, q: &Self::Coordinates, v: &Self::Velocities) -> Self::Links;
}

/// The rows of the closure of loops: how many there are, and to which loop each belongs.
pub trait LoopRows {
    /// Number of rows, NC.
    fn nc(&self) -> usize;
    /// Name of the loop that row `row` belongs to; `None` past the last, and where loops have no names.
    fn loop_name(&self, row: usize) -> Option<&str> {
        let _ = row;
        None
    }
}

/// The closure of the loops of a mechanism `M`: constraints on its coordinates that the cut joints set.
///
/// A compiled type is its own closure. Another closure, such as a closed form or constraints that no cut joint
/// describes, is a type of its own that implements this trait.
pub trait LoopClosure<S: Scalar, M: ConfigurationSpace<S>>: LoopRows {
    /// One value for each row: `[S; NC]`.
    type Rows: Vector<S>;
    /// The Jacobian, by rows: `[[S; NV]; NC]`.
    type Jacobian: Vector<M::Velocities>;
    /// A square matrix over the rows: `[[S; NC]; NC]`.
    type Gram: Vector<Self::Rows>;

    /// How far the loops are from closed: the point of side b minus the point of side a of each cut, in the base frame,
    /// m; then what aligns directions, sines.
    fn loop_residual(&self, q: &M::Coordinates) -> Self::Rows;
    /// J(q) with d/dt residual = J v.
    fn loop_jacobian(&self, q: &M::Coordinates) -> Self::Jacobian;
    /// J̇ v, the second derivative of the residual at zero joint accelerations.
    fn loop_bias(&self, q: &M::Coordinates, v: &M::Velocities) -> Self::Rows;
}

/// All functions of a tree-type mechanism at once; every type that has them all has this. A compiled type whose model
/// or macro leaves out one of them, by `functions`, has the traits of the others alone.
pub trait TreeDynamics<S: Scalar>:
    InverseDynamics<S>
    + ForwardDynamics<S>
    + MassMatrix<S>
    + BiasForces<S>
    + CoriolisMatrix<S>
    + GravityForces<S>
    + PassiveForces<S>
    + MechanicalEnergy<S>
    + MassCenter<S>
    + TotalMomentum<S>
    + LinkKinematics<S>
{
}

impl<S: Scalar, M> TreeDynamics<S> for M where
    M: InverseDynamics<S>
        + ForwardDynamics<S>
        + MassMatrix<S>
        + BiasForces<S>
        + CoriolisMatrix<S>
        + GravityForces<S>
        + PassiveForces<S>
        + MechanicalEnergy<S>
        + MassCenter<S>
        + TotalMomentum<S>
        + LinkKinematics<S>
{
}

/// Energy of a mechanism, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Energy<S> {
    /// ½ q̇ᵀ M q̇.
    pub kinetic: S,
    /// −Σ m g·c, zero at the origin of the base frame, and ½ k (q − q₀)² of each spring.
    pub potential: S,
}

impl<S: Scalar> Energy<S> {
    /// Kinetic and potential energy together, J.
    pub fn total(&self) -> S {
        self.kinetic + self.potential
    }
}

/// The centre of mass of a mechanism, in the base frame. It is the origin, at rest, for a mechanism without mass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct CenterOfMass<S> {
    /// Σ m c / Σ m, m.
    pub position: [S; 3],
    /// Σ m ċ / Σ m, m/s: the linear momentum as a share of the mass.
    pub velocity: [S; 3],
}

/// The momentum of a mechanism, in the axes of the base frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Momentum<S> {
    /// Σ m ċ, N s.
    pub linear: [S; 3],
    /// Σ I ω + m (c − c₀) × ċ about the centre of mass c₀ of the mechanism, N m s.
    pub angular: [S; 3],
}

/// What [`HybridDynamics`] finds, for each velocity in the model's order.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HybridMotion<V> {
    /// Accelerations, rad/s² or m/s²: those that are given, and those that are found.
    pub a: V,
    /// Joint forces, N m or N: those that are found, and those that are given.
    pub tau: V,
}

/// Position and velocity of one link, in the base frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct LinkState<S> {
    /// The link's axes, as columns, in the base frame; `rotation[row][column]`.
    pub rotation: [[S; 3]; 3],
    /// Origin of the link's frame, m.
    pub origin: [S; 3],
    /// Centre of mass, m.
    pub com: [S; 3],
    /// Velocity of the origin, m/s.
    pub velocity: [S; 3],
    /// Angular velocity, rad/s.
    pub angular_velocity: [S; 3],
}
