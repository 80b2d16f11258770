// A slider-crank by hand, twice: the angle of its crank is one coordinate, or its cosine and sine are two.
//
// The crank turns about the origin, the rod about the crank's tip, the slider moves along x; the rod's tip is the
// slider's pin. Point masses sit at both tips and on the slider; gravity acts along −y.

use redysim_runtime::{
    BiasForces, ConfigurationSpace, InverseDynamics, LinkState, LoopClosure, LoopRows, MassMatrix, Mechanism,
};

pub const CRANK: f64 = 0.4;
pub const ROD: f64 = 0.9;
const GRAVITY: f64 = 9.81;
/// Masses at the crank's tip, at the rod's tip and on the slider, kg.
const MASSES: [f64; 3] = [1.3, 0.7, 2.1];

/// With the crank's angle: q = [crank, rod, slider].
#[derive(Clone, Copy, Debug)]
pub struct ByAngle;

/// With the crank's cosine and sine: q = [cos, sin, rod, slider], v as with the angle.
#[derive(Clone, Copy, Debug)]
pub struct ByCosine;

/// Cosine and sine of the crank's angle, and of the rod's from the x axis; sine and cosine of the angle between.
struct Position {
    crank: [f64; 2],
    rod: [f64; 2],
    between: [f64; 2],
    slider: f64,
}

impl Position {
    fn new(cos: f64, sin: f64, rod: f64, slider: f64) -> Self {
        let (s, c) = rod.sin_cos();
        Position { crank: [cos, sin], rod: [cos * c - sin * s, sin * c + cos * s], between: [s, c], slider }
    }

    fn mass_matrix(&self) -> [[f64; 3]; 3] {
        let [inner, outer, slider] = MASSES;
        let (coupling, rod) = (outer * CRANK * ROD * self.between[1], outer * ROD * ROD);
        [
            [(inner + outer) * CRANK * CRANK + rod + 2.0 * coupling, rod + coupling, 0.0],
            [rod + coupling, rod, 0.0],
            [0.0, 0.0, slider],
        ]
    }

    fn bias_forces(&self, v: &[f64; 3]) -> [f64; 3] {
        let [inner, outer, _] = MASSES;
        let coupling = outer * CRANK * ROD * self.between[0];
        let [crank, rod] = [(inner + outer) * CRANK * self.crank[0], outer * ROD * self.rod[0]];
        [GRAVITY * (crank + rod) - coupling * v[1] * (2.0 * v[0] + v[1]), GRAVITY * rod + coupling * v[0] * v[0], 0.0]
    }

    fn inverse_dynamics(&self, v: &[f64; 3], a: &[f64; 3]) -> [f64; 3] {
        let (matrix, bias) = (self.mass_matrix(), self.bias_forces(v));
        std::array::from_fn(|i| (0..3).map(|j| matrix[i][j] * a[j]).sum::<f64>() + bias[i])
    }

    fn residual(&self) -> [f64; 2] {
        [self.slider - CRANK * self.crank[0] - ROD * self.rod[0], -CRANK * self.crank[1] - ROD * self.rod[1]]
    }

    fn jacobian(&self) -> [[f64; 3]; 2] {
        let [[c1, s1], [c2, s2]] = [self.crank, self.rod];
        [[CRANK * s1 + ROD * s2, ROD * s2, 1.0], [-CRANK * c1 - ROD * c2, -ROD * c2, 0.0]]
    }

    fn bias(&self, v: &[f64; 3]) -> [f64; 2] {
        let [crank, rod] = [v[0] * v[0], (v[0] + v[1]) * (v[0] + v[1])];
        [0, 1].map(|axis| CRANK * self.crank[axis] * crank + ROD * self.rod[axis] * rod)
    }
}

impl ByAngle {
    fn position(q: &[f64; 3]) -> Position {
        Position::new(q[0].cos(), q[0].sin(), q[1], q[2])
    }
}

impl ByCosine {
    fn position(q: &[f64; 4]) -> Position {
        let length = q[0].hypot(q[1]);
        Position::new(q[0] / length, q[1] / length, q[2], q[3])
    }
}

/// The coordinates with cosine and sine.
pub fn by_cosine(q: &[f64; 3]) -> [f64; 4] {
    [q[0].cos(), q[0].sin(), q[1], q[2]]
}

const JOINTS: [&str; 3] = ["crank", "rod", "slider"];

macro_rules! slider_crank {
    ($type:ident, $nq:literal, $coordinates:expr, $($coordinate_of_velocity:item)?) => {
        impl Mechanism for $type {
            fn name(&self) -> &str {
                "slider-crank"
            }
            fn nq(&self) -> usize {
                $nq
            }
            fn nv(&self) -> usize {
                3
            }
            fn nl(&self) -> usize {
                3
            }
            fn link_name(&self, index: usize) -> Option<&str> {
                self.joint_name(index)
            }
            fn joint_name(&self, index: usize) -> Option<&str> {
                JOINTS.get(index).copied()
            }
            fn coordinate_name(&self, index: usize) -> Option<&str> {
                let names: [&str; $nq] = $coordinates;
                names.get(index).copied()
            }
            $($coordinate_of_velocity)?
        }

        impl MassMatrix<f64> for $type {
            fn mass_matrix(&self, q: &[f64; $nq]) -> [[f64; 3]; 3] {
                Self::position(q).mass_matrix()
            }
        }

        impl BiasForces<f64> for $type {
            fn bias_forces(&self, q: &[f64; $nq], v: &[f64; 3]) -> [f64; 3] {
                Self::position(q).bias_forces(v)
            }
        }

        impl InverseDynamics<f64> for $type {
            fn inverse_dynamics(&self, q: &[f64; $nq], v: &[f64; 3], a: &[f64; 3]) -> [f64; 3] {
                Self::position(q).inverse_dynamics(v, a)
            }
        }

        impl LoopRows for $type {
            fn nc(&self) -> usize {
                2
            }
        }

        impl LoopClosure<f64, Self> for $type {
            type Rows = [f64; 2];
            type Jacobian = [[f64; 3]; 2];
            type Gram = [[f64; 2]; 2];

            fn loop_residual(&self, q: &[f64; $nq]) -> [f64; 2] {
                Self::position(q).residual()
            }
            fn loop_jacobian(&self, q: &[f64; $nq]) -> [[f64; 3]; 2] {
                Self::position(q).jacobian()
            }
            fn loop_bias(&self, q: &[f64; $nq], v: &[f64; 3]) -> [f64; 2] {
                Self::position(q).bias(v)
            }
        }
    };
}

slider_crank! { ByAngle, 3, JOINTS, }
slider_crank! {
    ByCosine, 4, ["crank.cos", "crank.sin", "rod", "slider"],
    fn coordinate_of_velocity(&self, index: usize) -> Option<usize> {
        [None, Some(2), Some(3)].get(index).copied().flatten()
    }
}

impl ConfigurationSpace<f64> for ByAngle {
    type Coordinates = [f64; 3];
    type Velocities = [f64; 3];
    type State = [f64; 7];
    type Matrix = [[f64; 3]; 3];
    type Links = [LinkState<f64>; 3];

    fn coordinate_rates(&self, _: &[f64; 3], v: &[f64; 3]) -> [f64; 3] {
        *v
    }
    fn integrate(&self, q: &[f64; 3], dv: &[f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| q[i] + dv[i])
    }
    fn difference(&self, q0: &[f64; 3], q1: &[f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| q1[i] - q0[i])
    }
    fn neutral(&self) -> [f64; 3] {
        [0.0; 3]
    }
}

impl ConfigurationSpace<f64> for ByCosine {
    type Coordinates = [f64; 4];
    type Velocities = [f64; 3];
    type State = [f64; 8];
    type Matrix = [[f64; 3]; 3];
    type Links = [LinkState<f64>; 3];

    fn coordinate_rates(&self, q: &[f64; 4], v: &[f64; 3]) -> [f64; 4] {
        [-q[1] * v[0], q[0] * v[0], v[1], v[2]]
    }
    fn integrate(&self, q: &[f64; 4], dv: &[f64; 3]) -> [f64; 4] {
        let (s, c) = dv[0].sin_cos();
        [q[0] * c - q[1] * s, q[1] * c + q[0] * s, q[2] + dv[1], q[3] + dv[2]]
    }
    fn difference(&self, q0: &[f64; 4], q1: &[f64; 4]) -> [f64; 3] {
        let (along, across) = (q0[0] * q1[0] + q0[1] * q1[1], q0[0] * q1[1] - q0[1] * q1[0]);
        [across.atan2(along), q1[2] - q0[2], q1[3] - q0[3]]
    }
    fn neutral(&self) -> [f64; 4] {
        [1.0, 0.0, 0.0, 0.0]
    }
}
