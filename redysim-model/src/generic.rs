//! The generic path: the recursions at `f64` (or any other scalar), driven by a model that is read at run time.

use crate::denoc::{self, Method, Untraced, Workspace};
use crate::model::Model;
use crate::public_interface::{MovingJoint, PublicInterface};
use crate::tree::Tree;
use redysim_runtime::function::Dimension::{self, Coordinates, Velocities};
use redysim_runtime::{
    Arguments, BiasForces, CenterOfMass, ConfigurationSpace, CoriolisMatrix, Energy, ForwardDynamics,
    FrameAcceleration, FrameJacobian, FrameState, Frames, GravityForces, HybridDynamics, HybridMotion, InverseDynamics,
    LengthMismatch, LinkKinematics, LinkState, LoopClosure, LoopRows, MassCenter, MassMatrix, MechanicalEnergy,
    Mechanism, Momentum, PassiveForces, Scalar, TotalMomentum, VelocityCoordinates, Wrench,
};

/// A mechanism whose model is known only at run time.
///
/// It implements the traits of [`redysim_runtime`] as compiled types do, with `Vec` for arrays, and is the oracle that
/// specialised code is tested against. The lengths of the vectors are known only at run time, too: a function that is
/// called with a vector of wrong length panics, as slices of the standard library do, with the [`LengthMismatch`] that
/// names it. A simulation of the mechanism reports wrong lengths before it begins.
#[derive(Clone, Debug)]
pub struct GenericMechanism {
    model: Model,
    tree: Tree,
    coordinate_names: Vec<String>,
    velocity_names: Vec<String>,
    moved_coordinates: Vec<VelocityCoordinates>,
    actuated: Vec<bool>,
}

impl GenericMechanism {
    /// The mechanism of a checked model.
    pub fn new(model: Model) -> Self {
        let tree = Tree::new(&model);
        let interface = PublicInterface { joints: MovingJoint::all(&model), ..PublicInterface::default() };
        GenericMechanism {
            coordinate_names: interface.coordinate_names().map(String::from).collect(),
            velocity_names: interface.velocity_names().map(String::from).collect(),
            moved_coordinates: interface.moved_coordinates(),
            actuated: interface.actuated().collect(),
            model,
            tree,
        }
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The tree of moving bodies, on which the functions of [`denoc`] run.
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// [`InverseDynamics::inverse_dynamics`], written to `tau`. With a `workspace` [for this
    /// tree](Workspace::for_tree), no call allocates.
    ///
    /// ```
    /// use redysim_model::denoc::Workspace;
    /// use redysim_model::{GenericMechanism, Model};
    ///
    /// # let pendulum = "name = 'pendulum'\ngravity = [0, 0, -9.81]\n\n[[link]]\nname = 'rod'\nparent = 'base'\n\
    /// #     joint = 'revolute'\naxis = [0, 1, 0]\nmass = 2.0\ncom = [0.5, 0, 0]";
    /// let pendulum = GenericMechanism::new(Model::from_toml(pendulum, "pendulum.toml")?.model);
    /// let (mut workspace, mut tau) = (Workspace::for_tree(pendulum.tree()), [0.0]);
    /// for step in 0..1000 {
    ///     let q = 0.001 * f64::from(step);
    ///     pendulum.inverse_dynamics_in(&mut workspace, &[q], &[0.0], &[0.0], &mut tau);
    ///     assert!((tau[0] + 9.81 * q.cos()).abs() < 1e-12);
    /// }
    /// # Ok::<(), redysim_model::Faults>(())
    /// ```
    pub fn inverse_dynamics_in<S: Scalar>(
        &self,
        workspace: &mut Workspace<S>,
        q: &[S],
        v: &[S],
        a: &[S],
        tau: &mut [S],
    ) {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v), ("a", Velocities, a), ("tau", Velocities, tau)]);
        denoc::inverse_dynamics_in(workspace, &self.tree, &Untraced, q, v, a, tau);
    }

    /// [`ForwardDynamics::forward_dynamics`], written to `a`, in the room of `workspace`.
    pub fn forward_dynamics_in<S: Scalar>(
        &self,
        workspace: &mut Workspace<S>,
        q: &[S],
        v: &[S],
        tau: &[S],
        a: &mut [S],
    ) {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v), ("tau", Velocities, tau), ("a", Velocities, a)]);
        denoc::forward_dynamics_in(workspace, &self.tree, &Untraced, q, v, tau, a);
    }

    /// [`MassMatrix::mass_matrix`], written by rows to `matrix` of length NV², in the room of `workspace`.
    pub fn mass_matrix_in<S: Scalar>(&self, workspace: &mut Workspace<S>, q: &[S], matrix: &mut [S]) {
        self.check(&[("q", Coordinates, q)]);
        self.check_length("matrix", matrix, self.size(Velocities).pow(2));
        denoc::mass_matrix_in(workspace, &self.tree, &Untraced, q, matrix);
    }

    /// Panics if the length of a vector is not the size of its dimension, and names the first such vector.
    fn check<S>(&self, vectors: &[(&'static str, Dimension, &[S])]) {
        for (name, dimension, vector) in vectors {
            self.check_length(name, vector, self.size(*dimension));
        }
    }

    fn size(&self, dimension: Dimension) -> usize {
        match dimension {
            // The tree adds up the joints' coordinates, and every call of a function checks its vectors.
            Coordinates => self.coordinate_names.len(),
            Velocities => self.velocity_names.len(),
            other => self.tree.size(other),
        }
    }

    fn check_length<T>(&self, name: &'static str, vector: &[T], expected: usize) {
        if let Err(mismatch) = LengthMismatch::check(name, vector, expected) {
            let (nq, nv) = (self.size(Coordinates), self.size(Velocities));
            panic!("{mismatch}: `{}` has {nq} coordinates and {nv} velocities", self.model.name);
        }
    }
}

impl Mechanism for GenericMechanism {
    fn name(&self) -> &str {
        &self.model.name
    }
    fn nq(&self) -> usize {
        self.size(Coordinates)
    }
    fn nv(&self) -> usize {
        self.size(Velocities)
    }
    fn nl(&self) -> usize {
        self.size(Dimension::Links)
    }
    fn link_name(&self, index: usize) -> Option<&str> {
        self.model.links.get(index).map(|link| link.name.as_str())
    }
    fn joint_name(&self, index: usize) -> Option<&str> {
        self.model.moving_links().nth(index).map(|link| link.joint_name.as_str())
    }
    fn coordinate_name(&self, index: usize) -> Option<&str> {
        self.coordinate_names.get(index).map(String::as_str)
    }
    fn velocity_name(&self, index: usize) -> Option<&str> {
        self.velocity_names.get(index).map(String::as_str)
    }
    fn is_actuated(&self, index: usize) -> bool {
        self.actuated.get(index) == Some(&true)
    }
    fn coordinate_of_velocity(&self, index: usize) -> Option<usize> {
        match self.coordinates_of_velocity(index) {
            VelocityCoordinates::One(coordinate) => Some(coordinate),
            _ => None,
        }
    }
    fn coordinates_of_velocity(&self, index: usize) -> VelocityCoordinates {
        self.moved_coordinates.get(index).copied().unwrap_or(VelocityCoordinates::Unknown)
    }
    fn nf(&self) -> usize {
        self.size(Dimension::Frames)
    }
    fn frame_name(&self, index: usize) -> Option<&str> {
        self.model.frames.get(index).map(|frame| frame.name.as_str())
    }
}

impl<S: Scalar> ConfigurationSpace<S> for GenericMechanism {
    type Coordinates = Vec<S>;
    type Velocities = Vec<S>;
    type State = Vec<S>;
    type Matrix = Vec<Vec<S>>;
    type Links = Vec<LinkState<S>>;

    fn coordinate_rates(&self, q: &Vec<S>, v: &Vec<S>) -> Vec<S> {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v)]);
        denoc::coordinate_rates(&self.tree, q, v)
    }
    fn coordinate_rates_tangent(&self, q: &Vec<S>, v: &Vec<S>, dq: &Vec<S>) -> Option<Vec<S>> {
        Some(redysim_runtime::coordinate_rates_tangent(self, q, v, dq))
    }
    fn integrate(&self, q: &Vec<S>, dv: &Vec<S>) -> Vec<S> {
        self.check(&[("q", Coordinates, q), ("dv", Velocities, dv)]);
        denoc::integrate(&self.tree, q, dv)
    }
    fn difference(&self, q0: &Vec<S>, q1: &Vec<S>) -> Vec<S> {
        self.check(&[("q0", Coordinates, q0), ("q1", Coordinates, q1)]);
        denoc::difference(&self.tree, q0, q1)
    }
    fn neutral(&self) -> Vec<S> {
        denoc::neutral(&self.tree)
    }
    fn dissipated_power(&self, q: &Vec<S>, v: &Vec<S>) -> S {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v)]);
        denoc::dissipated_power(&self.tree, &Untraced, q, v)
    }
}

impl<S: Scalar> InverseDynamics<S> for GenericMechanism {
    fn inverse_dynamics(&self, q: &Vec<S>, v: &Vec<S>, a: &Vec<S>) -> Vec<S> {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v), ("a", Velocities, a)]);
        denoc::inverse_dynamics(&self.tree, &Untraced, q, v, a)
    }
    fn inverse_dynamics_tangent(&self, at: Arguments<'_, S, Self>, slopes: Arguments<'_, S, Self>) -> Option<Vec<S>> {
        Some(redysim_runtime::inverse_dynamics_tangent(self, at, slopes))
    }
}

impl<S: Scalar> ForwardDynamics<S> for GenericMechanism {
    /// By the O(n) recursion, which stays accurate for chains of any length.
    fn forward_dynamics(&self, q: &Vec<S>, v: &Vec<S>, tau: &Vec<S>) -> Vec<S> {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v), ("tau", Velocities, tau)]);
        denoc::forward_dynamics(Method::Recursion, &self.tree, &Untraced, q, v, tau)
    }
    fn forward_dynamics_tangent(&self, at: Arguments<'_, S, Self>, slopes: Arguments<'_, S, Self>) -> Option<Vec<S>> {
        Some(redysim_runtime::forward_dynamics_tangent(self, at, slopes))
    }
}

impl<S: Scalar> MassMatrix<S> for GenericMechanism {
    fn mass_matrix(&self, q: &Vec<S>) -> Vec<Vec<S>> {
        self.check(&[("q", Coordinates, q)]);
        denoc::mass_matrix(&self.tree, &Untraced, q)
    }
}

impl<S: Scalar> BiasForces<S> for GenericMechanism {
    fn bias_forces(&self, q: &Vec<S>, v: &Vec<S>) -> Vec<S> {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v)]);
        denoc::bias_forces(&self.tree, &Untraced, q, v)
    }
}

impl<S: Scalar> CoriolisMatrix<S> for GenericMechanism {
    fn coriolis_matrix(&self, q: &Vec<S>, v: &Vec<S>) -> Vec<Vec<S>> {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v)]);
        denoc::coriolis_matrix(&self.tree, &Untraced, q, v)
    }
}

impl<S: Scalar> GravityForces<S> for GenericMechanism {
    fn gravity_forces(&self, q: &Vec<S>) -> Vec<S> {
        self.check(&[("q", Coordinates, q)]);
        denoc::gravity_forces(&self.tree, &Untraced, q)
    }
}

impl<S: Scalar> MechanicalEnergy<S> for GenericMechanism {
    fn energy(&self, q: &Vec<S>, v: &Vec<S>) -> Energy<S> {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v)]);
        denoc::energy(&self.tree, &Untraced, q, v)
    }
}

impl<S: Scalar> PassiveForces<S> for GenericMechanism {
    fn passive_forces(&self, q: &Vec<S>, v: &Vec<S>) -> Vec<S> {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v)]);
        denoc::passive_forces(&self.tree, &Untraced, q, v)
    }
}

impl<S: Scalar> MassCenter<S> for GenericMechanism {
    fn center_of_mass(&self, q: &Vec<S>, v: &Vec<S>) -> CenterOfMass<S> {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v)]);
        denoc::center_of_mass(&self.tree, &Untraced, q, v)
    }
}

impl<S: Scalar> TotalMomentum<S> for GenericMechanism {
    fn momentum(&self, q: &Vec<S>, v: &Vec<S>) -> Momentum<S> {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v)]);
        denoc::momentum(&self.tree, &Untraced, q, v)
    }
}

impl<S: Scalar> HybridDynamics<S> for GenericMechanism {
    fn hybrid_dynamics(&self, q: &Vec<S>, v: &Vec<S>, u: &Vec<S>) -> HybridMotion<Vec<S>> {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v), ("u", Velocities, u)]);
        denoc::hybrid_dynamics(Method::Recursion, &self.tree, &Untraced, q, v, u)
    }
}

impl<S: Scalar> LinkKinematics<S> for GenericMechanism {
    fn link_kinematics(&self, q: &Vec<S>, v: &Vec<S>) -> Vec<LinkState<S>> {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v)]);
        denoc::link_kinematics(&self.tree, &Untraced, q, v)
    }
}

impl<S: Scalar> Frames<S> for GenericMechanism {
    type States = Vec<FrameState<S>>;
    type Jacobians = Vec<FrameJacobian<Vec<S>>>;
    type Accelerations = Vec<FrameAcceleration<S>>;
    type Wrenches = Vec<Wrench<S>>;

    fn frame_kinematics(&self, q: &Vec<S>, v: &Vec<S>) -> Vec<FrameState<S>> {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v)]);
        denoc::frame_kinematics(&self.tree, &Untraced, q, v)
    }
    fn frame_jacobians(&self, q: &Vec<S>) -> Vec<FrameJacobian<Vec<S>>> {
        self.check(&[("q", Coordinates, q)]);
        denoc::frame_jacobians(&self.tree, &Untraced, q)
    }
    fn frame_bias(&self, q: &Vec<S>, v: &Vec<S>) -> Vec<FrameAcceleration<S>> {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v)]);
        denoc::frame_bias(&self.tree, &Untraced, q, v)
    }
    fn frame_forces(&self, q: &Vec<S>, wrenches: &Vec<Wrench<S>>) -> Vec<S> {
        self.check(&[("q", Coordinates, q)]);
        self.check_length("wrenches", wrenches, self.size(Dimension::Frames));
        let wrenches: Vec<_> = wrenches.iter().copied().map(Into::into).collect();
        denoc::frame_forces(&self.tree, &Untraced, q, &wrenches)
    }
}

impl LoopRows for GenericMechanism {
    fn nc(&self) -> usize {
        self.size(Dimension::LoopRows)
    }
    fn loop_name(&self, row: usize) -> Option<&str> {
        self.tree.loops_of_rows().nth(row).map(|index| self.model.loops[index].name.as_str())
    }
}

impl<S: Scalar> LoopClosure<S, GenericMechanism> for GenericMechanism {
    type Rows = Vec<S>;
    type Jacobian = Vec<Vec<S>>;
    type Gram = Vec<Vec<S>>;

    fn loop_residual(&self, q: &Vec<S>) -> Vec<S> {
        self.check(&[("q", Coordinates, q)]);
        denoc::loop_residual(&self.tree, &Untraced, q)
    }
    fn loop_jacobian(&self, q: &Vec<S>) -> Vec<Vec<S>> {
        self.check(&[("q", Coordinates, q)]);
        denoc::loop_jacobian(&self.tree, &Untraced, q)
    }
    fn loop_bias(&self, q: &Vec<S>, v: &Vec<S>) -> Vec<S> {
        self.check(&[("q", Coordinates, q), ("v", Velocities, v)]);
        denoc::loop_bias(&self.tree, &Untraced, q, v)
    }
}
