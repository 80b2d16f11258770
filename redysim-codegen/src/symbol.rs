//! The symbolic scalar: run through the recursions, it builds their expression graph.
//!
//! Operations are not inlined: the recursions have thousands of them, and would take longer to compile than they save.

use crate::graph::{Edge, Graph, Name, Step};
use redysim_model::Tree;
use redysim_model::denoc::Trace;
use redysim_model::parameter::Parameter;
use redysim_runtime::{Dual, Lift, Scalar};
use std::cell::RefCell;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A graph that symbols write to while a recursion runs.
#[derive(Debug, Default)]
pub struct Tracer {
    graph: RefCell<Graph>,
    /// The values of the first nodes where parameters have those of the model, if no node depends on an argument.
    nominal: RefCell<Vec<f64>>,
}

/// A number known now, or a value of the generated function.
#[derive(Clone, Copy, Debug)]
pub enum Symbol<'g> {
    /// A constant.
    Constant(f64),
    /// A value in a graph.
    Value(&'g Tracer, Edge),
}

/// A robot of which the numbers that are given at run time are symbols.
pub type SymbolicTree<'p> = Tree<Symbol<'p>>;

impl Tracer {
    /// Symbols for the elements of argument number `argument`, an array of `len` elements.
    pub fn argument(&self, argument: u8, len: usize) -> Vec<Symbol<'_>> {
        (0..len).map(|index| Symbol::Value(self, self.graph.borrow_mut().input(argument, index as u32))).collect()
    }

    /// The symbol of parameter number `index`, whose value in the model is `nominal`.
    pub fn parameter(&self, index: u32, nominal: f64) -> Symbol<'_> {
        Symbol::Value(self, self.graph.borrow_mut().parameter(index, nominal))
    }

    /// The tree for a function that this tracer traces. What the numbers of `tree` are made of was traced by another
    /// tracer; here each is a parameter, with the index of its node there.
    pub fn tree(&self, tree: &SymbolicTree<'_>) -> SymbolicTree<'_> {
        tree.map(|number| match number {
            Symbol::Constant(value) => Symbol::Constant(value),
            Symbol::Value(tracer, edge) => {
                let symbol = self.parameter(edge.node() as u32, tracer.nominal(edge.abs()));
                edge.signed(symbol)
            }
        })
    }

    /// A value that depends on parameters alone, where these have the values of the model.
    fn nominal(&self, edge: Edge) -> f64 {
        let (graph, mut values) = (self.graph.borrow(), self.nominal.borrow_mut());
        for index in values.len()..graph.len() {
            let value = graph.nominal(index, &values);
            values.push(value);
        }
        edge.signed(values[edge.node()])
    }

    /// The edges of `outputs` in the graph.
    pub fn edges(&self, outputs: &[Symbol<'_>]) -> Vec<Edge> {
        outputs.iter().map(|output| output.edge(self)).collect()
    }

    /// The graph traced so far.
    pub fn into_graph(self) -> Graph {
        self.graph.into_inner()
    }
}

/// A scalar made of symbols: one that a [`Tracer`] observes in a recursion.
pub trait Traced: Copy {
    /// Gives the name to the value, and to its derivatives the names that follow from it.
    fn set_name(self, tracer: &Tracer, name: Name);
}

impl Traced for Symbol<'_> {
    fn set_name(self, tracer: &Tracer, name: Name) {
        if let Symbol::Value(_, edge) = self {
            tracer.graph.borrow_mut().set_name(edge, name);
        }
    }
}

impl<S: Traced> Traced for Dual<S> {
    fn set_name(self, tracer: &Tracer, name: Name) {
        self.value.set_name(tracer, name);
        self.slope.set_name(tracer, Name { order: name.order + 1, ..name });
    }
}

impl<S: Traced> Trace<S> for Tracer {
    fn step<R>(&self, sweep: &'static str, body: usize, work: impl FnOnce() -> R) -> R {
        self.graph.borrow_mut().enter_step(Some(Step { sweep, body }));
        let result = work();
        self.graph.borrow_mut().enter_step(None);
        result
    }

    fn name(&self, value: S, quantity: &'static str, body: usize, component: &'static str) {
        value.set_name(self, Name { quantity, body, component, negative: false, order: 0 });
    }
}

impl<'g> Symbol<'g> {
    /// The number where parameters have the values of the model.
    pub fn nominal(self) -> f64 {
        match self {
            Symbol::Constant(value) => value,
            Symbol::Value(tracer, edge) => tracer.nominal(edge),
        }
    }

    fn edge(self, tracer: &Tracer) -> Edge {
        match self {
            Symbol::Constant(value) => tracer.graph.borrow_mut().constant(value),
            Symbol::Value(_, edge) => edge,
        }
    }

    fn binary(
        self,
        other: Self,
        numbers: impl Fn(f64, f64) -> f64,
        symbols: impl Fn(&mut Graph, Edge, Edge) -> Edge,
    ) -> Self {
        let tracer = match (self, other) {
            (Symbol::Constant(a), Symbol::Constant(b)) => return Symbol::Constant(numbers(a, b)),
            (Symbol::Value(tracer, _), _) | (_, Symbol::Value(tracer, _)) => tracer,
        };
        let (a, b) = (self.edge(tracer), other.edge(tracer));
        let result = symbols(&mut tracer.graph.borrow_mut(), a, b);
        Self::folded(tracer, result)
    }

    fn unary(self, number: impl Fn(f64) -> f64, symbol: impl Fn(&mut Graph, Edge) -> Edge) -> Self {
        match self {
            Symbol::Constant(value) => Symbol::Constant(number(value)),
            Symbol::Value(tracer, edge) => {
                let result = symbol(&mut tracer.graph.borrow_mut(), edge);
                Self::folded(tracer, result)
            }
        }
    }

    fn folded(tracer: &'g Tracer, edge: Edge) -> Self {
        let constant = tracer.graph.borrow().constant_value(edge);
        constant.map_or(Symbol::Value(tracer, edge), Symbol::Constant)
    }
}

impl Scalar for Symbol<'_> {
    fn from_f64(value: f64) -> Self {
        Symbol::Constant(value)
    }

    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        (
            self.unary(|x| redysim_model::rotation::sin_cos(x).0, Graph::sin),
            self.unary(|x| redysim_model::rotation::sin_cos(x).1, Graph::cos),
        )
    }

    #[inline(never)]
    fn sqrt(self) -> Self {
        self.unary(f64::sqrt, Graph::sqrt)
    }
}

impl Parameter for Symbol<'_> {
    fn number(self) -> Option<f64> {
        match self {
            Symbol::Constant(value) => Some(value),
            Symbol::Value(..) => None,
        }
    }
}

impl<'g> Lift<Symbol<'g>> for Symbol<'g> {
    fn lift(self) -> Symbol<'g> {
        self
    }
}

impl Add for Symbol<'_> {
    type Output = Self;
    #[inline(never)]
    fn add(self, other: Self) -> Self {
        self.binary(other, |a, b| a + b, Graph::add)
    }
}

impl Sub for Symbol<'_> {
    type Output = Self;
    #[inline(never)]
    fn sub(self, other: Self) -> Self {
        self.binary(other, |a, b| a - b, |graph, a, b| graph.add(a, -b))
    }
}

impl Mul for Symbol<'_> {
    type Output = Self;
    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        self.binary(other, |a, b| a * b, Graph::multiply)
    }
}

impl Div for Symbol<'_> {
    type Output = Self;
    #[inline(never)]
    fn div(self, other: Self) -> Self {
        self.binary(other, |a, b| a / b, Graph::divide)
    }
}

impl Neg for Symbol<'_> {
    type Output = Self;
    #[inline(never)]
    fn neg(self) -> Self {
        self.unary(|a| -a, |_, a| -a)
    }
}

impl AddAssign for Symbol<'_> {
    #[inline(never)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Symbol<'_> {
    #[inline(never)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}
