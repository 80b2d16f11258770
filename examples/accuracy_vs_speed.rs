//! Accuracy against speed: every integrator on seven problems, every way to compute KR5's dynamics, and every way to
//! keep a loop closed. Writes pictures and tables; `docs/accuracy.md` explains them.
//!
//! `cargo run --release --bin accuracy_vs_speed`
//!
//! It takes some minutes, and builds itself twice again: for this machine's instructions, and with the feature
//! `deterministic`. The names of parts (`kr5`, `gripper`, `fourbar`, `stiff`,
//! `swing`, `floating`, `walking`, `iftomm`, `drift`, `digits`, `evaluation`) may follow behind `--`, to have those alone.

mod common;

// Robots that tests have, too.
#[path = "../tests/common/chains.rs"]
#[allow(dead_code, reason = "tests use more of it")]
mod chains;
#[path = "../tests/common/random.rs"]
#[allow(dead_code, reason = "tests use more of it")]
mod random;
#[path = "../tests/common/scenes/mod.rs"]
mod scenes;
#[path = "../tests/common/styles.rs"]
#[allow(dead_code, reason = "tests use more of it")]
mod styles;

mod accuracy {
    pub mod benchmarks;
    pub mod digits;
    pub mod drift;
    pub mod evaluation;
    pub mod floating;
    pub mod gimbal;
    pub mod models;
    pub mod problem;
    pub mod walking;
    pub mod work_precision;
}

#[allow(dead_code, reason = "tests use more of it")]
use accuracy::{benchmarks, digits, drift, evaluation, floating, gimbal, problem, walking, work_precision};
use common::{Failure, Outputs};

fn main() -> Result<(), Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    if let [flag, build] = arguments.as_slice()
        && flag == "--evaluate"
    {
        evaluation::print_lines(&evaluation::measure(build)?);
        return Ok(());
    }
    let asked = |part: &str| arguments.is_empty() || arguments.iter().any(|argument| argument == part);
    let mut outputs = Outputs::of("accuracy")?;
    if asked("kr5") {
        work_precision::report(&problem::kr5()?, &mut outputs)?;
    }
    if asked("gripper") {
        work_precision::report(&problem::gripper()?, &mut outputs)?;
    }
    if asked("fourbar") {
        work_precision::report(&problem::fourbar()?, &mut outputs)?;
    }
    if asked("stiff") {
        work_precision::report(&problem::stiff()?, &mut outputs)?;
    }
    if asked("swing") {
        work_precision::report(&problem::LongSwing, &mut outputs)?;
    }
    if asked("floating") {
        work_precision::report(&floating::Floating::new(), &mut outputs)?;
        gimbal::report(&mut outputs)?;
    }
    if asked("walking") {
        walking::report(&mut outputs)?;
    }
    if asked("iftomm") {
        benchmarks::report(&mut outputs)?;
    }
    if asked("drift") {
        drift::report(&mut outputs)?;
    }
    if asked("digits") {
        digits::report(&mut outputs)?;
    }
    if asked("evaluation") {
        evaluation::report(&mut outputs)?;
    }
    outputs.print();
    Ok(())
}
