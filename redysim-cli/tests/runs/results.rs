//! What a run leaves behind: its files, their columns, and all that is needed to do it again.

use std::fs;
use std::path::PathBuf;

use crate::common::{Table, call, deviation, names, root, scenario, scratch, succeed};
use redysim_cli::{Dynamics, Ending, Results, Run, Trajectory};

fn shipped(name: &str) -> String {
    root().join(format!("scenarios/{name}.toml")).display().to_string()
}

#[test]
fn a_run_writes_its_tables_its_scenario_and_its_model() {
    let folder = scratch("files");
    let always = [
        "energy.csv",
        "kinematics.csv",
        "model.toml",
        "momentum.csv",
        "run.toml",
        "statevar.csv",
        "timevar.csv",
        "tor.csv",
        "traj.csv",
    ];
    succeed(&folder, &["forward", &shipped("gripper"), "-o", "tree"]);
    assert_eq!(names(&folder.join("tree")), always);
    succeed(&folder, &["inverse", &shipped("fourbar"), "-o", "loops"]);
    let mut expected = [&always[..], &["lambda.csv"]].concat();
    expected.sort_unstable();
    assert_eq!(names(&folder.join("loops")), expected);
}

#[test]
fn columns_have_names_and_units() {
    let folder = scratch("columns");
    succeed(&folder, &["inverse", &shipped("fourbar"), "-o", "run"]);
    let headers = |name: &str| Table::csv(&folder.join("run").join(name)).headers;
    assert_eq!(headers("timevar.csv"), ["t [s]"]);
    let motion = [
        "t [s]",
        "q crank [rad]",
        "q rocker [rad]",
        "q coupler [rad]",
        "v crank [rad/s]",
        "v rocker [rad/s]",
        "v coupler [rad/s]",
    ];
    assert_eq!(headers("statevar.csv"), motion);
    assert_eq!(headers("traj.csv")[..7], motion);
    assert_eq!(headers("traj.csv")[7..], ["a crank [rad/s^2]", "a rocker [rad/s^2]", "a coupler [rad/s^2]"]);
    assert_eq!(headers("tor.csv"), ["t [s]", "tau crank [N m]", "tau rocker [N m]", "tau coupler [N m]"]);
    assert_eq!(headers("lambda.csv"), ["t [s]", "lambda crank-coupler 1 [N]", "lambda crank-coupler 2 [N]"]);
    assert_eq!(headers("energy.csv"), ["t [s]", "kinetic [J]", "potential [J]", "total [J]", "work [J]", "drift [J]"]);
    let of_crank = [
        "x crank [m]",
        "y crank [m]",
        "z crank [m]",
        "com_x crank [m]",
        "com_y crank [m]",
        "com_z crank [m]",
        "r11 crank [1]",
        "r12 crank [1]",
        "r13 crank [1]",
        "r21 crank [1]",
        "r22 crank [1]",
        "r23 crank [1]",
        "r31 crank [1]",
        "r32 crank [1]",
        "r33 crank [1]",
    ];
    assert_eq!(headers("kinematics.csv")[1..16], of_crank);
    assert_eq!(headers("kinematics.csv").len(), 1 + 3 * 15);
}

/// A slider and a spatial loop: a rod held to the ground at its end by a weld, so that rows align directions, too.
#[test]
fn sliding_joints_and_rows_of_directions_have_units_of_their_own() {
    let folder = scratch("units");
    let model = "name = 'm'\ngravity = [0, 0, -9.81]\n[[link]]\nname = 'a'\njoint_name = 'rail'\nparent = 'base'\njoint = 'prismatic'\n\
                 axis = [1, 0, 0]\nmass = 1.0\ninertia = { xx = 1, yy = 1, zz = 1 }\n[[link]]\nname = 'b'\nparent = 'a'\n\
                 joint = 'revolute'\naxis = [0, 0, 1]\nmass = 1.0\ninertia = { xx = 1, yy = 1, zz = 1 }\nactuated = false\n[[loop]]\nname = 'hold'\n\
                 joint = 'weld'\nlink_a = 'base'\npoint_a = [0, 0, 0]\nlink_b = 'b'\npoint_b = [0, 0, 0]\n";
    fs::write(folder.join("model.toml"), model).unwrap();
    fs::write(folder.join("trial.toml"), "model = 'model.toml'\n[forward]\nend = 0.2\nstep = 0.1\n").unwrap();
    succeed(&folder, &["--quiet", "forward", "trial.toml", "-o", "run"]);
    let headers = |name: &str| Table::csv(&folder.join("run").join(name)).headers;
    assert_eq!(headers("statevar.csv"), ["t [s]", "q rail [m]", "q b [rad]", "v rail [m/s]", "v b [rad/s]"]);
    assert_eq!(headers("tor.csv"), ["t [s]", "tau rail [N]", "tau b [N m]"]);
    assert_eq!(headers("lambda.csv"), ["t [s]", "lambda hold 1 [N]", "lambda hold 2 [N m]"]);
}

/// A pendulum's link is where its angle puts it.
#[test]
fn kinematics_are_those_of_the_angles() {
    let folder = scratch("kinematics");
    succeed(&folder, &["inverse", &shipped("two_link"), "-o", "run"]);
    let (motion, places) =
        (Table::csv(&folder.join("run/statevar.csv")), Table::csv(&folder.join("run/kinematics.csv")));
    let [q1, q2] = ["q joint1 [rad]", "q joint2 [rad]"].map(|name| motion.column(name));
    for k in 0..q1.len() {
        let at = |name: &str| places.column(name)[k];
        let angle = q1[k] + q2[k];
        let expected = [
            ("x link2 [m]", 0.3 * q1[k].cos()),
            ("y link2 [m]", 0.3 * q1[k].sin()),
            ("com_x link2 [m]", 0.3 * q1[k].cos() + 0.125 * angle.cos()),
            ("r11 link2 [1]", angle.cos()),
            ("r12 link2 [1]", -angle.sin()),
            ("r21 link2 [1]", angle.sin()),
            ("r33 link2 [1]", 1.0),
        ];
        for (name, expected) in expected {
            assert!((at(name) - expected).abs() < 1e-14, "{name}");
        }
    }
}

#[test]
fn the_scenario_of_a_run_has_what_was_left_open_and_how_it_went() {
    let folder = scratch("resolved");
    let rest = "# mine\ninitial = { q = [0, 0.9844, 4.3144] }\n[forward]\nend = 0.5\nstep = 0.1\n";
    let output = succeed(&folder, &["forward", &scenario(&folder, "fourbar.toml", rest), "-o", "run"]);
    let run = fs::read_to_string(folder.join("run/run.toml")).unwrap();
    let words = [
        "# mine",
        "model = \"model.toml\"",
        "name = \"trial\"",
        "held = [\"crank\"]",
        "assemble = true",
        "method = \"Ode45\"",
        "rtol = 0.001",
        "atol = 1e-6",
        "max_step = 0.05",
        "law = \"free\"",
        "stabilisation = { kind = \"projection\" }",
        "redysim = \"0.1.0\"",
        "ended = \"complete\"",
        "steps = ",
        "energy_drift = ",
        "energy_exchanged = ",
        "worst_position_residual = ",
    ];
    for word in words {
        assert!(run.contains(word), "no `{word}` in: {run}");
    }
    let words = [
        "the start moves rocker by -2.694e-5 rad, coupler by 3.919e-5 rad",
        "steps",
        "evaluations",
        "s of computing and writing",
        "energy drift",
        "were exchanged",
        "worst position residual",
        "written to run",
    ];
    for word in words {
        assert!(output.contains(word), "no `{word}` in: {output}");
    }
    let quiet = succeed(&folder, &["forward", &folder.join("trial.toml").display().to_string(), "-o", "quiet", "-q"]);
    assert_eq!(quiet, "");
}

#[test]
fn redysims_files_have_redysims_columns() {
    let folder = scratch("dat");
    for (scenario, command) in [("gripper", "forward"), ("gripper", "inverse"), ("fourbar", "inverse")] {
        for format in ["csv", "dat"] {
            let name = format!("{scenario}-{command}-{format}");
            succeed(&folder, &[command, &shipped(scenario), "-o", &name, "--format", format]);
        }
        let csv = |table: &str| Table::csv(&folder.join(format!("{scenario}-{command}-csv/{table}.csv")));
        let dat = |table: &str| Table::dat(&folder.join(format!("{scenario}-{command}-dat/{table}.dat"))).rows;
        assert_eq!(dat("timevar"), csv("timevar").rows);
        let energy = csv("energy");
        let columns = |row: &Vec<f64>| vec![row[2], row[1], 0.0 - row[4], row[3] - row[4]];
        assert!(deviation(&dat("envar"), &energy.rows.iter().map(columns).collect::<Vec<_>>()) < 1e-15);
        let (states, motion) = (dat("statevar"), csv("statevar"));
        let count = motion.headers.len() - 1;
        assert_eq!(states.iter().map(|row| row[..count].to_vec()).collect::<Vec<_>>(), motion.columns(1..count + 1));
        if command == "forward" {
            assert_eq!(states[0].len(), count + 1, "and the energy of the actuators");
        } else {
            assert_eq!(states, csv("traj").columns(1..1 + 3 * count / 2), "and accelerations");
        }
        let forces = match scenario {
            "fourbar" => csv("tor")
                .rows
                .iter()
                .zip(csv("lambda").rows)
                .map(|(tau, lambda)| vec![tau[1], lambda[1], lambda[2]])
                .collect(),
            _ => csv("tor").columns(1..5),
        };
        assert_eq!(dat("tor"), forces);
    }
    assert!(!names(&folder.join("fourbar-inverse-dat")).iter().any(|name| name.ends_with(".csv")));
}

/// The shipped tolerances take steps longer than from row to row, and the solution within is open by 10⁻⁵ m.
#[test]
fn loops_are_closed_in_every_row() {
    let folder = scratch("closed");
    succeed(&folder, &["forward", &shipped("fourbar"), "-o", "run"]);
    for row in Table::csv(&folder.join("run/statevar.csv")).rows {
        let [crank, rocker, coupler] = [row[1], row[2], row[2] + row[3]].map(f64::sin_cos);
        let x = -0.0895 + 0.1152 * (rocker.1 + coupler.1) - 0.038 * crank.1;
        let y = 0.1152 * (rocker.0 + coupler.0) - 0.038 * crank.0;
        assert!(x.abs() < 1e-14 && y.abs() < 1e-14, "open by {x:e} and {y:e} m at {} s", row[0]);
    }
}

/// ReDySim's own three-RRR starts with gaps; its free motion leaves them as they are.
#[test]
fn loops_may_stay_open_where_that_is_asked_for() {
    let folder = scratch("open");
    let rest = "initial = { q = [1.0467, 5.4206, -2.5357, 4.1883, -2.0939, 5.7637, -0.9869], assemble = false }\n[forward]\nend = 2.0\nstep = 0.01\n\
                stabilisation = 'none'\nintegrator = { method = 'Dop853', rtol = 1e-13, atol = 1e-14 }\n";
    succeed(&folder, &["forward", &scenario(&folder, "three_rrr.toml", rest), "-o", "run"]);
    let reference = Table::reference("golden_ref_rrr3.csv");
    let worst = deviation(&Table::csv(&folder.join("run/statevar.csv")).columns(1..15), &reference.columns(1..15));
    assert!(worst < 1e-8, "{worst:e}");
    let worst = deviation(&Table::csv(&folder.join("run/lambda.csv")).columns(1..5), &reference.columns(18..22));
    assert!(worst < 1e-8 * 100.0, "{worst:e} of forces of 10 to 100 N");
}

#[test]
fn the_scenario_of_the_documentation_runs() {
    let folder = scratch("documented");
    let text = fs::read_to_string(root().join("docs/scenarios.md")).unwrap();
    let scenario = text.split("```toml\n").nth(1).unwrap().split("```").next().unwrap();
    let models = root().join("models");
    fs::write(folder.join("swing.toml"), scenario.replace("../models", &models.display().to_string())).unwrap();
    for command in ["inverse", "forward"] {
        succeed(&folder, &[command, "swing.toml", "-o", command]);
    }
}

#[test]
fn forces_that_no_actuator_gives_are_warned_of() {
    let folder = scratch("passive");
    let model = fs::read_to_string(root().join("models/two_link.toml")).unwrap();
    // The last table is that of the second link.
    fs::write(folder.join("model.toml"), model + "actuated = false\n").unwrap();
    let lift = "model = 'model.toml'\n[trajectory]\nfrom = [0, 0]\nto = [1, 1]\nduration = 1.0\n[inverse]\nend = 1.0\nstep = 0.1\n";
    fs::write(folder.join("trial.toml"), lift).unwrap();
    let run = call(&folder, &["inverse", "trial.toml", "-o", "run"]);
    assert_eq!(run.code, 0, "{}", run.output());
    assert!(run.stderr.contains("the joint `joint2` has no actuator"), "{}", run.stderr);
    assert!(!run.stderr.contains("joint1"), "{}", run.stderr);
}

/// A run along a table, whose results have all that they can have.
fn tracked(name: &str) -> PathBuf {
    let folder = scratch(name);
    fs::write(folder.join("points.csv"), "t [s],q joint1 [deg],q joint2 [rad]\n0,0,0\n0.5,1,-1\n1,0,1\n").unwrap();
    let rest = "trajectory = { kind = 'csv', file = 'points.csv' }\n[inverse]\nend = 1.0\nstep = 0.1\n\
                [forward]\nend = 0.7\nstep = 0.1\ntorque = { law = 'tracking-pd', kp = 30, kd = 3 }\n";
    let path = scenario(&folder, "two_link.toml", rest);
    succeed(&folder, &["forward", &path, "-o", "first"]);
    folder
}

#[test]
fn results_are_kept_to_the_bit_and_run_again_from_where_they_are_written() {
    let folder = tracked("results-data");
    let first = Results::load(folder.join("first")).unwrap_or_else(|fault| panic!("{fault}"));
    // What another program reads of them is the same.
    let text = serde_json::to_string(&first).unwrap();
    assert_eq!(serde_json::from_str::<Results>(&text).unwrap(), first);
    assert_eq!((first.run.command, first.run.ended), (Dynamics::Forward, Ending::Complete));
    assert_eq!((first.run.instants, first.run.from, first.run.until), (8, 0.0, 0.7));
    assert_eq!((first.scenario.model.as_str(), first.scenario.inverse), ("model.toml", None));
    let tables: Vec<_> = first.tables.keys().map(String::as_str).collect();
    assert_eq!(tables, ["energy", "kinematics", "momentum", "statevar", "timevar", "tor", "traj", "trajectory"]);
    let state = &first.tables["statevar"];
    assert_eq!(
        state.columns.iter().map(|column| column.header()).collect::<Vec<_>>()[..2],
        ["q joint1 [rad]".to_owned(), "q joint2 [rad]".to_owned()]
    );
    assert_eq!(state.columns[2].values[0], first.run.start_v[0]);

    // Whatever it named, the scenario is about the folder that is written.
    let mut moved = first.clone();
    moved.scenario.model = "../two_link.toml".into();
    if let Some(Trajectory::Csv { file, .. }) = &mut moved.scenario.trajectory {
        *file = "../points.csv".into();
    }
    assert_ne!(moved.scenario, first.scenario);
    let written = moved.write(folder.join("second"), false).unwrap_or_else(|fault| panic!("{fault}"));
    assert_eq!(Results::load(&written).unwrap(), first);
    for command in [["plot", "second", "-o", "pictures"], ["forward", "second/run.toml", "-o", "third"]] {
        succeed(&folder, &command);
    }
    let third = Results::load(folder.join("third")).unwrap();
    assert_eq!(third.tables, first.tables);
    let outcome = |results: &Results| Run { seconds: 0.0, ..results.run.clone() };
    assert_eq!((outcome(&third), third.scenario), (outcome(&first), first.scenario));
}

#[test]
fn results_that_could_not_be_read_are_not_written() {
    let folder = tracked("results-data-faults");
    let good = Results::load(folder.join("first")).unwrap();
    let bad = |change: &dyn Fn(&mut Results)| {
        let mut results = good.clone();
        change(&mut results);
        let fault = results.write(folder.join("bad"), false).unwrap_err().to_string();
        assert!(!folder.join("bad").exists() && names(&folder).len() == 3, "nothing is left: {:?}", names(&folder));
        fault
    };
    let state = |results: &mut Results, change: &dyn Fn(&mut redysim_cli::Table)| {
        change(results.tables.get_mut("statevar").unwrap());
    };
    type Change<'c> = &'c dyn Fn(&mut Results);
    let faults: [(Change<'_>, &str); 12] = [
        (&|results| results.model.links[0].mass = -1.0, "`mass` is -1.0 kg"),
        (&|results| results.scenario.forward.as_mut().unwrap().step = -0.1, "`forward.step`"),
        (&|results| drop(results.tables.remove("trajectory")), "they have no table `trajectory`"),
        (&|results| results.tables.retain(|name, _| name == "trajectory"), "they have no table"),
        (&|results| results.scenario.name = None, "their scenario has no name"),
        (&|results| results.run.command = Dynamics::Inverse, "of inverse dynamics, which their scenario does not have"),
        (&|results| results.run.instants = u64::MAX, "integer number overflowed"),
        (
            &|results| state(results, &|table| table.columns[0].values.truncate(7)),
            "`q joint1 [rad]` has 7 values, but there are 8",
        ),
        (&|results| state(results, &|table| table.columns[0].symbol = "q x".into()), "reads back as another"),
        (&|results| state(results, &|table| table.t[3] = 0.0), "instant 4 is 0.0 s"),
        (&|results| state(results, &|table| table.t.clear()), "it has no rows"),
        (
            &|results| drop(results.tables.insert("state/var".into(), good.tables["tor"].clone())),
            "no table `state/var`",
        ),
    ];
    for (change, fault) in faults {
        let shown = bad(change);
        assert!(shown.contains(fault), "{fault}: {shown}");
    }
    let there = good.write(folder.join("first"), false).unwrap_err().to_string();
    assert!(there.contains("first"), "{there}");
    let nowhere = Results::load(folder.join("nowhere")).unwrap_err().to_string();
    assert!(nowhere.contains("nowhere is not there"), "{nowhere}");
    let run = fs::read_to_string(folder.join("first/run.toml")).unwrap();
    let run_file = |text: &str| {
        fs::write(folder.join("first/run.toml"), text).unwrap();
        Results::load(folder.join("first")).unwrap_err().to_string()
    };
    for (text, fault) in [
        (run.replace("instants = ", "instance = "), "run.toml: the table `[run]`: unknown field `instance`"),
        (run.split("# How it went.").next().unwrap().to_owned(), "it has no table `[run]`, which a run writes"),
        (run.replace("seconds = ", "seconds : "), "run.toml: TOML parse error at line"),
    ] {
        let shown = run_file(&text);
        assert!(shown.contains(fault), "{fault}: {shown}");
    }
    let path = folder.join("trial.toml").display().to_string();
    succeed(&folder, &["forward", &path, "-o", "dat", "--format", "dat"]);
    let dat = Results::load(folder.join("dat")).unwrap_err().to_string();
    assert!(dat.contains("holds no tables of results") && dat.contains("--format csv"), "{dat}");
}
