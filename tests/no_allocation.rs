//! Compiled functions and integrators allocate nothing.

mod common;

use common::methods::{WithMethod, every_adaptive, every_fixed};
use redysim::{Event, ForwardSimulation, Integrator, LinkState, Wrench, ZeroTorque, redysim};
use std::hint::black_box;
use std::ops::ControlFlow;

redysim! {
    /// Six joints in a row.
    pub struct Kr5("models/kr5.toml");
}

redysim! {
    /// Prismatic, fixed and oblique joints, branching.
    pub struct Gantry("models/test/gantry.toml");
}

redysim! {
    /// A quaternion and an angular velocity.
    pub struct Pendulum("models/spherical_pendulum.toml");
}

fn allocations(work: impl FnOnce()) -> u64 {
    allocation_counter::measure(work).count_total
}

#[test]
fn allocations_are_seen() {
    assert_eq!(allocations(|| drop(black_box(vec![1.0_f64; 6]))), 1);
}

macro_rules! assert_nothing_allocated {
    ($mechanism:ident, $scalar:ty) => {
        let (q, v, x) = black_box(([0.1 as $scalar; $mechanism::NQ], [0.2; $mechanism::NV], [0.3; $mechanism::NV]));
        let calls: [(&str, &dyn Fn()); 8] = [
            ("inverse_dynamics", &|| _ = black_box($mechanism::inverse_dynamics(&q, &v, &x))),
            ("forward_dynamics", &|| _ = black_box($mechanism::forward_dynamics(&q, &v, &x))),
            ("mass_matrix", &|| _ = black_box($mechanism::mass_matrix(&q))),
            ("bias_forces", &|| _ = black_box($mechanism::bias_forces(&q, &v))),
            ("coriolis_matrix", &|| _ = black_box($mechanism::coriolis_matrix(&q, &v))),
            ("gravity_forces", &|| _ = black_box($mechanism::gravity_forces(&q))),
            ("energy", &|| _ = black_box($mechanism::energy(&q, &v))),
            ("link_kinematics", &|| {
                let links: [LinkState<$scalar>; $mechanism::NL] = $mechanism::link_kinematics(&q, &v);
                black_box(&links);
            }),
        ];
        for (function, call) in calls {
            assert_eq!(allocations(call), 0, "{} {function}", $mechanism::NAME);
        }
    };
}

#[test]
fn functions_allocate_nothing() {
    assert_nothing_allocated!(Kr5, f64);
    assert_nothing_allocated!(Kr5, f32);
    assert_nothing_allocated!(Gantry, f64);
    assert_nothing_allocated!(Gantry, f32);
    assert_nothing_allocated!(Pendulum, f64);
    assert_nothing_allocated!(Pendulum, f32);
}

#[test]
fn functions_of_frames_allocate_nothing() {
    redysim! { struct Machine("models/test/frames.toml"); }
    let (q, v) = black_box(([0.1; Machine::NQ], [0.2; Machine::NV]));
    let wrenches = black_box([Wrench { force: [1.0; 3], moment: [2.0; 3] }; Machine::NF]);
    let all = || {
        black_box(Machine::frame_kinematics(&q, &v));
        black_box(Machine::frame_jacobians(&q));
        black_box(Machine::frame_bias(&q, &v));
        black_box(Machine::frame_forces(&q, &wrenches));
    };
    assert_eq!(allocations(all), 0);
}

/// A fall of KR5 with an event on the way.
struct Fall;

impl WithMethod for Fall {
    fn with(&mut self, name: &str, method: &impl Integrator<f64>) {
        let mut fall = ForwardSimulation::new(&Kr5, ZeroTorque);
        let start = fall.state(&[0.1; Kr5::NV], &[0.0; Kr5::NV]);
        let passing = |_t: f64, y: &[f64; 2 * Kr5::NV + 1]| y[1] + 0.1;
        let mut passages = 0;
        let run = || {
            let events = &mut [Event::any(&passing)];
            let on_event = |_: redysim::Occurrence<'_, f64, _>| {
                passages += 1;
                ControlFlow::Continue(())
            };
            let end =
                method.solve_with_events(&mut fall, (0.0, 0.3), start, events, |_| ControlFlow::Continue(()), on_event);
            black_box(end.is_ok());
        };
        assert_eq!(allocations(run), 0, "{name}");
        assert_eq!(passages, 1, "{name} finds the passage");
    }
}

#[test]
fn integrators_allocate_nothing() {
    every_fixed(1e-3, &mut Fall);
    every_adaptive(1e-6, 1e-8, &mut Fall);
}

#[cfg(feature = "generic")]
#[test]
fn inverse_and_forward_dynamics_and_mass_matrix_of_the_run_time_path_allocate_nothing_after_construction() {
    use redysim::generic::Workspace;

    let of_one_freedom = ["kr5", "gripper", "test/gantry", "peers/humanoid30", "test/springs", "parallel_gripper"];
    let of_several = ["kr5_floating", "spherical_pendulum", "test/joints_in_series"];
    for name in of_one_freedom.into_iter().chain(of_several) {
        let mechanism = common::models::generic(name);
        let (nq, nv) = (mechanism.tree().nq(), mechanism.tree().nv());
        let (q, v, x) = (vec![0.1; nq], vec![0.2; nv], vec![0.3; nv]);
        let (mut vector, mut matrix) = (vec![0.0; nv], vec![0.0; nv * nv]);
        let allocates_nothing = |function: &str, call: &mut dyn FnMut(&mut Workspace<f64>)| {
            let mut workspace = Workspace::for_tree(mechanism.tree());
            assert_eq!(allocations(|| call(&mut workspace)), 0, "{name} {function}");
            assert!(allocations(|| call(&mut Workspace::default())) > 0, "{name} {function} needs memory");
        };
        allocates_nothing("inverse_dynamics", &mut |workspace| {
            mechanism.inverse_dynamics_in(workspace, &q, &v, &x, &mut vector);
        });
        allocates_nothing("forward_dynamics", &mut |workspace| {
            mechanism.forward_dynamics_in(workspace, &q, &v, &x, &mut vector);
        });
        allocates_nothing("mass_matrix", &mut |workspace| mechanism.mass_matrix_in(workspace, &q, &mut matrix));
    }
}

#[cfg(feature = "generic")]
#[test]
fn the_room_of_one_mechanism_serves_another() {
    use redysim::generic::Workspace;
    use redysim::{ForwardDynamics, InverseDynamics, MassMatrix};

    let mut workspace = Workspace::default();
    let names =
        ["kr5", "test/springs", "kr5_floating", "gripper", "spherical_pendulum", "parallel_gripper", "test/gantry"];
    for name in names.into_iter().chain(["kr5"]) {
        let mechanism = common::models::generic(name);
        let (nq, nv) = (mechanism.tree().nq(), mechanism.tree().nv());
        let (q, v, x): (Vec<f64>, Vec<f64>, Vec<f64>) = (vec![0.4; nq], vec![-0.2; nv], vec![0.3; nv]);
        let (mut vector, mut matrix) = (vec![0.0; nv], vec![0.0; nv * nv]);
        mechanism.inverse_dynamics_in(&mut workspace, &q, &v, &x, &mut vector);
        assert_eq!(vector, mechanism.inverse_dynamics(&q, &v, &x), "{name}");
        mechanism.forward_dynamics_in(&mut workspace, &q, &v, &x, &mut vector);
        assert_eq!(vector, mechanism.forward_dynamics(&q, &v, &x), "{name}");
        mechanism.mass_matrix_in(&mut workspace, &q, &mut matrix);
        assert_eq!(matrix, mechanism.mass_matrix(&q).concat(), "{name}");
    }
}
