//! The tree of moving bodies: the model as the recursions want it.
//!
//! Links joined rigidly become one body, parents stand before their children, and each body's frame is turned so that
//! its joint axis is z. All of this happens in numbers, before any recursion runs, so it costs the recursions nothing.

use crate::joint::{BodyPhysics, Joint};
use crate::model::CutKind;
use crate::pseudo::PseudoInertia;
use crate::spatial::{Mat3, Pose, Vec3};
use crate::spring::BodySpring;
use redysim_runtime::Scalar;
use redysim_runtime::function::{Argument, Dimension};
use std::ops::Range;

/// Moving bodies, parents first, and where the model's links stand on them.
#[derive(Clone, Debug, PartialEq)]
pub struct Tree<P = f64> {
    /// Acceleration of gravity in the base frame, m/s².
    pub gravity: Vec3<P>,
    /// Everything that does not move, about the base frame.
    pub ground: PseudoInertia<P>,
    /// The moving bodies; each parent has a smaller index.
    pub bodies: Vec<Body<P>>,
    /// Where each of [`Model::links`](crate::model::Model::links) stands, in the model's order.
    pub links: Vec<Attachment<P>>,
    /// The cut joints, in the model's order.
    pub cuts: Vec<Cut>,
    /// Where each of [`Model::frames`](crate::model::Model::frames) stands, in the model's order.
    pub frames: Vec<BodyFrame>,
    /// The springs between points that act, in the model's order.
    pub springs: Vec<BodySpring<P>>,
    /// The joints that mimic others. Their coordinates stand after the mechanism's NQ in [`Body::q`], their velocities after
    /// its NV in [`Body::v`], in this order.
    pub mimics: Vec<Mimic>,
}

/// How a joint follows another: its coordinate is `multiplier` q + `offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mimic {
    /// The coordinate of the joint that it mimics, in the model's order.
    pub q: usize,
    /// The velocity of that joint.
    pub v: usize,
    /// What that joint's coordinate is multiplied by.
    pub multiplier: f64,
    /// What is added, rad or m.
    pub offset: f64,
}

impl Mimic {
    /// Its coordinate at the mechanism's coordinates `q`.
    pub(crate) fn coordinate_at<S: Scalar>(&self, q: &[S]) -> S {
        let rate = S::from_f64(self.multiplier) * q[self.q];
        if self.offset == 0.0 { rate } else { rate + S::from_f64(self.offset) }
    }

    /// Its velocity at the mechanism's velocities `v`, or its acceleration likewise.
    pub(crate) fn rate_at<S: Scalar>(&self, v: &[S]) -> S {
        S::from_f64(self.multiplier) * v[self.v]
    }
}

/// A moving body with its joint: about or along its z axis, or in space.
#[derive(Clone, Debug, PartialEq)]
pub struct Body<P = f64> {
    /// The parent's index in [`Tree::bodies`]; `None` is the ground.
    pub parent: Option<usize>,
    /// The body's frame in its parent's where `q + offset` is zero.
    pub placement: Pose<f64>,
    /// What the joint does.
    pub joint: Joint,
    /// The link that the joint moves, in [`Tree::links`]. The joint of a link may be several joints in series, each of a body
    /// of its own: the last has the link's mass.
    pub link: usize,
    /// What is added to the joint variable, rad.
    pub offset: f64,
    /// Whether the body's quantities are computed in axes that do not rotate with its joint: those of the parent, after
    /// the fixed rotation. The body then rotates against its axes, and the angle of a child with a parallel axis is
    /// merged with that of this joint: their sum.
    pub merged_parallel: bool,
    /// The joint's coordinates in the model's order.
    pub q: Range<usize>,
    /// The joint's velocities and forces in the model's order.
    pub v: Range<usize>,
    /// Moments of its mass about the origin of its frame.
    pub inertia: PseudoInertia<P>,
    /// What acts in the joint itself; `None` if nothing does.
    pub physics: Option<BodyPhysics<P>>,
    /// Whether each velocity of the joint has an actuator.
    pub actuated: Vec<bool>,
}

impl<P> Body<P> {
    /// Whether the joint has one axis, and this is parallel to the z axis of the parent's frame.
    #[inline]
    pub fn is_parallel(&self) -> bool {
        if !self.joint.is_on_axis() {
            return false;
        }
        // The cosine of a tilt of 1e-8 is 1 already.
        let [x, y, _] = self.placement.rotation.column(2).0;
        x == 0.0 && y == 0.0
    }

    /// An angle or a rate about the z axis of the parent's frame as one about the joint's axis, if these are parallel:
    /// the negative where they point in opposite directions.
    #[inline]
    pub(crate) fn about_parallel_axis<S: Scalar>(&self, turn: S) -> S {
        if self.placement.rotation.0[2][2] < 0.0 { -turn } else { turn }
    }
}

/// Where a link stands on a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Attachment<P = f64> {
    /// The body in [`Tree::bodies`]; `None` is the ground.
    pub body: Option<usize>,
    /// The link's frame in the body's.
    pub pose: Pose<f64>,
    /// Centre of mass in the link's frame, m.
    pub com: Vec3<P>,
}

/// Where a frame stands on a body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyFrame {
    /// The body in [`Tree::bodies`]; `None` is the ground.
    pub body: Option<usize>,
    /// The frame in the body's.
    pub pose: Pose<f64>,
}

/// A cut joint between two bodies.
#[derive(Clone, Debug, PartialEq)]
pub struct Cut {
    /// What the cut joint holds together.
    pub joint: CutKind,
    /// Side a.
    pub a: CutEnd,
    /// Side b.
    pub b: CutEnd,
    /// Which of its [rows](CutKind::rows) are kept. The others vanish at every position.
    pub rows: Vec<bool>,
}

/// One side of a cut joint.
#[derive(Clone, Debug, PartialEq)]
pub struct CutEnd {
    /// The body in [`Tree::bodies`]; `None` is the ground.
    pub body: Option<usize>,
    /// The point, in the body's frame, m.
    pub point: Vec3<f64>,
    /// What is to be aligned with the other side, as columns in the body's frame ([`Loop::axes`](crate::model::Loop::axes)).
    pub axes: Mat3<f64>,
}

impl<P> Tree<P> {
    /// Number of coordinates, NQ.
    #[inline]
    pub fn nq(&self) -> usize {
        self.bodies.iter().map(|body| body.q.len()).sum::<usize>() - self.mimics.len()
    }

    /// Number of velocities, NV.
    #[inline]
    pub fn nv(&self) -> usize {
        self.nv_of_all() - self.mimics.len()
    }

    /// Number of velocities of all joints: NV, and one for each joint that mimics another.
    #[inline]
    pub fn nv_of_all(&self) -> usize {
        self.bodies.iter().map(|body| body.v.len()).sum()
    }

    /// The velocity of the mechanism that determines a velocity of all joints: itself, or the one that is mimicked.
    pub(crate) fn own_velocity(&self, velocity: usize) -> usize {
        velocity.checked_sub(self.nv()).map_or(velocity, |index| self.mimics[index].v)
    }

    /// Whether joints mimic that of a velocity.
    pub(crate) fn is_mimicked(&self, velocity: usize) -> bool {
        self.mimics.iter().any(|mimic| mimic.v == velocity)
    }

    /// The bodies whose joints have coordinates and velocities of their own: those that do not mimic another.
    pub fn independent_bodies(&self) -> impl Iterator<Item = &Body<P>> {
        let nv = self.nv();
        self.bodies.iter().filter(move |body| body.v.start < nv)
    }

    /// Whether some velocities have an actuator and some do not, and there are no loops: then it has
    /// [hybrid dynamics](crate::denoc::hybrid_dynamics).
    pub fn has_passive_joints(&self) -> bool {
        let actuated = self.actuated().into_iter().filter(|actuated| *actuated).count();
        self.cuts.is_empty() && (1..self.nv()).contains(&actuated)
    }

    /// Whether each velocity has an actuator.
    pub fn actuated(&self) -> Vec<bool> {
        let mut actuated = vec![false; self.nv()];
        self.independent_bodies().for_each(|body| actuated[body.v.clone()].copy_from_slice(&body.actuated));
        actuated
    }

    /// For each row of the loops, the index of its cut; NC of them.
    pub fn loops_of_rows(&self) -> impl Iterator<Item = usize> {
        self.cuts.iter().enumerate().flat_map(|(index, cut)| cut.rows.iter().filter(|kept| **kept).map(move |_| index))
    }

    /// The tree with `f` applied to gravity, to each inertial parameter, to the physics of each joint and to each spring.
    pub fn map<Q>(&self, f: impl Fn(P) -> Q) -> Tree<Q>
    where
        P: Scalar,
    {
        let body = |body: &Body<P>| Body {
            parent: body.parent,
            placement: body.placement,
            joint: body.joint,
            link: body.link,
            offset: body.offset,
            merged_parallel: body.merged_parallel,
            q: body.q.clone(),
            v: body.v.clone(),
            inertia: body.inertia.map(&f),
            physics: body.physics.as_ref().map(|physics| physics.map(&f)),
            actuated: body.actuated.clone(),
        };
        let link = |link: &Attachment<P>| Attachment { body: link.body, pose: link.pose, com: link.com.map(&f) };
        Tree {
            gravity: self.gravity.map(&f),
            ground: self.ground.map(&f),
            bodies: self.bodies.iter().map(body).collect(),
            links: self.links.iter().map(link).collect(),
            cuts: self.cuts.clone(),
            frames: self.frames.clone(),
            springs: self.springs.iter().map(|spring| spring.map(&f)).collect(),
            mimics: self.mimics.clone(),
        }
    }

    /// The bodies from the ground outwards: parents before their children.
    #[inline]
    pub fn outward(&self) -> std::ops::Range<usize> {
        0..self.bodies.len()
    }

    /// The bodies from the tips inwards: children before their parents.
    #[inline]
    pub fn inward(&self) -> std::iter::Rev<std::ops::Range<usize>> {
        self.outward().rev()
    }

    /// The bodies whose parent is `body`.
    pub fn children(&self, body: usize) -> impl Iterator<Item = usize> {
        let later = self.bodies.iter().enumerate().skip(body + 1);
        later.filter(move |(_, child)| child.parent == Some(body)).map(|(index, _)| index)
    }

    /// The largest number of joints between the ground and a body.
    pub fn depth(&self) -> usize {
        let mut depths = vec![0; self.bodies.len()];
        for (index, body) in self.bodies.iter().enumerate() {
            depths[index] = body.parent.map_or(0, |parent| depths[parent]) + 1;
        }
        depths.into_iter().max().unwrap_or(0)
    }

    /// Coordinates spread over ±3 by a fixed rule, the same for every `position`: what holds at a few of them holds,
    /// but for freak coincidences, at all.
    pub fn sample(&self, position: usize) -> Vec<f64> {
        let golden = 0.618_033_988_749_895;
        let nq = self.nq();
        (0..nq).map(|k| (golden * (position * nq + k + 1) as f64).fract() * 6.0 - 3.0).collect()
    }

    /// The number of numbers that an argument of a function has.
    pub fn argument_length(&self, argument: Argument) -> usize {
        self.size(argument.dimension()) * argument.numbers()
    }

    /// The number of elements that a vector of this dimension has.
    pub fn size(&self, dimension: Dimension) -> usize {
        match dimension {
            Dimension::Coordinates => self.nq(),
            Dimension::Velocities => self.nv(),
            Dimension::Links => self.links.len(),
            Dimension::LoopRows => self.loops_of_rows().count(),
            Dimension::Frames => self.frames.len(),
        }
    }

    /// For each velocity, the link that its joint moves, in [`Tree::links`].
    pub fn links_of_velocities(&self) -> Vec<usize> {
        let mut links = vec![0; self.nv()];
        for body in self.independent_bodies() {
            links[body.v.clone()].fill(body.link);
        }
        links
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::model::Model;

    /// An upper arm on the ground and a forearm on it. The forearm is first in the file, so that its joint has the
    /// first coordinate and the first velocity.
    pub fn arm() -> Tree {
        let text = "name = 'arm'\ngravity = [0, 0, -9.81]\n\n\
            [[link]]\nname = 'fore'\nparent = 'upper'\njoint = 'revolute'\norigin = { xyz = [1, 0, 0] }\n\
            axis = [0, 1, 0]\nmass = 1.0\ncom = [0.5, 0, 0]\n\n\
            [[link]]\nname = 'upper'\nparent = 'base'\njoint = 'revolute'\naxis = [0, 1, 0]\nmass = 2.0\n\
            com = [0.5, 0, 0]\n";
        let arm = Model::from_toml(text, "arm.toml").unwrap_or_else(|faults| panic!("{faults}"));
        Tree::new(&arm.model)
    }

    #[test]
    fn each_velocity_has_the_link_that_its_joint_moves() {
        let mut tree = arm();
        let [upper, fore] = &mut tree.bodies[..] else { panic!("two bodies") };
        (fore.v, upper.v) = (0..3, 3..5);
        let names = ["fore", "upper"];
        let names: Vec<&str> = tree.links_of_velocities().into_iter().map(|link| names[link]).collect();
        assert_eq!(names, ["fore", "fore", "fore", "upper", "upper"]);
    }
}
