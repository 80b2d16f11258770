//! The meshes of a URDF on the pages of `redysim show` and `redysim animate`. How they look in a browser is tested in
//! `viewer_show.rs`.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{Run, call, data, fail, program, robot, scratch, succeed};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

/// The data of a page, and what was printed.
fn shown(folder: &Path, urdf: &Path) -> (Value, String) {
    let run = call(folder, &["show", urdf.to_str().unwrap(), "-o", "page.html", "--force"]);
    assert_eq!(run.code, 0, "{}", run.output());
    (data(&fs::read_to_string(folder.join("page.html")).unwrap()), run.output())
}

/// The robot with a text of its URDF replaced.
fn with(name: &str, [from, to]: [&str; 2]) -> (PathBuf, PathBuf) {
    let folder = scratch(&format!("meshes-{name}"));
    let urdf = robot(&folder);
    let text = fs::read_to_string(&urdf).unwrap();
    assert!(text.contains(from), "{from}");
    fs::write(&urdf, text.replace(from, to)).unwrap();
    (folder, urdf)
}

#[test]
fn every_mesh_is_in_the_page_with_its_place_and_colour() {
    let (folder, urdf) = with("all", ["", ""]);
    let (data, output) = shown(&folder, &urdf);
    let meshes = data["meshes"].as_array().unwrap();
    let of = |key: &str| -> Vec<_> { meshes.iter().map(|mesh| mesh[key].clone()).collect() };
    assert_eq!(of("body"), [0, 1, 2]);
    assert_eq!(of("colour"), [json!([1.0, 0.5, 0.0, 1.0]), Value::Null, Value::Null]);
    assert_eq!(of("scale")[2], json!([0.001, 0.001, 0.001]));
    assert_eq!(of("position")[2], json!([0.05, 0.0, 0.0]));
    let turn: Vec<f64> = of("rotation")[2].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    let half = 0.5_f64.sqrt();
    assert!(turn.iter().zip([0.0, 0.0, half, half]).all(|(a, b)| (a - b).abs() < 1e-15), "{turn:?}");
    for (file, name) in data["files"].as_array().unwrap().iter().zip(["base.stl", "arm.dae", "tool.OBJ"]) {
        assert_eq!(file["name"], name);
        let bytes = STANDARD.decode(file["base64"].as_str().unwrap()).unwrap();
        assert_eq!(bytes, fs::read(folder.join("arm_description/meshes").join(name)).unwrap());
    }
    assert!(!output.contains("warning") && data["notes"] == json!([]), "{output}");
}

/// A zero quaternion, or any quaternion before version 1.1, does not turn it.
#[test]
fn a_mesh_is_turned_by_its_quaternion() {
    let half = 0.5_f64.sqrt();
    for (version, quaternion, expected) in [
        ("1.1", "0 0 2 2", [0.0, 0.0, half, half]),
        ("1.1", "0 0 0 0", [0.0, 0.0, 0.0, 1.0]),
        ("1.0", "0 0 2 2", [0.0, 0.0, 0.0, 1.0]),
    ] {
        let (folder, urdf) = with("turned", ["rpy=\"0 0 1.5707963267948966\"", &format!("quat_xyzw=\"{quaternion}\"")]);
        let text = fs::read_to_string(&urdf).unwrap();
        fs::write(&urdf, text.replace("<robot", &format!("<robot version=\"{version}\""))).unwrap();
        let (data, _) = shown(&folder, &urdf);
        assert_eq!(data["meshes"][2]["position"], json!([0.05, 0.0, 0.0]));
        let turn: Vec<f64> = serde_json::from_value(data["meshes"][2]["rotation"].clone()).unwrap();
        assert!(turn.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{version} {quaternion}: {turn:?}");
    }
}

#[test]
fn a_file_that_two_links_show_is_in_the_page_once() {
    let (folder, urdf) = with("twice", ["package://arm_description/meshes/arm.dae", "../meshes/base.stl"]);
    let (data, _) = shown(&folder, &urdf);
    assert_eq!(data["files"].as_array().unwrap().len(), 2);
    let files: Vec<_> = data["meshes"].as_array().unwrap().iter().map(|mesh| mesh["file"].clone()).collect();
    assert_eq!(files, [0, 0, 1]);
}

#[test]
fn a_mesh_that_is_left_out_is_named_with_its_link_and_what_to_do() {
    const LARGE: &str = "its 20.0 MB exceed the limit of 20.0 MB together with 0.0 MB already embedded";
    let relative = "\"../meshes/tool.OBJ\"";
    for (name, to, why, help) in [
        (
            "missing",
            "\"../meshes/hand.stl\"",
            "the file ",
            "does not exist\n  = help: relative paths start at the URDF's folder",
        ),
        ("package", "\"package://hand/hand.stl\"", "the package `hand` is not found", "ROS_PACKAGE_PATH"),
        ("format", "\"../meshes/tool.ply\"", "`.ply` is not read", "STL, DAE and OBJ"),
        ("large", "\"../meshes/large.stl\"", LARGE, "20.0 MB of them"),
    ] {
        let (folder, urdf) = with(name, [relative, to]);
        let large = fs::File::create(folder.join("arm_description/meshes/large.stl")).unwrap();
        large.set_len(20_000_000).unwrap();
        let (data, output) = shown(&folder, &urdf);
        let place = format!("robot.urdf:12: link `tool` is drawn without its mesh `{}`: {why}", to.trim_matches('"'));
        assert!(output.contains("warning: ") && output.contains(&place) && output.contains(help), "{output}");
        assert_eq!(data["meshes"].as_array().unwrap().len(), 2, "{name}: the others are drawn");
        assert_eq!(data["notes"], json!(["one mesh is left out"]));
        assert_eq!(call(&folder, &["show", urdf.to_str().unwrap(), "--quiet"]).output(), "");
    }
}

#[test]
fn a_package_is_found_where_ros_has_it() {
    let (folder, urdf) = with("ros", ["", ""]);
    let elsewhere = folder.join("elsewhere");
    fs::create_dir(&elsewhere).unwrap();
    let moved = elsewhere.join("robot.urdf");
    let text = fs::read_to_string(&urdf).unwrap().replace("../meshes", "package://arm_description/meshes");
    fs::write(&moved, text).unwrap();
    fs::rename(folder.join("arm_description"), elsewhere.join("hidden")).unwrap();
    let found = |variable: &str, path: PathBuf, share: &str| {
        let holder = path.join(share);
        fs::create_dir_all(&holder).unwrap();
        fs::rename(elsewhere.join("hidden"), holder.join("arm_description")).unwrap();
        let mut command = program(&elsewhere, &["show", "robot.urdf", "--force"]);
        let run = Run::of(command.env(variable, &path));
        fs::rename(holder.join("arm_description"), elsewhere.join("hidden")).unwrap();
        assert_eq!((run.code, run.output().contains("warning")), (0, false), "{}", run.output());
    };
    found("ROS_PACKAGE_PATH", folder.join("workspace"), "");
    found("AMENT_PREFIX_PATH", folder.join("prefix"), "share");
    let (_, output) = shown(&elsewhere, Path::new("robot.urdf"));
    assert_eq!(output.matches("the package `arm_description` is not found").count(), 3, "{output}");
}

/// A run of the robot, whose model is the URDF itself.
fn run(name: &str) -> (PathBuf, PathBuf) {
    // Nearly a quarter turn, which stays what it is.
    let (folder, urdf) = with(name, ["xyz=\"0.4 0 0\"", "xyz=\"0.4 0 0\" rpy=\"0 0 1.5708\""]);
    let motion = "trajectory = { from = [0, 0], to = [1, 0.2], duration = 1.0 }\ninverse = { end = 1.0, step = 0.1 }\n";
    fs::write(folder.join("trial.toml"), format!("model = 'arm_description/urdf/robot.urdf'\n{motion}")).unwrap();
    succeed(&folder, &["inverse", "trial.toml", "-o", "run"]);
    (folder, urdf)
}

#[test]
fn a_scenario_of_a_urdf_is_one_of_the_model_that_import_makes() {
    let (folder, urdf) = run("scenario");
    let imported = succeed(&folder, &["import", urdf.to_str().unwrap()]);
    assert_eq!(fs::read_to_string(folder.join("run/model.toml")).unwrap(), imported);
    fs::write(folder.join("robot.toml"), imported).unwrap();
    let text = fs::read_to_string(folder.join("trial.toml")).unwrap();
    fs::write(folder.join("trial.toml"), text.replace("arm_description/urdf/robot.urdf", "robot.toml")).unwrap();
    succeed(&folder, &["inverse", "trial.toml", "-o", "again"]);
    let table = |run: &str| fs::read_to_string(folder.join(run).join("tor.csv")).unwrap();
    assert_eq!(table("run"), table("again"));
}

#[test]
fn a_run_of_a_urdf_is_played_with_its_meshes_and_without_them_if_it_is_gone() {
    let (folder, urdf) = run("played");
    succeed(&folder, &["animate", "run"]);
    let page = |folder: &Path| data(&fs::read_to_string(folder.join("run/animation.html")).unwrap());
    assert_eq!(page(&folder)["meshes"].as_array().unwrap().len(), 3);
    // The run can be done again from its folder, whose model is a model file.
    succeed(&folder, &["inverse", "run/run.toml", "-o", "run/again"]);
    succeed(&folder, &["animate", "run/again", "-o", "run/animation.html", "--force"]);
    assert_eq!(page(&folder)["meshes"].as_array().unwrap().len(), 3);
    // Another robot stands there by now.
    let text = fs::read_to_string(&urdf).unwrap();
    fs::write(&urdf, text.replace("\"arm\"", "\"boom\"")).unwrap();
    let output = call(&folder, &["animate", "run", "--force"]).output();
    assert!(output.contains("link `boom` is drawn without its mesh") && output.contains("of the run?"), "{output}");
    fs::remove_file(&urdf).unwrap();
    let output = call(&folder, &["animate", "run", "--force"]).output();
    assert!(output.contains("warning: cannot read ") && output.contains("robot.urdf"), "{output}");
    assert_eq!(page(&folder)["meshes"], json!([]));
}

#[test]
fn a_urdf_that_is_at_fault_is_refused_as_by_import() {
    let (folder, urdf) = with("fault", ["<mass value=\"2\"/>", "<mass value=\"two\"/>"]);
    let output = fail(&folder, &["show", urdf.to_str().unwrap()], 1);
    assert!(output.contains("robot.urdf:5: link `arm`: `value` of its <mass> must be a finite number"), "{output}");
    fs::write(folder.join("trial.toml"), "model = 'arm_description/urdf/robot.urdf'\n").unwrap();
    assert_eq!(
        fail(&folder, &["inverse", "trial.toml"], 1),
        output.replace(urdf.to_str().unwrap(), "arm_description/urdf/robot.urdf")
    );
    let output = fail(&folder, &["show", "nowhere.urdf"], 3);
    assert!(output.contains("cannot read nowhere.urdf: it does not exist in "), "{output}");
}
