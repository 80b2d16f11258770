//! The header for C++ and the package of CMake: a program finds one mechanism where it is installed and builds another
//! one with itself, and computes what Rust computes, to the bit.

use super::Given;
use super::program::compilers;
use crate::robots::Kr5;
use redysim::{FUSED, LinkState};
use redysim_codegen::{COptions, CppFiles, cpp_files};
use redysim_model::Model;
use std::path::Path;
use std::process::Command;

const USER: &str = r#"
#include "given.hpp"
#include "kr5.hpp"
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
    return 0;
}
"#;

const BUILD: &str = "\
cmake_minimum_required(VERSION 3.16)
project(user LANGUAGES C CXX)
find_package(kr5 REQUIRED)
add_subdirectory(given)
add_executable(user user.cpp)
set_target_properties(user PROPERTIES CXX_STANDARD 11 CXX_STANDARD_REQUIRED ON CXX_EXTENSIONS OFF)
target_compile_options(user PRIVATE -pedantic -Wall -Wextra -Wconversion -Wshadow -Wold-style-cast -Werror)
target_link_libraries(user PRIVATE kr5::kr5 given::given)
";

/// Writes the files of a model to a folder.
fn write(model: &str, name: &str, options: &str, folder: &Path) {
    let file = format!("{}/models/{model}.toml", env!("CARGO_MANIFEST_DIR"));
    let loaded = Model::load_with(&file, &file, options).unwrap_or_else(|faults| panic!("{faults}"));
    let form = COptions { prefix: Some(name.to_string()), ..COptions::default() };
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

/// Runs a program in a folder and returns what it prints.
fn run(folder: &Path, program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).current_dir(folder).output();
    let output = output.unwrap_or_else(|error| panic!("{program}: {error}"));
    let [out, err] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert!(output.status.success(), "{program} {arguments:?}: {out}{err}");
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
    all
}

#[test]
fn a_program_in_cpp_that_cmake_builds_computes_the_same_bits() {
    let expected: Vec<u64> = rust().into_iter().map(f64::to_bits).collect();
    let runs = |name: &str| Command::new(name).arg("--version").output().is_ok_and(|output| output.status.success());
    if !runs("cmake") {
        eprintln!("SKIPPED: there is no CMake here");
        return;
    }
    let root = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cpp");
    let _ = std::fs::remove_dir_all(&root);
    let options = "parameters = [\"gravity\", \"link3.mass\", \"link3.com\", \"link3.inertia\", \"joint2.damping\"]";
    write("kr5", "kr5", "", &root.join("kr5"));
    write("gripper", "given", options, &root.join("given"));
    std::fs::write(root.join("user.cpp"), USER).expect("a file");
    std::fs::write(root.join("CMakeLists.txt"), BUILD).expect("a file");
    let fused = if FUSED { "-DREDYSIM_FMA" } else { "" };
    let c_flags = format!("-DCMAKE_C_FLAGS=-O1 -pedantic -Wall -Wextra -Wconversion -Werror {fused}");
    for c in compilers() {
        let cpp = if c.contains("clang") { "clang++" } else { "c++" };
        if !runs(cpp) {
            eprintln!("SKIPPED: {cpp} is not here");
            continue;
        }
        let installed = root.join(format!("installed-{cpp}"));
        let installed = installed.to_str().expect("a path in UTF-8");
        let build = |source: &str, folder: &str, more: [&str; 2]| {
            let c = format!("-DCMAKE_C_COMPILER={c}");
            let always = ["-S", source, "-B", folder, "-DCMAKE_BUILD_TYPE=Debug", &c, &c_flags];
            run(&root, "cmake", &[&always[..], &more].concat());
            run(&root, "cmake", &["--build", folder]);
        };
        let [of_robot, of_user] = ["kr5", "user"].map(|name| format!("{name}-{cpp}"));
        build("kr5", &of_robot, [&format!("-DCMAKE_INSTALL_PREFIX={installed}"), "--no-warn-unused-cli"]);
        run(&root, "cmake", &["--install", &of_robot]);
        let found_in = format!("-DCMAKE_PREFIX_PATH={installed}");
        build(".", &of_user, [&found_in, &format!("-DCMAKE_CXX_COMPILER={cpp}")]);
        let program = root.join(&of_user).join("user");
        let printed = run(&root, program.to_str().expect("a path in UTF-8"), &[]);
        let found: Vec<u64> =
            printed.lines().map(|bits| u64::from_str_radix(bits, 16).expect("bits of a number")).collect();
        assert_eq!(found, expected, "{cpp}");
    }
}
