//! Identifiers of the generated code.

use super::local;
use crate::graph::Name;
use proc_macro2::Ident;
use std::collections::HashSet;

/// Hands out identifiers, each once.
pub struct Identifiers<'a> {
    /// The name of each body of the tree, for the values that belong to it.
    bodies: &'a [String],
    taken: HashSet<String>,
    unnamed: usize,
}

impl<'a> Identifiers<'a> {
    /// Identifiers for a function whose arguments have the names `reserved`.
    pub fn new(bodies: &'a [String], reserved: &[&str]) -> Self {
        Identifiers { bodies, taken: reserved.iter().map(|name| name.to_string()).collect(), unnamed: 0 }
    }

    /// An identifier such as `w_link3_z` for a named value, `t7` for another.
    pub fn make(&mut self, name: Option<Name>, flipped: bool) -> Ident {
        let text = match name {
            Some(name) => {
                let sign = if name.negative == flipped { "" } else { "minus_" };
                let component = if name.component.is_empty() { String::new() } else { format!("_{}", name.component) };
                format!("{sign}{}_{}{component}", name.quantity, word(&self.bodies[name.body]))
            }
            None => {
                self.unnamed += 1;
                format!("t{}", self.unnamed)
            }
        };
        let mut unique = text.clone();
        let mut copies = 1;
        while !self.taken.insert(unique.clone()) {
            copies += 1;
            unique = format!("{text}_{copies}");
        }
        local(&unique)
    }
}

/// The part of an identifier that stands for a name of the model.
fn word(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect()
}
