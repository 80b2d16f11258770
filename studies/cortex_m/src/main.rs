//! The dynamics of two robots in `f32`: on the board the instructions of a call, a line `name count` for each function;
//! on the board and on the host what the functions return, a line `name: hash` for each, which must be the same.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod counts;
mod robots;

#[cfg(not(target_os = "none"))]
fn main() {
    struct Results;

    impl robots::Visitor for Results {
        fn visit<I, R: robots::Numbers>(&mut self, name: &str, inputs: &[I; robots::CALLS], function: fn(&I) -> R) {
            println!("{name}: {:016x}", robots::hash(inputs, function));
        }
    }

    robots::visit_all(&mut Results);
}
