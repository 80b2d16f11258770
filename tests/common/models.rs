//! The mechanisms that tests run on, generic. To compile one takes half a second in each program: `robots.rs` has those that
//! the tests of several modules compile.

use redysim::generic::{GenericMechanism, Model};

/// The mechanism of `models/<name>.toml` on the generic path.
pub fn generic(name: &str) -> GenericMechanism {
    let path = format!("{}/models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    GenericMechanism::new(Model::load(path).expect("a good model").model)
}
