//! Of very many warnings the first 20 are shown, and how many more there are.
#![deny(deprecated)]

redysim::redysim! {
    pub struct Robot("../../../models/warn/many_links.toml");
}

fn main() {}
