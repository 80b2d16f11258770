//! Expressions as Rust: one `let` for each value that has a name or more than one use, and loops where bodies are
//! alike.

mod angles;
mod blocks;
mod loops;
mod names;
mod render;

use crate::angles::Angles;
use crate::expressions::Expressions;
use crate::graph::{Graph, Node};
use crate::rolled::{Rolled, is_operation};
pub use angles::{angle, without_turns};
use blocks::{Statement, in_blocks};
use names::Identifiers;
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;
use render::{Binding, Scope};
use std::collections::HashMap;

/// Operations that one `let` may hold before it is cut in two, for the reader's sake.
const OPERATIONS_PER_LINE: usize = 6;

/// What the expressions of a function are called in its code.
pub struct Vocabulary<'a> {
    /// The function's arguments, in the order in which the graph numbers them.
    pub arguments: &'a [&'a str],
    /// The name of each body of the tree.
    pub bodies: &'a [String],
    /// The angles whose sines and cosines are given.
    pub angles: &'a Angles,
}

/// The body of a function over `S: Scalar` that finds the sines and cosines of all angles in `sin` and `cos`: statements, then the
/// result that `result` makes of the outputs.
pub fn function_body(
    expressions: &Expressions,
    vocabulary: &Vocabulary,
    result: impl FnOnce(&[TokenStream]) -> TokenStream,
) -> TokenStream {
    let emitter = Emitter::new(expressions, vocabulary);
    let mut scope = Scope::default();
    let outputs: Vec<TokenStream> =
        expressions.outputs.iter().map(|&output| emitter.render(output, Binding::Lowest, &mut scope)).collect();
    let statements = emitter.code(&scope.needs);
    let result = result(&outputs);
    let k = local(FROM_F64);
    let sines_and_cosines = emitter.sines_and_cosines();
    quote! {
        let #k = S::from_f64;
        #sines_and_cosines
        #statements
        #result
    }
}

/// The name of an argument or a local value.
pub fn local(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

/// The names of the arguments that have the sines and the cosines of all angles.
pub const SIN: &str = "sin";
pub const COS: &str = "cos";

/// The local name of `S::from_f64`.
const FROM_F64: &str = "k";

struct Emitter<'a> {
    graph: &'a Graph,
    vocabulary: &'a Vocabulary<'a>,
    /// What of the function is loops.
    rolled: Option<Rolled>,
    /// Subtractions that are written the other way round, since their negative is what is wanted.
    flipped: Vec<bool>,
    /// Products that are part of a fused multiply-add.
    fused: Vec<bool>,
    /// The identifier of each value that has a `let`.
    idents: Vec<Option<Ident>>,
    /// For each sine and cosine, where its angle is among those of the mechanism.
    positions: HashMap<usize, usize>,
    /// The array in which each loop keeps what is read outside it.
    arrays: Vec<Ident>,
}

impl<'a> Emitter<'a> {
    fn new(expressions: &'a Expressions, vocabulary: &'a Vocabulary<'a>) -> Self {
        let graph = &expressions.graph;
        let uses = expressions.uses_in_code();
        let positions = vocabulary.angles.positions(expressions);
        let rolled = Rolled::of(expressions, &positions);
        let mut emitter = Emitter {
            graph,
            vocabulary,
            flipped: flipped(expressions, &uses),
            fused: fused_products(graph, &uses),
            idents: vec![None; graph.len()],
            positions,
            arrays: Vec::new(),
            rolled,
        };
        emitter.name_values(&uses);
        emitter
    }

    /// Gives an identifier to every value that is to have a `let`.
    fn name_values(&mut self, uses: &[usize]) {
        let graph = self.graph;
        let mut identifiers = Identifiers::new(self.vocabulary.bodies, &[FROM_F64, SIN, COS, loops::GROUP, loops::ROW]);
        self.vocabulary.arguments.iter().for_each(|argument| identifiers.reserve(argument));
        let mut lasting = vec![false; graph.len()];
        if let Some(rolled) = &self.rolled {
            self.arrays = rolled.sweeps.iter().map(|sweep| identifiers.unique(sweep.name)).collect();
            for sweep in &rolled.sweeps {
                sweep.carried.iter().map(|(node, _)| *node).chain(sweep.kept.iter().copied()).for_each(|node| {
                    lasting[node] = true;
                });
            }
        }
        let mut sizes = vec![0; graph.len()];
        for index in (0..graph.len()).filter(|&index| uses[index] > 0) {
            let node = graph.node(index);
            let place = self.rolled.as_ref().and_then(|rolled| rolled.place(index));
            if place.is_some() {
                self.flipped[index] = false;
                self.fused[index] &= !lasting[index];
            }
            if matches!(node, Node::Sin(_) | Node::Cos(_)) {
                // Among loops, sines and cosines are read where they are used.
                if self.rolled.is_none() {
                    self.idents[index] = Some(identifiers.make(graph.name(index), false));
                }
                continue;
            }
            if !is_operation(node) || place.is_some_and(|place| place.image != index) {
                continue;
            }
            sizes[index] = 1 + node.operands().map(|operand| sizes[operand.node()]).sum::<usize>();
            let nameless = graph.name(index).is_none() && !lasting[index];
            let inline = uses[index] == 1 && nameless && sizes[index] <= OPERATIONS_PER_LINE;
            if !(inline || self.fused[index]) {
                self.idents[index] = Some(match (&self.rolled, place) {
                    (Some(rolled), Some(_)) => identifiers.make_in_loop(graph.name(index), rolled.template_body),
                    _ => identifiers.make(graph.name(index), self.flipped[index]),
                });
                sizes[index] = 0;
            }
        }
    }

    /// All statements, operands first: loops, and blocks in between. `needed` are the nodes read after the last one.
    fn code(&self, needed: &[usize]) -> TokenStream {
        let mut parts: Vec<(Vec<Statement>, Option<Statement>)> = Vec::new();
        let mut statements = Vec::new();
        let mut loops = self.rolled.iter().flat_map(|rolled| &rolled.sweeps).enumerate().peekable();
        for (index, ident) in self.idents.iter().enumerate() {
            while let Some((number, _)) = loops.next_if(|(_, sweep)| sweep.start <= index) {
                parts.push((std::mem::take(&mut statements), Some(self.rolled_sweep(number))));
            }
            let (Some(ident), node) = (ident, self.graph.node(index)) else { continue };
            let in_loop = self.rolled.as_ref().is_some_and(|rolled| rolled.place(index).is_some());
            if is_operation(node) && !in_loop {
                statements.push(self.statement(index, ident, &mut Scope::default()));
            }
        }
        parts.push((statements, None));
        let mut needed = needed.to_vec();
        let mut code = Vec::new();
        for (statements, after) in parts.into_iter().rev() {
            if let Some(statement) = after {
                needed.extend(&statement.needs);
                code.push(statement.tokens);
            }
            let reads: Vec<usize> = statements.iter().flat_map(|statement| statement.needs.iter().copied()).collect();
            code.push(in_blocks(statements, &needed));
            needed.extend(reads);
        }
        code.into_iter().rev().collect()
    }

    /// The `let` of one value.
    fn statement(&self, index: usize, ident: &Ident, scope: &mut Scope) -> Statement {
        let value = self.operation(index, self.flipped[index], Binding::Lowest, scope);
        let needs = std::mem::take(&mut scope.needs);
        Statement { defines: vec![(index, ident.clone())], tokens: quote!(let #ident = #value;), needs }
    }

    /// Takes the sines and cosines that the function needs from those of all angles.
    fn sines_and_cosines(&self) -> TokenStream {
        let count = self.vocabulary.angles.len();
        let [mut sines, mut cosines] = [vec![None; count], vec![None; count]];
        for (&index, &position) in &self.positions {
            match self.graph.node(index) {
                Node::Sin(_) => sines[position] = self.idents[index].clone(),
                _ => cosines[position] = self.idents[index].clone(),
            }
        }
        let taken = [(SIN, sines), (COS, cosines)].map(|(array, idents)| {
            let array = local(array);
            let names = idents.iter().map(|ident| ident.as_ref().map_or(quote!(_), |ident| quote!(#ident)));
            idents.iter().any(Option::is_some).then(|| quote!(let [#(#names),*] = *#array;))
        });
        taken.into_iter().flatten().collect()
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

/// A number in full precision: the shortest digits that give the same `f64`.
fn constant(value: f64) -> TokenStream {
    if !value.is_finite() {
        // No checked model has one; should it come to that, the result is to show it.
        return quote!(f64::NAN);
    }
    let digits: Literal = format!("{:?}", value.abs()).parse().expect("a finite number is a literal");
    if value < 0.0 { quote!(-#digits) } else { quote!(#digits) }
}
