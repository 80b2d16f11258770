//! `redysim animate`: the page, and what is reported where none can be made. What the page does in a browser is tested
//! in `viewer.rs`.

use std::fs;
use std::path::Path;

use crate::common::{Table, call, data, fail, model, results, scratch, slide, succeed, swing, turn};
use serde_json::Value;

/// Makes the page of the results in `folder`.
fn page(folder: &Path) -> String {
    succeed(folder, &["animate", ".", "--force"]);
    fs::read_to_string(folder.join("animation.html")).unwrap()
}

fn numbers(list: &Value) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|value| value.as_f64().unwrap()).collect()
}

#[test]
fn the_page_asks_for_nothing_from_elsewhere() {
    let folder = scratch("animate-alone");
    let page = page(&swing(&folder, "kr5.toml", 6, 1.0, 50));
    for outside in ["src=\"", "<link rel=\"stylesheet", "@import", "url(http"] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert!(page.contains("default-src 'none'"));
}

#[test]
fn every_instant_of_the_run_is_in_the_page_with_its_coordinates_and_rates() {
    let folder = scratch("animate-instants");
    let run = swing(&folder, "kr5.toml", 6, 1.0, 50);
    let data = data(&page(&run));
    let table = Table::csv(&run.join("statevar.csv"));
    let same = |shown: &Value, header: &str| {
        let (shown, recorded) = (numbers(shown), table.column(header));
        assert_eq!(shown.len(), recorded.len(), "{header}");
        // The test's own reader rounds.
        assert!(shown.iter().zip(&recorded).all(|(a, b)| (a - b).abs() <= 1e-15 * b.abs()), "{header}");
    };
    same(&data["motion"]["t"], "t [s]");
    for joint in 0..6 {
        let name = data["joints"][joint].as_str().unwrap();
        same(&data["motion"]["q"][joint], &format!("q {name} [rad]"));
        same(&data["motion"]["v"][joint], &format!("v {name} [rad/s]"));
    }
    assert_eq!(data["notes"], serde_json::json!([]));
}

/// Of a rotor of the given speed, rad/s: the page's data, and what is printed about it.
fn rotor(name: &str, speed: f64, seconds: f64, step: f64) -> (Value, String, usize) {
    let folder = scratch(&format!("animate-{name}"));
    let motion = format!(
        "trajectory = {{ kind = 'constant-speed', from = [0], speed = [{speed:?}] }}\n\
         inverse = {{ end = {seconds:?}, step = {step:?} }}\n"
    );
    let run = results(&folder, "inverse", "simple_pendulum.toml", &motion);
    let output = call(&run, &["animate", "."]).output();
    let page = fs::read_to_string(run.join("animation.html")).unwrap();
    (data(&page), output, page.len())
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn a_rotor_goes_on_turning_the_way_it_does_however_long_it_runs() {
    let (data, output, _) = rotor("turning", 20.0, 600.0, 0.02);
    let [t, q] = ["t", "q"].map(|key| data["motion"][key].clone());
    let (t, q) = (numbers(&t), numbers(&q[0]));
    assert_eq!((t.len(), t[t.len() - 1]), (30_001, 600.0));
    assert!(t.iter().zip(&q).all(|(t, q)| (q - 20.0 * t).abs() < 1e-9), "the angle is not taken modulo a turn");
    assert!(!output.contains("note"), "{output}");
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn a_motion_too_long_for_a_page_is_thinned_and_that_is_reported() {
    let (data, output, size) = rotor("thinned", 1.0, 150.0, 0.001);
    let t = numbers(&data["motion"]["t"]);
    assert_eq!((t.len(), t[0], t[t.len() - 1]), (100_000, 0.0, 150.0));
    assert!(size < 6_000_000, "{size} bytes");
    assert!(output.contains("note: 100000 of 150001 instants are kept"), "{output}");
    assert_eq!(data["notes"][0], "100000 of 150001 instants are kept");
}

#[test]
fn a_joint_too_fast_for_its_instants_is_named() {
    let (data, output, _) = rotor("fast", 20.0, 1.0, 0.1);
    let note = "joint `bar` turns by up to 114.6 deg from one instant to the next";
    assert!(output.contains(note) && data["notes"][0].as_str().unwrap().contains(note), "{output}");
}

/// A pinned four-bar some 0.3 m across, whose crank turns by 3.6 deg from one instant to the next.
#[test]
fn how_far_loops_open_between_instants_is_reported_and_not_to_be_seen() {
    let folder = scratch("animate-open");
    let data = data(&page(&turn(&folder, 100)));
    let note = data["notes"][0].as_str().unwrap();
    let residual =
        note.strip_prefix("between instants the loops open by at most ").unwrap().strip_suffix(" m").unwrap();
    let residual: f64 = residual.parse().unwrap();
    assert!(0.0 < residual && residual < 1e-5, "{note}");
}

#[test]
fn names_cannot_end_the_script_they_stand_in() {
    let folder = scratch("animate-names");
    let text = fs::read_to_string(model("simple_pendulum.toml")).unwrap();
    let name = "</script><script>alert(1)</script><!--";
    let evil = folder.join("evil.toml");
    fs::write(&evil, text.replacen("\"simple_pendulum\"", &format!("{name:?}"), 1)).unwrap();
    let page = page(&swing(&folder, evil.to_str().unwrap(), 1, 1.0, 10));
    assert!(!page.contains("alert(1)</script>"));
    assert_eq!(data(&page)["name"], name);
}

#[test]
fn loops_and_their_multipliers_are_there() {
    let folder = scratch("animate-loops");
    let data = data(&page(&turn(&folder, 100)));
    assert_eq!(data["cuts"][0]["name"], "crank-coupler");
    let titles: Vec<_> = data["charts"].as_array().unwrap().iter().map(|chart| chart["title"].clone()).collect();
    assert!(titles.contains(&"Lagrange multipliers".into()) && titles.contains(&"Drift of the energy".into()));
}

#[test]
fn a_chart_has_the_curves_of_one_unit_alone() {
    let folder = scratch("animate-units");
    let data = data(&page(&slide(&folder, 10)));
    let chart = |unit: &str| data["charts"].as_array().unwrap().iter().find(|chart| chart["unit"] == unit).unwrap();
    let names = |unit: &str| -> Vec<_> {
        chart(unit)["curves"].as_array().unwrap().iter().map(|curve| curve["name"].as_str().unwrap()).collect()
    };
    assert_eq!(names("rad"), ["crank", "coupler"]);
    assert_eq!(names("m"), ["slider"]);
}

#[test]
fn what_is_missing_or_wrong_is_reported() {
    let folder = scratch("animate-missing");
    let fails = |code: i32, wrong: &str| {
        let output = fail(&folder, &["animate", "."], code);
        assert!(output.contains(wrong) && output.contains("help:"), "{output}");
        assert!(!folder.join("animation.html").exists());
    };
    fails(3, "holds no model.toml");
    fs::copy(model("simple_pendulum.toml"), folder.join("model.toml")).unwrap();
    fails(1, "holds no motion");
    fs::write(folder.join("statevar.csv"), "t [s],q other [rad]\n0,0\n").unwrap();
    fails(1, "statevar.csv:1: the column `q bar [..]` is missing");
    fs::write(folder.join("statevar.csv"), "t [s],q bar [rad],v bar [rad/s]\n0,0,0\n1,NaN,0\n").unwrap();
    fails(1, "statevar.csv:3: `q bar [rad]` must be a finite number, found NaN");
}

#[test]
fn a_page_that_is_there_stays_unless_forced() {
    let folder = scratch("animate-exists");
    swing(&folder, "simple_pendulum.toml", 1, 1.0, 10);
    fs::write(folder.join("mine.html"), "mine").unwrap();
    let output = fail(&folder, &["animate", "run", "-o", "mine.html"], 3);
    assert!(output.contains("mine.html is there already"), "{output}");
    assert_eq!(fs::read_to_string(folder.join("mine.html")).unwrap(), "mine");
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn the_page_of_a_free_robot_has_its_quaternion_and_the_rates_of_its_velocities() {
    let folder = scratch("animate-free");
    let rest = "[initial]\nq = { base = { rpy = [0.1, 0, 0] } }\nv = { base = [0, 0, 1, 0, 0, 2] }\n\
                [forward]\nend = 0.5\nstep = 0.01\n";
    let run = results(&folder, "forward", "kr5_floating.toml", rest);
    let data = data(&page(&run));
    let joint = |body: usize| &data["bodies"][body]["joint"];
    assert_eq!((&joint(1)["kind"], &joint(1)["orientation"]), (&"free".into(), &"quaternion".into()));
    assert_eq!((&joint(1)["coordinate"], &joint(2)["coordinate"]), (&0.into(), &7.into()));
    assert_eq!((&joint(2)["orientation"], data["joints"][6].as_str()), (&Value::Null, Some("base.qw")));
    // The base has no rod to the place where it starts.
    assert_eq!(data["bodies"][0]["ends"], serde_json::json!([]));
    let table = Table::csv(&run.join("statevar.csv"));
    for (coordinate, name) in ["x [m]", "y [m]", "z [m]", "qx [1]", "qy [1]", "qz [1]", "qw [1]"].iter().enumerate() {
        assert_eq!(numbers(&data["motion"]["q"][coordinate]), table.column(&format!("q base.{name}")));
        let rate = numbers(&data["motion"]["v"][coordinate]);
        assert!(rate.iter().all(|rate| rate.is_finite()));
    }
    let upward = [0.0, -(0.1_f64).sin(), (0.1_f64).cos(), 0.0, -(0.05_f64).sin(), (0.05_f64).cos(), 0.0];
    for (coordinate, expected) in upward.iter().enumerate() {
        let found = numbers(&data["motion"]["v"][coordinate])[0];
        assert!((found - expected).abs() < 1e-15, "{coordinate}: {found}, not {expected}");
    }
    assert_eq!(data["notes"], serde_json::json!([]));
    succeed(&run, &["plot", "."]);
}

#[test]
fn a_camera_that_is_asked_for_is_in_the_page_and_follows_floating_bases_alone() {
    let folder = scratch("animate-camera");
    let rest = "[forward]\nend = 0.1\nstep = 0.05\n";
    let run = results(&folder, "forward", "kr5_floating.toml", rest);
    assert_eq!(data(&page(&run))["camera"], Value::Null);
    for camera in ["follow", "fixed"] {
        succeed(&run, &["animate", ".", "--force", "--camera", camera]);
        assert_eq!(data(&fs::read_to_string(run.join("animation.html")).unwrap())["camera"], camera);
    }
    let fixed = swing(&folder.join("fixed"), "kr5.toml", 6, 1.0, 10);
    let output = fail(&fixed, &["animate", ".", "--camera", "follow"], 2);
    assert!(output.contains("the camera cannot follow `kr5`: none of its links floats on a `free` joint"), "{output}");
    assert!(!fixed.join("animation.html").exists());
    succeed(&fixed, &["animate", ".", "--camera", "fixed"]);
    let output = fail(&fixed, &["animate", ".", "--camera", "still"], 2);
    assert!(output.contains("follow, fixed"), "{output}");
}
