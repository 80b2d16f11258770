//! Draws a [`Figure`] as SVG.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::DrawingError;
use crate::axis::{Axis, drawable};
use crate::figure::{Curve, Figure, Mark, Panel};

/// The backend knows whole pixels only. A picture is drawn this many times as large as it is shown, so that curves are
/// smooth; all lengths below are in shown pixels, times this.
const FINE: i32 = 4;

const WIDTH: i32 = 800;
/// Height of a panel's coordinate system, of its headline, and of the title of the time axis.
const PLOT: i32 = 190;
const HEAD: i32 = 32;
const TIME_TITLE: i32 = 20;
/// From one row of a legend to the next.
const LEGEND_ROW: i32 = 22;
const LEFT: i32 = 74;
/// Room that the turned title of the vertical axis takes on its outer side.
const TITLE_INSET: i32 = 14;
const RIGHT: i32 = 20;
const TICK_LABELS: i32 = 24;

/// Black, and the colours of Okabe and Ito, which colour-blind people can tell apart; then two that they may not.
const PALETTE: [RGBColor; 10] = [
    RGBColor(0, 0, 0),
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(120, 120, 120),
    RGBColor(120, 70, 30),
    RGBColor(150, 150, 0),
];
/// When all colours are taken, they come again in dashes.
const DASH: (i32, i32) = (7, 3);
const INK: RGBColor = RGBColor(40, 40, 40);
const GRID: RGBColor = RGBColor(225, 225, 225);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), DrawingError>;

impl<E: std::error::Error + Send + Sync> From<DrawingAreaErrorKind<E>> for DrawingError {
    fn from(error: DrawingAreaErrorKind<E>) -> Self {
        DrawingError::new(error)
    }
}

/// The figure as an SVG file of 800 pixels in width.
///
/// # Errors
///
/// If the figure cannot be laid out: it has no columns, for one.
pub fn svg(figure: &Figure) -> Result<String, DrawingError> {
    if figure.columns == 0 {
        return Err(DrawingError::new("it has panels in no columns: give `columns` 1 or more"));
    }
    let rows = figure.panels.len().div_ceil(figure.columns) as i32;
    let shared = figure.panels.first().filter(|_| figure.shared_legend);
    let legend = shared.map_or(0, |panel| legend_height(panel, LEFT));
    let head = figure.panels.iter().map(|panel| head_height(panel, figure.shared_legend)).max().unwrap_or(HEAD);
    let row = head + PLOT + TICK_LABELS;
    let height = legend + rows * row + TIME_TITLE;
    let size = |length: i32| (length * FINE) as u32;
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (size(WIDTH), size(height))).into_drawing_area();
        root.fill(&WHITE)?;
        let (top, rest) = root.split_vertically(legend * FINE);
        if let Some(panel) = shared {
            draw_legend(&top, panel, LEFT)?;
        }
        let columns: Vec<i32> =
            (1..figure.columns).map(|k| (WIDTH * FINE) * k as i32 / figure.columns as i32).collect();
        let breaks: Vec<i32> = (1..rows).map(|k| k * row * FINE).collect();
        for (index, (area, panel)) in
            rest.split_by_breakpoints(&columns, &breaks).iter().zip(&figure.panels).enumerate()
        {
            let last = index + figure.columns >= figure.panels.len();
            draw_panel(area, panel, head, last, figure.shared_legend)?;
        }
        root.present()?;
    }
    let drawn = format!(r#"<svg width="{}" height="{}""#, size(WIDTH), size(height));
    Ok(text.replacen(&drawn, &format!(r#"<svg width="{WIDTH}" height="{height}""#), 1))
}

fn font(size: i32, colour: &RGBColor) -> TextStyle<'static> {
    ("sans-serif", size * FINE).into_font().color(colour)
}

/// Room above a panel's coordinate system for its title and, unless that is shared, its legend.
fn head_height(panel: &Panel, shared_legend: bool) -> i32 {
    if shared_legend { HEAD } else { legend_height(panel, legend_start(panel)) }
}

/// Where the legend begins behind the panel's title.
fn legend_start(panel: &Panel) -> i32 {
    LEFT + 30 + text_width(&panel.title)
}

fn legend_height(panel: &Panel, left: i32) -> i32 {
    HEAD + LEGEND_ROW * legend_places(panel, left).last().map_or(0, |place| place.2)
}

fn draw_panel(area: &Area<'_>, panel: &Panel, head: i32, last: bool, shared_legend: bool) -> Drawn {
    let (head, body) = area.split_vertically(head * FINE);
    let left_middle = Pos::new(HPos::Left, VPos::Center);
    let bold = ("sans-serif", 16 * FINE).into_font().style(FontStyle::Bold).color(&INK).pos(left_middle);
    head.draw(&Text::new(panel.title.clone(), (LEFT * FINE, (HEAD - 13) * FINE), bold))?;
    if !shared_legend {
        draw_legend(&head, panel, legend_start(panel))?;
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
        .x_desc(if last { &panel.across.0 } else { "" })
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
        let points: Vec<(f64, f64)> = points(panel, curve).collect();
        // What cannot be drawn leaves a gap.
        for run in points.split(|point| !drawable(point.0) || !drawable(point.1)) {
            let dots = |radius: i32, style: ShapeStyle| run.iter().map(move |&at| Circle::new(at, radius, style));
            if matches!(curve.mark, Mark::Line | Mark::Dots) {
                let (points, style) = (run.iter().copied(), line_style(curve));
                if dashed(curve) {
                    chart.draw_series(DashedLineSeries::new(points, DASH.0 * FINE, DASH.1 * FINE, style))?;
                } else {
                    chart.draw_series(LineSeries::new(points, style))?;
                }
            }
            match curve.mark {
                // A line of one point would not be seen.
                Mark::Line if run.len() == 1 => chart.draw_series(dots(FINE, line_style(curve).filled()))?,
                Mark::Line => continue,
                Mark::Dots | Mark::Scatter => chart.draw_series(dots(3 * FINE, line_style(curve).filled()))?,
                Mark::Circles => chart.draw_series(dots(3 * FINE, circle_style(curve)))?,
            };
        }
    }
    Ok(())
}

fn axes(panel: &Panel) -> (Axis, Axis) {
    let all = || panel.curves.iter().flat_map(|curve| points(panel, curve));
    let axis = |values: Vec<f64>, logarithmic: bool, ticks| {
        if logarithmic { Axis::logarithmic(values.into_iter(), ticks) } else { Axis::linear(values.into_iter(), ticks) }
    };
    let x = axis(all().map(|point| point.0).collect(), panel.across.1, 5);
    (x, axis(all().map(|point| point.1).collect(), panel.logarithmic, 6))
}

/// Where the points of a curve stand on the panel's axes.
fn points(panel: &Panel, curve: &Curve) -> impl Iterator<Item = (f64, f64)> {
    let coordinate = |value: f64, logarithmic: bool| if logarithmic { value.log10() } else { value };
    let place = move |&(x, y): &(f64, f64)| (coordinate(x, panel.across.1), coordinate(y, panel.logarithmic));
    curve.points.iter().map(place)
}

fn line_style(curve: &Curve) -> ShapeStyle {
    PALETTE[curve.colour % PALETTE.len()].stroke_width(2 * FINE as u32)
}

fn dashed(curve: &Curve) -> bool {
    curve.colour / PALETTE.len() % 2 == 1
}

fn circle_style(curve: &Curve) -> ShapeStyle {
    PALETTE[curve.colour % PALETTE.len()].stroke_width(FINE as u32)
}

/// Length of a curve's sample in the legend, and room before and behind its name.
const SAMPLE: i32 = 22;
const GAP: i32 = 6;
const BETWEEN: i32 = 14;

/// The curves that have names, once each, with the places of their samples: distance from the left, and row.
fn legend_places(panel: &Panel, left: i32) -> Vec<(&Curve, i32, i32)> {
    let mut places: Vec<(&Curve, i32, i32)> = Vec::new();
    let (mut x, mut row) = (left, 0);
    for curve in panel.curves.iter().filter(|curve| !curve.name.is_empty()) {
        if places.iter().any(|(other, ..)| other.name == curve.name) {
            continue;
        }
        let width = SAMPLE + GAP + text_width(&curve.name);
        if x > left && x + width > WIDTH - RIGHT {
            (x, row) = (left, row + 1);
        }
        places.push((curve, x, row));
        x += width + BETWEEN;
    }
    places
}

/// Draws the names of the panel's curves in rows that begin at `x`, above the coordinate system, where no data is.
fn draw_legend(area: &Area<'_>, panel: &Panel, x: i32) -> Drawn {
    for (curve, x, row) in legend_places(panel, x) {
        let y = (HEAD - 13 + LEGEND_ROW * row) * FINE;
        let (from, to) = (x * FINE, (x + SAMPLE) * FINE);
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
        let style = font(15, &INK).pos(Pos::new(HPos::Left, VPos::Center));
        area.draw(&Text::new(curve.name.clone(), ((x + SAMPLE + GAP) * FINE, y), style))?;
    }
    Ok(())
}

/// About the width of a text; the backend leaves the true one to the viewer's fonts.
fn text_width(text: &str) -> i32 {
    8 * text.chars().count() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One panel with so many curves.
    fn height(curves: usize) -> i32 {
        let panel = (0..curves).fold(Panel::new("Torques", "torque", "N m"), |panel, k| {
            panel.line(&format!("joint {k}"), k, &[0.0, 1.0], &[0.0, 1.0])
        });
        let svg = svg(&Figure { columns: 1, panels: vec![panel], shared_legend: false }).unwrap();
        let (_, rest) = svg.split_once("height=\"").unwrap();
        rest.split_once('"').unwrap().0.parse().unwrap()
    }

    #[test]
    fn a_long_legend_gets_the_rows_it_needs() {
        assert_eq!(height(1), height(3));
        assert!(height(40) > height(3) + 3 * LEGEND_ROW);
    }

    fn drawn(values: &[f64]) -> String {
        let t: Vec<f64> = (0..values.len()).map(|k| k as f64).collect();
        let panels = vec![Panel::new("Torques", "torque", "N m").line("", 1, &t, values)];
        svg(&Figure { columns: 1, panels, shared_legend: false }).unwrap()
    }

    /// How many elements of this kind have the colour of the curve.
    fn count(svg: &str, element: &str) -> usize {
        svg.lines().filter(|line| line.starts_with(element) && line.contains("#0072B2")).count()
    }

    #[test]
    fn what_cannot_be_drawn_leaves_a_gap() {
        assert_eq!(count(&drawn(&[1.0, 2.0, 3.0]), "<polyline"), 1);
        assert_eq!(count(&drawn(&[1.0, 2.0, f64::NAN, f64::INFINITY, 2.0, 1.0]), "<polyline"), 2);
    }

    #[test]
    fn a_point_between_gaps_is_a_dot() {
        assert_eq!(count(&drawn(&[1.0, 2.0, f64::NAN, 2.0, f64::NAN]), "<circle"), 1);
    }

    #[test]
    fn a_colour_that_comes_again_is_dashed() {
        let of = |colour: usize| {
            let panel = Panel::new("Torques", "torque", "N m").line("", colour, &[0.0, 1.0], &[0.0, 1.0]);
            count(&svg(&Figure { columns: 1, panels: vec![panel], shared_legend: false }).unwrap(), "<polyline")
        };
        assert_eq!((of(1), of(1 + 2 * PALETTE.len())), (1, 1));
        assert!(of(1 + PALETTE.len()) > 50, "{}", of(1 + PALETTE.len()));
    }

    #[test]
    fn a_figure_without_columns_cannot_be_drawn() {
        let error = svg(&Figure { columns: 0, panels: vec![], shared_legend: false }).unwrap_err();
        assert!(error.to_string().contains("`columns`"), "{error}");
    }
}
