//! `redysim check`, `generate`, `import`, `new` and `sweep`, and every command of the documentation.

#[path = "../common/mod.rs"]
mod common;

mod check;
mod documented;
mod generate;
mod import;
mod new;
mod ros2;
mod sweep;
