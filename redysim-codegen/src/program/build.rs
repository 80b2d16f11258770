//! From expressions to a program: one `let` for each value that has a name or more than one use, and loops where bodies
//! are alike.

use super::blocks::in_blocks;
use super::names::Identifiers;
use super::{Program, Scope, Statement, Trig, Value};
use crate::angles::Angles;
use crate::expressions::Expressions;
use crate::graph::{Graph, Node};
use crate::reroll::{Rerolled, is_operation};
use std::collections::{HashMap, HashSet};

/// Operations that one `let` may hold before it is cut in two, for the reader's sake.
const OPERATIONS_PER_LINE: usize = 6;

/// What the values of a function are called.
pub struct Names<'a> {
    /// The names that the backend uses itself: of arguments, and of what it defines.
    pub reserved: &'a [&'a str],
    /// The name of each body of the tree.
    pub bodies: &'a [String],
    /// The angles whose sines and cosines are given.
    pub angles: &'a Angles,
}

/// The program of a function.
pub fn program(expressions: &Expressions, names: &Names) -> Program {
    let builder = Builder::new(expressions, names);
    let outputs: Vec<_> = expressions.outputs.iter().map(|&output| builder.value(output, Scope::Outside)).collect();
    let mut statements = builder.sines_and_cosines();
    statements.extend(builder.code(&outputs));
    Program { statements, outputs }
}

pub(super) struct Builder<'a> {
    pub graph: &'a Graph,
    names: &'a Names<'a>,
    /// What of the function is loops.
    pub rerolled: Option<Rerolled>,
    /// Subtractions that are written the other way round, since their negative is what is wanted.
    pub flipped: Vec<bool>,
    /// Products that are part of a fused multiply-add.
    pub fused: Vec<bool>,
    /// The variable of each value that has a `let`.
    pub variables: Vec<Option<String>>,
    /// For each sine and cosine, where its angle is among those of the mechanism.
    pub positions: HashMap<usize, usize>,
    /// The array in which each loop keeps what is read outside it.
    pub arrays: Vec<String>,
}

impl<'a> Builder<'a> {
    fn new(expressions: &'a Expressions, names: &'a Names<'a>) -> Self {
        let graph = &expressions.graph;
        let uses = expressions.uses_in_code();
        let positions = names.angles.positions(expressions);
        let rerolled = Rerolled::of(expressions, &positions);
        let mut builder = Builder {
            graph,
            names,
            flipped: flipped(expressions, &uses),
            fused: fused_products(graph, &uses),
            variables: vec![None; graph.len()],
            positions,
            arrays: Vec::new(),
            rerolled,
        };
        builder.name_values(&uses);
        builder
    }

    /// Gives a name to every value that is to have a `let`.
    fn name_values(&mut self, uses: &[usize]) {
        let graph = self.graph;
        let mut identifiers = Identifiers::new(self.names.bodies, self.names.reserved);
        let mut lasting = vec![false; graph.len()];
        if let Some(rerolled) = &self.rerolled {
            self.arrays = rerolled.sweeps.iter().map(|sweep| identifiers.unique(sweep.name)).collect();
            for sweep in &rerolled.sweeps {
                sweep.carried.iter().map(|(node, _)| *node).chain(sweep.live_out.iter().copied()).for_each(|node| {
                    lasting[node] = true;
                });
            }
        }
        let mut sizes = vec![0; graph.len()];
        for index in (0..graph.len()).filter(|&index| uses[index] > 0) {
            let node = graph.node(index);
            let place = self.rerolled.as_ref().and_then(|rerolled| rerolled.place(index));
            if place.is_some() {
                self.flipped[index] = false;
                self.fused[index] &= !lasting[index];
            }
            if matches!(node, Node::Sin(_) | Node::Cos(_)) {
                // Among loops, sines and cosines are read where they are used.
                if self.rerolled.is_none() {
                    self.variables[index] = Some(identifiers.make(graph.name(index), false));
                }
                continue;
            }
            if !is_operation(node) || place.is_some_and(|place| place.template != index) {
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
            let (Some(name), node) = (name, self.graph.node(index)) else { continue };
            let in_loop = self.rerolled.as_ref().is_some_and(|rerolled| rerolled.place(index).is_some());
            if is_operation(node) && !in_loop {
                statements.push(self.definition(index, name, Scope::Outside));
            }
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

    /// The `let` of one value.
    pub fn definition(&self, index: usize, name: &str, scope: Scope) -> Statement {
        Statement::Let { name: name.to_string(), value: self.operation(index, self.flipped[index], scope) }
    }

    /// Takes the sines and cosines that the function needs from those of all angles.
    fn sines_and_cosines(&self) -> Vec<Statement> {
        let count = self.names.angles.len();
        let [mut sines, mut cosines] = [vec![None; count], vec![None; count]];
        for (&index, &position) in &self.positions {
            match self.graph.node(index) {
                Node::Sin(_) => sines[position] = self.variables[index].clone(),
                _ => cosines[position] = self.variables[index].clone(),
            }
        }
        let both = [(Trig::Sines, sines), (Trig::Cosines, cosines)].into_iter();
        let taken = both.filter(|(_, names)| names.iter().any(Option::is_some));
        taken.map(|(array, names)| Statement::Take { array, names }).collect()
    }
}

/// Products whose only use is a sum with something that is not such a product itself, or is the earlier of two: with
/// the sum they are one operation.
fn fused_products(graph: &Graph, uses: &[usize]) -> Vec<bool> {
    let mut fused = vec![false; graph.len()];
    for index in (0..graph.len()).filter(|&index| uses[index] > 0) {
        if let Node::Add(a, b) | Node::Subtract(a, b) = graph.node(index) {
            let products = [a.node(), b.node()]
                .into_iter()
                .filter(|&operand| uses[operand] == 1 && matches!(graph.node(operand), Node::Multiply(..)));
            if let Some(latest) = products.max() {
                fused[latest] = true;
            }
        }
    }
    fused
}

/// Which subtractions are wanted the other way round: those named so, and those mostly used with a minus.
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
