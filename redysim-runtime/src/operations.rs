//! How many operations a generated function takes.

/// Operations of one generated function. Unary minus is free.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
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

/// Operations of all generated functions of one mechanism; zero for what it does not have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Of `inverse_dynamics`.
    pub inverse_dynamics: OperationCount,
    /// Of `forward_dynamics`.
    pub forward_dynamics: OperationCount,
    /// Of `mass_matrix`.
    pub mass_matrix: OperationCount,
    /// Of `bias_forces`.
    pub bias_forces: OperationCount,
    /// Of `gravity_forces`.
    pub gravity_forces: OperationCount,
    /// Of `energy`.
    pub energy: OperationCount,
    /// Of `link_kinematics`.
    pub link_kinematics: OperationCount,
    /// Of `loop_residual`.
    pub loop_residual: OperationCount,
    /// Of `loop_jacobian`.
    pub loop_jacobian: OperationCount,
    /// Of `loop_bias`.
    pub loop_bias: OperationCount,
}

impl Operations {
    /// No operations.
    pub const NONE: Operations = Operations {
        inverse_dynamics: OperationCount::NONE,
        forward_dynamics: OperationCount::NONE,
        mass_matrix: OperationCount::NONE,
        bias_forces: OperationCount::NONE,
        gravity_forces: OperationCount::NONE,
        energy: OperationCount::NONE,
        link_kinematics: OperationCount::NONE,
        loop_residual: OperationCount::NONE,
        loop_jacobian: OperationCount::NONE,
        loop_bias: OperationCount::NONE,
    };
}
