//! The page of `redysim animate` in a browser: `viewer/check` runs this, and says what it needs.

mod recording;

use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use recording::{model, redysim, said, swing, turn};

/// A folder that stays, so that the screenshots can be looked at.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("viewer").join(name);
    let _ = fs::remove_dir_all(&folder);
    folder
}

/// Makes the page of the results in `folder` and has `viewer/test.mjs` look at it.
fn plays(folder: &Path) {
    let output = redysim(["animate", folder.to_str().unwrap()]);
    assert!(output.status.success(), "{}", said(&output));
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("viewer/test.mjs");
    let output = Command::new("node").arg(script).arg(folder).output().expect("node, which viewer/check looks for");
    assert!(output.status.success(), "{}", said(&output));
    println!("{}", said(&output));
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn a_robot_moves_as_its_kinematics_say() {
    let folder = folder("kr5");
    swing(&folder, &model("kr5"), 4.0, 400);
    plays(&folder);
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn a_closed_loop_moves_as_its_kinematics_say() {
    let folder = folder("fourbar");
    turn(&folder, &model("fourbar"), TAU, 1.3333, 400, &[0.0, 0.9844, 4.3144]);
    plays(&folder);
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn a_slider_moves_as_its_kinematics_say() {
    let folder = folder("slider_crank");
    turn(&folder, &model("slider_crank"), 2.0, 2.0, 400, &[-2.6, 2.058, 1.031]);
    plays(&folder);
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn a_long_chain_moves_as_its_kinematics_say() {
    let folder = folder("chain40");
    swing(&folder, &model("peers/chain40"), 4.0, 400);
    plays(&folder);
}

#[test]
#[ignore = "needs node and Chromium: run redysim-cli/viewer/check"]
fn names_that_are_html_do_no_harm() {
    let folder = folder("html_names");
    fs::create_dir_all(&folder).unwrap();
    let evil = folder.join("evil.toml");
    let name = "</script><script>document.title='harm'</script><img src=x onerror=document.title='harm'>";
    let text = fs::read_to_string(model("double_pendulum")).unwrap();
    fs::write(
        &evil,
        text.replace("\"double_pendulum\"", &format!("{name:?}")).replace("\"rod2\"", &format!("{name:?}")),
    )
    .unwrap();
    swing(&folder, &evil, 2.0, 200);
    plays(&folder);
}
