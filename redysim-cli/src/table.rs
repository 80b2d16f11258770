//! Tables of numbers over time, in CSV: what a run writes, and what a scenario may name.
//!
//! The first column is `t [s]`; the others are called `<symbol> <name> [<unit>]`, as `q joint1 [rad]`, or `kinetic
//! [J]`.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use csv::{Position, ReaderBuilder, StringRecord, Trim};
use serde::{Deserialize, Serialize};

use crate::failure::Failure;
use crate::number::counted;
use redysim_toml::with_decimal_points;

/// Columns over time.
#[derive(Debug)]
pub struct Table {
    /// Where it was read from.
    pub path: PathBuf,
    /// The text that was read.
    pub text: String,
    /// The instants, s: none is before another that stands above it.
    pub t: Vec<f64>,
    /// The other columns.
    pub columns: Vec<Column>,
    /// The line of the file on which each row stands.
    lines: Vec<usize>,
}

/// One quantity over time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
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
        let (label, unit) = header.strip_suffix(']')?.rsplit_once('[')?;
        let (symbol, name) = label.trim().split_once(' ').unwrap_or((label.trim(), ""));
        let column = Column { symbol: symbol.into(), name: name.trim().into(), unit: unit.into(), values: vec![] };
        (!symbol.is_empty()).then_some(column)
    }

    /// `q joint1 [rad]`.
    pub fn header(&self) -> String {
        let Column { symbol, name, unit, .. } = self;
        if name.is_empty() { format!("{symbol} [{unit}]") } else { format!("{symbol} {name} [{unit}]") }
    }
}

const TIME: &str = "t [s]";
const HEADERS: &str = "call the columns `t [s]`, and for example `q joint1 [rad]`, with commas between them; decimals are \
                       written with a point";
const ROWS: &str = "every row has a number for each column, with commas between them";

impl Table {
    /// Reads a file.
    ///
    /// # Errors
    /// The first fault, with its line.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        Table::of_text(read_text(path)?, path)
    }

    /// Reads the text of the file at `path`.
    ///
    /// # Errors
    /// The first fault, with its line.
    pub fn of_text(text: String, path: &Path) -> Result<Self, Failure> {
        let mut reader = ReaderBuilder::new().trim(Trim::All).comment(Some(b'#')).from_reader(text.as_bytes());
        let headers = reader.headers().map_err(|error| unreadable(path, &text, &error))?.clone();
        let mut table = Table {
            path: path.to_owned(),
            text: String::new(),
            t: vec![],
            columns: columns(path, &text, &headers)?,
            lines: vec![],
        };
        let mut row = StringRecord::new();
        while reader.read_record(&mut row).map_err(|error| unreadable(path, &text, &error))? {
            table.lines.push(line(&text, row.position()));
            table.push(&headers, &row)?;
        }
        if table.t.is_empty() {
            return Err(Failure::input(format!("{}: it has headers but no rows", path.display())).help(ROWS));
        }
        Ok(Table { text, ..table })
    }

    fn push(&mut self, headers: &StringRecord, row: &StringRecord) -> Result<(), Failure> {
        let index = self.t.len();
        for ((header, cell), column) in headers.iter().zip(row).zip(0..) {
            let value: f64 = cell.parse().map_err(|_| {
                let found = if cell.is_empty() { "nothing".to_owned() } else { format!("`{cell}`") };
                let fault = self.fault(index, format!("`{header}` must be a number, found {found}"));
                match with_decimal_points(cell).filter(|written| written.parse::<f64>().is_ok()) {
                    Some(written) => fault.help(format!("decimals are written with a point: {written}")),
                    None => fault.help(ROWS),
                }
            })?;
            match column {
                0 => self.t.push(self.next_instant(index, value)?),
                _ => self.columns[column - 1].values.push(value),
            }
        }
        Ok(())
    }

    fn next_instant(&self, row: usize, t: f64) -> Result<f64, Failure> {
        match self.t.last() {
            _ if !t.is_finite() => Err(self.fault(row, format!("`{TIME}` must be a finite number, found {t}"))),
            Some(before) if t < *before => {
                Err(self.fault(row, format!("time runs backwards: t = {t:?} s comes after {before:?} s")))
            }
            _ => Ok(t),
        }
    }

    /// The columns of a quantity, in the table's order.
    pub fn of(&self, symbol: &str) -> impl Iterator<Item = &Column> {
        self.columns.iter().filter(move |column| column.symbol == symbol)
    }

    /// What is wrong with row number `row`, counted from 0.
    pub fn fault(&self, row: usize, wrong: String) -> Failure {
        Failure::input(format!("{}:{}: {wrong}", self.path.display(), self.lines[row]))
    }
}

/// The text of the table in the file at `path`.
///
/// # Errors
/// If it cannot be read, or is not UTF-8.
pub fn read_text(path: &Path) -> Result<String, Failure> {
    let bytes = std::fs::read(path).map_err(|error| Failure::file("read", path, &error))?;
    String::from_utf8(bytes)
        .map_err(|_| Failure::input(format!("{} is not UTF-8", path.display())).help("save the file as UTF-8"))
}

/// The text of the table `name`, which reads back to the same bits.
///
/// # Errors
/// If it has no rows, a column without a value for each instant, or a name that reads as another.
pub fn to_csv(name: &str, t: &[f64], columns: &[Column]) -> Result<Vec<u8>, Failure> {
    let fault = |wrong: String, help: &str| Err(Failure::input(format!("the table `{name}`: {wrong}")).help(help));
    if t.is_empty() {
        return fault("it has no rows".into(), "a table has at least one instant");
    }
    if let Some(row) = (0..t.len()).find(|&row| !t[row].is_finite() || row > 0 && t[row] < t[row - 1]) {
        return fault(format!("instant {} is {:?} s", row + 1, t[row]), "instants are finite and in order");
    }
    for column in columns {
        let (header, count) = (column.header(), column.values.len());
        if count != t.len() {
            let wrong = format!("`{header}` has {count} values, but there are {} instants", t.len());
            return fault(wrong, "a column has a value for each instant");
        }
        let read = Column::of_header(header.trim());
        if read
            .is_none_or(|read| (&read.symbol, &read.name, &read.unit) != (&column.symbol, &column.name, &column.unit))
        {
            return fault(
                format!("the column `{header}` reads back as another"),
                "a symbol is one word, a name has no spaces at its ends, and a unit no brackets",
            );
        }
    }
    let mut writer = csv::Writer::from_writer(vec![]);
    let unwritten = |error: csv::Error| Failure::outside(format!("cannot write the table `{name}`: {error}"));
    let headers = columns.iter().map(Column::header);
    writer.write_record(std::iter::once(TIME.to_owned()).chain(headers)).map_err(unwritten)?;
    for (row, t) in t.iter().enumerate() {
        let values = std::iter::once(t).chain(columns.iter().map(|column| &column.values[row]));
        write_row(&mut writer, values).map_err(unwritten)?;
    }
    writer.into_inner().map_err(|error| unwritten(error.into_error().into()))
}

/// Writes a row of numbers, each as the shortest decimals that read back as exactly this number.
pub fn write_row<'v, W: std::io::Write>(
    writer: &mut csv::Writer<W>,
    row: impl IntoIterator<Item = &'v f64>,
) -> csv::Result<()> {
    let mut shortest = String::new();
    for value in row {
        shortest.clear();
        // A `String` takes everything.
        let _ = write!(shortest, "{value:?}");
        writer.write_field(&shortest)?;
    }
    writer.write_record(None::<&[u8]>)
}

fn columns(path: &Path, text: &str, headers: &StringRecord) -> Result<Vec<Column>, Failure> {
    let fault = |what: String| {
        Failure::input(format!("{}:{}: {what}", path.display(), line(text, headers.position()))).help(HEADERS)
    };
    let first = headers.get(0).unwrap_or_default();
    if let Some((_, between)) = [(';', "semicolons"), ('\t', "tabs")].iter().find(|(c, _)| first.contains(*c)) {
        return Err(fault(format!("commas are wanted between the columns, but there are {between}")));
    }
    if first != TIME {
        return Err(fault(format!("the first column must be the time, `{TIME}`, but is `{first}`")));
    }
    let column = |header| {
        let wrong = || fault(format!("a header must read `symbol name [unit]`, but this one is `{header}`"));
        Column::of_header(header).ok_or_else(wrong)
    };
    headers.iter().skip(1).map(column).collect()
}

/// The line on which a row stands: the reader knows where the one before it ended, and skips empty lines and
/// comments.
fn line(text: &str, position: Option<&Position>) -> usize {
    let (before, byte) = position.map_or((1, 0), |position| (position.line() as usize, position.byte() as usize));
    let rest = text.get(byte..).unwrap_or_default();
    before + rest.lines().take_while(|line| line.is_empty() || line.starts_with('#')).count()
}

/// Reports a table that is not CSV, with the line.
pub fn unreadable(path: &Path, text: &str, error: &csv::Error) -> Failure {
    let at = line(text, error.position());
    let mut help = ROWS.to_owned();
    let what = match error.kind() {
        csv::ErrorKind::UnequalLengths { expected_len, len, .. } => {
            let written = text.lines().nth(at - 1).and_then(with_decimal_points);
            // Each decimal comma has made two values of one.
            if let Some(written) = written.filter(|row| row.split(',').count() as u64 == *expected_len) {
                help = format!("decimals are written with a point: {written}");
            }
            let [values, columns] =
                [(*len, "value"), (*expected_len, "column")].map(|(count, noun)| counted(count, noun));
            format!("the row has {values}, but the header names {columns}")
        }
        _ => error.to_string(),
    };
    Failure::input(format!("{}:{at}: {what}", path.display())).help(help)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Table, Failure> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("table.csv");
        std::fs::write(&path, text).unwrap();
        Table::read(&path)
    }

    #[test]
    fn a_table_is_read_as_spreadsheets_and_editors_write_it() {
        for text in [
            "t [s],q joint 1 [rad],kinetic [J]\n0,1,2\n0.5,-3e-1,nan\n",
            "\u{feff}t [s],q joint 1 [rad],kinetic [J]\r\n0,1,2\r\n0.5,-3e-1,NaN\r\n",
            "# by hand\n t [s] , q joint 1 [rad],\tkinetic [J]\n 0, 1, 2\n\n# later\n0.5,-0.3,NaN",
            "\"t [s]\",\"q joint 1 [rad]\",\"kinetic [J]\"\n\"0\",1,2\n0.5,-0.3,NaN\n",
        ] {
            let table = read(text).unwrap_or_else(|fault| panic!("{text:?}: {fault}"));
            assert_eq!(table.t, [0.0, 0.5], "{text:?}");
            let [q, kinetic] = &table.columns[..] else { panic!("{text:?}: {:?}", table.columns) };
            assert_eq!((&*q.symbol, &*q.name, &*q.unit, &q.values[..]), ("q", "joint 1", "rad", &[1.0, -0.3][..]));
            assert_eq!((kinetic.header(), kinetic.values[1].is_nan()), ("kinetic [J]".to_owned(), true));
        }
    }

    #[test]
    fn decimal_commas_of_a_table_are_shown_with_points() {
        for (rows, written) in [
            ("0,0,0\n\"0,5\",1,0", "0.5"),
            ("0,0,0\n1,\"-1,5e-3\",0", "-1.5e-3"),
            ("0,0,0\n0,5,1,5,0,1", "0.5,1.5,0.1"),
        ] {
            let shown = read(&format!("t [s],q a [m],q b [m]\n{rows}\n")).unwrap_err().to_string();
            assert!(shown.contains("table.csv:3") && shown.ends_with(&format!("with a point: {written}")), "{shown}");
        }
        let shown = read("t [s],q a [m]\n0,5,0\n").unwrap_err().to_string();
        assert!(shown.ends_with("with a point: 0.5,0"), "{shown}");
        let shown = read("t [s];q a [m]\n0,5;0\n").unwrap_err().to_string();
        assert!(shown.contains("with a point"), "{shown}");
    }

    #[test]
    fn a_fault_is_reported_with_its_line_and_what_to_do() {
        for (text, wrong) in [
            ("", ":1: the first column must be the time, `t [s]`, but is ``"),
            ("time,q j [m]\n0,1\n", ":1: the first column must be the time, `t [s]`, but is `time`"),
            ("t [s];q j [m]\n0;1\n", ":1: commas are wanted between the columns, but there are semicolons"),
            ("t [s]\tq j [m]\n0\t1\n", ":1: commas are wanted between the columns, but there are tabs"),
            ("t [s],q\n0,1\n", ":1: a header must read `symbol name [unit]`, but this one is `q`"),
            ("t [s],q j [m]\n", ": it has headers but no rows"),
            ("t [s],q j [m]\n0,1\n\n# a comment\n1,one\n", ":5: `q j [m]` must be a number, found `one`"),
            ("\u{feff}t [s],q j [m]\r\n0,1\r\n1,\r\n", ":3: `q j [m]` must be a number, found nothing"),
            ("# a comment\n\ntime\n0\n", ":3: the first column must be the time, `t [s]`, but is `time`"),
            ("t [s],q j [m]\n0,1\n# a comment\n1\n", ":4: the row has 1 value, but the header names 2 columns"),
            ("t [s],\"q j\nk [m]\"\n0,1\n1,one", ":4: `q j\nk [m]` must be a number, found `one`"),
            ("t [s],q j [m]\n0,1\n1\n", ":3: the row has 1 value, but the header names 2 columns"),
            ("t [s],q j [m]\n0,1\n1,2,3\n", ":3: the row has 3 values, but the header names 2 columns"),
            ("t [s],q j [m]\n1,1\n0.5,1\n", ":3: time runs backwards: t = 0.5 s comes after 1.0 s"),
            ("t [s],q j [m]\nNaN,1\n", ":2: `t [s]` must be a finite number, found NaN"),
        ] {
            let shown = read(text).unwrap_err().to_string();
            assert!(shown.contains(&format!("table.csv{wrong}")), "{text:?}: {shown}");
        }
    }
}
