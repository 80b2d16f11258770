//! The header for C++ and the package of CMake: a program finds one mechanism where it is installed and builds another
//! one with itself, and computes what Rust computes, to the bit; so does each function of the header, whatever its shapes.

use super::bits::{by_floating, by_fourbar, by_machine};
use super::compilers::{self, compilers, cpp_compiler};
use super::parameters::{Given, OF_GIVEN};
use super::program::State;
use crate::NATIVE;
use crate::common::tools::{all_tools, skip};
use crate::robots::{Gripper, Kr5};
use redysim::function::{Argument, Dimension};
use redysim::{FUSED, Function, LinkState};
use redysim_codegen::{COptions, CScalar, CppFiles, cpp_files};
use redysim_model::{Model, Tree};
use std::path::Path;
use std::process::Command;

const USER: &str = r#"
#include "given.hpp"
#include "kr5.hpp"
#include "single.hpp"
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstring>

static void print(double x)
{
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    std::printf("%016" PRIx64 "\n", bits);
}

template <typename T, std::size_t N> void print(const std::array<T, N> &numbers)
{
    for (const T &number : numbers) {
        print(number);
    }
}

int main()
{
    {
        namespace robot = redysim::kr5;
        const robot::Coordinates q{{0.3, -0.8, 1.1, 2.0, -9.0, 0.7}};
        const robot::Velocities v{{1.0, -2.0, 3.0, 0.5, -0.25, 2.0}};
        const robot::Velocities a{{-1.0, 4.0, 0.5, 2.0, 1.0, -3.0}};
        const robot::JointTrig trig = robot::joint_trig(q);
        print(robot::inverse_dynamics(q, v, a));
        print(robot::inverse_dynamics(trig, v, a));
        print(robot::forward_dynamics(q, v, a));
        print(robot::mass_matrix(q));
        print(robot::mass_matrix(trig));
        print(robot::energy(q, v).kinetic);
        print(robot::energy(q, v).potential);
        for (const robot::LinkState &link : robot::link_kinematics(q, v)) {
            print(link.rotation[0][1]);
            print(link.velocity[2]);
        }
        print(robot::dissipated_power(q, v));
        print(robot::difference(q, robot::neutral()));
    }
    {
        namespace robot = redysim::given;
        const robot::Coordinates q{{0.3, -0.8, 1.1, 2.0}};
        robot::Parameters parameters;
        for (std::size_t i = 0; i < robot::np; i++) {
            parameters[i] = given_parameters[i];
        }
        robot::Robot other;
        print(robot::gravity_forces(other, q));
        parameters[3] = -1.0;
        print(other.try_init(parameters));
        print(robot::gravity_forces(other, q));
        parameters[3] = 5.0;
        print(robot::gravity_forces(robot::Robot(parameters), q));
        print(robot::mass_matrix(robot::Robot(parameters), robot::joint_trig(other, q)));
    }
    {
        namespace robot = redysim::single;
        static_assert(sizeof(robot::Number) == sizeof(float), "single precision");
        const robot::Coordinates q{{0.3f, -0.8f, 1.1f, 2.0f}};
        const robot::Velocities v{{1.0f, -2.0f, 3.0f, 0.5f}};
        const robot::JointTrig trig = robot::joint_trig(q);
        print(robot::bias_forces(q, v));
        print(robot::mass_matrix(trig));
        print(robot::energy(q, v).kinetic);
        for (const robot::LinkState &link : robot::link_kinematics(trig, v)) {
            print(link.rotation[0][1]);
            print(link.velocity[0]);
        }
    }
    return 0;
}
"#;

/// @next@ is a minor version that the package does not have.
const BUILD: &str = "\
cmake_minimum_required(VERSION 3.16)
project(user LANGUAGES C CXX)
find_package(kr5 @next@ QUIET)
if(kr5_FOUND)
    message(FATAL_ERROR \"kr5 ${kr5_VERSION} is taken for version @next@\")
endif()
find_package(kr5 @version@ REQUIRED)
if(NOT kr5_VERSION STREQUAL \"@whole@\")
    message(FATAL_ERROR \"the version of kr5 is '${kr5_VERSION}', not @whole@\")
endif()
add_subdirectory(given)
add_subdirectory(single)
add_executable(user user.cpp)
set_target_properties(user PROPERTIES CXX_STANDARD 11 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF)
target_compile_options(user PRIVATE @warnings@)
target_link_libraries(user PRIVATE kr5::kr5 given::given single::single)
";

/// What C++ code must be free of.
const WARNINGS: [&str; 7] =
    ["-pedantic", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Wold-style-cast", "-Werror"];

/// [`BUILD`] with the versions.
fn build_file() -> String {
    let [major, minor] = [env!("CARGO_PKG_VERSION_MAJOR"), env!("CARGO_PKG_VERSION_MINOR")]
        .map(|number| number.parse::<usize>().expect("a number"));
    BUILD
        .replace("@warnings@", &WARNINGS.join(" "))
        .replace("@version@", &format!("{major}.{minor}"))
        .replace("@next@", &format!("{major}.{}", minor + 1))
        .replace("@whole@", env!("CARGO_PKG_VERSION"))
}

/// Writes the files of a model to a folder.
fn write(model: &str, name: &str, options: &str, scalar: CScalar, folder: &Path) {
    let file = format!("{}/models/{model}.toml", env!("CARGO_MANIFEST_DIR"));
    let loaded = Model::load_with(&file, &file, options).unwrap_or_else(|faults| panic!("{faults}"));
    let form = COptions { prefix: Some(name.to_string()), scalar };
    let CppFiles { c, header, cmake } = cpp_files(&loaded.model, &form, &loaded.options).expect("code in C++");
    std::fs::create_dir_all(folder).expect("a folder");
    let files = [
        (format!("{name}.h"), c.header),
        (format!("{name}.c"), c.source),
        (format!("{name}.hpp"), header),
        ("CMakeLists.txt".into(), cmake),
    ];
    files.into_iter().for_each(|(file, text)| std::fs::write(folder.join(file), text).expect("a file"));
}

/// Runs a command and returns what it prints.
fn run(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert!(output.status.success(), "{command:?}: {out}{err}");
    out
}

fn rust() -> Vec<f64> {
    let q = [0.3, -0.8, 1.1, 2.0, -9.0, 0.7];
    let (v, a) = ([1.0, -2.0, 3.0, 0.5, -0.25, 2.0], [-1.0, 4.0, 0.5, 2.0, 1.0, -3.0]);
    let tau: [f64; 6] = Kr5::inverse_dynamics(&q, &v, &a);
    let inertia = Kr5::mass_matrix(&q).concat();
    let energy = Kr5::energy(&q, &v);
    let of = |link: &LinkState<f64>| [link.rotation[0][1], link.velocity[2]];
    let mut all = [tau, tau, Kr5::forward_dynamics(&q, &v, &a)].concat();
    all.extend([inertia.clone(), inertia].concat());
    all.extend([energy.kinetic, energy.potential]);
    all.extend(Kr5::link_kinematics(&q, &v).iter().flat_map(of));
    all.push(0.0);
    all.extend(q.map(|q| 0.0 - q));

    let q = [0.3, -0.8, 1.1, 2.0];
    let default = Given::<f64>::default().gravity_forces(&q);
    let mut parameters = Given::PARAMETERS;
    parameters[3] = 5.0;
    let heavy = Given::new(&parameters);
    all.extend(default);
    // The index of the mass plus one, and the robot as it was.
    all.push(4.0);
    all.extend([default, heavy.gravity_forces(&q)].concat());
    all.extend(heavy.mass_matrix(&q).concat());

    let (q, v) = ([0.3_f32, -0.8, 1.1, 2.0], [1.0_f32, -2.0, 3.0, 0.5]);
    let of = |link: &LinkState<f32>| [link.rotation[0][1], link.velocity[0]];
    let single = [
        Gripper::bias_forces(&q, &v).to_vec(),
        Gripper::mass_matrix(&q).concat(),
        vec![Gripper::energy(&q, &v).kinetic],
    ];
    all.extend(single.concat().into_iter().map(f64::from));
    all.extend(Gripper::link_kinematics(&q, &v).iter().flat_map(of).map(f64::from));
    all
}

#[test]
fn a_program_in_cpp_that_cmake_builds_computes_the_same_bits() {
    let expected: Vec<u64> = rust().into_iter().map(f64::to_bits).collect();
    if !all_tools() {
        skip("CMake is not used");
        return;
    }
    let root = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cpp");
    let _ = std::fs::remove_dir_all(&root);
    write("kr5", "kr5", "", CScalar::F64, &root.join("kr5"));
    write("gripper", "given", OF_GIVEN, CScalar::F64, &root.join("given"));
    write("gripper", "single", "", CScalar::F32, &root.join("single"));
    std::fs::write(root.join("user.cpp"), USER).expect("a file");
    std::fs::write(root.join("CMakeLists.txt"), build_file()).expect("a file");
    let fused = if FUSED { "-DREDYSIM_FMA" } else { "" };
    let c_flags = format!("-DCMAKE_C_FLAGS=-O1 -pedantic -Wall -Wextra -Wconversion -Werror {fused}");
    for (index, c) in compilers().iter().enumerate() {
        let Some(cpp) = cpp_compiler(c) else { continue };
        // CMake takes compilers with their flags from these variables.
        let cmake = |arguments: &[&str]| {
            run(Command::new("cmake").args(arguments).env("CC", c).env("CXX", &cpp).current_dir(&root));
        };
        let build = |source: &str, folder: &str, more: &str| {
            cmake(&["-S", source, "-B", folder, "-DCMAKE_BUILD_TYPE=Debug", &c_flags, more]);
            cmake(&["--build", folder]);
        };
        let [installed, of_robot, of_user] = ["installed", "kr5", "user"].map(|name| format!("{name}-{index}"));
        let installed = root.join(installed);
        let installed = installed.to_str().expect("a path in UTF-8");
        build("kr5", &of_robot, &format!("-DCMAKE_INSTALL_PREFIX={installed}"));
        cmake(&["--install", &of_robot]);
        build(".", &of_user, &format!("-DCMAKE_PREFIX_PATH={installed}"));
        let printed = run(&mut compilers::program(&root.join(&of_user).join("user")));
        let found: Vec<u64> =
            printed.lines().map(|bits| u64::from_str_radix(bits, 16).expect("bits of a number")).collect();
        assert_eq!(found, expected, "{cpp}");
    }
}

/// A program that calls functions, whose arguments are [`argument`].
const CALLS: &str = r#"
#include "robot.hpp"
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstring>

namespace robot = redysim::robot;

template <typename T> static T filled(std::size_t seed)
{
    std::array<double, sizeof(T) / sizeof(double)> numbers;
    for (std::size_t i = 0; i < numbers.size(); i++) {
        numbers[i] = 0.25 * static_cast<double>(seed) - 0.125 * static_cast<double>(i);
    }
    T value;
    std::memcpy(&value, &numbers, sizeof value);
    return value;
}

template <typename T> static void print(const T &result)
{
    std::array<std::uint64_t, sizeof(T) / sizeof(std::uint64_t)> bits;
    static_assert(sizeof bits == sizeof result, "a result is made of numbers");
    std::memcpy(&bits, &result, sizeof result);
    for (const std::uint64_t number : bits) {
        std::printf("%016" PRIx64 "\n", number);
    }
}

int main()
{
@calls@    return 0;
}
"#;

/// The numbers of an argument, which differ from each other and from those of the others.
fn argument(argument: Argument, length: usize) -> Vec<f64> {
    let seed = Argument::ALL.iter().position(|other| *other == argument).expect("a known argument") + 1;
    (0..length).map(|i| 0.25 * seed as f64 - 0.125 * i as f64).collect()
}

/// The program that calls `functions`.
fn calls(functions: &[Function]) -> String {
    let takes =
        |argument: &Argument| functions.iter().any(|function| function.signature().arguments.contains(argument));
    let define = |(index, argument): (usize, Argument)| {
        let kind = match argument {
            Argument::Wrenches => "std::array<robot::Wrench, robot::nf>",
            Argument::Forces => "robot::Forces",
            _ if argument.dimension() == Dimension::Coordinates => "robot::Coordinates",
            _ => "robot::Velocities",
        };
        format!("    const auto {} = filled<{kind}>({});\n", argument.name(), index + 1)
    };
    let arguments = Argument::ALL.into_iter().enumerate().filter(|(_, argument)| takes(argument)).map(define);
    let call = |function: &Function| {
        let names: Vec<&str> = function.signature().arguments.iter().map(|argument| argument.name()).collect();
        format!("    print(robot::{function}({}));\n", names.join(", "))
    };
    CALLS.replace("@calls@", &arguments.chain(functions.iter().map(call)).collect::<String>())
}

#[test]
fn every_function_of_the_header_gives_the_bits_of_rust_for_loops_frames_wrenches_and_hybrid_dynamics() {
    type Call = fn(Function, &State<f64>) -> Option<Vec<f64>>;
    let cases: [(&str, Call, Function); 3] = [
        ("fourbar", by_fourbar, Function::LoopJacobian),
        ("test/frames", by_machine, Function::FrameForces),
        // Takes some seconds.
        ("kr5_floating", by_floating, Function::HybridDynamics),
    ];
    for (model, by_rust, among) in &cases[..if NATIVE { 3 } else { 2 }] {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("cpp-calls-{}", model.replace('/', "-")));
        write(model, "robot", "", CScalar::F64, &folder);
        let header = std::fs::read_to_string(folder.join("robot.hpp")).expect("the header");
        let declared = |function: &&Function| header.contains(&format!(" {function}("));
        let functions: Vec<Function> = Function::ALL.iter().filter(declared).copied().collect();
        assert!(functions.contains(among));
        std::fs::write(folder.join("user.cpp"), calls(&functions)).expect("a file");
        let tree = Tree::new(
            &Model::load(format!("{}/models/{model}.toml", env!("CARGO_MANIFEST_DIR"))).expect("a good model").model,
        );
        let state: State<f64> =
            Argument::ALL.into_iter().map(|each| argument(each, tree.argument_length(each))).collect();
        let by_rust = |function: &Function| by_rust(*function, &state).expect("a function of the mechanism");
        let expected: Vec<String> =
            functions.iter().flat_map(by_rust).map(|number| format!("{:016x}", number.to_bits())).collect();
        for c in compilers() {
            let Some(cpp) = cpp_compiler(c) else { continue };
            let fused: &[&str] = if FUSED { &["-DREDYSIM_FMA"] } else { &[] };
            run(compilers::command(c)
                .args(["-std=c99", "-O0", "-c", "robot.c", "-o", "robot.o"])
                .args(fused)
                .current_dir(&folder));
            let compile = ["-std=c++11", "user.cpp", "robot.o", "-o", "user", "-lm"];
            run(compilers::command(&cpp).args(WARNINGS).args(compile).current_dir(&folder));
            let printed = run(&mut compilers::program(&folder.join("user")));
            assert_eq!(printed.lines().collect::<Vec<_>>(), expected, "{model} by {cpp}");
        }
    }
}
