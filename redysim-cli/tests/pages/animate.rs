//! `redysim animate`: the page, and what is reported where none can be made. What the page does in a browser is tested
//! in `viewer.rs`.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{Table, call, data, fail, model, results, scratch, shipped, slide, succeed, swing, turn};
use crate::rover;
use redysim_cli::Results;
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

/// The results of the shipped parcel with rows this far apart, s.
pub fn parcel(folder: &Path, step: f64) -> PathBuf {
    let shipped = fs::read_to_string(shipped("parcel")).unwrap();
    let (model, path) = (model("parcel.toml"), folder.join("parcel.toml"));
    let scenario = shipped.replace("../models/parcel.toml", &model).replace("step = 0.01", &format!("step = {step:?}"));
    fs::create_dir_all(folder).unwrap();
    fs::write(&path, scenario).unwrap();
    succeed(folder, &["forward", path.to_str().unwrap(), "-o", "run", "--quiet"]);
    folder.join("run")
}

/// When and where a page has footprints of each contact.
fn footprints(page: &str) -> Vec<Vec<Vec<f64>>> {
    let places = data(page)["contacts"]["places"].clone();
    let of_place = |place: &Value| place["footprints"].as_array().unwrap().iter().map(numbers).collect();
    places.as_array().unwrap().iter().map(of_place).collect()
}

/// How often a contact touches in a row and does not in the last one.
fn begun_in_rows(run: &Path) -> usize {
    let contacts = Table::csv(&run.join("contacts.csv"));
    let begun = |contact: &usize, pair: &[Vec<f64>]| pair[0][6 * contact] == 0.0 && pair[1][6 * contact] == 1.0;
    (1..=8).map(|contact| contacts.rows.windows(2).filter(|pair| begun(&contact, pair)).count()).sum()
}

#[test]
fn a_run_whose_rows_are_coarser_than_its_bounces_has_a_footprint_for_every_touch_down_of_its_record() {
    let folder = scratch("animate-footprints");
    let run = parcel(&folder, 0.1);
    let (page, record) = (page(&run), Table::csv(&run.join("touch_downs.csv")));
    let count = Results::load(&run).unwrap().run.touch_downs.unwrap() as usize;
    assert!(begun_in_rows(&run) < count, "every touch-down is seen in the rows: the test shows nothing");
    let footprints = footprints(&page);
    assert_eq!((footprints.iter().flatten().count(), record.rows.len()), (count, count));
    for (contact, shown) in footprints.iter().enumerate() {
        let of_contact: Vec<_> = record.rows.iter().filter(|row| row[1] == contact as f64).collect();
        assert_eq!(shown.len(), of_contact.len(), "contact {contact}");
        for (print, row) in shown.iter().zip(of_contact) {
            assert_eq!((print[0], print[1], print[2]), (row[0], row[2], row[3]), "contact {contact}");
            assert!(print[3].abs() < 1e-15, "{print:?} is on the ground");
        }
    }
    assert_eq!(data(&page)["notes"], serde_json::json!([]));
}

#[test]
fn results_without_a_record_of_touch_downs_have_the_footprints_of_their_rows_and_report_how_many_are_missing() {
    let folder = scratch("animate-footprints-of-rows");
    let run = parcel(&folder, 0.1);
    fs::remove_file(run.join("touch_downs.csv")).unwrap();
    let (page, shown) = (page(&run), begun_in_rows(&run));
    assert_eq!(footprints(&page).iter().flatten().count(), shown);
    let missing = Results::load(&run).unwrap().run.touch_downs.unwrap() as usize - shown;
    let note = format!("{missing} touch-downs between instants without a footprint");
    assert!(data(&page)["notes"][0].as_str().unwrap().starts_with(&note), "{}", data(&page)["notes"]);
}

#[test]
fn the_camera_can_follow_a_base_on_a_free_or_planar_joint_also_where_a_link_is_fixed_between_it_and_the_ground() {
    let folder = scratch("animate-base");
    let bases = [
        ("planar", "joint = 'planar'", "[3, 0, 0.5]"),
        ("free", "joint = 'free'", "[3, 0, 0, 0, 0, 0.5]"),
        ("angles", "joint = 'free'\ncoordinates = 'zyx'", "[3, 0, 0, 0.5, 0, 0]"),
    ];
    for (name, joint, v) in bases {
        let run = rover::drive(&folder.join(name), joint, v, 2);
        succeed(&run, &["animate", ".", "--camera", "follow"]);
        let data = data(&fs::read_to_string(run.join("animation.html")).unwrap());
        let base = data["base"].as_u64().unwrap() as usize;
        assert_eq!(data["bodies"][base]["name"], "chassis", "{name}");
        assert_eq!(data["bodies"][base]["joint"]["kind"], name.replace("angles", "free"));
    }
}

#[test]
fn of_several_bases_the_camera_can_follow_the_one_that_carries_the_most_links() {
    let folder = scratch("animate-bases");
    let path = folder.join("two.toml");
    let link = |name: &str, parent: &str, joint: &str| {
        format!(
            "[[link]]\nname = '{name}'\nparent = '{parent}'\njoint = '{joint}'\norigin = {{}}\nmass = 1\n\
                 inertia = {{ xx = 1, yy = 1, zz = 1 }}\nactuated = false\n"
        )
    };
    let links = [
        link("ball", "base", "free"),
        link("cart", "base", "planar"),
        link("mast", "cart", "planar"),
        link("sledge", "base", "planar"),
        link("box", "sledge", "planar"),
    ];
    let start = "name = 'two'\ngravity = [0, 0, 0]\nallow = ['under-actuated', 'no-gravity']\n";
    fs::write(&path, format!("{start}{}", links.concat())).unwrap();
    let run = results(&folder, "forward", path.to_str().unwrap(), "[forward]\nend = 0.1\nstep = 0.05\n");
    let data = data(&page(&run));
    assert_eq!(
        data["bodies"][data["base"].as_u64().unwrap() as usize]["name"],
        "cart",
        "the first of two that carry one"
    );
}

#[test]
fn a_camera_that_is_asked_for_is_in_the_page_and_follows_moving_bases_alone() {
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
    let message = "the camera cannot follow `kr5`: it follows a base, a link on a `free` or `planar` joint to the ground, \
                   and finds `revolute` alone";
    assert!(output.contains(message), "{output}");
    assert!(!fixed.join("animation.html").exists());
    assert_eq!(data(&page(&fixed))["base"], Value::Null);
    fs::remove_file(fixed.join("animation.html")).unwrap();
    succeed(&fixed, &["animate", ".", "--camera", "fixed"]);
    let output = fail(&fixed, &["animate", ".", "--camera", "still"], 2);
    assert!(output.contains("follow, fixed"), "{output}");
}
