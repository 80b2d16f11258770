//! Where an expression needs parentheses.

/// How tightly the surrounding expression binds; what binds less tightly gets parentheses.
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
        self <= surrounding && surrounding != Binding::Lowest
    }
}
