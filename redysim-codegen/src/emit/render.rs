//! Values and operations as Rust expressions.

use super::loops::{ROW, carried, index_in_loop};
use super::{COS, Emitter, FROM_F64, SIN, constant, local};
use crate::graph::{Edge, Node};
use crate::rolled::{Constant, TEMPLATE};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// Where an expression stands, and what it has read so far.
#[derive(Default)]
pub struct Scope {
    /// The loop it is in.
    pub sweep: Option<usize>,
    /// The nodes outside of loops that have a `let` and are read.
    pub needs: Vec<usize>,
}

/// How tightly the surrounding expression binds; what binds less tightly gets parentheses.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
pub enum Binding {
    Lowest,
    Sum,
    Product,
    Unary,
}

/// An operand of an operation.
#[derive(Clone, Copy)]
struct Operand {
    edge: Edge,
    /// The operation.
    user: usize,
    /// Which of its operands.
    number: usize,
}

impl Operand {
    fn flipped_if(self, flip: bool) -> Operand {
        Operand { edge: self.edge.flipped_if(flip), ..self }
    }
}

impl Emitter<'_> {
    /// A value as an expression.
    pub fn render(&self, edge: Edge, binding: Binding, scope: &mut Scope) -> TokenStream {
        let index = edge.node();
        if let Some(value) = self.graph.constant_value(edge) {
            let (k, value) = (local(FROM_F64), constant(value));
            return quote!(#k(#value));
        }
        if let Some((negative, value)) = self.loop_value(index, scope) {
            return if edge.is_negative() != negative { quote!(-#value) } else { value };
        }
        let negative = edge.is_negative() != self.flipped[index];
        if let Some(ident) = &self.idents[index] {
            scope.needs.push(index);
            return if negative { quote!(-#ident) } else { quote!(#ident) };
        }
        match self.graph.node(index) {
            Node::Input { argument, index } => {
                let argument = local(self.vocabulary.arguments[usize::from(argument)]);
                let index = self.element(index as usize, scope);
                if negative { quote!(-#argument[#index]) } else { quote!(#argument[#index]) }
            }
            Node::Sin(_) | Node::Cos(_) => {
                let function = if matches!(self.graph.node(index), Node::Sin(_)) { SIN } else { COS };
                let function = local(function);
                let index = self.element(self.positions[&index], scope);
                if negative { quote!(-#function[#index]) } else { quote!(#function[#index]) }
            }
            Node::Subtract(..) => self.operation(index, edge.is_negative(), binding, scope),
            _ if negative => {
                let value = self.operation(index, false, Binding::Unary, scope);
                quote!(-#value)
            }
            _ => self.operation(index, false, binding, scope),
        }
    }

    /// The operation of a node; of a subtraction, the other way round if `flip`.
    pub fn operation(&self, user: usize, flip: bool, binding: Binding, scope: &mut Scope) -> TokenStream {
        let operand = |edge, number| Operand { edge, user, number };
        let (own, tokens) = match self.graph.node(user) {
            Node::Add(a, b) => self.sum(operand(a, 0), operand(b, 1), scope),
            Node::Subtract(a, b) => self.sum(operand(a, 0).flipped_if(flip), operand(b, 1).flipped_if(!flip), scope),
            Node::Multiply(a, b) => {
                let a = self.operand(operand(a, 0), Binding::Sum, scope);
                let b = self.operand(operand(b, 1), Binding::Product, scope);
                (Binding::Product, quote!(#a * #b))
            }
            Node::Divide(a, b) => {
                let a = self.operand(operand(a, 0), Binding::Sum, scope);
                let b = self.operand(operand(b, 1), Binding::Product, scope);
                (Binding::Product, quote!(#a / #b))
            }
            Node::Sqrt(a) => {
                let a = self.operand(operand(a, 0), Binding::Lowest, scope);
                (Binding::Unary, quote!(S::sqrt(#a)))
            }
            Node::Sin(_) | Node::Cos(_) | Node::Input { .. } | Node::Constant(_) => {
                unreachable!("sines, cosines, inputs and constants are no operations")
            }
        };
        if own <= binding && binding != Binding::Lowest { quote!((#tokens)) } else { tokens }
    }

    /// a + b: fused where one of them is a product for it, else with a minus sign between them where one has it.
    fn sum(&self, a: Operand, b: Operand, scope: &mut Scope) -> (Binding, TokenStream) {
        for (product, addend) in [(a, b), (b, a)] {
            let node = product.edge.node();
            if self.fused[node]
                && let Node::Multiply(x, y) = self.graph.node(node)
            {
                let x = Operand { edge: x.flipped_if(product.edge.is_negative()), user: node, number: 0 };
                let y = Operand { edge: y, user: node, number: 1 };
                let [x, y, addend] = [x, y, addend].map(|operand| self.operand(operand, Binding::Lowest, scope));
                return (Binding::Unary, quote!(S::mul_add(#x, #y, #addend)));
            }
        }
        let (a, b) = if self.has_minus(a, scope) && !self.has_minus(b, scope) { (b, a) } else { (a, b) };
        let left = self.operand(a, Binding::Lowest, scope);
        if self.has_minus(b, scope) {
            let right = self.operand(b.flipped_if(true), Binding::Sum, scope);
            (Binding::Sum, quote!(#left - #right))
        } else {
            let right = self.operand(b, Binding::Sum, scope);
            (Binding::Sum, quote!(#left + #right))
        }
    }

    /// Whether the value is written with a minus sign in front.
    fn has_minus(&self, Operand { edge, .. }: Operand, scope: &Scope) -> bool {
        if let Some((negative, _)) = self.loop_value(edge.node(), scope) {
            return edge.is_negative() != negative;
        }
        let turned = self.idents[edge.node()].is_none() && matches!(self.graph.node(edge.node()), Node::Subtract(..));
        !turned && edge.is_negative() != self.flipped[edge.node()]
    }

    /// An operand: in a loop, constants come from its table.
    fn operand(&self, operand: Operand, binding: Binding, scope: &mut Scope) -> TokenStream {
        let Operand { edge, user, number } = operand;
        let constant_in_loop = self.rolled.as_ref().and_then(|rolled| rolled.constant(user, number));
        match (scope.sweep, constant_in_loop) {
            (Some(_), Some(value)) => {
                let k = local(FROM_F64);
                let negative = edge.is_negative();
                match value {
                    Constant::Same(value) => {
                        let value = constant(if negative { -value } else { value });
                        quote!(#k(#value))
                    }
                    Constant::Column(column) => {
                        let (row, column) = (local(ROW), Literal::usize_unsuffixed(column));
                        if negative { quote!(-#k(#row[#column])) } else { quote!(#k(#row[#column])) }
                    }
                }
            }
            _ => self.render(edge, binding, scope),
        }
    }

    /// Where element `index` of an argument is, which in a loop depends on the group.
    fn element(&self, index: usize, scope: &Scope) -> TokenStream {
        match (scope.sweep, &self.rolled) {
            (Some(_), Some(rolled)) => index_in_loop(index - TEMPLATE * rolled.period, rolled.period),
            _ => {
                let index = Literal::usize_unsuffixed(index);
                quote!(#index)
            }
        }
    }

    /// A value that a loop computes, as it is read from outside its own step, and whether it is the negative of what is
    /// read.
    fn loop_value(&self, index: usize, scope: &Scope) -> Option<(bool, TokenStream)> {
        let place = self.rolled.as_ref()?.place(index)?;
        let ident = self.idents[place.image].as_ref();
        match scope.sweep {
            Some(sweep) if sweep == place.sweep && place.group == TEMPLATE => None,
            Some(sweep) if sweep == place.sweep => {
                let last = carried(ident?);
                Some((place.negative, quote!(#last)))
            }
            Some(_) => Some((place.negative, quote!(#ident))),
            None => {
                let rolled = self.rolled.as_ref()?;
                let sweep = &rolled.sweeps[place.sweep];
                if place.group == rolled.last_group(place.sweep) {
                    let last = carried(ident?);
                    return Some((place.negative, quote!(#last)));
                }
                let slot = sweep.kept.iter().position(|&node| node == place.image)?;
                let [group, slot] = [place.group, slot].map(Literal::usize_unsuffixed);
                let array = &self.arrays[place.sweep];
                Some((place.negative, quote!(#array[#group][#slot])))
            }
        }
    }
}
