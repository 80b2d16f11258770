//! A part of the packs of siblings as a statement.

use super::build::Builder;
use super::names::Identifiers;
use super::{Input, Scope, SideBySide, Statement, Value};
use crate::graph::Graph;
use crate::siblings::{self, Kind, Operand, Operation, Pack, Packs, Source};
use std::collections::HashSet;

/// The variables of the packs of siblings.
pub struct PackNames {
    /// The variable of each pack that has one.
    variables: Vec<Option<String>>,
    /// Products that are part of a fused multiply-add.
    fused: Vec<bool>,
}

impl PackNames {
    /// Names the packs that become variables: inputs, results, and what is read more than once or has a name.
    /// `results` are read outside of the part that computes them.
    pub fn new(
        graph: &Graph,
        packs: &Packs,
        results: &HashSet<usize>,
        longest: usize,
        names: &mut Identifiers,
    ) -> Self {
        let mut sizes = vec![0; packs.packs.len()];
        let fused = fused_products(graph, packs, results);
        let mut variables = vec![None; packs.packs.len()];
        for (index, pack) in packs.packs.iter().enumerate().filter(|(index, _)| packs.uses[*index] > 0) {
            let (node, is_inline) = match pack {
                Pack::Same(node) => (*node, false),
                Pack::Each(nodes) => (nodes[0], false),
                Pack::Operation(operation) => {
                    let node = operation.nodes[0];
                    sizes[index] = 1 + operation.packs().map(|operand| sizes[operand]).sum::<usize>();
                    let nameless = graph.name(node).is_none() && !results.contains(&index);
                    let short = packs.uses[index] == 1 && nameless && sizes[index] <= longest;
                    (node, short || fused[index])
                }
            };
            if !is_inline {
                variables[index] = Some(names.make(graph.name(node), packs.negative[index][0]));
                sizes[index] = 0;
            }
        }
        PackNames { variables, fused }
    }
}

/// Products whose only use is a sum of the same part. Of two such products in one sum, the one that stands later: to fuse
/// the one that is ready later gains 3 % at most for a quadruped, and small forces of another one lose digits.
fn fused_products(graph: &Graph, packs: &Packs, results: &HashSet<usize>) -> Vec<bool> {
    let mut fused = vec![false; packs.packs.len()];
    for (index, operation) in packs.operations().filter(|(index, _)| packs.uses[*index] > 0) {
        if operation.kind(graph) == Kind::Sum {
            let is_product = |&operand: &usize| match &packs.packs[operand] {
                Pack::Operation(operation) => operation.kind(graph) == Kind::Product,
                _ => false,
            };
            let products = operation.packs().filter(is_product).filter(|&operand| {
                packs.uses[operand] == 1 && !results.contains(&operand) && packs.is_computed_with(operand, index)
            });
            if let Some(latest) = products.max() {
                fused[latest] = true;
            }
        }
    }
    fused
}

impl Builder<'_> {
    /// The statement for part number `number`.
    pub fn part(&self, side_by_side: &siblings::SideBySide, number: usize) -> Statement {
        let part = &side_by_side.parts[number];
        let (packs, names) = (&side_by_side.siblings[part.siblings], &self.pack_names[part.siblings]);
        let mut printer = PartPrinter { builder: self, side_by_side, part, packs, names, inputs: Vec::new() };
        let mut body = Vec::new();
        for &pack in &part.packs {
            if let (Some(name), Pack::Operation(operation)) = (&names.variables[pack], &packs.packs[pack]) {
                let value = printer.operation(pack, operation, false);
                body.push(Statement::Let { name: name.clone(), value });
            }
        }
        let results = part.results.iter().filter_map(|&pack| names.variables[pack].clone()).collect();
        let inputs = printer.inputs;
        Statement::SideBySide(SideBySide {
            name: self.arrays[number].clone(),
            branches: packs.branches,
            inputs,
            body,
            results,
        })
    }
}

struct PartPrinter<'a> {
    builder: &'a Builder<'a>,
    side_by_side: &'a siblings::SideBySide,
    part: &'a siblings::Part,
    packs: &'a Packs,
    names: &'a PackNames,
    inputs: Vec<Input>,
}

impl PartPrinter<'_> {
    /// The operation of a pack, negated if `flip`.
    fn operation(&mut self, pack: usize, operation: &Operation, flip: bool) -> Value {
        let kind = operation.kind(self.builder.graph);
        match (kind, &operation.operands[..]) {
            (Kind::Sum, [a, b]) => self.sum(pack, [a, b], flip),
            (Kind::Product | Kind::Quotient, [a, b]) => {
                let [a, b] = self.factors(pack, [a, b]).map(Box::new);
                if kind == Kind::Product { Value::Product(a, b) } else { Value::Quotient(a, b) }
            }
            (_, [a, ..]) => {
                let signs = self.signs(&[a], None);
                let value = self.value(a, &signs);
                Value::SquareRoot(Box::new(if a.minus[0] { value.negated() } else { value }))
            }
            (_, []) => unreachable!("operations have operands"),
        }
    }

    /// The factors of a product or the parts of a quotient. The first takes the signs.
    fn factors(&mut self, pack: usize, [a, b]: [&Operand; 2]) -> [Value; 2] {
        let signs = self.signs(&[a, b], Some(pack));
        let none = vec![false; signs.len()];
        let second = self.value(b, &none);
        let first = self.value(a, &signs);
        [if a.minus[0] != b.minus[0] { first.negated() } else { first }, second]
    }

    fn sum(&mut self, pack: usize, operands: [&Operand; 2], flip: bool) -> Value {
        let signs = operands.map(|operand| self.signs(&[operand], Some(pack)));
        let minus = operands.map(|operand| operand.minus[0] != flip);
        for (product, addend) in [(0, 1), (1, 0)] {
            let Source::Pack(index) = operands[product].source else { continue };
            let Pack::Operation(multiplication) = &self.packs.packs[index] else { continue };
            let ([x, y], true) = (&multiplication.operands[..], self.names.fused[index]) else { continue };
            let [x, y] = self.factors(index, [x, y]);
            let x = self.with_signs(x, &signs[product]);
            let x = if minus[product] { x.negated() } else { x };
            let c = self.value(operands[addend], &signs[addend]);
            let c = if minus[addend] { c.negated() } else { c };
            return Value::MultiplyAdd(Box::new(x), Box::new(y), Box::new(c));
        }
        let mut value = |place: usize| {
            let value = self.value(operands[place], &signs[place]);
            if minus[place] { value.negated() } else { value }
        };
        Value::sum(value(0), value(1))
    }

    /// By which signs the operands, taken together, have to be multiplied in each branch so that `pack` has its value.
    fn signs(&self, operands: &[&Operand], pack: Option<usize>) -> Vec<bool> {
        let own = |branch: usize| pack.is_some_and(|pack| self.packs.negative[pack][branch]);
        let of = |operand: &Operand, branch: usize| {
            let differs = operand.minus[branch] != operand.minus[0];
            let negative = match operand.source {
                Source::Pack(pack) => self.packs.negative[pack][branch],
                Source::Constants(_) => false,
            };
            differs != negative
        };
        let branches = 0..self.packs.branches;
        branches.map(|branch| operands.iter().fold(own(branch), |sign, operand| sign != of(operand, branch))).collect()
    }

    /// An operand, times a sign in each branch.
    fn value(&mut self, operand: &Operand, signs: &[bool]) -> Value {
        match &operand.source {
            Source::Constants(values) => {
                let signed = values.iter().zip(signs).map(|(&value, &minus)| if minus { -value } else { value });
                self.constants(signed.collect())
            }
            Source::Pack(pack) => {
                let value = self.pack(*pack);
                self.with_signs(value, signs)
            }
        }
    }

    fn pack(&mut self, pack: usize) -> Value {
        let is_input = !self.part.packs.contains(&pack);
        match (&self.names.variables[pack], &self.packs.packs[pack]) {
            (None, Pack::Operation(operation)) => self.operation(pack, operation, false),
            (name, source) => {
                let name = name.clone().unwrap_or_default();
                if is_input && self.inputs.iter().all(|input| input.name != name) {
                    let read = |node: usize| self.builder.value(self.builder.graph.edge(node), Scope::Outside);
                    let branches = match source {
                        Pack::Same(node) => vec![read(*node); self.packs.branches],
                        Pack::Each(nodes) => nodes.iter().map(|&node| read(node)).collect(),
                        Pack::Operation(_) => {
                            let (part, column) = self
                                .side_by_side
                                .result(self.part.siblings, pack)
                                .expect("what another part reads is a result");
                            let branches = self.packs.branches;
                            let array = || self.builder.arrays[part].clone();
                            let result = |branch| Value::OfBranch { array: array(), branches, branch, column };
                            (0..branches).map(result).collect()
                        }
                    };
                    self.inputs.push(Input { name: name.clone(), branches });
                }
                Value::Variable(name)
            }
        }
    }

    /// A value times a sign in each branch.
    fn with_signs(&mut self, value: Value, signs: &[bool]) -> Value {
        if signs.iter().all(|minus| !minus) {
            return value;
        }
        if signs.iter().all(|minus| *minus) {
            return value.negated();
        }
        let signs = self.constants(signs.iter().map(|&minus| if minus { -1.0 } else { 1.0 }).collect());
        Value::Product(Box::new(signs), Box::new(value))
    }

    /// A constant of each branch.
    fn constants(&mut self, values: Vec<f64>) -> Value {
        if values.iter().all(|value| *value == values[0]) {
            return Value::Constant(values[0]);
        }
        let branches: Vec<Value> = values.into_iter().map(Value::Constant).collect();
        if let Some(input) = self.inputs.iter().find(|input| input.branches == branches) {
            return Value::Variable(input.name.clone());
        }
        let number = self.inputs.iter().filter(|input| matches!(input.branches[0], Value::Constant(_))).count() + 1;
        let name = format!("each{number}");
        self.inputs.push(Input { name: name.clone(), branches });
        Value::Variable(name)
    }
}
