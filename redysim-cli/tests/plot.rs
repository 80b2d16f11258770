//! `redysim plot`: what it draws, and what it says where it cannot.

mod recording;

use std::f64::consts::TAU;
use std::fs;

use recording::{model, redysim, said, swing, turn};

#[test]
fn a_run_with_loops_gives_four_pictures_in_both_forms() {
    let folder = tempfile::tempdir().unwrap();
    let (from, to) = (folder.path().join("run"), folder.path().join("pictures"));
    turn(&from, &model("fourbar"), TAU, 1.0, 100, &[0.0, 0.9844, 4.3144]);
    let output = redysim(["plot", from.to_str().unwrap(), "-o", to.to_str().unwrap()]);
    assert!(output.status.success(), "{}", said(&output));
    for name in ["motion", "torques", "energy", "lambda"] {
        let svg = fs::read_to_string(to.join(format!("{name}.svg"))).unwrap();
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{name}");
        let png = fs::read(to.join(format!("{name}.png"))).unwrap();
        assert!(png.starts_with(b"\x89PNG"), "{name}");
    }
    let shows = |name: &str, texts: &[&str]| {
        let svg = fs::read_to_string(to.join(name)).unwrap();
        texts.iter().for_each(|text| assert!(svg.contains(text), "{name} does not show {text}"));
    };
    shows("motion.svg", &["angle [rad]", "velocity [rad/s]", "acceleration [rad/s²]", "crank", "coupler", "time [s]"]);
    shows("torques.svg", &["torque [N m]"]);
    shows("energy.svg", &["kinetic", "potential", "total", "Drift of the energy", "drift [pJ]"]);
    shows("lambda.svg", &["λ [N]", "crank-coupler 1", "crank-coupler 2"]);
}

#[test]
fn what_a_run_has_not_written_is_not_drawn() {
    let folder = tempfile::tempdir().unwrap();
    swing(folder.path(), &model("kr5"), 1.0, 50);
    fs::remove_file(folder.path().join("energy.csv")).unwrap();
    let output = redysim(["plot", folder.path().to_str().unwrap()]);
    assert!(output.status.success(), "{}", said(&output));
    let there = |name: &str| folder.path().join(name).exists();
    assert!(there("motion.svg") && there("torques.png") && !there("energy.svg") && !there("lambda.png"));
}

#[test]
fn angles_and_displacements_have_axes_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    swing(folder.path(), &model("slider_crank"), 1.0, 50);
    let output = redysim(["plot", folder.path().to_str().unwrap()]);
    assert!(output.status.success(), "{}", said(&output));
    let svg = fs::read_to_string(folder.path().join("motion.svg")).unwrap();
    for text in ["angle [rad]", "displacement [m]", "velocity [rad/s]", "velocity [m/s]"] {
        assert!(svg.contains(text), "{text}");
    }
}

#[test]
fn a_picture_that_is_there_stays_unless_forced_and_then_no_other_is_written() {
    let folder = tempfile::tempdir().unwrap();
    swing(folder.path(), &model("kr5"), 1.0, 50);
    let path = folder.path().to_str().unwrap();
    fs::write(folder.path().join("torques.svg"), "mine").unwrap();
    let output = redysim(["plot", path]);
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    assert!(said(&output).contains("torques.svg is there already") && said(&output).contains("--force"));
    assert!(!folder.path().join("motion.svg").exists());
    assert_eq!(fs::read_to_string(folder.path().join("torques.svg")).unwrap(), "mine");
    assert!(redysim(["plot", path, "--force"]).status.success());
    assert!(fs::read_to_string(folder.path().join("torques.svg")).unwrap().starts_with("<svg"));
}

/// What is written in place of a table, and what is said about it.
const BAD_TABLES: [(&str, &str); 7] = [
    ("", "tor.csv:1: the first column must be `t [s]`"),
    ("time,tau j [N m]\n0,1\n", "tor.csv:1: the first column must be `t [s]`, but is `time`"),
    ("t [s],torque\n0,1\n", "tor.csv:1: a header must read `symbol name [unit]`, but this one is `torque`"),
    ("t [s],tau j [N m]\n", "tor.csv: it has headers but no rows"),
    ("t [s],tau j [N m]\n0,1\n1,one\n", "tor.csv:3: column `tau j [N m]`: a number is needed, but it is `one`"),
    ("t [s],tau j [N m]\n0,1\n1\n", "tor.csv:3: the row must have 2 values, but has 1"),
    ("t [s],tau j [N m]\n1,1\n0,1\n", "tor.csv:3: time must not run backwards, but t is `0` here"),
];

#[test]
fn a_bad_table_is_named_with_its_line_and_column() {
    for (text, wrong) in BAD_TABLES {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("tor.csv"), text).unwrap();
        let output = redysim(["plot", folder.path().to_str().unwrap()]);
        assert_eq!(output.status.code(), Some(1), "{text:?}: {}", said(&output));
        assert!(said(&output).contains(wrong) && said(&output).contains("help:"), "{text:?}: {}", said(&output));
    }
}

#[test]
fn values_that_are_no_numbers_leave_a_gap() {
    let folder = tempfile::tempdir().unwrap();
    let rows = "0,1\n1,2\n2,NaN\n3,inf\n4,-inf\n5,2\n6,3\n";
    fs::write(folder.path().join("tor.csv"), format!("t [s],tau j [N m]\n{rows}")).unwrap();
    let output = redysim(["plot", folder.path().to_str().unwrap()]);
    assert!(output.status.success(), "{}", said(&output));
    let svg = fs::read_to_string(folder.path().join("torques.svg")).unwrap();
    let curves = svg.lines().filter(|line| line.starts_with("<polyline") && line.contains("#0072B2"));
    // And one sample in the legend.
    assert_eq!(curves.count(), 2 + 1, "{svg}");
}

#[test]
fn a_folder_without_results_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let output = redysim(["plot", folder.path().to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(1));
    assert!(said(&output).contains("holds nothing to draw"), "{}", said(&output));
    let output = redysim(["plot", folder.path().join("nowhere").to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(3));
    assert!(said(&output).contains("nowhere is not there"), "{}", said(&output));
}
