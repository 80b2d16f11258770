//! Tables that a scenario names: motion or forces of joints, without missing values.

use std::path::{Path, PathBuf};

use super::meant_from;
use crate::failure::Failure;
use crate::layout::Component;
use crate::table::{self, Column};

/// The largest number, as in a scenario: products of a few of them are finite.
const LARGEST: f64 = 1e100;

/// A table whose numbers are finite and whose times increase.
#[derive(Clone, Debug)]
pub struct InputTable {
    path: PathBuf,
    /// The text that was read.
    pub text: String,
    /// The instants, s, in order.
    pub t: Vec<f64>,
    columns: Vec<Column>,
}

impl InputTable {
    /// Reads a file.
    ///
    /// # Errors
    /// The first fault, with its line: a missing value, a number that is not finite or too large, or times that do not
    /// increase.
    pub fn read(path: &Path) -> Result<InputTable, Failure> {
        let text = table::read_text(path).map_err(|fault| match path.is_file() {
            true => fault,
            false => {
                let meant = meant_from(path.parent().unwrap_or(path), path);
                fault.help(format!("{meant}the path of a table is taken from the folder of the scenario"))
            }
        })?;
        InputTable::of_text(text, path)
    }

    /// Reads the text of the file at `path`.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn of_text(text: String, path: &Path) -> Result<InputTable, Failure> {
        let read = table::Table::of_text(text, path)?;
        for row in 0..read.t.len() {
            if let Some(column) = read.columns.iter().find(|column| !column.values[row].is_finite()) {
                let (header, found) = (column.header(), column.values[row]);
                let fault = read.fault(row, format!("`{header}` must be a finite number, found {found}"));
                return Err(fault.help("take the row out, or put a number there"));
            }
            let too_large = |column: &&Column| column.values[row].abs() > LARGEST;
            if let Some(column) = read.columns.iter().find(too_large) {
                let (header, found) = (column.header(), column.values[row]);
                let fault = read.fault(row, format!("`{header}` is {found:e}, which is out of range"));
                return Err(fault.help(format!("a number is at most {LARGEST:e} in size")));
            }
            if row > 0 && read.t[row] <= read.t[row - 1] {
                let fault = read.fault(row, format!("t is {:?} s again", read.t[row]));
                return Err(fault.help("every row must be later than the one before it"));
            }
        }
        let table::Table { path, text, t, columns, .. } = read;
        let table = InputTable { path, text, t, columns };
        match table.t.len() {
            0 | 1 => Err(table.fault("it has 1 row, and no time lies between", "a table has at least two rows")),
            _ => Ok(table),
        }
    }

    /// The values of `symbol` for each of `of`, indices into `components`, by rows; `None` if no column has that
    /// symbol. `per` is what the unit of a coordinate is divided by; `None` for a force.
    ///
    /// # Errors
    /// If a component has no column or two, or a column has a unit of another quantity.
    pub fn of_components(
        &self,
        symbol: &str,
        components: &[Component],
        of: &[usize],
        per: Option<&str>,
    ) -> Result<Option<Vec<Vec<f64>>>, Failure> {
        if self.columns.iter().all(|column| column.symbol != symbol) {
            return Ok(None);
        }
        let columns: Result<Vec<_>, Failure> =
            of.iter().map(|&index| self.column(symbol, &components[index], per)).collect();
        let columns = columns?;
        let row = |row: usize| columns.iter().map(|(column, factor)| factor * column.values[row]).collect();
        Ok(Some((0..self.t.len()).map(row).collect()))
    }

    /// The column of a component, and the factor that converts it to SI units.
    fn column(&self, symbol: &str, component: &Component, per: Option<&str>) -> Result<(&Column, f64), Failure> {
        let unit = per.map_or(component.unit_of_force().to_owned(), |per| format!("{}{per}", component.unit()));
        let wanted = format!("{symbol} {} [{unit}]", component.name);
        let mut found =
            self.columns.iter().filter(|column| column.symbol == symbol && column.name == component.name.trim());
        let Some(column) = found.next() else {
            return Err(self.fault(&format!("the column `{wanted}` is missing"), "add it, or name fewer joints"));
        };
        if let Some(again) = found.next() {
            return Err(self.fault(&format!("the column `{}` occurs twice", again.header()), "keep one of them"));
        }
        let degrees = per.filter(|_| component.turns()).map(|per| format!("deg{per}"));
        match &column.unit {
            given if *given == unit => Ok((column, 1.0)),
            given if Some(given) == degrees.as_ref() => Ok((column, 1_f64.to_radians())),
            _ => {
                let message = format!("the column `{}` has a unit that is not understood", column.header());
                let given = column.unit.to_lowercase();
                let unit = degrees.filter(|_| given.starts_with("deg") || given.contains('°')).unwrap_or(unit);
                Err(self.fault(&message, &format!("call it `{symbol} {} [{unit}]`", component.name)))
            }
        }
    }

    /// Fails unless the table goes from `start` to `end`.
    pub fn cover(&self, start: f64, end: f64) -> Result<(), Failure> {
        let (first, last) = (self.t[0], self.t[self.t.len() - 1]);
        // A last row that misses the end by rounding is the end.
        let slack = 1e-9 * (end - start);
        if first <= start + slack && last >= end - slack {
            return Ok(());
        }
        let message = format!("it goes from {first:?} s to {last:?} s, but the run from {start:?} s to {end:?} s");
        Err(self.fault(&message, "add rows, or shorten the run"))
    }

    /// A fault of the table as a whole.
    pub fn fault(&self, message: &str, help: &str) -> Failure {
        Failure::input(format!("{}: {message}", self.path.display())).help(help)
    }

    /// The file that it was read from.
    pub fn path(&self) -> &Path {
        &self.path
    }
}
