//! Of very many faults the first 20 are shown, and how many more there are.

redysim::redysim! {
    pub struct Robot("../../../models/fail/many_links.toml");
}

fn main() {}
