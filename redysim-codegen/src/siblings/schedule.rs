//! The order in which packs and single operations are computed.

use super::Siblings;
use super::packs::{Kind, Operation, Pack, Source, packs};
use super::signs::signs;
use crate::angles::is_given;
use crate::expressions::Expressions;
use crate::graph::Graph;
use crate::policies::{FEWEST_SIDE_BY_SIDE, LEAST_SAVED_SIDE_BY_SIDE as LEAST_SAVED};
use crate::reroll::is_operation;
use redysim_model::Function;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// The most parts that the packs of siblings are computed in: one for each time that a recursion passes through them.
const MOST_PARTS: usize = 8;

/// What of a function is computed side by side.
#[derive(Clone, Debug)]
pub struct SideBySide {
    /// The packs, of each siblings.
    pub siblings: Vec<Packs>,
    /// The parts, in the order in which they are computed.
    pub parts: Vec<Part>,
    /// How often each node is read where it is single.
    pub uses: Vec<usize>,
    /// The number of the part before which a single operation is computed.
    levels: Vec<usize>,
    /// For nodes of packs: which siblings, pack and branch.
    members: HashMap<usize, (usize, usize, usize)>,
}

/// The packs of siblings.
#[derive(Clone, Debug)]
pub struct Packs {
    /// Number of branches.
    pub branches: usize,
    /// The packs, operands first.
    pub packs: Vec<Pack>,
    /// For each pack, of which branches the value is the negative of the node's.
    pub negative: Vec<Vec<bool>>,
    /// How often each pack is read by packs, and once more if it is read from outside.
    pub uses: Vec<usize>,
    levels: Vec<usize>,
}

/// Packs that are computed without single operations in between.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// Of which siblings.
    pub siblings: usize,
    level: usize,
    /// The packs that it computes.
    pub packs: Vec<usize>,
    /// Those of them that are read elsewhere.
    pub results: Vec<usize>,
}

/// Where the value of a node of a pack is.
pub struct Member {
    /// The number of the part.
    pub part: usize,
    /// The position among the results of the part.
    pub result: usize,
    /// The branch.
    pub branch: usize,
    /// Whether the value of the node is the negative of that.
    pub negative: bool,
}

impl SideBySide {
    /// What of a function is computed side by side; `None` if nothing is, or if that does not pay.
    pub fn of(expressions: &Expressions, function: Function, siblings: &[Siblings]) -> Option<SideBySide> {
        let graph = &expressions.graph;
        if siblings.is_empty() || !may_pay(expressions) {
            return None;
        }
        let uses = expressions.uses_in_code();
        let live: Vec<bool> = (0..uses.len()).map(|node| uses[node] > 0 && is_operation(graph.node(node))).collect();
        let packed = |siblings: &Siblings| {
            let packs = packs(expressions, &live, function, siblings);
            let branches = siblings.branches.len();
            let (uses, levels) = (vec![0; packs.len()], vec![0; packs.len()]);
            Packs { branches, negative: signs(graph, &packs, branches), packs, uses, levels }
        };
        let siblings: Vec<Packs> = siblings.iter().map(packed).collect();
        let mut members = HashMap::new();
        for (number, siblings) in siblings.iter().enumerate() {
            for (pack, operation) in siblings.operations() {
                for (branch, &node) in operation.nodes.iter().enumerate() {
                    members.entry(node).or_insert((number, pack, branch));
                }
            }
        }
        let (uses, levels) = (vec![0; graph.len()], vec![0; graph.len()]);
        let mut side_by_side = SideBySide { siblings, parts: Vec::new(), uses, levels, members };
        let results = side_by_side.demand(expressions);
        side_by_side.schedule(graph)?;
        side_by_side.divide(results);
        side_by_side.negate_what_is_read_negative(expressions);
        let (own, all) = (side_by_side.code_size(graph), live.iter().filter(|live| **live).count());
        (!side_by_side.parts.is_empty() && LEAST_SAVED * own <= (LEAST_SAVED - 1) * all).then_some(side_by_side)
    }

    /// About how many instructions the code has: one for each operation, and one for each number that has to be put into
    /// a lane or taken from it.
    pub fn code_size(&self, graph: &Graph) -> usize {
        let single = (0..graph.len()).filter(|&node| self.uses[node] > 0 && is_operation(graph.node(node))).count();
        let of_packs = self.siblings.iter().map(|siblings| {
            let used = siblings.packs.iter().zip(&siblings.uses).filter(|(_, uses)| **uses > 0);
            let size = |(pack, _): (&Pack, _)| match pack {
                Pack::Same(_) | Pack::Operation(_) => 1,
                Pack::Each(_) => siblings.branches,
            };
            used.map(size).sum::<usize>()
        });
        let results = self.parts.iter().map(|part| self.siblings[part.siblings].branches * part.results.len());
        single + of_packs.sum::<usize>() + results.sum::<usize>()
    }

    /// The number of the part before which a single operation is computed.
    pub fn level(&self, node: usize) -> usize {
        self.levels[node]
    }

    /// The level of a part.
    pub fn level_of(&self, part: &Part) -> usize {
        part.level
    }

    /// Where the value of a node is, if a pack has it.
    pub fn member(&self, node: usize) -> Option<Member> {
        let &(siblings, pack, branch) = self.members.get(&node)?;
        let negative = self.siblings[siblings].negative[pack][branch];
        let (part, result) = self.result(siblings, pack)?;
        Some(Member { part, result, branch, negative })
    }

    /// The part that has a pack among its results, and the position there.
    pub fn result(&self, siblings: usize, pack: usize) -> Option<(usize, usize)> {
        let level = self.siblings[siblings].levels[pack];
        let part = self.parts.iter().position(|part| part.siblings == siblings && part.level == level)?;
        let result = self.parts[part].results.iter().position(|&result| result == pack)?;
        Some((part, result))
    }

    /// Counts what is read, starting from the outputs, and returns the packs of each siblings that are read one by one.
    fn demand(&mut self, expressions: &Expressions) -> Vec<BTreeSet<usize>> {
        enum Read {
            Node(usize),
            Pack(usize, usize),
        }
        let graph = &expressions.graph;
        let mut results = vec![BTreeSet::new(); self.siblings.len()];
        let mut reads: Vec<Read> = expressions.outputs.iter().map(|output| Read::Node(output.node())).collect();
        while let Some(read) = reads.pop() {
            match read {
                Read::Node(node) => {
                    if let Some(&(siblings, pack, _)) = self.members.get(&node) {
                        if results[siblings].insert(pack) {
                            reads.push(Read::Pack(siblings, pack));
                        }
                        continue;
                    }
                    self.uses[node] += 1;
                    if self.uses[node] == 1 && !is_given(graph, node) {
                        reads.extend(graph.node(node).operands().map(|operand| Read::Node(operand.node())));
                    }
                }
                Read::Pack(number, pack) => {
                    let siblings = &mut self.siblings[number];
                    siblings.uses[pack] += 1;
                    if siblings.uses[pack] > 1 {
                        continue;
                    }
                    match &siblings.packs[pack] {
                        Pack::Same(node) => reads.push(Read::Node(*node)),
                        Pack::Each(nodes) => reads.extend(nodes.iter().map(|&node| Read::Node(node))),
                        Pack::Operation(operation) => {
                            reads.extend(operation.packs().map(|pack| Read::Pack(number, pack)));
                        }
                    }
                }
            }
        }
        results
    }

    /// Packs that single operations and outputs mostly read with a minus sign have the negatives of their values: the operations
    /// that compute and read them take the sign.
    fn negate_what_is_read_negative(&mut self, expressions: &Expressions) {
        let graph = &expressions.graph;
        // For each pack, reads with a minus sign less those without.
        let mut minus: HashMap<(usize, usize), i32> = HashMap::new();
        let single = (0..graph.len()).filter(|&node| self.uses[node] > 0 && is_operation(graph.node(node)));
        let operands = single.flat_map(|node| graph.node(node).operands());
        for edge in operands.chain(expressions.outputs.iter().copied()) {
            if let Some(&(siblings, pack, branch)) = self.members.get(&edge.node()) {
                let is_minus = edge.is_negative() != self.siblings[siblings].negative[pack][branch];
                *minus.entry((siblings, pack)).or_default() += if is_minus { 1 } else { -1 };
            }
        }
        for ((siblings, pack), minus) in minus {
            let Packs { packs, negative, .. } = &mut self.siblings[siblings];
            let has_sign = |operation: &Operation| operation.kind(graph) != Kind::Root;
            if minus > 0 && matches!(&packs[pack], Pack::Operation(operation) if has_sign(operation)) {
                negative[pack].iter_mut().for_each(|negative| *negative = !*negative);
            }
        }
    }

    /// Finds the levels; `None` where packs and single operations wait for each other.
    fn schedule(&mut self, graph: &Graph) -> Option<()> {
        loop {
            let mut changed = false;
            for node in (0..graph.len()).filter(|&node| self.uses[node] > 0 && !is_given(graph, node)) {
                let operands = graph.node(node).operands().map(|operand| self.level_outside(operand.node()));
                let level = operands.max().unwrap_or(0);
                changed |= std::mem::replace(&mut self.levels[node], level) != level;
            }
            for number in 0..self.siblings.len() {
                for pack in 0..self.siblings[number].packs.len() {
                    let siblings = &self.siblings[number];
                    if siblings.uses[pack] == 0 {
                        continue;
                    }
                    let level = match &siblings.packs[pack] {
                        Pack::Same(node) => self.level_outside(*node),
                        Pack::Each(nodes) => nodes.iter().map(|&node| self.level_outside(node)).max()?,
                        Pack::Operation(operation) => {
                            operation.packs().map(|pack| siblings.levels[pack]).max().unwrap_or(0)
                        }
                    };
                    if level > MOST_PARTS {
                        return None;
                    }
                    changed |= std::mem::replace(&mut self.siblings[number].levels[pack], level) != level;
                }
            }
            if !changed {
                return Some(());
            }
        }
    }

    /// The level at which a node can be read outside of packs.
    fn level_outside(&self, node: usize) -> usize {
        match self.members.get(&node) {
            Some(&(siblings, pack, _)) => self.siblings[siblings].levels[pack] + 1,
            None => self.levels[node],
        }
    }

    /// Divides the packs into parts. `results` are those that are read one by one.
    fn divide(&mut self, results: Vec<BTreeSet<usize>>) {
        let mut parts: BTreeMap<(usize, usize), Part> = BTreeMap::new();
        for (number, (siblings, mut results)) in self.siblings.iter().zip(results).enumerate() {
            let used = || siblings.operations().filter(|(pack, _)| siblings.uses[*pack] > 0);
            for (pack, operation) in used() {
                let earlier = |operand: &usize| siblings.levels[*operand] < siblings.levels[pack];
                let is_operation = |operand: &usize| matches!(siblings.packs[*operand], Pack::Operation(_));
                results.extend(operation.packs().filter(earlier).filter(is_operation));
            }
            for (pack, _) in used() {
                let level = siblings.levels[pack];
                let part = parts.entry((level, number)).or_default();
                (part.siblings, part.level) = (number, level);
                part.packs.push(pack);
                if results.contains(&pack) {
                    part.results.push(pack);
                }
            }
        }
        self.parts = parts.into_values().collect();
    }
}

/// Whether a function has operations enough for branches side by side.
pub fn may_pay(expressions: &Expressions) -> bool {
    expressions.count().flops() >= FEWEST_SIDE_BY_SIDE
}

/// About how many instructions the code of a function has with branches side by side; `None` if that does not pay.
pub fn code_size(expressions: &Expressions, function: Function, siblings: &[Siblings]) -> Option<usize> {
    Some(SideBySide::of(expressions, function, siblings)?.code_size(&expressions.graph))
}

impl Packs {
    /// The packs that are operations, with their indices.
    pub fn operations(&self) -> impl Iterator<Item = (usize, &Operation)> {
        self.packs.iter().enumerate().filter_map(|(index, pack)| match pack {
            Pack::Operation(operation) => Some((index, operation)),
            _ => None,
        })
    }

    /// Whether a pack is computed in the part of another one.
    pub fn is_computed_with(&self, pack: usize, other: usize) -> bool {
        matches!(self.packs[pack], Pack::Operation(_)) && self.levels[pack] == self.levels[other]
    }
}

impl Operation {
    /// The operands that are packs.
    pub fn packs(&self) -> impl Iterator<Item = usize> {
        self.operands.iter().filter_map(|operand| match operand.source {
            Source::Pack(pack) => Some(pack),
            Source::Constants(_) => None,
        })
    }
}
