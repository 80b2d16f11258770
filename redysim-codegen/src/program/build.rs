//! From expressions to a program: one `let` for each value that has a name or more than one use, and loops over uniform
//! bodies.

use super::blocks::in_blocks;
use super::fusion::fused_products;
use super::names::Identifiers;
use super::side_by_side::PackNames;
use super::{Program, Scope, Statement, Trig, Value};
use crate::angles::Angles;
use crate::expressions::Expressions;
use crate::graph::{Graph, Node};
use crate::reroll::{Rerolled, is_operation};
use crate::siblings::SideBySide;
use std::collections::{HashMap, HashSet};

/// The most operations of one `let`, so that it can be read.
const OPERATIONS_PER_LINE: usize = 6;

/// What the names of variables are made from.
pub struct NamingContext<'a> {
    /// Names that variables must not have: arguments, and what the backend defines.
    pub reserved: &'a [&'a str],
    /// The name of each body of the tree.
    pub bodies: &'a [String],
    /// The angles whose sines and cosines are given.
    pub angles: &'a Angles,
}

/// The program of a function.
pub fn program(expressions: &Expressions, side_by_side: Option<&SideBySide>, naming: &NamingContext) -> Program {
    let builder = Builder::new(expressions, side_by_side, naming);
    let outputs: Vec<_> = expressions.outputs.iter().map(|&output| builder.value(output, Scope::Outside)).collect();
    let mut statements = builder.sines_and_cosines();
    statements.extend(builder.code(&outputs));
    Program { statements, outputs }
}

pub(super) struct Builder<'a> {
    pub graph: &'a Graph,
    naming: &'a NamingContext<'a>,
    /// The loops of the function, if it has any.
    pub rerolled: Option<Rerolled>,
    /// Subtractions of which the program computes the negative, since that is what is used.
    pub flipped: Vec<bool>,
    /// Products that are part of a fused multiply-add.
    pub fused: Vec<bool>,
    /// The variable of each value that has a `let`.
    pub variables: Vec<Option<String>>,
    /// For each sine and cosine, where its angle is among those of the mechanism.
    pub positions: HashMap<usize, usize>,
    /// The name of the live-out array of each loop, or of the results of each part of `side_by_side`.
    pub arrays: Vec<String>,
    /// What is computed side by side, if anything is.
    pub side_by_side: Option<&'a SideBySide>,
    /// The names in the parts, for each siblings.
    pub pack_names: Vec<PackNames>,
}

impl<'a> Builder<'a> {
    fn new(expressions: &'a Expressions, side_by_side: Option<&'a SideBySide>, naming: &'a NamingContext<'a>) -> Self {
        let graph = &expressions.graph;
        let uses = side_by_side.map_or_else(|| expressions.uses_in_code(), |side_by_side| side_by_side.uses.clone());
        let positions = naming.angles.positions(expressions);
        let rerolled = if side_by_side.is_some() { None } else { Rerolled::of(expressions, &positions) };
        let mut builder = Builder {
            graph,
            naming,
            flipped: flipped(expressions, &uses),
            fused: fused_products(graph, &uses),
            variables: vec![None; graph.len()],
            positions,
            arrays: Vec::new(),
            side_by_side,
            pack_names: Vec::new(),
            rerolled,
        };
        builder.name_values(&uses);
        builder
    }

    /// Names every value that becomes a `let`.
    fn name_values(&mut self, uses: &[usize]) {
        let graph = self.graph;
        let mut identifiers = Identifiers::new(self.naming.bodies, self.naming.reserved);
        let mut lasting = vec![false; graph.len()];
        if let Some(rerolled) = &self.rerolled {
            self.arrays = rerolled.sweeps.iter().map(|sweep| identifiers.unique(sweep.name)).collect();
            for sweep in &rerolled.sweeps {
                sweep.carried.iter().map(|(node, _)| *node).chain(sweep.live_out.iter().copied()).for_each(|node| {
                    lasting[node] = true;
                });
            }
        }
        if let Some(side_by_side) = self.side_by_side {
            self.arrays = side_by_side.parts.iter().map(|_| identifiers.unique("branches")).collect();
            let names = side_by_side.siblings.iter().enumerate().map(|(number, packs)| {
                let parts = side_by_side.parts.iter().filter(|part| part.siblings == number);
                let results = parts.flat_map(|part| part.results.iter().copied()).collect();
                PackNames::new(graph, packs, &results, OPERATIONS_PER_LINE, &mut identifiers)
            });
            self.pack_names = names.collect();
        }
        let mut sizes = vec![0; graph.len()];
        for index in (0..graph.len()).filter(|&index| uses[index] > 0) {
            let node = graph.node(index);
            let place = self.rerolled.as_ref().and_then(|rerolled| rerolled.place(index));
            if let Some(place) = place {
                self.flipped[index] = false;
                // What another step reads is a variable in every group, as it is in the template.
                self.fused[index] &= !lasting[place.template];
            }
            if self.is_given(index) {
                // Among loops, sines and cosines are read where they are used.
                if self.rerolled.is_none() {
                    self.variables[index] = Some(identifiers.make(graph.name(index), false));
                }
                continue;
            }
            if !self.is_operation(index) || place.is_some_and(|place| place.template != index) {
                continue;
            }
            sizes[index] = 1 + node.operands().map(|operand| sizes[operand.node()]).sum::<usize>();
            let nameless = graph.name(index).is_none() && !lasting[index];
            let inline = uses[index] == 1 && nameless && sizes[index] <= OPERATIONS_PER_LINE;
            if !(inline || self.fused[index]) {
                self.variables[index] = Some(match (&self.rerolled, place) {
                    (Some(rerolled), Some(_)) => identifiers.make_in_loop(graph.name(index), rerolled.template_body),
                    _ => identifiers.make(graph.name(index), self.flipped[index]),
                });
                sizes[index] = 0;
            }
        }
    }

    /// All statements, operands first: loops, and blocks in between. `outputs` are read after the last one.
    fn code(&self, outputs: &[Value]) -> Vec<Statement> {
        let mut parts: Vec<(Vec<Statement>, Option<Statement>)> = Vec::new();
        let mut statements = Vec::new();
        let mut sweeps = self.rerolled.iter().flat_map(|rerolled| &rerolled.sweeps).enumerate().peekable();
        for (index, name) in self.variables.iter().enumerate() {
            while let Some((number, _)) = sweeps.next_if(|(_, sweep)| sweep.start <= index) {
                parts.push((std::mem::take(&mut statements), Some(Statement::Loop(self.sweep(number)))));
            }
            let Some(name) = name else { continue };
            let in_loop = self.rerolled.as_ref().is_some_and(|rerolled| rerolled.place(index).is_some());
            if self.side_by_side.is_none() && self.is_operation(index) && !in_loop {
                statements.push(self.definition(index, name, Scope::Outside));
            }
        }
        if let Some(side_by_side) = self.side_by_side {
            let mut levels: Vec<Vec<Statement>> = Vec::new();
            for (index, name) in self.variables.iter().enumerate() {
                if let (Some(name), true) = (name, self.is_operation(index)) {
                    let level = side_by_side.level(index);
                    levels.resize_with(levels.len().max(level + 1), Vec::new);
                    levels[level].push(self.definition(index, name, Scope::Outside));
                }
            }
            let mut levels = levels.into_iter();
            let mut level = 0;
            for (number, part) in side_by_side.parts.iter().enumerate() {
                let mut before = Vec::new();
                while level <= side_by_side.level_of(part) {
                    before.extend(levels.next().into_iter().flatten());
                    level += 1;
                }
                parts.push((before, Some(self.part(side_by_side, number))));
            }
            statements = levels.flatten().collect();
        }
        parts.push((statements, None));
        let mut read_later: HashSet<String> = HashSet::new();
        outputs.iter().for_each(|output| output.variables(&mut |name| _ = read_later.insert(name.to_string())));
        let mut code = Vec::new();
        for (statements, after) in parts.into_iter().rev() {
            if let Some(statement) = after {
                statement.reads(&mut |name| _ = read_later.insert(name.to_string()));
                code.push(vec![statement]);
            }
            let mut reads = HashSet::new();
            for statement in &statements {
                statement.reads(&mut |name| _ = reads.insert(name.to_string()));
            }
            code.push(in_blocks(statements, &read_later));
            read_later.extend(reads);
        }
        code.into_iter().rev().flatten().collect()
    }

    /// Whether a value is the sine or cosine of an angle of the mechanism, which the function is given.
    pub fn is_given(&self, index: usize) -> bool {
        self.positions.contains_key(&index)
    }

    /// Whether the code computes a value.
    fn is_operation(&self, index: usize) -> bool {
        let node = self.graph.node(index);
        is_operation(node) || (matches!(node, Node::Sin(_) | Node::Cos(_)) && !self.is_given(index))
    }

    /// The `let` of one value.
    pub fn definition(&self, index: usize, name: &str, scope: Scope) -> Statement {
        Statement::Let { name: name.to_string(), value: self.operation(index, self.flipped[index], scope) }
    }

    /// Names the sines and cosines that the function reads among those of all angles.
    fn sines_and_cosines(&self) -> Vec<Statement> {
        let count = self.naming.angles.len();
        let [mut sines, mut cosines] = [vec![None; count], vec![None; count]];
        for (&index, &position) in &self.positions {
            match self.graph.node(index) {
                Node::Sin(_) => sines[position] = self.variables[index].clone(),
                _ => cosines[position] = self.variables[index].clone(),
            }
        }
        let arrays = [(Trig::Sines, sines), (Trig::Cosines, cosines)].into_iter();
        let read = arrays.filter(|(_, names)| names.iter().any(Option::is_some));
        read.map(|(array, names)| Statement::Destructure { array, names }).collect()
    }
}

/// The subtractions a − b of which b − a is used: those whose name is that of the negative, and those mostly used with
/// a minus sign.
fn flipped(expressions: &Expressions, uses: &[usize]) -> Vec<bool> {
    let graph = &expressions.graph;
    let mut minus = vec![0; graph.len()];
    let operands = (0..graph.len()).filter(|&index| uses[index] > 0).flat_map(|index| graph.node(index).operands());
    for edge in operands.chain(expressions.outputs.iter().copied()) {
        minus[edge.node()] += usize::from(edge.is_negative());
    }
    (0..graph.len())
        .map(|index| {
            matches!(graph.node(index), Node::Subtract(..))
                && graph.name(index).map_or(2 * minus[index] > uses[index], |name| name.negative)
        })
        .collect()
}
