//! Messages about the mechanism that the file describes.

use super::{message, with_locks};
use crate::joint::Joint;
use crate::model::{CutKind, JointKind};
use crate::schema::{RotationDefect, keys};
use redysim_runtime::Function;
use redysim_toml::words::{did_you_mean, nearest, quoted, rounded, shortened};
use redysim_toml::{Key, KeyPath, Message};

pub(crate) fn blank_name(item: &str, key: &str) -> Message {
    message(format!("{item}: `{key}` is blank"), "blank", "give it a name: messages and generated code use it")
}

pub(crate) fn reserved_name() -> Message {
    message(
        "a link cannot be named `base`".into(),
        "stands for the ground",
        "`base` is the ground, which every mechanism has: give the link another name",
    )
}

/// `what` is "link", "joint", "loop", "frame" or "spring".
pub(crate) fn duplicate_name(what: &str, name: &str, first_line: usize) -> Message {
    let name = quoted(name);
    message(
        format!("{what} {name}: the name is used twice"),
        format!("also on line {first_line}"),
        format!("the {what} on line {first_line} is {name} too: give one of them another name"),
    )
}

/// What other formats and simulators call the ground.
const GROUND: &[&str] = &["", "world", "ground", "map", "root", "fixed", "inertial", "origin", "base_link", "universe"];

/// `links` are the names of all; `suggests` is whether the nearest is looked for.
pub(crate) fn unknown_link<'a>(
    item: &str,
    key: &str,
    name: &str,
    links: impl Iterator<Item = &'a str>,
    suggests: bool,
) -> Message {
    let all: Vec<_> = std::iter::once("base").chain(links).collect();
    let meant = match name.trim().to_lowercase().as_str() {
        ground if GROUND.contains(&ground) => "did you mean `base`, the ground? ".into(),
        _ if suggests => did_you_mean(nearest(name, all.iter().copied())),
        _ => String::new(),
    };
    message(
        format!("{item}: unknown link {} in `{key}`", quoted(name)),
        "unknown link",
        format!("{meant}The links are: {}", shortened(&all)),
    )
}

/// `found` is what others call a kind of joint; `help` is what to write.
pub(crate) fn foreign_joint_kind(item: &str, path: &KeyPath, found: &str, help: &str) -> Message {
    let kinds = JointKind::ALL.map(|(name, _)| name);
    let help = format!("{help}. The kinds of joints are: {}", kinds.join(", "));
    message(format!("{item}: `{path}` cannot be {}", quoted(found)), "not one of the kinds", help)
}

pub(crate) fn own_parent(item: &str) -> Message {
    message(
        format!("{item}: it is its own parent"),
        "its own parent",
        "name the link that carries it, or \"base\" for the ground",
    )
}

pub(crate) fn physics_of_fixed(item: &str, key: &str) -> Message {
    message(
        format!("{item}: `{key}` belongs to a joint that moves, but this one is fixed"),
        "the joint is fixed",
        format!("delete `{key}`, or choose another `{}`", keys::JOINT.name),
    )
}

/// `path` is that of the key `key` or an element of it.
pub(crate) fn negative_physics(item: &str, key: &str, path: &KeyPath, value: f64) -> Message {
    let energy = match key {
        _ if key == keys::ARMATURE.name => "the mass matrix would not be positive definite",
        _ if key == keys::STIFFNESS.name => "the spring would push away from its rest",
        _ => "the joint would drive itself",
    };
    message(
        format!("{item}: `{path}` is negative: {value:?}; {energy}"),
        "negative",
        "give zero or a positive number; zero is the default",
    )
}

pub(crate) fn friction_velocity_not_positive(item: &str, path: &KeyPath, value: f64) -> Message {
    message(
        format!(
            "{item}: `{path}` must be positive, but is {value:?}: friction would jump where the joint stands still"
        ),
        "not positive",
        format!("give the speed below which friction is to fade, such as `{}`", keys::FRICTION_VELOCITY.example()),
    )
}

/// `velocities` are the names of those of the joint.
pub(crate) fn one_number_for_two_units(item: &str, key: &Key, velocities: &[&str]) -> Message {
    let name = key.name;
    message(
        format!("{item}: `{name}` is one number, but some velocities of the joint are in m/s, others in rad/s"),
        "one number for two units",
        format!(
            "give an array of {} numbers, one for each of the velocities {}",
            velocities.len(),
            velocities.join(", ")
        ),
    )
}

pub(crate) fn physics_without(item: &str, key: &str, missing: &str) -> Message {
    message(
        format!("{item}: `{key}` has no effect without `{missing}`"),
        format!("needs `{missing}`"),
        format!("add `{missing}`, or delete `{key}`"),
    )
}

/// `names` are the links of the cycle, each the child of the next, the last the child of the first.
pub(crate) fn cycle(names: &[&str]) -> Message {
    let first = names.first().copied().unwrap_or_default();
    let path: Vec<_> = names.iter().chain([&first]).map(|name| quoted(name)).collect();
    message(
        format!("link {}: its parents lead back to itself: {}", quoted(first), path.join(" -> ")),
        "leads back to this link",
        "one of these links must have the parent \"base\" or another link; close loops with [[loop]]",
    )
}

pub(crate) fn two_placements(item: &str, first: &str, second: &str) -> Message {
    message(
        format!("{item}: its joint is placed twice, by `{first}` and by `{second}`"),
        format!("already placed by `{first}`"),
        "keep one: `dh`, `dh_standard`, or `origin` and `axis`",
    )
}

pub(crate) fn placement_of_moving(item: &str, key: &str) -> Message {
    message(
        format!("{item}: has `{key}`, but its joint is fixed"),
        "the joint does not move",
        "place a fixed link by `origin` alone",
    )
}

pub(crate) fn beside_dh(item: &str, key: &str, parameters: &str) -> Message {
    let distance = if parameters == keys::DH.name { "b" } else { "d" };
    let help = if key == keys::OFFSET.name {
        format!("add it to `theta` of a joint that turns, or to `{distance}` of one that slides")
    } else {
        format!("leave `{key}` out, or place the joint by `origin` and `axis`")
    };
    message(format!("{item}: has `{key}` beside `{parameters}`"), format!("`{parameters}` includes it"), help)
}

pub(crate) fn not_a_rotation(item: &str, path: &KeyPath, defect: RotationDefect) -> Message {
    let help = "give each element with all its digits, or the angles by `rpy`";
    match defect {
        RotationDefect::NotOrthonormal(error) => message(
            format!("{item}: `{path}` is not a rotation: an element of R Rᵀ is off by {error:.1e}"),
            "not a rotation matrix",
            help,
        ),
        RotationDefect::Reflection => message(
            format!("{item}: `{path}` is a reflection: its determinant is -1"),
            "not a rotation matrix",
            "the columns are the axes x, y and z of a right-handed frame",
        ),
    }
}

pub(crate) fn two_rotations(item: &str) -> Message {
    message(
        format!("{item}: its rotation is given twice, by `rpy` and by `rotation`"),
        "already given by `rpy`",
        "keep one of the two",
    )
}

pub(crate) fn no_placement(item: &str) -> Message {
    message(
        format!("{item}: its joint has no place"),
        "no `dh`, `dh_standard`, `origin` or `axis`",
        format!(
            "give for example `{}`, `{}`, or `{}` and `{}`; `{} = {{}}` is the parent's frame",
            keys::DH.example(),
            keys::DH_STANDARD.example(),
            keys::ORIGIN.example(),
            keys::AXIS.example(),
            keys::ORIGIN.name
        ),
    )
}

/// `kind` is that of a joint that moves.
pub(crate) fn origin_without_axis(item: &str, kind: &str) -> Message {
    message(
        format!("{item}: `origin` places its {kind} joint, but `axis` is missing"),
        "no `axis` beside it",
        format!(
            "write for example `{}` ({}); `axis` does not have a default here (in URDF it is x)",
            keys::AXIS.example(),
            keys::AXIS.meaning
        ),
    )
}

pub(crate) fn axis_on_fixed(item: &str) -> Message {
    message(format!("{item}: a fixed joint has no axis"), "no axis", "delete `axis`, or make the joint move")
}

/// The key has a meaning for joints of one axis alone.
/// `key` belongs to a joint of one coordinate, or with one axis, and the link's is another.
pub(crate) fn needs_one_coordinate(item: &str, key: &str, kind: JointKind) -> Message {
    let (name, origin) = (kind.name(), keys::ORIGIN.name);
    let (owner, label, placed_by) = match kind {
        JointKind::Cylindrical => {
            ("of one coordinate", "the joint has two", format!("`{origin}` and `{}`", keys::AXIS.name))
        }
        JointKind::Universal => ("with one axis", "the joint turns about two axes", format!("`{origin}` alone")),
        JointKind::Planar => ("with one axis", "the joint moves in a plane", format!("`{origin}` alone")),
        _ => ("with one axis", "the joint moves about every axis", format!("`{origin}` alone")),
    };
    message(
        format!("{item}: `{key}` belongs to a joint {owner}, but its joint is {name}"),
        label,
        format!("delete `{key}`: a {name} joint is placed by {placed_by}"),
    )
}

pub(crate) fn coordinates_on_another_joint(item: &str, kind: &str) -> Message {
    message(
        format!("{item}: a {kind} joint has no `{}`", keys::COORDINATES.name),
        "neither spherical nor free",
        format!("delete `{}`, or make the joint spherical or free", keys::COORDINATES.name),
    )
}

pub(crate) fn pitch_on_another_joint(item: &str, kind: &str) -> Message {
    message(
        format!("{item}: a {kind} joint has no `pitch`"),
        "not helical",
        "delete `pitch`, or make the joint helical",
    )
}

pub(crate) fn axis_on_cut(item: &str, key: &str, kind: CutKind) -> Message {
    let help = match kind {
        CutKind::Prismatic => {
            format!("delete `{key}`: the frames of both links align, and slide along `{}`", keys::AXIS_A.name)
        }
        _ => format!("delete `{key}`, or make the loop's joint revolute"),
    };
    message(format!("{item}: a {} cut has no `{key}`", kind.name()), "no axis", help)
}

pub(crate) fn zero_axis(item: &str, key: &str, length: f64) -> Message {
    message(
        format!("{item}: `{key}` has the length {}, so it has no direction", rounded(length)),
        "no direction",
        "give a vector along the joint's axis, as in [0.0, 0.0, 1.0]; it need not have unit length",
    )
}

pub(crate) fn negative_mass(item: &str, mass: f64) -> Message {
    message(
        format!("{item}: `mass` is {mass:?} kg, which is negative"),
        "negative",
        "give the mass in kg; 0 is allowed where a link further out has mass",
    )
}

pub(crate) fn indefinite_inertia(item: &str, smallest: f64) -> Message {
    message(
        format!("{item}: `inertia` has a negative principal moment, {} kg m²", rounded(smallest)),
        "not an inertia",
        "give the inertia about the centre of mass; products of inertia are the tensor's elements, that of x and y -∫ x y dm",
    )
}

pub(crate) fn negative_moment_of_ground(item: &str, smallest: f64) -> Message {
    message(
        format!(
            "{item}: `inertia` has a negative principal moment, {} kg m², but the link never moves",
            rounded(smallest)
        ),
        "not an inertia",
        "the number is without effect; leave the inertia out, or give that about the centre of mass",
    )
}

/// `whole` are the principal moments of the rigid body that the link is part of.
pub(crate) fn negative_moment_of_part(item: &str, smallest: f64, whole: [f64; 3]) -> Message {
    let [least, _, largest] = whole.map(rounded);
    message(
        format!(
            "{item}: `inertia` has a negative principal moment, {} kg m², which is small beside those of the rigid body that \
             the link is part of, {least} to {largest} kg m²",
            rounded(smallest)
        ),
        "not an inertia",
        "the sum over the rigid body is used, which is the inertia of a body; leave this one out, or correct it",
    )
}

/// `largest` exceeds the sum of the other two principal moments by `excess`.
pub(crate) fn triangle(item: &str, largest: f64, excess: f64) -> Message {
    message(
        format!(
            "{item}: no body has this `inertia`: its largest principal moment, {} kg m², exceeds the sum of the other \
             two by {} kg m²",
            rounded(largest),
            rounded(excess)
        ),
        "violates the triangle inequality",
        "Ixx <= Iyy + Izz, and so for each axis: check units and digits; the model is used as it stands",
    )
}

pub(crate) fn massless(item: &str, joint: &str) -> Message {
    message(
        format!("{item}: its joint {} moves no mass", quoted(joint)),
        "neither it nor any link further out has mass or inertia",
        "the mass matrix would be singular at every position: give the link, or one that it carries, a mass, or make \
         the joint fixed",
    )
}

/// The joint moves mass, but no motion of it alone needs a force.
pub(crate) fn singular_mass_matrix(link: &str, joint_name: &str, joint: Joint) -> Message {
    let why = match joint {
        Joint::Revolute => "all mass that it could turn lies on its axis, or on another free axis that takes its place",
        Joint::Prismatic => "all mass that it could push is as free along another joint",
        Joint::Helical { .. } => "all mass that it could move is as free along or about another joint",
        Joint::Spherical => "about some axis it turns no mass, or none that is not as free about another joint",
        Joint::Free => {
            "along or about some axis it moves no mass, or none that is not as free along or about another joint"
        }
    };
    message(
        format!("link {}: its joint {} meets no inertia at any position", quoted(link), quoted(joint_name)),
        why,
        "the mass matrix would be singular at every position: give the link an inertia about its axis, move its `com` \
         off the axis, or make one of the joints fixed",
    )
}

/// Closed loops move, but the function `name` is that of the tree, in which `link` moves no mass.
pub(crate) fn singular_tree(item: &str, function: Function, link: &str, joint: &str) -> Message {
    let name = function.name();
    message(
        format!(
            "{item}: `{name}` is that of the tree with its loops open, whose mass matrix is singular: the joint {} of \
             link {} meets no inertia",
            quoted(joint),
            quoted(link)
        ),
        "the closed mechanism alone has accelerations",
        "leave it out and take `ClosedLoop::dynamics`, for which the loops hold the link, or give the link a small \
         mass and inertia",
    )
}

pub(crate) fn no_links(item: &str) -> Message {
    message(format!("{item}: it has no links"), "no links", "add a [[link]] table for each link")
}

pub(crate) fn nothing_moves(item: &str) -> Message {
    message(
        format!("{item}: every joint is fixed, so nothing moves"),
        "the first of the fixed joints",
        "make at least one joint revolute, prismatic or helical",
    )
}

/// `link_a` and `link_b` are one link, or fixed to each other.
pub(crate) fn loop_within_body(item: &str, link_a: &str, link_b: &str, locks: Vec<&str>) -> Message {
    let title = within_body(item, link_a, link_b);
    with_locks(message(title, "the same body", "a loop must join two bodies that move against each other"), &locks)
}

pub(crate) fn negative_of_spring(item: &str, key: &str, value: f64) -> Message {
    let why = match key {
        _ if key == keys::LENGTH.name => "a length cannot be negative",
        _ if key == keys::SPRING_STIFFNESS.name => "the spring would be unstable",
        _ => "the damper would add energy",
    };
    message(format!("{item}: `{key}` is negative: {value:?}; {why}"), "negative", "give zero or a positive number")
}

pub(crate) fn spring_without_force(item: &str) -> Message {
    let [stiffness, damping] = [&keys::SPRING_STIFFNESS, &keys::SPRING_DAMPING];
    message(
        format!("{item}: it has neither `{}` nor `{}`, so it has no effect", stiffness.name, damping.name),
        "no force",
        format!("give for example `{}` ({}) and `{}`", stiffness.example(), stiffness.meaning, keys::LENGTH.example()),
    )
}

/// `link_a` and `link_b` are one link, or fixed to each other.
pub(crate) fn spring_within_body(item: &str, link_a: &str, link_b: &str) -> Message {
    message(
        within_body(item, link_a, link_b),
        "the same body",
        "a spring must join two bodies that move against each other: one within a body never changes its length",
    )
}

fn within_body(item: &str, link_a: &str, link_b: &str) -> String {
    match link_a == link_b {
        true => format!("{item}: it joins {} to itself", quoted(link_a)),
        false => {
            format!("{item}: it joins {} and {}, which fixed joints make one body", quoted(link_a), quoted(link_b))
        }
    }
}

/// Newton's method did not close the loops from any start.
pub(crate) fn loops_stay_open(model: &str, starts: usize, position_residual: f64) -> Message {
    message(
        format!(
            "model {}: its loops could not be closed from any of {starts} starts; a position residual of {} m was left",
            quoted(model),
            rounded(position_residual)
        ),
        "the loops stay open",
        "check lengths, points and axes at the cuts; if the mechanism closes only near one position, close it from \
         there with `assemble`",
    )
}

pub(crate) fn loop_without_constraints(name: &str) -> Message {
    message(
        format!("loop {}: its constraints hold at every position", quoted(name)),
        "no constraints",
        "remove it, or check its links and points: the two sides may be held together by the tree already",
    )
}

pub(crate) fn redundant_rows(name: &str, dependent: usize, [rows, structural, mobility]: [usize; 3]) -> Message {
    let follow = if dependent == 1 { "follows" } else { "follow" };
    message(
        format!("loop {}: {dependent} of its constraints {follow} from the others", quoted(name)),
        format!(
            "the loops set {rows} constraints, which leave a mobility of {structural} by their structure, of \
             {mobility} by their rank"
        ),
        "the motion is not affected; of the constraint forces those of least norm are given. A cut of another kind \
         (spherical instead of revolute) may leave them out",
    )
}

pub(crate) fn no_mobility(model: &str, dof: usize, rank: usize) -> Message {
    message(
        format!("model {}: its loops leave nothing that moves", quoted(model)),
        format!("{dof} joint velocities, {rank} independent constraints"),
        "check the cuts: each joint between two links is either in the tree or cut, not both",
    )
}

pub(crate) fn over_actuated(model: &str, actuated: usize, mobility: usize) -> Message {
    message(
        format!("model {}: {actuated} actuated joints, but a mobility of {mobility}", quoted(model)),
        "more actuators than freedom",
        "write `actuated = false` for joints without an actuator; if all are meant, inverse dynamics gives the joint \
         forces of least norm",
    )
}
