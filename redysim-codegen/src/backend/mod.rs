//! Languages that a mechanism is written in.

pub mod rust;
