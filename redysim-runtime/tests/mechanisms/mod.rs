// Mechanisms written by hand, for tests and for the examples in the documentation, which include this file.

use redysim_runtime::{
    Arguments, ConfigurationSpace, Energy, ForwardDynamics, FrameAcceleration, FrameJacobian, FrameState, Frames,
    GravityForces, InverseDynamics, LinkState, MechanicalEnergy, Mechanism, Real, Scalar, Vector, VelocityCoordinates,
    Wrench,
};

pub const GRAVITY: f64 = 9.81;

/// What [`Mechanism`] requires, for a mechanism whose joints and links have no names, with as many links as velocities.
macro_rules! without_names {
    ($name:literal, $nq:literal, $nv:literal) => {
        fn name(&self) -> &str {
            $name
        }
        fn nq(&self) -> usize {
            $nq
        }
        fn nv(&self) -> usize {
            $nv
        }
        fn nl(&self) -> usize {
            $nv
        }
        fn link_name(&self, _: usize) -> Option<&str> {
            None
        }
        fn joint_name(&self, _: usize) -> Option<&str> {
            None
        }
    };
}

/// A mechanism of `$n` revolute joints and links without names.
macro_rules! mechanism {
    ($type:ident, $name:literal, $n:literal) => {
        impl Mechanism for $type {
            without_names!($name, $n, $n);
        }

        configuration_space!($type, $n);
    };
}

/// The space of `$n` coordinates whose rates are the velocities.
macro_rules! configuration_space {
    ($type:ident, $n:literal) => {
        impl<S: Scalar> ConfigurationSpace<S> for $type {
            type Coordinates = [S; $n];
            type Velocities = [S; $n];
            type State = [S; 2 * $n + 1];
            type Matrix = [[S; $n]; $n];
            type Links = [LinkState<S>; $n];

            fn coordinate_rates(&self, _: &[S; $n], v: &[S; $n]) -> [S; $n] {
                *v
            }
            fn integrate(&self, q: &[S; $n], dv: &[S; $n]) -> [S; $n] {
                std::array::from_fn(|i| q[i] + dv[i])
            }
            fn difference(&self, q0: &[S; $n], q1: &[S; $n]) -> [S; $n] {
                std::array::from_fn(|i| q1[i] - q0[i])
            }
            fn neutral(&self) -> [S; $n] {
                [S::zero(); $n]
            }
        }
    };
}

/// A point mass on a massless rod; q = 0 hangs down.
#[derive(Clone, Copy)]
pub struct Pendulum {
    pub mass: f64,
    pub length: f64,
}

impl Pendulum {
    fn inertia<S: Scalar>(&self) -> S {
        S::from_f64(self.mass * self.length * self.length)
    }

    fn weight<S: Scalar>(&self) -> S {
        S::from_f64(self.mass * GRAVITY * self.length)
    }

    /// The exact period for swings of amplitude `amplitude`, by the arithmetic-geometric mean.
    pub fn period(&self, amplitude: f64) -> f64 {
        let (mut a, mut b) = (1.0, (amplitude / 2.0).cos());
        for _ in 0..10 {
            (a, b) = ((a + b) / 2.0, (a * b).sqrt());
        }
        std::f64::consts::TAU * (self.length / GRAVITY).sqrt() / a
    }
}

mechanism!(Pendulum, "pendulum", 1);

impl<S: Scalar> InverseDynamics<S> for Pendulum {
    fn inverse_dynamics(&self, q: &[S; 1], _: &[S; 1], a: &[S; 1]) -> [S; 1] {
        [self.inertia::<S>() * a[0] + self.weight::<S>() * q[0].sin_cos().0]
    }

    fn inverse_dynamics_tangent(
        &self,
        at: Arguments<'_, S, Self>,
        slopes: Arguments<'_, S, Self>,
    ) -> Option<Self::Velocities> {
        Some(redysim_runtime::inverse_dynamics_tangent(self, at, slopes))
    }
}

impl<S: Scalar> ForwardDynamics<S> for Pendulum {
    fn forward_dynamics(&self, q: &[S; 1], _: &[S; 1], tau: &[S; 1]) -> [S; 1] {
        [(tau[0] - self.weight::<S>() * q[0].sin_cos().0) / self.inertia()]
    }

    fn forward_dynamics_tangent(
        &self,
        at: Arguments<'_, S, Self>,
        slopes: Arguments<'_, S, Self>,
    ) -> Option<Self::Velocities> {
        Some(redysim_runtime::forward_dynamics_tangent(self, at, slopes))
    }
}

impl<S: Scalar> GravityForces<S> for Pendulum {
    fn gravity_forces(&self, q: &[S; 1]) -> [S; 1] {
        [self.weight::<S>() * q[0].sin_cos().0]
    }
}

impl<S: Scalar> MechanicalEnergy<S> for Pendulum {
    fn energy(&self, q: &[S; 1], v: &[S; 1]) -> Energy<S> {
        Energy {
            kinetic: S::from_f64(0.5) * self.inertia() * v[0] * v[0],
            potential: -(self.weight::<S>() * q[0].sin_cos().1),
        }
    }
}

/// Two point masses of 1 kg on massless rods of 1 m and 0.5 m, the second hinged at the end of the first; q = 0 hangs
/// down, q₂ is relative.
#[derive(Clone, Copy)]
pub struct Arm;

impl Arm {
    const L1: f64 = 1.0;
    const L2: f64 = 0.5;

    /// [M₁₁, M₁₂, M₂₂]
    fn mass_matrix<S: Scalar>(q: &[S; 2]) -> [S; 3] {
        let coupling = S::from_f64(Self::L1 * Self::L2) * q[1].sin_cos().1;
        let outer = S::from_f64(Self::L2 * Self::L2);
        [S::from_f64(2.0 * Self::L1 * Self::L1) + outer + coupling + coupling, outer + coupling, outer]
    }

    fn bias<S: Scalar>(q: &[S; 2], v: &[S; 2]) -> [S; 2] {
        let coupling = S::from_f64(Self::L1 * Self::L2) * q[1].sin_cos().0;
        let inner_weight = S::from_f64(2.0 * GRAVITY * Self::L1) * q[0].sin_cos().0;
        let outer_weight = S::from_f64(GRAVITY * Self::L2) * (q[0] + q[1]).sin_cos().0;
        [inner_weight + outer_weight - coupling * v[1] * (v[0] + v[0] + v[1]), outer_weight + coupling * v[0] * v[0]]
    }
}

mechanism!(Arm, "arm", 2);

impl<S: Scalar> InverseDynamics<S> for Arm {
    fn inverse_dynamics(&self, q: &[S; 2], v: &[S; 2], a: &[S; 2]) -> [S; 2] {
        let ([m11, m12, m22], bias) = (Self::mass_matrix(q), Self::bias(q, v));
        [m11 * a[0] + m12 * a[1] + bias[0], m12 * a[0] + m22 * a[1] + bias[1]]
    }

    fn inverse_dynamics_tangent(
        &self,
        at: Arguments<'_, S, Self>,
        slopes: Arguments<'_, S, Self>,
    ) -> Option<Self::Velocities> {
        Some(redysim_runtime::inverse_dynamics_tangent(self, at, slopes))
    }
}

impl<S: Scalar> ForwardDynamics<S> for Arm {
    fn forward_dynamics(&self, q: &[S; 2], v: &[S; 2], tau: &[S; 2]) -> [S; 2] {
        let ([m11, m12, m22], bias) = (Self::mass_matrix(q), Self::bias(q, v));
        let (f1, f2) = (tau[0] - bias[0], tau[1] - bias[1]);
        let determinant = m11 * m22 - m12 * m12;
        [(m22 * f1 - m12 * f2) / determinant, (m11 * f2 - m12 * f1) / determinant]
    }

    fn forward_dynamics_tangent(
        &self,
        at: Arguments<'_, S, Self>,
        slopes: Arguments<'_, S, Self>,
    ) -> Option<Self::Velocities> {
        Some(redysim_runtime::forward_dynamics_tangent(self, at, slopes))
    }
}

impl<S: Scalar> MechanicalEnergy<S> for Arm {
    fn energy(&self, q: &[S; 2], v: &[S; 2]) -> Energy<S> {
        let [m11, m12, m22] = Self::mass_matrix(q);
        let twice_kinetic = m11 * v[0] * v[0] + S::from_f64(2.0) * m12 * v[0] * v[1] + m22 * v[1] * v[1];
        let height =
            -(S::from_f64(2.0 * Self::L1) * q[0].sin_cos().1 + S::from_f64(Self::L2) * (q[0] + q[1]).sin_cos().1);
        Energy { kinetic: S::from_f64(0.5) * twice_kinetic, potential: S::from_f64(GRAVITY) * height }
    }
}

/// The largest distance between components.
pub fn distance<S: Real, V: Vector<S>>(a: &V, b: &V) -> f64 {
    a.as_ref().iter().zip(b.as_ref()).map(|(&a, &b)| (a - b).to_f64().abs()).fold(0.0, Real::maximum)
}

/// A point mass that moves along x, y and z, which points up; its frames 0 and 1 are where it is, so that both may meet
/// something.
#[derive(Clone, Copy)]
pub struct Ball {
    pub mass: f64,
}

impl Mechanism for Ball {
    without_names!("ball", 3, 3);

    fn nf(&self) -> usize {
        2
    }
}

configuration_space!(Ball, 3);

impl<S: Scalar> ForwardDynamics<S> for Ball {
    fn forward_dynamics(&self, _: &[S; 3], _: &[S; 3], tau: &[S; 3]) -> [S; 3] {
        let [x, y, z] = tau.map(|force| force / S::from_f64(self.mass));
        [x, y, z - S::from_f64(GRAVITY)]
    }
}

impl<S: Scalar> MechanicalEnergy<S> for Ball {
    fn energy(&self, q: &[S; 3], v: &[S; 3]) -> Energy<S> {
        let mass = S::from_f64(self.mass);
        let [x, y, z] = *v;
        Energy {
            kinetic: S::from_f64(0.5) * mass * (x * x + y * y + z * z),
            potential: mass * S::from_f64(GRAVITY) * q[2],
        }
    }
}

impl<S: Scalar> Frames<S> for Ball {
    type States = [FrameState<S>; 2];
    type Jacobians = [FrameJacobian<[S; 3]>; 2];
    type Accelerations = [FrameAcceleration<S>; 2];
    type Wrenches = [Wrench<S>; 2];

    fn frame_kinematics(&self, q: &[S; 3], v: &[S; 3]) -> Self::States {
        [FrameState { rotation: unit(), origin: *q, velocity: *v, angular_velocity: [S::zero(); 3] }; 2]
    }
    fn frame_jacobians(&self, _: &[S; 3]) -> Self::Jacobians {
        [FrameJacobian { linear: unit(), angular: [[S::zero(); 3]; 3] }; 2]
    }
    fn frame_bias(&self, _: &[S; 3], _: &[S; 3]) -> Self::Accelerations {
        [FrameAcceleration { linear: [S::zero(); 3], angular: [S::zero(); 3] }; 2]
    }
    fn frame_forces(&self, _: &[S; 3], wrenches: &Self::Wrenches) -> [S; 3] {
        std::array::from_fn(|axis| wrenches[0].force[axis] + wrenches[1].force[axis])
    }
}

/// A body that turns about its centre of mass; q is a unit quaternion (x, y, z, w), v the angular velocity in its axes.
#[derive(Clone, Copy)]
pub struct Top;

impl Top {
    /// Principal moments of inertia, kg m².
    pub const INERTIA: [f64; 3] = [0.5, 0.8, 1.1];

    /// p q.
    pub fn product([a, b, c, d]: [f64; 4], [x, y, z, w]: [f64; 4]) -> [f64; 4] {
        [
            d * x + a * w + b * z - c * y,
            d * y + b * w + c * x - a * z,
            d * z + c * w + a * y - b * x,
            d * w - a * x - b * y - c * z,
        ]
    }
}

impl Mechanism for Top {
    without_names!("top", 4, 3);

    fn coordinates_of_velocity(&self, index: usize) -> VelocityCoordinates {
        if index < 3 { VelocityCoordinates::Quaternion(0) } else { VelocityCoordinates::Unknown }
    }
}

impl ConfigurationSpace<f64> for Top {
    type Coordinates = [f64; 4];
    type Velocities = [f64; 3];
    type State = [f64; 8];
    type Matrix = [[f64; 3]; 3];
    type Links = [LinkState<f64>; 3];

    fn coordinate_rates(&self, q: &[f64; 4], v: &[f64; 3]) -> [f64; 4] {
        Self::product(*q, [0.5 * v[0], 0.5 * v[1], 0.5 * v[2], 0.0])
    }
    fn integrate(&self, q: &[f64; 4], dv: &[f64; 3]) -> [f64; 4] {
        let angle = dv[0].hypot(dv[1]).hypot(dv[2]);
        let share = if angle == 0.0 { 0.5 } else { (0.5 * angle).sin() / angle };
        let length = q.iter().map(|component| component * component).sum::<f64>().sqrt();
        let turn = [share * dv[0], share * dv[1], share * dv[2], (0.5 * angle).cos()];
        Self::product(q.map(|component| component / length), turn)
    }
    fn difference(&self, q0: &[f64; 4], q1: &[f64; 4]) -> [f64; 3] {
        let [x, y, z, w] = Self::product([-q0[0], -q0[1], -q0[2], q0[3]], *q1);
        let sin = x.hypot(y).hypot(z);
        let share = if sin == 0.0 { 2.0 / w } else { 2.0 * sin.atan2(w.abs()) / sin * 1.0_f64.copysign(w) };
        [share * x, share * y, share * z]
    }
    fn neutral(&self) -> [f64; 4] {
        [0.0, 0.0, 0.0, 1.0]
    }
}

impl ForwardDynamics<f64> for Top {
    /// Euler's equations.
    fn forward_dynamics(&self, _: &[f64; 4], v: &[f64; 3], tau: &[f64; 3]) -> [f64; 3] {
        let [a, b, c] = Self::INERTIA;
        let [x, y, z] = *v;
        [(tau[0] - (c - b) * y * z) / a, (tau[1] - (a - c) * z * x) / b, (tau[2] - (b - a) * x * y) / c]
    }
}

fn unit<S: Scalar>() -> [[S; 3]; 3] {
    std::array::from_fn(|row| std::array::from_fn(|column| S::from_f64(f64::from(u8::from(row == column)))))
}
