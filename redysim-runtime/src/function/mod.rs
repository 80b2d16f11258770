//! What the functions of a mechanism take and return: one table, which code generation, the macro, the command and
//! documentation read.
//!
//! [`Function`](crate::Function) is a function, [`Functions`](crate::Functions) a set of them, and
//! [`Operations`](crate::Operations) what each costs.

mod form;
#[cfg(feature = "serde")]
mod serde;
pub(crate) mod set;
mod signature;
pub(crate) mod table;

pub use form::{Field, Form, Length, Structure};
pub use signature::{Argument, Dimension, Interface, Shape, Signature};
pub use table::UnknownFunction;
