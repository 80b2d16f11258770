//! What a model has no place for, as comments beside its link: names and digits of the URDF, with units.

use std::collections::HashMap;

use roxmltree::Node;

use redysim_model::JointKind;

use super::document::{Document, child};
use super::model_file::{Unfit, range};
use super::robot::{Link, Robot, has_one_damping};
use crate::number::counted;

/// Units of what URDF gives joints, where they turn and where they slide.
const UNITS: [(&str, [&str; 2]); 15] = [
    ("lower", ["rad", "m"]),
    ("upper", ["rad", "m"]),
    ("velocity", ["rad/s", "m/s"]),
    ("acceleration", ["rad/s²", "m/s²"]),
    ("deceleration", ["rad/s²", "m/s²"]),
    ("jerk", ["rad/s³", "m/s³"]),
    ("effort", ["N m", "N"]),
    ("damping", ["N m s/rad", "N s/m"]),
    ("friction", ["N m", "N"]),
    ("rising", ["rad", "m"]),
    ("falling", ["rad", "m"]),
    ("soft_lower_limit", ["rad", "m"]),
    ("soft_upper_limit", ["rad", "m"]),
    ("k_position", ["1/s", "1/s"]),
    ("k_velocity", ["N m s/rad", "N s/m"]),
];

/// Pictures and shapes: a model is of dynamics alone.
const SHAPES: [&str; 2] = ["visual", "collision"];

impl Robot {
    /// Adds to each link the numbers that its joint, the link, and elements that refer to either have in the URDF, and
    /// the model has not.
    pub fn with_comments(mut self, document: &Document) -> Self {
        let mut beside: HashMap<String, Vec<String>> = HashMap::new();
        let mut unread = document.unread();
        unread.retain(|node| !is_limit(*node));
        unread.sort_by_key(|node| node.range().start);
        for node in unread {
            for joint in carriers(document, node) {
                let comments = beside.entry(joint.attribute("name").unwrap_or_default().into()).or_default();
                comments.extend(comment(node, joint));
            }
        }
        for link in &mut self.links {
            let Some(joint) = document.joint(&link.joint_name) else { continue };
            link.comments = of_joint(joint, link);
            link.comments.extend(beside.remove(&link.joint_name).unwrap_or_default());
        }
        let count = self.links.iter().map(|link| link.comments.len()).sum::<usize>();
        if count > 0 {
            let lines = counted(count, "line");
            self.notes.push(format!("numbers without a key in the model are kept as comments: {lines}"));
        }
        self
    }
}

/// Whether an element that nothing is read of is kept as a comment.
pub fn is_kept(document: &Document, node: Node) -> bool {
    let is_beside = |joint: Node| !(is_limit(node) && is_fixed(joint)) && comment(node, joint).is_some();
    carriers(document, node).into_iter().any(is_beside)
}

/// What of axis, limits and dynamics is not in the model: of a joint that is fixed in the URDF, which has no use for them, what
/// is not zero of limits and dynamics.
fn of_joint(joint: Node, link: &Link) -> Vec<String> {
    if is_fixed(joint) {
        let kept = |tag: &str| {
            let node = child(joint, tag)?;
            let tells = node.attributes().any(|number| number.value().parse().is_ok_and(|number: f64| number != 0.0));
            tells.then(|| format!("{tag}: {}; the joint is fixed", own_values(node, joint, &|_| false).join(", ")))
        };
        return ["limit", "dynamics"].into_iter().filter_map(kept).collect();
    }
    let moves = link.kind.has_axis() || link.kind == JointKind::Planar;
    let mut comments = Vec::new();
    let mut keep = |tag: &str, is_written: &dyn Fn(&str) -> bool, why: &str| {
        let Some(node) = child(joint, tag) else { return };
        let values = own_values(node, joint, is_written);
        if !values.is_empty() {
            comments.push(format!("{tag}: {}{why}", values.join(", ")));
        }
    };
    keep("axis", &|_| moves, "");
    match (&link.limit, link.limit.as_ref().map(range)) {
        (Some(limit), Some(Ok(_))) if link.mimic.is_none() => {
            let positive = |x: f64| x.is_finite() && x > 0.0;
            let is_written = |name: &str| match name {
                "lower" | "upper" | "velocity" => true,
                "effort" => positive(limit.effort),
                "acceleration" => positive(limit.acceleration),
                _ => false,
            };
            keep("limit", &is_written, "");
        }
        _ if link.mimic.is_some() => keep("limit", &|_| false, "; the range of the joint that it mimics holds"),
        (_, Some(Err(Unfit(why)))) => keep("limit", &|_| false, &format!("; {why}")),
        _ if moves => keep("limit", &|_| false, "; a `range` needs a velocity"),
        _ => keep("limit", &|_| false, ""),
    }
    match has_one_damping(link.kind) {
        true => keep("dynamics", &|name| ["damping", "friction"].contains(&name), ""),
        false if link.kind.dof() > 1 => {
            keep("dynamics", &|_| false, "; `damping` and `friction` of this joint are arrays")
        }
        false => keep("dynamics", &|_| false, ""),
    }
    comments
}

fn is_fixed(joint: Node) -> bool {
    joint.attribute("type") == Some("fixed")
}

fn is_limit(node: Node) -> bool {
    node.tag_name().name() == "limit" && node.parent().is_some_and(|owner| owner.tag_name().name() == "joint")
}

/// The numbers of a transmission of joints that the robot does not have.
pub fn of_no_joint(node: Node) -> Option<String> {
    (node.tag_name().name() == "transmission").then(|| comment(node, node))?
}

/// The joints beside which an element stands: its own, that of its link, or those that it names.
fn carriers<'n, 'a>(document: &'n Document<'a>, node: Node<'n, 'a>) -> Vec<Node<'n, 'a>> {
    let Some(owner) = node.parent() else { return Vec::new() };
    let carries = |link: &str| document.joints().find(|joint| of_link(*joint) == Some(link));
    match (owner.tag_name().name(), node.tag_name().name()) {
        ("joint", _) => vec![owner],
        (_, tag) if SHAPES.contains(&tag) => Vec::new(),
        ("link", _) => owner.attribute("name").and_then(carries).into_iter().collect(),
        ("inertial", _) => {
            owner.parent().and_then(|link| link.attribute("name")).and_then(carries).into_iter().collect()
        }
        ("robot", _) => {
            let reference = node.attribute("reference");
            let by_reference = reference.and_then(|name| document.joint(name).or_else(|| carries(name)));
            let joints = node.descendants().filter(|inner| inner.tag_name().name() == "joint");
            let by_name = joints.filter_map(|inner| document.joint(inner.attribute("name")?));
            by_reference.into_iter().chain(by_name).collect()
        }
        _ => Vec::new(),
    }
}

/// The link that a joint carries.
fn of_link<'n>(joint: Node<'n, '_>) -> Option<&'n str> {
    child(joint, "child")?.attribute("link")
}

/// The numbers of an element and of what is inside: `transmission `t`: motor.mechanicalReduction = 100`.
fn comment(node: Node, joint: Node) -> Option<String> {
    let mut values = own_values(node, joint, &|_| false);
    let inside = node.descendants().skip(1).filter(Node::is_element);
    for inner in inside {
        let owner = inner.parent().filter(|parent| *parent != node).and_then(|parent| parent.attribute("name"));
        let owner = owner.map_or(String::new(), |name| format!("{name}."));
        let text = inner.text().map(str::trim).filter(|text| is_number(text));
        values.extend(text.map(|text| format!("{owner}{} = {text}", inner.tag_name().name())));
        let tag = inner.tag_name().name();
        values.extend(own_values(inner, joint, &|_| false).iter().map(|value| format!("{owner}{tag}.{value}")));
    }
    let name = node.attribute("name").map_or(String::new(), |name| format!(" `{name}`"));
    let rotor = values.iter().any(|value| value.contains("mechanicalReduction"));
    let rotor = if rotor { "; `armature` = rotor inertia × mechanicalReduction²" } else { "" };
    (!values.is_empty()).then(|| format!("{}{name}: {}{rotor}", node.tag_name().name(), values.join(", ")))
}

/// The attributes of an element that are numbers, but for what is written elsewhere.
fn own_values(node: Node, joint: Node, is_written: &dyn Fn(&str) -> bool) -> Vec<String> {
    let side = match joint.attribute("type") {
        Some("revolute" | "continuous") => Some(0),
        Some("prismatic") => Some(1),
        _ => None,
    };
    let with_unit = |name: &str, value: &str| {
        let unit = UNITS.iter().find(|(named, _)| *named == name).zip(side).map(|((_, units), side)| units[side]);
        let words = value.split_whitespace().collect::<Vec<_>>();
        let value = if words.len() == 1 { words[0].into() } else { format!("[{}]", words.join(", ")) };
        unit.map_or(format!("{name} = {value}"), |unit| format!("{name} = {value} {unit}"))
    };
    let numbers = node.attributes().filter(|attribute| is_number(attribute.value()) && !is_written(attribute.name()));
    numbers.map(|attribute| with_unit(attribute.name(), attribute.value())).collect()
}

/// Whether a text is a number, or several.
fn is_number(text: &str) -> bool {
    !text.trim().is_empty() && text.split_whitespace().all(|word| word.parse::<f64>().is_ok())
}
