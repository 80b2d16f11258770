//! The recursions for `f64`, compiled with this crate.
//!
//! A crate that is hardly optimised takes the instance of a generic function from a crate below it that has one. So the
//! command and the tests neither compile the recursions of a [`GenericMechanism`](crate::GenericMechanism) once more, nor
//! run them unoptimised. An optimised crate compiles its own.

use super::{Untraced, evaluate};
use crate::tree::Tree;
use redysim_runtime::Function;

type Evaluation = fn(Function, &Tree, &Untraced, &[&[f64]]) -> Vec<f64>;

#[used]
static OF_EVERY_FUNCTION: Evaluation = evaluate;
