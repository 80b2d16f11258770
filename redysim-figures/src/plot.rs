//! Draws a [`Figure`] as SVG.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::axis::{Axis, drawable};
use crate::figure::{Curve, Figure, Mark, Panel};
use crate::legend::{self, Legend};
use crate::{DrawingError, text};

/// The backend knows whole pixels only. A picture is drawn this many times as large as it is shown, so that curves are
/// smooth; all lengths below are in shown pixels, times this.
pub(crate) const FINE: i32 = 4;

const WIDTH: i32 = 800;
/// Height of a panel's coordinate system, of its headline with the middle of the letters in it, and of the title of the
/// time axis.
const PLOT: i32 = 190;
const HEAD: i32 = 32;
pub(crate) const HEADLINE: i32 = HEAD - 13;
const TIME_TITLE: i32 = 20;
/// Room on the left of a coordinate system, at least.
const LEFT: i32 = 74;
/// Room that the turned title of the vertical axis takes on its outer side, and from there to the labels.
const TITLE_INSET: i32 = 14;
const TITLE_HEIGHT: i32 = 18;
const RIGHT: i32 = 20;
const TICK_LABELS: i32 = 24;
const TICK: i32 = 4;
/// Size of labels, and room between two of them.
const LABEL: i32 = 15;
const APART: i32 = 10;
/// Room for the title of one of two panels beside each other.
pub(crate) const HALF: i32 = WIDTH / 2 - LEFT - RIGHT;

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
pub(crate) const DASH: (i32, i32) = (7, 3);
pub(crate) const INK: RGBColor = RGBColor(40, 40, 40);
const GRID: RGBColor = RGBColor(225, 225, 225);

pub(crate) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(crate) type Drawn = Result<(), DrawingError>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Axis, Axis>>;

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
    let shared = figure.panels.first().filter(|_| figure.shared_legend);
    let left = figure.panels.iter().map(left_room).max().unwrap_or(LEFT);
    let place = Place { width: WIDTH / figure.columns as i32, left, own_legend: !figure.shared_legend };
    let legend = shared.map(|panel| Legend::of(panel, left, WIDTH - RIGHT));
    let legend_height = legend.as_ref().map_or(0, |legend| HEAD + legend::ROW * (legend.rows() - 1).max(0));
    let rows = rows(figure, &place);
    let height = legend_height + rows.iter().map(Row::height).sum::<i32>();
    let size = |length: i32| (length * FINE) as u32;
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, (size(WIDTH), size(height))).into_drawing_area();
        root.fill(&WHITE)?;
        let (top, rest) = root.split_vertically(legend_height * FINE);
        legend.iter().try_for_each(|legend| legend.draw(&top, 0))?;
        let columns: Vec<i32> =
            (1..figure.columns).map(|k| (WIDTH * FINE) * k as i32 / figure.columns as i32).collect();
        let breaks: Vec<i32> = (1..rows.len()).map(|k| FINE * rows[..k].iter().map(Row::height).sum::<i32>()).collect();
        let areas = rest.split_by_breakpoints(&columns, &breaks);
        for (index, (area, panel)) in areas.iter().zip(&figure.panels).enumerate() {
            if !panel.is_gap() {
                draw_panel(area, panel, &rows[index / figure.columns], is_last(figure, index), &place)?;
            }
        }
        root.present()?;
    }
    let drawn = format!(r#"<svg width="{}" height="{}""#, size(WIDTH), size(height));
    Ok(text.replacen(&drawn, &format!(r#"<svg width="{WIDTH}" height="{height}""#), 1))
}

/// What is the same for all panels.
struct Place {
    width: i32,
    /// Room on the left of the coordinate systems, which stand exactly below each other.
    left: i32,
    own_legend: bool,
}

/// Panels beside each other.
struct Row {
    /// Height above the coordinate systems.
    head: i32,
    /// Whether one of them has no panel below, and therefore the title of the horizontal axis.
    last: bool,
}

impl Row {
    fn height(&self) -> i32 {
        self.head + PLOT + TICK_LABELS + if self.last { TIME_TITLE } else { 0 }
    }
}

fn rows(figure: &Figure, place: &Place) -> Vec<Row> {
    let indices: Vec<usize> = (0..figure.panels.len()).collect();
    let row = |indices: &[usize]| Row {
        head: indices.iter().map(|&index| Head::of(&figure.panels[index], place).height).max().unwrap_or(HEAD),
        last: indices.iter().any(|&index| !figure.panels[index].is_gap() && is_last(figure, index)),
    };
    indices.chunks(figure.columns).map(row).collect()
}

/// Whether no panel stands below this one.
fn is_last(figure: &Figure, index: usize) -> bool {
    figure.panels.get(index + figure.columns).is_none_or(Panel::is_gap)
}

pub(crate) fn font(size: i32, colour: &RGBColor) -> TextStyle<'static> {
    ("sans-serif", size * FINE).into_font().color(colour)
}

/// The room that the labels of a panel's vertical axis need, with the title of the axis.
fn left_room(panel: &Panel) -> i32 {
    let label = vertical(panel).labels().iter().map(|label| text::width(label, LABEL)).max().unwrap_or(0);
    (TITLE_INSET + TITLE_HEIGHT + label + 2 * TICK).max(LEFT)
}

/// What stands above a coordinate system: the title in as many lines as it needs and, unless it is shared, the legend:
/// behind the title if there is room for it, or below.
struct Head<'a> {
    title: Vec<String>,
    legend: Option<Legend<'a>>,
    legend_top: i32,
    height: i32,
}

impl<'a> Head<'a> {
    fn of(panel: &'a Panel, place: &Place) -> Self {
        let right = place.width - RIGHT;
        let title = text::wrapped_title(&panel.title, right - place.left);
        let further = legend::ROW * (title.len() as i32 - 1);
        let behind = place.left + 30 + text::title_width(&panel.title);
        let legend = Some(Legend::of(panel, behind, right)).filter(|legend| further == 0 && legend.is_row());
        match (place.own_legend, legend) {
            (false, _) => Head { title, legend: None, legend_top: 0, height: HEAD + further },
            (true, Some(legend)) => Head { title, legend: Some(legend), legend_top: 0, height: HEAD },
            (true, None) => {
                let legend = Legend::of(panel, place.left, right);
                let height = HEAD + further + legend::ROW * legend.rows();
                Head { title, legend: Some(legend), legend_top: further + legend::ROW, height }
            }
        }
    }
}

fn draw_panel(area: &Area<'_>, panel: &Panel, row: &Row, last: bool, place: &Place) -> Drawn {
    let (head, body) = area.split_vertically(row.head * FINE);
    let left_middle = Pos::new(HPos::Left, VPos::Center);
    let bold = ("sans-serif", text::TITLE * FINE).into_font().style(FontStyle::Bold).color(&INK).pos(left_middle);
    let Head { title, legend, legend_top, .. } = Head::of(panel, place);
    for (line, y) in title.into_iter().zip((HEADLINE..).step_by(legend::ROW as usize)) {
        head.draw(&Text::new(line, (place.left * FINE, y * FINE), bold.clone()))?;
    }
    legend.iter().try_for_each(|legend| legend.draw(&head, legend_top))?;
    // Where one panel of the row has the title of the axis, the others have as much room.
    let below = if row.last { TICK_LABELS + TIME_TITLE } else { TICK_LABELS };
    let (x, y) = (across(panel, place.width - place.left - RIGHT), vertical(panel));
    let (left, right) = (x.range().start, x.range().end);
    let crosses_zero = !panel.logarithmic && y.range().start < 0.0 && y.range().end > 0.0;
    let mut chart = ChartBuilder::on(&body)
        .margin_right(RIGHT * FINE)
        .margin_left(TITLE_INSET * FINE)
        .set_label_area_size(LabelAreaPosition::Left, (place.left - TITLE_INSET) * FINE)
        .set_label_area_size(LabelAreaPosition::Bottom, below * FINE)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .bold_line_style(GRID.stroke_width(FINE as u32))
        .axis_style(INK.stroke_width(FINE as u32))
        .label_style(font(LABEL, &INK))
        .axis_desc_style(font(16, &INK))
        .x_desc(if last { &panel.across.0 } else { "" })
        .y_desc(format!("{} [{}]", panel.quantity, panel.unit))
        .set_all_tick_mark_size(TICK * FINE)
        .draw()?;
    if crosses_zero {
        chart.draw_series(LineSeries::new(
            [(left, 0.0), (right, 0.0)],
            RGBColor(150, 150, 150).stroke_width(FINE as u32),
        ))?;
    }
    for curve in &panel.curves {
        draw_curve(&mut chart, panel, curve)?;
    }
    Ok(())
}

fn draw_curve(chart: &mut Chart<'_, '_>, panel: &Panel, curve: &Curve) -> Drawn {
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
    Ok(())
}

/// The horizontal axis, which is so long.
fn across(panel: &Panel, length: i32) -> Axis {
    let values = panel.curves.iter().flat_map(|curve| points(panel, curve)).map(|point| point.0);
    if panel.across.1 {
        return Axis::logarithmic(values, 5);
    }
    Axis::between(values, 7).with_room(f64::from(length), |label| f64::from(text::width(label, LABEL) + APART))
}

fn vertical(panel: &Panel) -> Axis {
    let held = panel.held.iter().map(|&value| coordinate(value, panel.logarithmic));
    let values = panel.curves.iter().flat_map(|curve| points(panel, curve)).map(|point| point.1).chain(held);
    if panel.logarithmic { Axis::logarithmic(values, 6) } else { Axis::around(values, 8) }
}

fn coordinate(value: f64, logarithmic: bool) -> f64 {
    if logarithmic { value.log10() } else { value }
}

/// Where the points of a curve stand on the panel's axes.
fn points(panel: &Panel, curve: &Curve) -> impl Iterator<Item = (f64, f64)> {
    let place = move |&(x, y): &(f64, f64)| (coordinate(x, panel.across.1), coordinate(y, panel.logarithmic));
    curve.points.iter().map(place)
}

pub(crate) fn line_style(curve: &Curve) -> ShapeStyle {
    PALETTE[curve.colour % PALETTE.len()].stroke_width(2 * FINE as u32)
}

pub(crate) fn dashed(curve: &Curve) -> bool {
    curve.colour / PALETTE.len() % 2 == 1
}

pub(crate) fn circle_style(curve: &Curve) -> ShapeStyle {
    PALETTE[curve.colour % PALETTE.len()].stroke_width(FINE as u32)
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
        assert!(height(40) > height(3) + 3 * legend::ROW);
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
    fn coordinate_systems_stand_where_they_are_used_to_unless_labels_are_long() {
        let left = |values: &[f64], logarithmic: bool| {
            let panel = Panel { logarithmic, ..Panel::new("", "torque", "N m").line("", 1, &[0.0, 1.0], values) };
            left_room(&panel)
        };
        assert_eq!((left(&[1e-18, 1.0], true), left(&[-300.0, 300.0], false)), (LEFT, LEFT));
        assert!(left(&[12345.678, 12345.679], false) > LEFT + 20);
    }

    #[test]
    fn a_figure_without_columns_cannot_be_drawn() {
        let error = svg(&Figure { columns: 0, panels: vec![], shared_legend: false }).unwrap_err();
        assert!(error.to_string().contains("`columns`"), "{error}");
    }
}
