//! What the tests share.
#![allow(dead_code, unused_imports, reason = "each test uses a part")]

pub mod andrews;
pub mod call;
pub mod chains;
pub mod comparison;
pub use redysim_codegen::accuracy::double_double;
pub mod dual;
pub mod elliptic;
pub mod kane;
pub mod kane_loops;
pub mod methods;
#[cfg(feature = "generic")]
pub mod models;
pub mod quadrature;
pub mod random;
pub mod styles;
#[cfg(feature = "generic")]
pub mod text;
pub mod tools;
pub mod traced;
