//! What the pictures of `redysim plot` look like: texts, axes and curves in their places.

use redysim_runtime::Real;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::common::{results, root, scratch, succeed, swing, turn};
use resvg::usvg::fontdb::Database;
use resvg::usvg::{Group, Node, Options, Rect, Tree};

/// The SVG pictures of a run.
fn pictures(run: &Path) -> Vec<(PathBuf, String)> {
    succeed(run, &["plot", ".", "--force"]);
    let paths = fs::read_dir(run).unwrap().map(|entry| entry.unwrap().path());
    let pictures = paths.filter(|path| path.extension().is_some_and(|extension| extension == "svg"));
    pictures.map(|path| (path.clone(), fs::read_to_string(path).unwrap())).collect()
}

/// The texts of a picture, and the boxes around their letters, in the font of the PNG.
fn texts(svg: &str) -> Vec<(String, Rect)> {
    let mut fonts = Database::new();
    fonts.load_font_data(fs::read(root().join("redysim-figures/fonts/DejaVuSans.ttf")).unwrap());
    fonts.set_sans_serif_family("DejaVu Sans");
    let options = Options { fontdb: Arc::new(fonts), ..Options::default() };
    let mut texts = Vec::new();
    collect(Tree::from_str(svg, &options).unwrap().root(), &mut texts);
    texts
}

fn collect(group: &Group, texts: &mut Vec<(String, Rect)>) {
    for node in group.children() {
        match node {
            Node::Group(group) => collect(group, texts),
            Node::Text(text) => {
                let words = text.chunks().iter().map(|chunk| chunk.text()).collect();
                texts.push((words, text.flattened().abs_bounding_box()));
            }
            _ => {}
        }
    }
}

/// No two texts of a picture overlap, and none is cut.
fn texts_have_their_room(path: &Path, svg: &str) {
    let texts = texts(svg);
    assert!(texts.len() > 5, "{}: {texts:?}", path.display());
    let number = |name: &str| -> f32 {
        let (_, rest) = svg.split_once(&format!(" {name}=\"")).unwrap();
        rest.split_once('"').unwrap().0.parse().unwrap()
    };
    for (index, (text, place)) in texts.iter().enumerate() {
        let (right, bottom) = (number("width"), number("height"));
        let within = place.left() >= 0.0 && place.top() >= 0.0 && place.right() <= right && place.bottom() <= bottom;
        assert!(within, "{}: {text} is cut", path.display());
        for (other, at) in &texts[..index] {
            let apart = place.left() >= at.right()
                || at.left() >= place.right()
                || place.top() >= at.bottom()
                || at.top() >= place.bottom();
            assert!(apart, "{}: {text} overlaps {other}", path.display());
        }
    }
}

/// The corners of the box around each of the lines of a colour: left, top, right, bottom.
fn lines(svg: &str, colour: &str) -> Vec<[f64; 4]> {
    let lines = svg.lines().filter(|line| line.starts_with("<polyline") && line.contains(colour));
    let corners = |line: &str| {
        let (_, points) = line.split_once("points=\"").unwrap();
        let points = points.split_once('"').unwrap().0.split_whitespace();
        let points = points.map(|point| point.split_once(',').unwrap());
        points.fold([f64::INFINITY, f64::INFINITY, 0.0, 0.0], |[left, top, right, bottom], (x, y)| {
            let (x, y): (f64, f64) = (x.parse().unwrap(), y.parse().unwrap());
            [left.min(x), top.min(y), right.max(x), bottom.max(y)]
        })
    };
    lines.map(corners).collect()
}

const INK: &str = "#282828";
const PALETTE: [&str; 6] = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"];
/// More colours that curves may have.
const FURTHER: [&str; 4] = ["#787878", "#78461E", "#969600", "#000000"];

/// The coordinate systems: the boxes between their axes. Ticks are shorter than these.
fn panels(svg: &str) -> Vec<[f64; 4]> {
    let axes = lines(svg, INK);
    let across = axes.iter().filter(|[left, top, right, bottom]| right - left > 200.0 && bottom - top < 10.0);
    let panel = |&[left, y, right, _]: &[f64; 4]| {
        let up =
            |axis: &&[f64; 4]| axis[3] - axis[1] > 200.0 && (axis[0] - left).abs() < 2.0 && (axis[3] - y).abs() < 10.0;
        let top = axes.iter().find(up).unwrap_or_else(|| panic!("an axis at {left}, {y} alone"))[1];
        [left, top, right, y]
    };
    across.map(panel).collect()
}

/// Every time axis ends where the curves do.
fn axes_end_with_the_curves(path: &Path, svg: &str) {
    let panels = panels(svg);
    assert!(!panels.is_empty(), "{}", path.display());
    for [left, top, right, bottom] in panels {
        let curves = PALETTE.iter().chain(&FURTHER).flat_map(|colour| lines(svg, colour));
        let within = |curve: &[f64; 4]| {
            curve[0] >= left - 2.0 && curve[2] <= right + 2.0 && curve[1] >= top - 2.0 && curve[3] <= bottom + 2.0
        };
        let within: Vec<_> = curves.filter(within).collect();
        assert!(!within.is_empty(), "{}: an empty panel", path.display());
        for curve in within {
            let ends = (curve[0] - left).abs() < 2.0 && (curve[2] - right).abs() < 2.0;
            assert!(ends, "{}: from {left} to {right} there is {curve:?}", path.display());
        }
    }
}

fn look_right(run: &Path) {
    for (path, svg) in pictures(run) {
        texts_have_their_room(&path, &svg);
        axes_end_with_the_curves(&path, &svg);
    }
}

/// A run whose time and values have this many digits, over `count` joints with names as robots have them.
fn joints(folder: &Path, count: usize) {
    let names: Vec<String> = (0..count).map(|joint| format!("left_shoulder_pitch_joint_{joint}")).collect();
    let table = |symbol: &str, unit: &str, value: &dyn Fn(usize, f64) -> f64| {
        let head: String = names.iter().map(|name| format!(",{symbol} {name} [{unit}]")).collect();
        let rows = (0..=40).map(|k| {
            let t = 12345.0 + 0.0171 * f64::from(k);
            let values: String = (0..count).map(|joint| format!(",{}", value(joint, t - 12345.0))).collect();
            format!("{t}{values}\n")
        });
        format!("t [s]{head}\n{}", rows.collect::<String>())
    };
    let wave = |joint: usize, t: f64| (10.0 * t + joint as f64).sin();
    fs::write(folder.join("statevar.csv"), table("q", "rad", &|joint, t| 12345.0 + 1e-3 * wave(joint, t))).unwrap();
    let sizes = [1e5, 12345.0, 200.0, 1.0, 1e-5, 1e-15];
    fs::write(folder.join("tor.csv"), table("tau", "N m", &|joint, t| sizes[joint % 6] * wave(joint, t))).unwrap();
}

#[test]
fn texts_never_overlap_and_time_ends_with_the_curves_for_29_joints_and_numbers_of_five_digits() {
    let folder = scratch("pictures-29");
    joints(&folder, 29);
    look_right(&folder);
}

#[test]
fn texts_never_overlap_and_time_ends_with_the_curves_for_the_kr5() {
    look_right(&swing(&scratch("pictures-kr5"), "kr5.toml", 6, 0.68, 40));
}

#[test]
fn texts_never_overlap_and_time_ends_with_the_curves_for_the_four_bar() {
    look_right(&turn(&scratch("pictures-fourbar"), 30));
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn texts_never_overlap_and_time_ends_with_the_curves_for_a_chain_of_twenty() {
    let fall = format!("initial = {{ q = {:?} }}\nforward = {{ end = 0.13, step = 0.01 }}\n", [0; 20]);
    look_right(&results(&scratch("pictures-chain"), "forward", "chain_20.toml", &fall));
}

#[test]
fn every_torque_of_the_kr5_is_seen_beside_those_that_are_larger() {
    let run = swing(&scratch("pictures-wrist"), "kr5.toml", 6, 1.0, 40);
    succeed(&run, &["plot", "."]);
    let svg = fs::read_to_string(run.join("torques.svg")).unwrap();
    let height = |[_, top, _, bottom]: [f64; 4]| bottom - top;
    let panel = height(panels(&svg)[0]);
    for colour in PALETTE {
        // Samples in the legend have no height.
        let tallest = lines(&svg, colour).into_iter().map(height).fold(0.0, Real::maximum);
        assert!(tallest > 0.1 * panel, "{colour}: {tallest} of {panel}");
    }
}

/// The legends of the panels: in each the names, and how the sample beside them is drawn.
fn legends(svg: &str) -> Vec<Vec<(String, String)>> {
    let panels = panels(svg);
    let colours = [PALETTE.as_slice(), &FURTHER].concat();
    let mut legends = vec![Vec::new(); panels.len()];
    for (text, place) in texts(svg) {
        // The picture is drawn four times as large as it is shown.
        let [left, top, bottom] = [place.left(), place.top(), place.bottom()].map(|length| 4.0 * f64::from(length));
        let beside = |[from, y, to, end]: &[f64; 4]| {
            from + 140.0 > left && *to < left && y == end && top - 10.0 < *y && *y < bottom + 10.0
        };
        let pieces = |colour: &str| lines(svg, colour).iter().filter(|line| beside(line)).count();
        let styles = colours.iter().map(|colour| (colour, pieces(colour))).filter(|(_, pieces)| *pieces > 0);
        let style: String = styles.map(|(colour, pieces)| format!("{colour} in {pieces}")).collect();
        let below =
            panels.iter().enumerate().filter(|(_, [from, y, to, _])| (*from..*to).contains(&left) && *y > bottom);
        if let (false, Some((panel, _))) = (style.is_empty(), below.min_by(|a, b| a.1[1].total_cmp(&b.1[1]))) {
            legends[panel].push((text, style));
        }
    }
    legends
}

/// Every panel of joints has those of one branch, in colours of which none comes twice, and a joint has one colour in all
/// panels. Returns the joints that have one of their own.
fn branches_stand_apart(run: &Path, branch: impl Fn(&str) -> String) -> BTreeSet<String> {
    let mut styles: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let pictures = pictures(run);
    for (path, svg) in pictures.iter().filter(|(path, _)| !path.ends_with("energy.svg")) {
        for legend in legends(svg) {
            let branches: BTreeSet<String> = legend
                .iter()
                .flat_map(|(names, _)| names.split(", "))
                .flat_map(|names| names.split(" … "))
                .map(&branch)
                .collect();
            assert_eq!(branches.len(), 1, "{}: {legend:?}", path.display());
            let different: BTreeSet<&String> = legend.iter().map(|(_, style)| style).collect();
            assert_eq!(different.len(), legend.len(), "{}: {legend:?}", path.display());
            for (names, style) in legend {
                let first = names.split([',', ' ']).next().unwrap();
                // The components of a joint in space are coordinates here and velocities there.
                if !first.contains('.') {
                    styles.entry(first.to_owned()).or_default().insert(style);
                }
            }
        }
    }
    styles.iter().for_each(|(joint, styles)| assert_eq!(styles.len(), 1, "{joint}: {styles:?}"));
    styles.into_keys().collect()
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn each_branch_of_a_humanoid_has_panels_of_its_own_and_a_joint_one_colour_in_all_pictures() {
    let run = swing(&scratch("pictures-humanoid"), "peers/humanoid30.toml", 30, 1.0, 40);
    let ends = [6, 12, 14, 21, 28, 30];
    let branch = |joint: &str| {
        let number: usize = joint.strip_prefix("link").unwrap().parse().unwrap();
        ends.iter().position(|end| number <= *end).unwrap().to_string()
    };
    assert_eq!(branches_stand_apart(&run, branch).len(), 30);
    look_right(&run);
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn each_leg_of_a_quadruped_has_panels_of_its_own_and_a_base_that_nothing_drives_has_none_of_forces() {
    let legs = ["rear_right", "rear_left", "front_right", "front_left"];
    let joints: Vec<String> =
        legs.iter().flat_map(|leg| ["hip", "thigh", "knee"].map(|joint| format!("{leg}_{joint}"))).collect();
    let to: Vec<f64> = (0..12).map(|joint| 0.2 + 0.1 * f64::from(joint)).collect();
    let lift = format!(
        "trajectory = {{ joints = {joints:?}, from = {:?}, to = {to:?}, duration = 0.2 }}\n\
         [forward]\nend = 0.2\nstep = 0.01\ntorque = {{ law = 'computed-torque', kp = 400.0, kd = 40.0 }}\n",
        [0; 12]
    );
    let run = results(&scratch("pictures-quadruped"), "forward", "quadruped.toml", &lift);
    let branch = |joint: &str| legs.iter().find(|leg| joint.starts_with(*leg)).unwrap_or(&"base").to_string();
    let own: Vec<String> = branches_stand_apart(&run, branch).into_iter().collect();
    let mut all = joints;
    all.sort();
    assert_eq!(own, all);
    let torques = fs::read_to_string(run.join("torques.svg")).unwrap();
    assert!(!torques.contains("base.") && !torques.contains("Joint forces"), "{torques}");
    look_right(&run);
}
