//! Mechanisms from the text of their model files.

use super::traced::traced;
use redysim::Function;
use redysim::generic::{GenericMechanism, Model};
use redysim_model::Tree;

/// The mechanism, by the run-time path.
pub fn mechanism(text: &str) -> GenericMechanism {
    GenericMechanism::new(Model::from_toml(text, "test.toml").unwrap_or_else(|faults| panic!("{faults}")).model)
}

/// Flops of inverse dynamics, forward dynamics and the mass matrix.
pub fn flops(text: &str) -> [u32; 3] {
    let tree = Tree::new(&Model::from_toml(text, "test.toml").expect("a good model").model);
    let functions = [Function::InverseDynamics, Function::ForwardDynamics, Function::MassMatrix];
    let traced = traced(&tree, &functions);
    functions.map(|wanted| {
        traced.iter().find(|traced| traced.function == wanted).expect("a function").expressions.count().flops()
    })
}
