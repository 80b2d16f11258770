//! Lists of joints, and of single velocities of joints that have several.

use std::ops::Range;

use redysim_toml::words::{did_you_mean, nearest, quoted};
use redysim_toml::{DeValue, Field, Key, KeyPath, Message, Reader};

use crate::layout::{Component, Layout, StatePart};

/// Some of the velocities, by their names: that of a joint stands for all velocities of it.
pub fn chosen(reader: &mut Reader<'_, '_>, key: &Key, layout: &Layout) -> Field<Vec<usize>> {
    reader.field(key, |reader, path, value| {
        let array = reader.array(path, value, "an array of names of joints")?;
        let mut found = Vec::new();
        for (k, value) in array.iter().enumerate() {
            let path = path.element(k);
            let DeValue::String(name) = value.get_ref() else {
                return reader.wrong_type(&path, value, "the name of a joint");
            };
            let name = Name { text: name, place: value.span(), path: &path };
            let velocities = named(reader, &name, layout)?;
            if let Some(again) = velocities.clone().find(|velocity| found.contains(velocity)) {
                let title = match layout.joints.iter().any(|joint| joint.name == name.text) && velocities.len() == 1 {
                    true => format!("{}: `{path}` names the joint `{}` again", reader.item(), name.text),
                    false => format!("{}: `{path}` names `{}` again", reader.item(), layout.velocities[again].name),
                };
                let help = "name each joint or velocity once".into();
                return reader.error(value, Message { title, label: "named before".into(), help });
            }
            found.extend(velocities);
        }
        if found.is_empty() {
            let message = Message {
                title: format!("{}: `{path}` names no joint", reader.item()),
                label: "empty".into(),
                help: "name at least one, or leave the key out".into(),
            };
            return reader.error(value, message);
        }
        Some(found)
    })
}

/// A name in a scenario.
pub struct Name<'n> {
    pub text: &'n str,
    /// Where it stands.
    pub place: Range<usize>,
    /// The key that it belongs to.
    pub path: &'n KeyPath,
}

/// The velocities that have the name, or whose joint has it.
fn named(reader: &mut Reader<'_, '_>, name: &Name<'_>, layout: &Layout) -> Option<Range<usize>> {
    if let Some(velocities) = StatePart::Velocities.named(layout, name.text) {
        return Some(velocities);
    }
    if StatePart::Coordinates.named(layout, name.text).is_some() {
        return not_a(reader, StatePart::Velocities, name, layout);
    }
    let joints: Vec<&str> = layout.joints.iter().map(|joint| joint.name.as_str()).collect();
    let several: Vec<&Component> =
        layout.velocities.iter().filter(|velocity| layout.joints[velocity.joint].v.len() > 1).collect();
    let names = joints.iter().copied().chain(several.iter().map(|velocity| velocity.name.as_str()));
    let single = several.first().map_or(String::new(), |velocity| {
        format!("; a velocity of a joint that has several is named as {}", quoted(&velocity.name))
    });
    let help = format!("{}The joints are: {}{single}", did_you_mean(nearest(name.text, names)), joints.join(", "));
    let title = format!("{}: unknown joint {}", reader.item(), quoted(name.text));
    reader.error_at(name.place.clone(), Message { title, label: "unknown joint".into(), help })
}

/// Reports a name of a velocity where coordinates are `wanted`, or of a coordinate where velocities are: one of a joint with
/// a quaternion. Always `None`.
pub fn not_a<T>(reader: &mut Reader<'_, '_>, wanted: StatePart, name: &Name<'_>, layout: &Layout) -> Option<T> {
    let Name { text, place, path } = name;
    let found = wanted.other().named(layout, text)?.start;
    let joint = &layout.joints[wanted.other().components(layout)[found].joint];
    let names: Vec<&str> =
        wanted.components(layout)[wanted.of_joint(joint)].iter().map(|own| own.name.as_str()).collect();
    let (item, names, joint) = (reader.item(), names.join(", "), &joint.name);
    let (title, help, label) = match wanted {
        StatePart::Coordinates => (
            format!(
                "{item}: `{path}` is for coordinates, but `{text}` is a velocity: the orientation of the joint `{joint}` \
                 is a quaternion"
            ),
            format!(
                "give the orientation as a whole, as in {joint} = {{ rpy = [0, \"10 deg\", 0] }}; the coordinates are {names}"
            ),
            "not a coordinate",
        ),
        StatePart::Velocities => (
            format!("{item}: `{path}` is for velocities, but `{text}` is a coordinate of the joint `{joint}`"),
            format!("its velocities are {names}"),
            "not a velocity",
        ),
    };
    reader.error_at(place.clone(), Message { title, label: label.into(), help })
}
