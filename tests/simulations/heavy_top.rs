//! The heavy top that spins at 150 rad/s: a benchmark of integrators on rotations.
//!
//! Source of its numbers: Brüls and Cardona, *On the use of Lie group time integrators in multibody dynamics*, Journal of
//! Computational and Nonlinear Dynamics 5 (2010).
#![cfg(feature = "generic")]

use nalgebra::Vector3;
use redysim::generic::{GenericMechanism, Inertia, JointKind, Link, Model, Vec3};
use redysim::{
    ConfigurationSpace, Dop853, ForwardSimulation, IntegrationError, Integrator, LinkKinematics, MechanicalEnergy,
    Mechanism, Ode4, Solution, Step, ZeroTorque,
};
use redysim_model::joint::EulerSequence;

/// 15 kg at 1 m along y, J = diag(0.234375, 0.46875, 0.234375) kg m² about the centre of mass, on a spherical joint with
/// Euler angles of the given sequence, or with a quaternion.
fn top(coordinates: Option<EulerSequence>) -> GenericMechanism {
    let top = Link {
        mass: 15.0,
        com: Vec3([0.0, 1.0, 0.0]),
        inertia: Inertia { xx: 0.234375, yy: 0.46875, zz: 0.234375, ..Inertia::default() },
        coordinates,
        ..Link::new("top", None, JointKind::Spherical)
    };
    GenericMechanism::new(Model { links: vec![top], ..Model::new("heavy_top", Vec3([0.0, 0.0, -9.81])) })
}

/// The angular velocity at the start, where the axes are those of the ground, in rad/s.
const SPIN: Vector3<f64> = Vector3::new(0.0, 150.0, -4.615_38);

/// What an integration of the top shows.
struct Run {
    /// The state at the end, or the error of the integration.
    end: Result<Solution<f64, Vec<f64>>, IntegrationError<f64>>,
    /// Largest change of the energy at the ends of steps, as a share of that of the spin.
    drift: f64,
    /// The least |cos θ| there, where θ is the second angle.
    gimbal: f64,
}

/// Two seconds by the given method, which the top passes in about fifty turns and eight noddings.
fn run(top: &GenericMechanism, coordinates: Option<EulerSequence>, method: impl Integrator<f64>) -> Run {
    let (q, mut v) = (top.neutral(), SPIN);
    if let Some(sequence) = coordinates {
        // At zero angles each axis of the sequence is one of the ground.
        v = Vector3::from(sequence.axes().map(|axis| SPIN[axis]));
    }
    let mut simulation = ForwardSimulation::new(top, ZeroTorque);
    let start: Vec<f64> = simulation.state(&q, &v.as_slice().to_vec());
    let energy = |state: &Vec<f64>| {
        let (q, rest) = state.split_at(q.len());
        let energy = top.energy(&q.to_vec(), &rest[..3].to_vec());
        energy.kinetic + energy.potential
    };
    let at_start = energy(&start);
    let (mut drift, mut gimbal) = (0.0_f64, f64::INFINITY);
    let on_step = |step: &Step<'_, f64, Vec<f64>>| {
        let state = step.end().1;
        drift = drift.max((energy(state) - at_start).abs() / at_start);
        gimbal = gimbal.min(state[1].cos().abs());
    };
    let end = method.each_step(&mut simulation, (0.0, 2.0), start, on_step);
    Run { end, drift, gimbal }
}

const ZXY: Option<EulerSequence> = Some(EulerSequence::Zxy);

/// A spin about the last axis of the sequence, as favourable as it can be: the top nods through the gimbal all the same.
#[test]
fn fixed_steps_fail_at_the_gimbal_of_euler_angles_and_not_with_a_quaternion() {
    let by_quaternion = run(&top(None), None, Ode4::new(1e-4));
    assert!(by_quaternion.end.is_ok() && by_quaternion.drift < 2e-10, "{:e}", by_quaternion.drift);
    let by_angles = run(&top(ZXY), ZXY, Ode4::new(1e-4));
    let fault = by_angles.end.expect_err("the steps pass the gimbal too fast");
    assert!(matches!(fault, IntegrationError::NonFiniteDerivative { t, .. } if t > 0.37 && t < 0.38), "{fault}");
    assert!(by_angles.drift > 1.0, "it gains energy before: {:e}", by_angles.drift);
}

#[test]
fn steps_by_tolerance_pass_the_gimbal_of_euler_angles_by_rejected_steps_and_agree_with_a_quaternion() {
    let method = || Dop853::new().rtol(1e-10).atol(1e-10);
    let runs = [None, ZXY].map(|coordinates| {
        let top = top(coordinates);
        let run = run(&top, coordinates, method());
        let end = run.end.expect("it arrives");
        let (q, rest) = end.y.split_at(top.nq());
        let com = top.link_kinematics(&q.to_vec(), &rest[..3].to_vec())[0].com;
        println!("{coordinates:?}: drift {:.1e}, |cos θ| {:.1e}, {:?}", run.drift, run.gimbal, end.statistics);
        (Vector3::from(com), run.drift, run.gimbal, end.statistics.rejected)
    });
    let [(expected, drift, _, rejected), (found, drift_by_angles, gimbal, rejected_by_angles)] = runs;
    assert!(gimbal < 1e-6, "{gimbal:e}");
    assert!(drift < 2e-11 && drift_by_angles < 2e-10, "{drift:e}, {drift_by_angles:e}");
    assert!(rejected == 0 && rejected_by_angles > 20, "{rejected}, {rejected_by_angles}");
    // 1e-10 a step over a thousand steps.
    assert!((found - expected).amax() < 1e-8, "{found} {expected}");
}

/// Where the first and the third axis are the same, the top starts in the gimbal.
#[test]
fn a_start_in_the_gimbal_is_reported_with_what_to_look_for() {
    let sequence = Some(EulerSequence::Zxz);
    let fault = run(&top(sequence), sequence, Ode4::new(1e-4)).end.expect_err("the mass matrix is singular");
    assert!(fault.to_string().contains("a singular mass matrix"), "{fault}");
}
