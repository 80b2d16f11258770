//! What tolerances save on a model whose joints have ranges:
//! `cargo run --release -p redysim-codegen --example prune_gains -- models/test/kr5_ranges.toml`.

use redysim_codegen::functions::trace_model;
use redysim_codegen::passes::Passes;
use redysim_model::{CodegenOptions, Functions, Model};
use std::time::Instant;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let functions = ["inverse_dynamics", "forward_dynamics", "mass_matrix", "bias_forces", "gravity_forces"];
    for path in std::env::args().skip(1) {
        let model = Model::load(&path)?.model;
        println!("{path}");
        for exponent in 1..=6 {
            let tolerance = 10_f64.powi(-exponent);
            let options = CodegenOptions {
                functions: Functions::named(functions)?,
                tolerance: Some(tolerance),
                ..CodegenOptions::default()
            };
            let start = Instant::now();
            let traced = trace_model(&model, &options, &Passes::all())?;
            println!("  to {tolerance:e}, in {:.1?}", start.elapsed());
            for function in traced {
                let (Some(pruning), count) = (function.pruning, function.expressions.count()) else { continue };
                println!(
                    "    {:<18}{:>5} flops of {:>5}, {} pairs of {}, error {:.1e}{}",
                    function.function.name(),
                    count.flops(),
                    pruning.before.flops(),
                    count.trig,
                    pruning.before.trig,
                    pruning.worst,
                    if pruning.holds { "" } else { ": left whole" },
                );
            }
        }
    }
    Ok(())
}
