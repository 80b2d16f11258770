//! Bodies on which the same is done: what of a long function can be a loop.
//!
//! Every sweep of a recursion does one step at each body. On a chain of alike bodies the steps have the same operations
//! on the values of the body before, on those of other sweeps at the same body, on the body's own inputs, and on
//! constants; only the constants differ. Such a run of bodies, taken `period` at a time (neighbours may be mirrored),
//! is found here by comparing steps. One group of bodies is the template; its operations become the body of a loop for
//! each sweep, with the constants in a table.
//!
//! Since constants of a graph are positive and signs stand on edges, a value of one group may be the negative of the
//! same value in the template: `signs` finds for each which it is.

mod alike;
mod signs;
mod table;

use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};
use alike::Steps;
use signs::Signs;
use std::collections::{BTreeSet, HashMap};
pub use table::Constant;

/// The group of bodies that the others are compared with. It has a neighbour on either side.
pub const TEMPLATE: usize = 1;
/// Fewer groups than this are not worth a loop.
const FEWEST_GROUPS: usize = 4;
/// The most bodies that are taken as one.
const LONGEST_PERIOD: usize = 3;

/// Part of a function as loops, one for each sweep, over the same bodies.
#[derive(Clone, Debug)]
pub struct Rolled {
    /// Number of groups, which is how often each loop runs.
    pub groups: usize,
    /// Bodies in a group.
    pub period: usize,
    /// The first body of the template.
    pub template_body: usize,
    /// The loops, in the order in which they run.
    pub sweeps: Vec<Sweep>,
    /// For each node of the graph, its place in the loops.
    places: HashMap<usize, Place>,
    constants: HashMap<(usize, usize), Constant>,
}

/// One loop.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// What the recursion calls it.
    pub name: &'static str,
    /// Whether it starts at the first group; else at the last.
    pub ascending: bool,
    /// The least index of its nodes: before this one it has to run.
    pub start: usize,
    /// The nodes of the template, in order.
    pub template: Vec<usize>,
    /// Nodes of the template whose value in the group before is read, each with its value before the loop.
    pub carried: Vec<(usize, Edge)>,
    /// Nodes of the template that are read outside the loop.
    pub kept: Vec<usize>,
    /// Columns of the table of constants: for each, its value for every group.
    pub columns: Vec<Vec<f64>>,
}

/// What a node inside the loops is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Index in [`Rolled::sweeps`].
    pub sweep: usize,
    /// The group it belongs to.
    pub group: usize,
    /// The node of the template that stands for it.
    pub image: usize,
    /// Whether its value is the negative of what the loop computes.
    pub negative: bool,
}

impl Rolled {
    /// The longest run of alike bodies, if it is worth loops. `live` says which nodes are operations of the function's
    /// code, `position` finds an angle among all.
    pub fn of(expressions: &Expressions, live: &[bool], position: &dyn Fn(Edge) -> usize) -> Option<Rolled> {
        if !expressions.is_long() {
            return None;
        }
        let steps = Steps::of(&expressions.graph, live, position);
        let runs = (1..=LONGEST_PERIOD).filter_map(|period| {
            let bodies = steps.longest_run(period)?;
            let mut groups = bodies.len() / period;
            // The signs of a longer run may contradict each other where those of a shorter one do not.
            while groups >= FEWEST_GROUPS {
                match Rolled::over(expressions, live, &steps, bodies.start, period, groups) {
                    Ok(rolled) => return Some(rolled),
                    Err(consistent) => groups = consistent.min(groups - 1),
                }
            }
            None
        });
        runs.max_by_key(|rolled| (rolled.groups * rolled.period, std::cmp::Reverse(rolled.period)))
    }

    /// The place of a node in the loops; `None` where it is outside.
    pub fn place(&self, node: usize) -> Option<Place> {
        self.places.get(&node).copied()
    }

    /// The constant that is operand `operand` of a node of a template.
    pub fn constant(&self, node: usize, operand: usize) -> Option<Constant> {
        self.constants.get(&(node, operand)).copied()
    }

    /// Loops over the given groups of bodies, or the number of groups up to which signs are consistent.
    fn over(
        expressions: &Expressions,
        live: &[bool],
        steps: &Steps,
        first: usize,
        period: usize,
        groups: usize,
    ) -> Result<Rolled, usize> {
        let graph = &expressions.graph;
        let mut sweeps = Vec::new();
        let mut places = HashMap::new();
        for sweep in steps.sweeps() {
            let nodes = |group: usize| -> Vec<usize> {
                let bodies = first + group * period..first + (group + 1) * period;
                bodies.flat_map(|body| steps.nodes(sweep, body).iter().copied()).collect()
            };
            let template = nodes(TEMPLATE);
            if template.is_empty() {
                continue;
            }
            for group in 0..groups {
                for (node, &image) in nodes(group).into_iter().zip(&template) {
                    places.insert(node, Place { sweep: sweeps.len(), group, image, negative: false });
                }
            }
            let ascending = nodes(0)[0] < template[0];
            let start = (0..groups).flat_map(nodes).min().unwrap_or(0);
            let mut template = template;
            template.sort_unstable();
            let (carried, kept, columns) = (Vec::new(), Vec::new(), Vec::new());
            sweeps.push(Sweep { name: sweep, ascending, start, template, carried, kept, columns });
        }
        sweeps.sort_by_key(|sweep| sweep.start);
        let order: HashMap<&str, usize> = sweeps.iter().enumerate().map(|(index, sweep)| (sweep.name, index)).collect();
        for (&node, place) in &mut places {
            place.sweep = order[graph.step(node).map_or("", |step| step.sweep)];
        }
        let mut members: Vec<usize> = places.keys().copied().collect();
        members.sort_unstable_by_key(|&node| (places[&node].group, node));
        let signs = Signs::of(graph, &members, &places)?;
        for (&node, place) in &mut places {
            place.negative = signs.is_negative(node);
        }
        let template_body = first + TEMPLATE * period;
        let mut rolled = Rolled { groups, period, template_body, sweeps, places, constants: HashMap::new() };
        rolled.connect(expressions, live, &signs).ok_or(0_usize)?;
        rolled.tabulate(graph, &signs, &members);
        Ok(rolled)
    }

    /// Finds what each loop carries on and keeps; `None` where the loops cannot run one after the other.
    fn connect(&mut self, expressions: &Expressions, live: &[bool], signs: &Signs) -> Option<()> {
        let graph = &expressions.graph;
        let mut kept: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); self.sweeps.len()];
        for output in &expressions.outputs {
            if let Some(place) = self.place(output.node()) {
                kept[place.sweep].insert(place.image);
            }
        }
        let mut carried: Vec<HashMap<usize, Edge>> = vec![HashMap::new(); self.sweeps.len()];
        for node in (0..graph.len()).filter(|&node| live[node]) {
            let user = self.place(node);
            for (operand, edge) in graph.node(node).operands().enumerate() {
                match (user, self.place(edge.node())) {
                    (None, Some(read)) => {
                        kept[read.sweep].insert(read.image);
                    }
                    (Some(user), Some(read)) if user.sweep == read.sweep => {
                        let sweep = &self.sweeps[user.sweep];
                        let before = if sweep.ascending { user.group.checked_sub(1) } else { Some(user.group + 1) };
                        if read.group != user.group && Some(read.group) != before {
                            return None;
                        }
                    }
                    (Some(user), Some(read)) => {
                        let runs_before = self.sweeps[read.sweep].start < self.sweeps[user.sweep].start;
                        if read.group != user.group || !runs_before {
                            return None;
                        }
                        kept[read.sweep].insert(read.image);
                    }
                    (Some(user), None) if live[edge.node()] => {
                        let sweep = &self.sweeps[user.sweep];
                        if edge.node() > sweep.start {
                            return None;
                        }
                        // At the start of a sweep, what the loop carries on comes from outside.
                        let same = graph.node(user.image).operands().nth(operand)?;
                        if let Some(image) = self.place(same.node()) {
                            let first = if sweep.ascending { 0 } else { self.groups - 1 };
                            if user.group != first || image.sweep != user.sweep {
                                return None;
                            }
                            let start = edge.abs().flipped_if(signs.is_negative(edge.node()));
                            carried[user.sweep].insert(image.image, start);
                        }
                    }
                    _ => {}
                }
            }
        }
        for (index, sweep) in self.sweeps.iter_mut().enumerate() {
            sweep.kept = kept[index].iter().copied().collect();
            sweep.carried = carried[index].iter().map(|(&image, &start)| (image, start)).collect();
            sweep.carried.sort_unstable();
        }
        Some(())
    }

    /// Collects the constants of the loops.
    fn tabulate(&mut self, graph: &Graph, signs: &Signs, members: &[usize]) {
        let mut values: HashMap<(usize, usize), Vec<f64>> = HashMap::new();
        for &node in members {
            let place = self.places[&node];
            for (operand, value) in table::constants(graph, node, place.image, signs) {
                let column = values.entry((place.image, operand)).or_insert_with(|| vec![0.0; self.groups]);
                column[place.group] = value;
            }
        }
        for sweep in &mut self.sweeps {
            for &node in &sweep.template {
                for operand in 0..2 {
                    if let Some(column) = values.remove(&(node, operand)) {
                        self.constants.insert((node, operand), table::entered(&mut sweep.columns, column));
                    }
                }
            }
        }
    }
}

/// The live operations of a function: what is neither an input, a constant, nor only part of an angle.
pub fn is_operation(node: Node) -> bool {
    !matches!(node, Node::Input { .. } | Node::Constant(_) | Node::Sin(_) | Node::Cos(_))
}
