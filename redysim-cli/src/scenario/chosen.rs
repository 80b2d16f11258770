//! Lists of joints, and of single velocities of joints that have several.

use std::ops::Range;

use redysim_toml::words::{did_you_mean, nearest, quoted};
use redysim_toml::{DeValue, Field, Key, KeyPath, Message, Reader};

use crate::layout::{Component, Layout};

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
            let velocities = named(reader, value.span(), &path, name, layout)?;
            if let Some(again) = velocities.clone().find(|velocity| found.contains(velocity)) {
                let title = match layout.joints.iter().any(|joint| joint.name == **name) && velocities.len() == 1 {
                    true => format!("{}: `{path}` names the joint `{name}` again", reader.item()),
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

/// The velocities that have the name, or whose joint has it.
fn named(
    reader: &mut Reader<'_, '_>,
    place: Range<usize>,
    path: &KeyPath,
    name: &str,
    layout: &Layout,
) -> Option<Range<usize>> {
    if let Some(joint) = layout.joints.iter().find(|joint| joint.name == name) {
        return Some(joint.v.clone());
    }
    if let Some(velocity) = layout.velocities.iter().position(|velocity| velocity.name == name) {
        return Some(velocity..velocity + 1);
    }
    if layout.coordinates.iter().any(|coordinate| coordinate.name == name) {
        return not_a(Wanted::Velocity, reader, place, path, name, layout);
    }
    let joints: Vec<&str> = layout.joints.iter().map(|joint| joint.name.as_str()).collect();
    let several: Vec<&Component> =
        layout.velocities.iter().filter(|velocity| layout.joints[velocity.joint].v.len() > 1).collect();
    let names = joints.iter().copied().chain(several.iter().map(|velocity| velocity.name.as_str()));
    let single = several.first().map_or(String::new(), |velocity| {
        format!("; a velocity of a joint that has several is named as {}", quoted(&velocity.name))
    });
    let help = format!("{}The joints are: {}{single}", did_you_mean(nearest(name, names)), joints.join(", "));
    let title = format!("{}: unknown joint {}", reader.item(), quoted(name));
    reader.error_at(place, Message { title, label: "unknown joint".into(), help })
}

/// What a name must be of.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    Coordinate,
    Velocity,
}

/// Reports a name of a velocity that is not a coordinate, or of a coordinate that is not a velocity: one of a joint with a
/// quaternion. Always `None`.
pub fn not_a<T>(
    wanted: Wanted,
    reader: &mut Reader<'_, '_>,
    place: Range<usize>,
    path: &KeyPath,
    name: &str,
    layout: &Layout,
) -> Option<T> {
    let (all, others) = match wanted {
        Wanted::Coordinate => (&layout.coordinates, &layout.velocities),
        Wanted::Velocity => (&layout.velocities, &layout.coordinates),
    };
    let joint = others.iter().find(|other| other.name == name)?.joint;
    let names: Vec<&str> = all.iter().filter(|own| own.joint == joint).map(|own| own.name.as_str()).collect();
    let joint = &layout.joints[joint].name;
    let (item, names) = (reader.item(), names.join(", "));
    let (title, help) = match wanted {
        Wanted::Coordinate => (
            format!(
                "{item}: `{path}` is for coordinates, but `{name}` is a velocity: the orientation of the joint `{joint}` \
                 is a quaternion"
            ),
            format!(
                "give the orientation as a whole, as in {joint} = {{ rpy = [0, \"10 deg\", 0] }}; the coordinates are {names}"
            ),
        ),
        Wanted::Velocity => (
            format!("{item}: `{path}` is for velocities, but `{name}` is a coordinate of the joint `{joint}`"),
            format!("its velocities are {names}"),
        ),
    };
    reader.error_at(place, Message { title, label: format!("not a {}", wanted.name()), help })
}

impl Wanted {
    fn name(self) -> &'static str {
        match self {
            Wanted::Coordinate => "coordinate",
            Wanted::Velocity => "velocity",
        }
    }
}
