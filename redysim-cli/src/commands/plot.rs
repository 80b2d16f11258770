//! `redysim plot RESULTS`.

use std::path::PathBuf;

use redysim_figures::figure::{Figure, Panel};
use redysim_figures::{plot, png};

use crate::failure::Failure;
use crate::output;
use crate::recorded::{Chart, Curve, Recorded};
use crate::results::names::Picture;

/// Draw what a run has written: motion, torques, energy and λ, as SVG and PNG.
///
/// Joints of one branch, such as a leg or an arm, share a panel, seven at most, if their curves have one unit and sizes
/// within a factor of ten; panels of about one size have the same limits. A joint has the same colour in all pictures.
/// Energies share one panel.
#[derive(clap::Args)]
#[command(after_help = "Example:\n  redysim plot results/kuka/inverse -o pictures")]
pub struct Arguments {
    /// The folder of results.
    results: PathBuf,
    /// The folder for the pictures [default: the results' own].
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Overwrite pictures that are there already.
    #[arg(long)]
    force: bool,
}

/// Draws the pictures.
pub fn run(arguments: &Arguments, quiet: bool) -> Result<(), Failure> {
    let recorded = Recorded::open(&arguments.results)?;
    let mut charts = recorded.charts()?;
    if charts.is_empty() {
        return Err(recorded.lacks("nothing to draw"));
    }
    if !quiet {
        charts.iter().for_each(warn_of_gaps);
    }
    let mut pictures: Vec<(PathBuf, Vec<u8>)> = Vec::new();
    let folder = arguments.output.as_deref().unwrap_or(recorded.folder());
    for (picture, name) in Picture::ALL {
        let (of_picture, rest): (Vec<Chart>, _) = charts.into_iter().partition(|chart| chart.picture == picture);
        charts = rest;
        if let Some(figure) = figure(&of_picture) {
            let svg = plot::svg(&figure).map_err(Failure::outside)?;
            pictures.push((folder.join(format!("{name}.svg")), svg.into_bytes()));
            pictures.push((folder.join(format!("{name}.png")), png::png(&figure).map_err(Failure::outside)?));
        }
    }
    let files: Vec<(PathBuf, &[u8])> =
        pictures.iter().map(|(path, contents)| (path.clone(), contents.as_slice())).collect();
    output::write_together(folder, &files, arguments.force)?;
    if !quiet {
        pictures.iter().for_each(|(path, _)| output::to_stdout(&path.display().to_string()));
    }
    Ok(())
}

/// Warns of the curves that have gaps.
fn warn_of_gaps(chart: &Chart) {
    for Curve { name, .. } in chart.curves.iter().filter(|curve| !curve.values.iter().all(|value| value.is_finite())) {
        let title = chart.title;
        output::to_stderr(&format!(
            "warning: {title}, {name}: its curve has a gap where a value is not a finite number"
        ));
    }
}

/// The charts below each other: energies together, as parts of one sum; other curves by groups and sizes.
fn figure(charts: &[Chart]) -> Option<Figure> {
    let panels = |chart: &Chart| match chart.picture {
        Picture::Energy => vec![panel(chart).merged().prefixed()],
        _ => panel(chart).multiples(&chart.curves.iter().map(|curve| curve.place.group).collect::<Vec<_>>()),
    };
    (!charts.is_empty()).then(|| Figure::of_charts(charts.iter().map(panels).collect()))
}

fn panel(chart: &Chart) -> Panel {
    let empty = Panel::new(chart.title, chart.quantity, &chart.unit);
    chart.curves.iter().fold(empty, |panel, curve| {
        // The palette's first colour, black, is for references.
        panel.line(&curve.name, curve.place.number + 1, &chart.t, &curve.values)
    })
}
