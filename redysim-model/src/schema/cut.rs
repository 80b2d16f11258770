//! A `[[loop]]` table.

use super::reader::{Reader, Shape};
use super::{Field, Table, item};
use crate::diagnostic::Findings;
use crate::model::CutKind;

/// What a `[[loop]]` table says.
#[derive(Debug)]
pub(crate) struct LoopTable {
    /// What messages call the loop.
    pub(crate) item: String,
    pub(crate) name: Field<String>,
    pub(crate) joint: Field<CutKind>,
    pub(crate) a: CutSideTable,
    pub(crate) b: CutSideTable,
}

/// What a `[[loop]]` table says about one side of the cut.
#[derive(Debug)]
pub(crate) struct CutSideTable {
    /// The key of the link, `link_a` or `link_b`.
    pub(crate) link_key: &'static str,
    /// The key of the axis, `axis_a` or `axis_b`.
    pub(crate) axis_key: &'static str,
    pub(crate) link: Field<String>,
    pub(crate) point: Field<[f64; 3]>,
    pub(crate) axis: Field<[f64; 3]>,
}

const LOOP: Shape =
    Shape { owner: "A loop", keys: &["name", "joint", "link_a", "point_a", "axis_a", "link_b", "point_b", "axis_b"] };

impl LoopTable {
    /// Reads the `number`-th loop of the file.
    pub(super) fn read((table, header): Table<'_>, number: usize, findings: &mut Findings) -> LoopTable {
        let item = item("loop", table, number);
        let mut reader = Reader::new(table, header, &item, &LOOP, findings);
        let name = reader.text("name");
        let joint = reader.choice("joint", &CutKind::ALL, &[]);
        LoopTable {
            name: reader.required("name", name),
            joint: reader.required("joint", joint),
            a: side(&mut reader, "link_a", "point_a", "axis_a"),
            b: side(&mut reader, "link_b", "point_b", "axis_b"),
            item,
        }
    }
}

fn side(
    reader: &mut Reader<'_, '_>,
    link_key: &'static str,
    point_key: &'static str,
    axis_key: &'static str,
) -> CutSideTable {
    let link = reader.text(link_key);
    CutSideTable {
        link_key,
        axis_key,
        link: reader.required(link_key, link),
        point: reader.vector(point_key),
        axis: reader.vector(axis_key),
    }
}
