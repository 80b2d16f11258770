//! Names of the variables of a program.

use crate::graph::Name;
use std::collections::HashSet;

/// Makes identifiers that differ from each other.
pub struct Identifiers<'a> {
    /// The name of each body of the tree, for the values that belong to it.
    bodies: &'a [String],
    taken: HashSet<String>,
    unnamed: usize,
}

impl<'a> Identifiers<'a> {
    /// Identifiers other than those that are `reserved`.
    pub fn new(bodies: &'a [String], reserved: &[&str]) -> Self {
        Identifiers { bodies, taken: reserved.iter().map(|name| name.to_string()).collect(), unnamed: 0 }
    }

    /// `name`, with a number if it is taken.
    pub fn unique(&mut self, name: &str) -> String {
        let mut unique = name.to_string();
        let mut copies = 1;
        while !self.taken.insert(unique.clone()) {
            copies += 1;
            unique = format!("{name}_{copies}");
        }
        unique
    }

    /// A name such as `w_a_z` for a named value of a loop over groups of bodies, which begin with body `first`.
    pub fn make_in_loop(&mut self, name: Option<Name>, first: usize) -> String {
        let letters = ["a", "b", "c"];
        match name {
            Some(name) => {
                let letter = name.body.checked_sub(first).and_then(|place| letters.get(place)).unwrap_or(&"x");
                self.unique(&spelled(name, letter, false))
            }
            None => self.make(None, false),
        }
    }

    /// A name such as `w_link3_z` for a named value, `t7` for another.
    pub fn make(&mut self, name: Option<Name>, flipped: bool) -> String {
        match name {
            Some(name) => self.unique(&spelled(name, &word(&self.bodies[name.body]), flipped)),
            None => {
                self.unnamed += 1;
                self.unique(&format!("t{}", self.unnamed))
            }
        }
    }
}

/// Sign, a `d` for each derivative, quantity, body and component.
fn spelled(name: Name, body: &str, flipped: bool) -> String {
    let sign = if name.negative == flipped { "" } else { "minus_" };
    let component = if name.component.is_empty() { String::new() } else { format!("_{}", name.component) };
    let derivative = if name.order == 0 { String::new() } else { "d".repeat(name.order.into()) + "_" };
    format!("{sign}{derivative}{}_{body}{component}", name.quantity)
}

/// A name of the model as part of an identifier.
fn word(name: &str) -> String {
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect()
}

/// The name of the variable by which a loop carries `name` to the next group.
pub fn carried(name: &str) -> String {
    format!("last_{name}")
}
