//! Long functions, cut into blocks.
//!
//! Each `let` of a scope opens a debug scope inside the one before it, and a few thousand of them, nested, are more
//! than the compiler bears in a dev build. So statements stand in blocks that hand on only what is read later.

use proc_macro2::{Ident, TokenStream};
use quote::quote;
use std::collections::{HashMap, HashSet};

/// The most statements in one scope.
const STATEMENTS_PER_BLOCK: usize = 250;

/// A `let` of one or two values.
pub struct Statement {
    /// The nodes it defines, with their identifiers.
    pub defines: Vec<(usize, Ident)>,
    /// The code.
    pub tokens: TokenStream,
    /// The nodes it reads.
    pub needs: Vec<usize>,
}

/// The statements in order, in blocks where they are many; `needed` are the nodes read after the last one.
pub fn in_blocks(statements: Vec<Statement>, needed: &[usize]) -> TokenStream {
    if statements.len() <= STATEMENTS_PER_BLOCK {
        return statements.into_iter().map(|statement| statement.tokens).collect();
    }
    let mut last_reads: HashMap<usize, usize> = HashMap::new();
    for (position, statement) in statements.iter().enumerate() {
        last_reads.extend(statement.needs.iter().map(|&node| (node, position)));
    }
    last_reads.extend(needed.iter().map(|&node| (node, usize::MAX)));
    let mut blocks = TokenStream::new();
    for (number, block) in statements.chunks(STATEMENTS_PER_BLOCK).enumerate() {
        let end = number * STATEMENTS_PER_BLOCK + block.len();
        let read_later: HashSet<usize> =
            last_reads.iter().filter(|&(_, &position)| position >= end).map(|(&node, _)| node).collect();
        let live: Vec<&Ident> = block
            .iter()
            .flat_map(|statement| &statement.defines)
            .filter(|(node, _)| read_later.contains(node))
            .map(|(_, ident)| ident)
            .collect();
        let code = block.iter().map(|statement| &statement.tokens);
        blocks.extend(quote! {
            let [#(#live),*] = {
                #(#code)*
                [#(#live),*]
            };
        });
    }
    blocks
}
