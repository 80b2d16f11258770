//! What robots with several limbs compute side by side, in the lanes of vectors, is the same bits in C. Their code takes
//! long to compile: `.ci/run` alone has these tests, for any processor with the feature `deterministic`.

use super::compilers::compilers;
use super::program::{InC, State};
use super::{builds, configuration, same_bits_by, states, trig, vector};
use redysim::function::Argument;
use redysim::{ForwardDynamics, Function, InverseDynamics, Real, redysim};
use redysim_codegen::CScalar;

redysim! { struct Quadruped("models/quadruped.toml", functions = [inverse_dynamics, forward_dynamics, mass_matrix]); }
redysim! { struct Humanoid("models/peers/humanoid30.toml", functions = [inverse_dynamics]); }

#[test]
fn four_legs_side_by_side_compute_the_same_bits_in_c() {
    fn compare<T: Real>(scalar: CScalar) {
        let functions = "functions = [\"inverse_dynamics\", \"forward_dynamics\", \"mass_matrix\"]";
        let in_c = InC::new("quadruped", functions, scalar);
        let states = states::<T>(&Quadruped);
        let called = |function, state: &State<T>| {
            let [v, a, tau] = [Argument::Velocities, Argument::Accelerations, Argument::Forces]
                .map(|name| vector::<T, [T; Quadruped::NV]>(state, name));
            let q = vector(state, Argument::Coordinates);
            match function {
                Function::InverseDynamics => Some(InverseDynamics::inverse_dynamics(&Quadruped, &q, &v, &a).to_vec()),
                Function::ForwardDynamics => Some(ForwardDynamics::forward_dynamics(&Quadruped, &q, &v, &tau).to_vec()),
                Function::MassMatrix => Some(Quadruped::mass_matrix(&q).concat()),
                _ => configuration(&Quadruped, function, state),
            }
        };
        same_bits_by(compilers(), builds(), &in_c, &Quadruped, &states, trig!(Quadruped::joint_trig), &called);
    }
    compare::<f64>(CScalar::F64);
    compare::<f32>(CScalar::F32);
}

#[test]
fn two_arms_and_two_legs_side_by_side_compute_the_same_bits_in_c() {
    let in_c = InC::new("peers/humanoid30", "functions = [\"inverse_dynamics\"]", CScalar::F64);
    let states = states::<f64>(&Humanoid);
    same_bits_by(compilers(), builds(), &in_c, &Humanoid, &states, trig!(Humanoid::joint_trig), &|function, state| {
        let [q, v, a] = [Argument::Coordinates, Argument::Velocities, Argument::Accelerations]
            .map(|name| vector::<f64, [f64; Humanoid::NV]>(state, name));
        match function {
            Function::InverseDynamics => Some(InverseDynamics::inverse_dynamics(&Humanoid, &q, &v, &a).to_vec()),
            _ => configuration(&Humanoid, function, state),
        }
    });
}
