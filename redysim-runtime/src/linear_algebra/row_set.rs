//! A set of rows of a Jacobian.

use core::fmt;

/// Some of the first 128 rows of a Jacobian, such as that of the loop residual; rows beyond are not recorded.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RowSet(u128);

impl RowSet {
    /// The set with one more row.
    #[must_use]
    pub fn with(self, row: usize) -> Self {
        let bit = u32::try_from(row).ok().and_then(|row| 1_u128.checked_shl(row)).unwrap_or(0);
        RowSet(self.0 | bit)
    }

    /// Whether there are no rows in it.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The rows, in order.
    pub fn iter(self) -> impl Iterator<Item = usize> {
        (0..128).filter(move |row| self.0 >> row & 1 == 1)
    }
}

/// The rows, with commas between them.
impl fmt::Display for RowSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, row) in self.iter().enumerate() {
            write!(f, "{}{row}", if index == 0 { "" } else { ", " })?;
        }
        Ok(())
    }
}
