//! The page of `redysim animate` and `redysim show` in a browser: `viewer/check` runs this, and says what it needs.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use redysim_model::{GenericMechanism, Model};
use redysim_runtime::{Frames, Mechanism};

use crate::animate;
use crate::common::{Table, model, results, robot, scratch, shipped, slide, succeed, swing, turn};
use crate::rover;

/// Makes the page of the results in `folder` and has `viewer/test.mjs` look at it, and hold it against the results of
/// the same motion at more instants if there are.
fn plays(folder: &Path, finer: Option<&Path>) {
    succeed(folder, &["animate", "."]);
    node("test.mjs", folder, finer);
}

/// Makes the page of the results in `folder` with more `options` and has `viewer/camera.mjs` look where the camera is.
fn films<const N: usize>(folder: &Path, options: &[&str], expected: [&str; N]) {
    succeed(folder, &[&["animate", ".", "--force"], options].concat());
    node("camera.mjs", folder, expected);
}

/// Runs a script of `viewer/` on a folder.
fn node(script: &str, folder: &Path, more: impl IntoIterator<Item = impl AsRef<OsStr>>) {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("viewer").join(script);
    let output = Command::new("node").arg(script).arg(folder).args(more).output();
    let output = output.expect("node, which viewer/check looks for");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    println!("{}", String::from_utf8_lossy(&output.stdout));
}

/// A folder that stays, so that the screenshots can be looked at.
fn folder(name: &str) -> PathBuf {
    scratch(&format!("viewer/{name}"))
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn the_page_moves_a_robot_as_its_kinematics() {
    plays(&swing(&folder("kr5"), "kr5.toml", 6, 4.0, 400), None);
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn the_page_moves_a_closed_loop_as_its_kinematics() {
    plays(&turn(&folder("fourbar"), 100), Some(&turn(&folder("fourbar_finer"), 700)));
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn the_page_moves_a_slider_as_its_kinematics() {
    plays(&slide(&folder("slider_crank"), 400), None);
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn the_page_moves_a_long_chain_as_its_kinematics() {
    plays(&swing(&folder("chain40"), "peers/chain40.toml", 40, 4.0, 400), None);
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn numbers_of_any_length_stand_complete_beside_their_axes() {
    let run = swing(&folder("long_labels"), "kr5.toml", 6, 4.0, 400);
    let drift = |k: i32| format!("{},{:e}\n", 0.01 * f64::from(k), -1.22e-13 + 2e-15 * (0.05 * f64::from(k)).sin());
    let drift: String = (0..=400).map(drift).collect();
    fs::write(run.join("energy.csv"), format!("t [s],drift [J]\n{drift}")).unwrap();
    plays(&run, None);
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn names_that_are_html_do_no_harm() {
    let folder = folder("html_names");
    fs::create_dir_all(&folder).unwrap();
    let evil = folder.join("evil.toml");
    let name = "</script><script>document.title='harm'</script><img src=x onerror=document.title='harm'>";
    let text = fs::read_to_string(model("double_pendulum.toml")).unwrap();
    fs::write(
        &evil,
        text.replace("\"double_pendulum\"", &format!("{name:?}")).replace("\"rod2\"", &format!("{name:?}")),
    )
    .unwrap();
    plays(&swing(&folder, evil.to_str().unwrap(), 2, 2.0, 200), None);
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn a_rotor_turns_the_way_it_does_between_instants() {
    let spin = |name: &str, step: f64| {
        let motion = format!(
            "trajectory = {{ kind = 'constant-speed', from = [0], speed = [20] }}\ninverse = {{ end = 4.0, step = {step:?} }}\n"
        );
        results(&folder(name), "inverse", "simple_pendulum.toml", &motion)
    };
    // By 4 rad from one instant to the next: the short way would be backwards.
    plays(&spin("rotor", 0.2), Some(&spin("rotor_finer", 0.01)));
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn the_page_moves_the_robot_of_a_urdf_with_its_meshes() {
    let folder = folder("meshes");
    robot(&folder);
    let motion =
        "trajectory = { from = [0, 0], to = [1, 0.2], duration = 1.0 }\ninverse = { end = 1.0, step = 0.01 }\n";
    fs::write(folder.join("trial.toml"), format!("model = 'arm_description/urdf/robot.urdf'\n{motion}")).unwrap();
    succeed(&folder, &["inverse", "trial.toml", "-o", "run"]);
    plays(&folder.join("run"), None);
}

/// A forward run with so many rows.
fn run(name: &str, model: &str, initial: &str, rows: usize) -> PathBuf {
    let step = 2.0 / rows as f64;
    let integrator = "integrator = { method = 'Dop853', rtol = 1e-9, atol = 1e-9 }";
    let rest = format!("[initial]\n{initial}\n[forward]\nend = 2.0\nstep = {step:?}\n{integrator}\n");
    results(&folder(name), "forward", model, &rest)
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn the_page_moves_a_robot_on_a_free_base_as_its_kinematics() {
    let initial =
        "q = { base = { rpy = [0.3, 0.2, 0.1] }, joint2 = 1 }\nv = { base = [1, 0, 9, 0.5, 1, 2], joint1 = 1 }";
    let coarse = run("kr5_floating", "kr5_floating.toml", initial, 200);
    plays(&coarse, Some(&run("kr5_floating_finer", "kr5_floating.toml", initial, 1400)));
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn the_page_moves_a_spherical_pendulum_as_its_kinematics() {
    let initial = "q = { pivot = { rpy = [1, 0.2, 0.1] } }\nv = [0, 0, 6]";
    let coarse = run("spherical_pendulum", "spherical_pendulum.toml", initial, 200);
    plays(&coarse, Some(&run("spherical_pendulum_finer", "spherical_pendulum.toml", initial, 1400)));
}

/// The results of a shipped scenario, in a folder for one test.
fn run_of(name: &str, test: &str) -> PathBuf {
    let folder = folder(&format!("{test}_{name}"));
    succeed(&folder, &["forward", &shipped(name), "-o", "run", "--force", "--quiet"]);
    folder.join("run")
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn the_camera_follows_a_trunk_that_trots_over_the_ground() {
    let run = run_of("quadruped", "camera");
    films(&run, &[], ["follow", "trunk", "y"]);
    films(&run, &["--camera", "fixed"], ["fixed", "trunk", "y"]);
    films(&run, &["--camera", "follow"], ["follow", "trunk", "y"]);
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn the_camera_follows_a_platform_in_the_air_on_request_in_all_directions() {
    let run = run_of("kr5_floating", "camera");
    films(&run, &[], ["fixed", "platform", "none"]);
    films(&run, &["--camera", "follow"], ["follow", "platform", "none"]);
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn the_camera_follows_a_base_that_drives_over_a_plane() {
    let run = rover::drive(&folder("camera_rover"), "joint = 'planar'", "[3, 0, 0.5]", 40);
    films(&run, &[], ["follow", "chassis", "none", "0.6"]);
    films(&run, &["--camera", "fixed"], ["fixed", "chassis", "none"]);
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn the_camera_has_nothing_to_follow_where_the_base_is_fixed() {
    films(&swing(&folder("camera_kr5"), "kr5.toml", 6, 4.0, 100), &[], ["none", "link1", "none"]);
}

/// Writes the places of the frames of the model `name` in each row of a run of it to `points.csv`.
fn write_points(run: &Path, name: &str) {
    let mechanism = GenericMechanism::new(Model::load(model(&format!("{name}.toml"))).unwrap().model);
    let frames = mechanism.model().frames.iter();
    let headers = frames.flat_map(|frame| ["x", "y", "z"].map(|axis| format!(",{axis} {} [m]", frame.name)));
    let mut points = format!("t [s]{}\n", headers.collect::<String>());
    for row in Table::csv(&run.join("statevar.csv")).rows {
        let (q, v) = (row[1..=mechanism.nq()].to_vec(), vec![0.0; mechanism.nv()]);
        let numbers = mechanism.frame_kinematics(&q, &v).into_iter().flat_map(|state| state.origin);
        let numbers = numbers.map(|number| format!(",{number:?}")).collect::<String>();
        points += &format!("{}{numbers}\n", row[0]);
    }
    fs::write(run.join("points.csv"), points).unwrap();
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn the_page_draws_forces_of_the_ground_at_the_feet_and_footprints_where_they_touch_down() {
    for (name, normal) in [("quadruped", "y"), ("parcel", "z")] {
        let run = run_of(name, "contacts");
        write_points(&run, name);
        succeed(&run, &["animate", ".", "--force"]);
        node("contacts.mjs", &run, [normal]);
    }
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn the_page_draws_footprints_on_a_wall_where_contacts_meet_one() {
    let law = "law = 'hunt-crossley'\nstiffness = 2e4\ndamping = 0.8\nfriction = 0.5\nslip_velocity = 0.01\n";
    let rest = format!(
        "initial = {{ q = {{ parcel = {{ xyz = [0, 0, 0.4] }} }}, v = {{ parcel = [3, 0, 1, 0, 0, 0] }} }}\n\
         forward = {{ end = 1.5, step = 0.01 }}\n\
         [[contact]]\n{law}frame = ['bottom_right_rear', 'bottom_left_rear']\n\
         [[contact]]\n{law}frame = ['top_right_front', 'top_left_front']\n\
         ground = {{ point = [1, 0, 0], normal = [-2, 0, 0] }}\n"
    );
    let run = results(&folder("contacts_wall"), "forward", "parcel.toml", &rest);
    write_points(&run, "parcel");
    succeed(&run, &["animate", ".", "--force"]);
    node("contacts.mjs", &run, ["z", "z", "-x=1", "-x=1"]);
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn the_page_draws_footprints_of_bounces_between_the_instants_of_a_run() {
    let run = animate::parcel(&folder("contacts_parcel_coarse"), 0.1);
    write_points(&run, "parcel");
    succeed(&run, &["animate", ".", "--force"]);
    node("contacts.mjs", &run, ["z"]);
}
