//! The crates as cargo and other programs build them: without `std`, after a change of a model, and from packages.

mod no_std;
mod packages;
mod rebuild;
