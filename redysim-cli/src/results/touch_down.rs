//! When and where contacts touched down: the table `touch_downs.csv`.

use redysim_runtime::ContactEvent;

use super::names;
use crate::failure::Failure;
use crate::table::{self, Column};

/// The symbol of the column of contacts, and those of the places.
pub const CONTACT: &str = "contact";
pub const PLACE: [&str; 3] = ["x", "y", "z"];

/// The text of the table, which must have a row.
///
/// # Errors
/// If a number is infinite or NaN.
pub fn to_csv(touch_downs: &[ContactEvent<f64>]) -> Result<Vec<u8>, Failure> {
    let column = |symbol: &str, unit: &str, value: &dyn Fn(&ContactEvent<f64>) -> f64| Column {
        symbol: symbol.into(),
        name: String::new(),
        unit: unit.into(),
        values: touch_downs.iter().map(value).collect(),
    };
    let mut columns = vec![column(CONTACT, "1", &|of| of.contact as f64)];
    columns.extend((0..3).map(|axis| column(PLACE[axis], "m", &|of| of.place[axis])));
    let t: Vec<f64> = touch_downs.iter().map(|of| of.t).collect();
    table::to_csv(names::TOUCH_DOWNS, &t, &columns)
}
