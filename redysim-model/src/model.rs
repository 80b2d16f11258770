//! The checked model: what a model file says, with every name resolved and every joint placed in one way.

pub use crate::cut::{CutKind, CutSide, Loop};
use crate::inertia::Sym3;
use crate::joint::physics::JointPhysics;
use crate::joint::{EulerSequence, LinkJoint};
use crate::per_velocity::PerVelocity;
use crate::spatial::{Pose, Vec3};

/// A mechanism whose file passed every check. Links, loops, frames and springs stand in the file's order.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(remote = "Self", deny_unknown_fields))]
pub struct Model {
    /// Name of the mechanism.
    pub name: String,
    /// Acceleration of gravity in the base frame, m/s².
    pub gravity: Vec3<f64>,
    /// The links, in the file's order; parents may stand after their children.
    pub links: Vec<Link>,
    /// The cut joints, in the file's order.
    #[cfg_attr(feature = "serde", serde(default))]
    pub loops: Vec<Loop>,
    /// Frames of interest on links, in the file's order.
    #[cfg_attr(feature = "serde", serde(default))]
    pub frames: Vec<Frame>,
    /// Springs between points, in the file's order.
    #[cfg_attr(feature = "serde", serde(default))]
    pub springs: Vec<Spring>,
}

/// One rigid body and the joint that carries it.
///
/// A joint variable q moves the link's frame to `placement · motion(offset + q) · frame`, where the motion is a rotation
/// about `axis` (revolute), a translation along it (prismatic), both in proportion (helical), or nothing (fixed). The
/// coordinates of a spherical joint are the unit quaternion (x, y, z, w) of the link's axes in the frame at `placement`,
/// those of a free joint the position of the link's origin in it, m, and then that quaternion.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Link {
    /// Name of the link.
    pub name: String,
    /// Name of its joint; the link's own name unless the file gives one.
    pub joint_name: String,
    /// Index of the parent in [`Model::links`]; `None` is the ground.
    pub parent: Option<usize>,
    /// What the joint lets the link do.
    pub joint: JointKind,
    /// The frame that the joint moves, in the parent's where the joint's motion is zero. The joint axis passes through
    /// its origin.
    pub placement: Pose<f64>,
    /// Unit vector of the joint axis, in the frame that the joint moves; z for a joint without one.
    pub axis: Vec3<f64>,
    /// The link's frame in the one that the joint moves: the identity, or the Tx(a) Rx(alpha) of standard
    /// Denavit-Hartenberg parameters, which have a link's frame at its far end.
    pub frame: Pose<f64>,
    /// What is added to the joint variable: rad, or m (prismatic).
    pub offset: f64,
    /// Translation along the axis for a unit of rotation, m/rad, of a helical joint; zero for others.
    pub pitch: f64,
    /// The Euler angles that are the coordinates of a spherical or free joint; `None` for a quaternion.
    #[cfg_attr(feature = "serde", serde(default))]
    pub coordinates: Option<EulerSequence>,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass from the link's frame, in it, m.
    pub com: Vec3<f64>,
    /// Inertia about the centre of mass, in the link's axes.
    pub inertia: Inertia,
    /// What acts in the joint itself.
    pub physics: JointPhysics,
    /// The joint that this one mimics; `None` for a joint with coordinates of its own.
    #[cfg_attr(feature = "serde", serde(default))]
    pub mimic: Option<Mimic>,
    /// Which of the joint's velocities have an actuator.
    pub actuated: PerVelocity<bool>,
    /// Within what the joint moves, for each of its velocities; empty if the file does not give it.
    #[cfg_attr(feature = "serde", serde(default, deserialize_with = "crate::serde::ranges"))]
    pub range: Vec<JointRange>,
}

/// How a joint follows another, as the fingers of a gripper do: its coordinate is `multiplier` q + `offset`, where q is
/// the coordinate of the joint that it mimics. Its forces act on that joint, times the multiplier.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Mimic {
    /// Index in [`Model::links`] of the link whose joint is mimicked.
    pub link: usize,
    /// What the coordinate of that joint is multiplied by: a number, or m/rad or rad/m if one of the two turns and the other
    /// slides.
    pub multiplier: f64,
    /// What is added, rad or m.
    pub offset: f64,
}

impl Mimic {
    /// What a joint that mimics another so follows, if that one mimics a third by `next`.
    fn after(self, next: Mimic) -> Mimic {
        Mimic {
            link: next.link,
            multiplier: self.multiplier * next.multiplier,
            offset: self.multiplier * next.offset + self.offset,
        }
    }
}

/// Within what a joint moves by one of its velocities: rad or m, and their rates. It limits nothing, but determines for which
/// states a pruned function is made. The position of a joint with a quaternion is a displacement from its zero position, by
/// [`ConfigurationSpace::integrate`](redysim_runtime::ConfigurationSpace::integrate).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct JointRange {
    /// The least and the largest coordinate.
    pub position: [f64; 2],
    /// The largest speed in either direction.
    pub velocity: f64,
    /// The largest acceleration in either direction; not every file gives it, but a tolerance needs it.
    pub acceleration: Option<f64>,
    /// The force of which a tolerance is a share, N m or N; `None` for the largest that occurs within these ranges.
    pub force: Option<f64>,
}

/// The kinds of joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum JointKind {
    /// Rotation about the axis.
    Revolute,
    /// Translation along the axis.
    Prismatic,
    /// Rotation about the axis with a translation along it in proportion, as a screw moves.
    Helical,
    /// A rotation about x of the joint's frame, then one about y of the frame turned so.
    Universal,
    /// Translation along the axis, and rotation about it.
    Cylindrical,
    /// Translations along x and y of the joint's frame, then rotation about z.
    Planar,
    /// Rotation about any axis through the joint's origin.
    Spherical,
    /// Any motion.
    Free,
    /// No motion: the link is part of its parent.
    Fixed,
}

impl JointKind {
    /// Every kind with its name in a model file.
    pub const ALL: [(&'static str, JointKind); 9] = [
        (JointKind::Revolute.name(), JointKind::Revolute),
        (JointKind::Prismatic.name(), JointKind::Prismatic),
        (JointKind::Helical.name(), JointKind::Helical),
        (JointKind::Universal.name(), JointKind::Universal),
        (JointKind::Cylindrical.name(), JointKind::Cylindrical),
        (JointKind::Planar.name(), JointKind::Planar),
        (JointKind::Spherical.name(), JointKind::Spherical),
        (JointKind::Free.name(), JointKind::Free),
        (JointKind::Fixed.name(), JointKind::Fixed),
    ];

    /// Its name in a model file.
    pub const fn name(self) -> &'static str {
        match self {
            JointKind::Revolute => "revolute",
            JointKind::Prismatic => "prismatic",
            JointKind::Helical => "helical",
            JointKind::Universal => "universal",
            JointKind::Cylindrical => "cylindrical",
            JointKind::Planar => "planar",
            JointKind::Spherical => "spherical",
            JointKind::Free => "free",
            JointKind::Fixed => "fixed",
        }
    }

    /// Number of joint velocities.
    pub fn dof(self) -> usize {
        LinkJoint::of_kind(self, 0.0, None).map_or(0, LinkJoint::nv)
    }

    /// Whether it has an axis, about or along which its link moves.
    pub fn has_axis(self) -> bool {
        match self {
            JointKind::Revolute | JointKind::Prismatic | JointKind::Helical | JointKind::Cylindrical => true,
            JointKind::Universal | JointKind::Planar | JointKind::Spherical | JointKind::Free | JointKind::Fixed => {
                false
            }
        }
    }

    /// Whether it turns its link about every axis: its coordinates have an orientation.
    pub fn moves_in_space(self) -> bool {
        matches!(self, JointKind::Spherical | JointKind::Free)
    }

    /// Whether its coordinate is an angle, rad, and its force a moment, N m.
    pub fn turns(self) -> bool {
        matches!(self, JointKind::Revolute | JointKind::Helical)
    }
}

/// A symmetric inertia tensor, kg m².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Inertia {
    /// Moment about x.
    pub xx: f64,
    /// Moment about y.
    pub yy: f64,
    /// Moment about z.
    pub zz: f64,
    /// Element xy of the tensor (the negative of ∫xy dm).
    pub xy: f64,
    /// Element yz of the tensor.
    pub yz: f64,
    /// Element xz of the tensor.
    pub xz: f64,
}

impl From<Inertia> for Sym3<f64> {
    fn from(Inertia { xx, yy, zz, xy, yz, xz }: Inertia) -> Self {
        Sym3 { xx, yy, zz, xy, yz, xz }
    }
}

/// A frame of interest on a link, such as that of a tool or a foot: a table `[[frame]]`.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Frame {
    /// Name of the frame.
    pub name: String,
    /// Index of the link on which it stands in [`Model::links`]; `None` is the ground.
    pub link: Option<usize>,
    /// The frame in the link's.
    pub placement: Pose<f64>,
}

/// A spring with a damper between two points: a table `[[spring]]`.
///
/// It pulls its ends together with the force k (ℓ − ℓ₀) + c ℓ̇ along the line between them, where ℓ is their distance.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Spring {
    /// Name of the spring, if the file gives one.
    pub name: Option<String>,
    /// One end.
    pub a: LinkPoint,
    /// The other end.
    pub b: LinkPoint,
    /// Stiffness k, N/m.
    pub stiffness: f64,
    /// Viscous damping c, N s/m.
    pub damping: f64,
    /// Free length ℓ₀, at which the spring is relaxed, m.
    pub length: f64,
}

/// A point on a link.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct LinkPoint {
    /// Index of the link in [`Model::links`]; `None` is the ground.
    pub link: Option<usize>,
    /// The point, in the link's frame, m.
    pub point: Vec3<f64>,
}

impl Link {
    /// A link without mass, whose joint stands in the parent's frame and moves about or along z.
    pub fn new(name: impl Into<String>, parent: Option<usize>, joint: JointKind) -> Self {
        let name = name.into();
        Link {
            joint_name: name.clone(),
            name,
            parent,
            joint,
            placement: Pose::identity(),
            axis: Vec3([0.0, 0.0, 1.0]),
            frame: Pose::identity(),
            offset: 0.0,
            pitch: 0.0,
            coordinates: None,
            mass: 0.0,
            com: Vec3::zero(),
            inertia: Inertia::default(),
            physics: JointPhysics::default(),
            mimic: None,
            actuated: true.into(),
            range: Vec::new(),
        }
    }
}

impl Link {
    /// Whether each velocity of its joint has an actuator.
    pub fn actuated_velocities(&self) -> Vec<bool> {
        self.actuated.of_velocities(self.joint.dof(), true)
    }

    /// Number of velocities that its joint adds to the mechanism: those of the joint, but none if it mimics another.
    pub fn dof(&self) -> usize {
        if self.mimic.is_some() { 0 } else { self.joint.dof() }
    }
}

impl Model {
    /// A model without links, to which they are added; [`check`](Self::check) checks it by the rules for files.
    pub fn new(name: impl Into<String>, gravity: Vec3<f64>) -> Self {
        let (links, loops, frames, springs) = (vec![], vec![], vec![], vec![]);
        Model { name: name.into(), gravity, links, loops, frames, springs }
    }

    /// Number of velocities, NV: the sum of the freedoms of joints that do not mimic others.
    pub fn dof(&self) -> usize {
        self.links.iter().map(Link::dof).sum()
    }

    /// Whether some joints have an actuator and some do not, and there are no loops.
    pub(crate) fn has_passive_joints(&self) -> bool {
        let actuated = self.moving_links().flat_map(Link::actuated_velocities);
        self.loops.is_empty() && (1..self.dof()).contains(&actuated.filter(|actuated| *actuated).count())
    }

    /// Mass of all links, kg.
    pub fn mass(&self) -> f64 {
        self.links.iter().map(|link| link.mass).sum()
    }

    /// The joint that moves that of a link in the end, and how: itself, times 1, unless it mimics another. The model is
    /// checked, and `link` an index in it.
    pub fn followed(&self, link: usize) -> Mimic {
        let mut followed = Mimic { link, multiplier: 1.0, offset: 0.0 };
        while let Some(next) = self.links[followed.link].mimic {
            followed = followed.after(next);
        }
        followed
    }

    /// The links whose joints have coordinates of their own, in the file's order: not those that are fixed or mimic another.
    pub fn moving_links(&self) -> impl Iterator<Item = &Link> {
        self.links.iter().filter(|link| link.dof() > 0)
    }
}
