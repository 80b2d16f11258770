//! Time of every function, for every scalar, on the robots that other programs are compared on.
//!
//! `cargo bench --bench dynamics -- kr5/inverse` runs those whose name has `kr5/inverse` in it; a name is
//! `robot/function/scalar`. Times are for a call, which works on as many states as the scalar has lanes; elements per
//! second are states. `RUSTFLAGS="-C target-cpu=native"` lets the compiler use the vectors that this machine has. The
//! first line of output names the processor and the vectors that the program is compiled for.

mod calls;
mod numbers;
#[path = "../../examples/common/processor.rs"]
mod processor;
#[allow(dead_code)]
#[path = "../../tests/common/random.rs"]
mod random;

use calls::{main_functions, other_functions, with_joint_trig};
use criterion::{Criterion, criterion_group};
use numbers::Numbers;
use redysim::generic::{GenericMechanism, Model};
use redysim::lanes::{F32x8, F32x16, F64x4, F64x8};
use redysim::redysim;

redysim! {
    /// Six joints in a row; the last link's rounded inertia belongs to no body.
    #[allow(deprecated)]
    pub struct Kr5("../../models/peers/kr5.toml");
}

redysim! {
    /// Two fingers in the plane.
    pub struct Gripper("../../models/peers/gripper.toml");
}

redysim! {
    /// Legs, trunk, arms and head.
    pub struct Humanoid30("../../models/peers/humanoid30.toml");
}

fn kr5<S: Numbers>(criterion: &mut Criterion) {
    main_functions::<S, _>(criterion, "kr5", S::NAME, &Kr5);
    other_functions::<S, _>(criterion, "kr5", S::NAME, &Kr5);
    let functions = (Kr5::inverse_dynamics_with_trig::<S>, Kr5::forward_dynamics_with_trig, Kr5::mass_matrix_with_trig);
    with_joint_trig(criterion, "kr5", Kr5::joint_trig, functions);
}

fn gripper<S: Numbers>(criterion: &mut Criterion) {
    main_functions::<S, _>(criterion, "gripper", S::NAME, &Gripper);
    other_functions::<S, _>(criterion, "gripper", S::NAME, &Gripper);
    let functions =
        (Gripper::inverse_dynamics_with_trig::<S>, Gripper::forward_dynamics_with_trig, Gripper::mass_matrix_with_trig);
    with_joint_trig(criterion, "gripper", Gripper::joint_trig, functions);
}

/// Its functions are long, and the others would double the time to compile.
fn humanoid30<S: Numbers>(criterion: &mut Criterion) {
    main_functions::<S, _>(criterion, "humanoid30", S::NAME, &Humanoid30);
}

fn scalar<S: Numbers>(criterion: &mut Criterion) {
    kr5::<S>(criterion);
    gripper::<S>(criterion);
    humanoid30::<S>(criterion);
}

fn generic_path(criterion: &mut Criterion) {
    for name in ["kr5", "gripper", "humanoid30"] {
        let path = format!("{}/../models/peers/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let mechanism = GenericMechanism::new(Model::load(path).expect("a good model").model);
        main_functions::<f64, _>(criterion, name, "generic", &mechanism);
        other_functions::<f64, _>(criterion, name, "generic", &mechanism);
    }
}

criterion_group! {
    name = dynamics;
    // Half the usual times: there are two hundred of them.
    config = Criterion::default()
        .warm_up_time(std::time::Duration::from_millis(500))
        .measurement_time(std::time::Duration::from_secs(2));
    targets = scalar::<f64>, scalar::<f32>, scalar::<F64x4>, scalar::<F64x8>, scalar::<F32x8>, scalar::<F32x16>, generic_path
}

fn main() {
    println!("processor: {}", processor::described());
    dynamics();
    Criterion::default().configure_from_args().final_summary();
}
