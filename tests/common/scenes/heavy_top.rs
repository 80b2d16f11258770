//! The heavy top that spins at 150 rad/s: a benchmark of integrators on rotations, with a quaternion and with Euler angles.
//!
//! Source of its numbers: Brüls and Cardona, *On the use of Lie group time integrators in multibody dynamics*, Journal of
//! Computational and Nonlinear Dynamics 5 (2010).

use nalgebra::Vector3;
use redysim::generic::{GenericMechanism, Inertia, JointKind, Link, Model, Vec3};
use redysim::{
    ConfigurationSpace, ForwardSimulation, IntegrationError, Integrator, MechanicalEnergy, Solution, Step, ZeroTorque,
};
use redysim_model::joint::EulerSequence;

/// 15 kg at 1 m along y, J = diag(0.234375, 0.46875, 0.234375) kg m² about the centre of mass, on a spherical joint with
/// Euler angles of the given sequence, or with a quaternion.
pub fn top(coordinates: Option<EulerSequence>) -> GenericMechanism {
    let top = Link {
        mass: 15.0,
        com: Vec3([0.0, 1.0, 0.0]),
        inertia: Inertia { xx: 0.234375, yy: 0.46875, zz: 0.234375, ..Inertia::default() },
        coordinates,
        ..Link::new("top", None, JointKind::Spherical)
    };
    GenericMechanism::new(Model { links: vec![top], ..Model::new("heavy_top", Vec3([0.0, 0.0, -9.81])) })
}

/// The angular velocity at the start, where the axes are those of the ground, as published, in rad/s.
pub const SPIN: Vector3<f64> = Vector3::new(0.0, 150.0, -4.615_38);

/// What an integration of the top shows.
pub struct Run {
    /// The state at the end, or the error of the integration.
    pub end: Result<Solution<f64, Vec<f64>>, IntegrationError<f64>>,
    /// Largest change of the energy at the ends of steps, as a share of what it is at the start.
    pub drift: f64,
    /// The least |cos θ| there, where θ is the second angle.
    pub gimbal: f64,
}

/// Two seconds from the angular velocity `spin` on by the given method, which the top passes in about fifty turns and eight noddings.
pub fn run(coordinates: Option<EulerSequence>, spin: Vector3<f64>, method: &impl Integrator<f64>) -> Run {
    let top = &top(coordinates);
    let (q, mut v) = (top.neutral(), spin);
    if let Some(sequence) = coordinates {
        // At zero angles each axis of the sequence is one of the ground.
        v = Vector3::from(sequence.axes().map(|axis| spin[axis]));
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
