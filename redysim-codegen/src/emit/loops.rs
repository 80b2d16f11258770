//! One sweep over alike bodies as a loop.

use super::blocks::Statement;
use super::render::{Binding, Scope};
use super::{Emitter, constant, local};
use crate::rolled::{Rolled, Sweep};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

/// The variable of a loop: which group of bodies it is at.
pub const GROUP: &str = "group";
/// The constants of the group.
pub const ROW: &str = "constants";

/// What a loop carries from one group to the next.
pub fn carried(ident: &Ident) -> Ident {
    format_ident!("last_{ident}")
}

/// Where a value stands in an array, in a loop over groups of `period` bodies: `first + period · group`.
pub fn index_in_loop(first: usize, period: usize) -> TokenStream {
    let group = local(GROUP);
    let [first_index, period_length] = [first, period].map(Literal::usize_unsuffixed);
    match (first, period) {
        (0, 1) => quote!(#group),
        (0, _) => quote!(#period_length * #group),
        (_, 1) => quote!(#group + #first_index),
        _ => quote!(#period_length * #group + #first_index),
    }
}

impl Emitter<'_> {
    /// The loop for sweep number `number`:
    ///
    /// ```text
    /// let mut last_w_a_x = w_link2_x;                       // what goes from body to body
    /// let mut outward = [[S::zero(); 2]; 38];               // what is read elsewhere
    /// for group in 0..38 {
    ///     let constants = &CONSTANTS[group];
    ///     let w_a_x = …;
    ///     last_w_a_x = w_a_x;
    ///     outward[group] = [force_a_x, moment_a_z];
    /// }
    /// ```
    ///
    /// An array from a closure would not have to be set to zero first, but where the compiler does not inline the
    /// closure, what goes from body to body goes through memory.
    pub fn rolled_sweep(&self, number: usize) -> Statement {
        let rolled = self.rolled.as_ref().expect("only loops are rolled");
        let sweep = &rolled.sweeps[number];
        let mut outside = Scope::default();
        let starts: Vec<TokenStream> = sweep
            .carried
            .iter()
            .map(|(_, start)| {
                start.map_or(quote!(S::zero()), |start| self.render(start, Binding::Lowest, &mut outside))
            })
            .collect();
        let mut inside = Scope { sweep: Some(number), needs: Vec::new() };
        let statements: Vec<Statement> = sweep
            .template
            .iter()
            .filter_map(|&node| Some(self.statement(node, self.idents[node].as_ref()?, &mut inside)))
            .collect();
        let code: TokenStream = statements.iter().map(|statement| statement.tokens.clone()).collect();
        let ident = |node: usize| self.idents[node].as_ref();
        let values: Vec<&Ident> = sweep.carried.iter().filter_map(|(node, _)| ident(*node)).collect();
        let lasts: Vec<Ident> = values.iter().map(|ident| carried(ident)).collect();
        let (array, group, row) = (&self.arrays[number], local(GROUP), local(ROW));
        let kept: Vec<&Ident> = sweep.kept.iter().filter_map(|&node| ident(node)).collect();
        let [groups, width] = [rolled.groups, kept.len()].map(Literal::usize_unsuffixed);
        let range = if sweep.ascending { quote!(0..#groups) } else { quote!((0..#groups).rev()) };
        let reads = self.reads_of_other_loops(rolled, number);
        let table = table(sweep, rolled.groups);
        let constants = (!sweep.columns.is_empty()).then(|| quote!(let #row = &CONSTANTS[#group];));
        let keeping = (!kept.is_empty()).then(|| quote!(let mut #array = [[S::zero(); #width]; #groups];));
        let keep = (!kept.is_empty()).then(|| quote!(#array[#group] = [#(#kept),*];));
        let tokens = quote! {
            #(let mut #lasts = #starts;)*
            #keeping
            {
                #table
                for #group in #range {
                    #constants
                    #reads
                    #code
                    #(#lasts = #values;)*
                    #keep
                }
            }
        };
        let own = |node: &usize| sweep.template.binary_search(node).is_err();
        let needs = statements.into_iter().flat_map(|statement| statement.needs).filter(own);
        Statement { defines: Vec::new(), tokens, needs: outside.needs.into_iter().chain(needs).collect() }
    }

    /// Takes what other loops have kept for the same group.
    fn reads_of_other_loops(&self, rolled: &Rolled, number: usize) -> TokenStream {
        let reads = rolled.sweeps[..number].iter().zip(&self.arrays).map(|(other, array)| {
            let names: Vec<TokenStream> = other
                .kept
                .iter()
                .map(|&node| {
                    let read = rolled.sweeps[number]
                        .template
                        .iter()
                        .any(|&user| self.graph.node(user).operands().any(|operand| operand.node() == node));
                    let ident = self.idents[node].as_ref().filter(|_| read);
                    ident.map_or(quote!(_), |ident| quote!(#ident))
                })
                .collect();
            let any = names.iter().any(|name| name.to_string() != "_");
            let group = local(GROUP);
            any.then(|| quote!(let [#(#names),*] = #array[#group];))
        });
        reads.flatten().collect()
    }
}

/// The constants of all groups, by rows.
fn table(sweep: &Sweep, groups: usize) -> Option<TokenStream> {
    let [width, length] = [sweep.columns.len(), groups].map(Literal::usize_unsuffixed);
    let rows = (0..groups).map(|group| {
        let values = sweep.columns.iter().map(|column| constant(column[group]));
        quote!([#(#values),*])
    });
    (!sweep.columns.is_empty()).then(|| quote!(static CONSTANTS: [[f64; #width]; #length] = [#(#rows),*];))
}
