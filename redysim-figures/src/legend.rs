//! The names of a panel's curves, with samples of how they are drawn.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::figure::{Curve, Mark, Panel};
use crate::plot::{Area, DASH, Drawn, FINE, HEADLINE, INK, circle_style, dashed, font, line_style};
use crate::text;

/// From one row of a legend to the next.
pub const ROW: i32 = 22;
/// Length of a curve's sample, and room before and behind its name.
const SAMPLE: i32 = 22;
const GAP: i32 = 6;
const BETWEEN: i32 = 14;
const SIZE: i32 = 15;

/// Where the names stand.
pub struct Legend<'a> {
    entries: Vec<Entry<'a>>,
    rows: i32,
}

/// A curve with its name in lines, of which the first begins at this distance from the left, in this row.
struct Entry<'a> {
    curve: &'a Curve,
    lines: Vec<String>,
    x: i32,
    row: i32,
}

impl<'a> Legend<'a> {
    /// The curves that have names, once each, in rows from `left` to `right`.
    pub fn of(panel: &'a Panel, left: i32, right: i32) -> Self {
        let mut entries: Vec<Entry<'_>> = Vec::new();
        let (mut x, mut row) = (left, 0);
        for curve in panel.curves.iter().filter(|curve| !curve.name.is_empty()) {
            if entries.iter().any(|entry| entry.curve.name == curve.name) {
                continue;
            }
            let lines = text::wrapped(&curve.name, SIZE, right - left - SAMPLE - GAP);
            let width = SAMPLE + GAP + lines.iter().map(|line| text::width(line, SIZE)).max().unwrap_or(0);
            if x > left && x + width > right {
                (x, row) = (left, row + 1);
            }
            let further = lines.len() as i32 - 1;
            entries.push(Entry { curve, lines, x, row });
            (x, row) = if further == 0 { (x + width + BETWEEN, row) } else { (right, row + further) };
        }
        let rows = if entries.is_empty() { 0 } else { row + 1 };
        Legend { entries, rows }
    }

    /// Whether they stand in one row, all complete.
    pub fn is_row(&self) -> bool {
        self.rows <= 1 && self.entries.iter().all(|entry| entry.lines == [entry.curve.name.as_str()])
    }

    /// In how many rows they stand.
    pub fn rows(&self) -> i32 {
        self.rows
    }

    /// Draws them from `top` on.
    pub fn draw(&self, area: &Area<'_>, top: i32) -> Drawn {
        for Entry { curve, lines, x, row } in &self.entries {
            let y = |row: i32| (top + HEADLINE + ROW * row) * FINE;
            draw_sample(area, curve, x * FINE, y(*row))?;
            for (row, line) in (*row..).zip(lines) {
                let style = font(SIZE, &INK).pos(Pos::new(HPos::Left, VPos::Center));
                area.draw(&Text::new(line.clone(), ((x + SAMPLE + GAP) * FINE, y(row)), style))?;
            }
        }
        Ok(())
    }
}

fn draw_sample(area: &Area<'_>, curve: &Curve, from: i32, y: i32) -> Drawn {
    let to = from + SAMPLE * FINE;
    if matches!(curve.mark, Mark::Line | Mark::Dots) {
        let dashes = if dashed(curve) { DASH } else { (SAMPLE, 0) };
        for start in (from..to).step_by(((dashes.0 + dashes.1) * FINE) as usize) {
            let end = (start + dashes.0 * FINE).min(to);
            area.draw(&PathElement::new([(start, y), (end, y)], line_style(curve)))?;
        }
    }
    let middle = ((from + to) / 2, y);
    match curve.mark {
        Mark::Line => {}
        Mark::Dots | Mark::Scatter => area.draw(&Circle::new(middle, 3 * FINE, line_style(curve).filled()))?,
        Mark::Circles => area.draw(&Circle::new(middle, 3 * FINE, circle_style(curve)))?,
    }
    Ok(())
}
