//! How many operations a generated function takes.

/// Operations of one generated function. Unary minus is free.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OperationCount {
    /// Additions and subtractions.
    pub additions: u32,
    /// Multiplications.
    pub multiplications: u32,
    /// Divisions.
    pub divisions: u32,
    /// Pairs of one sine and one cosine of the same angle.
    pub trig: u32,
}

impl OperationCount {
    /// No operations.
    pub const NONE: OperationCount = OperationCount { additions: 0, multiplications: 0, divisions: 0, trig: 0 };

    /// Additions, subtractions, multiplications and divisions together.
    ///
    /// ```
    /// let count = redysim_runtime::OperationCount { additions: 3, multiplications: 4, divisions: 1, trig: 2 };
    /// assert_eq!(count.flops(), 8);
    /// ```
    pub const fn flops(&self) -> u32 {
        self.additions + self.multiplications + self.divisions
    }
}
