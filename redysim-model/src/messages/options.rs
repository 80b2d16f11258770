//! Messages about the options of the generator, and the ranges that one of them needs.

use super::message;
use crate::options::AccelerationMethod;
use crate::run_time::Quantity;
use crate::schema::keys;
use redysim_runtime::Function;
use redysim_toml::words::{did_you_mean, nearest, quoted, rounded, shortened};
use redysim_toml::{KeyPath, Message};

fn names_of_functions() -> Vec<&'static str> {
    Function::ALL.iter().map(|function| function.name()).collect()
}

pub(crate) fn unknown_function(item: &str, name: &str) -> Message {
    let meant = did_you_mean(nearest(name, names_of_functions()));
    message(
        format!("{item}: unknown function {} in `functions`", quoted(name)),
        "unknown function",
        format!("{meant}The functions are: {}", names_of_functions().join(", ")),
    )
}

pub(crate) fn repeated_function(item: &str, function: Function) -> Message {
    let name = function.name();
    message(format!("{item}: `functions` names `{name}` twice"), "named before", "delete one of the two")
}

pub(crate) fn no_functions(item: &str) -> Message {
    message(
        format!("{item}: `functions` names no function"),
        "no functions",
        format!("without `functions`, all of them are generated: {}", names_of_functions().join(", ")),
    )
}

pub(crate) fn function_of_loops(item: &str, function: Function) -> Message {
    let name = function.name();
    message(
        format!("{item}: `functions` names `{name}`, but there are no loops"),
        "the model has no [[loop]]",
        "leave it out, or add the loops; a tree has the functions that do not begin with `loop_`",
    )
}

pub(crate) fn function_of_frames(item: &str, function: Function) -> Message {
    let name = function.name();
    message(
        format!("{item}: `functions` names `{name}`, but there are no frames"),
        "the model has no [[frame]]",
        "leave it out, or add a [[frame]] with the name of a link; every model has `link_kinematics`",
    )
}

pub(crate) fn function_of_passive_joints(item: &str, function: Function) -> Message {
    let name = function.name();
    message(
        format!(
            "{item}: `functions` names `{name}`, which needs joints with an actuator and joints without one, and no loops"
        ),
        "not available for this model",
        "leave it out, or write `actuated = false` in the links whose joints move freely",
    )
}

pub(crate) fn locked_unknown(item: &str, name: &str, joints: &[&str]) -> Message {
    let meant = did_you_mean(nearest(name, joints.iter().copied()));
    message(
        format!("{item}: unknown joint {} in `locked`", quoted(name)),
        "unknown joint",
        format!("{meant}The joints that move are: {}", shortened(joints)),
    )
}

pub(crate) fn locked_fixed(item: &str, name: &str) -> Message {
    message(
        format!("{item}: `locked` names {}, whose joint is fixed", quoted(name)),
        "fixed already",
        "leave it out: only joints that move can be locked",
    )
}

pub(crate) fn locked_mimic(item: &str, name: &str, followed: &str) -> Message {
    message(
        format!("{item}: `locked` names {}, which mimics {}", quoted(name), quoted(followed)),
        "follows another joint",
        format!("lock {} instead: joints that mimic it are held where they are then", quoted(followed)),
    )
}

pub(crate) fn locked_twice(item: &str, name: &str) -> Message {
    message(
        format!("{item}: `locked` holds the joint {} a second time", quoted(name)),
        "locked before",
        "a joint has a name, and so has its link: keep one of the two",
    )
}

pub(crate) fn without_orientation(item: &str, path: &KeyPath) -> Message {
    message(
        format!("{item}: the quaternion of `{path}` is zero, which is invalid"),
        "a zero quaternion",
        "the last four coordinates are a quaternion x, y, z, w: the default orientation is 0, 0, 0, 1",
    )
}

pub(crate) fn nothing_moves_unlocked(item: &str) -> Message {
    message(
        format!("{item}: every joint is fixed or locked, so nothing moves"),
        "locks the last joint that moves",
        "leave at least one joint unlocked",
    )
}

pub(crate) fn unknown_acceleration_method(item: &str, name: &str) -> Message {
    let names = AccelerationMethod::NAMES.map(|(name, _)| name);
    let meant = did_you_mean(nearest(name, names));
    message(
        format!("{item}: `forward_dynamics` is {}, which is invalid", quoted(name)),
        "not a method",
        format!(
            "{meant}The methods are: {}; with `auto`, the default, the generator takes the factorisation where it is \
             cheaper and keeps the digits that the recursion keeps",
            names.join(", ")
        ),
    )
}

pub(crate) fn bad_tolerance(item: &str, tolerance: f64) -> Message {
    message(
        format!("{item}: `tolerance` is {tolerance:?}, which is not a share between 0 and 1"),
        "not between 0 and 1",
        "give the error allowed as a share of each joint's largest force, as in 1e-3; without `tolerance` nothing is \
         pruned",
    )
}

/// A tolerance is asked for, but these joints have `what`: no range, or one without an acceleration.
pub(crate) fn no_range(item: &str, what: &str, joints: &[&str]) -> Message {
    let names: Vec<_> = joints.iter().map(|name| quoted(name)).collect();
    let names: Vec<_> = names.iter().map(String::as_str).collect();
    let (have, s) = if joints.len() == 1 { ("has", "") } else { ("have", "s") };
    message(
        format!("{item}: `tolerance` is given, but joint{s} {} {have} {what}", shortened(&names)),
        "holds within ranges only",
        format!("give each link whose joint moves its range, as in `{}`", keys::RANGE.example()),
    )
}

pub(crate) fn empty_range(item: &str, path: &KeyPath, [least, largest]: [f64; 2]) -> Message {
    message(
        format!("{item}: `{path}` goes from {} down to {}", rounded(least), rounded(largest)),
        "empty range",
        "give the least coordinate first, then the largest",
    )
}

pub(crate) fn negative_range(item: &str, path: &KeyPath, largest: f64) -> Message {
    message(
        format!("{item}: `{path}` is {}, which is negative", rounded(largest)),
        "negative",
        "give the largest size of it, which holds in both directions",
    )
}

pub(crate) fn unknown_parameter(item: &str, name: &str) -> Message {
    let meant = did_you_mean(nearest(name, [Quantity::Gravity.name()]));
    let help = format!(
        "{meant}Write `gravity`, or the name of a link or a joint and what it has, as in `{}`",
        keys::PARAMETERS.example()
    );
    message(format!("{item}: unknown parameter {} in `parameters`", quoted(name)), "unknown parameter", help)
}

/// `owner` has no `quantity`.
pub(crate) fn unknown_quantity(item: &str, name: &str, owner: &str, quantity: &str) -> Message {
    let names = Quantity::OF_LINKS.map(|(name, _)| name);
    let meant = nearest(quantity, names).map(|quantity| format!("{owner}.{quantity}"));
    let help = format!("{}Links and joints have: {}", did_you_mean(meant.as_deref()), names.join(", "));
    message(format!("{item}: unknown parameter {} in `parameters`", quoted(name)), "unknown parameter", help)
}

/// The parameter `whole` exists, of which `name` is a component or is meant to be.
pub(crate) fn component_of_parameter(item: &str, name: &str, whole: &str, quantity: Quantity) -> Message {
    let (whole, numbers) = (quoted(whole), quantity.components());
    let help = match numbers {
        [] | [_] => format!("write {whole}"),
        numbers => format!("write {whole}, which gives all {} of its numbers: {}", numbers.len(), numbers.join(", ")),
    };
    message(format!("{item}: unknown parameter {} in `parameters`", quoted(name)), "part of a parameter", help)
}

pub(crate) fn parameter_of_unknown(item: &str, name: &str, [owner, quantity]: [&str; 2], owners: &[&str]) -> Message {
    let meant = nearest(owner, owners.iter().copied()).map(|owner| format!("{owner}.{quantity}"));
    let help = format!("{}Links and joints: {}", did_you_mean(meant.as_deref()), shortened(owners));
    message(format!("{item}: parameter {} of an unknown link or joint", quoted(name)), "unknown link or joint", help)
}

pub(crate) fn repeated_parameter(item: &str, name: &str) -> Message {
    message(format!("{item}: `parameters` names {} twice", quoted(name)), "named before", "remove one of the two")
}

pub(crate) fn parameter_of_fixed(item: &str, link: &str) -> Message {
    message(
        format!("{item}: `parameters` names a quantity of the joint of {link}, which is fixed or locked"),
        "the joint does not move",
        "remove the parameter, or let the joint move",
    )
}
