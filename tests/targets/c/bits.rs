//! What the functions in C give is what those in Rust give, to the bit, in `double` and in `float`.

use super::compilers::compilers;
use super::program::{InC, State, numbers};
use super::{assert_same_bits, builds, configuration, same_bits_by, states, tree, trig, vector};
use crate::common::call;
use crate::common::random::Random;
use crate::robots::{Gripper, Kr5};
use crate::robots_in_space::Floating;
use redysim::function::Argument;
use redysim::{ConfigurationSpace, Function, HybridDynamics, LoopClosure, Real, Wrench, redysim};
use redysim_codegen::CScalar;
use std::f64::consts::FRAC_PI_2;

redysim! { pub struct Fourbar("models/fourbar.toml"); }
redysim! { pub struct BallFourbar("models/ball_fourbar.toml"); }
redysim! { pub struct Cuts("models/test/cuts.toml", functions = [loop_residual, loop_jacobian, loop_bias]); }
redysim! { pub struct Machine("models/test/frames.toml"); }
redysim! { struct Pendulum("models/simple_pendulum.toml", functions = [gravity_forces]); }

/// What Rust computes of an arm on a floating base.
pub fn by_floating<T: Real>(function: Function, state: &State<T>) -> Option<Vec<T>> {
    if function != Function::HybridDynamics {
        return tree(&Floating, function, state);
    }
    let [q, v, u] = [Argument::Coordinates, Argument::Velocities, Argument::Given];
    let motion = HybridDynamics::hybrid_dynamics(&Floating, &vector(state, q), &vector(state, v), &vector(state, u));
    Some([motion.a, motion.tau].concat())
}

/// What Rust computes of a closed loop.
pub fn by_fourbar<T: Real>(function: Function, state: &State<T>) -> Option<Vec<T>> {
    of_loops(&Fourbar, function, state).or_else(|| tree(&Fourbar, function, state))
}

/// What Rust computes of frames and wrenches.
pub fn by_machine<T: Real>(function: Function, state: &State<T>) -> Option<Vec<T>> {
    let wrenches = numbers(state, Argument::Wrenches);
    let wrench = |i: usize| {
        let of = |first: usize| core::array::from_fn(|k| wrenches[6 * i + first + k]);
        Wrench { force: of(0), moment: of(3) }
    };
    let wrenches: [Wrench<T>; Machine::NF] = core::array::from_fn(wrench);
    let [q, v] = [Argument::Coordinates, Argument::Velocities].map(|name| numbers(state, name));
    let [kinematics, jacobians, bias, forces] = call::frames(&Machine, q, v, &wrenches);
    match function {
        Function::FrameKinematics => Some(kinematics),
        Function::FrameJacobians => Some(jacobians),
        Function::FrameBias => Some(bias),
        Function::FrameForces => Some(forces),
        _ => tree(&Machine, function, state),
    }
}

#[test]
fn an_arm_computes_the_same_bits_in_c() {
    fn compare<T: Real>(scalar: CScalar) {
        let in_c = InC::new("kr5", "", scalar);
        let states = states::<T>(&Kr5);
        same_bits_by::<T>(compilers(), &[&[]], &in_c, &Kr5, &states, trig!(Kr5::joint_trig), &|function, state| {
            tree(&Kr5, function, state)
        });
    }
    compare::<f64>(CScalar::F64);
    compare::<f32>(CScalar::F32);
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run natively, by .ci/run")]
fn fingers_with_parallel_axes_compute_the_same_bits_in_c() {
    assert_same_bits!(Gripper, "gripper", "", |function, state| tree(&Gripper, function, state));
}

/// The functions of closed loops.
pub fn of_loops<T: Real, M>(m: &M, function: Function, state: &State<T>) -> Option<Vec<T>>
where
    M: ConfigurationSpace<T> + LoopClosure<T, M>,
{
    let [q, v] = [Argument::Coordinates, Argument::Velocities].map(|argument| numbers(state, argument));
    Some(match function {
        Function::LoopResidual => call::loop_residual(m, q),
        Function::LoopJacobian => call::loop_jacobian(m, q).concat(),
        Function::LoopBias => call::loop_bias(m, q, v),
        _ => return None,
    })
}

#[test]
fn closed_loops_compute_the_same_bits_in_c() {
    assert_same_bits!(Fourbar, "fourbar", "", by_fourbar);
}

/// Angles of every size, many of them beside multiples of quarter turns, where the reduction takes most digits.
fn pendulums<T: Real>() -> Vec<State<T>> {
    let mut random = Random::new(2);
    let angle = |index: usize| {
        let size = 10.0_f64.powf(random.within(18.0) + 6.0);
        let multiple = (random.within(size) / FRAC_PI_2).round() * FRAC_PI_2;
        let beside = 10.0_f64.powf(random.within(10.0) - 10.0);
        if index.is_multiple_of(2) { random.within(size) } else { multiple * (1.0 + random.within(beside)) }
    };
    let state =
        |q: f64| [q, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0].map(|x| vec![T::from_f64(x)]).into_iter().chain([vec![]]);
    (0..50_000).map(angle).map(|q| state(q).collect()).collect()
}

#[test]
fn sines_of_angles_of_all_sizes_are_the_same_bits_in_c() {
    fn compare<T: Real>(scalar: CScalar) {
        let in_c = InC::new("simple_pendulum", "functions = [\"gravity_forces\"]", scalar);
        let states = pendulums::<T>();
        let called = |function, state: &State<T>| match function {
            Function::GravityForces => {
                Some(Pendulum::gravity_forces(&vector::<T, [T; 1]>(state, Argument::Coordinates)).to_vec())
            }
            _ => configuration(&Pendulum, function, state),
        };
        same_bits_by(compilers(), builds(), &in_c, &Pendulum, &states, trig!(Pendulum::joint_trig), &called);
    }
    compare::<f64>(CScalar::F64);
    compare::<f32>(CScalar::F32);
}
