//! Frames of interest on links.

use super::tree;
use crate::model::Frame;
use crate::schema::{Document, FrameTable, keys};
use crate::spatial::Pose;
use redysim_toml::Findings;

/// The frames; `None` if one of them has a fault.
pub(super) fn frames(document: &Document, findings: &mut Findings) -> Option<Vec<Frame>> {
    // Collected in two steps, so that every frame is checked.
    let frames: Vec<_> = document.frames.iter().map(|table| frame(document, table, findings)).collect();
    frames.into_iter().collect()
}

fn frame(document: &Document, table: &FrameTable, findings: &mut Findings) -> Option<Frame> {
    let link = tree::carrier(document, &table.item, keys::FRAME_LINK.name, &table.link, findings);
    Some(Frame { name: table.name.value()?.clone(), link: link?, placement: table.origin.value_or(Pose::identity())? })
}
