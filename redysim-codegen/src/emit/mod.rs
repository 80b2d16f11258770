//! Expressions as Rust: one `let` for each value that has a name or more than one use.

mod angles;
mod blocks;
mod names;

use crate::expressions::Expressions;
use crate::graph::{Edge, Graph, Node};
pub use angles::Angles;
use blocks::{Statement, in_blocks};
use names::Identifiers;
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;

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

/// The body of a function over `S: Scalar` that finds the sines and cosines of all angles in `at`: statements, then the
/// result that `result` makes of the outputs.
pub fn function_body(
    expressions: &Expressions,
    vocabulary: &Vocabulary,
    result: impl FnOnce(&[TokenStream]) -> TokenStream,
) -> TokenStream {
    let emitter = Emitter::new(expressions, vocabulary);
    let statements = emitter.statements();
    let mut needed = Vec::new();
    let outputs: Vec<TokenStream> =
        expressions.outputs.iter().map(|&output| emitter.render(output, Binding::Lowest, &mut needed)).collect();
    let statements = in_blocks(statements, &needed);
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

/// The name of the argument that has the coordinates with the sines and cosines.
pub const POSTURE: &str = "at";

/// The local name of `S::from_f64`.
const FROM_F64: &str = "k";

/// How tightly the surrounding expression binds; what binds less tightly gets parentheses.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Binding {
    Lowest,
    Sum,
    Product,
    Unary,
}

struct Emitter<'a> {
    graph: &'a Graph,
    vocabulary: &'a Vocabulary<'a>,
    uses: Vec<usize>,
    /// Nodes that are subtractions written the other way round, since their negative is what is wanted.
    flipped: Vec<bool>,
    /// Products that are part of a fused multiply-add.
    fused: Vec<bool>,
    /// The identifier of each value that has a `let`.
    idents: Vec<Option<Ident>>,
}

impl<'a> Emitter<'a> {
    fn new(expressions: &'a Expressions, vocabulary: &'a Vocabulary<'a>) -> Self {
        let graph = &expressions.graph;
        let uses = uses_in_statements(expressions);
        let flipped = flipped(expressions, &uses);
        let fused = fused_products(graph, &uses);
        let mut idents = vec![None; graph.len()];
        let mut reserved = vocabulary.arguments.to_vec();
        reserved.extend([FROM_F64, POSTURE]);
        let mut identifiers = Identifiers::new(vocabulary.bodies, &reserved);
        let mut sizes = vec![0; graph.len()];
        for index in (0..graph.len()).filter(|&index| uses[index] > 0) {
            let node = graph.node(index);
            if matches!(node, Node::Input { .. } | Node::Constant(_)) {
                continue;
            }
            if matches!(node, Node::Sin(_) | Node::Cos(_)) {
                idents[index] = Some(identifiers.make(graph.name(index), false));
                continue;
            }
            sizes[index] = 1 + node.operands().map(|operand| sizes[operand.node()]).sum::<usize>();
            let inline = uses[index] == 1 && graph.name(index).is_none() && sizes[index] <= OPERATIONS_PER_LINE;
            if !(inline || fused[index]) {
                idents[index] = Some(identifiers.make(graph.name(index), flipped[index]));
                sizes[index] = 0;
            }
        }
        Emitter { graph, vocabulary, uses, flipped, fused, idents }
    }

    /// One statement for each value with a `let`, operands first.
    fn statements(&self) -> Vec<Statement> {
        let mut statements = Vec::new();
        for (index, ident) in self.idents.iter().enumerate() {
            let (Some(ident), node) = (ident, self.graph.node(index)) else { continue };
            if matches!(node, Node::Sin(_) | Node::Cos(_)) {
                continue;
            }
            let mut needs = Vec::new();
            let value = self.operation(node, self.flipped[index], Binding::Lowest, &mut needs);
            statements.push(Statement {
                defines: vec![(index, ident.clone())],
                tokens: quote!(let #ident = #value;),
                needs,
            });
        }
        statements
    }

    /// Takes the sines and cosines that the function needs from those of all angles.
    fn sines_and_cosines(&self) -> TokenStream {
        let angles = self.vocabulary.angles;
        let [mut sines, mut cosines] = [vec![None; angles.len()], vec![None; angles.len()]];
        for (index, ident) in self.idents.iter().enumerate() {
            match self.graph.node(index) {
                Node::Sin(angle) => sines[angles.position(self.graph, angle)] = ident.clone(),
                Node::Cos(angle) => cosines[angles.position(self.graph, angle)] = ident.clone(),
                _ => {}
            }
        }
        let taken = [("sin", sines), ("cos", cosines)].map(|(field, idents)| {
            let (at, field) = (local(POSTURE), local(field));
            let names = idents.iter().map(|ident| ident.as_ref().map_or(quote!(_), |ident| quote!(#ident)));
            idents.iter().any(Option::is_some).then(|| quote!(let [#(#names),*] = #at.#field;))
        });
        taken.into_iter().flatten().collect()
    }

    /// A value as an expression; `needs` collects the nodes with a `let` that it reads.
    fn render(&self, edge: Edge, binding: Binding, needs: &mut Vec<usize>) -> TokenStream {
        let index = edge.node();
        let negative = edge.is_negative() != self.flipped[index];
        if let Some(value) = self.graph.constant_value(edge) {
            let (k, value) = (local(FROM_F64), constant(value));
            return quote!(#k(#value));
        }
        if let Some(ident) = &self.idents[index] {
            needs.push(index);
            return if negative { quote!(-#ident) } else { quote!(#ident) };
        }
        match self.graph.node(index) {
            Node::Input { argument, index } => {
                let argument = local(self.vocabulary.arguments[usize::from(argument)]);
                let index = Literal::u32_unsuffixed(index);
                if negative { quote!(-#argument[#index]) } else { quote!(#argument[#index]) }
            }
            node @ Node::Subtract(..) => self.operation(node, edge.is_negative(), binding, needs),
            node if negative => {
                let value = self.operation(node, false, Binding::Unary, needs);
                quote!(-#value)
            }
            node => self.operation(node, false, binding, needs),
        }
    }

    /// a + b, with a minus sign between them where one of them has it.
    fn sum(&self, a: Edge, b: Edge, needs: &mut Vec<usize>) -> (Binding, TokenStream) {
        for (product, addend) in [(a, b), (b, a)] {
            if self.fused[product.node()]
                && let Node::Multiply(x, y) = self.graph.node(product.node())
            {
                let x = self.render(x.flipped_if(product.is_negative()), Binding::Lowest, needs);
                let y = self.render(y, Binding::Lowest, needs);
                let addend = self.render(addend, Binding::Lowest, needs);
                return (Binding::Unary, quote!(S::mul_add(#x, #y, #addend)));
            }
        }
        let (a, b) = if self.has_minus(a) && !self.has_minus(b) { (b, a) } else { (a, b) };
        let left = self.render(a, Binding::Lowest, needs);
        if self.has_minus(b) {
            let right = self.render(-b, Binding::Sum, needs);
            (Binding::Sum, quote!(#left - #right))
        } else {
            let right = self.render(b, Binding::Sum, needs);
            (Binding::Sum, quote!(#left + #right))
        }
    }

    /// Whether the value is written with a minus sign in front.
    fn has_minus(&self, edge: Edge) -> bool {
        let turned = self.idents[edge.node()].is_none() && matches!(self.graph.node(edge.node()), Node::Subtract(..));
        !turned && edge.is_negative() != self.flipped[edge.node()]
    }

    /// The operation of a node; of a subtraction, the other way round if `flip`.
    fn operation(&self, node: Node, flip: bool, binding: Binding, needs: &mut Vec<usize>) -> TokenStream {
        let (own, tokens) = match node {
            Node::Add(a, b) => self.sum(a, b, needs),
            Node::Subtract(a, b) => self.sum(a.flipped_if(flip), b.flipped_if(!flip), needs),
            Node::Multiply(a, b) => {
                let (a, b) = (self.render(a, Binding::Sum, needs), self.render(b, Binding::Product, needs));
                (Binding::Product, quote!(#a * #b))
            }
            Node::Divide(a, b) => {
                let (a, b) = (self.render(a, Binding::Sum, needs), self.render(b, Binding::Product, needs));
                (Binding::Product, quote!(#a / #b))
            }
            Node::Sqrt(a) => {
                let a = self.render(a, Binding::Lowest, needs);
                (Binding::Unary, quote!(S::sqrt(#a)))
            }
            Node::Sin(_) | Node::Cos(_) | Node::Input { .. } | Node::Constant(_) => {
                unreachable!("sines and cosines have a `let`, inputs and constants are no operations")
            }
        };
        if own <= binding && binding != Binding::Lowest { quote!((#tokens)) } else { tokens }
    }
}

/// How often each value is read by the statements of a function. Angles are not among them: their sines and cosines are
/// given.
fn uses_in_statements(expressions: &Expressions) -> Vec<usize> {
    let graph = &expressions.graph;
    let mut uses = vec![0; graph.len()];
    for output in &expressions.outputs {
        uses[output.node()] += 1;
    }
    for index in (0..graph.len()).rev().filter(|&index| !matches!(graph.node(index), Node::Sin(_) | Node::Cos(_))) {
        if uses[index] > 0 {
            graph.node(index).operands().for_each(|operand| uses[operand.node()] += 1);
        }
    }
    uses
}

/// Products whose only use is a sum with something that is not such a product itself, or is the earlier of two: with the
/// sum they are one operation.
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
