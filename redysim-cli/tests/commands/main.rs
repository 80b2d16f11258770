//! `redysim check`, `generate`, `import` and `new`, and every command of the documentation.

#[path = "../common/mod.rs"]
mod common;

mod check;
mod documented;
mod generate;
mod import;
mod new;
