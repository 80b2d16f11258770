//! The body of a function as Rust: its program, printed as statements and expressions over `S: Scalar`.

use super::moments::Moment;
use super::sines::SinesWhenRead;
use super::values::{FROM_F64, Printer, constant, trig};
use super::writes::Writes;
use crate::backend::binding::Binding;
use crate::program::{Carried, LiveOutArray, Loop, LoopRead, Program, SideBySide, Statement, Value};
use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;
use std::collections::HashMap;

/// The names of the arguments that have the sines and the cosines of all angles.
pub const SIN: &str = "sin";
pub const COS: &str = "cos";
/// The name of the argument that has the numbers that are given at run time.
pub const GIVEN: &str = "given";
/// The variable of a loop: which group of bodies it is at.
pub const GROUP: &str = "group";
/// The constants of the group.
pub const ROW: &str = "constants";

/// The sines and cosines of a function that computes them when it reads them.
pub const SINES: &str = "sines";
/// The matrix that a function gives, where it is not written as a literal.
pub const MATRIX: &str = "matrix";

/// Names that variables must not have, beside those of arguments.
pub const RESERVED: [&str; 11] = [GIVEN, FROM_F64, SIN, COS, GROUP, ROW, SINES, MATRIX, "read", "each", "write"];

/// The name of an argument or a local value.
pub fn local(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

/// When a function does what it need not do at once.
#[derive(Default)]
pub struct Schedule {
    /// The writes of the elements of its matrix, if it writes them.
    pub writes: Option<Writes>,
    /// The computation of its sines and cosines, if it does not have them from the beginning.
    pub sines: Option<SinesWhenRead>,
}

/// The body of a function of the given arguments: statements, then the result that `result` makes of the outputs, or the matrix
/// of which all elements are written.
pub fn body(
    program: &Program,
    arguments: &[&str],
    runtime: &TokenStream,
    schedule: &Schedule,
    result: impl FnOnce(&[TokenStream]) -> TokenStream,
) -> TokenStream {
    let Schedule { writes, sines } = schedule;
    let expressions = sines.as_ref().map_or_else(HashMap::new, SinesWhenRead::expressions);
    let (printer, k, matrix) = (Printer { arguments, runtime, expressions }, local(FROM_F64), local(MATRIX));
    let outputs = printer.outputs(program);
    let computed_before = |moment| sines.as_ref().map(|sines| sines.computed_before(moment));
    let written_after = |moment| writes.as_ref().map(|writes| writes.after(moment, &outputs));
    let (computed, first) = (computed_before(Moment::default()), written_after(Moment::default()));
    let statements = (1..).zip(&program.statements).map(|(number, statement)| match statement {
        Statement::SideBySide(each) if writes.is_some() => {
            let (name, (branches, read)) = (local(&each.name), printer.side_by_side(each, true));
            let computed = (0..each.branches).map(|branch| {
                let moment = Moment { statement: number, branch };
                let (computed, written) = (computed_before(moment), written_after(moment));
                let branch = Literal::usize_unsuffixed(branch);
                quote!(#computed #name.compute(#branch, &#read); #written)
            });
            quote!(let mut #name = #branches; #(#computed)*)
        }
        _ => {
            let is_replaced = matches!(statement, Statement::Destructure { .. }) && sines.is_some();
            let code = (!is_replaced).then(|| printer.statement(statement));
            let written = written_after(Moment { statement: number, branch: 0 });
            quote!(#code #written)
        }
    });
    let (begun, result) = match writes {
        Some(writes) => {
            let (order, count) = writes.order(runtime);
            let by_rows = Writes::by_rows(program, &outputs);
            (
                quote!(#order let mut #matrix = #matrix.elements::<Order, #count>(); #first),
                quote!(#matrix.finish(#[inline(always)] |#matrix| { #by_rows })),
            )
        }
        None => (TokenStream::new(), result(&outputs)),
    };
    quote! {
        let #k = S::from_f64;
        #begun
        #computed
        #(#statements)*
        #result
    }
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
                let (name, (branches, _)) = (local(&each.name), self.side_by_side(each, false));
                quote!(let #name = #branches;)
            }
        }
    }

    /// The results of all branches, or, to compute them `one_by_one`, none yet; and what the branches read.
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
    ///     SideBySide::<S, Branch, 9, 4, 2>::all(&[v[6], v[9], …])
    /// }
    /// ```
    fn side_by_side(
        &self,
        SideBySide { branches, inputs, body, results, .. }: &SideBySide,
        one_by_one: bool,
    ) -> (TokenStream, TokenStream) {
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
        let (k, runtime, read) = (local(FROM_F64), self.runtime, quote!([#(#read),*]));
        let results_of_all = if one_by_one { quote!(begun()) } else { quote!(all(&#read)) };
        let branches = quote! {
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
                #runtime::SideBySide::<S, Branch, #reads, #branches, #columns>::#results_of_all
            }
        };
        (branches, read)
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
