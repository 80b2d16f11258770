//! Random trees in many styles: ordinary ones, and those in which digits slip.

use super::random::Random;
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use redysim_model::spatial::{Mat3, Pose, Vec3};
use redysim_model::{Inertia, JointKind, Link, Model};

/// What is unusual about a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Style {
    /// Nothing: a few kilogrammes, a few decimetres.
    Ordinary,
    /// Masses from 1e-6 to 1e4 kg.
    SpreadMasses,
    /// Lengths from 1e-3 to 100 m.
    SpreadLengths,
    /// Both.
    SpreadMassesAndLengths,
    /// Axes that are nearly parallel or nearly at right angles, by 1e-15 to 1e-5 rad.
    Tilted,
    /// Arms of up to 100 m and links of up to 10 t, axes tilted by 1e-9 to 1e-5 rad.
    LongAndTilted,
    /// Links that are points of mass.
    PointMasses,
    /// Links that are thin rods along one of their axes.
    Rods,
    /// Ordinary, with one link 1e6 times as heavy.
    HeavyTip,
}

impl Style {
    pub const ALL: [Style; 9] = [
        Style::Ordinary,
        Style::SpreadMasses,
        Style::SpreadLengths,
        Style::SpreadMassesAndLengths,
        Style::Tilted,
        Style::LongAndTilted,
        Style::PointMasses,
        Style::Rods,
        Style::HeavyTip,
    ];

    /// A tree of up to `most` links.
    pub fn model(self, random: &mut Random, most: usize) -> Model {
        let count = 1 + random.below(most);
        let heavy = if self == Style::HeavyTip { random.below(count) } else { usize::MAX };
        let links = random.tree(count, |random, grown, parent| {
            let joint = if random.below(5) == 0 { JointKind::Prismatic } else { JointKind::Revolute };
            let turned = self.rotation(random);
            let length = self.length(random);
            let mut mass = self.mass(random);
            if grown == heavy {
                mass *= 1e6;
            }
            let com = Vec3::from_fn(|_| random.within(0.4 * length));
            let at = Vec3::from_fn(|_| random.within(length));
            let offset = offset(random);
            let inertia = self.inertia(random, mass, length);
            Link { offset, mass, com, inertia, ..link(grown, parent, joint, placed(&turned, at)) }
        });
        Model { links, ..Model::new("random", Vec3::from_fn(|_| random.within(10.0))) }
    }

    fn mass(self, random: &mut Random) -> f64 {
        match self {
            Style::SpreadMasses | Style::SpreadMassesAndLengths => power_of_ten(random, -6.0, 4.0),
            Style::LongAndTilted => power_of_ten(random, 1.0, 4.0),
            _ => 1.5 + random.within(1.0),
        }
    }

    fn length(self, random: &mut Random) -> f64 {
        match self {
            Style::SpreadLengths | Style::SpreadMassesAndLengths => power_of_ten(random, -3.0, 2.0),
            Style::LongAndTilted => power_of_ten(random, 0.0, 2.0),
            _ => 0.5,
        }
    }

    fn rotation(self, random: &mut Random) -> Matrix3<f64> {
        let quarter = |turns: usize| {
            let axis = [Vector3::x_axis(), Vector3::y_axis(), Vector3::z_axis()][turns % 3];
            let angle = std::f64::consts::FRAC_PI_2 * [0.0, 1.0, -1.0, 2.0][turns / 3 % 4];
            Rotation3::from_axis_angle(&axis, angle)
        };
        let any = |random: &mut Random, angle: f64| {
            let axis = Vector3::from_fn(|_, _| random.within(1.0));
            Rotation3::from_axis_angle(&Unit::new_normalize(axis), angle)
        };
        let turned = match self {
            Style::Tilted | Style::LongAndTilted => {
                let least = if self == Style::Tilted { -15.0 } else { -9.0 };
                let tilt = power_of_ten(random, least, -5.0);
                quarter(random.below(12)) * any(random, tilt)
            }
            _ if random.below(3) == 0 => quarter(random.below(12)),
            _ => {
                let angle = random.within(3.0);
                any(random, angle)
            }
        };
        *turned.matrix()
    }

    /// About the centre of mass.
    fn inertia(self, random: &mut Random, mass: f64, length: f64) -> Inertia {
        let size = 0.05 * mass * length * length;
        let mut shares = [0; 3].map(|_| size * (1.0 + random.within(0.9)));
        match self {
            Style::PointMasses => shares = [0.0; 3],
            Style::Rods => {
                let along = random.below(3);
                shares = [0, 1, 2].map(|axis| if axis == along { shares[axis] } else { 0.0 });
            }
            _ => {}
        }
        let axes = if self == Style::Rods { Matrix3::identity() } else { Style::Ordinary.rotation(random) };
        inertia(&axes, shares)
    }
}

/// A number whose logarithm is spread evenly.
fn power_of_ten(random: &mut Random, least: f64, largest: f64) -> f64 {
    10.0_f64.powf(0.5 * (least + largest) + random.within(0.5 * (largest - least)))
}

/// The link `link<number>` without mass, on a joint about or along z.
pub fn link(number: usize, parent: Option<usize>, joint: JointKind, placement: Pose<f64>) -> Link {
    Link { placement, ..Link::new(format!("link{number}"), parent, joint) }
}

/// A frame with the axes `turned`, at `position`.
pub fn placed(turned: &Matrix3<f64>, position: Vec3<f64>) -> Pose<f64> {
    Pose { rotation: Mat3::from_fn(|i, j| turned[(i, j)]), position }
}

/// What is added to a joint variable: nothing in half of the joints.
pub fn offset(random: &mut Random) -> f64 {
    if random.below(2) == 0 { 0.0 } else { random.within(1.0) }
}

/// R diag(b + c, a + c, a + b) Rᵀ, which is a possible inertia for a, b, c that are not negative.
pub fn inertia(axes: &Matrix3<f64>, [a, b, c]: [f64; 3]) -> Inertia {
    let i = axes * Matrix3::from_diagonal(&Vector3::new(b + c, a + c, a + b)) * axes.transpose();
    Inertia { xx: i[(0, 0)], yy: i[(1, 1)], zz: i[(2, 2)], xy: i[(0, 1)], yz: i[(1, 2)], xz: i[(0, 2)] }
}
