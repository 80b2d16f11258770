//! What of the tables is worth a look: curves that belong into one coordinate system.

use super::Recorded;
use super::groups::{Groups, Place};
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
    /// Number of its colour where all curves of a chart stand in one coordinate system: the same for curves of one name
    /// in all charts of joints.
    pub colour: usize,
    /// Where it stands if groups of joints have coordinate systems of their own: the same in all charts of joints.
    pub place: Place,
    /// A value at each of the chart's instants.
    pub values: Vec<f64>,
}

impl Recorded {
    /// All charts that the tables yield, those first that are looked at most.
    ///
    /// # Errors
    /// If a table cannot be read.
    pub fn charts(&self) -> Result<Vec<Chart>, Failure> {
        let (motion, mut torques) = (self.motion()?, self.table(names::TOR)?);
        let of_joints = ["q", "tau", "v", "a"].map(|symbol| {
            let table = if symbol == "tau" { &torques } else { &motion };
            table.iter().flat_map(|table| table.of(symbol)).map(curve_name).collect::<Vec<_>>()
        });
        let model = self.model().ok();
        let mut joints = Styles::of(Groups::of(model.as_ref(), of_joints.into_iter().flatten()));
        // That nothing drives a body through space need not be seen.
        let drives =
            |column: &Column| !joints.groups.floats(curve_name(column)) || column.values.iter().any(|v| *v != 0.0);
        torques.iter_mut().for_each(|table| table.columns.retain(drives));
        let mut charts = Vec::new();
        if let Some(table) = &motion {
            charts.extend(by_unit(table, Picture::Motion, &["q"], &mut joints, |unit| match unit {
                "m" => ("Joint displacements", "displacement"),
                "1" => ("Joint orientations", "quaternion"),
                _ => ("Joint angles", "angle"),
            }));
        }
        if let Some(table) = &torques {
            charts.extend(by_unit(table, Picture::Torques, &["tau"], &mut joints, |unit| match unit {
                "N" => ("Joint forces", "force"),
                _ => ("Joint torques", "torque"),
            }));
        }
        if let Some(table) = self.table(names::ENERGY)? {
            let energies = ["kinetic", "potential", "ground", "total", "work", "ground_loss"];
            let (all, drift) =
                (&mut Styles::of_columns(&table, &energies), &mut Styles::of_columns(&table, &["drift"]));
            charts.extend(by_unit(&table, Picture::Energy, &energies, all, |_| ("Energy", "energy")));
            charts.extend(by_unit(&table, Picture::Energy, &["drift"], drift, |_| ("Drift of the energy", "drift")));
        }
        if let Some(table) = self.table(names::LAMBDA)? {
            let multipliers = &mut Styles::of_columns(&table, &["lambda"]);
            charts.extend(by_unit(&table, Picture::Multipliers, &["lambda"], multipliers, |_| {
                ("Lagrange multipliers", "λ")
            }));
        }
        if let Some(table) = &motion {
            charts.extend(by_unit(table, Picture::Motion, &["v"], &mut joints, |_| ("Joint velocities", "velocity")));
            charts.extend(by_unit(table, Picture::Motion, &["a"], &mut joints, |_| {
                ("Joint accelerations", "acceleration")
            }));
        }
        Ok(charts)
    }
}

/// How curves are told apart, by their names.
struct Styles {
    /// Those that have a colour: its number is their place here, and a new one gets the next.
    coloured: Vec<String>,
    groups: Groups,
}

impl Styles {
    fn of(groups: Groups) -> Styles {
        Styles { coloured: Vec::new(), groups }
    }

    /// Of columns that are about no joints.
    fn of_columns(table: &Table, symbols: &[&str]) -> Styles {
        let columns = symbols.iter().flat_map(|symbol| table.of(symbol));
        Styles::of(Groups::of(None, columns.map(curve_name)))
    }

    fn colour(&mut self, name: &str) -> usize {
        self.coloured.iter().position(|known| known == name).unwrap_or_else(|| {
            self.coloured.push(name.to_owned());
            self.coloured.len() - 1
        })
    }
}

/// As the legend shows it.
fn curve_name(column: &Column) -> &str {
    if column.name.is_empty() { &column.symbol } else { &column.name }
}

/// The columns of the given quantities, a chart for each unit.
fn by_unit(
    table: &Table,
    picture: Picture,
    symbols: &[&str],
    styles: &mut Styles,
    words: impl Fn(&str) -> (&'static str, &'static str),
) -> Vec<Chart> {
    let columns: Vec<_> = symbols
        .iter()
        .flat_map(|symbol| table.of(symbol))
        .map(|column| (styles.colour(curve_name(column)), column))
        .collect();
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
            name: curve_name(column).to_owned(),
            colour: *colour,
            place: styles.groups.place(curve_name(column)),
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn a_joint_has_one_colour_though_there_are_more_coordinates_than_velocities() {
        let folder = tempfile::tempdir().unwrap();
        let q = ["x", "y", "z"].map(|part| format!("q base.{part} [m]"));
        let quaternion = ["qx", "qy", "qz", "qw"].map(|part| format!("q base.{part} [1]"));
        let v = ["vx", "vy", "vz"].map(|part| format!("v base.{part} [m/s]"));
        let w = ["wx", "wy", "wz"].map(|part| format!("v base.{part} [rad/s]"));
        let headers =
            [&["t [s]".into()], &q[..], &quaternion, &["q arm [rad]".into()], &v, &w, &["v arm [rad/s]".into()]];
        let headers = headers.concat();
        let rows: String = (0..3).map(|t| format!("{t}{}\n", ",0.5".repeat(headers.len() - 1))).collect();
        let path: &Path = folder.path();
        std::fs::write(path.join("statevar.csv"), format!("{}\n{rows}", headers.join(","))).unwrap();
        let charts = Recorded::open(path).unwrap().charts().unwrap();
        let curves: Vec<&Curve> = charts.iter().flat_map(|chart| &chart.curves).collect();
        assert_eq!(curves.len(), 15);
        let colours = |name: &str| -> Vec<usize> {
            curves.iter().filter(|curve| curve.name == name).map(|curve| curve.colour).collect()
        };
        assert_eq!(colours("arm"), [7, 7]);
        assert_eq!((colours("base.qw"), colours("base.wx")), (vec![6], vec![11]));
    }
}
