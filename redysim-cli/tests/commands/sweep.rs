//! `redysim sweep`: rows of many samples, the same as of single runs, whatever interrupts them.

mod faults;

use std::fs;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use redysim_cli::{Study, SweepRows};

#[cfg(target_os = "linux")]
use crate::common::running::shown;
use crate::common::{Table, call, fail, model, names, scenario, scratch, succeed};
#[cfg(unix)]
use crate::common::{on_a_full_disk, program, running::Running};

const FALL: &str = "initial = { q = [0, 1] }\n[forward]\nend = 0.1\nstep = 0.05\n\
                    torque = { law = 'pd', target = [0.5, 0.5], kp = 10.0, kd = [1.0, 1.0] }\n";

/// A study of the two-link robot; returns its path.
fn study(folder: &Path, rest: &str) -> String {
    scenario(folder, "two_link.toml", FALL);
    fs::write(folder.join("study.toml"), format!("scenario = 'trial.toml'\n{rest}\n")).unwrap();
    folder.join("study.toml").display().to_string()
}

/// A folder with the rows of a study.
fn sweep(name: &str, rest: &str) -> PathBuf {
    let folder = scratch(name);
    succeed(&folder, &["sweep", &study(&folder, rest), "--output", "rows", "--quiet"]);
    folder
}

fn text(folder: &Path) -> String {
    fs::read_to_string(folder.join("rows/rows.csv")).unwrap()
}

/// The cells below `header`, by samples.
fn cells(folder: &Path, header: &str) -> Vec<String> {
    let text = text(folder);
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let column = reader.headers().unwrap().iter().position(|found| found == header);
    let column = column.unwrap_or_else(|| panic!("no `{header}` in {text}"));
    reader.records().map(|record| record.unwrap()[column].to_owned()).collect()
}

fn numbers(folder: &Path, header: &str) -> Vec<f64> {
    cells(folder, header).iter().map(|cell| cell.parse().unwrap()).collect()
}

const GRID: &str = "[over]\n\"forward.torque.kp\" = [10.0, 20.0]\n\
                    \"model.link.link2.mass\" = { from = 1.0, to = 2.0, count = 3 }\n";

#[test]
fn rows_have_the_bits_of_single_runs_of_the_same_scenario() {
    let folder = sweep("sweep-single", GRID);
    let text = fs::read_to_string(model("two_link.toml")).unwrap();
    assert_eq!(numbers(&folder, "forward.torque.kp"), [10.0, 10.0, 10.0, 20.0, 20.0, 20.0]);
    let [last, peak, drift] =
        ["last q joint2 [rad]", "peak tau joint1 [N m]", "energy_drift"].map(|header| numbers(&folder, header));
    for (index, (kp, m)) in [(1, (10.0, 1.5)), (5, (20.0, 2.0))] {
        fs::write(folder.join("heavy.toml"), text.replace("mass = 0.4", &format!("mass = {m:?}"))).unwrap();
        let alone = format!("model = 'heavy.toml'\n{}", FALL.replace("kp = 10.0", &format!("kp = {kp:?}")));
        fs::write(folder.join("alone.toml"), alone).unwrap();
        succeed(&folder, &["forward", "alone.toml", "--output", "alone", "--force", "--quiet"]);
        check(&folder.join("alone"), [last[index], peak[index], drift[index]]);
        // The files of the sample do the same.
        let index = index.to_string();
        succeed(&folder, &["sweep", "study.toml", "--sample", &index, "--output", "one", "--force", "--quiet"]);
        succeed(&folder, &["forward", "one/scenario.toml", "--output", "again", "--force", "--quiet"]);
        assert_eq!(fs::read(folder.join("again/traj.csv")).unwrap(), fs::read(folder.join("alone/traj.csv")).unwrap());
    }
}

/// Compares the last position of the second joint, the largest torque of the first, and the drift of a run.
fn check(run: &Path, [last, peak, drift]: [f64; 3]) {
    let [motion, torques] = ["traj.csv", "tor.csv"].map(|name| Table::csv(&run.join(name)));
    assert_eq!(motion.column("q joint2 [rad]").last(), Some(&last));
    let torques = torques.column("tau joint1 [N m]");
    assert_eq!(torques.iter().fold(0.0, |most, tau| f64::max(most, tau.abs())), peak);
    let how: toml::Table = fs::read_to_string(run.join("run.toml")).unwrap().parse().unwrap();
    assert_eq!(how["run"]["energy_drift"].as_float(), Some(drift));
}

#[test]
fn a_grid_lists_and_a_table_are_the_same_samples() {
    let grid = text(&sweep("sweep-grid", GRID));
    let lists =
        "[samples]\nforward.torque.kp = [10, 10, 10, 20, 20, 20]\nmodel.link.link2.mass = [1, 1.5, 2, 1, 1.5, 2]";
    assert_eq!(text(&sweep("sweep-lists", lists)), grid);
    let folder = scratch("sweep-table");
    let rows = "# by hand\nforward.torque.kp, model.link.link2.mass\n10,1\n10,1.5\n10,2\n20,1\n20,1.5\n20,2\n";
    fs::write(folder.join("samples.csv"), rows).unwrap();
    succeed(&folder, &["sweep", &study(&folder, "samples.file = 'samples.csv'"), "--output", "rows", "--quiet"]);
    assert_eq!(text(&folder), grid);
}

/// The torque that holds a pendulum of length l at an angle is m g l cos q: over normal lengths it is normal.
#[test]
fn the_torque_over_random_lengths_has_its_closed_form_and_spread() {
    let folder = scratch("sweep-spread");
    let at = "trajectory = { from = [\"60 deg\"], to = [\"60 deg\"], duration = 1.0 }\ninverse = { end = 0.1, step = 0.1 }\n";
    fs::write(
        folder.join("rod.toml"),
        "name = 'rod'\ngravity = [0, -9.81, 0]\n[[link]]\nname = 'rod'\nparent = 'base'\njoint = 'revolute'\ndh = {}\nmass = 2.0\ncom = [0.5, 0, 0]\n",
    )
    .unwrap();
    fs::write(folder.join("hold.toml"), format!("model = 'rod.toml'\n{at}")).unwrap();
    let drawn =
        "scenario = 'hold.toml'\n[samples]\ncount = 400\nseed = 3\nmodel.link.rod.com.0 = { normal = [0.5, 0.01] }\n";
    fs::write(folder.join("study.toml"), drawn).unwrap();
    succeed(&folder, &["sweep", "study.toml", "--output", "rows", "--quiet"]);
    let lengths = numbers(&folder, "model.link.rod.com.0");
    let torques = numbers(&folder, "peak tau rod [N m]");
    for (length, torque) in lengths.iter().zip(&torques) {
        let exact = 2.0 * 9.81 * length * 0.5;
        assert!((torque - exact).abs() < 1e-14 * 10.0, "{length}: {torque}, not {exact}");
    }
    let mean = torques.iter().sum::<f64>() / 400.0;
    let variance = torques.iter().map(|torque| (torque - mean).powi(2)).sum::<f64>() / 400.0;
    let (exact, deviation) = (2.0 * 9.81 * 0.5 * 0.5, 2.0 * 9.81 * 0.01 * 0.5);
    // Five standard errors: σ/√n of the mean, σ/√2n of the deviation.
    assert!((mean - exact).abs() < 5.0 * deviation / 20.0, "{mean}");
    assert!((variance.sqrt() - deviation).abs() < 5.0 * deviation / 800_f64.sqrt(), "{}", variance.sqrt());
}

#[test]
fn what_is_torn_or_missing_is_computed_again_and_more_samples_are_added() {
    let folder = sweep("sweep-again", GRID);
    let whole = text(&folder);
    let rows = folder.join("rows/rows.csv");
    // Rows in another order, one missing, and one torn.
    let lines: Vec<&str> = whole.lines().collect();
    let torn = [lines[0], lines[4], lines[2], &lines[6][..20]].join("\n");
    fs::write(&rows, torn).unwrap();
    let again = call(&folder, &["sweep", "study.toml", "--output", "rows"]);
    assert!(again.stderr.contains("2 samples of 6 are there already"), "{}", again.stderr);
    assert_eq!(text(&folder), whole);
    assert!(succeed(&folder, &["sweep", "study.toml", "--output", "rows"]).contains("6 samples\n"));
    // More samples keep those that there were.
    let drawn = |count| format!("[samples]\ncount = {count}\nforward.torque.kp = {{ uniform = [5, 15] }}\n");
    study(&folder, &drawn(3));
    succeed(&folder, &["sweep", "study.toml", "--output", "rows", "--force", "--quiet"]);
    let few = text(&folder);
    study(&folder, &drawn(5));
    succeed(&folder, &["sweep", "study.toml", "--output", "rows", "--quiet"]);
    assert!(text(&folder).starts_with(&few) && text(&folder).lines().count() == 6);
}

/// A folder with the rows of a study of sixty short runs and then two that take most of a second: whoever stops it
/// after its first rows is in time, on a busy machine, too.
#[cfg(unix)]
fn long_sweep(name: &str) -> PathBuf {
    let folder = scratch(name);
    let long = if cfg!(debug_assertions) { 120.0 } else { 480.0 };
    let ends = (0..60).map(|index| 0.2 + 0.005 * f64::from(index)).chain([long, long]);
    let lines: Vec<String> = ends.map(|end| format!("{end:?}\n")).collect();
    fs::write(folder.join("samples.csv"), format!("forward.end\n{}", lines.concat())).unwrap();
    let study = study(&folder, "samples.file = 'samples.csv'");
    succeed(&folder, &["sweep", &study, "--output", "rows", "--quiet"]);
    folder
}

#[cfg(unix)]
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn a_killed_sweep_goes_on_to_the_rows_of_one_that_was_not() {
    let folder = long_sweep("sweep-killed");
    let whole = text(&folder);
    let rows = folder.join("killed/rows.csv");
    let mut child = program(&folder, &["sweep", "study.toml", "--output", "killed", "--quiet"]).spawn().unwrap();
    while fs::metadata(&rows).map_or(0, |file| file.len()) < 600 {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let kept = fs::read_to_string(&rows).unwrap().lines().count();
    assert!(kept < 63, "it was killed in time");
    succeed(&folder, &["sweep", "study.toml", "--output", "killed", "--quiet", "--jobs", "1"]);
    assert_eq!(fs::read_to_string(&rows).unwrap(), whole);
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_whole_rows_and_the_same_command_goes_on_to_those_of_a_sweep_without_it() {
    let folder = long_sweep("sweep-interrupted");
    let command = ["sweep", "study.toml", "--output", "part"];
    let rows = folder.join("part/rows.csv");
    let run = Running::into(&folder, &command, rows.clone());
    run.wait(|rows| fs::metadata(rows).is_ok_and(|file| file.len() > 600));
    run.interrupt();
    let (code, error) = run.end();
    assert_eq!(code, Some(130), "{error}");
    let kept = fs::read_to_string(&rows).unwrap();
    let count = kept.lines().count() - 1;
    assert!(kept.ends_with('\n') && (1..62).contains(&count), "{kept}");
    let message = format!("interrupted: {count} of 62 samples are in part/rows.csv; the same command goes on");
    assert!(error.contains(&message), "{error}");
    assert!(!error.contains('%'), "no terminal, no bar: {error}");
    // Whole rows, in whatever order.
    let whole = text(&folder);
    assert!(kept.lines().all(|row| whole.lines().any(|other| other == row)), "{kept}");
    let again = call(&folder, &command);
    assert!(again.code == 0 && again.stderr.contains(" of 62 are there already"), "{}", again.output());
    assert_eq!(fs::read_to_string(&rows).unwrap(), whole);
}

#[cfg(target_os = "linux")]
#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn a_terminal_shows_how_far_a_long_sweep_is_and_how_long_it_will_take() {
    let folder = scratch("sweep-progress");
    study(&folder, "[samples]\ncount = 20000\nforward.end = { uniform = [1.0, 2.0] }\n");
    let bar = shown(&folder, "sweep study.toml --output rows --jobs 1");
    assert!(bar.contains(" %, ") && bar.contains(" left") && bar.contains("the same command goes on"), "{bar}");
}

#[cfg(unix)]
#[test]
fn a_full_disk_is_one_error_and_loses_no_row() {
    let drawn = "[samples]\ncount = 60\nforward.torque.kp = { uniform = [5, 15] }\n";
    let folder = sweep("sweep-full", drawn);
    let error = on_a_full_disk(&folder, 6, &["sweep", "study.toml", "--output", "full", "--quiet"]);
    assert_eq!(error.matches("error:").count(), 1, "{error}");
    for part in
        ["cannot write full/rows.csv", "of 60 samples are kept in full/rows.csv", "the same command then goes on"]
    {
        assert!(error.contains(part), "{error}");
    }
    // Without room for the study itself.
    fs::create_dir(folder.join("fuller")).unwrap();
    fs::write(folder.join("fuller/rows.csv"), "").unwrap();
    succeed(&folder, &["sweep", "study.toml", "--output", "fuller", "--quiet"]);
    let kept = fs::read_to_string(folder.join("full/rows.csv")).unwrap();
    assert!(kept.ends_with('\n') && kept.len() > 5000, "whole rows: {kept}");
    succeed(&folder, &["sweep", "study.toml", "--output", "full", "--quiet"]);
    assert_eq!(fs::read_to_string(folder.join("full/rows.csv")).unwrap(), text(&folder));
}

#[test]
fn a_sample_that_fails_is_kept_with_its_reason() {
    let folder =
        sweep("sweep-failed", "[samples]\nmodel.link.link2.mass = [1, -1, 2]\nforward.torque.kp = [10, 10, 1e90]\n");
    assert_eq!(cells(&folder, "status"), ["complete", "failed", "failed"]);
    let reasons = cells(&folder, "reason");
    assert_eq!(reasons[0], "");
    assert!(reasons[1].contains("`mass` is -1") || reasons[1].contains("mass"), "{}", reasons[1]);
    assert!(reasons[2].contains("t = "), "{}", reasons[2]);
    assert_eq!(cells(&folder, "last q joint1 [rad]")[1], "");
    let again = call(&folder, &["sweep", "study.toml", "--output", "rows"]);
    assert!(again.code == 0 && again.stderr.contains("2 of 3 failed, the first of them sample 1"), "{}", again.stderr);
}

/// The rows of all parts in Parquet, as text, by samples.
fn parts(folder: &Path) -> Vec<Vec<String>> {
    let mut rows = Vec::new();
    for part in fs::read_dir(folder.join("rows/rows")).unwrap() {
        let reader = SerializedFileReader::new(fs::File::open(part.unwrap().path()).unwrap()).unwrap();
        for row in reader.get_row_iter(None).unwrap() {
            let row = row.unwrap();
            let cells = row.get_column_iter().map(|(_, field)| match field {
                Field::Long(sample) => sample.to_string(),
                Field::Double(number) => format!("{number:?}"),
                Field::Str(text) => text.clone(),
                other => other.to_string().replace("null", ""),
            });
            rows.push(cells.collect::<Vec<_>>());
        }
    }
    rows.sort_by_key(|row| row[0].parse::<usize>().unwrap());
    rows
}

/// The rows of the table, with numbers as those of [`parts`].
fn table(folder: &Path) -> Vec<Vec<String>> {
    let text = text(folder);
    let of = |(index, cell): (usize, &str)| match cell.parse::<f64>() {
        Ok(number) if index > 0 => format!("{number:?}"),
        _ => cell.to_owned(),
    };
    let records = csv::Reader::from_reader(text.as_bytes()).into_records();
    records.map(|record| record.unwrap().iter().enumerate().map(of).collect()).collect()
}

#[test]
fn parts_of_parquet_have_each_row_of_the_table_once_whatever_has_interrupted_them() {
    let folder = sweep("sweep-parquet", "[samples]\nmodel.link.link2.mass = [1, -1, 2, 0.5, 1.5, 3]\n");
    let whole = text(&folder);
    let study = Study::load(folder.join("study.toml")).unwrap();
    fs::remove_dir_all(folder.join("rows")).unwrap();
    let mut rows = SweepRows::open(folder.join("rows"), &study, false).unwrap();
    rows = rows.with_parts(&study, NonZeroUsize::new(2).unwrap()).unwrap();
    for index in [4, 0, 1] {
        rows.add(index, &study.sampler().row(&study.sample(index)).unwrap()).unwrap();
    }
    drop(rows);
    // The row of sample 4 is in a part and no longer in the table, that of sample 1 is in the table alone.
    assert_eq!(parts(&folder).len(), 2);
    let kept: Vec<String> = text(&folder).lines().filter(|line| !line.starts_with("4,")).map(str::to_owned).collect();
    fs::write(folder.join("rows/rows.csv"), kept.join("\n") + "\n").unwrap();
    let command = ["sweep", "study.toml", "--output", "rows", "--quiet", "--format", "parquet"];
    succeed(&folder, &command);
    assert_eq!(text(&folder), whole);
    assert_eq!(parts(&folder), table(&folder));
    assert_eq!(parts(&folder)[1].iter().filter(|cell| cell.is_empty()).count(), study.headers().len() - 4);

    let part = names(&folder.join("rows/rows"))[0].clone();
    fs::write(folder.join("rows/rows").join(&part), "PAR1").unwrap();
    let error = fail(&folder, &command, 3);
    assert!(error.contains(&format!("cannot read rows/rows/{part}: ")) && error.contains("delete it"), "{error}");
}

#[test]
fn a_study_that_is_replaced_leaves_no_parts_of_parquet() {
    let folder = scratch("sweep-parquet-replaced");
    study(&folder, GRID);
    succeed(&folder, &["sweep", "study.toml", "--output", "rows", "--quiet", "--format", "parquet"]);
    assert_eq!((parts(&folder), parts(&folder).len()), (table(&folder), 6));
    study(&folder, &GRID.replace("20.0", "30.0"));
    succeed(&folder, &["sweep", "study.toml", "--output", "rows", "--quiet", "--force"]);
    assert_eq!(parts(&folder).len(), 0);
    succeed(&folder, &["sweep", "study.toml", "--output", "rows", "--quiet", "--format", "parquet"]);
    assert_eq!((parts(&folder), parts(&folder).len()), (table(&folder), 6));
}
