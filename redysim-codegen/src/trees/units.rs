//! The choice of the unit of length: the constant with the most products becomes 1.

use crate::expressions::Expressions;
use crate::graph::Node;
use redysim_model::Tree;
use redysim_model::parameter::Parameter;
use redysim_model::scaling::in_unit;
use std::collections::HashMap;

/// The tree in the unit of length that saves most products of `expressions`, which were traced on it; unchanged if none
/// saves any.
pub fn chosen<P: Parameter>(tree: &Tree<P>, expressions: &Expressions) -> Tree<P> {
    let products = products(expressions);
    let saved = |constant: f64| products.get(&key(constant)).copied().unwrap_or(0);
    let mut best = (0, 1.0);
    let mut consider = |constant: f64, unit: f64| {
        if constant != 0.0 && saved(constant) > best.0 {
            best = (saved(constant), unit);
        }
    };
    for body in &tree.bodies {
        body.placement.position.0.into_iter().for_each(|length| consider(length, length.abs()));
        let moments = body.inertia.moment.0.into_iter().filter_map(Parameter::number);
        moments.for_each(|moment| consider(moment, 1.0 / moment.abs()));
        if let Some(mass) = body.inertia.mass.number() {
            consider(mass, 1.0 / mass.abs().sqrt());
        }
    }
    let (_, unit) = best;
    if unit == 1.0 { tree.clone() } else { in_unit(tree, unit).unwrap_or_else(|| tree.clone()) }
}

/// A key that is equal for constants that differ by roundoff only.
fn key(constant: f64) -> u64 {
    (constant.abs().to_bits() + 16) >> 5
}

/// How many products have each constant.
fn products(expressions: &Expressions) -> HashMap<u64, usize> {
    let graph = &expressions.graph;
    let mut products = HashMap::new();
    for (index, uses) in expressions.uses().into_iter().enumerate() {
        if let Node::Multiply(factor, _) = graph.node(index)
            && let Node::Constant(bits) = graph.node(factor.node())
            && uses > 0
        {
            *products.entry(key(f64::from_bits(bits))).or_default() += 1;
        }
    }
    products
}
