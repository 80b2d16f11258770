//! Messages about the file as text: syntax, keys, types, numbers.

use super::super::Message;
use super::{did_you_mean, message, nearest, quoted};
use std::ops::RangeInclusive;

/// What messages know of a kind of file.
#[derive(Debug)]
pub struct Manual {
    /// What it is called: "the model file".
    pub file: &'static str,
    /// For every key an example that may be copied, and what it means. `dh.a` is `a` in the table `dh`.
    pub examples: &'static [(&'static str, &'static str, &'static str)],
}

pub(crate) const MODEL_FILE: Manual = Manual { file: "the model file", examples: EXAMPLES };

const EXAMPLES: &[(&str, &str, &str)] = &[
    ("name", "name = \"arm\"", ""),
    ("gravity", "gravity = [0.0, 0.0, -9.81]", "m/s², in the base frame"),
    ("link", "[[link]]", "one such table for each link"),
    ("loop", "[[loop]]", "one such table for each cut joint"),
    ("functions", "functions = [\"inverse_dynamics\", \"mass_matrix\"]", "only these are generated; default: all"),
    ("locked", "locked = { joint6 = \"90 deg\" }", "joints and the coordinates at which they are held"),
    ("joint_name", "joint_name = \"elbow\"", ""),
    ("parent", "parent = \"base\"", "the link that carries this one; `base` is the ground"),
    ("joint", "joint = \"revolute\"", ""),
    ("dh", "dh = { a = 0.18, alpha = \"90 deg\", b = 0.4, theta = \"0 deg\" }", "m and angles; missing = 0"),
    ("dh.a", "a = 0.18", "m"),
    ("dh.b", "b = 0.4", "m"),
    ("dh.alpha", "alpha = \"90 deg\"", "without a unit in rad"),
    ("dh.theta", "theta = \"90 deg\"", "without a unit in rad"),
    ("origin", "origin = { xyz = [0.0, 0.0, 0.4], rpy = [\"90 deg\", 0, 0] }", "m and angles; missing = 0"),
    ("origin.xyz", "xyz = [0.0, 0.0, 0.4]", "m, in the parent's frame"),
    ("origin.rpy", "rpy = [\"90 deg\", 0, 0]", "roll, pitch, yaw; without a unit in rad"),
    ("axis", "axis = [0.0, 0.0, 1.0]", "in the link's frame"),
    ("mass", "mass = 1.5", "kg"),
    ("pitch", "pitch = 0.005", "m/rad: the translation for a unit of rotation"),
    ("com", "com = [0.0, 0.0, 0.1]", "m, in the link's frame"),
    ("inertia", "inertia = { xx = 0.1, yy = 0.1, zz = 0.02 }", "kg m², about the centre of mass; missing = 0"),
    ("inertia.xx", "xx = 0.1", "kg m²"),
    ("inertia.yy", "yy = 0.1", "kg m²"),
    ("inertia.zz", "zz = 0.1", "kg m²"),
    ("inertia.xy", "xy = 0.001", "kg m²"),
    ("inertia.yz", "yz = 0.001", "kg m²"),
    ("inertia.xz", "xz = 0.001", "kg m²"),
    ("actuated", "actuated = false", ""),
    (
        "range",
        "range = { position = [\"-170 deg\", \"170 deg\"], velocity = \"150 deg\", acceleration = 10.0 }",
        "rad or m, rad/s or m/s, rad/s² or m/s²",
    ),
    ("range.position", "position = [\"-170 deg\", \"170 deg\"]", "rad or m"),
    ("range.velocity", "velocity = \"150 deg\"", "the largest in either direction; without a unit rad/s or m/s"),
    ("range.acceleration", "acceleration = 10.0", "the largest in either direction; without a unit rad/s² or m/s²"),
    ("range.force", "force = 40.0", "N m or N, of which the tolerance is a share; default: the largest that occurs"),
    ("tolerance", "tolerance = 1e-3", "the error allowed, as a share of each joint's largest force"),
    ("forward_dynamics", "forward_dynamics = \"recursion\"", "`auto`, `recursion` or `factorisation`; default: `auto`"),
    ("link_a", "link_a = \"crank\"", "a link, or `base`"),
    ("link_b", "link_b = \"base\"", "a link, or `base`"),
    ("point_a", "point_a = [0.1, 0.0, 0.0]", "m, in the frame of link a"),
    ("point_b", "point_b = [0.1, 0.0, 0.0]", "m, in the frame of link b"),
    ("axis_a", "axis_a = [0.0, 0.0, 1.0]", "in the frame of link a"),
    ("axis_b", "axis_b = [0.0, 0.0, 1.0]", "in the frame of link b"),
];

/// "write for example …" for a key, or for an element of it such as `com[1]`.
fn example(manual: &Manual, path: &str) -> String {
    let key = path.split('[').next().unwrap_or(path);
    let of = |key| manual.examples.iter().find(|(known, ..)| *known == key);
    match of(key).or_else(|| of(key.split('.').next().unwrap_or(key))) {
        Some((_, example, "")) => format!("write for example `{example}`"),
        Some((_, example, meaning)) => format!("write for example `{example}` ({meaning})"),
        None => format!("see `{key}` in the description of {}", manual.file),
    }
}

pub(crate) fn unreadable(error: &std::io::Error) -> Message {
    let help = match error.kind() {
        std::io::ErrorKind::PermissionDenied => "its permissions forbid it",
        _ => "the path must name a TOML file in UTF-8",
    };
    message(format!("cannot read the model file: {error}"), "", help)
}

pub(crate) fn is_directory() -> Message {
    message("cannot read the model file: it is a directory".into(), "", "name a file in it")
}

pub(crate) fn not_utf8(byte: usize) -> Message {
    message(
        format!("the model file is not UTF-8 (byte {byte})"),
        "",
        "save the file as UTF-8; TOML allows no other encoding",
    )
}

pub(crate) fn syntax(reason: &str) -> Message {
    let help = match reason {
        "duplicate key" => "a key may stand only once in its table: delete one of the two, or rename it",
        _ => "correct the TOML first; what the file says is checked after that",
    };
    message(format!("TOML: {reason}"), reason, help)
}

pub(crate) fn more_is_no_toml() -> Message {
    message("TOML: more lines are faulty".into(), "and below", "is this the right file?")
}

pub(crate) fn xml() -> Message {
    message(
        "this is XML, not TOML".into(),
        "TOML does not begin like this",
        "of a URDF, `redysim import` makes a model file",
    )
}

/// `owner` has the keys `keys`; `meant` is the one that was probably meant.
pub(crate) fn unknown_key(item: &str, path: &str, meant: Option<&str>, owner: &str, keys: &[&str]) -> Message {
    let help = format!("{}{owner} has: {}", did_you_mean(meant), keys.join(", "));
    message(format!("{item}: unknown key {}", quoted(path)), "unknown key", help)
}

pub(crate) fn missing_key(manual: &Manual, item: &str, path: &str) -> Message {
    message(format!("{item}: `{path}` is missing"), format!("`{path}` is missing"), example(manual, path))
}

/// `wanted` and `found` are nouns with their article.
pub(crate) fn wrong_type(manual: &Manual, item: &str, path: &str, wanted: &str, found: &str) -> Message {
    let help = match (wanted, found.starts_with("the string")) {
        ("a number", true) => format!("{}, without quotes: only angles may have a unit", example(manual, path)),
        _ => example(manual, path),
    };
    message(format!("{item}: `{path}` must be {wanted}, found {found}"), format!("not {wanted}"), help)
}

pub(crate) fn wrong_length(manual: &Manual, item: &str, path: &str, wanted: &str, found: usize) -> Message {
    message(
        format!("{item}: `{path}` must have {wanted}, found {found}"),
        format!("{found} instead of {wanted}"),
        example(manual, path),
    )
}

pub(crate) fn not_finite(manual: &Manual, item: &str, path: &str, found: &str) -> Message {
    message(
        format!("{item}: `{path}` is {}, which is not a finite number", quoted(found)),
        "not a finite number",
        example(manual, path),
    )
}

/// `nearest` is the float next to the integer.
pub(crate) fn integer_out_of_range(item: &str, path: &str, found: &str, nearest: Option<f64>) -> Message {
    message(
        format!("{item}: `{path}` is the integer {}, and integers in TOML have 64 bits", quoted(found)),
        "not from -2^63 to 2^63 - 1",
        match nearest {
            Some(nearest) => format!("write a larger number with an exponent, as in {nearest:e}"),
            None => "write a larger number with an exponent, as in 1e20".into(),
        },
    )
}

pub(crate) fn not_positive(manual: &Manual, item: &str, path: &str, found: f64) -> Message {
    let title = format!("{item}: `{path}` is {found:?}, which is not above zero");
    message(title, "not above zero", example(manual, path))
}

pub(crate) fn out_of_range(item: &str, path: &str, found: &str, allowed: &RangeInclusive<f64>) -> Message {
    message(
        format!("{item}: `{path}` is {}, with which nothing can be computed", quoted(found)),
        "too large or too small",
        format!("a number is 0 or from {:e} to {:e} in size", allowed.start(), allowed.end()),
    )
}

pub(crate) fn not_an_angle(item: &str, path: &str, found: &str) -> Message {
    message(
        format!("{item}: `{path}` is {}, which is not a number with a unit", quoted(found)),
        "not an angle",
        "write a number and a unit, as in \"90 deg\" or \"1.5 rad\", or a plain number of radians",
    )
}

pub(crate) fn bad_unit(item: &str, path: &str, found: &str, unit: &str, per: &str) -> Message {
    let (title, label) = match unit {
        "" => (format!("{item}: `{path}` is \"{found}\", which has no unit"), "no unit".into()),
        _ => (
            format!("{item}: `{path}` has the unit {}, which is not an angle's", quoted(unit)),
            format!("{} is not a unit of angle", quoted(unit)),
        ),
    };
    let help =
        format!("the units of angle are deg{per} and rad{per}, as in \"90 deg{per}\"; a plain number is in rad{per}");
    message(title, label, help)
}

pub(crate) fn unknown_choice(item: &str, path: &str, found: &str, choices: &[&str]) -> Message {
    let meant = did_you_mean(nearest(found, choices.iter().copied()));
    let help = format!("{meant}It must be one of: {}", choices.join(", "));
    message(format!("{item}: `{path}` cannot be {}", quoted(found)), "not one of the kinds", help)
}

pub(crate) fn unknown_name(item: &str, what: &str, found: &str, names: &[&str]) -> Message {
    let help = format!("{}there are: {}", did_you_mean(nearest(found, names.iter().copied())), names.join(", "));
    message(format!("{item}: there is no {what} {}", quoted(found)), format!("no such {what}"), help)
}

pub(crate) fn unsupported_joint(item: &str, found: &str, choices: &[&str]) -> Message {
    message(
        format!("{item}: joints of the kind `{found}` are not supported yet"),
        "not supported yet",
        format!("supported are: {}; chain several, with massless links in between", choices.join(", ")),
    )
}

pub(crate) fn large_angle(item: &str, path: &str, radians: f64) -> Message {
    message(
        format!("{item}: `{path}` is {radians:?} rad, more than a whole turn"),
        "more than a whole turn",
        format!("if degrees are meant, write \"{radians:?} deg\"; otherwise \"{radians:?} rad\" ends this warning"),
    )
}

pub(crate) fn nearly_quarter_turn(item: &str, path: &str, radians: f64, degrees: f64) -> Message {
    message(
        format!("{item}: `{path}` is {radians:?} rad, nearly but not exactly {degrees} deg"),
        format!("nearly {degrees} deg"),
        format!(
            "write \"{degrees} deg\": it is exact, and its zeros leave the generated code; \"{radians:?} rad\" ends this warning"
        ),
    )
}
