//! A table of samples in CSV: a path above each column, a row for each sample.

use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim};
use toml::Value;

use super::place::Place;
use crate::failure::Failure;
use crate::table::unreadable;

/// The paths above the columns of the table at `path`, and the values below each.
///
/// # Errors
/// The first fault, with its line.
pub fn of_text(text: &str, path: &Path) -> Result<Vec<(Place, Vec<Value>)>, Failure> {
    let shown = path.display();
    let mut reader = ReaderBuilder::new().trim(Trim::All).comment(Some(b'#')).from_reader(text.as_bytes());
    let unreadable = |error: csv::Error| unreadable(path, text, &error);
    let headers = reader.headers().map_err(unreadable)?.clone();
    let mut columns = Vec::new();
    for header in &headers {
        let place = Place::parse(header).map_err(|wrong| {
            Failure::input(format!("{shown}: {wrong}")).help("call each column by a path, as in model.link.crank.mass")
        })?;
        columns.push((place, Vec::new()));
    }
    let mut row = StringRecord::new();
    while reader.read_record(&mut row).map_err(unreadable)? {
        let line = row.position().map_or(0, csv::Position::line);
        for (cell, (place, values)) in row.iter().zip(&mut columns) {
            let fault = |wrong: &str| {
                let fault = Failure::input(format!("{shown}:{line}: `{place}` {wrong}, found `{cell}`"));
                fault.help("every sample has a value for each path: correct the row, or take it out")
            };
            values.push(match (cell, cell.parse::<f64>()) {
                ("", _) => return Err(fault("has no value")),
                ("true", _) => Value::Boolean(true),
                ("false", _) => Value::Boolean(false),
                (_, Ok(number)) if number.is_finite() => Value::Float(number),
                (_, Ok(_)) => return Err(fault("must be a finite number")),
                _ => Value::String(cell.to_owned()),
            });
        }
    }
    Ok(columns)
}
