//! Mass, centre of mass and inertia of a link, in its own frame.

use redysim_model::inertia::Sym3;
use redysim_model::spatial::{Pose, Vec3};

/// An inertia of so many kg m² for a kg (a radius of gyration of 10 nm) is roundoff.
const NOISE: f64 = 1e-16;

/// A rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertial {
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass in the link's frame, m.
    pub com: Vec3<f64>,
    /// Inertia about the centre of mass in the link's axes, kg m².
    pub inertia: Sym3<f64>,
}

impl Inertial {
    /// No mass.
    pub fn none() -> Self {
        Inertial { mass: 0.0, com: Vec3::zero(), inertia: Sym3::zero() }
    }

    /// Without an inertia that is nothing but the roundoff of the program that wrote it, and whether there was one.
    /// Left in, its elements would not fit each other, and the inertia be none of a body.
    pub fn without_noise(self) -> (Self, bool) {
        let Sym3 { xx, yy, zz, xy, yz, xz } = self.inertia;
        let largest = [xx, yy, zz, xy, yz, xz].into_iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let noise = 0.0 < largest && largest < NOISE * self.mass;
        (Inertial { inertia: if noise { Sym3::zero() } else { self.inertia }, ..self }, noise)
    }

    /// Whether there is anything that resists motion.
    pub fn is_none(&self) -> bool {
        self.mass == 0.0 && self.inertia == Sym3::zero()
    }

    /// The same body seen from the frame in which its own stands at `pose`.
    pub fn seen_from(self, pose: Pose<f64>) -> Self {
        Inertial { mass: self.mass, com: pose.transform(self.com), inertia: self.inertia.rotated(pose.rotation) }
    }

    /// Two bodies as one, each inertia carried to the common centre of mass (Steiner).
    pub fn and(self, other: Inertial) -> Self {
        let mass = self.mass + other.mass;
        let com = match mass {
            0.0 => Vec3::zero(),
            _ => (self.com.scale(self.mass) + other.com.scale(other.mass)).scale(1.0 / mass),
        };
        Inertial { mass, com, inertia: self.about(com) + other.about(com) }
    }

    fn about(self, point: Vec3<f64>) -> Sym3<f64> {
        let d = self.com - point;
        let square = d.dot(d);
        self.inertia + Sym3::from_upper(|i, j| self.mass * (if i == j { square } else { 0.0 } - d[i] * d[j]))
    }
}
