//! The inertia of a rigid body as moments of its mass: ∫1, ∫r and ∫r rᵀ.
//!
//! With Σ = ∫ r rᵀ dm instead of the inertia tensor J = tr(Σ) 1 − Σ, the force and the moment that a motion takes are
//! f = m a + U h and n = the axial vector of U Σ, where U = ω̇× + (ω×)² takes the points of the body to their
//! accelerations against the origin; and mass on an axis is three of the ten numbers (Balafoutis & Patel, *Dynamic
//! Analysis of Robot Manipulators*, Kluwer 1991; Wensing, Kim, Slotine, "Linear matrix inequalities for physically
//! consistent inertial parameter identification", IEEE Robotics and Automation Letters 3(1), 2018).

use crate::inertia::{RigidInertia, Sym3};
use crate::parameter::Parameter;
use crate::spatial::{Mat3, Pose, Vec3};
use redysim_runtime::Scalar;
use std::ops::Add;

/// Mass, first and second moments of a rigid body about the origin of a frame, in its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PseudoInertia<S> {
    /// Mass ∫ dm, kg.
    pub mass: S,
    /// First moment ∫ r dm, kg m.
    pub moment: Vec3<S>,
    /// Second moment Σ = ∫ r rᵀ dm, kg m².
    pub second: Sym3<S>,
}

impl<P: Parameter> PseudoInertia<P> {
    /// The body of the given mass, centre of mass, and inertia tensor J about it: Σ = ½ tr(J) 1 − J + m c cᵀ.
    pub fn from_central(mass: P, com: Vec3<P>, central: Sym3<P>) -> Self {
        let j = central;
        // Halves of sums of three: a difference below their roundoff counts as zero.
        let known = [j.xx, j.yy, j.zz].into_iter().filter_map(Parameter::number);
        let size = 4.0 * f64::EPSILON * known.fold(0.0_f64, |largest, x| largest.max(x.abs()));
        let half = |sum: P| match sum.number() {
            Some(number) if number.abs() < size => P::zero(),
            _ => P::from_f64(0.5) * sum,
        };
        let own = Sym3 {
            xx: half(j.yy + j.zz - j.xx),
            yy: half(j.zz + j.xx - j.yy),
            zz: half(j.xx + j.yy - j.zz),
            xy: -j.xy,
            yz: -j.yz,
            xz: -j.xz,
        };
        let moment = com.scale(mass);
        PseudoInertia { mass, moment, second: own + Sym3::from_upper(|i, j| moment[i] * com[j]) }
    }
}

impl<S: Scalar> PseudoInertia<S> {
    /// Nothing.
    pub fn zero() -> Self {
        PseudoInertia { mass: S::zero(), moment: Vec3::zero(), second: Sym3::zero() }
    }

    /// The same with the inertia tensor J = tr(Σ) 1 − Σ.
    pub fn to_rigid(self) -> RigidInertia<S> {
        let s = self.second;
        let tensor = Sym3 { xx: s.yy + s.zz, yy: s.zz + s.xx, zz: s.xx + s.yy, xy: -s.xy, yz: -s.yz, xz: -s.xz };
        RigidInertia { mass: self.mass, moment: self.moment, tensor }
    }

    /// Applies `f` to each number.
    #[inline]
    pub fn map<T>(self, f: impl Fn(S) -> T) -> PseudoInertia<T> {
        PseudoInertia { mass: f(self.mass), moment: self.moment.map(&f), second: self.second.map(f) }
    }

    /// The ten numbers, where all are known before run time.
    pub fn number(self) -> Option<PseudoInertia<f64>>
    where
        S: Parameter,
    {
        let PseudoInertia { mass, moment: Vec3([x, y, z]), second } = self;
        let Sym3 { xx, yy, zz, xy, yz, xz } = second;
        let known = [mass, x, y, z, xx, yy, zz, xy, yz, xz].iter().all(|value| value.number().is_some());
        known.then(|| self.map(|value| value.number().unwrap_or(f64::NAN)))
    }

    /// The same body about the origin of the reference, where `p` is the origin of its frame (of equal axes):
    /// h' = h + m p, Σ' = Σ + h pᵀ + p h'ᵀ.
    #[inline(always)]
    pub fn translated(self, p: Vec3<S>) -> Self {
        let moment = self.moment + p.scale(self.mass);
        let steiner = Sym3::from_upper(|i, j| {
            if i == j { p[i] * (self.moment[i] + moment[i]) } else { self.moment[i] * p[j] + p[i] * moment[j] }
        });
        PseudoInertia { mass: self.mass, moment, second: self.second + steiner }
    }

    /// The same body seen from the frame in which its own frame stands at `pose`.
    pub fn transformed(self, pose: Pose<S>) -> Self {
        self.rotated(pose.rotation).translated(pose.position)
    }

    /// The body after the rotation.
    pub fn rotated(self, rotation: Mat3<S>) -> Self {
        PseudoInertia { mass: self.mass, moment: rotation * self.moment, second: self.second.rotated(rotation) }
    }
}

impl<S: Scalar> Add for PseudoInertia<S> {
    type Output = Self;
    fn add(self, b: Self) -> Self {
        PseudoInertia { mass: self.mass + b.mass, moment: self.moment + b.moment, second: self.second + b.second }
    }
}
