//! Frames of bodies chosen anew.
//!
//! The frame of a body on a joint with one degree of freedom may be turned about the joint's axis z and slid along it
//! without changing the joint: q stays what it was. Other joints have coordinates that mean the model's own frame. With x
//! along the common normal of the body's axis and a child's, and the origin at its foot, the child's fixed rotation is one
//! about x and its arm has no more than two components, wherever the model put its frames (Khalil & Kleinfinger, "A new
//! geometric notation for open and closed-loop robots", Proc. IEEE Int. Conf. on Robotics and Automation, 1986).

use crate::inertia::Sym3;
use crate::parameter::Parameter;
use crate::pseudo::PseudoInertia;
use crate::rotation;
use crate::spatial::{Mat3, Pose, Vec3};
use crate::spring::BodySpring;
use crate::tree::{Body, Tree};

/// Elements of a rotation nearer than this to a quarter turn's are roundoff of the products they come from.
const ROTATION_ROUNDOFF: f64 = 64.0 * f64::EPSILON;
/// Lengths and inertias smaller than this part of those around them are roundoff of the sums they come from.
const LENGTH_ROUNDOFF: f64 = 16.0 * f64::EPSILON;
/// The common normal of two axes is taken if its foot is no further away than so many times the lengths around: that of
/// nearly parallel axes is as far as their tilt is small, and inertias about a point out there have lost their digits.
const FARTHEST_FOOT: f64 = 4.0;

/// The tree with every frame in its canonical place, whatever the frames of the model: by the common normal with the
/// first child's axis, and for a body without one by its inertia. A change after which `keeps` is false is not
/// made.
pub fn canonical<P: Parameter>(tree: &Tree<P>, keeps: impl Fn(&Tree<P>) -> bool) -> Tree<P> {
    let mut tree = tree.clone();
    for body in (0..tree.bodies.len()).rev() {
        if !tree.bodies[body].joint.is_on_axis() {
            continue;
        }
        let first = tree.children(body).next();
        let turn = first.and_then(|child| turn_to_child(&tree, child)).or_else(|| turn_to_inertia(&tree, body));
        let slide = first.and_then(|child| slide_to_child(&tree, child)).or_else(|| slide_to_parent(&tree, body));
        let mut other = tree.clone();
        reframe(&mut other, body, turn.unwrap_or(0.0), slide.unwrap_or(0.0));
        if keeps(&other) {
            tree = other;
        }
    }
    let mut unified = tree.clone();
    unify_lengths(&mut unified);
    if keeps(&unified) { unified } else { tree }
}

/// Makes lengths that differ by roundoff only the same number, as they were before frames were turned and slid.
fn unify_lengths<P: Parameter>(tree: &mut Tree<P>) {
    let size = (0..tree.bodies.len()).map(|body| reach(tree, body)).fold(0.0, f64::max);
    let roundoff = LENGTH_ROUNDOFF * size;
    let mut known: Vec<f64> = Vec::new();
    for length in tree.bodies.iter_mut().flat_map(|body| &mut body.placement.position.0) {
        match known.iter().find(|&&other| (length.abs() - other).abs() < roundoff) {
            Some(&other) => *length = other.copysign(*length),
            None => known.push(length.abs()),
        }
    }
}

/// Turns the frame of `body` about its z axis by `angle` and slides it along by `distance`.
pub fn reframe<P: Parameter>(tree: &mut Tree<P>, body: usize, angle: f64, distance: f64) {
    let size = reach(tree, body).max(distance.abs());
    let change = Pose { rotation: snapped(rotation::about_z(angle)), position: Vec3([0.0, 0.0, distance]) };
    let back = inverse(change);
    let moved = &mut tree.bodies[body];
    moved.placement = moved.placement * change;
    moved.inertia = clean_inertia(moved.inertia.transformed(Pose::constant(back)), size);
    settle_rotation(tree, body, size);
    for child in tree.children(body).collect::<Vec<_>>() {
        tree.bodies[child].placement = back * tree.bodies[child].placement;
        settle_rotation(tree, child, size);
    }
    for link in tree.links.iter_mut().filter(|link| link.body == Some(body)) {
        link.pose = clean_pose(back * link.pose, size);
    }
    for frame in tree.frames.iter_mut().filter(|frame| frame.body == Some(body)) {
        frame.pose = clean_pose(back * frame.pose, size);
    }
    for end in tree.cuts.iter_mut().flat_map(|cut| [&mut cut.a, &mut cut.b]).filter(|end| end.body == Some(body)) {
        let Pose { rotation, position } = clean_pose(back * Pose { rotation: end.axes, position: end.point }, size);
        (end.axes, end.point) = (rotation, position);
    }
    for end in tree.springs.iter_mut().flat_map(BodySpring::ends_mut).filter(|end| end.body == Some(body)) {
        end.point = clean_vector(back.transform(end.point), size);
    }
}

/// By which angle to turn the frame of the parent of `child` so that x is along the common normal of their axes; for
/// parallel axes, so that x points from one to the other. `None` where the axes coincide.
pub fn turn_to_child<P: Parameter>(tree: &Tree<P>, child: usize) -> Option<f64> {
    let Pose { rotation, position: p } = placement_on_axis(tree, child)?;
    let u = rotation.column(2);
    let around = tree.bodies[child].parent.map_or(0.0, |parent| reach(tree, parent));
    let (normal, size) = if is_parallel(u) { (p, around) } else { (Vec3([-u[1], u[0], 0.0]), 1.0) };
    (normal[0].hypot(normal[1]) > LENGTH_ROUNDOFF * size).then(|| normal[1].atan2(normal[0]))
}

/// How far to slide the frame of the parent of `child` so that its origin is the foot of the common normal of their
/// axes; for axes that are parallel, or nearly so, that the two origins are at one height.
pub fn slide_to_child<P: Parameter>(tree: &Tree<P>, child: usize) -> Option<f64> {
    let Pose { rotation, position: p } = placement_on_axis(tree, child)?;
    Some(foot_on_child(tree, child).map_or(p[2], |along| p[2] + along * rotation.column(2)[2]))
}

/// How far to slide the frame of `body` so that its origin is the foot of the common normal with its parent's axis; for
/// axes that are parallel, or nearly so, that the two origins are at one height. `None` for a body on the ground.
pub fn slide_to_parent<P: Parameter>(tree: &Tree<P>, body: usize) -> Option<f64> {
    tree.bodies[body].parent?;
    let Pose { rotation, position: p } = tree.bodies[body].placement;
    Some(foot_on_child(tree, body).unwrap_or(-p[2] * rotation.column(2)[2]))
}

/// The placement of a body; `None` if its joint has more than one axis.
fn placement_on_axis<P>(tree: &Tree<P>, body: usize) -> Option<Pose<f64>> {
    Some(&tree.bodies[body]).filter(|body| body.joint.is_on_axis()).map(|body| body.placement)
}

/// How far along the axis of `child`, from its origin, the foot of the common normal with its parent's axis is. `None`
/// where that is nowhere near.
fn foot_on_child<P: Parameter>(tree: &Tree<P>, child: usize) -> Option<f64> {
    let Pose { rotation, position: p } = tree.bodies[child].placement;
    let u = rotation.column(2);
    let along = -(p[0] * u[0] + p[1] * u[1]) / (u[0] * u[0] + u[1] * u[1]);
    let around = tree.bodies[child].parent.map_or(0.0, |parent| reach(tree, parent)).max(reach(tree, child));
    (!is_parallel(u) && along.abs() <= FARTHEST_FOOT * around).then_some(along)
}

/// By which angle to turn the frame of `body` so that the first moment of its mass is along x, or if that is on the
/// axis, so that the second moment Σ_xy vanishes. `None` where both do already.
pub fn turn_to_inertia<P: Parameter>(tree: &Tree<P>, body: usize) -> Option<f64> {
    let PseudoInertia { mass, moment: h, .. } = tree.bodies[body].inertia.number()?;
    if h[0].hypot(h[1]) > LENGTH_ROUNDOFF * reach(tree, body) * mass {
        return Some(h[1].atan2(h[0]));
    }
    turn_to_principal_axis(tree, body)
}

/// By which angle to turn the frame of `body` so that the second moment Σ_xy vanishes. `None` where all directions are
/// the same.
pub fn turn_to_principal_axis<P: Parameter>(tree: &Tree<P>, body: usize) -> Option<f64> {
    let Sym3 { xx, yy, xy, .. } = tree.bodies[body].inertia.number()?.second;
    let difference = xx - yy;
    let roundoff = 64.0 * f64::EPSILON * (xx.abs() + yy.abs());
    (difference.abs().max(xy.abs()) > roundoff).then(|| 0.5 * (2.0 * xy).atan2(difference))
}

/// Writes the rotation of `body` as a fixed one with as many zeros as can be, after which comes one about z: this is
/// part of the fixed one if it is of quarter turns, else it is the joint's offset.
fn settle_rotation<P: Parameter>(tree: &mut Tree<P>, body: usize, size: f64) {
    let Pose { rotation, position } = tree.bodies[body].placement;
    let position = clean_vector(position, size);
    let offset = tree.bodies[body].offset;
    let whole = snapped(rotation * rotation::about_z(offset));
    let fixed = simplest_with_axis(whole.column(2));
    let rest = snapped(fixed.transpose() * whole);
    let quarter = rest.0[0].iter().all(|x| x.round() == *x);
    let joint = tree.bodies[body].joint;
    let turns = joint.is_on_axis() && joint.screw(0).turn != 0.0;
    let (rotation, offset) = if quarter || !turns {
        (if quarter { fixed * rest } else { whole }, 0.0)
    } else {
        (fixed, rest.0[1][0].atan2(rest.0[0][0]))
    };
    tree.bodies[body].placement = Pose { rotation, position };
    tree.bodies[body].offset = offset;
}

/// A rotation that takes z to the unit vector `u`, about x or y if that can be.
fn simplest_with_axis(u: Vec3<f64>) -> Mat3<f64> {
    let x = if u[0] == 0.0 {
        Vec3([1.0, 0.0, 0.0])
    } else if u[1] == 0.0 {
        Vec3([u[2], 0.0, -u[0]])
    } else {
        let across = u[0].hypot(u[1]);
        Vec3([-u[1] / across, u[0] / across, 0.0])
    };
    let y = u.cross(x);
    Mat3::from_fn(|i, j| [x, y, u][j][i])
}

/// Whether an axis is that of z.
fn is_parallel(u: Vec3<f64>) -> bool {
    u[0] == 0.0 && u[1] == 0.0
}

fn inverse(pose: Pose<f64>) -> Pose<f64> {
    let rotation = pose.rotation.transpose();
    Pose { rotation, position: -(rotation * pose.position) }
}

/// The largest length around a body: to its parent, its children, its links and its centre of mass.
///
/// The position of the robot in the base frame does not count: inertias do not depend on it.
fn reach<P: Parameter>(tree: &Tree<P>, body: usize) -> f64 {
    let Body { parent, placement, inertia, .. } = &tree.bodies[body];
    let own = parent.map_or(Vec3::zero(), |_| placement.position);
    let com = match inertia.number() {
        Some(PseudoInertia { mass, moment, .. }) if mass > 0.0 => moment.scale(1.0 / mass),
        _ => Vec3::zero(),
    };
    let children = tree.children(body).map(|child| tree.bodies[child].placement.position);
    let links = tree.links.iter().filter(|link| link.body == Some(body)).map(|link| link.pose.position);
    let lengths = [own, com].into_iter().chain(children).chain(links).flat_map(|vector| vector.0);
    lengths.fold(0.0, |reach, length| reach.max(length.abs()))
}

/// A rotation without the roundoff of quarter turns. An element is ±1 only where the others in its row and column
/// vanish: the cosine of a small tilt is as near to 1 as roundoff.
fn snapped(mut rotation: Mat3<f64>) -> Mat3<f64> {
    let elements = rotation.0.as_flattened_mut();
    elements.iter_mut().filter(|element| element.abs() < ROTATION_ROUNDOFF).for_each(|element| *element = 0.0);
    let along_axis =
        |i: usize, j: usize| (0..3).all(|k| (k == j || rotation.0[i][k] == 0.0) && (k == i || rotation.0[k][j] == 0.0));
    Mat3::from_fn(|i, j| if along_axis(i, j) { rotation.0[i][j].round() } else { rotation.0[i][j] })
}

fn clean(value: f64, size: f64) -> f64 {
    if value.abs() < LENGTH_ROUNDOFF * size { 0.0 } else { value }
}

fn clean_vector(v: Vec3<f64>, size: f64) -> Vec3<f64> {
    Vec3(v.0.map(|x| clean(x, size)))
}

fn clean_pose(pose: Pose<f64>, size: f64) -> Pose<f64> {
    Pose { rotation: snapped(pose.rotation), position: clean_vector(pose.position, size) }
}

fn clean_inertia<P: Parameter>(inertia: PseudoInertia<P>, size: f64) -> PseudoInertia<P> {
    let PseudoInertia { mass, moment, second } = inertia.without_roundoff();
    let Some(weight) = mass.number().map(f64::abs) else { return PseudoInertia { mass, moment, second } };
    let clean = |value: P, size: f64| value.number().map_or(value, |number| P::from_f64(clean(number, size)));
    PseudoInertia {
        mass,
        moment: moment.map(|x| clean(x, weight * size)),
        second: second.map(|x| clean(x, weight * size * size)),
    }
}
