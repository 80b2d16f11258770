//! One sweep over uniform bodies as a loop.

use super::build::Builder;
use super::names::carried;
use super::{Carried, LiveOutArray, Loop, LoopRead, Scope, Statement, Value};
use crate::reroll::{Rerolled, Sweep};

impl Builder<'_> {
    /// The loop for sweep number `number`.
    pub fn sweep(&self, number: usize) -> Loop {
        let rerolled = self.rerolled.as_ref().expect("only rerolled functions have sweeps");
        let sweep = &rerolled.sweeps[number];
        let name = |node: usize| self.variables[node].as_deref();
        let carried_on = sweep.carried.iter().filter_map(|&(node, start)| {
            let next = name(node)?;
            let start = start.map_or(Value::Constant(0.0), |start| self.value(start, Scope::Outside));
            Some(Carried { name: carried(next), start, next: next.to_string() })
        });
        let definition = |&node: &usize| Some(self.definition(node, name(node)?, Scope::Sweep(number)));
        let body: Vec<Statement> = sweep.template.iter().filter_map(definition).collect();
        let columns: Vec<String> = sweep.live_out.iter().filter_map(|&node| Some(name(node)?.to_string())).collect();
        Loop {
            groups: rerolled.groups,
            ascending: sweep.ascending,
            carried: carried_on.collect(),
            live_out: (!columns.is_empty()).then(|| LiveOutArray { name: self.arrays[number].clone(), columns }),
            constants: rows(sweep, rerolled.groups),
            reads: self.reads_of_other_loops(rerolled, number),
            body,
        }
    }

    /// The live-out values of earlier loops that this loop reads for the same group.
    fn reads_of_other_loops(&self, rerolled: &Rerolled, number: usize) -> Vec<LoopRead> {
        let template = &rerolled.sweeps[number].template;
        let is_read = |node: usize| {
            template.iter().any(|&user| self.graph.node(user).operands().any(|operand| operand.node() == node))
        };
        let reads = rerolled.sweeps[..number].iter().zip(&self.arrays).map(|(other, array)| {
            let names = other.live_out.iter().map(|&node| self.variables[node].clone().filter(|_| is_read(node)));
            LoopRead { array: array.clone(), names: names.collect() }
        });
        reads.filter(|read| read.names.iter().any(Option::is_some)).collect()
    }
}

/// The constants of each group, a row for each.
fn rows(sweep: &Sweep, groups: usize) -> Vec<Vec<f64>> {
    if sweep.columns.is_empty() {
        return Vec::new();
    }
    (0..groups).map(|group| sweep.columns.iter().map(|column| column[group]).collect()).collect()
}
