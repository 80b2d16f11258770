//! `redysim animate`: the page, and what is said where none can be made. What the page does in a browser is tested in
//! `viewer.rs`.

mod recording;

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use recording::{model, redysim, said, swing, turn};
use serde_json::Value;

/// Makes the page of the results in `folder`.
fn page(folder: &Path) -> String {
    let output = redysim(["animate", folder.to_str().unwrap(), "--force"]);
    assert!(output.status.success(), "{}", said(&output));
    fs::read_to_string(folder.join("animation.html")).unwrap()
}

/// The data in a page.
fn data(page: &str) -> Value {
    let (_, rest) = page.split_once(r#"<script id="data" type="application/json">"#).unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

#[test]
fn the_page_asks_for_nothing_from_elsewhere() {
    let folder = tempfile::tempdir().unwrap();
    swing(folder.path(), &model("kr5"), 1.0, 50);
    let page = page(folder.path());
    for outside in ["src=\"", "<link rel=\"stylesheet", "@import", "url(http"] {
        assert!(!page.contains(outside), "{outside}");
    }
    assert!(page.contains("default-src 'none'"));
}

#[test]
fn the_frames_are_those_of_the_kinematics() {
    let folder = tempfile::tempdir().unwrap();
    swing(folder.path(), &model("kr5"), 1.0, 50);
    let data = data(&page(folder.path()));
    assert_eq!(data["poses"]["t"].as_array().unwrap().len(), 51);
    assert_eq!(data["poses"]["values"].as_array().unwrap().len(), 51 * 6 * 7);
    let table = fs::read_to_string(folder.path().join("kinematics.csv")).unwrap();
    let headers: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let column = headers.iter().position(|header| *header == "z link4 [m]").unwrap();
    let last: f64 = table.lines().last().unwrap().split(',').nth(column).unwrap().parse().unwrap();
    let shown = data["poses"]["values"][(50 * 6 + 3) * 7 + 2].as_f64().unwrap();
    assert!((shown - last).abs() < 1e-6, "{shown} {last}");
}

#[test]
fn without_kinematics_they_come_from_the_joint_angles() {
    let folder = tempfile::tempdir().unwrap();
    swing(folder.path(), &model("kr5"), 1.0, 50);
    let written = data(&page(folder.path()));
    fs::remove_file(folder.path().join("kinematics.csv")).unwrap();
    assert_eq!(data(&page(folder.path()))["poses"], written["poses"]);
}

#[test]
fn a_long_run_is_thinned_and_keeps_its_end() {
    let folder = tempfile::tempdir().unwrap();
    swing(folder.path(), &model("double_pendulum"), 60.0, 20_000);
    let page = page(folder.path());
    let data = data(&page);
    let t = data["poses"]["t"].as_array().unwrap();
    assert!(t.len() <= 1200, "{} frames", t.len());
    assert_eq!((t[0].as_f64(), t[t.len() - 1].as_f64()), (Some(0.0), Some(60.0)));
    assert!(page.len() < 2_000_000, "{} bytes", page.len());
}

#[test]
fn names_cannot_end_the_script_they_stand_in() {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(model("simple_pendulum")).unwrap();
    let name = "</script><script>alert(1)</script><!--";
    let evil = folder.path().join("evil.toml");
    fs::write(&evil, text.replacen("\"simple_pendulum\"", &format!("{name:?}"), 1)).unwrap();
    swing(folder.path(), &evil, 1.0, 10);
    let page = page(folder.path());
    assert!(!page.contains("alert(1)</script>"));
    assert_eq!(data(&page)["name"], name);
}

#[test]
fn loops_and_their_multipliers_are_there() {
    let folder = tempfile::tempdir().unwrap();
    turn(folder.path(), &model("fourbar"), TAU, 1.0, 100, &[0.0, 0.9844, 4.3144]);
    let data = data(&page(folder.path()));
    assert_eq!(data["cuts"][0]["name"], "crank-coupler");
    let titles: Vec<_> = data["charts"].as_array().unwrap().iter().map(|chart| chart["title"].clone()).collect();
    assert!(titles.contains(&"Lagrange multipliers".into()) && titles.contains(&"Drift of the energy".into()));
}

#[test]
fn a_chart_has_the_curves_of_one_unit_alone() {
    let folder = tempfile::tempdir().unwrap();
    swing(folder.path(), &model("slider_crank"), 1.0, 10);
    let data = data(&page(folder.path()));
    let chart = |unit: &str| data["charts"].as_array().unwrap().iter().find(|chart| chart["unit"] == unit).unwrap();
    let names = |unit: &str| -> Vec<_> {
        chart(unit)["curves"].as_array().unwrap().iter().map(|curve| curve["name"].as_str().unwrap()).collect()
    };
    assert_eq!(names("rad"), ["crank", "coupler"]);
    assert_eq!(names("m"), ["slider"]);
}

#[test]
fn what_is_missing_or_wrong_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().to_str().unwrap();
    let fails = |code: i32, wrong: &str| {
        let output = redysim(["animate", path]);
        assert_eq!(output.status.code(), Some(code), "{}", said(&output));
        assert!(said(&output).contains(wrong) && said(&output).contains("help:"), "{}", said(&output));
        assert!(!folder.path().join("animation.html").exists());
    };
    fails(3, "holds no model.toml");
    fs::copy(model("simple_pendulum"), folder.path().join("model.toml")).unwrap();
    fails(1, "holds no motion");
    fs::write(folder.path().join("kinematics.csv"), "t [s],x other [m]\n0,0\n").unwrap();
    fails(1, "kinematics.csv:1: there is no column `x ");
    fs::remove_file(folder.path().join("kinematics.csv")).unwrap();
    swing(folder.path(), &model("simple_pendulum"), 1.0, 2);
    let table = fs::read_to_string(folder.path().join("kinematics.csv")).unwrap();
    let rows: Vec<&str> = table.lines().collect();
    let broken = rows[2].replacen(rows[2].split(',').nth(1).unwrap(), "NaN", 1);
    fs::write(folder.path().join("kinematics.csv"), format!("{}\n{}\n{broken}\n", rows[0], rows[1])).unwrap();
    fails(1, "kinematics.csv:3: column `x ");
}

#[test]
fn a_page_that_is_there_stays_unless_forced() {
    let folder = tempfile::tempdir().unwrap();
    swing(folder.path(), &model("simple_pendulum"), 1.0, 10);
    let path = folder.path().join("mine.html");
    fs::write(&path, "mine").unwrap();
    let output = redysim(["animate", folder.path().to_str().unwrap(), "-o", path.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(3));
    assert!(said(&output).contains("mine.html is there already"), "{}", said(&output));
    assert_eq!(fs::read_to_string(&path).unwrap(), "mine");
}
