//! Messages about joints that mimic others.

use super::message;
use crate::model::JointKind;
use crate::schema::keys;
use redysim_toml::Message;
use redysim_toml::words::{did_you_mean, nearest, quoted, shortened};

const NAME: &str = keys::MIMIC.name;

pub(crate) fn mimic_of_joint_without_one_coordinate(item: &str, kind: JointKind) -> Message {
    message(
        format!("{item}: `{NAME}` belongs to a joint of one coordinate, but its joint is {}", kind.name()),
        "the joint does not have one coordinate",
        format!("delete `{NAME}`, or choose revolute, prismatic or helical as `{}`", keys::JOINT.name),
    )
}

pub(crate) fn unknown_mimicked(item: &str, name: &str, joints: &[&str]) -> Message {
    let meant = did_you_mean(nearest(name, joints.iter().copied()));
    message(
        format!("{item}: `{NAME}` names {}, which is an unknown joint", quoted(name)),
        "unknown joint",
        format!("{meant}The joints with one coordinate are: {}", shortened(joints)),
    )
}

pub(crate) fn mimicked_without_one_coordinate(item: &str, name: &str, kind: JointKind) -> Message {
    message(
        format!("{item}: `{NAME}` names {}, whose joint is {}", quoted(name), kind.name()),
        "the joint does not have one coordinate",
        "a joint mimics a revolute, prismatic or helical joint",
    )
}

pub(crate) fn mimics_itself(item: &str, names: &[&str]) -> Message {
    let path: Vec<_> = names.iter().map(|name| quoted(name)).collect();
    message(
        format!("{item}: `{NAME}` leads back to its own joint: {}", path.join(" -> ")),
        "leads back to this joint",
        format!("delete `{NAME}` of the joint that moves by itself"),
    )
}

pub(crate) fn zero_multiplier(item: &str) -> Message {
    let multiplier = keys::MULTIPLIER.name;
    message(
        format!("{item}: `{NAME}.{multiplier}` is 0.0, so the joint would not move"),
        "zero",
        format!("give another `{multiplier}`, or choose fixed as `{}`", keys::JOINT.name),
    )
}

pub(crate) fn beside_mimic(item: &str, key: &str) -> Message {
    message(
        format!("{item}: has `{key}` beside `{NAME}`"),
        "the joint follows another",
        format!("delete `{key}`: that of the joint which is mimicked holds"),
    )
}
