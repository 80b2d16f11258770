//! Impedance control of frames: its statics, its energy, its frequency and its null space.
#![cfg(feature = "generic")]

use redysim::generic::{GenericMechanism, Model};
use redysim::{
    Compensation, ConfigurationSpace, Dop853, ForwardDynamics, ForwardSimulation, FrameGains, FrameState, Frames,
    Impedance, Integrator, LengthMismatch, MassMatrix, MechanicalEnergy, Mechanism, OperationalSpace, TaskStatus,
    TorqueLaw, Wrench,
};

/// KR5 with a tool, whose frame is turned against the flange.
fn kr5() -> GenericMechanism {
    let path = format!("{}/models/peers/kr5.toml", env!("CARGO_MANIFEST_DIR"));
    let frame =
        "\n[[frame]]\nname = \"tool\"\nlink = \"link6\"\norigin = { xyz = [0.05, 0.02, 0.2], rpy = [0.3, 0.7, 0] }\n";
    let text = std::fs::read_to_string(path).expect("a model file") + frame;
    GenericMechanism::new(Model::from_toml(&text, "kr5.toml").expect("a good model").model)
}

/// Away from singular positions.
const Q: [f64; 6] = [0.3, 0.7, -0.6, 0.4, 0.9, -0.2];

fn tool(robot: &GenericMechanism, q: &[f64], v: &[f64]) -> FrameState<f64> {
    robot.frame_kinematics(&q.to_vec(), &v.to_vec())[0]
}

/// The law that holds the tool where it is at `Q`.
fn held(robot: &GenericMechanism) -> Impedance<'_, f64, GenericMechanism, FrameState<f64>> {
    Impedance {
        mechanism: robot,
        frame: 0,
        target: tool(robot, &Q, &[0.0; 6]),
        stiffness: FrameGains { linear: [900.0, 1600.0, 2500.0], angular: [90.0, 120.0, 160.0] },
        damping: FrameGains { linear: [300.0; 3], angular: [30.0; 3] },
        compensation: Compensation::Gravity,
        null_space_damping: 0.0,
    }
}

fn times(rotation: &[[f64; 3]; 3], x: [f64; 3]) -> [f64; 3] {
    rotation.map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum())
}

fn transposed(a: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] - b[i])
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The law with a constant wrench on the tool, for a simulation.
fn pressed<'a>(
    law: &'a mut Impedance<'_, f64, GenericMechanism, FrameState<f64>>,
    robot: &'a GenericMechanism,
    wrench: Wrench<f64>,
) -> impl FnMut(f64, &Vec<f64>, &Vec<f64>) -> Vec<f64> + 'a {
    move |t, q, v| {
        let by_wrench = robot.frame_forces(q, &vec![wrench]);
        let by_law = law.torque(robot, t, q, v);
        by_law.iter().zip(&by_wrench).map(|(a, b)| a + b).collect()
    }
}

#[test]
fn under_a_wrench_the_tool_rests_off_its_place_by_the_inverse_stiffness_times_the_wrench() {
    let robot = kr5();
    let wrench = Wrench { force: [20.0, -30.0, 15.0], moment: [3.0, 2.0, -4.0] };
    let mut law = held(&robot);
    let target = law.target;
    let (stiffness, angular_stiffness) = (law.stiffness.linear, law.stiffness.angular);
    let mut simulation = ForwardSimulation::new(&robot, pressed(&mut law, &robot, wrench));
    let start = simulation.state(&Q.to_vec(), &vec![0.0; 6]);
    let method = redysim::Ode15s::new().rtol(1e-8).atol(1e-10);
    let end = method.integrate(&mut simulation, (0.0, 8.0), start).unwrap();
    let parts = simulation.split(&end.y);
    assert!(parts.v.iter().all(|v| v.abs() < 1e-7), "at rest: {:?}", parts.v);
    let state = tool(&robot, &parts.q, &parts.v);
    // Along the axes of the desired frame.
    let axes = transposed(target.rotation);
    let (displacement, force) = (times(&axes, minus(state.origin, target.origin)), times(&axes, wrench.force));
    let turn: [[f64; 3]; 3] = std::array::from_fn(|i| {
        std::array::from_fn(|j| (0..3).map(|k| state.rotation[i][k] * target.rotation[j][k]).sum())
    });
    // Its rotation vector by the series of the logarithm, for a rotation of a few degrees.
    let (skew, sin) = {
        let skew = [turn[2][1] - turn[1][2], turn[0][2] - turn[2][0], turn[1][0] - turn[0][1]].map(|x| 0.5 * x);
        (skew, dot(&skew, &skew).sqrt())
    };
    let rotation = times(&axes, skew.map(|x| x * sin.asin() / sin));
    let moment = times(&axes, wrench.moment);
    assert!(sin > 0.02 && displacement.iter().any(|x| x.abs() > 0.01), "{sin} {displacement:?}");
    for axis in 0..3 {
        let expected = force[axis] / stiffness[axis];
        assert!((displacement[axis] - expected).abs() < 1e-7, "{displacement:?} instead of {expected} along {axis}");
        let expected = moment[axis] / angular_stiffness[axis];
        assert!((rotation[axis] - expected).abs() < 1e-7, "{rotation:?} instead of {expected} about {axis}");
    }
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn energy_is_conserved_without_damping() {
    let robot = kr5();
    let gains = FrameGains { linear: [900.0, 1600.0, 2500.0], angular: [80.0; 3] };
    let law = Impedance { stiffness: gains, damping: FrameGains::default(), ..held(&robot) };
    let target = law.target;
    let energy = |q: &Vec<f64>, v: &Vec<f64>| {
        let state = tool(&robot, q, v);
        let apart = times(&transposed(target.rotation), minus(target.origin, state.origin));
        // |φ| from the trace of R_d Rᵀ, 1 + 2 cos φ.
        let trace: f64 = target.rotation.concat().iter().zip(state.rotation.concat()).map(|(a, b)| a * b).sum();
        let angle = (0.5 * (trace - 1.0)).clamp(-1.0, 1.0).acos();
        let linear: f64 = (0..3).map(|i| 0.5 * gains.linear[i] * apart[i] * apart[i]).sum();
        [robot.energy(q, v).kinetic, linear + 0.5 * 80.0 * angle * angle]
    };
    let mut simulation = ForwardSimulation::new(&robot, law);
    let (q, v) = (Q.map(|q| q + 0.2).to_vec(), vec![0.3; 6]);
    let [kinetic, potential] = energy(&q, &v);
    let start = simulation.state(&q, &v);
    let duration = if cfg!(debug_assertions) { 0.1 } else { 0.5 };
    let end = Dop853::new().rtol(1e-10).atol(1e-12).integrate(&mut simulation, (0.0, duration), start).unwrap();
    let parts = simulation.split(&end.y);
    let [kinetic_there, potential_there] = energy(&parts.q, &parts.v);
    assert!((kinetic_there - kinetic).abs() > 0.1 * (kinetic + potential), "{kinetic} {kinetic_there}");
    let gained = kinetic_there + potential_there - kinetic - potential;
    assert!(gained.abs() < 1e-7 * (kinetic + potential), "{gained} J of {} J", kinetic + potential);
}

/// A spring along one axis alone: δ̈ = −(k/Λ) δ, with Λ = 1/(J M⁻¹ Jᵀ) along it.
#[test]
fn the_tool_swings_on_its_spring_with_the_frequency_of_the_operational_space_inertia() {
    let robot = kr5();
    let k = 800.0;
    let only = |k: f64| FrameGains { linear: [0.0, k, 0.0], angular: [0.0; 3] };
    let target = tool(&robot, &Q, &[0.0; 6]);
    let axis: [f64; 3] = transposed(target.rotation)[1];
    let rows = &robot.frame_jacobians(&Q.to_vec())[0].linear;
    let row: Vec<f64> = (0..6).map(|j| (0..3).map(|i| axis[i] * rows[i][j]).sum()).collect();
    let space = OperationalSpace::new(robot.mass_matrix(&Q.to_vec()), [row]).unwrap();
    let [[inertia]] = space.inertia();
    let omega = (k / inertia).sqrt();
    let amplitude = 1e-5;
    let shift = space.joint_velocity(&[amplitude]);
    let law = Impedance {
        stiffness: only(k),
        damping: FrameGains::default(),
        compensation: Compensation::Bias,
        ..held(&robot)
    };
    let mut simulation = ForwardSimulation::new(&robot, law);
    let q = robot.integrate(&Q.to_vec(), &shift);
    let start = simulation.state(&q, &vec![0.0; 6]);
    for part in [0.25, 0.5, 1.0] {
        let t = part * std::f64::consts::TAU / omega;
        let end = Dop853::new().rtol(1e-11).atol(1e-15).integrate(&mut simulation, (0.0, t), start.clone()).unwrap();
        let parts = simulation.split(&end.y);
        let displacement = dot(&axis, &minus(tool(&robot, &parts.q, &parts.v).origin, target.origin));
        let expected = amplitude * (omega * t).cos();
        // What the bending of the path and the change of Λ leave is of the second order.
        assert!((displacement - expected).abs() < 1e-3 * amplitude, "{part}: {displacement} instead of {expected}");
    }
}

#[test]
fn null_space_damping_slows_the_motions_that_leave_the_task_alone_and_nothing_else() {
    let robot = kr5();
    // Six joints hold a point: three are left.
    let gains = |x: f64| FrameGains { linear: [x; 3], angular: [0.0; 3] };
    let law = Impedance { stiffness: gains(900.0), damping: gains(60.0), ..held(&robot) };
    let rate = 3.0;
    let (q, v) = (Q.to_vec(), vec![0.5, -0.3, 0.8, -1.0, 0.2, 0.6]);
    let accelerations = |null_space_damping| {
        let mut law = Impedance { null_space_damping, ..law };
        let tau = law.torque(&robot, 0.0, &q, &v);
        robot.forward_dynamics(&q, &v, &tau)
    };
    let (with, without) = (accelerations(rate), accelerations(0.0));
    let space = OperationalSpace::new(robot.mass_matrix(&q), robot.frame_jacobians(&q)[0].linear.clone()).unwrap();
    let null = space.null_velocity(&v);
    assert!(null.iter().any(|v| v.abs() > 0.1), "{null:?}");
    for i in 0..6 {
        assert!((with[i] - without[i] + rate * null[i]).abs() < 1e-9, "{with:?} {without:?} {null:?}");
    }
}

/// With joints 4 and 6 in line, the tool cannot turn about what is square to both axes of the wrist.
#[test]
fn a_straight_wrist_has_task_rank_five() {
    let robot = kr5();
    let space = |q: &[f64]| {
        let (mass_matrix, jacobians) = (robot.mass_matrix(&q.to_vec()), robot.frame_jacobians(&q.to_vec()));
        OperationalSpace::new(mass_matrix, jacobians[0].rows()).unwrap()
    };
    assert_eq!(space(&Q).status(), TaskStatus::Full);
    let mut straight = Q;
    straight[4] = 0.0;
    let space = space(&straight);
    assert!(matches!(space.status(), TaskStatus::Deficient { rank: 5, .. }), "{:?}", space.status());
    // What the joints can do is attainable, and the wrist's own motion is all that leaves the tool alone.
    let velocity = space.task_velocity(&vec![0.5, -0.3, 0.8, -1.0, 0.2, 0.6]);
    for (attained, velocity) in space.attainable(&velocity).iter().zip(velocity) {
        assert!((attained - velocity).abs() < 1e-12, "{attained} {velocity}");
    }
    let counter = [0.0, 0.0, 0.0, 1.0, 0.0, -1.0];
    for (kept, counter) in space.null_velocity(&counter.to_vec()).iter().zip(counter) {
        assert!((kept - counter).abs() < 1e-9, "{kept} {counter}");
    }
    assert!(space.inertia().iter().flatten().all(|element| element.is_finite() && element.abs() < 1e4));
}

/// By the formula, in a frame that is neither the tool's nor the base's, with a moving target.
#[test]
fn the_wrench_is_that_of_springs_and_dampers_along_the_axes_of_the_desired_frame() {
    let robot = kr5();
    let quarter = [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    let target = move |t: f64| FrameState {
        rotation: quarter,
        origin: [t, 0.0, 0.0],
        velocity: [1.0, 0.0, 0.0],
        angular_velocity: [0.0, 0.0, 0.5],
    };
    let law = Impedance {
        mechanism: &robot,
        frame: 0,
        target,
        stiffness: FrameGains { linear: [10.0, 20.0, 30.0], angular: [1.0, 2.0, 3.0] },
        damping: FrameGains { linear: [4.0, 5.0, 6.0], angular: [0.4, 0.5, 0.6] },
        compensation: Compensation::Gravity,
        null_space_damping: 0.0,
    };
    // The tool's axes are those of the base: it is to turn by 90° about z.
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let state = FrameState {
        rotation: identity,
        origin: [0.0, 1.0, 0.0],
        velocity: [0.0; 3],
        angular_velocity: [0.1, 0.0, 0.0],
    };
    let wrench = law.wrench(2.0, &state);
    // The desired frame's y is −x of the base, its x is y.
    let expected = Wrench {
        force: [20.0 * 2.0 + 5.0, -10.0, 0.0],
        moment: [0.5 * -0.1, 0.0, 3.0 * std::f64::consts::FRAC_PI_2 + 0.6 * 0.5],
    };
    for (found, expected) in
        wrench.force.iter().chain(&wrench.moment).zip(expected.force.iter().chain(&expected.moment))
    {
        assert!((found - expected).abs() < 1e-13, "{wrench:?}");
    }
}

#[test]
fn a_frame_that_the_mechanism_lacks_is_refused_before_a_simulation_begins() {
    let robot = kr5();
    let mut law = Impedance { frame: 1, ..held(&robot) };
    let mismatch = LengthMismatch { vector: "frames", length: 1, expected: 2 };
    assert_eq!(law.check_lengths(0.0, &robot), Err(mismatch));
    let tau = law.torque(&robot, 0.0, &Q.to_vec(), &vec![0.0; robot.nv()]);
    assert!(tau.iter().all(|tau: &f64| tau.is_nan()) && tau.len() == 6);
}
