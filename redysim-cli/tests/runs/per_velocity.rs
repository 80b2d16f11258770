//! Laws and motions of single velocities of joints that have several: the same mechanism moves with one joint for each velocity.

use std::fs;
use std::path::Path;

use crate::common::{AGAINST_CLOSED_FORMS, BALLS, Table, call, deviation, fail, scratch, succeed};

const RUN: &str = "[forward]\nend = 1.0\nstep = 0.05\n";
const BODY: &str =
    "mass = 1.5\ncom = [0.05, 0.1, -0.3]\ninertia = { xx = 0.02, yy = 0.03, zz = 0.04, xy = 0.002, yz = -0.004 }\n";
const MASSLESS: &str = "mass = 0\ninertia = { xx = 0, yy = 0, zz = 0 }\n";
/// Actuates the first velocity of a universal joint only.
const PARTLY: &str = "actuated = [true, false]\n";

fn head() -> String {
    "name = 'cross'\ngravity = [0.5, -1, -9.81]\nallow = ['under-actuated', 'other-gravity', 'point-masses', 'missing-inertia']\n".into()
}

/// A body on a universal joint `u`, with further keys of its link.
fn universal(folder: &Path, more: &str) {
    let link = format!("[[link]]\nname = 'u'\nparent = 'base'\njoint = 'universal'\norigin = {{}}\n{BODY}{more}");
    fs::write(folder.join("model.toml"), format!("{}{link}", head())).unwrap();
}

/// The same body on two revolute joints, `first` and `second`, of which the second has no actuator.
fn two_joints(folder: &Path) {
    let first = format!(
        "[[link]]\nname = 'first'\nparent = 'base'\njoint = 'revolute'\naxis = [1, 0, 0]\norigin = {{}}\n{MASSLESS}"
    );
    let second = format!(
        "[[link]]\nname = 'second'\nparent = 'first'\njoint = 'revolute'\naxis = [0, 1, 0]\norigin = {{}}\n{BODY}actuated = false\n"
    );
    fs::write(folder.join("model.toml"), format!("{}{first}{second}", head())).unwrap();
}

/// The states and the forces of a run of the model in `folder`.
fn moved(folder: &Path, rest: &str) -> [Table; 2] {
    fs::write(folder.join("trial.toml"), format!("model = 'model.toml'\n{rest}")).unwrap();
    succeed(folder, &["forward", "trial.toml", "-o", "run", "--force", "--quiet"]);
    ["traj", "tor"].map(|name| Table::csv(&folder.join("run").join(format!("{name}.csv"))))
}

/// The scenario that a run has left in its results, which gives the same states again.
fn copy_that_runs_again(folder: &Path) -> String {
    succeed(folder, &["forward", "run/run.toml", "-o", "again", "--quiet"]);
    let read = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    assert_eq!(read("run/statevar.csv"), read("again/statevar.csv"));
    read("run/run.toml")
}

/// What `redysim forward` prints about a run that is refused.
fn refused(folder: &Path, rest: &str) -> String {
    fs::write(folder.join("trial.toml"), format!("model = 'model.toml'\n{rest}")).unwrap();
    fail(folder, &["forward", "trial.toml"], 1)
}

/// States and forces of the universal joint, which are those of the two joints with other names.
fn as_two_joints(name: &str, rest: &str) -> [Table; 2] {
    let folder = scratch(&format!("per-velocity-{name}"));
    two_joints(&folder);
    let with_other_names = rest.replace("u.phi", "first").replace("u.theta", "second");
    let expected = moved(&folder, &with_other_names);
    universal(&folder, PARTLY);
    let found = moved(&folder, rest);
    for (found, expected) in found.iter().zip(&expected) {
        let off = deviation(&found.rows, &expected.rows);
        assert!(off < 1e-11, "{name}: off by {off:e}");
    }
    assert!(found[1].column("tau u.theta [N m]").iter().all(|force| *force == 0.0), "{name}: nothing drives it");
    assert!(found[0].column("q u.theta [rad]").iter().any(|q| (q - 0.4).abs() > 0.1), "{name}: it moves");
    found
}

const START: &str = "[initial]\nq = { 'u.phi' = 0.3, 'u.theta' = 0.4 }\nv = { 'u.theta' = -0.5 }\n";

#[test]
fn a_law_drives_the_actuated_velocity_of_a_joint_by_default_or_by_its_name_and_leaves_the_other_alone() {
    let run = format!("{START}{RUN}{AGAINST_CLOSED_FORMS}");
    let mut states = Vec::new();
    for (name, law) in [
        ("default", "law = 'pd', target = [1.0], kp = 60, kd = 8"),
        ("named", "law = 'pd', joints = ['u.phi'], target = [1.0], kp = [60], kd = { 'u.phi' = 8 }"),
        ("limited", "law = 'pd', target = { 'u.phi' = 1 }, kp = 60, kd = 8, limits = { 'u.phi' = 1e3 }"),
    ] {
        let [state, forces] = as_two_joints(name, &format!("{run}torque = {{ {law} }}\n"));
        for (state, force) in state.rows.iter().zip(forces.column("tau u.phi [N m]")) {
            let by_law = 60.0 * (1.0 - state[1]) - 8.0 * state[3];
            assert!((force - by_law).abs() < 1e-12, "{name}: {force} instead of {by_law}");
        }
        states.push(state.rows);
    }
    assert!(states.iter().all(|state| *state == states[0]));
    as_two_joints("pid", &format!("{run}torque = {{ law = 'pid', target = [1.0], kp = 60, ki = 5, kd = 8 }}\n"));
    as_two_joints("gravity", &format!("{run}torque = {{ law = 'pd-gravity', target = [1.0], kp = 60, kd = 8 }}\n"));
}

#[test]
fn values_of_a_law_are_in_the_order_in_which_it_names_velocities_and_a_joints_name_stands_for_those_of_it() {
    let folder = scratch("per-velocity-order");
    universal(&folder, "");
    let run = |law: &str| moved(&folder, &format!("{START}{RUN}torque = {{ law = 'pd', {law} }}\n"))[0].rows.clone();
    let expected = run("target = [1.0, -0.3], kp = [60, 20], kd = [8, 2]");
    for law in [
        "joints = ['u.theta', 'u.phi'], target = [-0.3, 1.0], kp = [20, 60], kd = [2, 8]",
        "joints = ['u.theta', 'u.phi'], target = { u = [1.0, -0.3] }, kp = { u = [60, 20] }, kd = { 'u.phi' = 8, 'u.theta' = 2 }",
        "joints = ['u'], target = { 'u.phi' = 1.0, 'u.theta' = -0.3 }, kp = { u = [60, 20] }, kd = [8, 2]",
    ] {
        assert_eq!(run(law), expected, "{law}");
    }
}

/// The error obeys ë + 20 ė + 100 e = 0, so that e = e₀ (1 + 10 t) exp(−10 t), however the other velocity moves.
#[test]
fn computed_torque_moves_the_actuated_velocity_of_a_joint_along_its_trajectory() {
    let trajectory = "[trajectory]\njoints = ['u.phi']\nfrom = [0]\nto = [1]\nduration = 0.8\n";
    let law = "torque = { law = 'computed-torque', kp = 100, kd = 20 }\n";
    let [state, _] = as_two_joints("computed", &format!("{START}{trajectory}{RUN}{AGAINST_CLOSED_FORMS}{law}"));
    for row in &state.rows {
        let s = (row[0] / 0.8).min(1.0);
        let wanted = s - (std::f64::consts::TAU * s).sin() / std::f64::consts::TAU;
        let error = -0.3 * (1.0 + 10.0 * row[0]) * (-10.0 * row[0]).exp();
        assert!((wanted - row[1] - error).abs() < 1e-10, "{row:?}");
    }
    let pd = "torque = { law = 'tracking-pd', kp = 60, kd = 8 }\n";
    as_two_joints("tracking", &format!("{START}{trajectory}{RUN}{AGAINST_CLOSED_FORMS}{pd}"));
    let all = "[trajectory]\nfrom = { 'u.phi' = 0 }\nto = { 'u.phi' = 1 }\nduration = 0.8\n";
    as_two_joints("tracking-of-all", &format!("{START}{all}{RUN}{AGAINST_CLOSED_FORMS}{pd}"));
}

#[test]
fn one_velocity_of_a_joint_follows_its_trajectory_exactly_while_the_other_is_free() {
    let folder = scratch("per-velocity-prescribed");
    let led = "[trajectory]\nkind = 'constant-speed'\njoints = ['u.phi']\nfrom = [0.2]\nspeed = [1.5]\n";
    let follows = "prescribed = ['u.phi']\n";
    let start = START.replace("'u.phi' = 0.3", "'u.phi' = 9");
    let rest = format!("{start}{led}{RUN}{AGAINST_CLOSED_FORMS}{follows}");
    let [state, forces] = as_two_joints("prescribed", &rest);
    for row in &state.rows {
        let off = deviation(&[vec![row[1], row[3], row[5]]], &[vec![0.2 + 1.5 * row[0], 1.5, 0.0]]);
        assert!(off < 1e-15, "{row:?}");
    }
    assert!(forces.column("tau u.phi [N m]").iter().any(|force| force.abs() > 0.1), "it takes some force");
    universal(&folder, PARTLY);
    moved(&folder, &rest);
    let drift = Table::csv(&folder.join("run/energy.csv")).column("drift [J]");
    assert!(drift.iter().all(|drift| drift.abs() < 1e-10), "{drift:?}");
    // The copy names the velocity.
    let text = copy_that_runs_again(&folder);
    assert!(text.contains("joints = ['u.phi']") && text.contains("prescribed = ['u.phi']"), "{text}");
}

#[test]
fn the_copy_of_a_scenario_names_the_velocities_that_a_law_drives_by_default() {
    let folder = scratch("per-velocity-copy");
    universal(&folder, PARTLY);
    moved(&folder, &format!("{START}{RUN}torque = {{ law = 'pd', target = [1], kp = 60, kd = 8 }}\n"));
    let text = copy_that_runs_again(&folder);
    assert!(text.contains("joints = [\"u.phi\"]"), "{text}");
}

#[test]
fn a_law_drives_a_velocity_while_the_other_one_of_its_joint_is_prescribed() {
    let folder = scratch("per-velocity-both");
    universal(&folder, "");
    let led = "[trajectory]\nkind = 'constant-speed'\njoints = ['u.phi']\nfrom = [0.2]\nspeed = [1.5]\n";
    let law = "prescribed = ['u.phi']\ntorque = { law = 'p', target = [0.1], kp = 7 }\n";
    let [state, forces] = moved(&folder, &format!("{START}{led}{RUN}{law}"));
    for (state, force) in state.rows.iter().zip(forces.column("tau u.theta [N m]")) {
        assert!((force - 7.0 * (0.1 - state[2])).abs() < 1e-12, "{force}: {state:?}");
    }
}

/// A crank and a rocker whose coupler stands on a universal joint, of which the second velocity is the only actuated one.
#[test]
fn an_actuated_velocity_leads_closed_loops_by_default() {
    let folder = scratch("per-velocity-loops");
    let passive = BALLS.replacen("mass = 1\n", "mass = 1\nactuated = false\n", 1);
    assert!(passive.contains("joint = 'spherical'\norigin = { xyz = [0, 0, 0.6] }\nmass = 1\nactuated = false"));
    let coupler = "joint = 'spherical'\norigin = { xyz = [0, 0, 0.6] }\nmass = 1\nactuated = false";
    let universal = passive
        .replace(coupler, "joint = 'universal'\norigin = { xyz = [0, 0, 0.6] }\nmass = 1\nactuated = [false, true]");
    fs::write(folder.join("model.toml"), &universal).unwrap();
    let [state, _] = moved(&folder, "initial = { q = [0.7, 0.1, 0.2, -0.6] }\n[forward]\nend = 0.01\nstep = 0.01\n");
    let held = fs::read_to_string(folder.join("run/run.toml")).unwrap();
    assert!(held.contains("held = [\"coupler.theta\"]"), "{held}");
    let theta = state.column("q coupler.theta [rad]")[0];
    let rest = |name: &str, q: &[f64]| {
        format!(
            "model = 'model.toml'\n[initial]\nq = {q:?}\n[trajectory]\nkind = 'constant-speed'\njoints = ['{name}']\n\
             from = [{theta}]\nspeed = [0.3]\n[inverse]\nend = 0.5\nstep = 0.05\n"
        )
    };
    let q = state.rows[0][1..5].to_vec();
    let forces = |scenario: &str, name: &str| {
        fs::write(folder.join("trial.toml"), scenario).unwrap();
        succeed(&folder, &["inverse", "trial.toml", "-o", "run", "--force", "--quiet"]);
        Table::csv(&folder.join("run/tor.csv")).column(&format!("tau {name} [N m]"))
    };
    let by_default = rest("coupler.theta", &q).replace("joints = ['coupler.theta']\n", "");
    let found = forces(&by_default, "coupler.theta");
    assert_eq!(found, forces(&rest("coupler.theta", &q), "coupler.theta"));
    let link = "[[link]]\nname = 'coupler'\nparent = 'rocker'\njoint = 'universal'\norigin = { xyz = [0, 0, 0.6] }\nmass = 1\nactuated = [false, true]";
    assert!(universal.contains(link));
    let two = format!(
        "[[link]]\nname = 'cross'\nparent = 'rocker'\njoint = 'revolute'\naxis = [1, 0, 0]\norigin = {{ xyz = [0, 0, 0.6] }}\n\
         actuated = false\n{MASSLESS}[[link]]\nname = 'coupler'\nparent = 'cross'\njoint = 'revolute'\naxis = [0, 1, 0]\norigin = {{}}\n\
         mass = 1"
    );
    fs::write(folder.join("model.toml"), universal.replace(link, &two)).unwrap();
    let expected = forces(&rest("coupler", &q), "coupler");
    assert!(
        deviation(std::slice::from_ref(&found), &[expected]) < 1e-9 && found.iter().any(|force| force.abs() > 0.1),
        "{found:?}"
    );
}

/// A spring along x of the link turns it about that axis: its target is an orientation all the same.
#[test]
fn a_law_of_some_velocities_of_a_quaternion_takes_the_orientation_as_its_target() {
    let folder = scratch("per-velocity-quaternion");
    let ball = "name = 'ball'\ngravity = [0, 0, 0]\nallow = ['under-actuated', 'other-gravity']\n[[link]]\nname = 'pivot'\nparent = 'base'\n\
         joint = 'spherical'\norigin = {}\nmass = 1\ninertia = { xx = 0.1, yy = 0.1, zz = 0.1 }\nactuated = [true, false, false]\n";
    fs::write(folder.join("model.toml"), ball).unwrap();
    let run = |law: &str| {
        moved(&folder, &format!("[forward]\nend = 0.05\nstep = 0.05\ntorque = {{ {law} }}\n"))[1].rows[0][1..].to_vec()
    };
    let target = "target = { pivot = { rpy = [0.4, 0, 0] } }";
    for law in [format!("law = 'p', {target}, kp = 5"), format!("law = 'p', joints = ['pivot.wx'], {target}, kp = [5]")]
    {
        let found = run(&law);
        assert!(deviation(std::slice::from_ref(&found), &[vec![5.0 * 0.4, 0.0, 0.0]]) < 1e-15, "{law}: {found:?}");
    }
    fs::write(folder.join("push.csv"), "t [s],tau pivot.wx [N m]\n0,3\n1,3\n").unwrap();
    assert_eq!(run("law = 'csv', file = 'push.csv'"), [3.0, 0.0, 0.0]);
}

#[test]
fn limits_of_the_range_are_those_of_each_velocity() {
    let folder = scratch("per-velocity-range");
    let range = |force: f64| format!("{{ position = [-3, 3], velocity = 9, force = {force:?} }}");
    universal(&folder, &format!("range = [{}, {}]\n", range(2.0), range(0.5)));
    for (joints, expected) in [("", [2.0, 0.5]), ("joints = ['u.theta', 'u.phi'], ", [2.0, 0.5])] {
        let law = format!("torque = {{ law = 'p', {joints}target = {{ u = [3, 3] }}, kp = 100, limits = 'range' }}\n");
        let [_, forces] = moved(&folder, &format!("[forward]\nend = 0.01\nstep = 0.01\n{law}"));
        assert_eq!(forces.rows[0][1..], expected, "{joints}");
    }
}

#[test]
fn a_joint_that_is_named_is_driven_whole_with_a_warning_about_what_has_no_actuator() {
    let folder = scratch("per-velocity-warned");
    universal(&folder, PARTLY);
    let shown = |joints: &str, target: &str| {
        let law = format!("torque = {{ law = 'p', joints = {joints}, target = {target}, kp = 2 }}\n");
        fs::write(folder.join("trial.toml"), format!("model = 'model.toml'\n{RUN}{law}")).unwrap();
        let run = call(&folder, &["forward", "trial.toml", "-o", "run", "--force"]);
        assert_eq!(run.code, 0, "{}", run.output());
        run.stderr
    };
    let whole = shown("['u']", "[1, 1]");
    assert!(whole.contains("drives the joint `u`, which has actuators for some of its velocities only"), "{whole}");
    let one = shown("['u.theta']", "[1]");
    assert!(one.contains("the torque law drives the velocity `u.theta`, which has no actuator"), "{one}");
    assert!(!shown("['u.phi']", "[1]").contains("actuator"));
}

#[test]
fn velocities_that_cannot_be_driven_or_prescribed_are_refused_with_what_to_do() {
    let folder = scratch("per-velocity-refused");
    let pivot = "[[link]]\nname = 'pivot'\nparent = 'u'\njoint = 'spherical'\norigin = {}\nmass = 1\nactuated = false\n\
                 inertia = { xx = 0.1, yy = 0.1, zz = 0.1 }\n";
    let wrist = pivot.replace("pivot", "wrist").replacen("'u'", "'pivot'", 1) + "coordinates = 'zxy'\n";
    universal(&folder, &format!("{PARTLY}{pivot}{wrist}"));
    let law = |keys: &str| format!("torque = {{ law = 'p', {keys} }}\n");
    let motion = |keys: &str| format!("trajectory = {{ kind = 'constant-speed', {keys} }}\n");
    let phi = "joints = ['u.phi'], from = [0], speed = [1]";
    let pivots = "joints = ['pivot'], from = {}, speed = {}";
    let computed = "torque = { law = 'computed-torque', kp = 1, kd = 1 }\n";
    for (trajectory, forward, faults) in [
        (
            String::new(),
            law("joints = ['u.phy'], target = [0], kp = 1"),
            &["unknown joint `u.phy`", "did you mean `u.phi`?", "The joints are: u, pivot, wrist;", "named as `u.phi`"]
                [..],
        ),
        (
            String::new(),
            law("joints = ['u', 'u.theta'], target = [0, 0, 0], kp = 1"),
            &["`forward.torque.joints[1]` names `u.theta` again", "name each joint or velocity once"],
        ),
        (String::new(), law("target = [1, 2], kp = 1"), &["must have 1 value, that of u.phi, found 2"]),
        (
            String::new(),
            law("target = { u = [1, 2] }, kp = 1"),
            &[
                "`forward.torque.target.u` stands for all of the joint, but is for u.phi only",
                "its own name: \"u.phi\" = 0",
            ],
        ),
        (
            String::new(),
            law("target = { 'u.theta' = 1 }, kp = 1"),
            &["`forward.torque.target` has nothing to do with `u.theta`", "name it among the `joints`"],
        ),
        (
            String::new(),
            law("joints = ['pivot.wx'], target = { 'pivot.wx' = 1 }, kp = 1"),
            &[
                "`pivot.wx` is a velocity: the orientation of the joint `pivot` is a quaternion",
                "as in pivot = { rpy =",
            ],
        ),
        (
            String::new(),
            law("joints = ['wrist.phi', 'wrist.psi'], target = { wrist = { rpy = [0, 1, 0] } }, kp = 1"),
            &["target.wrist` stands for all of the joint, but is for wrist.phi, wrist.psi only"],
        ),
        (
            String::new(),
            law("joints = ['pivot.qx'], target = [1], kp = 1"),
            &["`pivot.qx` is a coordinate of the joint `pivot`", "its velocities are pivot.wx, pivot.wy, pivot.wz"],
        ),
        (
            motion("joints = ['u.phi', 'pivot.wx'], from = [0, 0], speed = [1, 1]"),
            String::new(),
            &[
                "the trajectory prescribes `pivot.wx`, but the orientation of the joint `pivot` is a quaternion",
                "name the joint `pivot`",
            ],
        ),
        (
            motion(pivots),
            "prescribed = ['pivot.wx']\n".into(),
            &[
                "`prescribed` names `pivot.wx`, but the orientation of the joint `pivot` is a quaternion",
                "name the joint `pivot`",
            ],
        ),
        (
            motion(phi),
            "prescribed = ['u']\n".into(),
            &["`prescribed` names the velocity `u.theta`, for which the trajectory has no motion", "leave it out here"],
        ),
        (
            motion(phi),
            format!("prescribed = ['u.phi']\n{}", law("target = [0], kp = 1")),
            &[
                "no joint that is not prescribed has an actuator, so that the torque law drives nothing",
                "under `joints`",
            ],
        ),
        (
            motion(phi),
            format!("prescribed = ['u.phi']\n{}", law("joints = ['u'], target = [0, 0], kp = 1")),
            &["the velocity `u.phi` is prescribed, and the torque law drives it"],
        ),
        (
            motion("joints = ['u'], from = [0, 0], speed = [1, 1]"),
            computed.into(),
            &[
                "but the joint `u` has actuators for some of its velocities only",
                "as the `joints` of `[trajectory]` (u.phi)",
            ],
        ),
        (
            motion("joints = ['u.theta'], from = [0], speed = [1]"),
            computed.into(),
            &["moves what the trajectory prescribes, but the velocity `u.theta` has no actuator"],
        ),
        (
            motion(pivots),
            "torque = { law = 'tracking-pd', kp = 1, kd = 1 }\n".into(),
            &["no joint that the trajectory prescribes has an actuator, so that the torque law drives nothing"],
        ),
        (
            motion(phi),
            "torque = { law = 'tracking-pd', joints = ['u'], kp = 1, kd = 1 }\n".into(),
            &["the trajectory does not prescribe the velocity `u.theta` that the torque law drives"],
        ),
    ] {
        let shown = refused(&folder, &format!("{trajectory}{RUN}{forward}"));
        for fault in faults {
            assert!(shown.contains(fault), "{trajectory}{forward}: no {fault} in {shown}");
        }
        assert!(shown.contains("trial.toml:"), "{shown}");
    }
    fs::write(
        folder.join("trial.toml"),
        format!("model = 'model.toml'\n{}[inverse]\nend = 1\nstep = 0.1\n", motion(phi)),
    )
    .unwrap();
    let shown = fail(&folder, &["inverse", "trial.toml"], 1);
    assert!(shown.contains("the trajectory does not prescribe the velocity `u.theta`"), "{shown}");
}

#[test]
fn a_law_of_a_mechanism_without_actuators_is_refused() {
    let folder = scratch("per-velocity-none");
    universal(&folder, "actuated = false\n");
    let shown = refused(&folder, &format!("{RUN}torque = {{ law = 'pd', target = {{}}, kp = 1, kd = 1 }}\n"));
    assert!(shown.contains("no joint has an actuator, so that the torque law drives nothing"), "{shown}");
    assert!(shown.contains("name those that the law drives under `joints`"), "{shown}");
}
