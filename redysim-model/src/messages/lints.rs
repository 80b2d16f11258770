//! Messages about what is rarely meant.

use super::message;
use crate::lint::Lint;
use redysim_toml::Message;
use redysim_toml::words::{did_you_mean, nearest, quoted, rounded};

/// The message with the way to allow its lint.
pub(crate) fn with_allow(mut message: Message, lint: Lint) -> Message {
    let ends = if lint.is_note() { "note" } else { "warning" };
    message.help += &format!("; `allow = [\"{lint}\"]` at the top of the file ends this {ends}");
    message
}

pub(crate) fn unknown_lint(item: &str, name: &str) -> Message {
    let names = Lint::ALL.map(Lint::name);
    let meant = did_you_mean(nearest(name, names));
    message(
        format!("{item}: unknown lint {} in `allow`", quoted(name)),
        "unknown lint",
        format!("{meant}The lints are: {}", names.join(", ")),
    )
}

pub(crate) fn no_gravity(model: &str) -> Message {
    message(
        format!("model {}: gravity is zero", quoted(model)),
        "zero",
        "on Earth it is 9.81 m/s² downwards, as in `gravity = [0.0, 0.0, -9.81]`",
    )
}

pub(crate) fn gravity_units(model: &str, size: f64) -> Message {
    message(
        format!("model {}: gravity is {} m/s², which no planet has", quoted(model), rounded(size)),
        "mm/s², ft/s² or km/s²?",
        "gravity is in m/s², on Earth 9.81, and lengths are in m",
    )
}

pub(crate) fn other_gravity(model: &str, size: f64) -> Message {
    message(
        format!("model {}: gravity is {} m/s², which is not Earth's", quoted(model), rounded(size)),
        "not 9.81 m/s²",
        "on Earth it is 9.78 to 9.83 m/s²",
    )
}

/// `axis` is "y" or "z".
pub(crate) fn gravity_up(model: &str, axis: &str) -> Message {
    message(
        format!("model {}: gravity points up, along {axis}", quoted(model)),
        "upwards",
        "`gravity` is the acceleration of free fall in the base frame, as in [0.0, 0.0, -9.81] where z points up. A base \
         that hangs upside down is a reason to allow it",
    )
}

pub(crate) fn far_reach(model: &str, size: f64, mass: f64) -> Message {
    message(
        format!(
            "model {}: the mechanism reaches {} m with a mass of {} kg",
            quoted(model),
            rounded(size),
            rounded(mass)
        ),
        "lengths in mm or cm?",
        "lengths are in m, masses in kg and inertias in kg m²",
    )
}

/// The names and lengths of the link that is too long and of the next shorter one.
pub(crate) fn uneven_lengths([(long, length), (short, next)]: [(&String, f64); 2]) -> Message {
    message(
        format!(
            "link {}: it is placed {} m from the one that carries it, and the next shorter, {}, only {} m",
            quoted(long),
            rounded(length),
            quoted(short),
            rounded(next)
        ),
        "in mm?",
        "lengths are in m",
    )
}

pub(crate) fn far_com(item: &str, distance: f64, around: f64) -> Message {
    message(
        format!(
            "{item}: its centre of mass is {} m from its frame, in a mechanism of {} m",
            rounded(distance),
            rounded(around)
        ),
        "in mm?",
        "`com` is in m, from the link's frame",
    )
}

pub(crate) fn long_spring(item: &str, length: f64, around: f64) -> Message {
    message(
        format!("{item}: its free length is {} m, in a mechanism of {} m", rounded(length), rounded(around)),
        "in mm?",
        "`length` is in m",
    )
}

pub(crate) fn heavy_chain(model: &str, mass: f64, size: f64) -> Message {
    message(
        format!(
            "model {}: its links on joints weigh {} kg and reach {} m, and would weigh less if they were of solid steel",
            quoted(model),
            rounded(mass),
            rounded(size)
        ),
        "masses in g?",
        "masses are in kg, lengths in m and inertias in kg m²",
    )
}

/// The names and masses of the heaviest and of the lightest link.
pub(crate) fn mass_ratio([(heavy, mass), (light, least)]: [(&String, f64); 2]) -> Message {
    message(
        format!(
            "link {}: its mass is {} kg, that of {} only {} kg",
            quoted(heavy),
            rounded(mass),
            quoted(light),
            rounded(least)
        ),
        "kg and g?",
        "masses are in kg",
    )
}

pub(crate) fn wide_range(item: &str, farthest: f64) -> Message {
    message(
        format!("{item}: `range.position` goes to {} rad", rounded(farthest)),
        "degrees?",
        "a plain number is in rad; write \"170 deg\" for degrees",
    )
}

pub(crate) fn large_radius(item: &str, radius: f64, size: f64) -> Message {
    radius_of_gyration(item, radius, format!("in a mechanism of {} m", rounded(size)), "too large for its mass")
}

pub(crate) fn large_radius_of_link(item: &str, radius: f64, size: f64) -> Message {
    let why = format!(
        "but its centre of mass, its frames and the joints next to it are within {} m of its frame",
        rounded(size)
    );
    radius_of_gyration(item, radius, why, "too large for its mass")
}

pub(crate) fn small_radius(item: &str, radius: f64, size: f64) -> Message {
    radius_of_gyration(item, radius, format!("in a mechanism of {} m", rounded(size)), "too small for its mass")
}

pub(crate) fn dense_link(item: &str, radius: f64, mass: f64) -> Message {
    let why = format!("so its {} kg are far denser than tungsten", rounded(mass));
    radius_of_gyration(item, radius, why, "too small for its mass")
}

fn radius_of_gyration(item: &str, radius: f64, why: String, label: &str) -> Message {
    message(
        format!("{item}: with this `mass` and `inertia` its radius of gyration is {} m, {why}", rounded(radius)),
        label,
        "masses are in kg, inertias in kg m² (1 kg m² = 1e6 kg mm² = 1e7 g cm²), about the centre of mass; of a point of \
         mass, leave out `inertia`",
    )
}

pub(crate) fn point_masses(model: &str) -> Message {
    message(
        format!("model {}: no link has an `inertia`", quoted(model)),
        "all masses are points",
        "give each link its inertia about the centre of mass, if it is not a point",
    )
}

pub(crate) fn missing_inertia(item: &str, mass: f64, other: &str) -> Message {
    message(
        format!("{item}: it has {} kg, but no `inertia`, which others, such as {}, have", rounded(mass), quoted(other)),
        "a point of mass?",
        "give its inertia about the centre of mass, in kg m²",
    )
}

/// The last two joints of a chain under `dh` have one axis, and its first row is not zero.
pub(crate) fn standard_rows(item: &str, before: &str) -> Message {
    message(
        format!("{item}: its axis is that of {}, and the rows under `dh` look like standard ones", quoted(before)),
        "`a` and `alpha` are zero: the axis of the joint before",
        "`dh` is Khalil and Kleinfinger's convention (modified), Rx(alpha) Tx(a) Rz(theta) Tz(b); rows of data sheets and \
         most textbooks are standard (distal): write them as `dh_standard = { a, alpha, d, theta }`, with `com` and \
         `inertia` in the frames at the links' far ends",
    )
}

/// The first two joints of a chain under `dh_standard` have one axis, and its last row is not zero.
pub(crate) fn modified_rows(item: &str, next: &str) -> Message {
    message(
        format!(
            "{item}: its axis is that of {}, and the rows under `dh_standard` look like those of Khalil and Kleinfinger",
            quoted(next)
        ),
        "`a` and `alpha` are zero: the axis of the next joint",
        "`dh_standard` is the standard convention (distal), Rz(theta) Tz(d) Tx(a) Rx(alpha), whose first row leads to the \
         second axis; write the rows of Khalil and Kleinfinger or Craig (modified) as `dh = { a, alpha, b, theta }`",
    )
}

pub(crate) fn constant_length(item: &str, length: f64) -> Message {
    message(
        format!("{item}: its ends are {} m apart at every position, so it has no effect", rounded(length)),
        "never changes its length",
        "check its links and points: an end on a joint's axis is not moved by that joint",
    )
}

pub(crate) fn no_direction(item: &str, length: f64) -> Message {
    message(
        format!(
            "{item}: its ends coincide where all coordinates are zero, and its free length is {} m",
            rounded(length)
        ),
        "its force has no direction there",
        "check its points; where they coincide, its force is zero, and a little beside it pushes with all of its preload. \
         A spring that balances a weight mostly has `length = 0`",
    )
}

pub(crate) fn under_actuated(model: &str, actuated: usize, mobility: usize) -> Message {
    let joints = if actuated == 1 { "joint" } else { "joints" };
    message(
        format!("model {}: the mobility is {mobility}, but there is an actuator at {actuated} {joints}", quoted(model)),
        "fewer actuators than freedom",
        "delete `actuated = false` where there is an actuator",
    )
}
