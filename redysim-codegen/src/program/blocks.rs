//! Long functions, cut into blocks.
//!
//! Each `let` opens a debug scope inside that of the `let` before it, and a few thousand nested scopes crash the
//! compiler in a dev build. So statements stand in blocks, each of which returns only what is read later.

use super::Statement;
use std::collections::{HashMap, HashSet};

/// The most statements in one scope.
const STATEMENTS_PER_BLOCK: usize = 250;

/// The statements in order, in blocks if there are many; `read_later` are the variables read after the last one.
pub fn in_blocks(statements: Vec<Statement>, read_later: &HashSet<String>) -> Vec<Statement> {
    if statements.len() <= STATEMENTS_PER_BLOCK {
        return statements;
    }
    let mut last_reads: HashMap<String, usize> = HashMap::new();
    for (position, statement) in statements.iter().enumerate() {
        statement.reads(&mut |name| _ = last_reads.insert(name.to_string(), position));
    }
    let is_read_from = |name: &str, end: usize| {
        read_later.contains(name) || last_reads.get(name).is_some_and(|&position| position >= end)
    };
    let mut rest = statements.into_iter();
    let mut blocks = Vec::new();
    while rest.len() > 0 {
        let statements: Vec<Statement> = rest.by_ref().take(STATEMENTS_PER_BLOCK).collect();
        let end = blocks.len() * STATEMENTS_PER_BLOCK + statements.len();
        let defined = statements.iter().filter_map(|statement| match statement {
            Statement::Let { name, .. } => Some(name),
            Statement::Destructure { .. } | Statement::Block { .. } | Statement::Loop(_) | Statement::SideBySide(_) => {
                None
            }
        });
        let live_out = defined.filter(|name| is_read_from(name, end)).cloned().collect();
        blocks.push(Statement::Block { statements, live_out });
    }
    blocks
}
