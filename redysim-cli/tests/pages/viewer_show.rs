//! The page of `redysim show` in a browser: `viewer/check` runs this, and says what it needs.

use std::f64::consts::{PI, TAU};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::{BALLS, data, model, robot, scratch, succeed};
use redysim_model::{GenericMechanism, Model};
use redysim_runtime::{LinkKinematics, Mechanism};
use serde_json::{Value, json};

/// A model of this repository on its page, in a folder that stays, so that the screenshots can be looked at.
struct Shown {
    folder: PathBuf,
    mechanism: GenericMechanism,
    start: Vec<f64>,
    drags: Vec<Value>,
}

impl Shown {
    fn new(name: &str) -> Shown {
        let folder = scratch(&format!("viewer/show-{}", name.replace(['/', '.'], "-")));
        let path = model(name);
        Shown::of(folder, &path, Model::load(&path).unwrap().model)
    }

    fn of(folder: PathBuf, path: &str, model: Model) -> Shown {
        succeed(&folder, &["show", path, "-o", "show.html"]);
        let data = data(&fs::read_to_string(folder.join("show.html")).unwrap());
        let start =
            data["sliders"].as_array().unwrap().iter().map(|slider| slider["start"].as_f64().unwrap()).collect();
        Shown { folder, mechanism: GenericMechanism::new(model), start, drags: Vec::new() }
    }

    /// Drags the slider of a coordinate, after which coordinates are `q`, where it is known, and links are at `places`.
    fn drag(&mut self, coordinate: usize, value: f64, q: &[Option<f64>], places: Option<Value>, stops: Option<&str>) {
        self.drags.push(json!({ "coordinate": coordinate, "value": value, "q": q, "links": places, "stops": stops }));
    }

    /// Drags to a whole position: links are where the mechanism has them.
    fn drag_to(&mut self, coordinate: usize, value: f64, q: &[f64]) {
        let known: Vec<Option<f64>> = q.iter().copied().map(Some).collect();
        self.drag(coordinate, value, &known, Some(self.links(q)), None);
    }

    fn links(&self, q: &[f64]) -> Value {
        let states = self.mechanism.link_kinematics(&q.to_vec(), &vec![0.0; self.mechanism.nv()]);
        let links = self.mechanism.model().links.iter().zip(states);
        links.map(|(link, state)| json!({ "name": link.name, "origin": state.origin, "com": state.com })).collect()
    }

    /// Has `viewer/show.mjs` look at the page.
    fn look(self) {
        self.look_for("", &["links", "axes", "frames", "coms", "ellipsoids", "ground"]);
    }

    /// The same, with what it must note and the layers that it must have.
    fn look_for(self, notes: &str, layers: &[&str]) {
        let expected = json!({ "start": self.start, "drags": self.drags, "layers": layers, "notes": notes });
        fs::write(self.folder.join("expected.json"), expected.to_string()).unwrap();
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("viewer/show.mjs");
        let output = Command::new("node").arg(script).arg(&self.folder).output();
        let output = output.expect("node, which viewer/check looks for");
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        println!("{}", String::from_utf8_lossy(&output.stdout));
    }
}

/// The angle from -π to π: sliders of joints that turn around have no others.
fn within_a_turn(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// Links of 0.3 and 0.25 m in the plane: bars, with the centre of mass in the middle.
#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn sliders_move_two_links_as_sines_and_cosines_do() {
    let mut shown = Shown::new("two_link.toml");
    let places = |q1: f64, q2: f64| {
        let (elbow, fore) = ([0.3 * q1.cos(), 0.3 * q1.sin(), 0.0], q1 + q2);
        let centre = [elbow[0] + 0.125 * fore.cos(), elbow[1] + 0.125 * fore.sin(), 0.0];
        json!([
            { "name": "link1", "origin": [0.0, 0.0, 0.0], "com": [0.15 * q1.cos(), 0.15 * q1.sin(), 0.0] },
            { "name": "link2", "origin": elbow, "com": centre },
        ])
    };
    shown.drag(0, 0.7, &[Some(0.7), Some(0.0)], Some(places(0.7, 0.0)), None);
    shown.drag(1, -1.9, &[Some(0.7), Some(-1.9)], Some(places(0.7, -1.9)), None);
    shown.drag(0, -3.1, &[Some(-3.1), Some(-1.9)], Some(places(-3.1, -1.9)), None);
    shown.look();
}

/// A rail, a screw, revolute joints, a fixed link, and frames of interest.
#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn sliders_move_every_kind_of_joint_as_the_kinematics_does() {
    let mut shown = Shown::new("test/frames.toml");
    let mut q = vec![0.0; 5];
    for (coordinate, value) in [(0, 0.4), (1, -0.8), (2, 2.0), (3, 0.5), (4, -2.5), (0, -0.2)] {
        q[coordinate] = value;
        shown.drag_to(coordinate, value, &q);
    }
    shown.look();
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn sliders_move_joints_in_series_as_the_kinematics_does() {
    let mut shown = Shown::new("test/joints_in_series.toml");
    let mut q = vec![0.0; 16];
    for (coordinate, value) in (0..16).map(|coordinate| (coordinate, 0.3 - 0.07 * coordinate as f64)) {
        q[coordinate] = value;
        shown.drag_to(coordinate, value, &q);
    }
    shown.look();
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn sliders_move_a_robot_by_standard_parameters_as_the_kinematics_does() {
    let mut shown = Shown::new("test/ur5.toml");
    let mut q = vec![0.0; 6];
    for (coordinate, value) in [(1, -1.2), (2, 1.4), (4, -1.5), (5, 0.3)] {
        q[coordinate] = value;
        shown.drag_to(coordinate, value, &q);
    }
    shown.look();
}

/// Crank of 0.05 m, coupler of 0.1 m, rocker of 0.13 m and base of 0.15 m: the crank turns around; the rocker comes to
/// rest where crank and coupler are in line.
#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn a_four_bar_stays_closed_while_it_is_dragged_and_stops_where_it_cannot_be() {
    let mut shown = Shown::new("fourbar_gui.toml");
    let (crank, coupler, rocker, base) = (0.05, 0.1, 0.13, 0.15);
    let tip = |q: f64| [crank * q.cos(), crank * q.sin()];
    let side = |p: [f64; 2], q: f64| {
        // On which side of the line from the rocker's pivot to the crank's tip the rocker's tip is.
        let [x, y] = [p[0] - base, p[1]];
        x * rocker * q.sin() - y * rocker * q.cos()
    };
    let branch = side(tip(shown.start[0]), shown.start[1]).signum();
    let closed = |q: f64| {
        // The triangle of the rocker's pivot, the crank's tip and the rocker's tip.
        let p = tip(q);
        let [x, y] = [p[0] - base, p[1]];
        let distance = x.hypot(y);
        let cosine = (rocker * rocker + distance * distance - coupler * coupler) / (2.0 * rocker * distance);
        let rocks = y.atan2(x) + branch * cosine.acos();
        let joint = [base + rocker * rocks.cos(), rocker * rocks.sin()];
        let couples = (p[1] - joint[1]).atan2(p[0] - joint[0]) - rocks;
        [q, rocks, couples]
    };
    for value in [shown.start[0] + 0.3, 2.9, 0.4, -2.0, 1.0] {
        shown.drag_to(0, value, &closed(value).map(within_a_turn));
    }
    let at = |length: f64| ((length * length - base * base - rocker * rocker) / (2.0 * base * rocker)).acos();
    // On either side of the base: the rocker is where it is.
    let half = closed(1.0)[1].sin().signum();
    for (value, limit) in [(0.3 * half, at(crank + coupler)), (half * (PI - 0.1), at(coupler - crank))] {
        shown.drag(1, value, &[None, Some(half * limit), None], None, Some("rocker stops at"));
    }
    shown.drag(0, 0.5, &[Some(0.5), None, None], None, None);
    shown.look();
}

/// Crank and coupler of 1 m: where the coupler's tip meets the slider on -y, s = -2 sin(q).
#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn a_slider_crank_stays_closed_while_it_is_dragged() {
    let mut shown = Shown::new("slider_crank.toml");
    let at = |q: f64| [q, within_a_turn(PI - 2.0 * q), -2.0 * q.sin()];
    for (found, expected) in shown.start.iter().zip(at(shown.start[0])) {
        assert!((found - expected).abs() < 1e-12, "{:?} is on the branch of the closed form", shown.start);
    }
    for value in [-0.2, -1.0, -1.4] {
        shown.drag_to(0, value, &at(value));
    }
    for value in [1.9_f64, 0.3, 1.2] {
        shown.drag_to(2, value, &at(-(0.5 * value).asin()));
    }
    shown.look();
}

/// Spatial loops with revolute cuts: every drag leaves them closed.
#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn spatial_loops_stay_closed_while_they_are_dragged() {
    for (name, coordinates) in
        [("test/fourbar_spatial.toml", 1), ("test/bricard.toml", 2), ("test/three_cranks.toml", 1)]
    {
        let mut shown = Shown::new(name);
        for coordinate in 0..coordinates {
            for by in [0.05, 0.1, -0.05] {
                let value = shown.start[coordinate] + by;
                let mut known = vec![None; shown.start.len()];
                known[coordinate] = Some(value);
                shown.drag(coordinate, value, &known, None, None);
            }
        }
        shown.look();
    }
}

/// A model of this text, whose links weigh something.
fn of_text(name: &str, text: &str) -> Shown {
    let folder = scratch(&format!("viewer/show-{name}"));
    let text = text.replace("[[link]]", "[[link]]\nmass = 1\ninertia = { xx = 0.01, yy = 0.01, zz = 0.01 }");
    fs::write(folder.join("model.toml"), &text).unwrap();
    let model = Model::from_toml(text, "model.toml").unwrap_or_else(|faults| panic!("{faults}")).model;
    Shown::of(folder, "model.toml", model)
}

/// The four-bar above, cut in the middle of its coupler, whose halves keep their direction.
#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn a_weld_holds_points_and_directions_while_it_is_dragged() {
    let mut shown = of_text(
        "weld",
        "name = 'weld'\ngravity = [0, -9.81, 0]\n\
         [[link]]\nname = 'crank'\nparent = 'base'\njoint = 'revolute'\ndh = {}\n\
         [[link]]\nname = 'rocker'\nparent = 'base'\njoint = 'revolute'\ndh = { a = 0.15 }\n\
         [[link]]\nname = 'near'\nparent = 'crank'\njoint = 'revolute'\ndh = { a = 0.05 }\n\
         [[link]]\nname = 'far'\nparent = 'rocker'\njoint = 'revolute'\ndh = { a = 0.13 }\n\
         [[loop]]\nname = 'middle'\njoint = 'weld'\nlink_a = 'near'\npoint_a = [0.05, 0, 0]\nlink_b = 'far'\n\
         point_b = [-0.05, 0, 0]\n",
    );
    let rocks = |q: f64, branch: f64| {
        let [x, y] = [0.05 * q.cos() - 0.15, 0.05 * q.sin()];
        let cosine = (0.13 * 0.13 + x * x + y * y - 0.1 * 0.1) / (2.0 * 0.13 * x.hypot(y));
        let rocker = y.atan2(x) + branch * cosine.acos();
        let [to_x, to_y] = [0.13 * rocker.cos() - x, 0.13 * rocker.sin() - y];
        let direction = to_y.atan2(to_x);
        [q, rocker, direction - q, direction - rocker].map(within_a_turn)
    };
    let apart = |branch: f64| within_a_turn(rocks(shown.start[0], branch)[1] - shown.start[1]).abs();
    let branch = if apart(1.0) < apart(-1.0) { 1.0 } else { -1.0 };
    for value in [shown.start[0] + 0.2, 2.0, -2.5] {
        shown.drag_to(0, value, &rocks(value, branch));
    }
    shown.look();
}

/// A crank of 0.1 m about z and a rocker of 0.25 m about y, 0.3 m apart, with a coupler of 0.3 m between their tips.
#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn a_ball_holds_a_point_while_it_is_dragged() {
    let mut shown = of_text(
        "ball",
        "name = 'ball'\ngravity = [0, 0, -9.81]\n\
         [[link]]\nname = 'crank'\nparent = 'base'\njoint = 'revolute'\naxis = [0, 0, 1]\n\
         [[link]]\nname = 'rocker'\nparent = 'base'\njoint = 'revolute'\naxis = [0, 1, 0]\n\
         origin = { xyz = [0.3, 0, 0] }\n\
         [[link]]\nname = 'fork'\nparent = 'crank'\njoint = 'revolute'\naxis = [0, 0, 1]\n\
         origin = { xyz = [0.1, 0, 0] }\n\
         [[link]]\nname = 'coupler'\nparent = 'fork'\njoint = 'revolute'\naxis = [0, 1, 0]\n\
         [[loop]]\nname = 'ball'\njoint = 'spherical'\nlink_a = 'coupler'\npoint_a = [0.3, 0, 0]\nlink_b = 'rocker'\n\
         point_b = [0.25, 0, 0]\n",
    );
    let side = shown.start[1].signum();
    let rocks = |q: f64| {
        let across = 0.1 * q.cos() - 0.3;
        let square = across * across + 0.25 * 0.25 + (0.1 * q.sin()).powi(2) - 0.3 * 0.3;
        side * (square / (2.0 * 0.25 * across)).acos()
    };
    for value in [shown.start[0] + 0.1, 1.0, -2.0, 3.0] {
        shown.drag(0, value, &[Some(value), Some(rocks(value)), None, None], None, None);
    }
    shown.look();
}

/// A box on the ground, one that turns, and one that slides on it; and a file that is not a mesh.
#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn meshes_move_with_their_links() {
    let folder = scratch("viewer/show-meshes");
    let urdf = robot(&folder);
    let text = fs::read_to_string(&urdf).unwrap();
    let broken = "<visual><geometry><mesh filename=\"broken.stl\"/></geometry></visual></link>\n<link name=\"arm\">";
    fs::write(&urdf, text.replace("</link>\n<link name=\"arm\">", broken)).unwrap();
    fs::write(urdf.with_file_name("broken.stl"), "no triangles here").unwrap();
    let path = urdf.to_str().unwrap().to_owned();
    let imported = succeed(&folder, &["import", &path]);
    let mut shown = Shown::of(folder, &path, Model::from_toml(imported, "robot.toml").unwrap().model);
    let boxed = |body: usize, min: [f64; 3], max: [f64; 3]| json!({ "body": body, "min": min, "max": max });
    let base = || boxed(0, [-0.1, -0.1, 0.0], [0.1, 0.1, 0.1]);
    let mut drag = |coordinate: usize, value: f64, q: [f64; 2], arm: Value, tool: Value| {
        shown.drag_to(coordinate, value, &q);
        shown.drags.last_mut().unwrap()["meshes"] = json!([base(), arm, tool]);
    };
    let along_x = boxed(1, [0.0, -0.03, 0.07], [0.4, 0.03, 0.15]);
    drag(1, 0.2, [0.0, 0.2], along_x, boxed(2, [0.63, 0.0, 0.08], [0.67, 0.1, 0.12]));
    // By a quarter turn, whose cosine is not quite zero.
    let along_y = boxed(1, [-0.03, 0.0, 0.07], [0.03, 0.4, 0.15]);
    drag(0, 0.5 * PI, [0.5 * PI, 0.2], along_y, boxed(2, [-0.1, 0.63, 0.08], [0.0, 0.67, 0.12]));
    shown.look_for("the mesh broken.stl cannot be read", &["meshes", "links", "frames"]);
}

/// The coordinates of a position and of roll, pitch and yaw.
fn pose(x: &[f64], [roll, pitch, yaw]: [f64; 3]) -> Vec<f64> {
    let about = |axis: usize, angle: f64| -> [f64; 4] {
        let mut q = [0.0, 0.0, 0.0, (0.5 * angle).cos()];
        q[axis] = (0.5 * angle).sin();
        q
    };
    let product = |p: [f64; 4], q: [f64; 4]| {
        [
            p[3] * q[0] + p[0] * q[3] + p[1] * q[2] - p[2] * q[1],
            p[3] * q[1] + p[1] * q[3] + p[2] * q[0] - p[0] * q[2],
            p[3] * q[2] + p[2] * q[3] + p[0] * q[1] - p[1] * q[0],
            p[3] * q[3] - p[0] * q[0] - p[1] * q[1] - p[2] * q[2],
        ]
    };
    let turned = product(about(2, yaw), product(about(1, pitch), about(0, roll)));
    x.iter().chain(&turned).copied().collect()
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn sliders_move_a_free_base_by_its_position_and_by_roll_pitch_and_yaw() {
    let mut shown = Shown::new("kr5_floating.toml");
    let mut values = [0.0; 12];
    for (coordinate, value) in [(0, 0.4), (2, -0.3), (3, 0.9), (5, -2.0), (4, 0.6), (7, 1.1)] {
        values[coordinate] = value;
        let base = pose(&values[..3], [values[3], values[4], values[5]]);
        let q: Vec<f64> = base.iter().chain(&values[6..]).copied().collect();
        let known: Vec<Option<f64>> = values.iter().copied().map(Some).collect();
        shown.drag(coordinate, value, &known, Some(shown.links(&q)), None);
    }
    shown.look();
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn the_balls_of_a_spatial_four_bar_follow_its_crank() {
    let folder = scratch("viewer/show-balls");
    let path = folder.join("balls.toml");
    fs::write(&path, BALLS).unwrap();
    let path = path.to_str().unwrap().to_owned();
    let model = Model::load(&path).unwrap().model;
    let mut shown = Shown::of(folder, &path, model);
    let mut known = [None; 5];
    for value in [0.8, 2.0, -2.5] {
        known[0] = Some(value);
        shown.drag(0, value, &known, None, None);
    }
    shown.look();
}
