//! The subcommands, a file each: what they take, and what they do.

pub mod animate;
pub mod check;
pub mod completions;
pub mod forward;
pub mod generate;
pub mod import;
pub mod inverse;
pub mod new;
pub mod plot;
pub mod show;
