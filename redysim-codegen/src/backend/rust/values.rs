//! Values as Rust expressions.

use super::body::{COS, GIVEN, GROUP, ROW, SIN, local};
use crate::backend::binding::Binding;
use crate::program::{Index, Trig, Value};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use std::collections::HashMap;

/// The local name of `S::from_f64`.
pub const FROM_F64: &str = "k";

/// A number in full precision: the shortest digits that give the same `f64`.
pub fn constant(value: f64) -> TokenStream {
    if !value.is_finite() {
        // No checked model has such a number. If one arises all the same, the result shows it.
        return quote!(f64::NAN);
    }
    let digits: Literal = format!("{:?}", value.abs()).parse().expect("a finite number is a literal");
    if value < 0.0 { quote!(-#digits) } else { quote!(#digits) }
}

/// Prints statements and values.
pub struct Printer<'a> {
    /// The names of the function's arguments.
    pub arguments: &'a [&'a str],
    /// The path of the crate `redysim_runtime`.
    pub runtime: &'a TokenStream,
    /// Variables that are printed as these expressions.
    pub expressions: HashMap<String, TokenStream>,
}

impl Printer<'_> {
    /// The value of a carried variable before the first group.
    pub fn start(&self, value: &Value) -> TokenStream {
        if value.is_zero() { quote!(S::zero()) } else { self.value(value, Binding::Lowest) }
    }

    pub fn value(&self, value: &Value, binding: Binding) -> TokenStream {
        let (own, tokens) = match value {
            Value::Constant(value) => {
                let (k, value) = (local(FROM_F64), constant(*value));
                return quote!(#k(#value));
            }
            Value::GroupConstant(column) => {
                let (k, row, column) = (local(FROM_F64), local(ROW), Literal::usize_unsuffixed(*column));
                return quote!(#k(#row[#column]));
            }
            Value::Variable(name) => {
                let variable = local(name);
                return self.expressions.get(name).cloned().unwrap_or(quote!(#variable));
            }
            Value::Argument(argument, place) => {
                let (argument, place) = (local(self.arguments[*argument]), index(*place));
                return quote!(#argument[#place]);
            }
            Value::Given(place) => {
                let (given, place) = (local(GIVEN), Literal::usize_unsuffixed(*place));
                return quote!(#given[#place]);
            }
            Value::Trig(array, place) => {
                let (array, place) = (trig(*array), index(*place));
                return quote!(#array[#place]);
            }
            Value::LiveOut(array, row, column) | Value::OfBranch { array, branch: row, column, .. } => {
                let (array, [row, column]) = (local(array), [*row, *column].map(Literal::usize_unsuffixed));
                return quote!(#array[#row][#column]);
            }
            Value::Negative(a) => {
                let a = self.value(a, Binding::Unary);
                return quote!(-#a);
            }
            Value::MultiplyAdd(a, b, c) => {
                let [a, b, c] = [a, b, c].map(|operand| self.value(operand, Binding::Lowest));
                return quote!(S::mul_add(#a, #b, #c));
            }
            Value::SquareRoot(a) => {
                let a = self.value(a, Binding::Lowest);
                return quote!(S::sqrt(#a));
            }
            Value::Sine(a) | Value::Cosine(a) => {
                let (angle, part) = (self.value(a, Binding::Lowest), usize::from(matches!(value, Value::Cosine(_))));
                let part = Literal::usize_unsuffixed(part);
                return quote!(S::sin_cos(#angle).#part);
            }
            Value::Sum(a, b) => {
                let (a, b) = (self.value(a, Binding::Lowest), self.value(b, Binding::Sum));
                (Binding::Sum, quote!(#a + #b))
            }
            Value::Difference(a, b) => {
                let (a, b) = (self.value(a, Binding::Lowest), self.value(b, Binding::Sum));
                (Binding::Sum, quote!(#a - #b))
            }
            Value::Product(a, b) => {
                let (a, b) = (self.value(a, Binding::Sum), self.value(b, Binding::Product));
                (Binding::Product, quote!(#a * #b))
            }
            Value::Quotient(a, b) => {
                let (a, b) = (self.value(a, Binding::Sum), self.value(b, Binding::Product));
                (Binding::Product, quote!(#a / #b))
            }
        };
        if own.needs_parentheses(binding) { quote!((#tokens)) } else { tokens }
    }
}

pub fn trig(array: Trig) -> Ident {
    local(match array {
        Trig::Sines => SIN,
        Trig::Cosines => COS,
    })
}

fn index(index: Index) -> TokenStream {
    let group = local(GROUP);
    match index {
        Index::At(place) => {
            let place = Literal::usize_unsuffixed(place);
            quote!(#place)
        }
        Index::OfGroup { first, period } => {
            let [first_place, length] = [first, period].map(Literal::usize_unsuffixed);
            match (first, period) {
                (0, 1) => quote!(#group),
                (0, _) => quote!(#length * #group),
                (_, 1) => quote!(#group + #first_place),
                _ => quote!(#length * #group + #first_place),
            }
        }
    }
}
