//! Compiled functions and integrators allocate nothing.

mod common;

use common::methods::{WithMethod, every_adaptive, every_fixed};
use redysim::integrate::Ends;
use redysim::{
    AnyContactLaw, Contact, Event, ForwardSimulation, GroundPlane, Grounded, HuntCrossleyContact, Integrator,
    LinkState, Ode, ReDySimContact, Vector, Wrench, ZeroTorque, redysim,
};
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

redysim! {
    /// A box with a frame on each corner.
    pub struct Parcel(
        "models/parcel.toml",
        functions = [forward_dynamics, frame_kinematics, frame_jacobians, frame_bias, frame_forces]
    );
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

/// Integrates for 0.3 s, on the way an event at which `passing` changes its sign once.
fn assert_integrates_without_allocating<Y: Vector<f64>>(
    name: &str,
    method: &impl Integrator<f64>,
    ode: &mut impl Ode<f64, Y>,
    start: Y,
    passing: impl Fn(f64, &Y) -> f64,
) {
    let mut passages = 0;
    let run = || {
        let events = &mut [Event::any(&passing)];
        let on_event = |_: redysim::Occurrence<'_, f64, _>| {
            passages += 1;
            ControlFlow::Continue(())
        };
        let end = method.solve_with_events(ode, (0.0, 0.3), start, events, |_| ControlFlow::Continue(()), on_event);
        black_box(end.is_ok());
    };
    assert_eq!(allocations(run), 0, "{name}");
    assert_eq!(passages, 1, "{name} finds the passage");
}

/// A fall of KR5, and a turn of the pendulum, whose quaternion steps and events correct.
struct Motions;

impl WithMethod for Motions {
    fn with(&mut self, name: &str, method: &impl Integrator<f64>) {
        let mut fall = ForwardSimulation::new(&Kr5, ZeroTorque);
        let start = fall.state(&[0.1; Kr5::NV], &[0.0; Kr5::NV]);
        assert_integrates_without_allocating(name, method, &mut fall, start, |_, y| y[1] + 0.1);
        let mut turn = ForwardSimulation::new(&Pendulum, ZeroTorque);
        let start = turn.state(&[0.0, 0.0, 0.0, 1.0], &[0.0, 8.0, 1.0]);
        assert_integrates_without_allocating(name, method, &mut turn, start, |_, y| y[1] - 0.5);
    }
}

#[test]
fn integrators_allocate_nothing() {
    every_fixed(1e-3, &mut Motions);
    every_adaptive(1e-6, 1e-8, &mut Motions);
}

/// The parcel lands on its corners, which have either law of contact.
struct Landing;

impl WithMethod for Landing {
    fn with(&mut self, name: &str, method: &impl Integrator<f64>) {
        let ground = GroundPlane::new([0.0; 3], [0.0, 0.0, 1.0]).expect("a plane");
        let laws = [
            AnyContactLaw::HuntCrossley(HuntCrossleyContact {
                stiffness: 2e4,
                exponent: 1.5,
                damping: 0.8,
                friction: 0.5,
                slip_velocity: 0.01,
            }),
            AnyContactLaw::ReDySim(ReDySimContact {
                stiffness: 5e3,
                damping: 40.0,
                leaving_speed: 5.0,
                friction: 0.5,
                sliding_damping: 100.0,
            }),
        ];
        let contacts =
            [0, 1, 2, 3, 4, 5, 6, 7].map(|corner| Contact::new(corner, ground, laws[corner % 2]).expect("a law"));
        let grounded = Grounded::new(&Parcel, &contacts).expect("frames of the parcel");
        let mut simulation = ForwardSimulation::new(&grounded, ZeroTorque);
        let start = simulation.state(&[0.0, 0.0, 0.3, 0.1, 0.05, 0.0, 0.99], &[1.0, 0.0, -1.0, 0.5, -1.0, 0.3]);
        let mut touch_downs = 0;
        let run = || {
            let end = grounded.run(method, &mut simulation, (0.0, 0.3), start, &mut Ends, |event| {
                touch_downs += u32::from(event.touching);
            });
            assert!(black_box(end).is_ok());
        };
        assert_eq!(allocations(run), 0, "{name}");
        assert!(touch_downs > 1, "{name}: {touch_downs} touch-downs");
    }
}

#[test]
fn runs_on_the_ground_allocate_nothing() {
    every_fixed(1e-3, &mut Landing);
    every_adaptive(1e-6, 1e-8, &mut Landing);
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
