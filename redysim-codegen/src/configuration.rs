//! How coordinates move with velocities: the functions of `ConfigurationSpace`, which every mechanism has.

use crate::angles::Angles;
use crate::program::{NamingContext, Program, program};
use crate::symbol::Symbol;
use crate::tracing::traced_of;
use redysim_model::{PublicInterface, Tree, denoc};
use redysim_runtime::function::Dimension;

/// A function over coordinates and velocities.
pub struct ConfigurationFunction {
    /// Its name.
    pub name: &'static str,
    /// Its arguments: their names and lengths.
    pub arguments: &'static [(&'static str, Dimension)],
    /// The length of its result.
    pub result: Dimension,
    computed: for<'g> fn(&Tree, &[&[Symbol<'g>]]) -> Vec<Symbol<'g>>,
}

/// All of them.
pub const CONFIGURATION_FUNCTIONS: [ConfigurationFunction; 4] = [
    ConfigurationFunction {
        name: "coordinate_rates",
        arguments: &[("q", Dimension::Coordinates), ("v", Dimension::Velocities)],
        result: Dimension::Coordinates,
        computed: |tree, x| denoc::coordinate_rates(tree, x[0], x[1]),
    },
    ConfigurationFunction {
        name: "integrate",
        arguments: &[("q", Dimension::Coordinates), ("dv", Dimension::Velocities)],
        result: Dimension::Coordinates,
        computed: |tree, x| denoc::integrate(tree, x[0], x[1]),
    },
    ConfigurationFunction {
        name: "difference",
        arguments: &[("q0", Dimension::Coordinates), ("q1", Dimension::Coordinates)],
        result: Dimension::Velocities,
        computed: |tree, x| denoc::difference(tree, x[0], x[1]),
    },
    ConfigurationFunction {
        name: "neutral",
        arguments: &[],
        result: Dimension::Coordinates,
        computed: |tree, _| denoc::neutral(tree),
    },
];

impl ConfigurationFunction {
    /// The names of its arguments.
    pub fn argument_names(&self) -> Vec<&'static str> {
        self.arguments.iter().map(|&(argument, _)| argument).collect()
    }

    /// Its program. No variable has a name in `reserved`.
    pub fn program(&self, tree: &Tree, interface: &PublicInterface, reserved: &[&str]) -> Program {
        let lengths = self.arguments.iter().map(|&(_, dimension)| interface.size(dimension));
        let expressions = traced_of(lengths, |_, x| (self.computed)(tree, x));
        let reserved = [&self.argument_names(), reserved].concat();
        let angles = Angles::of([&expressions]);
        program(&expressions, &NamingContext { reserved: &reserved, bodies: &[], angles: &angles })
    }
}
