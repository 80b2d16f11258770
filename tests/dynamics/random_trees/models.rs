//! Random trees of bodies of a few kilogrammes and decimetres.

use super::state_in_space;
use crate::common::kane::kane;
use crate::common::random::Random;
use crate::common::styles::{inertia, link, offset, placed};
use nalgebra::{Matrix3, Rotation3, Unit, Vector3};
use redysim_model::joint::{EulerSequence, JointPhysics, LinkJoint};
use redysim_model::spatial::{Pose, Vec3};
use redysim_model::{Frame, Inertia, JointKind, Link, LinkPoint, Mimic, Model, PerVelocity, Spring};

fn rotation(random: &mut Random) -> Matrix3<f64> {
    // A third of all rotations are quarter turns, as in most machines.
    let angle = if random.below(3) == 0 { std::f64::consts::FRAC_PI_2 } else { random.within(3.0) };
    *Rotation3::from_axis_angle(&Unit::new_normalize(axis(random)), angle).matrix()
}

fn axis(random: &mut Random) -> Vector3<f64> {
    match random.below(4) {
        0 => Vector3::z(),
        1 => [Vector3::x(), Vector3::y(), -Vector3::x(), -Vector3::y()][random.below(4)],
        _ => Vector3::from_fn(|_, _| random.within(1.0)).normalize(),
    }
}

/// The kinds of joint that are several joints in series, if spherical and free ones have Euler angles.
const SERIES: [JointKind; 5] =
    [JointKind::Universal, JointKind::Cylindrical, JointKind::Planar, JointKind::Spherical, JointKind::Free];

/// Which joints a tree has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Joints {
    /// With one degree of freedom: revolute, prismatic, helical; and fixed ones.
    OfOneFreedom,
    /// These, spherical and free ones with quaternions.
    InSpace,
    /// These, universal, cylindrical and planar ones, and spherical and free ones with Euler angles.
    InSeries,
}

/// A tree of up to twelve links, with three frames of interest. `with_physics` are its joints,
/// `with_springs` the tree between points.
pub fn random_model(random: &mut Random, joints: Joints, with_physics: bool, with_springs: bool) -> Model {
    let mut model = bare_model(random, joints);
    if with_physics {
        for link in model.links.iter_mut() {
            if let Some(joint) = LinkJoint::of(link) {
                link.physics = joint_physics(random, joint);
            }
        }
    }
    if with_springs {
        model.springs = (0..3).map(|_| spring(random, &model)).collect();
    }
    model.frames = (0..3).map(|index| frame(random, &model, index)).collect();
    model
}

/// A tree of up to twelve links with nothing in its joints.
fn bare_model(random: &mut Random, joints: Joints) -> Model {
    let count = 1 + random.below(12);
    // One at least has several degrees of freedom; others are as often as any kind.
    let (chosen, kinds) = match joints {
        Joints::OfOneFreedom => (None, 5),
        Joints::InSpace => (Some(random.below(count)), 7),
        Joints::InSeries => (Some(random.below(count)), 12),
    };
    let links = random.tree(count, |random, grown, parent| {
        let joint = match random.below(kinds) {
            kind if joints == Joints::InSeries && (kind > 6 || chosen == Some(grown)) => SERIES[kind % 5],
            kind if kind > 4 || chosen == Some(grown) => [JointKind::Spherical, JointKind::Free][kind % 2],
            0 if grown > 0 => JointKind::Fixed,
            1 => JointKind::Prismatic,
            2 if grown % 3 != 1 => JointKind::Helical,
            _ => JointKind::Revolute,
        };
        let turned = rotation(random);
        let at = Vec3::from_fn(|_| random.within(0.5));
        let frame = if random.below(2) == 0 {
            Pose::identity()
        } else {
            placed(&rotation(random), Vec3::from_fn(|_| random.within(0.3)))
        };
        // A body of a few kilogrammes and decimetres.
        let body = Link {
            axis: Vec3(axis(random).into()),
            frame,
            offset: offset(random),
            pitch: if joint == JointKind::Helical { 0.4 - 0.1 * grown as f64 } else { 0.0 },
            mass: 1.5 + random.within(1.0),
            com: Vec3::from_fn(|_| random.within(0.2)),
            inertia: {
                let shares = [0; 3].map(|_| 0.01 + random.within(0.009));
                inertia(&rotation(random), shares)
            },
            ..link(grown, parent, joint, placed(&turned, at))
        };
        let coordinates = match joint {
            JointKind::Spherical | JointKind::Free if joints == Joints::InSeries && random.below(3) > 0 => {
                Some(EulerSequence::ALL[random.below(12)].1)
            }
            _ => None,
        };
        let body = Link { coordinates, ..body };
        let z = Vec3([0.0, 0.0, 1.0]);
        // Joints with several degrees of freedom have no offset; spherical and free ones neither an axis nor a frame beyond.
        match joint {
            JointKind::Cylindrical => Link { offset: 0.0, ..body },
            JointKind::Universal | JointKind::Planar => Link { axis: z, offset: 0.0, ..body },
            JointKind::Spherical | JointKind::Free => Link { axis: z, frame: Pose::identity(), offset: 0.0, ..body },
            _ => body,
        }
    });
    Model { links, ..Model::new("random", Vec3::from_fn(|_| random.within(10.0))) }
}

/// Makes about half of the joints with one degree of freedom mimic others, some of which mimic others themselves.
pub fn mimic_some(random: &mut Random, model: &mut Model) {
    let of_one = |link: &Link| link.joint.dof() == 1;
    let mut joints: Vec<usize> = (0..model.links.len()).filter(|&link| of_one(&model.links[link])).collect();
    // A joint mimics one that is before it in a random order.
    for last in (1..joints.len()).rev() {
        joints.swap(last, random.below(last + 1));
    }
    for position in 1..joints.len() {
        if random.below(2) == 0 {
            let link = joints[random.below(position)];
            let multiplier = [1.0, -1.0, 0.5, -2.0, random.within(1.5)][random.below(5)];
            model.links[joints[position]].mimic = Some(Mimic { link, multiplier, offset: offset(random) });
        }
    }
}

/// Takes mass and inertia from half of the links whose joints mimic others or are mimicked, wherever the mass matrix of the
/// mechanism stays regular by Kane's equations: their joints move none by themselves, or none that they do not share.
pub fn empty_some(random: &mut Random, model: &mut Model) {
    let is_mimicked = |model: &Model, link: usize| {
        model.links.iter().any(|other| other.mimic.is_some_and(|mimic| mimic.link == link))
    };
    for link in 0..model.links.len() {
        if random.below(2) == 0 || !(model.links[link].mimic.is_some() || is_mimicked(model, link)) {
            continue;
        }
        let full = model.links[link].clone();
        let empty = Link { mass: 0.0, inertia: Inertia::default(), ..full.clone() };
        model.links[link] = Link { physics: JointPhysics { armature: 0.0.into(), ..full.physics.clone() }, ..empty };
        let state = state_in_space(random, model);
        let eigenvalues = kane(model, &state.q, &state.v).matrix.symmetric_eigenvalues();
        if eigenvalues.min() < 1e-6 * eigenvalues.max() {
            model.links[link] = full;
        }
    }
}

/// What acts in a joint: each of its parts in half of the joints, on each of several velocities or on half of them. Rotations
/// have one stiffness in half of the joints.
fn joint_physics(random: &mut Random, joint: LinkJoint) -> JointPhysics {
    let nv = joint.nv();
    let mut some = |largest: f64| if random.below(2) == 0 { 0.0 } else { 0.5 * largest + random.within(0.5 * largest) };
    if nv == 1 {
        return JointPhysics {
            armature: some(0.5).into(),
            damping: some(2.0).into(),
            friction: some(4.0).into(),
            friction_velocity: (0.05 + some(0.2)).into(),
            stiffness: some(20.0).into(),
            rest: vec![some(1.0)],
        };
    }
    let mut each = |least: f64, largest: f64| PerVelocity::Each((0..nv).map(|_| least + some(largest)).collect());
    let mut physics = JointPhysics {
        armature: each(0.0, 0.5),
        damping: each(0.0, 2.0),
        friction: each(0.0, 4.0),
        friction_velocity: each(0.05, 0.2),
        stiffness: each(0.0, 20.0),
        rest: random.vector(joint.nq(), 1.0),
    };
    if let (PerVelocity::Each(stiffness), 0) = (&mut physics.stiffness, random.below(2)) {
        stiffness[nv - 2..].fill(12.0);
        stiffness[nv.saturating_sub(3)] = 12.0;
    }
    physics
}

/// A frame somewhere on a link, or on the ground; a third of them stand on the origin of the link's frame.
fn frame(random: &mut Random, model: &Model, index: usize) -> Frame {
    let link = random.below(model.links.len() + 1).checked_sub(1);
    let at = if random.below(3) == 0 { Vec3::zero() } else { Vec3::from_fn(|_| random.within(0.3)) };
    Frame { name: format!("frame{index}"), link, placement: placed(&rotation(random), at) }
}

/// A spring between points of two links, or of a link and the ground. One in four has no stiffness, one in four no
/// damping, one in three no free length.
fn spring(random: &mut Random, model: &Model) -> Spring {
    let count = model.links.len() + 1;
    let first = random.below(count);
    // Another link: between points of one link, Kane's equations know no direction where the points coincide.
    let second = (first + 1 + random.below(count - 1)) % count;
    let [a, b] = [first, second]
        .map(|link| LinkPoint { link: link.checked_sub(1), point: Vec3::from_fn(|_| random.within(0.4)) });
    let acts = random.below(4);
    Spring {
        name: None,
        a,
        b,
        stiffness: if acts == 0 { 0.0 } else { 30.0 + random.within(20.0) },
        damping: if acts == 1 { 0.0 } else { 3.0 + random.within(2.0) },
        length: if random.below(3) == 0 { 0.0 } else { 0.5 + random.within(0.4) },
    }
}
