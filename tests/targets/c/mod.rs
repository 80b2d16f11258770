//! The code in C is that in Rust: it compiles without warnings, computes the same bits, and its program that checks it
//! finds no fault.
//!
//! In C nothing is fused where `REDYSIM_FMA` is not defined, as in Rust with the feature `deterministic` and on targets
//! without the instruction; where Rust fuses here, so does C.
//!
//! For AArch64, LLVM makes one instruction of −fma(a, b, c), which gives zeros the other sign: there, where products and
//! sums are fused, zeros of both signs are the same.
#![cfg(feature = "generic")]

pub mod bits;
mod checks;
mod compilers;
mod cpp;
#[cfg(any(feature = "deterministic", target_feature = "fma", not(target_arch = "x86_64")))]
mod kinds;
mod parameters;
mod program;
#[cfg(any(feature = "deterministic", target_feature = "fma", not(target_arch = "x86_64")))]
mod side_by_side;

use crate::NATIVE;
use crate::common::call;
use crate::common::random::Random;
use compilers::{compilers, is_native};
use program::{InC, State, is_of, numbers};
use redysim::function::Argument;
use redysim::{ConfigurationSpace, Energy, FUSED, Function, LinkState, Mechanism, Real, TreeDynamics, Vector};
use std::f64::consts::{FRAC_PI_2, PI};

/// Whether compilers by LLVM, Rust's among them, may give zeros another sign than the expressions have.
const UNSIGNED_ZEROS: bool = FUSED && cfg!(target_arch = "aarch64");

/// States of each mechanism.
const STATES: usize = 60;

/// States with angles of all sizes, among them multiples of quarter turns.
fn states<T: Real>(mechanism: &impl Mechanism) -> Vec<State<T>> {
    let mut random = Random::new(1);
    let (nq, nv, nf) = (mechanism.nq(), mechanism.nv(), mechanism.nf());
    let state = |index: usize| {
        let size = [PI, 10.0, 1e3, 1e6, 1e9, 1e30][index % 6];
        let mut q = random.vector(nq, size);
        if index % 7 == 6 {
            q.iter_mut().for_each(|q| *q = (*q / FRAC_PI_2).round() * FRAC_PI_2);
        }
        let others = [(nq, 3.0), (nq, 3.0), (nv, 3.0), (nv, 1.0), (nv, 10.0), (nv, 10.0), (nv, 10.0), (6 * nf, 10.0)];
        let others = others.map(|(length, size)| random.vector(length, size));
        let all = std::iter::once(q).chain(others);
        all.map(|numbers| numbers.into_iter().map(T::from_f64).collect()).collect()
    };
    (0..STATES).map(state).collect()
}

/// The result of a function of `mechanism` by its numbers in order; `None` for one that it does not have.
type Call<'a, T> = dyn Fn(Function, &State<T>) -> Option<Vec<T>> + 'a;

fn vector<T: Real, V: Vector<T>>(state: &State<T>, argument: Argument) -> V {
    let numbers = numbers(state, argument);
    V::from_fn(numbers.len(), |i| numbers[i])
}

/// How every mechanism moves.
fn configuration<T: Real>(m: &impl ConfigurationSpace<T>, function: Function, state: &State<T>) -> Option<Vec<T>> {
    let at = |argument| numbers(state, argument);
    Some(match function {
        Function::CoordinateRates => call::coordinate_rates(m, at(Argument::Coordinates), at(Argument::Velocities)),
        Function::Integrate => call::integrate(m, at(Argument::Coordinates), at(Argument::Displacement)),
        Function::Difference => call::difference(m, at(Argument::Start), at(Argument::End)),
        Function::DissipatedPower => {
            vec![m.dissipated_power(&vector(state, Argument::Coordinates), &vector(state, Argument::Velocities))]
        }
        Function::Neutral => call::neutral(m),
        _ => return None,
    })
}

/// The functions of a tree.
fn tree<T: Real>(m: &impl TreeDynamics<T>, function: Function, state: &State<T>) -> Option<Vec<T>> {
    let at = |argument| numbers(state, argument);
    let [q, v] = [Argument::Coordinates, Argument::Velocities].map(at);
    Some(match function {
        Function::InverseDynamics => call::inverse_dynamics(m, q, v, at(Argument::Accelerations)),
        Function::ForwardDynamics => call::forward_dynamics(m, q, v, at(Argument::Forces)),
        Function::MassMatrix => call::mass_matrix(m, q).concat(),
        Function::BiasForces => call::bias_forces(m, q, v),
        Function::CoriolisMatrix => call::coriolis_matrix(m, q, v).concat(),
        Function::GravityForces => call::gravity_forces(m, q),
        Function::PassiveForces => call::passive_forces(m, q, v),
        Function::Energy => {
            let Energy { kinetic, potential } = call::energy(m, q, v);
            vec![kinetic, potential]
        }
        Function::CenterOfMass => {
            let center = call::center_of_mass(m, q, v);
            [center.position, center.velocity].concat()
        }
        Function::Momentum => {
            let momentum = call::momentum(m, q, v);
            [momentum.linear, momentum.angular].concat()
        }
        Function::LinkKinematics => {
            let of = |link: &LinkState<T>| {
                [link.rotation.concat(), [link.origin, link.com, link.velocity, link.angular_velocity].concat()]
                    .concat()
            };
            call::link_kinematics(m, q, v).iter().flat_map(of).collect()
        }
        _ => return configuration(m, function, state),
    })
}

/// Compares all functions of a mechanism in C and in Rust, bit by bit, and runs the program that checks the code.
fn same_bits<T: Real>(in_c: &InC, mechanism: &impl Mechanism, trig: impl Fn(&[T]) -> Vec<T>, called: &Call<T>) {
    // The other compilers of the machine compile the arm, and in all builds what is computed side by side.
    let own = compilers().get(..1).unwrap_or_default();
    same_bits_by(own, &[&[]], in_c, mechanism, &states::<T>(mechanism), trig, called);
}

/// The flag by which a compiler takes all instructions of the processor at hand.
const FOR_HERE: &str = if cfg!(target_arch = "x86_64") { "-march=native" } else { "-mcpu=native" };

/// The flags of the builds that give the same bits: with the vectors that every processor of this kind has, with those of the
/// processor at hand, which fused operations on x86-64 need, and without any. Compiled for every processor, the first alone:
/// `.ci/run` compiles these tests for the processor at hand, once with fused operations and once without. Under an emulator,
/// there is no processor at hand.
fn builds() -> &'static [&'static [&'static str]] {
    match (NATIVE, is_native()) {
        (true, true) => &[&[], &[FOR_HERE], &["-DREDYSIM_VECTORS=0"]],
        (true, false) => &[&[], &["-DREDYSIM_VECTORS=0"]],
        (false, _) => &[&[]],
    }
}

/// The same by the given compilers, in the given builds and at the given states.
fn same_bits_by<T: Real>(
    compilers: &[String],
    builds: &[&[&str]],
    in_c: &InC,
    mechanism: &impl Mechanism,
    states: &[State<T>],
    trig: impl Fn(&[T]) -> Vec<T>,
    called: &Call<T>,
) {
    assert!(is_of(in_c, mechanism));
    let fused: &[&str] = if FUSED { &["-DREDYSIM_FMA"] } else { &[] };
    for (compiler, build) in compilers.iter().flat_map(|compiler| builds.iter().map(move |build| (compiler, build))) {
        // Not optimised, it compiles in a third of the time; `.ci/run` has both.
        let optimised = if NATIVE { "-O1" } else { "-O0" };
        let flags = [&[optimised], fused, build].concat();
        let found = in_c.results::<T>(compiler, &flags, states);
        let mut rest = found.as_slice();
        for (index, state) in states.iter().enumerate() {
            let mut compare = |name: &str, expected: &[T]| {
                let (found, others) = rest.split_at(expected.len());
                rest = others;
                let same = |(x, y): (&T, &T)| {
                    let [x, y] = [x, y].map(|x| x.to_f64());
                    let zeros = UNSIGNED_ZEROS && x == 0.0 && y == 0.0;
                    x.to_bits() == y.to_bits() || (x.is_nan() && y.is_nan()) || zeros
                };
                assert!(
                    found.iter().zip(expected).all(same),
                    "{} {name} by {compiler} {flags:?} in state {index}: {found:?} instead of {expected:?}",
                    mechanism.name()
                );
            };
            compare("joint_trig", &trig(numbers(state, Argument::Coordinates)));
            for &function in in_c.functions() {
                let expected = called(function, state).unwrap_or_else(|| panic!("{function} is not called"));
                compare(function.name(), &expected);
            }
        }
        assert!(rest.is_empty());
        if build.is_empty() {
            in_c.check(compiler, &flags);
        }
    }
}

/// Sines, then cosines, of the angles of `Kr5::joint_trig`, or of `robot.joint_trig` with run-time parameters.
macro_rules! trig {
    ($($joint_trig:tt)+) => {
        |q| {
            let trig = $($joint_trig)+(&core::array::from_fn(|i| q[i]));
            [trig.sin.to_vec(), trig.cos.to_vec()].concat()
        }
    };
}

/// Compares all functions of a type in C and in Rust, bit by bit, in both precisions.
macro_rules! assert_same_bits {
    ($robot:ident, $model:literal, $options:literal, $called:expr) => {{
        fn compare<T: redysim::Real>(scalar: redysim_codegen::CScalar) {
            let in_c = $crate::c::program::InC::new($model, $options, scalar);
            $crate::c::same_bits::<T>(&in_c, &$robot, $crate::c::trig!($robot::joint_trig), &$called);
        }
        compare::<f64>(redysim_codegen::CScalar::F64);
        compare::<f32>(redysim_codegen::CScalar::F32);
    }};
}

use {assert_same_bits, trig};
