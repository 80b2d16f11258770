//! A `[[spring]]` table.

use super::item::item;
use super::keys;
use super::point::PointTable;
use redysim_toml::{Field, Findings, Reader, TableAt};
use std::ops::Range;

/// A `[[spring]]` table.
#[derive(Debug)]
pub(crate) struct SpringTable {
    /// What messages call the spring.
    pub(crate) item: String,
    /// The place of `[[spring]]`.
    pub(crate) header: Range<usize>,
    pub(crate) name: Field<String>,
    pub(crate) a: PointTable,
    pub(crate) b: PointTable,
    pub(crate) stiffness: Field<f64>,
    pub(crate) damping: Field<f64>,
    pub(crate) length: Field<f64>,
}

impl SpringTable {
    /// Reads the `number`-th spring of the file.
    pub(super) fn read(at: TableAt<'_>, number: usize, findings: &mut Findings) -> SpringTable {
        let item = item("spring", &at, number);
        let mut reader = Reader::new(at.table, at.header.clone(), &item, &keys::SPRING, findings);
        let stiffness = reader.number(&keys::SPRING_STIFFNESS);
        SpringTable {
            header: at.header,
            name: reader.text(&keys::NAME),
            a: PointTable::read(&mut reader, &keys::LINK_A, &keys::POINT_A),
            b: PointTable::read(&mut reader, &keys::LINK_B, &keys::POINT_B),
            damping: reader.number(&keys::SPRING_DAMPING),
            length: match stiffness.is_missing() {
                true => reader.number(&keys::LENGTH),
                false => reader.required(&keys::LENGTH, Reader::number),
            },
            stiffness,
            item,
        }
    }
}
