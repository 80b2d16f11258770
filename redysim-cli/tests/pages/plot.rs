//! `redysim plot`: what it draws, and what it reports where it cannot.

use std::fs;

use crate::common::{call, fail, results, scratch, slide, succeed, swing, turn};

#[test]
fn a_run_with_loops_gives_four_pictures_in_both_forms() {
    let folder = scratch("plot-pictures");
    turn(&folder, 100);
    succeed(&folder, &["plot", "run", "-o", "pictures"]);
    let to = folder.join("pictures");
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
    shows("energy.svg", &["kinetic", "potential", "total", "Drift of the energy", "J]"]);
    shows("lambda.svg", &["λ [N]", "crank-coupler 1", "crank-coupler 2"]);
}

#[test]
fn what_a_run_has_not_written_is_not_drawn() {
    let folder = scratch("plot-lacking");
    let from = swing(&folder, "kr5.toml", 6, 1.0, 50);
    fs::remove_file(from.join("energy.csv")).unwrap();
    succeed(&from, &["plot", "."]);
    let there = |name: &str| from.join(name).exists();
    assert!(there("motion.svg") && there("torques.png") && !there("energy.svg") && !there("lambda.png"));
}

#[test]
fn angles_and_displacements_have_axes_of_their_own() {
    let folder = scratch("plot-units");
    let from = slide(&folder, 50);
    succeed(&from, &["plot", "."]);
    let svg = fs::read_to_string(from.join("motion.svg")).unwrap();
    for text in ["angle [rad]", "displacement [m]", "velocity [rad/s]", "velocity [m/s]"] {
        assert!(svg.contains(text), "{text}");
    }
}

/// How often each name stands in the legends of a picture.
fn legend(svg: &str, names: &[&str]) -> Vec<usize> {
    names.iter().map(|name| svg.lines().filter(|line| line.trim() == *name).count()).collect()
}

/// Two angles that swing by 0.1 rad about 50 rad cannot be told apart beside one that goes up to 100 rad; their
/// velocities can.
#[test]
fn every_curve_stands_in_a_legend_by_its_own_name() {
    let folder = scratch("plot-legends");
    let mut motion = "t [s],q a [rad],q b [rad],q c [rad],v a [rad/s],v b [rad/s],v c [rad/s]\n".to_owned();
    for t in (0..=100).map(|k| 0.01 * f64::from(k)) {
        let (sin, cos) = (50.0 * t).sin_cos();
        motion +=
            &format!("{t},{},{},{},100,{},{}\n", 100.0 * t, 50.0 + 0.1 * sin, 50.0 + 0.1 * cos, 5.0 * cos, -5.0 * sin);
    }
    fs::write(folder.join("statevar.csv"), motion).unwrap();
    succeed(&folder, &["plot", "."]);
    let svg = fs::read_to_string(folder.join("motion.svg")).unwrap();
    assert_eq!(legend(&svg, &["a", "b, c", "b", "c"]), [2, 1, 1, 1], "{svg}");
}

#[test]
fn one_legend_serves_panels_that_show_the_same_curves() {
    let folder = scratch("plot-one-legend");
    let motion = "t [s],q a [rad],q b [rad],v a [rad/s],v b [rad/s]\n0,0,0,1,2\n1,1,2,1,2\n";
    fs::write(folder.join("statevar.csv"), motion).unwrap();
    succeed(&folder, &["plot", "."]);
    let svg = fs::read_to_string(folder.join("motion.svg")).unwrap();
    assert_eq!(legend(&svg, &["a", "b"]), [1, 1], "{svg}");
}

#[test]
fn a_picture_that_is_there_stays_unless_forced_and_then_no_other_is_written() {
    let folder = scratch("plot-exists");
    let run = swing(&folder, "kr5.toml", 6, 1.0, 50);
    fs::write(run.join("torques.svg"), "mine").unwrap();
    let output = fail(&folder, &["plot", "run"], 3);
    assert!(output.contains("torques.svg is there already") && output.contains("--force"), "{output}");
    assert!(!run.join("motion.svg").exists());
    assert_eq!(fs::read_to_string(run.join("torques.svg")).unwrap(), "mine");
    succeed(&folder, &["plot", "run", "--force"]);
    assert!(fs::read_to_string(run.join("torques.svg")).unwrap().starts_with("<svg"));
}

#[test]
fn a_bad_table_is_named_with_its_line_and_what_to_do() {
    let folder = scratch("plot-bad-table");
    fs::write(folder.join("tor.csv"), "t [s],tau j [N m]\n0,1\n1,one\n").unwrap();
    let output = fail(&folder, &["plot", "."], 1);
    for words in ["tor.csv:3: `tau j [N m]` must be a number, found `one`", "help: "] {
        assert!(output.contains(words), "{output}");
    }
    assert!(!folder.join("torques.svg").exists());
}

#[test]
fn values_that_are_not_numbers_leave_a_gap() {
    let folder = scratch("plot-gaps");
    let rows = "0,1\n1,2\n2,NaN\n3,inf\n4,-inf\n5,2\n6,3\n";
    fs::write(folder.join("tor.csv"), format!("t [s],tau j [N m]\n{rows}")).unwrap();
    let run = call(&folder, &["plot", "."]);
    assert_eq!(run.code, 0, "{}", run.stderr);
    assert!(run.stderr.starts_with("warning: ") && run.stderr.contains(", j: its curve has a gap"), "{}", run.stderr);
    let svg = fs::read_to_string(folder.join("torques.svg")).unwrap();
    let curves = svg.lines().filter(|line| line.starts_with("<polyline") && line.contains("#0072B2"));
    // And one sample in the legend.
    assert_eq!(curves.count(), 2 + 1, "{svg}");
}

#[test]
fn a_folder_without_results_is_refused() {
    let folder = scratch("plot-nothing");
    let output = fail(&folder, &["plot", "."], 1);
    assert!(output.contains("holds nothing to draw"), "{output}");
    let output = fail(&folder, &["plot", "nowhere"], 3);
    assert!(output.contains("nowhere is not there"), "{output}");
}

#[test]
fn tables_without_names_are_distinguished_from_a_folder_without_results() {
    let folder = scratch("plot-nameless");
    let lift = "trajectory = { from = [0, 0], to = [1, 1], duration = 1.0 }\ninverse = { end = 1.0, step = 0.1 }\n";
    results(&folder, "inverse", "two_link.toml", lift);
    succeed(&folder, &["inverse", "trial.toml", "-o", "run", "--force", "--format", "dat"]);
    for command in ["plot", "animate"] {
        let output = fail(&folder, &[command, "run"], 1);
        assert!(output.contains("*.dat") && output.contains("--format csv"), "{output}");
    }
}
