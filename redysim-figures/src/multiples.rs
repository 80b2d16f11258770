//! Curves that are too many or too different in size for one coordinate system, in several.

use std::ops::Range;

use crate::axis::{drawable, extent};
use crate::figure::{Curve, Figure, Panel, coincident, enumeration};
use crate::plot::HALF;
use crate::{peak, text};

/// Curves whose sizes differ by more than this do not share a panel: the smaller one would be a flat line.
const FACTOR: f64 = 10.0;
/// A curve that swings by no more than this share of its peak is level.
const LEVEL: f64 = 0.1;
/// A peak of this share of the largest one is as good as zero.
const NOTHING: f64 = 1e-9;
/// Curves that differ by no more than this share of what is shown look the same.
const SIGHT: f64 = 2e-3;
/// A curve that swings by less than a panel shows, divided by this, would be a flat line, too, unless it is level.
const FLAT: f64 = 15.0;
/// Panels have the same limits if the curves of each fill this share of them.
const FILLED: f64 = 0.5;

impl Figure {
    /// Charts below each other, each of one or several panels: two of these beside each other if they are many. One
    /// legend serves all panels if they show the same curves.
    pub fn of_charts(mut charts: Vec<Vec<Panel>>) -> Figure {
        let count: usize = charts.iter().map(Vec::len).sum();
        let rows_of_two: usize = charts.iter().map(|panels| panels.len().div_ceil(2)).sum();
        // Few places stay empty.
        let columns = if count > 3 && 3 * rows_of_two <= 2 * count { 2 } else { 1 };
        let legends: Vec<Vec<_>> = charts.iter().flatten().map(legend).collect();
        let shared_legend = count > 1 && legends.windows(2).all(|pair| pair[0] == pair[1]);
        for panels in &mut charts {
            panels.resize(panels.len().next_multiple_of(columns), Panel::gap());
        }
        Figure { columns, panels: charts.into_iter().flatten().collect(), shared_legend }
    }
}

/// Curves that coincide in one panel may be apart in the next.
fn legend(panel: &Panel) -> Vec<(String, usize)> {
    panel.curves.iter().map(|curve| (curve.name.clone(), curve.colour)).collect()
}

/// What one of several panels shows: numbers of curves, those that look the same together.
type Part = Vec<Vec<usize>>;

impl Panel {
    /// The panel's curves in as many panels as they need. `groups` has the number of the group to which each curve
    /// belongs: unless all are zero, a panel has curves of one group, whose sizes are within a factor of ten and of which none is a flat
    /// line. Of each group there are the fewest panels for which this is so, and of these those whose sizes are furthest
    /// apart. Panels of about one size
    /// have the same limits. Curves that coincide in the picture become one curve with all their names. The title of a
    /// panel names its curves, or where that is too long for one line, the first and the last of them.
    pub fn multiples(self, groups: &[usize]) -> Vec<Panel> {
        // If all are zero, there is nothing to tell apart.
        let zeros = vec![0; groups.len()];
        let groups = if self.is_nothing(&Vec::from_iter(0..groups.len())) { &zeros } else { groups };
        let mut numbers = groups.to_vec();
        numbers.sort_unstable();
        numbers.dedup();
        let of = |number: usize| (0..self.curves.len()).filter(move |&index| groups[index] == number).collect();
        let parts: Vec<Part> =
            numbers.into_iter().flat_map(|number| self.by_size(of(number))).map(|part| self.alike(&part)).collect();
        let panel = |(part, held): (&Part, Vec<f64>)| Panel {
            title: if parts.len() == 1 { self.title.clone() } else { self.part_title(part) },
            curves: part.iter().map(|alike| self.joined(alike)).collect(),
            held,
            quantity: self.quantity.clone(),
            unit: self.unit.clone(),
            across: self.across.clone(),
            logarithmic: self.logarithmic,
        };
        parts.iter().zip(self.limits(&parts)).map(panel).map(Panel::prefixed).collect()
    }

    /// Curves by their sizes, those together that are within a factor of [`FACTOR`] and can be seen beside each other.
    /// What is as good as zero lies on the axis, be that what it may: it joins the largest.
    fn by_size(&self, curves: Vec<usize>) -> Vec<Vec<usize>> {
        let (nothing, mut order): (Vec<usize>, Vec<usize>) =
            curves.into_iter().partition(|&index| self.is_nothing(&[index]));
        let size = |index: &usize| self.size(*index);
        order.sort_by(|a, b| size(b).total_cmp(&size(a)));
        let descending: Vec<f64> = order.iter().map(size).collect();
        let runs = runs(&descending, |run| self.can_be_seen(&order[run]));
        let mut parts: Vec<Vec<usize>> = runs.into_iter().map(|run| order[run].to_vec()).collect();
        match parts.first_mut() {
            Some(largest) => largest.extend(nothing),
            None if nothing.is_empty() => {}
            None => parts.push(nothing),
        }
        parts.iter_mut().for_each(|part| part.sort_unstable());
        parts.sort();
        parts
    }

    /// The curves of a panel, those that look the same together.
    fn alike(&self, part: &[usize]) -> Part {
        if self.is_nothing(part) {
            return vec![part.to_vec()];
        }
        let shown = self.extent(part);
        let columns: Vec<Vec<f64>> = part.iter().map(|&index| self.curves[index].values().collect()).collect();
        let alike = coincident(&columns, |_| SIGHT * (shown.end - shown.start));
        alike.iter().map(|members| members.iter().map(|&member| part[member]).collect()).collect()
    }

    /// For each part the values that its axis holds, so that parts of about one size have the same limits. Those that
    /// are as good as zero have the limits of the largest.
    fn limits(&self, parts: &[Part]) -> Vec<Vec<f64>> {
        let shown: Vec<Range<f64>> = parts.iter().map(|part| self.extent(&part.concat())).collect();
        let length = |range: &Range<f64>| range.end - range.start;
        let mut order: Vec<usize> = (0..parts.len()).filter(|&part| !self.is_nothing(&parts[part].concat())).collect();
        order.sort_by(|&a, &b| length(&shown[b]).total_cmp(&length(&shown[a])));
        let mut shared: Vec<(Range<f64>, Vec<usize>)> = Vec::new();
        for part in order {
            let least = &shown[part];
            let with = |range: &Range<f64>| range.start.min(least.start)..range.end.max(least.end);
            match shared.iter_mut().find(|(range, _)| FILLED * length(&with(range)) <= length(least)) {
                Some((range, members)) => (*range, _) = (with(range), members.push(part)),
                None => shared.push((least.clone(), vec![part])),
            }
        }
        let of = |part: usize| shared.iter().find(|(_, members)| members.contains(&part)).or(shared.first());
        let held = |part: usize| of(part).map_or(vec![], |(range, _)| vec![range.start, range.end]);
        (0..parts.len()).map(held).collect()
    }

    /// Whether none of these curves is a flat line in one panel, but those that are level.
    fn can_be_seen(&self, curves: &[usize]) -> bool {
        let shown = self.extent(curves);
        curves.iter().all(|&index| self.is_level(index) || FLAT * self.swing(index) >= shown.end - shown.start)
    }

    /// How far a curve swings; of a level one, how far it is from zero.
    fn size(&self, curve: usize) -> f64 {
        if self.is_level(curve) { peak(self.values(&[curve])) } else { self.swing(curve) }
    }

    fn is_level(&self, curve: usize) -> bool {
        self.swing(curve) < LEVEL * peak(self.values(&[curve]))
    }

    /// How far it is from the least value of a curve to the largest.
    fn swing(&self, curve: usize) -> f64 {
        let least = self.values(&[curve]).fold(f64::INFINITY, f64::min);
        let largest = self.values(&[curve]).fold(f64::NEG_INFINITY, f64::max);
        largest - least
    }

    /// Whether these curves are as good as zero beside the largest one of all.
    fn is_nothing(&self, curves: &[usize]) -> bool {
        let most = NOTHING * peak(self.curves.iter().flat_map(Curve::values).filter(|value| drawable(*value)));
        peak(self.values(curves)) <= most
    }

    /// The range of what of these curves can be drawn.
    fn extent(&self, curves: &[usize]) -> Range<f64> {
        extent(self.values(curves))
    }

    /// What of these curves can be drawn.
    fn values(&self, curves: &[usize]) -> impl Iterator<Item = f64> {
        curves.iter().flat_map(|&index| self.curves[index].values()).filter(|value| drawable(*value))
    }

    /// The first of the curves in the name of all of them. Those that are zero may be too many to be named.
    fn joined(&self, curves: &[usize]) -> Curve {
        let names = self.names(curves);
        let many = text::width(&names, text::TITLE) > 2 * HALF && self.is_nothing(curves);
        let name = if many { format!("{} others (0 throughout)", curves.len()) } else { names };
        Curve { name, ..self.curves[curves[0]].clone() }
    }

    fn names(&self, curves: &[usize]) -> String {
        let names: Vec<&str> = curves.iter().map(|&index| self.curves[index].name.as_str()).collect();
        enumeration(&names, curves)
    }

    fn part_title(&self, part: &Part) -> String {
        let mut all = part.concat();
        all.sort_unstable();
        let full = format!("{}: {}", self.title, self.names(&all));
        let ends = [all.first(), all.last()].map(|end| end.map_or("", |&index| self.curves[index].name.as_str()));
        match all.len() {
            3.. if text::title_width(&full) > HALF => format!("{}: {} … {}", self.title, ends[0], ends[1]),
            _ => full,
        }
    }
}

/// Runs of sizes, which descend, within a factor of [`FACTOR`] where `fits` says so, as it does of one alone: the fewest,
/// and of these those that are furthest apart.
fn runs(sizes: &[f64], fits: impl Fn(Range<usize>) -> bool) -> Vec<Range<usize>> {
    // Of the first 0, 1, 2, … sizes: how many runs, the logarithms of the gaps between them, where the last run starts.
    let mut best = vec![(0_usize, 0.0, 0)];
    for end in 1..=sizes.len() {
        let within = |start: &usize| start + 1 == end || sizes[*start] <= FACTOR * sizes[end - 1] && fits(*start..end);
        let from = |start: usize| {
            let gap = if start == 0 { 0.0 } else { (sizes[start - 1] / sizes[start]).ln() };
            (best[start].0 + 1, best[start].1 + gap, start)
        };
        let better = |a: &(usize, f64, usize), b: &(usize, f64, usize)| a.0.cmp(&b.0).then(b.1.total_cmp(&a.1));
        best.extend((0..end).filter(within).map(from).min_by(better));
    }
    let mut runs = Vec::new();
    let mut end = sizes.len();
    while end > 0 {
        runs.push(best[end].2..end);
        end = best[end].2;
    }
    runs.reverse();
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A panel of curves with these peaks, named a, b, …, that swing so that all are different.
    fn panel(peaks: &[f64]) -> Panel {
        let t: Vec<f64> = (0..40).map(f64::from).collect();
        (0..peaks.len()).fold(Panel::new("Torques", "torque", "N m"), |panel, k| {
            let values: Vec<f64> = t.iter().map(|t| peaks[k] * (0.1 * (k as f64 + 1.0) * t).cos()).collect();
            panel.line(&format!("j{k}"), k + 1, &t, &values)
        })
    }

    /// The names of the curves, by panels.
    fn names(panels: &[Panel]) -> Vec<String> {
        let names = |panel: &Panel| panel.curves.iter().map(|curve| curve.name.as_str()).collect::<Vec<_>>().join(" ");
        panels.iter().map(names).collect()
    }

    #[test]
    fn a_curve_that_would_be_a_flat_line_beside_another_gets_a_panel_of_its_own_size() {
        let panels = panel(&[106.0, 211.0, 36.0, 0.29, 0.38, 3.8e-5]).multiples(&[0; 6]);
        assert_eq!(names(&panels), ["j0 j1 j2", "j3 j4", "j5"]);
        let titles: Vec<_> = panels.iter().map(|panel| panel.title.as_str()).collect();
        assert_eq!(titles, ["Torques: j0 … j2", "Torques: j3, j4", "Torques: j5"]);
        let units: Vec<_> = panels.iter().map(|panel| panel.unit.as_str()).collect();
        assert_eq!(units, ["N m", "mN m", "µN m"]);
    }

    #[test]
    fn sizes_are_cut_where_their_gap_is_widest_into_as_few_groups_as_can_be() {
        assert_eq!(names(&panel(&[100.0, 11.0, 9.0, 8.0]).multiples(&[0; 4])), ["j0", "j1 j2 j3"]);
        assert_eq!(names(&panel(&[100.0, 90.0, 80.0, 12.0, 9.0]).multiples(&[0; 5])), ["j0 j1 j2", "j3 j4"]);
        assert_eq!(names(&panel(&[8.0, 100.0, 11.0, 9.0]).multiples(&[0; 4])), ["j0 j2 j3", "j1"]);
        // A level curve beside one that swings as far as its value, and one that swings about another value.
        let swing = |k: usize, value: f64, by: f64| {
            Panel::new("Angles", "angle", "rad").line(&format!("j{k}"), 0, &[0.0, 1.0], &[value, value + by])
        };
        let all = [swing(0, 50.0, 0.0), swing(1, -30.0, 60.0), swing(2, 0.0, 4.0), swing(3, 20.0, 2.5)];
        let curves = all.into_iter().flat_map(|panel| panel.curves).collect();
        let panels = Panel { curves, ..Panel::new("Angles", "angle", "rad") }.multiples(&[0; 4]);
        assert_eq!(names(&panels), ["j0 j1", "j2 j3"]);
        // One that swings about zero would be a flat line beside one that swings as much but is far from there.
        let all = [swing(0, -142.0, -16.0), swing(1, -2.0, 4.0), swing(2, -100.0, 20.0)];
        let curves = all.into_iter().flat_map(|panel| panel.curves).collect();
        let panels = Panel { curves, ..Panel::new("Angles", "angle", "rad") }.multiples(&[0; 3]);
        assert_eq!(names(&panels), ["j0 j2", "j1"]);
        // As in a chain whose links hang on each other: 400, 361, … 1.
        let squares: Vec<f64> = (1..=20).rev().map(|k| f64::from(k * k)).collect();
        let groups = panel(&squares).by_size((0..20).collect());
        assert_eq!(groups.len(), 3, "{groups:?}");
        for group in groups {
            let sizes = group.iter().map(|&index| squares[index]);
            assert!(sizes.clone().fold(0.0, f64::max) <= FACTOR * sizes.fold(f64::INFINITY, f64::min));
        }
    }

    #[test]
    fn zeros_lie_in_the_panel_of_the_largest_as_one_line() {
        let panels = panel(&[0.0, 5.0, 100.0, 0.0, 1e-12, 80.0]).multiples(&[0; 6]);
        assert_eq!(names(&panels), ["j0, j3, j4 j2 j5", "j1"]);
        let still = panel(&[0.0; 29]).multiples(&Vec::from_iter(0..29));
        assert_eq!(names(&still), ["j0 … j28"]);
        assert_eq!(still[0].title, "Torques");
        let name = |k: usize| format!("left_shoulder_joint_{k}");
        let mut robot = panel(&(0..20).map(|k| f64::from(k % 2)).collect::<Vec<_>>());
        robot.curves.iter_mut().enumerate().for_each(|(k, curve)| curve.name = name(k));
        assert_eq!(robot.multiples(&[0; 20])[0].curves[0].name, "10 others (0 throughout)");
        let none = Panel::new("Torques", "torque", "N m").multiples(&[]);
        assert_eq!(none.len(), 0);
    }

    #[test]
    fn a_panel_has_curves_of_one_group_and_panels_of_about_one_size_have_the_same_limits() {
        let groups = [0, 0, 1, 1, 2, 2, 2, 3, 3];
        let panels = panel(&[100.0, 80.0, 60.0, 90.0, 70.0, 1.0, 2.0, 0.0, 1e-10]).multiples(&groups);
        assert_eq!(names(&panels), ["j0 j1", "j2 j3", "j4", "j5 j6", "j7, j8"]);
        let limits: Vec<_> = panels.iter().map(|panel| panel.held.clone()).collect();
        assert!(limits[1..=2].iter().chain([&limits[4]]).all(|held| *held == limits[0]), "{limits:?}");
        assert!(limits[3] != limits[0] && limits[3].len() == 2, "{limits:?}");
        let colours: Vec<usize> = panels.iter().flat_map(|panel| &panel.curves).map(|curve| curve.colour).collect();
        assert_eq!(colours, [1, 2, 3, 4, 5, 6, 7, 8], "each keeps its own");
        // Of one size, but about values so far apart that they would be flat lines beside each other.
        let swing = |value: f64| vec![value - 1.0, value + 1.0];
        let far = Panel::new("Angles", "angle", "rad").line("a", 1, &[0.0, 1.0], &swing(0.0));
        let far = far.line("b", 2, &[0.0, 1.0], &swing(90.0)).line("c", 3, &[0.0, 1.0], &swing(91.0));
        let limits: Vec<_> = far.multiples(&[0, 1, 2]).into_iter().map(|panel| panel.held).collect();
        assert_eq!(limits, [swing(0.0), vec![89.0, 92.0], vec![89.0, 92.0]]);
    }

    #[test]
    fn a_title_without_room_for_its_curves_names_the_first_and_the_last() {
        let long = (0..8).fold(Panel::new("Torques", "torque", "N m"), |panel, k| {
            let values = [0.0, if k % 2 == 0 { 1.0 } else { 100.0 }];
            panel.line(&format!("left_shoulder_pitch_joint_{k}"), k, &[0.0, 1.0], &values)
        });
        let titles: Vec<String> = long.multiples(&[0; 8]).into_iter().map(|panel| panel.title).collect();
        let title = |ends: [usize; 2]| {
            let [first, last] = ends.map(|k| format!("left_shoulder_pitch_joint_{k}"));
            format!("Torques: {first} … {last}")
        };
        assert_eq!(titles, [title([0, 6]), title([1, 7])]);
    }

    #[test]
    fn charts_begin_rows_of_their_own_and_few_places_stay_empty() {
        let places = |counts: &[usize]| {
            let panels = |&count: &usize| panel(&vec![1.0; count]).multiples(&(0..count).collect::<Vec<_>>());
            let figure = Figure::of_charts(counts.iter().map(panels).collect());
            let gaps: Vec<bool> = figure.panels.iter().map(Panel::is_gap).collect();
            (figure.columns, gaps)
        };
        assert_eq!(places(&[1, 1, 1]), (1, vec![false; 3]));
        assert_eq!(places(&[1, 1, 2]), (1, vec![false; 4]));
        assert_eq!(places(&[4]), (2, vec![false; 4]));
        assert_eq!(places(&[3, 2]), (2, vec![false, false, false, true, false, false]));
    }
}
