//! Loop rerolling: code that an unrolled recursion repeats for each of many bodies becomes a loop again.
//!
//! Every sweep of a recursion does one step at each body. Bodies are uniform if their steps have the same operations on
//! the values of the body before, on those of other sweeps at the same body, on the body's own inputs, and on
//! constants; only the constants differ. A run of such bodies, taken `period` at a time (neighbours may be mirrored),
//! is found here by comparing steps. One group of bodies is the template; its nodes become the body of a loop for each
//! sweep, with the constants in a table.
//!
//! Since constants of a graph are positive and signs stand on edges, a value of one group may be the negative of the
//! same value in the template: `signs` finds which values are.

mod signs;
mod steps;
mod table;

use crate::angles::Angles;
use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};
use crate::policies::{FEWEST_GROUPS, LONGEST_PERIOD};
use signs::Signs;
use std::collections::{BTreeMap, BTreeSet, HashMap};
use steps::Steps;
pub use table::Constant;

/// The group of bodies that the others are compared with. It has a neighbour on either side.
pub const TEMPLATE: usize = 1;

/// Part of a function as loops, one for each sweep, over the same bodies.
#[derive(Clone, Debug)]
pub struct Rerolled {
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
    /// The name that the recursion gives it.
    pub name: &'static str,
    /// Whether it starts at the first group; else at the last.
    pub ascending: bool,
    /// The node before which it runs: the first of its own or, if later, the one after the last that it reads from
    /// outside the loops.
    pub start: usize,
    /// The nodes of the template, in order.
    pub template: Vec<usize>,
    /// Loop-carried nodes of the template: the value in the group before is read, or that in the last group after the
    /// loop. Each with its value before the loop, if any.
    pub carried: Vec<(usize, Option<Edge>)>,
    /// Live-out nodes of the template: other code reads their values in several groups.
    pub live_out: Vec<usize>,
    /// Columns of the table of constants: for each, its value for every group.
    pub columns: Vec<Vec<f64>>,
}

/// The place of a node in the loops.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// Index in [`Rerolled::sweeps`].
    pub sweep: usize,
    /// The group it belongs to.
    pub group: usize,
    /// Its template node.
    pub template: usize,
    /// Whether its value is the negative of what the loop computes.
    pub negative: bool,
}

impl Sweep {
    /// The loop of a sweep with the given nodes in each group; `None` if there are none.
    fn new(name: &'static str, groups: usize, nodes: impl Fn(&'static str, usize) -> Vec<usize>) -> Option<Sweep> {
        let mut template = nodes(name, TEMPLATE);
        template.sort_unstable();
        let first = nodes(name, 0).into_iter().min()?;
        Some(Sweep {
            name,
            ascending: first < *template.first()?,
            start: (0..groups).flat_map(|group| nodes(name, group)).min()?,
            template,
            carried: Vec::new(),
            live_out: Vec::new(),
            columns: Vec::new(),
        })
    }
}

impl Rerolled {
    /// The longest run of uniform bodies, if the function is long enough for loops. `positions` has the position of the
    /// angle of each sine and cosine.
    pub fn of(expressions: &Expressions, positions: &HashMap<usize, usize>) -> Option<Rerolled> {
        let is_given = |node: usize| positions.contains_key(&node);
        let uses = expressions.uses();
        let computes_trig = |node: usize| {
            uses[node] > 0 && matches!(expressions.graph.node(node), Node::Sin(_) | Node::Cos(_)) && !is_given(node)
        };
        if !expressions.is_long() || (0..uses.len()).any(computes_trig) {
            return None;
        }
        let live = &operations(expressions);
        let steps = Steps::of(&expressions.graph, live, positions);
        let runs = (1..=LONGEST_PERIOD).filter_map(|period| {
            let bodies = steps.longest_run(period)?;
            let mut groups = bodies.len() / period;
            // The signs of a longer run may contradict each other where those of a shorter one do not.
            while groups >= FEWEST_GROUPS {
                match Rerolled::over(expressions, live, &steps, bodies.start, period, groups) {
                    Some(rerolled) => return Some(rerolled),
                    None => groups = groups * 3 / 4,
                }
            }
            None
        });
        runs.max_by_key(|rerolled| (rerolled.groups * rerolled.period, std::cmp::Reverse(rerolled.period)))
    }

    /// The place of a node in the loops; `None` where it is outside.
    pub fn place(&self, node: usize) -> Option<Place> {
        self.places.get(&node).copied()
    }

    /// The group with which a sweep starts.
    pub fn first_group(&self, sweep: usize) -> usize {
        if self.sweeps[sweep].ascending { 0 } else { self.groups - 1 }
    }

    /// The group with which a sweep ends.
    pub fn last_group(&self, sweep: usize) -> usize {
        if self.sweeps[sweep].ascending { self.groups - 1 } else { 0 }
    }

    /// The constant that is operand `operand` of a node of a template.
    pub fn constant(&self, node: usize, operand: usize) -> Option<Constant> {
        self.constants.get(&(node, operand)).copied()
    }

    /// Loops over the given groups of bodies; `None` if their signs contradict each other or one loop cannot run after
    /// the other.
    fn over(
        expressions: &Expressions,
        live: &[bool],
        steps: &Steps,
        first: usize,
        period: usize,
        groups: usize,
    ) -> Option<Rerolled> {
        let graph = &expressions.graph;
        let nodes = |sweep: &'static str, group: usize| -> Vec<usize> {
            let bodies = first + group * period..first + (group + 1) * period;
            bodies.flat_map(|body| steps.nodes(sweep, body).iter().copied()).collect()
        };
        let mut sweeps: Vec<Sweep> = steps.sweeps().filter_map(|name| Sweep::new(name, groups, nodes)).collect();
        sweeps.sort_by_key(|sweep| sweep.start);
        let mut places = HashMap::new();
        for (index, sweep) in sweeps.iter().enumerate() {
            let templates = nodes(sweep.name, TEMPLATE);
            for group in 0..groups {
                for (node, &template) in nodes(sweep.name, group).into_iter().zip(&templates) {
                    places.insert(node, Place { sweep: index, group, template, negative: false });
                }
            }
        }
        let mut members: Vec<usize> = places.keys().copied().collect();
        members.sort_unstable();
        let signs = Signs::of(graph, &members, &places)?;
        for (&node, place) in &mut places {
            place.negative = signs.is_negative(node);
        }
        let template_body = first + TEMPLATE * period;
        let mut rerolled = Rerolled { groups, period, template_body, sweeps, places, constants: HashMap::new() };
        rerolled.schedule(graph, live)?;
        rerolled.connect(expressions, live, &signs)?;
        rerolled.tabulate(graph, &signs, &members);
        Some(rerolled)
    }

    /// Lets each loop run after what it reads from outside; `None` if the loops do not keep their order.
    fn schedule(&mut self, graph: &Graph, live: &[bool]) -> Option<()> {
        for node in (0..graph.len()).filter(|&node| live[node]) {
            let Some(user) = self.place(node) else { continue };
            for read in graph.node(node).operands().map(Edge::node) {
                if live[read] && self.place(read).is_none() {
                    let start = &mut self.sweeps[user.sweep].start;
                    *start = (*start).max(read + 1);
                }
            }
        }
        self.sweeps.is_sorted_by_key(|sweep| sweep.start).then_some(())
    }

    /// Finds the carried and the live-out values of each loop; `None` where the loops cannot run one after the other.
    fn connect(&mut self, expressions: &Expressions, live: &[bool], signs: &Signs) -> Option<()> {
        let graph = &expressions.graph;
        let mut live_out: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); self.sweeps.len()];
        let mut carried: Vec<BTreeMap<usize, Option<Edge>>> = vec![BTreeMap::new(); self.sweeps.len()];
        let mut read_outside = |rerolled: &Rerolled, carried: &mut [BTreeMap<usize, Option<Edge>>], read: Place| {
            if read.group == rerolled.last_group(read.sweep) {
                carried[read.sweep].entry(read.template).or_insert(None);
            } else {
                live_out[read.sweep].insert(read.template);
            }
        };
        for place in expressions.outputs.iter().filter_map(|output| self.place(output.node())) {
            read_outside(self, &mut carried, place);
        }
        for node in (0..graph.len()).filter(|&node| live[node]) {
            let user = self.place(node);
            for (operand, edge) in graph.node(node).operands().enumerate() {
                match (user, self.place(edge.node())) {
                    (None, Some(read)) => {
                        if node < self.sweeps[read.sweep].start {
                            return None;
                        }
                        read_outside(self, &mut carried, read);
                    }
                    (Some(user), Some(read)) if user.sweep == read.sweep => {
                        let sweep = &self.sweeps[user.sweep];
                        let before = if sweep.ascending { user.group.checked_sub(1) } else { Some(user.group + 1) };
                        if read.group != user.group && Some(read.group) != before {
                            return None;
                        }
                    }
                    (Some(user), Some(read)) => {
                        if read.group != user.group || read.sweep > user.sweep {
                            return None;
                        }
                        read_outside(self, &mut carried, Place { group: TEMPLATE, ..read });
                    }
                    (Some(user), None) if live[edge.node()] => {
                        // In the first group, what the loop carries comes from before it.
                        let same = graph.node(user.template).operands().nth(operand)?;
                        if let Some(template) = self.place(same.node()) {
                            if user.group != self.first_group(user.sweep) || template.sweep != user.sweep {
                                return None;
                            }
                            let start = edge.abs().flipped_if(signs.is_negative(edge.node()));
                            carried[user.sweep].insert(template.template, Some(start));
                        }
                    }
                    _ => {}
                }
            }
        }
        for (index, sweep) in self.sweeps.iter_mut().enumerate() {
            sweep.live_out = live_out[index].iter().copied().collect();
            sweep.carried = std::mem::take(&mut carried[index]).into_iter().collect();
        }
        Some(())
    }

    /// Collects the constants of the loops.
    fn tabulate(&mut self, graph: &Graph, signs: &Signs, members: &[usize]) {
        let mut values: HashMap<(usize, usize), Vec<f64>> = HashMap::new();
        for &node in members {
            let place = self.places[&node];
            for (operand, value) in table::constants(graph, node, place.template, signs) {
                let column = values.entry((place.template, operand)).or_insert_with(|| vec![0.0; self.groups]);
                column[place.group] = value;
            }
        }
        for sweep in &mut self.sweeps {
            for &node in &sweep.template {
                for operand in 0..2 {
                    if let Some(column) = values.remove(&(node, operand)) {
                        self.constants.insert((node, operand), table::tabulated(&mut sweep.columns, column));
                    }
                }
            }
        }
    }
}

/// About how many operations the code of a function has. A loop counts as one group.
pub fn code_size(expressions: &Expressions) -> usize {
    let angles = Angles::of([expressions]);
    let all = operations(expressions).into_iter().filter(|live| *live).count();
    let saved = Rerolled::of(expressions, &angles.positions(expressions)).map_or(0, |rerolled| {
        let in_loops: usize = rerolled.sweeps.iter().map(|sweep| sweep.template.len()).sum();
        in_loops * (rerolled.groups - 1)
    });
    all - saved
}

/// Which nodes are operations of the function's code.
fn operations(expressions: &Expressions) -> Vec<bool> {
    let uses = expressions.uses_in_code();
    (0..uses.len()).map(|node| uses[node] > 0 && is_operation(expressions.graph.node(node))).collect()
}

/// Whether a node is neither an input, a constant, a sine nor a cosine.
pub fn is_operation(node: Node) -> bool {
    !matches!(node, Node::Input { .. } | Node::Constant(_) | Node::Parameter { .. } | Node::Sin(_) | Node::Cos(_))
}
