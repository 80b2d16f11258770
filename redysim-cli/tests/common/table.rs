//! Tables of numbers, written by the program or by others.

use std::fs;
use std::path::Path;

use super::root;

/// A table of numbers.
pub struct Table {
    pub headers: Vec<String>,
    pub rows: Vec<Vec<f64>>,
}

impl Table {
    /// Reads comma-separated values with names above.
    pub fn csv(path: &Path) -> Table {
        let text = fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let mut lines = text.lines();
        let headers = lines.next().unwrap().split(',').map(str::to_owned).collect();
        Table { headers, rows: lines.map(|line| numbers(line.split(','))).collect() }
    }

    /// Reads numbers between spaces.
    pub fn dat(path: &Path) -> Table {
        let text = fs::read_to_string(path).unwrap();
        Table { headers: vec![], rows: text.lines().map(|line| numbers(line.split_whitespace())).collect() }
    }

    /// A reference: its first line names the columns.
    pub fn reference(name: &str) -> Table {
        Table::csv(&root().join("tests/reference").join(name))
    }

    /// The columns `range` of each row.
    pub fn columns(&self, range: std::ops::Range<usize>) -> Vec<Vec<f64>> {
        self.rows.iter().map(|row| row[range.clone()].to_vec()).collect()
    }

    /// The column of a name.
    pub fn column(&self, name: &str) -> Vec<f64> {
        let index = self.headers.iter().position(|header| header == name);
        let index = index.unwrap_or_else(|| panic!("no `{name}` among {:?}", self.headers));
        self.rows.iter().map(|row| row[index]).collect()
    }
}

fn numbers<'a>(cells: impl Iterator<Item = &'a str>) -> Vec<f64> {
    cells.map(|cell| cell.parse().unwrap()).collect()
}

/// The largest difference between two tables, which must have the same shape.
pub fn deviation(found: &[Vec<f64>], expected: &[Vec<f64>]) -> f64 {
    assert_eq!(found.len(), expected.len(), "as many rows");
    let pairs = found.iter().zip(expected).flat_map(|(found, expected)| {
        assert_eq!(found.len(), expected.len(), "as many columns");
        found.iter().zip(expected)
    });
    // NaN counts as infinite, so that it is not overlooked.
    let sizes = pairs.map(|(found, expected)| (found - expected).abs());
    sizes.fold(0.0, |most, size| if size.is_nan() { f64::INFINITY } else { f64::max(most, size) })
}
