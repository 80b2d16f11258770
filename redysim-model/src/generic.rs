//! The generic path: the recursions at `f64` (or any other scalar), driven by a model that is read at run time.

use crate::denoc::{self, Method, Untraced, Workspace};
use crate::model::Model;
use crate::tree::Tree;
use redysim_runtime::{
    Arguments, BiasForces, CenterOfMass, ConfigurationSpace, Energy, ForwardDynamics, GravityForces, InverseDynamics,
    LengthMismatch, LinkKinematics, LinkState, LoopClosure, LoopRows, MassCenter, MassMatrix, MechanicalEnergy,
    Mechanism, Scalar,
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
}

impl GenericMechanism {
    /// The mechanism of a checked model.
    pub fn new(model: Model) -> Self {
        let tree = Tree::new(&model);
        GenericMechanism { model, tree }
    }

    /// The model.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The tree of moving bodies, on which the functions of [`denoc`] run.
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// [`InverseDynamics::inverse_dynamics`], written to `tau`. A `workspace` that is kept from call to call is all the
    /// memory that is needed: later calls allocate nothing.
    ///
    /// ```
    /// use redysim_model::denoc::Workspace;
    /// use redysim_model::{GenericMechanism, Model};
    ///
    /// # let pendulum = "name = 'pendulum'\ngravity = [0, 0, -9.81]\n\n[[link]]\nname = 'rod'\nparent = 'base'\n\
    /// #     joint = 'revolute'\naxis = [0, 1, 0]\nmass = 2.0\ncom = [0.5, 0, 0]";
    /// let pendulum = GenericMechanism::new(Model::from_toml(pendulum, "pendulum.toml")?.model);
    /// let (mut workspace, mut tau) = (Workspace::default(), [0.0]);
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
        self.check(&[("q", q), ("v", v), ("a", a), ("tau", tau)]);
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
        self.check(&[("q", q), ("v", v), ("tau", tau), ("a", a)]);
        denoc::forward_dynamics_in(workspace, &self.tree, &Untraced, q, v, tau, a);
    }

    /// [`MassMatrix::mass_matrix`], written by rows to `matrix` of length NV², in the room of `workspace`.
    pub fn mass_matrix_in<S: Scalar>(&self, workspace: &mut Workspace<S>, q: &[S], matrix: &mut [S]) {
        self.check(&[("q", q)]);
        self.check_length("matrix", matrix, self.tree.nv().pow(2));
        denoc::mass_matrix_in(workspace, &self.tree, &Untraced, q, matrix);
    }

    /// Panics with the first vector of wrong length: coordinates are those whose names begin with q.
    fn check<S>(&self, vectors: &[(&'static str, &[S])]) {
        let (nq, nv) = (self.tree.nq(), self.tree.nv());
        for (name, vector) in vectors {
            self.check_length(name, vector, if name.starts_with('q') { nq } else { nv });
        }
    }

    fn check_length<S>(&self, name: &'static str, vector: &[S], expected: usize) {
        if let Err(mismatch) = LengthMismatch::check(name, vector, expected) {
            let (nq, nv) = (self.tree.nq(), self.tree.nv());
            panic!("{mismatch}: `{}` has {nq} coordinates and {nv} velocities", self.model.name);
        }
    }
}

impl Mechanism for GenericMechanism {
    fn name(&self) -> &str {
        &self.model.name
    }
    fn nq(&self) -> usize {
        self.tree.nq()
    }
    fn nv(&self) -> usize {
        self.tree.nv()
    }
    fn nl(&self) -> usize {
        self.model.links.len()
    }
    fn link_name(&self, index: usize) -> Option<&str> {
        self.model.links.get(index).map(|link| link.name.as_str())
    }
    fn joint_name(&self, index: usize) -> Option<&str> {
        self.model.moving_links().nth(index).map(|link| link.joint_name.as_str())
    }
}

impl<S: Scalar> ConfigurationSpace<S> for GenericMechanism {
    type Coordinates = Vec<S>;
    type Velocities = Vec<S>;
    type State = Vec<S>;
    type Matrix = Vec<Vec<S>>;
    type Links = Vec<LinkState<S>>;

    fn coordinate_rates(&self, q: &Vec<S>, v: &Vec<S>) -> Vec<S> {
        self.check(&[("q", q), ("v", v)]);
        denoc::coordinate_rates(&self.tree, q, v)
    }
    fn coordinate_rates_tangent(&self, q: &Vec<S>, v: &Vec<S>, dq: &Vec<S>) -> Option<Vec<S>> {
        Some(redysim_runtime::coordinate_rates_tangent(self, q, v, dq))
    }
    fn integrate(&self, q: &Vec<S>, dv: &Vec<S>) -> Vec<S> {
        self.check(&[("q", q), ("dv", dv)]);
        denoc::integrate(&self.tree, q, dv)
    }
    fn difference(&self, q0: &Vec<S>, q1: &Vec<S>) -> Vec<S> {
        self.check(&[("q0", q0), ("q1", q1)]);
        denoc::difference(&self.tree, q0, q1)
    }
    fn neutral(&self) -> Vec<S> {
        denoc::neutral(&self.tree)
    }
}

impl<S: Scalar> InverseDynamics<S> for GenericMechanism {
    fn inverse_dynamics(&self, q: &Vec<S>, v: &Vec<S>, a: &Vec<S>) -> Vec<S> {
        self.check(&[("q", q), ("v", v), ("a", a)]);
        denoc::inverse_dynamics(&self.tree, &Untraced, q, v, a)
    }
    fn inverse_dynamics_tangent(&self, at: Arguments<'_, S, Self>, slopes: Arguments<'_, S, Self>) -> Option<Vec<S>> {
        Some(redysim_runtime::inverse_dynamics_tangent(self, at, slopes))
    }
}

impl<S: Scalar> ForwardDynamics<S> for GenericMechanism {
    /// By the O(n) recursion, which stays accurate for chains of any length.
    fn forward_dynamics(&self, q: &Vec<S>, v: &Vec<S>, tau: &Vec<S>) -> Vec<S> {
        self.check(&[("q", q), ("v", v), ("tau", tau)]);
        denoc::forward_dynamics(Method::Recursion, &self.tree, &Untraced, q, v, tau)
    }
    fn forward_dynamics_tangent(&self, at: Arguments<'_, S, Self>, slopes: Arguments<'_, S, Self>) -> Option<Vec<S>> {
        Some(redysim_runtime::forward_dynamics_tangent(self, at, slopes))
    }
}

impl<S: Scalar> MassMatrix<S> for GenericMechanism {
    fn mass_matrix(&self, q: &Vec<S>) -> Vec<Vec<S>> {
        self.check(&[("q", q)]);
        denoc::mass_matrix(&self.tree, &Untraced, q)
    }
}

impl<S: Scalar> BiasForces<S> for GenericMechanism {
    fn bias_forces(&self, q: &Vec<S>, v: &Vec<S>) -> Vec<S> {
        self.check(&[("q", q), ("v", v)]);
        denoc::bias_forces(&self.tree, &Untraced, q, v)
    }
}

impl<S: Scalar> GravityForces<S> for GenericMechanism {
    fn gravity_forces(&self, q: &Vec<S>) -> Vec<S> {
        self.check(&[("q", q)]);
        denoc::gravity_forces(&self.tree, &Untraced, q)
    }
}

impl<S: Scalar> MechanicalEnergy<S> for GenericMechanism {
    fn energy(&self, q: &Vec<S>, v: &Vec<S>) -> Energy<S> {
        self.check(&[("q", q), ("v", v)]);
        denoc::energy(&self.tree, &Untraced, q, v)
    }
}

impl<S: Scalar> MassCenter<S> for GenericMechanism {
    fn center_of_mass(&self, q: &Vec<S>, v: &Vec<S>) -> CenterOfMass<S> {
        self.check(&[("q", q), ("v", v)]);
        denoc::center_of_mass(&self.tree, &Untraced, q, v)
    }
}

impl<S: Scalar> LinkKinematics<S> for GenericMechanism {
    fn link_kinematics(&self, q: &Vec<S>, v: &Vec<S>) -> Vec<LinkState<S>> {
        self.check(&[("q", q), ("v", v)]);
        denoc::link_kinematics(&self.tree, &Untraced, q, v)
    }
}

impl LoopRows for GenericMechanism {
    fn nc(&self) -> usize {
        self.tree.loops_of_rows().count()
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
        self.check(&[("q", q)]);
        denoc::loop_residual(&self.tree, &Untraced, q)
    }
    fn loop_jacobian(&self, q: &Vec<S>) -> Vec<Vec<S>> {
        self.check(&[("q", q)]);
        denoc::loop_jacobian(&self.tree, &Untraced, q)
    }
    fn loop_bias(&self, q: &Vec<S>, v: &Vec<S>) -> Vec<S> {
        self.check(&[("q", q), ("v", v)]);
        denoc::loop_bias(&self.tree, &Untraced, q, v)
    }
}
