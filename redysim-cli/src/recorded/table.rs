//! A table over time: a file of comma-separated values whose headers name a quantity, its owner and its unit.

use std::path::{Path, PathBuf};

use csv::{Position, ReaderBuilder, StringRecord};

use crate::failure::Failure;

/// Columns over time.
#[derive(Debug)]
pub struct Table {
    path: PathBuf,
    /// The instants, s.
    pub t: Vec<f64>,
    /// What was recorded, without the column of time.
    pub columns: Vec<Column>,
}

/// One quantity over time, with the header `<symbol> <name> [<unit>]`.
#[derive(Debug)]
pub struct Column {
    /// What it is: "q", "tau", "kinetic".
    pub symbol: String,
    /// Whose it is, such as a joint's; empty for a quantity of the whole mechanism.
    pub name: String,
    /// The unit, without brackets.
    pub unit: String,
    /// A value for each instant; what is not finite is kept.
    pub values: Vec<f64>,
}

impl Column {
    fn of_header(header: &str) -> Option<Self> {
        let (label, unit) = header.trim().strip_suffix(']')?.rsplit_once('[')?;
        let (symbol, name) = label.trim().split_once(' ').unwrap_or((label.trim(), ""));
        let column = Column { symbol: symbol.into(), name: name.trim().into(), unit: unit.into(), values: vec![] };
        (!symbol.is_empty()).then_some(column)
    }
}

impl Table {
    /// Reads a table.
    ///
    /// # Errors
    /// What is wrong with it, with file, line and column.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let file = std::fs::File::open(path).map_err(|error| Failure::file("read", path, &error))?;
        let mut reader = ReaderBuilder::new().from_reader(std::io::BufReader::new(file));
        let headers = reader.headers().map_err(|error| unreadable(path, &error))?.clone();
        let mut table = Table { path: path.to_owned(), t: vec![], columns: columns(path, &headers)? };
        let mut row = StringRecord::new();
        while reader.read_record(&mut row).map_err(|error| unreadable(path, &error))? {
            let line = row.position().map_or(0, Position::line);
            let value =
                |index: usize| number(&row[index]).ok_or_else(|| no_number(path, line, &headers[index], &row[index]));
            let t = value(0)?;
            if !t.is_finite() || table.t.last().is_some_and(|&before| t < before) {
                return Err(backwards(path, line, &row[0]));
            }
            table.t.push(t);
            for (index, column) in table.columns.iter_mut().enumerate() {
                column.values.push(value(index + 1)?);
            }
        }
        if table.t.is_empty() {
            return Err(Failure::input(format!("{}: it has headers but no rows", path.display())).help(RERUN));
        }
        Ok(table)
    }

    /// The columns of a quantity, in the table's order.
    pub fn of(&self, symbol: &str) -> impl Iterator<Item = &Column> {
        self.columns.iter().filter(move |column| column.symbol == symbol)
    }

    /// The column of a quantity of a joint or link.
    ///
    /// # Errors
    /// If there is none.
    pub fn column(&self, symbol: &str, name: &str) -> Result<&Column, Failure> {
        self.of(symbol).find(|column| column.name == name).ok_or_else(|| {
            Failure::input(format!("{}:1: there is no column `{symbol} {name} [..]`", self.path.display()))
                .help(format!("the folder's model.toml has `{name}`: are both from the same run?"))
        })
    }

    /// What is wrong with the value of a column in row number `row`, counted from 0.
    pub fn fault(&self, column: &Column, row: usize, wrong: &str) -> Failure {
        let (path, line) = (self.path.display(), row + 2);
        Failure::input(format!(
            "{path}:{line}: column `{} {}`: {} {wrong}",
            column.symbol, column.name, column.values[row]
        ))
        .help("did the run fail there? End it before, or make its tolerances tighter")
    }
}

const RERUN: &str = "was it changed by hand? Run the command again that wrote it";

fn columns(path: &Path, headers: &StringRecord) -> Result<Vec<Column>, Failure> {
    let fault = |what: String| Err(Failure::input(format!("{}:1: {what}", path.display())).help(RERUN));
    match headers.get(0).unwrap_or("").trim_start_matches('\u{feff}').trim() {
        "t [s]" => {}
        other => return fault(format!("the first column must be `t [s]`, but is `{other}`")),
    }
    let mut columns = Vec::new();
    for header in headers.iter().skip(1) {
        match Column::of_header(header) {
            Some(column) => columns.push(column),
            None => return fault(format!("a header must read `symbol name [unit]`, but this one is `{header}`")),
        }
    }
    Ok(columns)
}

fn number(text: &str) -> Option<f64> {
    text.trim().parse().ok()
}

fn no_number(path: &Path, line: u64, header: &str, found: &str) -> Failure {
    let path = path.display();
    Failure::input(format!("{path}:{line}: column `{header}`: a number is needed, but it is `{found}`")).help(RERUN)
}

fn backwards(path: &Path, line: u64, found: &str) -> Failure {
    Failure::input(format!("{}:{line}: time must not run backwards, but t is `{found}` here", path.display()))
        .help(RERUN)
}

fn unreadable(path: &Path, error: &csv::Error) -> Failure {
    match error.kind() {
        csv::ErrorKind::Io(error) => Failure::file("read", path, error),
        csv::ErrorKind::UnequalLengths { pos, expected_len, len } => {
            let line = pos.as_ref().map_or(0, Position::line);
            let path = path.display();
            Failure::input(format!("{path}:{line}: the row must have {expected_len} values, but has {len}")).help(RERUN)
        }
        _ => Failure::input(format!("{}: {error}", path.display())).help(RERUN),
    }
}
