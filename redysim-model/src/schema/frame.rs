//! A `[[frame]]` table.

use super::item::item;
use super::keys;
use super::origin::origin;
use crate::spatial::Pose;
use redysim_toml::{Field, Findings, Reader, TableAt};

/// A `[[frame]]` table.
#[derive(Debug)]
pub(crate) struct FrameTable {
    /// What messages call the frame.
    pub(crate) item: String,
    pub(crate) name: Field<String>,
    pub(crate) link: Field<String>,
    pub(crate) origin: Field<Pose<f64>>,
}

impl FrameTable {
    /// Reads the `number`-th frame of the file.
    pub(super) fn read(at: TableAt<'_>, number: usize, findings: &mut Findings) -> FrameTable {
        let item = item("frame", &at, number);
        let mut reader = Reader::new(at.table, at.header, &item, &keys::FRAME, findings);
        FrameTable {
            name: reader.required(&keys::NAME, Reader::text),
            link: reader.required(&keys::FRAME_LINK, Reader::text),
            origin: reader.table(&keys::FRAME_ORIGIN, origin),
            item,
        }
    }
}
