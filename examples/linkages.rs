//! Mechanisms with closed loops: starts that do not close, loops that stay closed, and answers that are known.
//!
//! `cargo run --release --example linkages`

#[path = "../tests/common/andrews.rs"]
#[allow(dead_code, reason = "tests use the rest")]
mod andrews_data;
mod common;
/// The parts of this example.
mod linkages {
    pub mod andrews;
    pub mod n_fourbar;
    pub mod redysim_examples;
    pub mod study;
}

use common::figure::{Figure, Panel};
use common::loop_motion::peaks;
use common::table::{headline, remark};
use common::{Failure, Outputs};
use linkages::study::{Studies, Study};
use linkages::{andrews, n_fourbar, redysim_examples};

fn main() -> Result<(), Failure> {
    let mut outputs = Outputs::of("linkages")?;
    let mut studies = Studies::default();
    redysim_examples::move_all(&mut studies)?;
    andrews::run(&mut studies)?;
    n_fourbar::move_both(&mut studies)?;
    headline("Closed loops in motion");
    studies.table().print();
    remark(
        "Residual, moved: of the start as it is given, and by how much assembly moved the joint that moved farthest.",
    );
    remark("Open, and drift: the worst at the end of any step. The time includes recording.");
    for line in studies.mended() {
        remark(line);
    }
    redysim_examples::compare(&studies)?;
    andrews::compare(&studies)?;
    n_fourbar::compare(&studies, &mut outputs)?;
    outputs.picture("closure", "what stays open at the end of each step", &closure(&studies))?;
    for study in &studies.all {
        let sliding: &[usize] = if study.name == "slider_crank" { &[2] } else { &[] };
        outputs.numbers(study.name, "motion and λ", &study.motion.csv(sliding))?;
    }
    outputs.print();
    Ok(())
}

/// The position residuals of some of them over time; a panel for each.
fn closure(studies: &Studies) -> Figure {
    let shown = ["slider_crank", "three_rrr", "leg", "andrews", "n_fourbar_2", "n_fourbar_40"];
    let panel = |study: &Study| {
        let (t, residual) = peaks(&study.motion.steps.t, &study.motion.steps.position_residual);
        Panel::new(study.name, "position residual", "m").logarithmic().line("", 1, &t, &residual)
    };
    let panels = studies.all.iter().filter(|study| shown.contains(&study.name)).map(panel);
    Figure { columns: 2, panels: panels.collect(), shared_legend: false }
}
