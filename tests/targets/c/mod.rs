//! The code in C is that in Rust: it compiles without warnings, computes the same bits, and its program that checks it
//! finds no fault.
//!
//! In C nothing is fused where `REDYSIM_FMA` is not defined, as in Rust with the feature `deterministic` and on targets
//! without the instruction; where Rust fuses here, so does C.
#![cfg(feature = "generic")]

mod cpp;
mod program;

use crate::NATIVE;
use crate::common::call;
use crate::common::random::Random;
use crate::robots::{Gripper, Kr5};
use crate::robots_in_space::Floating;
use program::{InC, State, compilers, is_of, numbers};
use rayon::prelude::*;
use redysim::function::Argument;
use redysim::{
    ConfigurationSpace, Energy, FUSED, ForwardDynamics, Function, HybridDynamics, InverseDynamics, LinkState,
    LoopClosure, Mechanism, Real, TreeDynamics, Vector, Wrench, redysim,
};
use redysim_codegen::CScalar;
use std::f64::consts::{FRAC_PI_2, PI};

redysim! { pub struct Fourbar("models/fourbar.toml"); }
redysim! { pub struct Machine("models/test/frames.toml"); }
redysim! { struct Given("models/gripper.toml", parameters = ["gravity", "link3.mass", "link3.com", "link3.inertia", "joint2.damping"]); }
redysim! { struct Worn("models/test/bushing.toml", parameters = ["hull.damping", "ball.stiffness", "ball.rest"]); }
redysim! { struct Pendulum("models/simple_pendulum.toml", functions = [gravity_forces]); }
redysim! { struct Quadruped("models/quadruped.toml", functions = [inverse_dynamics, forward_dynamics, mass_matrix]); }
redysim! { struct Humanoid("models/peers/humanoid30.toml", functions = [inverse_dynamics]); }
redysim! { struct Chain("models/peers/chain40.toml", functions = [inverse_dynamics, forward_dynamics]); }

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
    let own: Vec<String> = compilers().into_iter().take(1).collect();
    same_bits_by(&own, &[&[]], in_c, mechanism, &states::<T>(mechanism), trig, called);
}

/// The flags of the builds that give the same bits: with the vectors that every processor of this kind has, with those of the
/// processor at hand, which fused operations need, and without any. Compiled for every processor, the first alone: `.ci/run`
/// compiles these tests for the processor at hand, once with fused operations and once without.
fn builds() -> &'static [&'static [&'static str]] {
    const FOR_HERE: &str = if cfg!(target_arch = "x86_64") { "-march=native" } else { "-mcpu=native" };
    if NATIVE { &[&[], &[FOR_HERE], &["-DREDYSIM_VECTORS=0"]] } else { &[&[]] }
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
        let flags = [&["-O1"], fused, build].concat();
        let found = in_c.results::<T>(compiler, &flags, states);
        let mut rest = found.as_slice();
        for (index, state) in states.iter().enumerate() {
            let mut compare = |name: &str, expected: &[T]| {
                let (found, others) = rest.split_at(expected.len());
                rest = others;
                let same = |(x, y): (&T, &T)| {
                    let [x, y] = [x, y].map(|x| x.to_f64());
                    x.to_bits() == y.to_bits() || (x.is_nan() && y.is_nan())
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

/// Sines, then cosines, of a type's angles.
macro_rules! trig {
    ($robot:ident) => {
        |q| {
            let trig = $robot::joint_trig(&core::array::from_fn(|i| q[i]));
            [trig.sin.to_vec(), trig.cos.to_vec()].concat()
        }
    };
}

#[test]
fn an_arm_computes_the_same_bits_in_c() {
    let in_c = InC::new("kr5", "", CScalar::F64);
    let states = states::<f64>(&Kr5);
    same_bits_by::<f64>(&compilers(), &[&[]], &in_c, &Kr5, &states, trig!(Kr5), &|function, state| {
        tree(&Kr5, function, state)
    });
}

#[test]
fn an_arm_computes_the_same_bits_in_single_precision_in_c() {
    let in_c = InC::new("kr5", "", CScalar::F32);
    let states = states::<f32>(&Kr5);
    same_bits_by::<f32>(&compilers(), &[&[]], &in_c, &Kr5, &states, trig!(Kr5), &|function, state| {
        tree(&Kr5, function, state)
    });
}

#[test]
fn fingers_with_parallel_axes_compute_the_same_bits_in_c() {
    for scalar in [CScalar::F64, CScalar::F32] {
        let in_c = InC::new("gripper", "", scalar);
        match scalar {
            CScalar::F64 => same_bits::<f64>(&in_c, &Gripper, trig!(Gripper), &|f, state| tree(&Gripper, f, state)),
            CScalar::F32 => same_bits::<f32>(&in_c, &Gripper, trig!(Gripper), &|f, state| tree(&Gripper, f, state)),
        }
    }
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run natively, by .ci/run")]
fn a_floating_arm_with_quaternion_and_hybrid_dynamics_computes_the_same_bits_in_c() {
    let in_c = InC::new("kr5_floating", "", CScalar::F64);
    same_bits::<f64>(&in_c, &Floating, trig!(Floating), &|function, state| match function {
        Function::HybridDynamics => {
            let [q, v, u] = [Argument::Coordinates, Argument::Velocities, Argument::Given];
            let motion =
                HybridDynamics::hybrid_dynamics(&Floating, &vector(state, q), &vector(state, v), &vector(state, u));
            Some([motion.a, motion.tau].concat())
        }
        _ => tree(&Floating, function, state),
    });
}

#[test]
fn closed_loops_compute_the_same_bits_in_c() {
    let in_c = InC::new("fourbar", "", CScalar::F64);
    same_bits::<f64>(&in_c, &Fourbar, trig!(Fourbar), &|function, state| {
        let [q, v]: [[f64; Fourbar::NV]; 2] =
            [Argument::Coordinates, Argument::Velocities].map(|name| vector(state, name));
        match function {
            Function::LoopResidual => Some(LoopClosure::loop_residual(&Fourbar, &q).to_vec()),
            Function::LoopJacobian => Some(LoopClosure::loop_jacobian(&Fourbar, &q).concat()),
            Function::LoopBias => Some(LoopClosure::loop_bias(&Fourbar, &q, &v).to_vec()),
            _ => tree(&Fourbar, function, state),
        }
    });
}

#[test]
fn frames_and_wrenches_compute_the_same_bits_in_c() {
    let in_c = InC::new("test/frames", "", CScalar::F64);
    same_bits::<f64>(&in_c, &Machine, trig!(Machine), &|function, state| {
        let wrenches = numbers(state, Argument::Wrenches);
        let wrench = |i: usize| {
            let of = |first: usize| core::array::from_fn(|k| wrenches[6 * i + first + k]);
            Wrench { force: of(0), moment: of(3) }
        };
        let wrenches: [Wrench<f64>; Machine::NF] = core::array::from_fn(wrench);
        let [q, v] = [Argument::Coordinates, Argument::Velocities].map(|name| numbers(state, name));
        let [kinematics, jacobians, bias, forces] = call::frames(&Machine, q, v, &wrenches);
        match function {
            Function::FrameKinematics => Some(kinematics),
            Function::FrameJacobians => Some(jacobians),
            Function::FrameBias => Some(bias),
            Function::FrameForces => Some(forces),
            _ => tree(&Machine, function, state),
        }
    });
}

#[test]
fn run_time_parameters_give_the_same_bits_in_c() {
    let options = "parameters = [\"gravity\", \"link3.mass\", \"link3.com\", \"link3.inertia\", \"joint2.damping\"]";
    let in_c = InC::new("gripper", options, CScalar::F64);
    let robot = Given::<f64>::default();
    let trig = |q: &[f64]| {
        let trig = robot.joint_trig(&core::array::from_fn(|i| q[i]));
        [trig.sin.to_vec(), trig.cos.to_vec()].concat()
    };
    same_bits::<f64>(&in_c, &robot, trig, &|function, state| tree(&robot, function, state));
}

#[test]
fn run_time_parameters_are_checked_in_c_as_in_rust() {
    let options = "parameters = [\"gravity\", \"link3.mass\", \"link3.com\", \"link3.inertia\", \"joint2.damping\"]";
    let in_c = InC::new("gripper", options, CScalar::F64);
    let mut lists = vec![Given::PARAMETERS];
    for index in 0..Given::NP {
        // With a tensor that no body has, a negative number, and one that is not finite.
        lists.extend([-1.0, 1e-3, f64::NAN].map(|number| {
            let mut list = Given::PARAMETERS;
            list[index] = number;
            list
        }));
    }
    let status = |list: &[f64; Given::NP]| Given::try_new(list).map_or_else(|error| error.index + 1, |_| 0);
    let expected: Vec<usize> = lists.iter().map(status).collect();
    assert!(expected.contains(&0) && expected.iter().filter(|&&status| status > 0).count() > Given::NP);
    let lists: Vec<Vec<f64>> = lists.iter().map(|list| list.to_vec()).collect();
    compilers().iter().for_each(|compiler| assert_eq!(in_c.statuses(compiler, &lists), expected, "{compiler}"));
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run natively, by .ci/run")]
fn what_acts_in_joints_of_several_freedoms_is_the_same_bits_in_c_and_checked_as_in_rust() {
    let options = "parameters = [\"hull.damping\", \"ball.stiffness\", \"ball.rest\"]";
    let in_c = InC::new("test/bushing", options, CScalar::F64);
    let robot = Worn::<f64>::default();
    let trig = |q: &[f64]| {
        let trig = robot.joint_trig(&core::array::from_fn(|i| q[i]));
        [trig.sin.to_vec(), trig.cos.to_vec()].concat()
    };
    same_bits::<f64>(&in_c, &robot, trig, &|function, state| tree(&robot, function, state));
    // The last four are a quaternion, of which the second and the last are not zero in the model.
    let mut lists = [Worn::PARAMETERS; 5];
    lists[1][2] = -1.0;
    lists[2][Worn::NP - 1] = 0.0;
    lists[3][Worn::NP - 4..].fill(0.0);
    lists[4][Worn::NP - 2] = f64::INFINITY;
    let status = |list: &[f64; Worn::NP]| Worn::try_new(list).map_or_else(|error| error.index + 1, |_| 0);
    let expected = lists.map(|list| status(&list));
    assert_eq!(expected, [0, 3, 0, Worn::NP - 3, Worn::NP - 1]);
    let lists = lists.map(Vec::from);
    compilers().iter().for_each(|compiler| assert_eq!(in_c.statuses(compiler, &lists), expected, "{compiler}"));
}

#[test]
fn the_loops_of_a_long_chain_compute_the_same_bits_in_c() {
    let in_c = InC::new("peers/chain40", "functions = [\"inverse_dynamics\", \"forward_dynamics\"]", CScalar::F64);
    same_bits::<f64>(&in_c, &Chain, trig!(Chain), &|function, state| {
        let [q, v, a, tau] = [Argument::Coordinates, Argument::Velocities, Argument::Accelerations, Argument::Forces]
            .map(|name| vector(state, name));
        match function {
            Function::InverseDynamics => Some(InverseDynamics::inverse_dynamics(&Chain, &q, &v, &a).to_vec()),
            Function::ForwardDynamics => Some(ForwardDynamics::forward_dynamics(&Chain, &q, &v, &tau).to_vec()),
            _ => configuration(&Chain, function, state),
        }
    });
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run natively, by .ci/run")]
fn four_legs_side_by_side_compute_the_same_bits_in_c() {
    fn compare<T: Real>(scalar: CScalar) {
        let functions = "functions = [\"inverse_dynamics\", \"forward_dynamics\", \"mass_matrix\"]";
        let in_c = InC::new("quadruped", functions, scalar);
        let states = states::<T>(&Quadruped);
        same_bits_by(&compilers(), builds(), &in_c, &Quadruped, &states, trig!(Quadruped), &|function, state| {
            let [v, a, tau] = [Argument::Velocities, Argument::Accelerations, Argument::Forces]
                .map(|name| vector::<T, [T; Quadruped::NV]>(state, name));
            let q = vector(state, Argument::Coordinates);
            match function {
                Function::InverseDynamics => Some(InverseDynamics::inverse_dynamics(&Quadruped, &q, &v, &a).to_vec()),
                Function::ForwardDynamics => Some(ForwardDynamics::forward_dynamics(&Quadruped, &q, &v, &tau).to_vec()),
                Function::MassMatrix => Some(Quadruped::mass_matrix(&q).concat()),
                _ => configuration(&Quadruped, function, state),
            }
        });
    }
    compare::<f64>(CScalar::F64);
    compare::<f32>(CScalar::F32);
}

/// Its square roots are those of four legs.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run natively, by .ci/run")]
fn friction_in_four_legs_side_by_side_is_within_the_stated_roundings_in_c() {
    let file = format!("{}/models/quadruped.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(file).expect("the model");
    let joint = "joint = \"revolute\"\n";
    let rough = text.replace(joint, &format!("{joint}friction = 0.3\nfriction_velocity = 0.02\n"));
    for scalar in [CScalar::F64, CScalar::F32] {
        let options = "functions = [\"inverse_dynamics\", \"forward_dynamics\"]";
        let in_c = InC::of_text(&rough, "rough_quadruped", options, scalar);
        assert!(in_c.source().contains("REDYSIM_FOUR_SQUARE_ROOT(REDYSIM_FOUR_MULTIPLY_ADD("));
        for (compiler, build) in
            compilers().iter().flat_map(|compiler| builds().iter().map(move |build| (compiler, build)))
        {
            in_c.check(compiler, &[&["-O1"], *build].concat());
        }
    }
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run natively, by .ci/run")]
fn two_arms_and_two_legs_side_by_side_compute_the_same_bits_in_c() {
    let in_c = InC::new("peers/humanoid30", "functions = [\"inverse_dynamics\"]", CScalar::F64);
    let states = states::<f64>(&Humanoid);
    same_bits_by(&compilers(), builds(), &in_c, &Humanoid, &states, trig!(Humanoid), &|function, state| {
        let [q, v, a] = [Argument::Coordinates, Argument::Velocities, Argument::Accelerations]
            .map(|name| vector::<f64, [f64; Humanoid::NV]>(state, name));
        match function {
            Function::InverseDynamics => Some(InverseDynamics::inverse_dynamics(&Humanoid, &q, &v, &a).to_vec()),
            _ => configuration(&Humanoid, function, state),
        }
    });
}

/// Far from the origin, too, where a free body's momentum is a small difference.
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run natively, by .ci/run")]
fn the_check_of_every_shipped_model_finds_no_fault() {
    let folder = format!("{}/models", env!("CARGO_MANIFEST_DIR"));
    let files = std::fs::read_dir(folder).expect("the models").map(|entry| entry.expect("an entry").path());
    let models: Vec<_> = files.filter(|path| path.extension().is_some_and(|extension| extension == "toml")).collect();
    assert!(models.len() > 30);
    let compiler = &compilers()[0];
    models.par_iter().for_each(|path| {
        let name = path.file_stem().and_then(|name| name.to_str()).expect("a name");
        InC::new(name, "", CScalar::F64).check(compiler, &["-O0"]);
    });
}

#[test]
fn the_header_is_one_of_cpp_too() {
    let options = "parameters = [\"gravity\", \"link6.mass\"]";
    for (model, options) in [("kr5_tool", options), ("test/frames", "")] {
        let in_c = InC::new(model, options, CScalar::F64);
        compilers().iter().for_each(|compiler| in_c.read_by_cpp(compiler));
    }
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
        same_bits_by(&compilers(), builds(), &in_c, &Pendulum, &states, trig!(Pendulum), &|function, state| {
            match function {
                Function::GravityForces => {
                    Some(Pendulum::gravity_forces(&vector::<T, [T; 1]>(state, Argument::Coordinates)).to_vec())
                }
                _ => configuration(&Pendulum, function, state),
            }
        });
    }
    compare::<f64>(CScalar::F64);
    compare::<f32>(CScalar::F32);
}

/// Within the bounds that the program has, which hold for sines of one unit in the last place.
#[test]
fn sines_of_the_c_library_stay_within_the_stated_roundings() {
    let in_c = InC::new("gripper", "", CScalar::F64);
    for compiler in compilers() {
        in_c.check(&compiler, &["-O1", "-DREDYSIM_LIBM"]);
        in_c.check(&compiler, &["-O1", "-DREDYSIM_SINCOS(x, s, c)=(*(s) = sin(x), *(c) = cos(x))"]);
    }
}
