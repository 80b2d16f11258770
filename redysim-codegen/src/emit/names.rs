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

    /// Keeps an identifier from being handed out.
    pub fn reserve(&mut self, name: &str) {
        self.taken.insert(name.to_string());
    }

    /// An identifier like `name`.
    pub fn unique(&mut self, name: &str) -> Ident {
        let mut unique = name.to_string();
        let mut copies = 1;
        while !self.taken.insert(unique.clone()) {
            copies += 1;
            unique = format!("{name}_{copies}");
        }
        local(&unique)
    }

    /// An identifier such as `w_a_z` for a named value of a loop over groups of bodies, which begin with body `first`.
    pub fn make_in_loop(&mut self, name: Option<Name>, first: usize) -> Ident {
        let letters = ["a", "b", "c"];
        match name {
            Some(name) => {
                let letter = name.body.checked_sub(first).and_then(|place| letters.get(place)).unwrap_or(&"x");
                self.unique(&spelled(name, letter, false))
            }
            None => self.make(None, false),
        }
    }

    /// An identifier such as `w_link3_z` for a named value, `t7` for another.
    pub fn make(&mut self, name: Option<Name>, flipped: bool) -> Ident {
        match name {
            Some(name) => self.unique(&spelled(name, &word(&self.bodies[name.body]), flipped)),
            None => {
                self.unnamed += 1;
                self.unique(&format!("t{}", self.unnamed))
            }
        }
    }
}

/// Sign, quantity, body and component.
fn spelled(name: Name, body: &str, flipped: bool) -> String {
    let sign = if name.negative == flipped { "" } else { "minus_" };
    let component = if name.component.is_empty() { String::new() } else { format!("_{}", name.component) };
    format!("{sign}{}_{body}{component}", name.quantity)
}

/// The part of an identifier that stands for a name of the model.
fn word(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect()
}
