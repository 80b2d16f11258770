//! What a picture shows, before it is drawn: panels with curves over time, or over what they say.

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
        Panel { title, quantity, unit, logarithmic: false, across: ("time [s]".to_owned(), false), curves: Vec::new() }
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
        let mut groups: Vec<(Vec<usize>, Vec<f64>)> = Vec::new();
        for joint in 0..rows.first().map_or(0, Vec::len) {
            let values = column(rows, joint);
            match groups.iter_mut().find(|(_, others)| coincide(others, &values)) {
                Some((joints, _)) => joints.push(joint + 1),
                None => groups.push((vec![joint + 1], values)),
            }
        }
        for (joints, values) in groups {
            self = self.line(&joint_names(&joints), joints[0], t, &values);
        }
        self
    }

    /// Measures the vertical axis in thousandths, millionths, … of the unit where the values are that small.
    pub fn prefixed(mut self) -> Self {
        let values = self.curves.iter().flat_map(|curve| &curve.points).map(|point| point.1);
        let size = peak(values);
        let (factor, prefix) = PREFIXES.into_iter().find(|(factor, _)| size * factor >= 0.5).unwrap_or((1.0, ""));
        for point in self.curves.iter_mut().flat_map(|curve| &mut curve.points) {
            point.1 *= factor;
        }
        self.unit.insert_str(0, prefix);
        self
    }
}

const PREFIXES: [(f64, &str); 6] = [(1.0, ""), (1e3, "m"), (1e6, "µ"), (1e9, "n"), (1e12, "p"), (1e15, "f")];

fn coincide(a: &[f64], b: &[f64]) -> bool {
    peak(a.iter().zip(b).map(|(a, b)| a - b)) <= 1e-9 * peak(a.iter().copied())
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
