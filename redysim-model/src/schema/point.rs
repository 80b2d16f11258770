//! A point on a link, by the keys `link_a` and `point_a`, or `link_b` and `point_b`.

use redysim_toml::{Field, Key, Reader};

/// A point on a link.
#[derive(Debug)]
pub(crate) struct PointTable {
    /// The key of the link, `link_a` or `link_b`.
    pub(crate) link_key: &'static str,
    pub(crate) link: Field<String>,
    pub(crate) point: Field<[f64; 3]>,
}

impl PointTable {
    pub(super) fn read(reader: &mut Reader<'_, '_>, link: &Key, point: &Key) -> PointTable {
        PointTable { link_key: link.name, link: reader.required(link, Reader::text), point: reader.vector(point) }
    }
}
