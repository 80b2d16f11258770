//! The body of a function as Rust: its program, printed as statements and expressions over `S: Scalar`.

use super::writes::{Moment, Write, Writes};
use crate::program::{Carried, Index, LiveOutArray, Loop, LoopRead, Program, SideBySide, Statement, Trig, Value};
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;
use std::collections::HashMap;

/// The names of the arguments that have the sines and the cosines of all angles.
pub const SIN: &str = "sin";
pub const COS: &str = "cos";
/// The name of the argument that has the numbers that are given at run time.
pub const GIVEN: &str = "given";
/// The local name of `S::from_f64`.
const FROM_F64: &str = "k";
/// The variable of a loop: which group of bodies it is at.
const GROUP: &str = "group";
/// The constants of the group.
const ROW: &str = "constants";

/// The matrix that a function gives, where it is not written as a literal.
pub const MATRIX: &str = "matrix";

/// Names that variables must not have, beside those of arguments.
pub const RESERVED: [&str; 10] = [GIVEN, FROM_F64, SIN, COS, GROUP, ROW, MATRIX, "read", "each", "write"];

/// The name of an argument or a local value.
pub fn local(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

/// A number in full precision: the shortest digits that give the same `f64`.
pub fn constant(value: f64) -> TokenStream {
    if !value.is_finite() {
        // No checked model has such a number. If one arises all the same, the result shows it.
        return quote!(f64::NAN);
    }
    let digits: Literal = format!("{:?}", value.abs()).parse().expect("a finite number is a literal");
    if value < 0.0 { quote!(-#digits) } else { quote!(#digits) }
}

/// The body of a function of the given arguments: statements, then the result that `result` makes of the outputs.
pub fn body(
    program: &Program,
    arguments: &[&str],
    runtime: &TokenStream,
    result: impl FnOnce(&[TokenStream]) -> TokenStream,
) -> TokenStream {
    let (printer, k) = (Printer { arguments, runtime }, local(FROM_F64));
    let statements = program.statements.iter().map(|statement| printer.statement(statement));
    let result = result(&printer.outputs(program));
    quote! {
        let #k = S::from_f64;
        #(#statements)*
        #result
    }
}

/// The body of a function that writes the elements of its matrix when `writes` has them.
pub fn writing_body(program: &Program, arguments: &[&str], runtime: &TokenStream, writes: &Writes) -> TokenStream {
    let (printer, k, matrix) = (Printer { arguments, runtime }, local(FROM_F64), local(MATRIX));
    let outputs = printer.outputs(program);
    let at = |moment| {
        let code = writes.at(moment).iter().map(|write| match *write {
            Write::Output(number) => {
                let value = &outputs[number];
                quote!(#matrix.write(#value);)
            }
            Write::Zeros => quote!(#matrix.zeros();),
        });
        quote!(#(#code)*)
    };
    let first = at(Moment::default());
    let by_rows = program.outputs.iter().zip(&outputs).collect::<Vec<_>>();
    let by_rows = by_rows.chunk_by(|(a, _), (b, _)| a.is_zero() && b.is_zero()).map(|run| match *run {
        [(output, value)] if !output.is_zero() => quote!(#matrix.push(#value);),
        _ => {
            let count = Literal::usize_unsuffixed(run.len());
            quote!(#matrix.zeros(#count);)
        }
    });
    let by_rows = quote!(#(#by_rows)*);
    let statements = (1..).zip(&program.statements).map(|(statements, statement)| {
        if let Statement::SideBySide(side_by_side) = statement {
            let (name, branches) = (local(&side_by_side.name), printer.side_by_side(side_by_side));
            let computed = (0..side_by_side.branches).map(|branch| {
                let (number, written) = (Literal::usize_unsuffixed(branch), at(Moment { statements, branch }));
                quote!(#name.compute(#number); #written)
            });
            quote!(let mut #name = #branches; #(#computed)*)
        } else {
            let (code, written) = (printer.statement(statement), at(Moment { statements, branch: 0 }));
            quote!(#code #written)
        }
    });
    let (count, runs) = (
        Literal::usize_unsuffixed(writes.runs.len()),
        writes.runs.iter().map(|run| {
            let [first, length] = run.map(Literal::usize_unsuffixed);
            quote!([#first, #length])
        }),
    );
    quote! {
        struct Order;
        impl #runtime::WritingOrder<#count> for Order {
            const RUNS: [[usize; 2]; #count] = [#(#runs),*];
        }
        let #k = S::from_f64;
        let mut #matrix = #matrix.elements::<Order, #count>();
        #first
        #(#statements)*
        #matrix.finish(#[inline(always)] |#matrix| { #by_rows })
    }
}

/// Prints statements and values.
struct Printer<'a> {
    /// The names of the function's arguments.
    arguments: &'a [&'a str],
    /// The path of the crate `redysim_runtime`.
    runtime: &'a TokenStream,
}

/// How tightly the surrounding expression binds; what binds less tightly gets parentheses.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Binding {
    Lowest,
    Sum,
    Product,
    Unary,
}

impl Printer<'_> {
    fn outputs(&self, program: &Program) -> Vec<TokenStream> {
        program.outputs.iter().map(|output| self.value(output, Binding::Lowest)).collect()
    }

    fn statement(&self, statement: &Statement) -> TokenStream {
        match statement {
            Statement::Destructure { array, names } => {
                let (array, names) = (trig(*array), patterns(names));
                quote!(let [#(#names),*] = *#array;)
            }
            Statement::Let { name, value } => {
                let (name, value) = (local(name), self.value(value, Binding::Lowest));
                quote!(let #name = #value;)
            }
            Statement::Block { statements, live_out } => {
                let code = statements.iter().map(|statement| self.statement(statement));
                let live_out: Vec<Ident> = live_out.iter().map(|name| local(name)).collect();
                quote! {
                    let [#(#live_out),*] = {
                        #(#code)*
                        [#(#live_out),*]
                    };
                }
            }
            Statement::Loop(each) => self.sweep(each),
            Statement::SideBySide(each) => {
                let (name, branches) = (local(&each.name), self.side_by_side(each));
                quote!(let #name = #branches.all();)
            }
        }
    }

    /// Branches, of which none is computed yet.
    ///
    /// ```text
    /// {
    ///     struct Branch;
    ///     impl<T: Scalar> Branches<T, 9, 4, 2> for Branch {
    ///         fn compute<S: Scalar>(read: &[T; 9], each: impl Fn([T; 4]) -> S, mut write: impl FnMut(usize, S)) {
    ///             let k = S::from_f64;
    ///             let v_hip = each([read[0], read[1], read[2], read[3]]);
    ///             let each1 = each([T::from_f64(0.1), …]);
    ///             let w_thigh_x = …;
    ///             write(0, w_thigh_x);
    ///         }
    ///     }
    ///     SideBySide::<S, Branch, 9, 4, 2>::new([v[6], v[9], …])
    /// }
    /// ```
    fn side_by_side(&self, SideBySide { branches, inputs, body, results, .. }: &SideBySide) -> TokenStream {
        let mut read: Vec<TokenStream> = Vec::new();
        let mut places: HashMap<String, usize> = HashMap::new();
        let inputs: Vec<TokenStream> = inputs
            .iter()
            .map(|input| {
                let values = input.branches.iter().map(|value| match value {
                    Value::Constant(value) => {
                        let value = constant(*value);
                        quote!(T::from_f64(#value))
                    }
                    value => {
                        let value = self.value(value, Binding::Lowest);
                        let place = *places.entry(value.to_string()).or_insert_with(|| {
                            read.push(value);
                            read.len() - 1
                        });
                        let place = Literal::usize_unsuffixed(place);
                        quote!(read[#place])
                    }
                });
                let (name, values) = (local(&input.name), values.collect::<Vec<_>>());
                quote!(let #name = each([#(#values),*]);)
            })
            .collect();
        let [reads, branches, columns] = [read.len(), *branches, results.len()].map(Literal::usize_unsuffixed);
        let code = body.iter().map(|statement| self.statement(statement));
        let results = results.iter().enumerate().map(|(column, result)| {
            let (column, result) = (Literal::usize_unsuffixed(column), local(result));
            quote!(write(#column, #result);)
        });
        let (k, runtime) = (local(FROM_F64), self.runtime);
        quote! {
            {
                struct Branch;
                impl<T: #runtime::Scalar> #runtime::Branches<T, #reads, #branches, #columns> for Branch {
                    #[inline(always)]
                    fn compute<S: #runtime::Scalar>(
                        read: &[T; #reads],
                        each: impl Fn([T; #branches]) -> S,
                        mut write: impl FnMut(usize, S),
                    ) {
                        let #k = S::from_f64;
                        #(#inputs)*
                        #(#code)*
                        #(#results)*
                    }
                }
                #runtime::SideBySide::<S, Branch, #reads, #branches, #columns>::new([#(#read),*])
            }
        }
    }

    /// ```text
    /// let mut last_w_a_x = w_link2_x;                       // carried from body to body
    /// let mut outward = [[S::zero(); 2]; 38];               // live-out: read after the loop
    /// for group in 0..38 {
    ///     let constants = &CONSTANTS[group];
    ///     let w_a_x = …;
    ///     last_w_a_x = w_a_x;
    ///     outward[group] = [force_a_x, moment_a_z];
    /// }
    /// ```
    ///
    /// `array::from_fn` would not have to set the array to zero first, but where the compiler does not inline its
    /// closure, carried variables go through memory.
    fn sweep(&self, Loop { groups, ascending, carried, live_out, constants, reads, body }: &Loop) -> TokenStream {
        let (group, row) = (local(GROUP), local(ROW));
        let length = Literal::usize_unsuffixed(*groups);
        let range = if *ascending { quote!(0..#length) } else { quote!((0..#length).rev()) };
        let starts = carried.iter().map(|Carried { name, start, .. }| {
            let (name, start) = (local(name), self.start(start));
            quote!(let mut #name = #start;)
        });
        let steps = carried.iter().map(|Carried { name, next, .. }| {
            let (name, next) = (local(name), local(next));
            quote!(#name = #next;)
        });
        let array = live_out.iter().map(|LiveOutArray { name, columns }| {
            let (array, width) = (local(name), Literal::usize_unsuffixed(columns.len()));
            quote!(let mut #array = [[S::zero(); #width]; #length];)
        });
        let store = live_out.iter().map(|LiveOutArray { name, columns }| {
            let (array, values) = (local(name), columns.iter().map(|name| local(name)));
            quote!(#array[#group] = [#(#values),*];)
        });
        let reads = reads.iter().map(|LoopRead { array, names }| {
            let (array, names) = (local(array), patterns(names));
            quote!(let [#(#names),*] = #array[#group];)
        });
        let table = table(constants);
        let constants = (!constants.is_empty()).then(|| quote!(let #row = &CONSTANTS[#group];));
        let code = body.iter().map(|statement| self.statement(statement));
        quote! {
            #(#starts)*
            #(#array)*
            {
                #table
                for #group in #range {
                    #constants
                    #(#reads)*
                    #(#code)*
                    #(#steps)*
                    #(#store)*
                }
            }
        }
    }

    /// The value of a carried variable before the first group.
    fn start(&self, value: &Value) -> TokenStream {
        if value.is_zero() { quote!(S::zero()) } else { self.value(value, Binding::Lowest) }
    }

    fn value(&self, value: &Value, binding: Binding) -> TokenStream {
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
                let name = local(name);
                return quote!(#name);
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
        if own <= binding && binding != Binding::Lowest { quote!((#tokens)) } else { tokens }
    }
}

fn trig(array: Trig) -> Ident {
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

/// A pattern for each element of an array.
fn patterns(names: &[Option<String>]) -> Vec<TokenStream> {
    let pattern = |name: &Option<String>| {
        name.as_ref().map_or(quote!(_), |name| {
            let name = local(name);
            quote!(#name)
        })
    };
    names.iter().map(pattern).collect()
}

/// The constants of all groups, by rows.
fn table(rows: &[Vec<f64>]) -> Option<TokenStream> {
    let [width, length] = [rows.first()?.len(), rows.len()].map(Literal::usize_unsuffixed);
    let rows = rows.iter().map(|row| {
        let values = row.iter().map(|&value| constant(value));
        quote!([#(#values),*])
    });
    Some(quote!(static CONSTANTS: [[f64; #width]; #length] = [#(#rows),*];))
}
