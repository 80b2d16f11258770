//! scratch
use redysim_codegen::functions::trace_with;
use redysim_codegen::passes::Passes;
use redysim_model::{Model, Tree};
use std::time::Instant;
fn main() {
    let all = Passes::default();
    let sets = [
        ("none", Passes::none()),
        ("all", all),
        ("-base", Passes { base_parameters: false, ..all }),
        ("-frames", Passes { frames: false, ..all }),
        ("-axis", Passes { axis_masses: false, ..all }),
        ("-parallel", Passes { parallel_axes: false, ..all }),
        ("-units", Passes { units: false, ..all }),
        ("-squares", Passes { squares: false, ..all }),
        ("-factors", Passes { factors: false, ..all }),
        ("-sums", Passes { sums: false, ..all }),
    ];
    let mut args: Vec<String> = std::env::args().skip(1).collect();
    let only = args[0] == "-a";
    if only {
        args.remove(0);
    }
    for name in args {
        let path = format!("{}/../models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(&path).unwrap();
        let model = Model::from_toml(text, &path).unwrap_or_else(|f| panic!("{f}")).model;
        let tree = Tree::new(&model);
        println!("{name}");
        for (set, passes) in &sets {
            if only && *set != "all" {
                continue;
            }
            let start = Instant::now();
            print!("{set:10}");
            let functions = trace_with(&tree, passes);
            for f in functions {
                let c = f.expressions.count();
                if c.flops() > 0 {
                    print!(" {}: {} ({}t)", f.signature.name, c.flops(), c.trig);
                }
            }
            println!(" {:?}", start.elapsed());
        }
    }
}
