//! How operations, code, compile time and time per call grow with the number of joints.
//!
//! `cargo run --release` builds chains of 5 to 100 links with all functions, in the dev profile, in release, and in
//! release for this machine's processor, and prints tables in Markdown; `cargo run --release -- 10 80` those of 10 and
//! 80 links only. Leave the machine alone meanwhile.

mod chain;
mod generated;
mod package;
mod robot;
mod sizes;
mod tables;

use redysim_codegen::passes::Passes;
use robot::{Empty, Row};

/// How many links the chains have.
const LINKS: [usize; 9] = [5, 10, 20, 30, 40, 50, 60, 80, 100];
/// Programs are run in turns, this many times: the shortest times count.
const ROUNDS: usize = 7;
/// Links of the chain on which loops are compared with straight code.
const LONG: usize = 80;

const KR5: &str = include_str!("../../../models/kr5.toml");

fn main() {
    let mut links: Vec<usize> = std::env::args().skip(1).map(|word| word.parse().expect("a number of links")).collect();
    if links.is_empty() {
        links = LINKS.to_vec();
    }
    let empty = Empty::measured();
    println!("Without a robot: {:.2} s in dev, {:.2} s in release.", empty.dev, empty.release);
    let kr5 = Row::built("kr5", 6, KR5, &empty);
    let chain = |&count: &usize| Row::built(&format!("chain{count}"), count, &chain::model(count), &empty);
    let mut rows: Vec<Row> = std::iter::once(kr5).chain(links.iter().map(chain)).collect();
    let mut long = Vec::new();
    if links.contains(&LONG) {
        for (name, loops) in [("loops", true), ("straight", false)] {
            let passes = Passes { loops, ..Passes::all() };
            long.push(Row::from_source(name, LONG, &chain::model(LONG), &passes, &empty));
        }
    }
    for _ in 0..ROUNDS {
        rows.iter_mut().chain(&mut long).for_each(Row::run);
    }
    tables::print_times("Inverse dynamics", 0, &rows[1..]);
    tables::print_times("Forward dynamics", 1, &rows[1..]);
    tables::print_builds(&rows, &empty);
    if !long.is_empty() {
        tables::print_loops(&long, &empty);
    }
}
