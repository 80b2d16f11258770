//! What each way to accelerations and each pass costs in digits, and what it saves in operations.
use redysim_codegen::accuracy::{Quantity, Reference};
use redysim_codegen::functions::trace_with;
use redysim_codegen::passes::Passes;
use redysim_model::{Model, Tree};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for path in std::env::args().skip(1) {
        let model = Model::load(&path)?.model;
        let tree = Tree::new(&model);
        let reference = Reference::new(&tree);
        println!("{path}: recursion on numbers {:?}", Quantity::ALL.map(|quantity| reference.lost_on(&tree, quantity)));
        for (name, passes) in [("none", Passes::none()), ("all", Passes::all())] {
            let start = std::time::Instant::now();
            let functions = trace_with(&tree, &passes)?;
            let [inverse, forward, matrix, ..] = &functions[..] else { unreachable!() };
            let computed =
                [(Quantity::Forces, inverse), (Quantity::Accelerations, forward), (Quantity::Matrix, matrix)];
            let lost =
                computed.map(|(quantity, function)| reference.lost_by(quantity, |x| function.expressions.evaluate(x)));
            println!(
                "  {name}: {lost:?} {:?} {:?}",
                start.elapsed(),
                [inverse, forward, matrix].map(|f| f.expressions.count().flops())
            );
            println!("  {}", forward.remark.as_ref().unwrap());
        }
    }
    Ok(())
}
