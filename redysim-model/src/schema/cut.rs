//! A `[[loop]]` table.

use super::item::item;
use super::keys;
use super::point::PointTable;
use crate::model::CutKind;
use redysim_toml::{Field, Findings, Key, Reader, TableAt};

/// A `[[loop]]` table.
#[derive(Debug)]
pub(crate) struct LoopTable {
    /// What messages call the loop.
    pub(crate) item: String,
    pub(crate) name: Field<String>,
    pub(crate) joint: Field<CutKind>,
    pub(crate) a: CutSideTable,
    pub(crate) b: CutSideTable,
}

/// One side of the cut.
#[derive(Debug)]
pub(crate) struct CutSideTable {
    pub(crate) at: PointTable,
    /// The key of the axis, `axis_a` or `axis_b`.
    pub(crate) axis_key: &'static str,
    pub(crate) axis: Field<[f64; 3]>,
}

impl LoopTable {
    /// Reads the `number`-th loop of the file.
    pub(super) fn read(at: TableAt<'_>, number: usize, findings: &mut Findings) -> LoopTable {
        let item = item("loop", &at, number);
        let mut reader = Reader::new(at.table, at.header, &item, &keys::LOOP, findings);
        LoopTable {
            name: reader.required(&keys::NAME, Reader::text),
            joint: reader.required(&keys::CUT_JOINT, |reader, key| reader.choice(key, &CutKind::ALL)),
            a: side(&mut reader, [&keys::LINK_A, &keys::POINT_A, &keys::AXIS_A]),
            b: side(&mut reader, [&keys::LINK_B, &keys::POINT_B, &keys::AXIS_B]),
            item,
        }
    }
}

fn side(reader: &mut Reader<'_, '_>, [link, point, axis]: [&Key; 3]) -> CutSideTable {
    CutSideTable { at: PointTable::read(reader, link, point), axis_key: axis.name, axis: reader.vector(axis) }
}
