//! Tables of numbers as files: every column has a name and a unit, every number all its digits.

use std::fmt::Write;

/// A file of comma-separated values in the making.
pub struct Csv {
    text: String,
    columns: usize,
}

impl Csv {
    /// A table with the given column headers, such as "q1 [rad]".
    pub fn new(headers: &[String]) -> Self {
        Csv { text: headers.join(",") + "\n", columns: headers.len() }
    }

    /// Adds one row: the shortest decimals that read back as exactly the same numbers.
    pub fn row(&mut self, values: impl IntoIterator<Item = f64>) {
        self.fill(0, values);
    }

    /// Adds one row whose first entry is a name.
    pub fn named_row(&mut self, name: &str, values: impl IntoIterator<Item = f64>) {
        write!(self.text, "\"{name}\"").expect("a String takes everything");
        self.fill(1, values);
    }

    fn fill(&mut self, mut count: usize, values: impl IntoIterator<Item = f64>) {
        for value in values {
            let comma = if count == 0 { "" } else { "," };
            write!(self.text, "{comma}{value:?}").expect("a String takes everything");
            count += 1;
        }
        assert_eq!(count, self.columns, "a row has a number for each column");
        self.text.push('\n');
    }

    /// The file's content.
    pub fn text(&self) -> &str {
        &self.text
    }
}

/// The headers "t [s]", then `symbol` of every joint in its unit, for each `(symbol, unit)`: "q1 [rad]", "q2 [rad]", …
pub fn headers(joints: usize, quantities: &[(&str, &str)]) -> Vec<String> {
    let of_joints =
        quantities.iter().flat_map(|(symbol, unit)| (1..=joints).map(move |joint| format!("{symbol}{joint} [{unit}]")));
    std::iter::once("t [s]".to_owned()).chain(of_joints).collect()
}
