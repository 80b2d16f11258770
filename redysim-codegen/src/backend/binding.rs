//! Where an expression needs parentheses.

/// How tightly an expression binds. An operand gets parentheses unless it binds more tightly than what surrounds it.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
pub enum Binding {
    Lowest,
    Sum,
    Product,
    Unary,
}

impl Binding {
    /// Whether an expression that binds like this needs parentheses in one that binds as `surrounding`.
    pub fn needs_parentheses(self, surrounding: Binding) -> bool {
        self <= surrounding
    }
}
