//! The space in which some of a mechanism's joints move, or single velocities of them.

use std::ops::Range;

use redysim_model::spatial::Vec3;
use redysim_model::{GenericMechanism, JointKind, Link, Model};
use redysim_toml::{Message, Reader};

use crate::layout::Layout;

/// `velocities` without those of joints with a quaternion of which they have only a part.
pub fn whole_orientations(layout: &Layout, mut velocities: Vec<usize>) -> Vec<usize> {
    while let Some(part) = layout.part_of_quaternion(&velocities) {
        velocities.retain(|velocity| !layout.joint_of(part).v.contains(velocity));
    }
    velocities
}

/// The space of the positions along `velocities`, in this order: joints on the base, each by itself. A component of a joint in
/// series is a joint with one degree of freedom.
pub fn alone(layout: &Layout, velocities: &[usize]) -> GenericMechanism {
    let kind = |&velocity: &usize| {
        let joint = layout.joint_of(velocity);
        if !joint.is_in_space() {
            let turns = layout.velocities[velocity].turns();
            return Some(if turns { JointKind::Revolute } else { JointKind::Prismatic });
        }
        let whole = if joint.v.len() > 3 { JointKind::Free } else { JointKind::Spherical };
        (velocity == joint.v.start).then_some(whole)
    };
    let links = velocities.iter().filter_map(kind).map(|kind| Link::new("alone", None, kind)).collect();
    GenericMechanism::new(Model { links, ..Model::new("alone", Vec3::zero()) })
}

/// Reports a motion of a joint with a quaternion that is not one of all its velocities. Always `None`.
pub fn part_of_quaternion<T>(
    reader: &mut Reader<'_, '_>,
    named: Option<Range<usize>>,
    layout: &Layout,
    velocity: usize,
) -> Option<T> {
    let (name, joint) = (&layout.velocities[velocity].name, &layout.joint_of(velocity).name);
    let title = format!(
        "{}: the trajectory prescribes `{name}`, but the orientation of the joint `{joint}` is a quaternion, which moves as a \
         whole",
        reader.item()
    );
    let help = format!(
        "name the joint `{joint}` among the `joints`; components of an orientation in Euler angles (`coordinates` in the model) can be \
         prescribed alone"
    );
    let message = Message { title, label: "a part of an orientation".into(), help };
    match named {
        Some(place) => reader.error_at(place, message),
        None => reader.error_of_table(message),
    }
}
