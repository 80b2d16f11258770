//! The KUKA KR5 held against gravity, then let fall, without `std`, without an allocator, and without a panic: the
//! program does not link if one is left in it. Exits with 0 if the numbers are right.
#![no_std]
#![no_main]

use core::ops::ControlFlow;

use redysim::integrate::Ends;
use redysim::nalgebra as dynamics;
use redysim::{
    AnyContactLaw, ClosedLoop, ClosedLoopComputedTorque, ClosedLoopInverse, ClosedLoopSimulation, Compensation,
    ConfigurationSpace, Contact, Cycloid, Dop853, Event, ForwardSimulation, FrameGains, FrameState, Gauss6, GroundPlane,
    Grounded, HuntCrossleyContact, HybridSimulation, Impedance, IndependentMotion, Integrator, Limited,
    ManifoldSpline, MechanicalEnergy, Motion, Ode5, Ode15s, Ode45, OperationalSpace, Pd, PdGravity, Pid, Radau5, ReDySimContact,
    SemiImplicitEuler, SetPoint, TangentTrajectory, TrackingPd, Trajectory, Wrench, ZeroTorque, redysim, tracking_rates,
};

redysim! {
    /// The KUKA KR5 of the ReDySim paper.
    struct Kr5("../../../models/kr5.toml");
}

redysim! {
    /// The four-bar of the ReDySim paper.
    struct Fourbar("../../../models/fourbar.toml");
}

redysim! {
    /// The same with rotors and a tool.
    struct Kr5Tool("../../../models/kr5_tool.toml");
}

redysim! {
    /// The KUKA KR5 with a load.
    struct Kr5Loaded("../../../models/kr5.toml", parameters = ["gravity", "link6.mass", "link6.com", "link6.inertia"]);
}

redysim! {
    /// A body that turns about a point.
    struct Top(
        "../../../models/spherical_pendulum.toml",
        functions = [forward_dynamics, energy, momentum]
    );
}

redysim! {
    /// A pole that turns freely on a cart.
    struct CartPole("../../../models/cart_pole.toml", functions = [inverse_dynamics, hybrid_dynamics]);
}

redysim! {
    /// A box that falls to the ground.
    struct Parcel(
        "../../../models/parcel.toml",
        functions = [forward_dynamics, energy, frame_kinematics, frame_jacobians, frame_bias, frame_forces]
    );
}

redysim! {
    /// A machine with frames.
    struct Machine(
        "../../../models/test/frames.toml",
        functions = [frame_kinematics, frame_jacobians, frame_bias, frame_forces, coriolis_matrix]
    );
}

unsafe extern "C" {
    /// Defined nowhere.
    fn a_panic_is_left_in_the_program() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    // Safety: this is never called, since the program links only if the optimiser finds no way to get here.
    unsafe { a_panic_is_left_in_the_program() }
}

// The C library, which starts the program on a machine that has one.
#[link(name = "c")]
unsafe extern "C" {}

#[unsafe(no_mangle)]
extern "C" fn main() -> i32 {
    let kept = keeps_its_energy_when_it_falls().is_some_and(|kept| kept);
    i32::from(
        !(is_held_by_gravity_forces()
            && a_load_is_felt()
            && is_held_in_the_vectors_of_nalgebra()
            && a_frame_moves_in_the_vectors_of_nalgebra()
            && wrenches_have_the_power_of_their_joint_forces()
            && kept
            && a_free_pole_takes_no_force()
            && a_pole_swings_on_a_cart_that_follows_a_motion().is_some_and(|swings| swings)
            && a_parcel_bounces_and_keeps_its_energy_account().is_some_and(|kept| kept)
            && a_top_keeps_its_energy_and_its_quaternion_its_length().is_some_and(|kept| kept)
            && a_top_follows_attitudes().is_some_and(|follows| follows)
            && stays_closed_when_it_turns().is_some_and(|closed| closed)
            && stops_at_an_event_with_stable_steps().is_some_and(|stopped| stopped)
            && rests_under_limited_pid().is_some_and(|rests| rests)
            && holds_its_tool().is_some_and(|holds| holds)
            && a_tip_rises_in_the_vectors_of_nalgebra().is_some_and(|rises| rises)
            && the_crank_carries_the_weight().is_some_and(|carries| carries)
            && implicit_methods_agree().is_some_and(|agree| agree)),
    )
}

/// A heavier load takes more torque at the shoulder, and one that no body has is refused.
fn a_load_is_felt() -> bool {
    let mut numbers = Kr5Loaded::PARAMETERS;
    let [_, _, _, mass, ..] = &mut numbers;
    *mass += 5.0;
    let (empty, q) = (Kr5Loaded::<f64>::default(), [0.3; Kr5::NQ]);
    let Ok(loaded) = Kr5Loaded::try_new(&numbers) else { return false };
    let ([_, light, ..], [_, heavy, ..]) = (empty.gravity_forces(&q), loaded.gravity_forces(&q));
    let refused = Kr5Loaded::try_new(&numbers.map(|number| -number)).is_err();
    let (heavy, light) = (heavy * heavy, light * light);
    refused && heavy > light
}

fn is_held_by_gravity_forces() -> bool {
    let q = [0.1, 0.7, -0.4, 0.3, 0.9, -0.2];
    let torques: [f64; 6] = Kr5::gravity_forces(&q);
    let accelerations = Kr5::forward_dynamics(&q, &[0.0; 6], &torques);
    accelerations.iter().all(|a| -1e-9 < *a && *a < 1e-9) && torques.iter().any(|torque| *torque > 1.0)
}

/// The same with nalgebra's vectors.
fn is_held_in_the_vectors_of_nalgebra() -> bool {
    let q = nalgebra::Vector6::new(0.1, 0.7, -0.4, 0.3, 0.9, -0.2);
    let torques = dynamics::gravity_forces(&Kr5, &q);
    let at_rest = nalgebra::Vector6::zeros();
    let accelerations = dynamics::forward_dynamics(&Kr5, &q, &at_rest, &torques);
    let [.., hand] = dynamics::link_kinematics(&Kr5, &q, &at_rest);
    accelerations.norm_squared() < 1e-18 && hand.pose.translation.vector.norm() > 0.1
}

/// J v is the twist of a frame, and a wrench has the power of its joint forces.
fn a_frame_moves_in_the_vectors_of_nalgebra() -> bool {
    let q = nalgebra::Vector5::new(0.1, 0.7, -0.4, 0.3, 0.9);
    let v = nalgebra::Vector5::new(0.2, -0.3, 0.5, 0.1, -0.6);
    let [tool, ..] = dynamics::frame_kinematics(&Machine, &q, &v);
    let [jacobian, ..] = dynamics::frame_jacobians(&Machine, &q);
    let [bias, ..] = dynamics::frame_bias(&Machine, &q, &v);
    let mut wrenches = [dynamics::Wrench::default(); Machine::NF];
    wrenches[0].force.z = -3.0;
    let power = dynamics::frame_forces(&Machine, &q, &wrenches).dot(&v) + 3.0 * tool.velocity.z;
    let placed = tool.pose.translation.vector.norm() > 0.1 && bias.norm() > 0.1;
    placed && (jacobian * v - tool.twist()).norm() < 1e-12 && -1e-12 < power && power < 1e-12
}

/// The task's force for an upward acceleration of the tip gives it that.
fn a_tip_rises_in_the_vectors_of_nalgebra() -> Option<bool> {
    let q = nalgebra::Vector6::new(0.1, 0.7, -0.4, 0.3, 0.9, -0.2);
    let [jacobian] = dynamics::frame_jacobians(&Kr5Tool, &q);
    let linear = jacobian.fixed_rows::<3>(0).into_owned();
    let tip = dynamics::OperationalSpace::new(&dynamics::mass_matrix(&Kr5Tool, &q), &linear).ok()?;
    let up = nalgebra::Vector3::z();
    let tau = tip.joint_force(&tip.force_of_acceleration(&up)) + dynamics::gravity_forces(&Kr5Tool, &q);
    let a = dynamics::forward_dynamics(&Kr5Tool, &q, &nalgebra::Vector6::zeros(), &tau);
    let of_null_space = tip.inertia() * linear * tip.projector() * tip.inverse();
    Some(tip.rank() == 3 && (tip.task_velocity(&a) - up).norm() < 1e-12 && of_null_space.norm() < 1e-9)
}

fn wrenches_have_the_power_of_their_joint_forces() -> bool {
    let (q, v) = ([0.1, 0.7, -0.4, 0.3, 0.9], [0.2, -0.3, 0.5, 0.1, -0.6]);
    let wrenches = [Wrench { force: [1.0, 2.0, -3.0], moment: [0.0; 3] }; Machine::NF];
    let states: [FrameState<f64>; Machine::NF] = Machine::frame_kinematics(&q, &v);
    let power: f64 = states.iter().zip(&wrenches).map(|(state, wrench)| dot(&state.velocity, &wrench.force)).sum();
    let of_joints: f64 = dot(&Machine::frame_forces(&q, &wrenches), &v);
    let velocity = Machine::frame_jacobians(&q)[0].linear.map(|row| dot(&row, &v));
    let found = Machine::frame_bias(&q, &v)[0].linear[0] + Machine::coriolis_matrix(&q, &v)[0][1];
    let error = (power - of_joints) + (velocity[0] - states[0].velocity[0]);
    power != 0.0 && found != 0.0 && -1e-12 < error && error < 1e-12
}

fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn keeps_its_energy_when_it_falls() -> Option<bool> {
    let mut fall = ForwardSimulation::new(&Kr5, ZeroTorque);
    let start = fall.state(&[0.0_f64; 6], &[0.0; 6]);
    let energy_at_rest = Kr5::energy(&[0.0; 6], &[0.0; 6]).total();
    let adaptive = Ode45::new().rtol(1e-9).atol(1e-9).integrate(&mut fall, (0.0, 0.5), start).ok()?;
    let fixed = Ode5::new(1e-3).integrate(&mut fall, (0.0, 0.5), start).ok()?;
    let kept = [adaptive.y, fixed.y].iter().all(|state| {
        let end = fall.split(state);
        let gained = Kr5::energy(&end.q, &end.v).total() - energy_at_rest;
        -1e-5 < gained && gained < 1e-5
    });
    Some(kept)
}

/// A top falls over, and where it is is the difference of its positions.
fn a_top_keeps_its_energy_and_its_quaternion_its_length() -> Option<bool> {
    let mut fall = ForwardSimulation::new(&Top, ZeroTorque);
    let (upright, spin) = (Top.neutral(), [0.3_f64, -0.2, 40.0]);
    let start = fall.state(&upright, &spin);
    let energy = Top::energy(&upright, &spin).total();
    let end = Ode5::new(1e-4).integrate(&mut fall, (0.0, 0.5), start).ok()?;
    let end = fall.split(&end.y);
    let gained = Top::energy(&end.q, &end.v).total() - energy;
    let length = end.q.iter().fold(-1.0, |sum, component| sum + component * component);
    let again = Top.integrate(&upright, &Top.difference(&upright, &end.q));
    let sign: f64 = if again[3] * end.q[3] < 0.0 { -1.0 } else { 1.0 };
    let apart = (0..4).fold(0.0, |sum, i| sum + (sign * again[i] - end.q[i]) * (sign * again[i] - end.q[i]));
    let turns = Top::momentum(&end.q, &end.v).angular.iter().any(|component| component * component > 1e-3);
    Some(-1e-5 < gained && gained < 1e-5 && -1e-9 < length && length < 1e-9 && apart < 1e-18 && turns)
}

/// A top is pulled along a turn about a fixed axis, and along a motion through three attitudes.
fn a_top_follows_attitudes() -> Option<bool> {
    let upright: [f64; 4] = Top.neutral();
    let [left, right] = [[1.0, 0.0, 0.3], [-1.0, 0.2, 0.0]].map(|way| Top.integrate(&upright, &way));
    let turn = TangentTrajectory::along_screw(&Top, upright, &left, Cycloid::new([0.0], [1.0], 0.4).ok()?).ok()?;
    let nod = ManifoldSpline::minimum_jerk(&Top, [0.0, 0.2, 0.4], [upright, left, right]).ok()?;
    Some(ends_near(turn, &left)? && ends_near(nod, &right)?)
}

/// Whether the top is near `end` after 0.5 s under springs and dampers to the trajectory.
fn ends_near(trajectory: impl Trajectory<f64, [f64; 4], [f64; 3]>, end: &[f64; 4]) -> Option<bool> {
    let law = TrackingPd { trajectory, kp: [400.0; 3], kd: [10.0; 3] };
    let mut simulation = ForwardSimulation::new(&Top, law);
    let start = simulation.state(&Top.neutral(), &[0.0; 3]);
    let reached = Ode45::new().integrate(&mut simulation, (0.0, 0.5), start).ok()?;
    let left = Top.difference(&simulation.split(&reached.y).q, end);
    Some(dot(&left, &left) < 1e-2)
}

/// A box falls on a corner under both laws of contact: what it has lost the ground has taken.
fn a_parcel_bounces_and_keeps_its_energy_account() -> Option<bool> {
    let plane = GroundPlane::new([0.0_f64; 3], [0.0, 0.0, 1.0]).ok()?;
    let redysim =
        ReDySimContact { stiffness: 2e4, damping: 300.0, leaving_speed: 4.0, friction: 0.5, sliding_damping: 100.0 };
    let hertz = HuntCrossleyContact { stiffness: 1e5, exponent: 1.5, damping: 0.2, friction: 0.5, slip_velocity: 0.01 };
    let laws = [AnyContactLaw::ReDySim(redysim), AnyContactLaw::HuntCrossley(hertz)];
    let [first, second] = laws.map(|law| Contact::new(0, plane, law));
    let contacts = [first.ok()?, second.ok()?];
    let mut kept = true;
    for contact in contacts.chunks(1) {
        let grounded = Grounded::new(&Parcel, contact).ok()?;
        let mut fall = ForwardSimulation::new(&grounded, ZeroTorque);
        let mut q = Parcel.neutral();
        q[2] = 0.6;
        let start = fall.state(&q, &[0.0; Parcel::NV]);
        let at_start = grounded.energy(&q, &[0.0; Parcel::NV]).total();
        let mut touched = 0;
        let method = Ode45::new().rtol(1e-8).atol(1e-9);
        let end = grounded.run(&method, &mut fall, (0.0, 0.6), start, &mut Ends, |event| {
            touched += u32::from(event.touching);
        });
        let end = fall.split(&end.ok()?.y);
        let account = grounded.energy(&end.q, &end.v).total() - at_start - end.actuator_energy;
        kept &= touched > 0 && -1e-4 < account && account < 1e-4;
    }
    Some(kept)
}

/// The cart follows a sine, and the pole moves as that makes it.
fn a_pole_swings_on_a_cart_that_follows_a_motion() -> Option<bool> {
    let motion = |t: f64| {
        let (sin, cos) = redysim::Scalar::sin_cos(t);
        Motion { q: [sin, 0.0], v: [cos, 0.0], a: [-sin, 0.0] }
    };
    let mut simulation = HybridSimulation::new(&CartPole, motion, ZeroTorque);
    let start = simulation.state(0.0, &[0.0, 0.1], &[0.0; 2]);
    let end = Ode5::new(1e-3).integrate(&mut simulation, (0.0, 1.0), start).ok()?;
    let at_end = simulation.split(1.0, &end.y);
    let [on_cart, on_pole] = simulation.forced_motion(1.0, &end.y).tau;
    let (sin, _) = redysim::Scalar::sin_cos(1.0_f64);
    Some(on_pole == 0.0 && on_cart != 0.0 && at_end.q[0] == sin && at_end.q[1] != 0.1)
}

fn a_free_pole_takes_no_force() -> bool {
    let (q, v) = ([0.3_f64, 0.4], [0.8, -1.7]);
    let motion = CartPole::hybrid_dynamics(&q, &v, &[3.0, 0.0]);
    let [_, on_pole] = CartPole::inverse_dynamics(&q, &v, &motion.a);
    on_pole * on_pole < 1e-24
}

fn stops_at_an_event_with_stable_steps() -> Option<bool> {
    let mut fall = ForwardSimulation::new(&Kr5, ZeroTorque);
    let start = fall.state(&[0.0_f64; 6], &[0.0; 6]);
    let events = &mut [Event::any(&|_, y: &[f64; 13]| y[1] * y[1] - 0.01)];
    let end = Dop853::new()
        .solve_with_events(
            &mut fall,
            (0.0, 0.5),
            start,
            events,
            |_| ControlFlow::Continue(()),
            |_| ControlFlow::Break(()),
        )
        .ok()?;
    let stopped = end.t < 0.5 && end.y[1] * end.y[1] - 0.01 < 1e-9;
    let law = Pd { target: [0.0; 6], kp: [100.0; 6], kd: [10.0; 6] };
    let mut held = ForwardSimulation::new(&Kr5, law);
    let warning = held.step_warning(&SemiImplicitEuler::new(1.0), 0.0, &start).ok()??;
    let method = SemiImplicitEuler::new(0.5 * warning.stable.step);
    let end = method.integrate(&mut held, (0.0, 0.1), start).ok()?;
    Some(stopped && warning.joint.is_some() && end.y[2] < 1.0)
}

fn rests_under_limited_pid() -> Option<bool> {
    let (q, at_rest) = ([0.1, 0.7, -0.4, 0.3, 0.9, -0.2], [0.0; 6]);
    let [kp, ki, kd] = [[500.0; 6], [100.0; 6], [50.0; 6]];
    let tracking = tracking_rates(&kp, &ki, &kd);
    let integral = Kr5::gravity_forces(&q);
    let pid = Pid { trajectory: SetPoint::new(&Kr5, q), kp, ki, kd, tracking, integral };
    let mut held = ForwardSimulation::new(&Kr5, Limited { law: pid, limits: [1000.0; 6] });
    let start: [f64; 19] = held.extended_state(&q, &at_rest);
    let by_pid = Ode15s::new().integrate(&mut held, (0.0, 0.1), start).ok()?;
    let law = PdGravity { mechanism: &Kr5, trajectory: SetPoint::new(&Kr5, q), kp, kd };
    let mut held = ForwardSimulation::new(&Kr5, law);
    let start = held.state(&q, &at_rest);
    let by_gravity = Ode15s::new().integrate(&mut held, (0.0, 0.1), start).ok()?;
    let stays = |state: &[f64]| state.iter().zip(&q).all(|(now, then)| -1e-9 < now - then && now - then < 1e-9);
    Some(stays(&by_pid.y) && stays(&by_gravity.y))
}

fn holds_its_tool() -> Option<bool> {
    let (q, at_rest) = ([0.1, 0.7, -0.4, 0.3, 0.9, -0.2], [0.0; 6]);
    let [target] = Kr5Tool::frame_kinematics(&q, &at_rest);
    let gains = |linear: f64, angular: f64| FrameGains { linear: [linear; 3], angular: [angular; 3] };
    let law = Impedance {
        mechanism: &Kr5Tool,
        frame: 0,
        target,
        stiffness: gains(900.0, 0.0),
        damping: gains(90.0, 0.0),
        compensation: Compensation::Gravity,
        null_space_damping: 1.0,
    };
    let mut held = ForwardSimulation::new(&Kr5Tool, law);
    let start = held.state(&q, &[0.0, 0.0, 0.0, 0.1, 0.0, 0.0]);
    let end = Ode45::new().integrate(&mut held, (0.0, 0.1), start).ok()?;
    let [jacobian] = Kr5Tool::frame_jacobians(&q);
    let space = OperationalSpace::new(Kr5Tool::mass_matrix(&q), jacobian.rows()).ok()?;
    let slowed = end.y[9] < 0.099;
    Some(slowed && space.rank() == 6 && space.inertia()[0][0] > 0.1 && space.projector()[0][0] < 1e-9)
}

fn the_crank_carries_the_weight() -> Option<bool> {
    let loops = ClosedLoop::new(&Fourbar);
    let assembly = loops.assemble(&[0.0_f64, 0.9844, 4.3144], &[0.0; 3], &[0]).ok()?;
    let motion: IndependentMotion<f64, _, _, [f64; 1]> = loops.independent_motion(&assembly.q, &[0]).ok()?;
    let [torque] = motion.restricted(&Fourbar::gravity_forces(&assembly.q));
    let [velocity, ..] = motion.velocities(&[2.0]);
    Some(torque != 0.0 && 1.999 < velocity && velocity < 2.001)
}

fn implicit_methods_agree() -> Option<bool> {
    let law = Pd { target: [0.0; 6], kp: [100.0; 6], kd: [10.0; 6] };
    let mut held = ForwardSimulation::new(&Kr5, law);
    let start = held.state(&[0.1_f64; 6], &[0.0; 6]);
    let bdf = Ode15s::new().rtol(1e-6).atol(1e-8).integrate(&mut held, (0.0, 0.1), start).ok()?;
    let radau = Radau5::new().rtol(1e-6).atol(1e-8).integrate(&mut held, (0.0, 0.1), start).ok()?;
    let gauss = Gauss6::new(1e-3).integrate(&mut ForwardSimulation::new(&Kr5, ZeroTorque), (0.0, 0.1), start).ok()?;
    let apart = bdf.y[1] - radau.y[1];
    Some(-1e-4 < apart && apart < 1e-4 && gauss.y[1] < 0.1)
}

fn stays_closed_when_it_turns() -> Option<bool> {
    let loops = ClosedLoop::new(&Fourbar);
    let assembly = loops.assemble(&[0.0_f64, 0.9844, 4.3144], &[4.7124, 1.4045, 0.0], &[0]).ok()?;
    let mut turn = ClosedLoopSimulation::new(loops, ZeroTorque);
    let start = turn.start(&assembly.q, &assembly.v).ok()?;
    let adaptive = Ode45::new().rtol(1e-9).atol(1e-9).integrate(&mut turn, (0.0, 0.5), start).ok()?;
    let fixed = Ode5::new(1e-3).integrate(&mut turn, (0.0, 0.5), start).ok()?;
    let closed = [adaptive.y, fixed.y]
        .iter()
        .all(|state| Fourbar::loop_residual(&turn.split(state).q).iter().all(|gap| -1e-12 < *gap && *gap < 1e-12));
    let crank = |t: f64| Motion { q: [t], v: [1.0], a: [0.0] };
    let forces = ClosedLoopInverse::new(loops, &[0], assembly.q).at(0.1, &crank).ok()?;
    let law = ClosedLoopComputedTorque::new(loops, &[0], crank, [[400.0], [40.0]]);
    let mut driven = ClosedLoopSimulation::new(loops, law);
    let end = Ode5::new(1e-3).integrate(&mut driven, (0.0, 1.0), start).ok()?;
    let late = end.y[0] - 1.0;
    Some(closed && forces.redundancy == 0 && forces.rank == 2 && -1e-6 < late && late < 1e-6)
}
