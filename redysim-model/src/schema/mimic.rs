//! Joints that mimic others, by name.

use super::link::LinkTable;
use crate::lock::by_name;
use redysim_toml::Spanned;

/// The link whose joint has this name, or else which has it itself.
pub(crate) fn mimicked(links: &[LinkTable], name: &str) -> Option<usize> {
    let names = links.iter().map(|link| {
        let joint = link.joint_name().map(|name| name.get_ref().as_str());
        (joint, link.name.value().map(String::as_str))
    });
    by_name(name, names)
}

/// Locks the joints that mimic a locked joint, where they are then.
pub(super) fn lock(links: &mut [LinkTable]) {
    let mut left = links.len();
    while left > 0 {
        let held = (0..links.len()).find_map(|index| {
            let link = links.get(index).filter(|link| link.locked.is_none())?;
            let mimic = link.mimic.value()?;
            let followed = mimicked(links, mimic.joint.as_ref().map(Spanned::get_ref)?)?;
            match links[followed].locked.as_deref() {
                Some([value]) => Some((index, mimic.multiplier * value + mimic.offset)),
                _ => None,
            }
        });
        let Some((index, value)) = held else { return };
        links[index].locked = Some(vec![value]);
        left -= 1;
    }
}
