//! Tables of numbers over time, in CSV: the form of this program's own results.
//!
//! The first column is `t [s]`; the others are called `<symbol> <joint> [<unit>]`, as `q joint1 [rad]`.

use std::path::{Path, PathBuf};

use super::joints::Joint;
use crate::failure::Failure;

/// A table as it is read.
#[derive(Clone, Debug)]
pub struct Table {
    path: PathBuf,
    /// The instants, s, in order.
    pub t: Vec<f64>,
    headers: Vec<Header>,
    rows: Vec<Vec<f64>>,
}

/// `q joint1 [rad]`, taken apart.
#[derive(Clone, Debug)]
struct Header {
    symbol: String,
    name: String,
    unit: String,
}

impl Table {
    /// Reads a file.
    ///
    /// # Errors
    /// The first fault, with its line: a gap, what is no finite number, or times that do not grow.
    pub fn read(path: &Path) -> Result<Table, Failure> {
        let file = std::fs::File::open(path).map_err(|error| {
            Failure::file("read", path, &error).help("the path of a table is taken from the folder of the scenario")
        })?;
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).comment(Some(b'#')).from_reader(file);
        let headers = reader.headers().map_err(|error| unreadable(path, &error))?;
        let headers: Vec<Header> = headers.iter().map(Header::read).collect();
        if headers.first().is_none_or(|first| first.symbol != "t" || first.unit != "s") {
            let message = format!("{}, line 1: the first column must be the time", path.display());
            return Err(Failure::input(message).help("call it `t [s]`, and the others for example `q joint1 [rad]`"));
        }
        let mut table = Table { path: path.to_owned(), t: Vec::new(), headers, rows: Vec::new() };
        for record in reader.records() {
            let record = record.map_err(|error| unreadable(path, &error))?;
            let line = record.position().map_or(0, csv::Position::line);
            let row: Result<Vec<f64>, Failure> =
                record.iter().enumerate().map(|(k, cell)| table.number(line, k, cell)).collect();
            let row = row?;
            let t = row.first().copied().unwrap_or(f64::NAN);
            if let Some(&previous) = table.t.last().filter(|&&previous| t <= previous) {
                let message = format!("{}, line {line}: t = {t:?} s comes after {previous:?} s", path.display());
                return Err(Failure::input(message).help("every row must be later than the one before it"));
            }
            table.t.push(t);
            table.rows.push(row);
        }
        if table.t.len() < 2 {
            let message = format!("{} has {} rows, and between them lies no time", path.display(), table.t.len());
            return Err(Failure::input(message).help("a table has at least two rows"));
        }
        Ok(table)
    }

    fn number(&self, line: u64, column: usize, cell: &str) -> Result<f64, Failure> {
        let name = self.headers.get(column).map_or(String::new(), Header::shown);
        let fault = |what: String| {
            let message = format!("{}, line {line}: `{name}` {what}", self.path.display());
            Failure::input(message).help("every row has a finite number in each column; take out rows that have not")
        };
        match cell.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ if cell.is_empty() => Err(fault("is empty".into())),
            _ => Err(fault(format!("is `{cell}`, which is no finite number"))),
        }
    }

    /// What stands under `symbol` for each of `joints`, by rows; nothing, if no column has that symbol. `per` is what the
    /// unit of a coordinate is divided by, or a force's `None`.
    ///
    /// # Errors
    /// A joint that has no column or two, and a unit that is not the quantity's.
    pub fn of_joints(
        &self,
        symbol: &str,
        joints: &[&Joint],
        per: Option<&str>,
    ) -> Result<Option<Vec<Vec<f64>>>, Failure> {
        if self.headers.iter().all(|header| header.symbol != symbol) {
            return Ok(None);
        }
        let columns: Result<Vec<_>, Failure> = joints.iter().map(|joint| self.column(symbol, joint, per)).collect();
        let columns = columns?;
        let row = |row: &Vec<f64>| columns.iter().map(|&(column, factor)| factor * row[column]).collect();
        Ok(Some(self.rows.iter().map(row).collect()))
    }

    /// The column of a joint, and by what it is multiplied.
    fn column(&self, symbol: &str, joint: &Joint, per: Option<&str>) -> Result<(usize, f64), Failure> {
        let unit = per.map_or(joint.unit_of_force().to_owned(), |per| format!("{}{per}", joint.unit()));
        let wanted = format!("{symbol} {} [{unit}]", joint.name);
        let mut found = self.headers.iter().enumerate().filter(|(_, header)| header.is(symbol, &joint.name));
        let Some((column, header)) = found.next() else {
            return Err(self.fault(&format!("there is no column `{wanted}`"), "add it, or name fewer joints"));
        };
        if let Some((_, again)) = found.next() {
            return Err(self.fault(&format!("the column `{}` is there twice", again.shown()), "keep one of them"));
        }
        let degrees = per.filter(|_| joint.turns).map(|per| format!("deg{per}"));
        match &header.unit {
            given if *given == unit => Ok((column, 1.0)),
            given if Some(given) == degrees.as_ref() => Ok((column, 1_f64.to_radians())),
            _ => {
                let message = format!("the column `{}` has a unit that is not understood", header.shown());
                Err(self.fault(&message, &format!("call it `{wanted}`")))
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

    /// Where it was read from.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Header {
    fn read(text: &str) -> Header {
        let (rest, unit) = match text.strip_suffix(']').and_then(|text| text.rsplit_once('[')) {
            Some((rest, unit)) => (rest.trim_end(), unit),
            None => (text, ""),
        };
        let (symbol, name) = rest.split_once(' ').unwrap_or((rest, ""));
        Header { symbol: symbol.to_owned(), name: name.to_owned(), unit: unit.to_owned() }
    }

    fn is(&self, symbol: &str, name: &str) -> bool {
        self.symbol == symbol && self.name == name
    }

    fn shown(&self) -> String {
        let space = if self.name.is_empty() { "" } else { " " };
        format!("{}{space}{} [{}]", self.symbol, self.name, self.unit)
    }
}

fn unreadable(path: &Path, error: &csv::Error) -> Failure {
    let line = error.position().map_or(String::new(), |position| format!(", line {}", position.line()));
    let what = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            format!("the row has {len} numbers, and the header names {expected_len}")
        }
        csv::ErrorKind::Io(error) => return Failure::file("read", path, error),
        csv::ErrorKind::Utf8 { .. } => "the text is not UTF-8".to_owned(),
        _ => error.to_string(),
    };
    let failure = Failure::input(format!("{}{line}: {what}", path.display()));
    failure.help("every row has a number for each column, and commas between them")
}
