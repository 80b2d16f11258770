//! What of the tables is worth a look: curves that belong into one coordinate system.

use super::Recorded;
use super::thin::with_peaks;
use crate::failure::Failure;
use crate::results::names::{self, Picture};
use crate::table::{Column, Table};

/// Rows of a chart, about: more than a screen has pixels across.
const ROWS: usize = 2000;

/// A coordinate system with its curves over time.
#[derive(Debug)]
pub struct Chart {
    /// To which picture it belongs.
    pub picture: Picture,
    /// What it shows.
    pub title: &'static str,
    /// What its vertical axis measures.
    pub quantity: &'static str,
    /// The unit of that.
    pub unit: String,
    /// The instants, s.
    pub t: Vec<f64>,
    /// The curves.
    pub curves: Vec<Curve>,
}

/// A curve of a [`Chart`].
#[derive(Debug)]
pub struct Curve {
    /// As the legend shows it.
    pub name: String,
    /// Number of its colour: the same for a joint in all charts.
    pub colour: usize,
    /// A value at each of the chart's instants.
    pub values: Vec<f64>,
}

impl Recorded {
    /// All charts that the tables yield, those first that are looked at most.
    ///
    /// # Errors
    /// If a table cannot be read.
    pub fn charts(&self) -> Result<Vec<Chart>, Failure> {
        let motion = self.motion()?;
        let mut charts = Vec::new();
        if let Some(table) = &motion {
            charts.extend(by_unit(table, Picture::Motion, &["q"], |unit| match unit {
                "m" => ("Joint displacements", "displacement"),
                _ => ("Joint angles", "angle"),
            }));
        }
        if let Some(table) = self.table(names::TOR)? {
            charts.extend(by_unit(&table, Picture::Torques, &["tau"], |unit| match unit {
                "N" => ("Joint forces", "force"),
                _ => ("Joint torques", "torque"),
            }));
        }
        if let Some(table) = self.table(names::ENERGY)? {
            let energies = ["kinetic", "potential", "total", "work"];
            charts.extend(by_unit(&table, Picture::Energy, &energies, |_| ("Energy", "energy")));
            charts.extend(by_unit(&table, Picture::Energy, &["drift"], |_| ("Drift of the energy", "drift")));
        }
        if let Some(table) = self.table(names::LAMBDA)? {
            charts.extend(by_unit(&table, Picture::Multipliers, &["lambda"], |_| ("Lagrange multipliers", "λ")));
        }
        if let Some(table) = &motion {
            charts.extend(by_unit(table, Picture::Motion, &["v"], |_| ("Joint velocities", "velocity")));
            charts.extend(by_unit(table, Picture::Motion, &["a"], |_| ("Joint accelerations", "acceleration")));
        }
        Ok(charts)
    }
}

/// The columns of the given quantities, a chart for each unit.
fn by_unit(
    table: &Table,
    picture: Picture,
    symbols: &[&str],
    words: impl Fn(&str) -> (&'static str, &'static str),
) -> Vec<Chart> {
    let columns: Vec<_> = symbols.iter().flat_map(|symbol| table.of(symbol)).enumerate().collect();
    let mut units: Vec<&str> = Vec::new();
    for (_, column) in &columns {
        if !units.contains(&column.unit.as_str()) {
            units.push(&column.unit);
        }
    }
    let chart = |unit: &str| {
        let shown: Vec<_> = columns.iter().filter(|(_, column)| column.unit == unit).collect();
        let values: Vec<&[f64]> = shown.iter().map(|(_, column)| column.values.as_slice()).collect();
        let rows = with_peaks(&values, table.t.len(), ROWS);
        let pick = |values: &[f64]| rows.iter().map(|&row| values[row]).collect();
        let curve = |(colour, column): &&(usize, &Column)| Curve {
            name: if column.name.is_empty() { column.symbol.clone() } else { column.name.clone() },
            colour: *colour,
            values: pick(&column.values),
        };
        let (title, quantity) = words(unit);
        Chart {
            picture,
            title,
            quantity,
            unit: unit.replace("^2", "²"),
            t: pick(&table.t),
            curves: shown.iter().map(curve).collect(),
        }
    };
    units.into_iter().map(chart).collect()
}
