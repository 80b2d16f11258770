//! Languages that a mechanism is written in.

mod binding;
#[cfg(feature = "source")]
pub mod c;
#[cfg(feature = "source")]
pub mod head;
#[cfg(feature = "source")]
mod lines;
pub mod rust;
