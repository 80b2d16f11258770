//! Tables for the terminal: aligned, with units under the headers.

use std::io::IsTerminal;

/// A table in the making. The first column is text, the others are numbers and stand to the right.
pub struct Table {
    headers: Vec<Vec<String>>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table with the given headers; a header may have several lines, the last of them the unit.
    pub fn new(headers: &[&str]) -> Self {
        let height = headers.iter().map(|header| header.lines().count()).max().unwrap_or(0);
        let line = |header: &&str, index| header.lines().nth(index).unwrap_or("").to_owned();
        let headers = (0..height).map(|index| headers.iter().map(|header| line(header, index)).collect()).collect();
        Table { headers, rows: Vec::new() }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    /// Prints the table.
    pub fn print(&self) {
        let lines = || self.headers.iter().chain(&self.rows);
        let columns = lines().map(Vec::len).max().unwrap_or(0);
        let widest =
            |column: usize| lines().filter_map(|line| line.get(column)).map(|cell: &String| cell.chars().count()).max();
        let widths: Vec<usize> = (0..columns).map(|column| widest(column).unwrap_or(0)).collect();
        for line in &self.headers {
            println!("  {}", dim(&aligned(line, &widths)));
        }
        for line in &self.rows {
            println!("  {}", aligned(line, &widths));
        }
    }
}

fn aligned(cells: &[String], widths: &[usize]) -> String {
    let cell = |(index, (cell, &width)): (usize, (&String, &usize))| {
        if index == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
    };
    cells.iter().zip(widths).enumerate().map(cell).collect::<Vec<_>>().join("   ").trim_end().to_owned()
}

/// Prints the headline of a section.
pub fn headline(text: &str) {
    println!("\n{}", styled("1", text));
}

/// Prints a remark below a table.
pub fn remark(text: &str) {
    println!("  {text}");
}

fn dim(text: &str) -> String {
    styled("2", text)
}

/// Bold or dim letters, where the output is a terminal.
fn styled(style: &str, text: &str) -> String {
    if std::io::stdout().is_terminal() { format!("\x1b[{style}m{text}\x1b[0m") } else { text.to_owned() }
}

/// A small number by order of magnitude: "2.3e-14", and "0" for none at all.
pub fn tiny(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}") }
}

/// A number with five digits, in powers of ten where it is small.
pub fn digits(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        size if size < 1e-3 => format!("{value:.4e}"),
        size => format!("{value:.*}", (4 - size.log10().floor() as i32).max(0) as usize),
    }
}
