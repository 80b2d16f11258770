//! Sine and cosine without panics, of one angle or of several at once, the same bits either way.
//!
//! `double` and `single` are the kernels, written once over any number of lanes (`angle`); `fast_path` decides whether their
//! own reduction is accurate enough, and `reduction` is that of the few other angles; `several` spreads a list of angles over
//! lanes.
//!
//! Errors stay below 1 unit in the last place for every finite angle; non-finite angles give NaN.

pub(crate) mod angle;
pub mod double;
pub mod fast_path;
#[cfg(feature = "lanes")]
pub mod in_turn;
#[cfg(feature = "lanes")]
pub mod lists;
pub(crate) mod reduction;
#[cfg(feature = "lanes")]
pub(crate) mod several;
pub mod single;
mod single_reduction;
pub mod turns;
pub mod unfused;
