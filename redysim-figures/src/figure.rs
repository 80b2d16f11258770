//! What a picture shows, before it is drawn: panels with curves over time, or over what they say.

use crate::axis::{drawable, extent};
use crate::{Series, column, peak};

/// A picture: panels in rows. Those above each other have the same horizontal axis.
#[derive(Clone, Debug)]
pub struct Figure {
    /// How many panels stand beside each other.
    pub columns: usize,
    /// The panels, by rows.
    pub panels: Vec<Panel>,
    /// Whether all panels show the same curves, so that one legend at the top serves all.
    pub shared_legend: bool,
}

/// One coordinate system.
#[derive(Clone, Debug)]
pub struct Panel {
    /// What stands above it.
    pub title: String,
    /// What the vertical axis measures.
    pub quantity: String,
    /// The unit of what it measures.
    pub unit: String,
    /// Whether the vertical axis is logarithmic.
    pub logarithmic: bool,
    /// What the horizontal axis measures, and whether it is logarithmic.
    pub across: (String, bool),
    /// Values that its vertical axis holds beside those of its curves, so that it has the limits of another panel.
    pub held: Vec<f64>,
    /// What is drawn in it.
    pub curves: Vec<Curve>,
}

/// Values over time, or over what the panel says.
#[derive(Clone, Debug)]
pub struct Curve {
    /// As the legend shows it; a curve without a name needs none.
    pub name: String,
    /// Time, or what the panel says, and value.
    pub points: Vec<(f64, f64)>,
    /// Number in the palette.
    pub colour: usize,
    /// How it is drawn.
    pub mark: Mark,
}

impl Curve {
    /// Its values, in order.
    pub(crate) fn values(&self) -> impl Iterator<Item = f64> {
        self.points.iter().map(|point| point.1)
    }
}

/// How a curve is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A line.
    Line,
    /// A line with a dot at every point.
    Dots,
    /// A dot at every point.
    Scatter,
    /// Hollow circles at a few points, so that a line below can be seen.
    Circles,
}

/// Circles along one curve.
const CIRCLES: usize = 20;

/// A panel for each joint, two beside each other: the runs as lines, references as circles, values times `factor`.
pub fn joint_grid(quantity: &str, unit: &str, factor: f64, lines: &[Series<'_>], circles: &[Series<'_>]) -> Figure {
    let panel = |joint: usize| {
        let values =
            |series: &Series<'_>| column(series.rows, joint).iter().map(|value| factor * value).collect::<Vec<_>>();
        let panel = Panel::new(format!("joint {}", joint + 1), quantity, unit);
        let draw =
            |panel: Panel, (index, run): (usize, &Series<'_>)| panel.line(run.name, index + 1, run.t, &values(run));
        let panel = lines.iter().enumerate().fold(panel, draw);
        circles.iter().fold(panel, |panel, run| panel.circles(run.name, run.t, &values(run)))
    };
    let joints = lines.first().and_then(|run| run.rows.first()).map_or(0, Vec::len);
    Figure { columns: 2, panels: (0..joints).map(panel).collect(), shared_legend: true }
}

impl Panel {
    /// An empty panel whose vertical axis shows `quantity` in `unit`.
    pub fn new(title: impl Into<String>, quantity: &str, unit: &str) -> Self {
        let (title, quantity, unit) = (title.into(), quantity.to_owned(), unit.to_owned());
        let across = ("time [s]".to_owned(), false);
        Panel { title, quantity, unit, logarithmic: false, across, held: Vec::new(), curves: Vec::new() }
    }

    /// The place of a panel that is left empty.
    pub fn gap() -> Self {
        Panel::new("", "", "")
    }

    /// Whether nothing is drawn in its place.
    pub fn is_gap(&self) -> bool {
        self.title.is_empty() && self.quantity.is_empty() && self.curves.is_empty()
    }

    /// Makes the horizontal axis a logarithmic one that measures `quantity`.
    pub fn over(mut self, quantity: &str) -> Self {
        self.across = (quantity.to_owned(), true);
        self
    }

    /// Adds a line with a dot at every point, in colour number `colour`; of no points, for the legend alone.
    pub fn dots(mut self, name: &str, colour: usize, points: &[(f64, f64)]) -> Self {
        self.curves.push(Curve { name: name.to_owned(), points: points.to_vec(), colour, mark: Mark::Dots });
        self
    }

    /// Adds dots in colour number `colour`.
    pub fn scatter(mut self, name: &str, colour: usize, points: &[(f64, f64)]) -> Self {
        self.curves.push(Curve { name: name.to_owned(), points: points.to_vec(), colour, mark: Mark::Scatter });
        self
    }

    /// Makes the vertical axis logarithmic.
    pub fn logarithmic(mut self) -> Self {
        self.logarithmic = true;
        self
    }

    /// Adds a line in colour number `colour`.
    pub fn line(mut self, name: &str, colour: usize, t: &[f64], values: &[f64]) -> Self {
        let points = t.iter().copied().zip(values.iter().copied()).collect();
        self.curves.push(Curve { name: name.to_owned(), points, colour, mark: Mark::Line });
        self
    }

    /// Adds circles at about twenty of the points, in the palette's black.
    pub fn circles(mut self, name: &str, t: &[f64], values: &[f64]) -> Self {
        let every = (t.len().saturating_sub(1) / CIRCLES).max(1);
        let points = t.iter().copied().zip(values.iter().copied()).step_by(every).collect();
        self.curves.push(Curve { name: name.to_owned(), points, colour: 0, mark: Mark::Circles });
        self
    }

    /// Adds a line for each joint, in the joint's own colour. Lines that coincide would hide each other: they become
    /// one, which names all its joints.
    pub fn joints(mut self, t: &[f64], rows: &[Vec<f64>]) -> Self {
        let columns: Vec<Vec<f64>> = (0..rows.first().map_or(0, Vec::len)).map(|joint| column(rows, joint)).collect();
        for group in coincident(&columns, |values| 1e-9 * peak(values.iter().copied())) {
            let joints: Vec<usize> = group.iter().map(|joint| joint + 1).collect();
            self = self.line(&joint_names(&joints), joints[0], t, &columns[group[0]]);
        }
        self
    }

    /// Replaces curves that coincide in the picture by one curve with all their names.
    pub fn merged(mut self) -> Self {
        let columns: Vec<Vec<f64>> = self.curves.iter().map(|curve| curve.values().collect()).collect();
        let shown = extent(columns.iter().flatten().copied());
        let groups = coincident(&columns, |_| 2e-3 * (shown.end - shown.start));
        let merged = groups.iter().map(|group| {
            let names: Vec<&str> = group.iter().map(|&index| self.curves[index].name.as_str()).collect();
            Curve { name: enumeration(&names, group), ..self.curves[group[0]].clone() }
        });
        self.curves = merged.collect();
        self
    }

    /// Measures the vertical axis in thousandths, millionths, … of the unit where the values are that small. The unit 1,
    /// of plain numbers, stays.
    pub fn prefixed(mut self) -> Self {
        if self.unit == "1" {
            return self;
        }
        let values = self.curves.iter().flat_map(Curve::values).chain(self.held.iter().copied());
        let size = peak(values.filter(|value| drawable(*value)));
        let (factor, prefix) = PREFIXES.into_iter().find(|(factor, _)| size * factor >= 0.5).unwrap_or((1.0, ""));
        for point in self.curves.iter_mut().flat_map(|curve| &mut curve.points) {
            point.1 *= factor;
        }
        self.held.iter_mut().for_each(|value| *value *= factor);
        self.unit.insert_str(0, prefix);
        self
    }
}

const PREFIXES: [(f64, &str); 6] = [(1.0, ""), (1e3, "m"), (1e6, "µ"), (1e9, "n"), (1e12, "p"), (1e15, "f")];

/// The numbers of those columns that differ from the first of them by no more than its tolerance.
pub(crate) fn coincident(columns: &[Vec<f64>], tolerance: impl Fn(&[f64]) -> f64) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (index, values) in columns.iter().enumerate() {
        let same = |first: &[f64]| {
            first.len() == values.len() && peak(first.iter().zip(values).map(|(a, b)| a - b)) <= tolerance(first)
        };
        match groups.iter_mut().find(|group| same(&columns[group[0]])) {
            Some(group) => group.push(index),
            None => groups.push(vec![index]),
        }
    }
    groups
}

/// "a, b", with "c … f" for those that follow each other by their `numbers`, which ascend.
pub(crate) fn enumeration(names: &[&str], numbers: &[usize]) -> String {
    let names: Vec<(usize, &str)> = numbers.iter().copied().zip(names.iter().copied()).collect();
    let runs = names.chunk_by(|a, b| a.0 + 1 == b.0);
    let texts = runs.map(|run| match run {
        [first, _, .., last] => format!("{} … {}", first.1, last.1),
        few => few.iter().map(|name| name.1).collect::<Vec<_>>().join(", "),
    });
    texts.collect::<Vec<_>>().join(", ")
}

/// "joint 1", "joints 2, 3", "joints 1–6".
fn joint_names(joints: &[usize]) -> String {
    let (first, last) = (joints[0], joints[joints.len() - 1]);
    if joints.len() == 1 {
        format!("joint {first}")
    } else if joints.len() > 2 && last - first + 1 == joints.len() {
        format!("joints {first}–{last}")
    } else {
        format!("joints {}", joints.iter().map(usize::to_string).collect::<Vec<_>>().join(", "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(curves: &[&[f64]]) -> Panel {
        let name = |k: usize| char::from(b'a' + k as u8).to_string();
        let line = |panel: Panel, (k, values): (usize, &&[f64])| panel.line(&name(k), k, &[0.0, 1.0], values);
        curves.iter().enumerate().fold(Panel::new("Torques", "torque", "N m"), line)
    }

    fn names(panel: &Panel) -> Vec<&str> {
        panel.curves.iter().map(|curve| curve.name.as_str()).collect()
    }

    #[test]
    fn small_values_are_measured_in_a_smaller_unit() {
        for (size, unit, shown) in [
            (0.0, "N m", 0.0),
            (2.0, "N m", 2.0),
            (0.5, "N m", 0.5),
            (0.25, "mN m", 250.0),
            (3e-5, "µN m", 30.0),
            (7e-9, "nN m", 7.0),
            (1e-12, "pN m", 1.0),
            (4e-15, "fN m", 4.0),
            (1e-30, "N m", 1e-30),
        ] {
            let panel = panel(&[&[0.0, -size], &[size / 2.0, f64::NAN]]).prefixed();
            assert_eq!(panel.unit, unit, "{size}");
            assert!((panel.curves[0].points[1].1 + shown).abs() <= 1e-12 * shown, "{size}: {:?}", panel.curves);
            assert!((panel.curves[1].points[0].1 - shown / 2.0).abs() <= 1e-12 * shown, "one scale for all curves");
        }
        let part_of_a_quaternion = Panel::new("", "quaternion", "1").line("", 1, &[0.0], &[0.1]).prefixed();
        assert_eq!((&*part_of_a_quaternion.unit, part_of_a_quaternion.curves[0].points[0].1), ("1", 0.1));
    }

    #[test]
    fn joints_that_move_alike_are_one_curve_that_names_them() {
        let names_of = |rows: &[Vec<f64>]| -> Vec<String> {
            let panel = Panel::new("", "angle", "rad").joints(&[0.0, 1.0], rows);
            panel.curves.into_iter().map(|curve| format!("{} {}", curve.name, curve.colour)).collect()
        };
        assert_eq!(names_of(&[]), [""; 0]);
        assert_eq!(names_of(&[vec![0.0; 6], vec![1.0; 6]]), ["joints 1–6 1"]);
        let rows = [vec![0.0, 0.0, 0.0, 5.0], vec![1.0, 2.0, 1.0, 5.0 + 1e-12]];
        assert_eq!(names_of(&rows), ["joints 1, 3 1", "joint 2 2", "joint 4 4"]);
    }

    #[test]
    fn curves_that_cannot_be_distinguished_are_one_that_names_them_all() {
        let apart = panel(&[&[0.0, 1.0], &[0.0, 1.1]]).merged();
        assert_eq!(names(&apart), ["a", "b"]);
        let close = panel(&[&[0.0, 100.0], &[1e-6, 0.0], &[0.0, 0.0], &[0.0, 99.99], &[0.0, 1e-3], &[f64::NAN; 2]]);
        assert_eq!(names(&close.merged()), ["a, d", "b, c, e", "f"]);
        let all = panel(&[[0.0, 0.0].as_slice(); 5]).merged();
        assert_eq!((names(&all), all.curves[0].colour), (vec!["a … e"], 0));
    }

    /// The axis goes from 50.00 to 50.05.
    #[test]
    fn curves_far_from_zero_are_distinguished_by_what_their_axis_shows() {
        let crossing = panel(&[&[50.0, 50.05], &[50.05, 50.0], &[50.0, 50.049_99]]).merged();
        assert_eq!(names(&crossing), ["a, c", "b"]);
        let constant = panel(&[&[50.0, 50.0], &[50.0, 50.0 + 1e-13]]).merged();
        assert_eq!(names(&constant), ["a, b"]);
    }
}
