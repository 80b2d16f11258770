//! The functions of a mechanism on slices, whatever its own vectors are made of.

use redysim::{
    BiasForces, CenterOfMass, ConfigurationSpace, CoriolisMatrix, Energy, ForwardDynamics, FrameJacobian, Frames,
    GravityForces, HybridDynamics, HybridMotion, InverseDynamics, LinkKinematics, LinkState, LoopClosure, MassCenter,
    MassMatrix, MechanicalEnergy, Mechanism, Momentum, PassiveForces, Scalar, TotalMomentum, Vector,
};

fn vector<S: Scalar, V: Vector<S>>(values: &[S]) -> V {
    V::from_fn(values.len(), |i| values[i])
}

/// Constants as scalars.
pub fn constants<S: Scalar>(values: &[f64]) -> Vec<S> {
    values.iter().map(|&value| S::from_f64(value)).collect()
}

pub fn inverse_dynamics<S: Scalar>(m: &impl InverseDynamics<S>, q: &[S], v: &[S], a: &[S]) -> Vec<S> {
    m.inverse_dynamics(&vector(q), &vector(v), &vector(a)).as_ref().to_vec()
}

pub fn forward_dynamics<S: Scalar>(m: &impl ForwardDynamics<S>, q: &[S], v: &[S], tau: &[S]) -> Vec<S> {
    m.forward_dynamics(&vector(q), &vector(v), &vector(tau)).as_ref().to_vec()
}

/// By rows.
pub fn mass_matrix<S: Scalar>(m: &impl MassMatrix<S>, q: &[S]) -> Vec<Vec<S>> {
    m.mass_matrix(&vector(q)).as_ref().iter().map(|row| row.as_ref().to_vec()).collect()
}

pub fn bias_forces<S: Scalar>(m: &impl BiasForces<S>, q: &[S], v: &[S]) -> Vec<S> {
    m.bias_forces(&vector(q), &vector(v)).as_ref().to_vec()
}

/// By rows.
pub fn coriolis_matrix<S: Scalar>(m: &impl CoriolisMatrix<S>, q: &[S], v: &[S]) -> Vec<Vec<S>> {
    m.coriolis_matrix(&vector(q), &vector(v)).as_ref().iter().map(|row| row.as_ref().to_vec()).collect()
}

pub fn gravity_forces<S: Scalar>(m: &impl GravityForces<S>, q: &[S]) -> Vec<S> {
    m.gravity_forces(&vector(q)).as_ref().to_vec()
}

pub fn passive_forces<S: Scalar>(m: &impl PassiveForces<S>, q: &[S], v: &[S]) -> Vec<S> {
    m.passive_forces(&vector(q), &vector(v)).as_ref().to_vec()
}

pub fn energy<S: Scalar>(m: &impl MechanicalEnergy<S>, q: &[S], v: &[S]) -> Energy<S> {
    m.energy(&vector(q), &vector(v))
}

pub fn center_of_mass<S: Scalar>(m: &impl MassCenter<S>, q: &[S], v: &[S]) -> CenterOfMass<S> {
    m.center_of_mass(&vector(q), &vector(v))
}

pub fn momentum<S: Scalar>(m: &impl TotalMomentum<S>, q: &[S], v: &[S]) -> Momentum<S> {
    m.momentum(&vector(q), &vector(v))
}

pub fn coordinate_rates<S: Scalar>(m: &impl ConfigurationSpace<S>, q: &[S], v: &[S]) -> Vec<S> {
    m.coordinate_rates(&vector(q), &vector(v)).as_ref().to_vec()
}

pub fn integrate<S: Scalar>(m: &impl ConfigurationSpace<S>, q: &[S], dv: &[S]) -> Vec<S> {
    m.integrate(&vector(q), &vector(dv)).as_ref().to_vec()
}

pub fn difference<S: Scalar>(m: &impl ConfigurationSpace<S>, q0: &[S], q1: &[S]) -> Vec<S> {
    m.difference(&vector(q0), &vector(q1)).as_ref().to_vec()
}

pub fn neutral<S: Scalar>(m: &impl ConfigurationSpace<S>) -> Vec<S> {
    m.neutral().as_ref().to_vec()
}

pub fn hybrid_dynamics<S: Scalar, M: HybridDynamics<S>>(
    m: &M,
    q: &[S],
    v: &[S],
    u: &[S],
) -> HybridMotion<M::Velocities> {
    m.hybrid_dynamics(&vector(q), &vector(v), &vector(u))
}

pub fn dissipated_power<S: Scalar>(m: &impl ConfigurationSpace<S>, q: &[S], v: &[S]) -> S {
    m.dissipated_power(&vector(q), &vector(v))
}

pub fn link_kinematics<S: Scalar>(m: &impl LinkKinematics<S>, q: &[S], v: &[S]) -> Vec<LinkState<S>> {
    m.link_kinematics(&vector(q), &vector(v)).as_ref().to_vec()
}

/// The functions of frames by their numbers: kinematics, Jacobians, bias and joint forces.
pub fn frames<S: Scalar, M: Frames<S>>(mechanism: &M, q: &[S], v: &[S], wrenches: &M::Wrenches) -> [Vec<S>; 4] {
    let (q, v) = (vector(q), vector(v));
    let states = mechanism.frame_kinematics(&q, &v);
    let states = states.as_ref().iter().flat_map(|state| {
        [state.rotation.concat(), [state.origin, state.velocity, state.angular_velocity].concat()].concat()
    });
    let jacobians = mechanism.frame_jacobians(&q);
    let rows = |FrameJacobian { linear, angular }: &FrameJacobian<M::Velocities>| {
        linear.iter().chain(angular).flat_map(|row| row.as_ref().to_vec()).collect::<Vec<S>>()
    };
    let bias = mechanism.frame_bias(&q, &v);
    let bias = bias.as_ref().iter().flat_map(|bias| [bias.linear, bias.angular].concat());
    let forces = mechanism.frame_forces(&q, wrenches);
    [states.collect(), jacobians.as_ref().iter().flat_map(rows).collect(), bias.collect(), forces.as_ref().to_vec()]
}

pub fn loop_residual<S: Scalar, M: ConfigurationSpace<S> + LoopClosure<S, M>>(m: &M, q: &[S]) -> Vec<S> {
    m.loop_residual(&vector(q)).as_ref().to_vec()
}

/// By rows.
pub fn loop_jacobian<S: Scalar, M: ConfigurationSpace<S> + LoopClosure<S, M>>(m: &M, q: &[S]) -> Vec<Vec<S>> {
    m.loop_jacobian(&vector(q)).as_ref().iter().map(|row| row.as_ref().to_vec()).collect()
}

pub fn loop_bias<S: Scalar, M: ConfigurationSpace<S> + LoopClosure<S, M>>(m: &M, q: &[S], v: &[S]) -> Vec<S> {
    m.loop_bias(&vector(q), &vector(v)).as_ref().to_vec()
}
