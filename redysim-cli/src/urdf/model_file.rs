//! The robot as the text of a model file.

use std::fmt::Write;

use redysim_model::inertia::Sym3;
use redysim_model::{JointKind, rotation};

use super::elements::{Limit, Mimic};
use super::notation::{inertia, vector};
use super::origin::Origin;
use super::robot::{Link, Robot};

/// The text, and the line on which each link begins.
pub struct ModelFile {
    pub text: String,
    pub lines: Vec<usize>,
}

/// Writes `robot`, with `head` as comments before it.
pub fn write(robot: &Robot, head: &[String]) -> ModelFile {
    let mut text = String::new();
    for line in head {
        text += format!("# {}", one_line(line)).trim_end();
        text += "\n";
    }
    text += &format!("name = {}\n", quoted(&robot.name));
    text += "gravity = [0.0, 0.0, -9.81]    # m/s², in the base frame: not from the URDF, which does not state it\n";
    if robot.links.iter().any(|link| matches!(link.kind, JointKind::Free | JointKind::Planar)) {
        text += "allow = [\"under-actuated\"]    # what floats has no actuator\n";
    }
    let mut lines = Vec::new();
    for link in &robot.links {
        text += "\n";
        lines.push(text.matches('\n').count() + 1);
        // Writing to a text cannot fail.
        let _ = write_link(&mut text, link, robot);
    }
    ModelFile { text, lines }
}

fn write_link(text: &mut String, link: &Link, robot: &Robot) -> std::fmt::Result {
    writeln!(text, "[[link]]")?;
    for remark in link.remarks.iter().chain(&link.comments) {
        writeln!(text, "# {}", one_line(remark))?;
    }
    writeln!(text, "name = {}", quoted(&link.name))?;
    writeln!(text, "joint_name = {}", quoted(&link.joint_name))?;
    writeln!(text, "parent = {}", quoted(link.parent.map_or("base", |parent| &robot.links[parent].name)))?;
    writeln!(text, "joint = \"{}\"", link.kind.name())?;
    writeln!(text, "origin = {}", origin(link.origin))?;
    if link.kind.has_axis() {
        writeln!(text, "axis = {}", vector(link.axis))?;
    }
    if let Some(far_end) = link.far_end {
        writeln!(text, "far_end = {}", origin(far_end))?;
    }
    if matches!(link.kind, JointKind::Free | JointKind::Planar) {
        writeln!(text, "actuated = false")?;
    }
    match (&link.mimic, link.limit.as_ref().map(range)) {
        (Some(mimic), _) => writeln!(text, "{}", mimic_entry(mimic))?,
        (None, Some(Ok(range))) => writeln!(text, "{range}")?,
        _ => {}
    }
    for (key, value) in ["damping", "friction"].into_iter().zip(link.resistance) {
        if value != 0.0 {
            writeln!(text, "{key} = {value:?}")?;
        }
    }
    writeln!(text, "mass = {:?}", link.inertial.mass + 0.0)?;
    if link.inertial.com.0 != [0.0; 3] {
        writeln!(text, "com = {}", vector(link.inertial.com.0))?;
    }
    if link.inertial.inertia != Sym3::zero() {
        writeln!(text, "inertia = {}", inertia(link.inertial.inertia))?;
    }
    Ok(())
}

/// An origin as models have it.
pub fn origin(Origin { xyz, rpy }: Origin) -> String {
    let xyz = (xyz != [0.0; 3]).then(|| format!("xyz = {}", vector(xyz)));
    let rpy = (rpy != [0.0; 3]).then(|| format!("rpy = [{}]", rpy.map(angle).join(", ")));
    let entries: Vec<String> = xyz.into_iter().chain(rpy).collect();
    if entries.is_empty() { "{}".into() } else { format!("{{ {} }}", entries.join(", ")) }
}

/// Quarter turns as what they are.
fn angle(radians: f64) -> String {
    let (sin, cos) = rotation::sin_cos(radians);
    if radians != 0.0 && (sin == 0.0 || cos == 0.0) {
        return format!("\"{} deg\"", (radians.to_degrees() / 90.0).round() * 90.0);
    }
    format!("{:?}", radians + 0.0)
}

/// Why limits are not a range.
pub struct Unfit(pub &'static str);

/// Limits as a range, which needs positions and a velocity.
pub fn range(limit: &Limit) -> Result<String, Unfit> {
    let Limit { lower, upper, effort, velocity, acceleration } = *limit;
    let positive = |x: f64| x.is_finite() && x > 0.0;
    if lower.is_finite() && upper.is_finite() && lower >= upper && (lower, upper) != (0.0, 0.0) {
        return Err(Unfit("the lower one is not below the upper"));
    }
    if effort < 0.0 || velocity < 0.0 || acceleration < 0.0 {
        return Err(Unfit("they are negative"));
    }
    if !(lower.is_finite() && upper.is_finite() && lower < upper && positive(velocity)) {
        return Err(Unfit("a `range` needs positions and a velocity"));
    }
    let entry = |key: &str, x: f64| if positive(x) { format!(", {key} = {x:?}") } else { String::new() };
    let (acceleration, force) = (entry("acceleration", acceleration), entry("force", effort));
    Ok(format!("range = {{ position = [{lower:?}, {upper:?}], velocity = {velocity:?}{acceleration}{force} }}"))
}

/// The entry `mimic` of a model.
fn mimic_entry(Mimic { joint, multiplier, offset }: &Mimic) -> String {
    let entry = |key: &str, value: f64, default: f64| match value == default {
        true => String::new(),
        false => format!(", {key} = {value:?}"),
    };
    let (multiplier, offset) = (entry("multiplier", *multiplier, 1.0), entry("offset", *offset, 0.0));
    format!("mimic = {{ joint = {}{multiplier}{offset} }}", quoted(joint))
}

/// A TOML string.
fn quoted(text: &str) -> String {
    toml::Value::String(text.into()).to_string()
}

/// A comment must not end before its line does.
fn one_line(text: &str) -> String {
    text.chars().flat_map(|c| if c.is_control() { c.escape_debug().collect() } else { vec![c] }).collect()
}
