//! Where contacts have touched down.

use crate::failure::Failure;
use crate::recorded::Recorded;
use crate::results::names;
use crate::results::touch_down::{CONTACT, PLACE};
use crate::table::{Column, Table};

/// The touch-downs that a run has recorded as they happened; one between two rows of the other tables is among them.
pub struct TouchDowns {
    t: Vec<f64>,
    contacts: Vec<f64>,
    places: [Vec<f64>; 3],
}

impl TouchDowns {
    /// Those of a run; `None` where the run has no such table: without touch-downs, or by an earlier version.
    ///
    /// # Errors
    /// If the table cannot be read, or lacks a column.
    pub fn of(recorded: &Recorded) -> Result<Option<TouchDowns>, Failure> {
        let Some(table) = recorded.table(names::TOUCH_DOWNS)? else { return Ok(None) };
        let [x, y, z] = PLACE.map(|symbol| column(&table, symbol));
        let (contacts, places) = (column(&table, CONTACT)?, [x?, y?, z?]);
        Ok(Some(TouchDowns { contacts, places, t: table.t }))
    }

    /// When, s, and where, m, in the base frame the contact number `contact` touched down.
    pub fn of_contact(&self, contact: usize) -> impl Iterator<Item = (f64, [f64; 3])> {
        let rows = (0..self.t.len()).filter(move |&row| self.contacts[row] == contact as f64);
        rows.map(|row| (self.t[row], [0, 1, 2].map(|axis| self.places[axis][row])))
    }
}

fn column(table: &Table, symbol: &str) -> Result<Vec<f64>, Failure> {
    table.of(symbol).next().map(|Column { values, .. }| values.clone()).ok_or_else(|| {
        Failure::input(format!("{}:1: the column `{symbol} [..]` is missing", table.path.display()))
            .help("results are read as a run has written them: run the scenario again")
    })
}
