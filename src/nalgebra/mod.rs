//! The functions of compiled mechanisms over the vectors, matrices and isometries of [`::nalgebra`].
//!
//! All functions are here, each with the name of the one that it calls, and [`OperationalSpace`]. Vectors are passed on
//! as the arrays that they hold, and results are moved into vectors and matrices, so that nothing is copied by hand.
//! Neither `std` nor an allocator is needed.
//!
//! ```
//! use nalgebra::{SVector, Vector6};
//! use redysim::nalgebra as dynamics;
//! use redysim::redysim;
//!
//! redysim! { struct Kr5("models/kr5.toml"); }
//!
//! let (q, v) = (Vector6::new(0.1, -0.5, 0.9, 0.0, 0.4, 0.0), Vector6::repeat(0.2));
//! // Computed torque: the forces that take the robot to an acceleration chosen by a controller.
//! let a = -(q * 100.0) - v * 20.0;
//! let tau = dynamics::mass_matrix(&Kr5, &q) * a + dynamics::bias_forces(&Kr5, &q, &v);
//! let same: SVector<f64, 6> = dynamics::inverse_dynamics(&Kr5, &q, &v, &a);
//! assert!((tau - same).norm() < 1e-12 * tau.norm());
//!
//! let tool = dynamics::link_kinematics(&Kr5, &q, &v)[5];
//! println!("the tool's frame is at {}, its tip at {}", tool.pose, tool.pose * nalgebra::Point3::new(0.0, 0.0, 0.1));
//! ```

mod frames;
mod operational_space;

pub use frames::{Frame, Wrench, frame_bias, frame_forces, frame_jacobians, frame_kinematics};
pub use operational_space::OperationalSpace;

use crate::{
    BiasForces, ConfigurationSpace, CoriolisMatrix, Energy, ForwardDynamics, GravityForces, HybridDynamics,
    HybridMotion, InverseDynamics, LinkKinematics, LinkState, LoopClosure, MassCenter, MassMatrix, MechanicalEnergy,
    PassiveForces, Scalar, TotalMomentum,
};
use ::nalgebra::{Isometry3, Point3, RealField, Rotation3, SMatrix, SVector, UnitQuaternion, Vector3};

/// A scalar that is a number of nalgebra's too: `f32` and `f64`.
pub trait Number: Scalar + ::nalgebra::Scalar {}

impl<S: Scalar + ::nalgebra::Scalar> Number for S {}

/// A link's frame, centre of mass and velocities, in the base frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link<S: RealField> {
    /// The link's frame: takes points of the link to the base frame, m.
    pub pose: Isometry3<S>,
    /// Centre of mass, m.
    pub com: Point3<S>,
    /// Velocity of the frame's origin, m/s.
    pub velocity: Vector3<S>,
    /// Angular velocity, rad/s.
    pub angular_velocity: Vector3<S>,
}

impl<S: RealField + Copy> From<LinkState<S>> for Link<S> {
    fn from(state: LinkState<S>) -> Self {
        let LinkState { rotation, origin, com, velocity, angular_velocity } = state;
        Link {
            pose: isometry(rotation, origin),
            com: com.into(),
            velocity: velocity.into(),
            angular_velocity: angular_velocity.into(),
        }
    }
}

/// The momentum of a whole mechanism, in the axes of the base frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Momentum<S: ::nalgebra::Scalar> {
    /// Linear momentum, N s.
    pub linear: Vector3<S>,
    /// Angular momentum about the centre of mass, N m s.
    pub angular: Vector3<S>,
}

/// Position and velocity of the centre of mass of a whole mechanism, in the base frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CenterOfMass<S: ::nalgebra::Scalar> {
    /// Position, m.
    pub position: Point3<S>,
    /// Velocity, m/s.
    pub velocity: Vector3<S>,
}

/// The array that a vector holds.
fn array<S, const N: usize>(vector: &SVector<S, N>) -> &[S; N] {
    let [column] = &vector.data.0;
    column
}

/// The matrix with these rows, which are columns of its transpose.
fn matrix<S: ::nalgebra::Scalar, const R: usize, const C: usize>(rows: [[S; C]; R]) -> SMatrix<S, R, C> {
    SMatrix::<S, C, R>::from(rows).transpose()
}

/// The rows of a matrix.
fn rows<S: ::nalgebra::Scalar, const R: usize, const C: usize>(matrix: &SMatrix<S, R, C>) -> [[S; C]; R] {
    matrix.transpose().data.0
}

/// The frame whose axes are the columns of `rotation`, with its origin at `origin`.
fn isometry<S: RealField>(rotation: [[S; 3]; 3], origin: [S; 3]) -> Isometry3<S> {
    let rotation = Rotation3::from_matrix_unchecked(matrix(rotation));
    Isometry3::from_parts(origin.into(), UnitQuaternion::from_rotation_matrix(&rotation))
}

/// [`ConfigurationSpace::coordinate_rates`]: q̇ = N(q) v.
pub fn coordinate_rates<S, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    v: &SVector<S, NV>,
) -> SVector<S, NQ>
where
    S: Number,
    M: ConfigurationSpace<S, Coordinates = [S; NQ], Velocities = [S; NV]>,
{
    mechanism.coordinate_rates(array(q), array(v)).into()
}

/// [`ConfigurationSpace::integrate`]: q ⊞ dv.
pub fn integrate<S, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    dv: &SVector<S, NV>,
) -> SVector<S, NQ>
where
    S: Number,
    M: ConfigurationSpace<S, Coordinates = [S; NQ], Velocities = [S; NV]>,
{
    mechanism.integrate(array(q), array(dv)).into()
}

/// [`ConfigurationSpace::difference`]: q₁ ⊟ q₀.
pub fn difference<S, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q0: &SVector<S, NQ>,
    q1: &SVector<S, NQ>,
) -> SVector<S, NV>
where
    S: Number,
    M: ConfigurationSpace<S, Coordinates = [S; NQ], Velocities = [S; NV]>,
{
    mechanism.difference(array(q0), array(q1)).into()
}

/// [`ConfigurationSpace::neutral`]: the coordinates of the zero position.
pub fn neutral<S, M, const NQ: usize>(mechanism: &M) -> SVector<S, NQ>
where
    S: Number,
    M: ConfigurationSpace<S, Coordinates = [S; NQ]>,
{
    mechanism.neutral().into()
}

/// [`InverseDynamics::inverse_dynamics`]: the joint forces of a motion, N m or N.
pub fn inverse_dynamics<S, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    v: &SVector<S, NV>,
    a: &SVector<S, NV>,
) -> SVector<S, NV>
where
    S: Number,
    M: InverseDynamics<S, Coordinates = [S; NQ], Velocities = [S; NV]>,
{
    mechanism.inverse_dynamics(array(q), array(v), array(a)).into()
}

/// [`ForwardDynamics::forward_dynamics`]: the accelerations for joint forces, rad/s² or m/s².
pub fn forward_dynamics<S, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    v: &SVector<S, NV>,
    tau: &SVector<S, NV>,
) -> SVector<S, NV>
where
    S: Number,
    M: ForwardDynamics<S, Coordinates = [S; NQ], Velocities = [S; NV]>,
{
    mechanism.forward_dynamics(array(q), array(v), array(tau)).into()
}

/// [`MassMatrix::mass_matrix`]: the generalised inertia matrix, kg m², kg m or kg.
pub fn mass_matrix<S, M, const NQ: usize, const NV: usize>(mechanism: &M, q: &SVector<S, NQ>) -> SMatrix<S, NV, NV>
where
    S: Number,
    M: MassMatrix<S, Coordinates = [S; NQ], Matrix = [[S; NV]; NV]>,
{
    // Rows are columns, since the matrix is symmetric.
    mechanism.mass_matrix(array(q)).into()
}

/// [`BiasForces::bias_forces`]: the joint forces at zero acceleration, N m or N.
pub fn bias_forces<S, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    v: &SVector<S, NV>,
) -> SVector<S, NV>
where
    S: Number,
    M: BiasForces<S, Coordinates = [S; NQ], Velocities = [S; NV]>,
{
    mechanism.bias_forces(array(q), array(v)).into()
}

/// [`CoriolisMatrix::coriolis_matrix`]: C with Ṁ − 2 C skew-symmetric, of which C v is the part of the bias that
/// velocities make.
pub fn coriolis_matrix<S, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    v: &SVector<S, NV>,
) -> SMatrix<S, NV, NV>
where
    S: Number,
    M: CoriolisMatrix<S, Coordinates = [S; NQ], Velocities = [S; NV], Matrix = [[S; NV]; NV]>,
{
    matrix(mechanism.coriolis_matrix(array(q), array(v)))
}

/// [`GravityForces::gravity_forces`]: the joint forces of gravity, N m or N.
pub fn gravity_forces<S, M, const NQ: usize, const NV: usize>(mechanism: &M, q: &SVector<S, NQ>) -> SVector<S, NV>
where
    S: Number,
    M: GravityForces<S, Coordinates = [S; NQ], Velocities = [S; NV]>,
{
    mechanism.gravity_forces(array(q)).into()
}

/// [`PassiveForces::passive_forces`]: the part of the bias that damping, friction and springs take, N m or N.
pub fn passive_forces<S, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    v: &SVector<S, NV>,
) -> SVector<S, NV>
where
    S: Number,
    M: PassiveForces<S, Coordinates = [S; NQ], Velocities = [S; NV]>,
{
    mechanism.passive_forces(array(q), array(v)).into()
}

/// [`MechanicalEnergy::energy`]: kinetic and potential energy, J.
pub fn energy<S, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    v: &SVector<S, NV>,
) -> Energy<S>
where
    S: Number,
    M: MechanicalEnergy<S, Coordinates = [S; NQ], Velocities = [S; NV]>,
{
    mechanism.energy(array(q), array(v))
}

/// [`ConfigurationSpace::dissipated_power`]: the power that damping and friction take, W.
pub fn dissipated_power<S, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    v: &SVector<S, NV>,
) -> S
where
    S: Number,
    M: ConfigurationSpace<S, Coordinates = [S; NQ], Velocities = [S; NV]>,
{
    mechanism.dissipated_power(array(q), array(v))
}

/// [`MassCenter::center_of_mass`]: where the centre of mass of the mechanism is and how it moves, in the base frame.
pub fn center_of_mass<S, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    v: &SVector<S, NV>,
) -> CenterOfMass<S>
where
    S: Number,
    M: MassCenter<S, Coordinates = [S; NQ], Velocities = [S; NV]>,
{
    let crate::CenterOfMass { position, velocity } = mechanism.center_of_mass(array(q), array(v));
    CenterOfMass { position: position.into(), velocity: velocity.into() }
}

/// [`TotalMomentum::momentum`]: the linear momentum of the mechanism, and its angular momentum about the centre of mass.
pub fn momentum<S, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    v: &SVector<S, NV>,
) -> Momentum<S>
where
    S: Number,
    M: TotalMomentum<S, Coordinates = [S; NQ], Velocities = [S; NV]>,
{
    let crate::Momentum { linear, angular } = mechanism.momentum(array(q), array(v));
    Momentum { linear: linear.into(), angular: angular.into() }
}

/// [`HybridDynamics::hybrid_dynamics`]: accelerations and joint forces from what `u` gives of each velocity.
pub fn hybrid_dynamics<S, M, const NQ: usize, const NV: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    v: &SVector<S, NV>,
    u: &SVector<S, NV>,
) -> HybridMotion<SVector<S, NV>>
where
    S: Number,
    M: HybridDynamics<S, Coordinates = [S; NQ], Velocities = [S; NV]>,
{
    let HybridMotion { a, tau } = mechanism.hybrid_dynamics(array(q), array(v), array(u));
    HybridMotion { a: a.into(), tau: tau.into() }
}

/// [`LinkKinematics::link_kinematics`]: where every link is and how it moves, in the base frame, in the model's order.
pub fn link_kinematics<S, M, const NQ: usize, const NV: usize, const NL: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    v: &SVector<S, NV>,
) -> [Link<S>; NL]
where
    S: Number + RealField,
    M: LinkKinematics<S, Coordinates = [S; NQ], Velocities = [S; NV], Links = [LinkState<S>; NL]>,
{
    mechanism.link_kinematics(array(q), array(v)).map(Link::from)
}

/// [`LoopClosure::loop_residual`]: how far the loops are from closed, m for points and sines for directions.
pub fn loop_residual<S, M, const NQ: usize, const NC: usize>(mechanism: &M, q: &SVector<S, NQ>) -> SVector<S, NC>
where
    S: Number,
    M: ConfigurationSpace<S, Coordinates = [S; NQ]> + LoopClosure<S, M, Rows = [S; NC]>,
{
    mechanism.loop_residual(array(q)).into()
}

/// [`LoopClosure::loop_jacobian`]: the matrix J by which the residual changes at the rates J v.
pub fn loop_jacobian<S, M, const NQ: usize, const NV: usize, const NC: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
) -> SMatrix<S, NC, NV>
where
    S: Number,
    M: ConfigurationSpace<S, Coordinates = [S; NQ], Velocities = [S; NV]> + LoopClosure<S, M, Jacobian = [[S; NV]; NC]>,
{
    matrix(mechanism.loop_jacobian(array(q)))
}

/// [`LoopClosure::loop_bias`]: J̇ v, the second derivative of the residual at zero joint accelerations.
pub fn loop_bias<S, M, const NQ: usize, const NV: usize, const NC: usize>(
    mechanism: &M,
    q: &SVector<S, NQ>,
    v: &SVector<S, NV>,
) -> SVector<S, NC>
where
    S: Number,
    M: ConfigurationSpace<S, Coordinates = [S; NQ], Velocities = [S; NV]> + LoopClosure<S, M, Rows = [S; NC]>,
{
    mechanism.loop_bias(array(q), array(v)).into()
}
