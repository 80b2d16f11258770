//! What each pass gains on a model: `cargo run --release -p redysim-codegen --example pass_gains -- models/kr5.toml`.

use redysim_codegen::functions::trace_with;
use redysim_codegen::passes::Passes;
use redysim_model::{Model, Tree};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for path in std::env::args().skip(1) {
        let tree = Tree::new(&Model::load(&path)?.model);
        println!("{path}");
        for (set, passes) in Passes::variations() {
            let start = Instant::now();
            let functions = trace_with(&tree, &passes)?;
            let time = start.elapsed();
            println!("  {set}, traced in {time:.1?}");
            for function in functions {
                let count = function.expressions.count();
                if count.flops() > 0 {
                    let name = function.function.name();
                    println!("    {name:<18}{:>7} flops, {:>3} sine-cosine pairs", count.flops(), count.trig);
                }
            }
        }
    }
    Ok(())
}
