//! Mechanisms of other kinds compute the same bits in C: floating bases, cuts, frames, long chains, and run-time parameters
//! of joints with several degrees of freedom. Their code takes long to compile: `.ci/run` alone has these tests, for the
//! processor at hand and with the feature `deterministic`.

use super::bits::{BallFourbar, Cuts, Machine, by_floating, by_machine, of_loops};
use super::parameters::{OF_WORN, assert_statuses};
use super::program::InC;
use super::{assert_same_bits, configuration, same_bits, tree, trig, vector};
use crate::robots_in_space::Floating;
use redysim::function::Argument;
use redysim::{Dual, ForwardDynamics, Function, InverseDynamics, Lift, Real, redysim};
use redysim_codegen::CScalar;

redysim! { struct Chain("models/peers/chain40.toml", functions = [inverse_dynamics, forward_dynamics]); }
redysim! { struct Worn("models/test/bushing.toml", parameters = ["hull.damping", "ball.stiffness", "ball.rest"]); }

#[test]
fn a_floating_arm_with_quaternion_and_hybrid_dynamics_computes_the_same_bits_in_c() {
    assert_same_bits!(Floating, "kr5_floating", "", by_floating);
}

#[test]
fn loops_through_quaternions_compute_the_same_bits_in_c() {
    assert_same_bits!(BallFourbar, "ball_fourbar", "", |function, state| {
        of_loops(&BallFourbar, function, state).or_else(|| tree(&BallFourbar, function, state))
    });
}

#[test]
fn cuts_of_every_kind_compute_the_same_bits_in_c() {
    assert_same_bits!(
        Cuts,
        "test/cuts",
        "functions = [\"loop_residual\", \"loop_jacobian\", \"loop_bias\"]",
        |function, state| { of_loops(&Cuts, function, state).or_else(|| configuration(&Cuts, function, state)) }
    );
}

#[test]
fn frames_and_wrenches_compute_the_same_bits_in_c() {
    assert_same_bits!(Machine, "test/frames", "", by_machine);
}

#[test]
fn the_loops_of_a_long_chain_compute_the_same_bits_in_c() {
    assert_same_bits!(
        Chain,
        "peers/chain40",
        "functions = [\"inverse_dynamics\", \"forward_dynamics\"]",
        |function, state| {
            let [q, v, a, tau] =
                [Argument::Coordinates, Argument::Velocities, Argument::Accelerations, Argument::Forces]
                    .map(|name| vector(state, name));
            match function {
                Function::InverseDynamics => Some(InverseDynamics::inverse_dynamics(&Chain, &q, &v, &a).to_vec()),
                Function::ForwardDynamics => Some(ForwardDynamics::forward_dynamics(&Chain, &q, &v, &tau).to_vec()),
                _ => configuration(&Chain, function, state),
            }
        }
    );
}

#[test]
fn what_acts_in_joints_of_several_freedoms_is_the_same_bits_in_c_and_checked_as_in_rust() {
    fn compare<T: Real + Lift<T> + Lift<Dual<T>>>(scalar: CScalar) {
        let in_c = InC::new("test/bushing", OF_WORN, scalar);
        let robot = Worn::<T>::default();
        same_bits::<T>(&in_c, &robot, trig!(robot.joint_trig), &|function, state| tree(&robot, function, state));
        // The last four are a quaternion, of which the second and the last are not zero in the model.
        let mut lists = [Worn::PARAMETERS; 5];
        lists[1][2] = -1.0;
        lists[2][Worn::NP - 1] = 0.0;
        lists[3][Worn::NP - 4..].fill(0.0);
        lists[4][Worn::NP - 2] = f64::INFINITY;
        let status =
            |list: [f64; Worn::NP]| Worn::try_new(&list.map(T::from_f64)).map_or_else(|error| error.index + 1, |_| 0);
        let expected = lists.map(status);
        assert_eq!(expected, [0, 3, 0, Worn::NP - 3, Worn::NP - 1]);
        assert_statuses(&in_c, &lists, &expected);
    }
    compare::<f64>(CScalar::F64);
    compare::<f32>(CScalar::F32);
}
