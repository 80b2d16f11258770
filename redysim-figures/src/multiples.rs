//! Curves that are too many or too different in size for one coordinate system, in several.

use crate::axis::{drawable, extent};
use crate::figure::{Curve, Figure, Panel, coincident, enumeration};
use crate::plot::{COLOURS, HALF};
use crate::{peak, text};

/// Curves that can be followed in one panel.
const MOST: usize = 6;
/// Curves whose sizes differ by more than this do not share a panel: the smaller one would be a flat line.
const FACTOR: f64 = 10.0;
/// A curve that swings by no more than this share of its peak is level.
const LEVEL: f64 = 0.1;
/// A peak of this share of the largest one is as good as zero.
const NOTHING: f64 = 1e-9;
/// Curves that differ by no more than this share of what is shown look the same.
const SIGHT: f64 = 2e-3;

impl Figure {
    /// Charts below each other, each of one or several panels: two of these beside each other if they are many. Colours
    /// are those of the curves, or, if the palette has not as many, different ones in each panel. One legend serves all
    /// panels if they show the same curves.
    pub fn of_charts(mut charts: Vec<Vec<Panel>>) -> Figure {
        let count: usize = charts.iter().map(Vec::len).sum();
        let rows_of_two: usize = charts.iter().map(|panels| panels.len().div_ceil(2)).sum();
        // Few places stay empty.
        let columns = if count > 3 && 3 * rows_of_two <= 2 * count { 2 } else { 1 };
        if charts.iter().flatten().flat_map(|panel| &panel.curves).any(|curve| curve.colour > COLOURS) {
            for panel in charts.iter_mut().flatten() {
                panel.curves.iter_mut().zip(1..).for_each(|(curve, number)| curve.colour = number);
            }
        }
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

impl Panel {
    /// The panel's curves in as many panels as they need, in order: six at most in each, whose sizes are within a
    /// factor of ten, in the fewest groups for which this is so, and of these in those that are furthest apart. Panels
    /// of one group have the same limits. Curves that coincide in the picture become one curve with all their names. The
    /// title of a panel lists its curves, or where that is too long, the number of the panel.
    pub fn multiples(self) -> Vec<Panel> {
        let parts: Vec<(Vec<Vec<usize>>, Vec<f64>)> =
            self.groups().iter().flat_map(|group| self.parts(group)).collect();
        let panel = |(number, (curves, held)): (usize, &(Vec<Vec<usize>>, Vec<f64>))| Panel {
            title: if parts.len() == 1 { self.title.clone() } else { self.part_title(curves, number, parts.len()) },
            curves: curves.iter().map(|alike| self.joined(alike)).collect(),
            held: held.clone(),
            quantity: self.quantity.clone(),
            unit: self.unit.clone(),
            across: self.across.clone(),
            logarithmic: self.logarithmic,
        };
        (1..).zip(&parts).map(panel).map(Panel::prefixed).collect()
    }

    /// The numbers of the curves whose sizes are within a factor of [`FACTOR`]. What is as good as zero lies on the
    /// axis, be that what it may: it joins the largest.
    fn groups(&self) -> Vec<Vec<usize>> {
        let most = self.nothing();
        let (nothing, mut order): (Vec<usize>, Vec<usize>) =
            (0..self.curves.len()).partition(|&index| peak(self.values(&[index])) <= most);
        let sizes: Vec<f64> = (0..self.curves.len()).map(|index| self.size(index)).collect();
        order.sort_by(|a, b| sizes[*b].total_cmp(&sizes[*a]));
        let descending: Vec<f64> = order.iter().map(|&index| sizes[index]).collect();
        let mut groups: Vec<Vec<usize>> = runs(&descending).into_iter().map(|run| order[run].to_vec()).collect();
        match groups.first_mut() {
            Some(largest) => largest.extend(nothing),
            None if nothing.is_empty() => {}
            None => groups.push(nothing),
        }
        groups.iter_mut().for_each(|group| group.sort_unstable());
        groups.sort();
        groups
    }

    /// The curves of a group, those that look the same together, for panels one after the other; and the values that
    /// each of their axes holds.
    fn parts(&self, group: &[usize]) -> Vec<(Vec<Vec<usize>>, Vec<f64>)> {
        let shown = extent(self.values(group));
        let held = if peak(self.values(group)) > 0.0 { vec![shown.start, shown.end] } else { vec![] };
        let columns: Vec<Vec<f64>> = group.iter().map(|&index| self.curves[index].values().collect()).collect();
        let alike = coincident(&columns, |_| SIGHT * (shown.end - shown.start));
        let alike: Vec<Vec<usize>> =
            alike.iter().map(|members| members.iter().map(|&member| group[member]).collect()).collect();
        let panels = alike.len().div_ceil(MOST);
        alike.chunks(alike.len().div_ceil(panels)).map(|chunk| (chunk.to_vec(), held.clone())).collect()
    }

    /// How far a curve swings; of a level one, how far it is from zero.
    fn size(&self, curve: usize) -> f64 {
        let least = self.values(&[curve]).fold(f64::INFINITY, f64::min);
        let largest = self.values(&[curve]).fold(f64::NEG_INFINITY, f64::max);
        let (swing, peak) = (largest - least, peak([least, largest]));
        if swing < LEVEL * peak { peak } else { swing }
    }

    /// The peak of what is as good as zero beside the largest curve.
    fn nothing(&self) -> f64 {
        NOTHING * peak(self.curves.iter().flat_map(Curve::values).filter(|value| drawable(*value)))
    }

    /// What of these curves can be drawn.
    fn values(&self, curves: &[usize]) -> impl Iterator<Item = f64> {
        curves.iter().flat_map(|&index| self.curves[index].values()).filter(|value| drawable(*value))
    }

    /// The first of the curves in the name of all of them. Those that are zero may be too many to be named.
    fn joined(&self, curves: &[usize]) -> Curve {
        let names = self.names(curves);
        let many = text::width(&names, text::TITLE) > 2 * HALF && peak(self.values(curves)) <= self.nothing();
        let name = if many { format!("{} others (0 throughout)", curves.len()) } else { names };
        Curve { name, ..self.curves[curves[0]].clone() }
    }

    fn names(&self, curves: &[usize]) -> String {
        let names: Vec<&str> = curves.iter().map(|&index| self.curves[index].name.as_str()).collect();
        enumeration(&names, curves)
    }

    fn part_title(&self, curves: &[Vec<usize>], number: usize, count: usize) -> String {
        let mut all = curves.concat();
        all.sort_unstable();
        let full = format!("{}: {}", self.title, self.names(&all));
        if text::title_width(&full) <= HALF { full } else { format!("{}, {number} of {count}", self.title) }
    }
}

/// Runs of sizes, which descend, within a factor of [`FACTOR`]: the fewest, and of these those that are furthest apart.
fn runs(sizes: &[f64]) -> Vec<std::ops::Range<usize>> {
    // Of the first 0, 1, 2, … sizes: how many runs, the logarithms of the gaps between them, where the last run starts.
    let mut best = vec![(0_usize, 0.0, 0)];
    for end in 1..=sizes.len() {
        let within = |start: &usize| sizes[*start] <= FACTOR * sizes[end - 1];
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
        let panels = panel(&[106.0, 211.0, 36.0, 0.29, 0.38, 3.8e-5]).multiples();
        assert_eq!(names(&panels), ["j0 j1 j2", "j3 j4", "j5"]);
        let titles: Vec<_> = panels.iter().map(|panel| panel.title.as_str()).collect();
        assert_eq!(titles, ["Torques: j0 … j2", "Torques: j3, j4", "Torques: j5"]);
        let units: Vec<_> = panels.iter().map(|panel| panel.unit.as_str()).collect();
        assert_eq!(units, ["N m", "mN m", "µN m"]);
    }

    #[test]
    fn sizes_are_cut_where_their_gap_is_widest_into_as_few_groups_as_can_be() {
        assert_eq!(names(&panel(&[100.0, 11.0, 9.0, 8.0]).multiples()), ["j0", "j1 j2 j3"]);
        assert_eq!(names(&panel(&[100.0, 90.0, 80.0, 12.0, 9.0]).multiples()), ["j0 j1 j2", "j3 j4"]);
        assert_eq!(names(&panel(&[8.0, 100.0, 11.0, 9.0]).multiples()), ["j0 j2 j3", "j1"]);
        // A level curve beside one that swings as far as its value, and one that swings about another value.
        let swing = |k: usize, value: f64, by: f64| {
            Panel::new("Angles", "angle", "rad").line(&format!("j{k}"), 0, &[0.0, 1.0], &[value, value + by])
        };
        let all = [swing(0, 50.0, 0.0), swing(1, -30.0, 60.0), swing(2, 0.0, 4.0), swing(3, 20.0, 2.5)];
        let curves = all.into_iter().flat_map(|panel| panel.curves).collect();
        let panels = Panel { curves, ..Panel::new("Angles", "angle", "rad") }.multiples();
        assert_eq!(names(&panels), ["j0 j1", "j2 j3"]);
        // As in a chain whose links hang on each other: 400, 361, … 1.
        let squares: Vec<f64> = (1..=20).rev().map(|k| f64::from(k * k)).collect();
        let groups = panel(&squares).groups();
        assert_eq!(groups.len(), 3, "{groups:?}");
        for group in groups {
            let sizes = group.iter().map(|&index| squares[index]);
            assert!(sizes.clone().fold(0.0, f64::max) <= FACTOR * sizes.fold(f64::INFINITY, f64::min));
        }
    }

    #[test]
    fn zeros_lie_in_the_panel_of_the_largest_as_one_line() {
        let panels = panel(&[0.0, 5.0, 100.0, 0.0, 1e-12, 80.0]).multiples();
        assert_eq!(names(&panels), ["j0, j3, j4 j2 j5", "j1"]);
        let still = panel(&[0.0; 29]).multiples();
        assert_eq!(names(&still), ["j0 … j28"]);
        assert_eq!(still[0].title, "Torques");
        let name = |k: usize| format!("left_shoulder_joint_{k}");
        let mut robot = panel(&(0..20).map(|k| f64::from(k % 2)).collect::<Vec<_>>());
        robot.curves.iter_mut().enumerate().for_each(|(k, curve)| curve.name = name(k));
        assert_eq!(robot.multiples()[0].curves[0].name, "10 others (0 throughout)");
        let none = Panel::new("Torques", "torque", "N m").multiples();
        assert_eq!(none.len(), 0);
    }

    #[test]
    fn many_curves_of_one_size_are_spread_over_panels_with_the_same_limits() {
        let panels = panel(&(0..29).map(|k| 1.0 + 0.1 * f64::from(k)).collect::<Vec<_>>()).multiples();
        let sizes: Vec<usize> = panels.iter().map(|panel| panel.curves.len()).collect();
        assert_eq!(sizes, [6, 6, 6, 6, 5]);
        assert!(panels.windows(2).all(|pair| pair[0].held == pair[1].held && !pair[0].held.is_empty()));
        assert_eq!(panels[4].title, "Torques: j24 … j28");
    }

    #[test]
    fn every_panel_has_as_many_colours_as_curves_and_a_curve_keeps_its_own_where_they_suffice() {
        for count in [1, 6, 9, 10, 29] {
            let figure = Figure::of_charts(vec![panel(&vec![1.0; count]).multiples(), panel(&[1.0; 3]).multiples()]);
            for panel in &figure.panels {
                let mut colours: Vec<usize> = panel.curves.iter().map(|curve| curve.colour).collect();
                assert!(colours.iter().all(|&colour| (1..=COLOURS).contains(&colour)), "{count}: {colours:?}");
                let own = panel.curves.iter().all(|curve| curve.name == format!("j{}", curve.colour - 1));
                assert!(own || count > COLOURS, "{count}: {colours:?}");
                colours.dedup();
                assert_eq!(colours.len(), panel.curves.len());
            }
        }
    }

    #[test]
    fn a_title_without_room_for_its_curves_counts_the_panels() {
        let long = (0..8).fold(Panel::new("Torques", "torque", "N m"), |panel, k| {
            panel.line(&format!("left_shoulder_pitch_joint_{k}"), k, &[0.0, 1.0], &[1.0, (k + 2) as f64])
        });
        let titles: Vec<String> = long.multiples().into_iter().map(|panel| panel.title).collect();
        assert_eq!(titles, ["Torques, 1 of 2", "Torques, 2 of 2"]);
    }

    #[test]
    fn charts_begin_rows_of_their_own_and_few_places_stay_empty() {
        let places = |counts: &[usize]| {
            let panels = |&count: &usize| panel(&vec![1.0; 6 * count]).multiples();
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
