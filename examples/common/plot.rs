//! Draws a [`Figure`] as SVG.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::Failure;
use super::axis::Axis;
use super::figure::{Curve, Figure, Mark, Panel};

/// The backend knows whole pixels only. A picture is drawn this many times as large as it is shown, so that curves are
/// smooth; all lengths below are in shown pixels, times this.
const FINE: i32 = 4;

const WIDTH: i32 = 800;
/// Height of a panel's coordinate system, of its headline, and of the title of the time axis.
const PLOT: i32 = 190;
const HEAD: i32 = 32;
const TIME_TITLE: i32 = 20;
const LEFT: i32 = 74;
/// Room that the turned title of the vertical axis takes on its outer side.
const TITLE_INSET: i32 = 14;
const RIGHT: i32 = 20;
const TICK_LABELS: i32 = 24;

/// Black, and the colours of Okabe and Ito, which colour-blind people can tell apart.
const PALETTE: [RGBColor; 8] = [
    RGBColor(0, 0, 0),
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(120, 120, 120),
];
const INK: RGBColor = RGBColor(40, 40, 40);
const GRID: RGBColor = RGBColor(225, 225, 225);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), Failure>;

/// The figure as an SVG file of 800 pixels in width.
pub fn svg(figure: &Figure) -> Result<String, Failure> {
    let rows = figure.panels.len().div_ceil(figure.columns) as i32;
    let legend = if figure.shared_legend { HEAD } else { 0 };
    let row = HEAD + PLOT + TICK_LABELS;
    let height = legend + rows * row + TIME_TITLE;
    let size = |length: i32| (length * FINE) as u32;
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (size(WIDTH), size(height))).into_drawing_area();
        root.fill(&WHITE)?;
        let (top, rest) = root.split_vertically(legend * FINE);
        if let Some(panel) = figure.panels.first().filter(|_| figure.shared_legend) {
            draw_legend(&top, panel, LEFT)?;
        }
        let columns: Vec<i32> =
            (1..figure.columns).map(|k| (WIDTH * FINE) * k as i32 / figure.columns as i32).collect();
        let breaks: Vec<i32> = (1..rows).map(|k| k * row * FINE).collect();
        for (index, (area, panel)) in
            rest.split_by_breakpoints(&columns, &breaks).iter().zip(&figure.panels).enumerate()
        {
            let last = index + figure.columns >= figure.panels.len();
            draw_panel(area, panel, last, figure.shared_legend)?;
        }
        root.present()?;
    }
    let drawn = format!(r#"<svg width="{}" height="{}""#, size(WIDTH), size(height));
    Ok(text.replacen(&drawn, &format!(r#"<svg width="{WIDTH}" height="{height}""#), 1))
}

fn font(size: i32, colour: &RGBColor) -> TextStyle<'static> {
    ("sans-serif", size * FINE).into_font().color(colour)
}

fn draw_panel(area: &Area<'_>, panel: &Panel, last: bool, shared_legend: bool) -> Drawn {
    let (head, body) = area.split_vertically(HEAD * FINE);
    let left_middle = Pos::new(HPos::Left, VPos::Center);
    let bold = ("sans-serif", 16 * FINE).into_font().style(FontStyle::Bold).color(&INK).pos(left_middle);
    head.draw(&Text::new(panel.title.clone(), (LEFT * FINE, (HEAD - 13) * FINE), bold))?;
    if !shared_legend {
        draw_legend(&head, panel, LEFT + 30 + text_width(&panel.title))?;
    }
    let below = if last { TICK_LABELS + TIME_TITLE } else { TICK_LABELS };
    let (x, y) = axes(panel);
    let (left, right) = (x.range().start, x.range().end);
    let crosses_zero = !panel.logarithmic && y.range().start < 0.0 && y.range().end > 0.0;
    let mut chart = ChartBuilder::on(&body)
        .margin_right(RIGHT * FINE)
        .margin_left(TITLE_INSET * FINE)
        .set_label_area_size(LabelAreaPosition::Left, (LEFT - TITLE_INSET) * FINE)
        .set_label_area_size(LabelAreaPosition::Bottom, below * FINE)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID.stroke_width(FINE as u32))
        .axis_style(INK.stroke_width(FINE as u32))
        .label_style(font(15, &INK))
        .axis_desc_style(font(16, &INK))
        .x_desc(if last { "time [s]" } else { "" })
        .y_desc(format!("{} [{}]", panel.quantity, panel.unit))
        .set_all_tick_mark_size(4 * FINE)
        .draw()?;
    if crosses_zero {
        chart.draw_series(LineSeries::new(
            [(left, 0.0), (right, 0.0)],
            RGBColor(150, 150, 150).stroke_width(FINE as u32),
        ))?;
    }
    for curve in &panel.curves {
        let points = curve.points.iter().map(|&(t, value)| (t, coordinate(panel, value)));
        let points = points.filter(|point| point.1.is_finite());
        match curve.mark {
            Mark::Line => chart.draw_series(LineSeries::new(points, line_style(curve)))?,
            Mark::Circles => {
                chart.draw_series(points.map(|point| Circle::new(point, 3 * FINE, circle_style(curve))))?
            }
        };
    }
    Ok(())
}

fn axes(panel: &Panel) -> (Axis, Axis) {
    let points = || panel.curves.iter().flat_map(|curve| &curve.points);
    let values = points().map(|point| coordinate(panel, point.1));
    let y = if panel.logarithmic { Axis::logarithmic(values, 6) } else { Axis::linear(values, 6) };
    (Axis::linear(points().map(|point| point.0), 5), y)
}

/// Where a value stands on the panel's vertical axis.
fn coordinate(panel: &Panel, value: f64) -> f64 {
    if panel.logarithmic { value.log10() } else { value }
}

fn line_style(curve: &Curve) -> ShapeStyle {
    PALETTE[curve.colour % PALETTE.len()].stroke_width(2 * FINE as u32)
}

fn circle_style(curve: &Curve) -> ShapeStyle {
    PALETTE[curve.colour % PALETTE.len()].stroke_width(FINE as u32)
}

/// Draws the names of the panel's curves in a row that begins at `x`, above the coordinate system, where no data is.
fn draw_legend(area: &Area<'_>, panel: &Panel, mut x: i32) -> Drawn {
    const SAMPLE: i32 = 22;
    let y = (HEAD - 13) * FINE;
    let mut named: Vec<&str> = Vec::new();
    for curve in &panel.curves {
        if curve.name.is_empty() || named.contains(&curve.name.as_str()) {
            continue;
        }
        named.push(&curve.name);
        let (from, to) = (x * FINE, (x + SAMPLE) * FINE);
        match curve.mark {
            Mark::Line => area.draw(&PathElement::new([(from, y), (to, y)], line_style(curve)))?,
            Mark::Circles => area.draw(&Circle::new(((from + to) / 2, y), 3 * FINE, circle_style(curve)))?,
        }
        let style = font(15, &INK).pos(Pos::new(HPos::Left, VPos::Center));
        area.draw(&Text::new(curve.name.clone(), ((x + SAMPLE + 6) * FINE, y), style))?;
        x += SAMPLE + 6 + text_width(&curve.name) + 14;
    }
    Ok(())
}

/// About the width of a text; the backend leaves the true one to the viewer's fonts.
fn text_width(text: &str) -> i32 {
    8 * text.chars().count() as i32
}
