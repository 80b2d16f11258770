//! Digits against operations: both ways to accelerations, and each pass of the generator left out, on robots for which
//! the one or the other costs digits.

use redysim_codegen::accuracy::Reference;
use redysim_codegen::functions::{MethodChoice, trace_of};
use redysim_codegen::passes::Passes;
use redysim_model::denoc::Method;
use redysim_model::{AccelerationMethod, CodegenOptions, Function, Functions, Model, Tree};

use crate::chains::{Rod, chain, oblique, palm};
use crate::common::csv::Csv;
use crate::common::figure::{Figure, Panel};
use crate::common::outputs::workspace;
use crate::common::table::{Table, headline, remark, tiny};
use crate::common::{Failure, Outputs};
use crate::random::Random;
use crate::styles::Style;

/// Switches passes off.
type Switch = fn(&mut Passes);

/// What is left out of all passes.
const LEFT_OUT: [(&str, Switch); 8] = [
    ("nothing", |_| {}),
    ("frames", |passes| passes.frames = false),
    ("base parameters", |passes| passes.base_parameters = false),
    ("masses on axes", |passes| passes.axis_masses = false),
    ("parallel axes", |passes| passes.parallel_axes = false),
    ("units", |passes| passes.units = false),
    ("sums and factors", |passes| (passes.sums, passes.factors) = (false, false)),
    ("all passes", |passes| *passes = Passes::none()),
];

/// Accelerations of six robots.
pub fn report(outputs: &mut Outputs) -> Result<(), Failure> {
    headline("Digits against operations: accelerations by both ways, with passes of the generator left out");
    let mut csv = Csv::new(&["way", "flops", "loss"].map(String::from));
    let mut panels = Vec::new();
    for (name, tree) in robots()? {
        panels.push(panel(name, &tree, &mut csv)?);
    }
    remark(
        "Losses are the largest √M_ii |Δa_i| as shares of the largest √M_jj |a_j|, against double-double arithmetic, \
         where all joints move at like speeds. Each function is on the description of the robot on which it keeps \
         its digits, so that a pass is taken as far as it costs none.",
    );
    let figure = Figure { columns: 3, panels, shared_legend: true };
    outputs.picture("digits", "digits of accelerations against operations", &figure)?;
    outputs.numbers("digits", "the same in numbers", &csv)
}

fn robots() -> Result<[(&'static str, Tree); 6], Failure> {
    let model = |name: &str| -> Result<Tree, Failure> {
        Ok(Tree::new(&Model::load(workspace().join(format!("models/{name}.toml")))?.model))
    };
    let heavy = |index| if index == 5 { 1e6 } else { 1.0 };
    Ok([
        ("KR5", model("peers/kr5")?),
        ("Gripper", model("peers/gripper")?),
        ("Hand of 21 joints", palm(5, 4)),
        ("Six joints, a heavy tip", chain(6, |index| Rod { axis: oblique(index), mass: heavy(index), length: 0.5 })),
        ("Chain of 30", model("test/chain30")?),
        ("Tree, 1e-6 to 1e4 kg", Tree::new(&Style::SpreadMasses.model(&mut Random::new(4), 12))),
    ])
}

/// The points of one robot, of which `csv` and a printed table get the numbers.
fn panel(name: &'static str, tree: &Tree, csv: &mut Csv) -> Result<Panel, Failure> {
    let reference = Reference::at(tree, 1);
    let only = Functions::named(["forward_dynamics"])?;
    let mut table = Table::new(&[name, "recursion, flops", "loss", "factorisation, flops", "loss", "taken"]);
    let mut points = [const { Vec::new() }; 4];
    for (left_out, switch) in LEFT_OUT {
        let mut passes = Passes::all();
        switch(&mut passes);
        let of = |forward_dynamics| -> Result<(Option<MethodChoice>, f64, f64), Failure> {
            let options = CodegenOptions { functions: only, forward_dynamics, ..CodegenOptions::default() };
            let function = trace_of(tree, &options, &passes)?.swap_remove(0);
            let flops = f64::from(function.expressions.count().flops());
            let [lost, ..] = reference.losses_by(Function::ForwardDynamics, |x| function.expressions.evaluate(x));
            Ok((function.method, flops, lost))
        };
        let mut cells = vec![format!("without {left_out}")];
        for (way, method) in [AccelerationMethod::Recursion, AccelerationMethod::Factorisation].into_iter().enumerate()
        {
            let (_, flops, lost) = of(method)?;
            points[2 * way + usize::from(left_out != "nothing")].push((flops, lost));
            let label = ["recursion", "factorisation"][way];
            csv.named_row(&format!("{name}, {label} without {left_out}"), [flops, lost]);
            cells.extend([format!("{flops}"), tiny(lost)]);
        }
        let (taken, ..) = of(AccelerationMethod::Auto)?;
        cells.push(match taken.map(|choice| choice.used.method) {
            Some(Method::Recursion) => "recursion".to_owned(),
            Some(Method::Factorisation) => "factorisation".to_owned(),
            None => String::new(),
        });
        table.row(cells);
    }
    table.print();
    let [recursion, recursions, factorisation, factorisations] = points;
    // What is drawn last lies on top.
    Ok(Panel::new(name, "loss", "share of the largest")
        .logarithmic()
        .over("operations")
        .scatter("recursion, passes left out", 2, &recursions)
        .scatter("factorisation, passes left out", 4, &factorisations)
        .scatter("recursion", 1, &recursion)
        .scatter("factorisation", 3, &factorisation))
}
