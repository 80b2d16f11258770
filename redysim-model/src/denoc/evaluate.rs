//! Every function of a mechanism by its name in the table of functions.

use super::trace::Trace;
use super::{
    Method, bias_forces, center_of_mass, coordinate_rates, coriolis_matrix, difference, dissipated_power, energy,
    forward_dynamics, frame_bias, frame_forces, frame_jacobians, frame_kinematics, gravity_forces, hybrid_dynamics,
    integrate, inverse_dynamics, link_kinematics, loop_bias, loop_jacobian, loop_residual, mass_matrix, momentum,
    neutral, passive_forces,
};
use crate::parameter::ParameterIn;
use crate::spatial::{Vec3, Wrench};
use crate::tree::Tree;
use redysim_runtime::{
    CenterOfMass, Energy, FrameAcceleration, FrameState, Function, HybridMotion, LinkState, Momentum, Scalar,
};

/// The values of `function` in the order of its [`Shape`](redysim_runtime::function::Shape); forward dynamics by the
/// recursion. `x` are the arguments that its [signature](Function::signature) lists.
pub fn evaluate<S: Scalar>(
    function: Function,
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    x: &[&[S]],
) -> Vec<S> {
    match function {
        Function::InverseDynamics
        | Function::ForwardDynamics
        | Function::MassMatrix
        | Function::BiasForces
        | Function::GravityForces => evaluate_dynamics(function, tree, trace, x),
        Function::CoriolisMatrix => coriolis_matrix(tree, trace, x[0], x[1]).concat(),
        Function::PassiveForces => passive_forces(tree, trace, x[0], x[1]),
        Function::Energy => {
            let Energy { kinetic, potential } = energy(tree, trace, x[0], x[1]);
            vec![kinetic, potential]
        }
        Function::CenterOfMass => {
            let CenterOfMass { position, velocity } = center_of_mass(tree, trace, x[0], x[1]);
            [position, velocity].concat()
        }
        Function::Momentum => {
            let Momentum { linear, angular } = momentum(tree, trace, x[0], x[1]);
            [linear, angular].concat()
        }
        Function::HybridDynamics => {
            let HybridMotion { a, tau } = hybrid_dynamics(Method::Recursion, tree, trace, x[0], x[1], x[2]);
            [a, tau].concat()
        }
        Function::LinkKinematics => {
            let vectors = link_kinematics(tree, trace, x[0], x[1]).into_iter().flat_map(|link: LinkState<S>| {
                link.rotation.into_iter().chain([link.origin, link.com, link.velocity, link.angular_velocity])
            });
            vectors.flatten().collect()
        }
        Function::FrameKinematics => {
            let vectors = frame_kinematics(tree, trace, x[0], x[1]).into_iter().flat_map(|frame: FrameState<S>| {
                frame.rotation.into_iter().chain([frame.origin, frame.velocity, frame.angular_velocity])
            });
            vectors.flatten().collect()
        }
        Function::FrameJacobians => {
            let rows = frame_jacobians(tree, trace, x[0])
                .into_iter()
                .flat_map(|frame| frame.linear.into_iter().chain(frame.angular));
            rows.flatten().collect()
        }
        Function::FrameBias => {
            let vectors = frame_bias(tree, trace, x[0], x[1])
                .into_iter()
                .flat_map(|frame: FrameAcceleration<S>| [frame.linear, frame.angular]);
            vectors.flatten().collect()
        }
        Function::FrameForces => {
            let (wrenches, _) = x[1].as_chunks();
            let wrench =
                |&[fx, fy, fz, mx, my, mz]: &[S; 6]| Wrench { force: Vec3([fx, fy, fz]), moment: Vec3([mx, my, mz]) };
            frame_forces(tree, trace, x[0], &wrenches.iter().map(wrench).collect::<Vec<_>>())
        }
        Function::LoopResidual => loop_residual(tree, trace, x[0]),
        Function::LoopJacobian => loop_jacobian(tree, trace, x[0]).concat(),
        Function::LoopBias => loop_bias(tree, trace, x[0], x[1]),
        Function::CoordinateRates => coordinate_rates(tree, x[0], x[1]),
        Function::Integrate => integrate(tree, x[0], x[1]),
        Function::Difference => difference(tree, x[0], x[1]),
        Function::Neutral => neutral(tree),
        Function::DissipatedPower => vec![dissipated_power(tree, trace, x[0], x[1])],
    }
}

/// The same of the five functions of the equations of motion, and an empty array of any other: a crate that needs no other
/// compiles a fraction of [`evaluate`] for each scalar.
///
/// They are inverse dynamics, forward dynamics by the recursion, the mass matrix, bias forces and gravity forces.
pub fn evaluate_dynamics<S: Scalar>(
    function: Function,
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    x: &[&[S]],
) -> Vec<S> {
    match function {
        Function::InverseDynamics => inverse_dynamics(tree, trace, x[0], x[1], x[2]),
        Function::ForwardDynamics => forward_dynamics(Method::Recursion, tree, trace, x[0], x[1], x[2]),
        Function::MassMatrix => mass_matrix(tree, trace, x[0]).concat(),
        Function::BiasForces => bias_forces(tree, trace, x[0], x[1]),
        Function::GravityForces => gravity_forces(tree, trace, x[0]),
        _ => Vec::new(),
    }
}
