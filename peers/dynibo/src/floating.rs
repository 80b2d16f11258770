//! A robot on a floating base, whose velocity and forces dynibo has in world axes, the angular ones first; the timer's
//! are in the base's axes, the linear ones first: v' = R v, ω' = R ω, f' = R f, τ' = R τ, a' = R (a + ω × v).

use dynibo::{BaseState, FloatingRobot, Frame, Twist};
use nalgebra::{Quaternion, Translation3, UnitQuaternion, Vector3};

/// Coordinates and velocities of the base.
const NQ: usize = 7;
const NV: usize = 6;

pub struct Floating {
    robot: FloatingRobot,
    /// Forces as dynibo takes them.
    forces: Vec<f64>,
}

impl Floating {
    pub fn new(robot: FloatingRobot) -> Self {
        let forces = vec![0.0; robot.generalized_count()];
        Self { robot, forces }
    }

    pub fn nv(&self) -> usize {
        self.forces.len()
    }

    pub fn inverse_dynamics(&mut self, q: &[f64], v: &[f64], a: &[f64], output: &mut [f64]) {
        let pose = pose(q);
        let turn = pose.rotation;
        let acceleration = Twist::new(turn * part(a, 3), turn * (part(a, 0) + part(v, 3).cross(&part(v, 0))));
        let base = BaseState::new(pose, velocity(&turn, v), acceleration).expect("a finite state");
        let (q, v, a) = (&q[NQ..], &v[NV..], &a[NV..]);
        self.robot.inverse_dynamics(&base, q, v, a, &[], output).expect("inverse dynamics");
        let (torque, force) = (part(output, 0), part(output, 3));
        put(output, turn.inverse() * force, turn.inverse() * torque);
    }

    pub fn forward_dynamics(&mut self, q: &[f64], v: &[f64], tau: &[f64], output: &mut [f64]) {
        let pose = pose(q);
        let turn = pose.rotation;
        self.forces.copy_from_slice(tau);
        put(&mut self.forces, turn * part(tau, 3), turn * part(tau, 0));
        let base = BaseState::new(pose, velocity(&turn, v), Twist::zeros()).expect("a finite state");
        self.robot.forward_dynamics(&base, &q[NQ..], &v[NV..], &self.forces, &[], output).expect("forward dynamics");
        let (angular, linear) = (turn.inverse() * part(output, 0), turn.inverse() * part(output, 3));
        put(output, linear - part(v, 3).cross(&part(v, 0)), angular);
    }

    /// In dynibo's velocities.
    pub fn mass_matrix(&mut self, q: &[f64], output: &mut [f64]) {
        let base = BaseState::stationary(pose(q)).expect("a finite state");
        self.robot.mass_matrix(&base, &q[NQ..], output).expect("mass matrix");
    }

    /// The symmetric matrix in dynibo's velocities, made that in the timer's.
    pub fn to_own_axes(&self, q: &[f64], matrix: &mut [f64]) {
        let back = pose(q).rotation.inverse();
        let n = self.nv();
        for row in matrix.chunks_exact_mut(n) {
            let (angular, linear) = (back * part(row, 0), back * part(row, 3));
            put(row, linear, angular);
        }
        for column in 0..n {
            let [angular, linear] = [0, 3].map(|at| back * Vector3::from_fn(|i, _| matrix[(at + i) * n + column]));
            for i in 0..3 {
                matrix[i * n + column] = linear[i];
                matrix[(3 + i) * n + column] = angular[i];
            }
        }
    }
}

fn pose(q: &[f64]) -> Frame {
    let turn = UnitQuaternion::new_unchecked(Quaternion::new(q[6], q[3], q[4], q[5]));
    Frame::from_parts(Translation3::new(q[0], q[1], q[2]), turn)
}

fn velocity(turn: &UnitQuaternion<f64>, v: &[f64]) -> Twist {
    Twist::new(turn * part(v, 3), turn * part(v, 0))
}

fn part(of: &[f64], at: usize) -> Vector3<f64> {
    Vector3::new(of[at], of[at + 1], of[at + 2])
}

fn put(into: &mut [f64], first: Vector3<f64>, second: Vector3<f64>) {
    into[..3].copy_from_slice(first.as_slice());
    into[3..6].copy_from_slice(second.as_slice());
}
