//! Every trajectory, torque law and integrator of a scenario, against closed forms.

use std::f64::consts::PI;
use std::fs;
use std::path::Path;

use crate::common::{AGAINST_CLOSED_FORMS, Table, call, deviation, fail, scenario, scratch, succeed};

/// The trajectory of two joints that a scenario's `trajectory` gives at the instants 0, 0.1, … 2 s, by rows of q, v, a.
fn prescribed(name: &str, trajectory: &str) -> Table {
    let folder = scratch(name);
    prescribed_in(&folder, trajectory)
}

fn prescribed_in(folder: &Path, trajectory: &str) -> Table {
    let rest = format!("[trajectory]\n{trajectory}\n[inverse]\nend = 2.0\nstep = 0.1\n");
    succeed(folder, &["inverse", &scenario(folder, "two_link.toml", &rest), "-o", "run"]);
    Table::csv(&folder.join("run/traj.csv"))
}

/// Compares the motion of the second joint with q, v, a as functions of time.
fn follows(found: &Table, expected: impl Fn(f64) -> [f64; 3]) {
    let names = ["q joint2 [rad]", "v joint2 [rad/s]", "a joint2 [rad/s^2]"];
    assert_eq!(found.rows.len(), 21);
    for (t, k) in found.column("t [s]").into_iter().zip(0..) {
        for (name, expected) in names.into_iter().zip(expected(t)) {
            let found = found.column(name)[k];
            assert!(
                (found - expected).abs() < 1e-13 * (1.0 + expected.abs()),
                "{name} at {t} s: {found}, not {expected}"
            );
        }
    }
}

#[test]
fn a_cycloid_is_meant_where_no_kind_is_named() {
    let found = prescribed("cycloid", "from = [0, '30 deg']\nto = [1, '90 deg']\nduration = 2.0");
    let way = PI / 3.0;
    follows(&found, |t| {
        let (sin, cos) = (PI * t).sin_cos();
        [PI / 6.0 + way * (t / 2.0 - sin / (2.0 * PI)), way * (1.0 - cos) / 2.0, way * PI * sin / 2.0]
    });
}

#[test]
fn a_constant_speed_is_constant() {
    let found = prescribed("constant-speed", "kind = 'constant-speed'\nfrom = [0, 0.5]\nspeed = [0, '-270 deg']");
    follows(&found, |t| [0.5 - 1.5 * PI * t, -1.5 * PI, 0.0]);
}

#[test]
fn least_jerk_is_the_polynomial_of_flash_and_hogan() {
    let found = prescribed("minimum-jerk", "kind = 'minimum-jerk'\ntimes = [0, 2]\npoints = [[0, 1], [0, 3]]");
    follows(&found, |t| {
        let s = t / 2.0;
        let q = 1.0 + 2.0 * s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s);
        [q, 30.0 * s * s * (1.0 - s) * (1.0 - s), 30.0 * s * (1.0 - s) * (1.0 - 2.0 * s)]
    });
}

/// Through points that are symmetric in time, at rest in the middle of their way back: two cubics at rest at three
/// points.
#[test]
fn a_cubic_passes_its_points() {
    let found = prescribed("cubic", "kind = 'cubic'\ntimes = [0, 1, 2]\npoints = [[0, 0], [0, 1], [0, 0]]");
    follows(&found, |t| {
        let (s, side) = if t < 1.0 { (t, 1.0) } else { (2.0 - t, -1.0) };
        [s * s * (3.0 - 2.0 * s), side * 6.0 * s * (1.0 - s), 6.0 - 12.0 * s]
    });
}

#[test]
fn a_table_of_states_is_passed_with_its_velocities_and_accelerations() {
    let folder = scratch("table-of-states");
    // A cubic has no fifth power: rows half a second apart determine it.
    let cubic = |t: f64| [t * t * t - t, 3.0 * t * t - 1.0, 6.0 * t];
    let mut text =
        "t [s],q joint2 [deg],v joint2 [rad/s],a joint2 [rad/s^2],q joint1 [rad],v joint1 [rad/s],a joint1 [rad/s^2]\n"
            .to_owned();
    for k in 0..=4 {
        let t = 0.5 * f64::from(k);
        let [q, v, a] = cubic(t);
        text += &format!("{t},{},{v},{a},0,0,0\n", q.to_degrees());
    }
    fs::write(folder.join("motion.csv"), text).unwrap();
    follows(&prescribed_in(&folder, "kind = 'csv'\nfile = 'motion.csv'"), cubic);
}

#[test]
fn results_are_a_trajectory_again() {
    let folder = scratch("results-again");
    let first = prescribed_in(&folder, "from = [0, 0]\nto = [1, 2]\nduration = 2.0");
    fs::rename(folder.join("run"), folder.join("first")).unwrap();
    let second = prescribed_in(&folder, "kind = 'csv'\nfile = 'first/traj.csv'");
    assert_eq!(first.rows, second.rows);
}

#[test]
fn a_table_of_coordinates_alone_is_passed_from_rest_to_rest() {
    let folder = scratch("table-of-coordinates");
    fs::write(folder.join("motion.csv"), "t [s],q joint1 [rad],q joint2 [rad]\n0,0,1\n2,0,3\n").unwrap();
    let found = prescribed_in(&folder, "kind = 'csv'\nfile = 'motion.csv'");
    let through = prescribed("through", "kind = 'minimum-jerk'\ntimes = [0, 2]\npoints = [[0, 1], [0, 3]]");
    assert_eq!(found.rows, through.rows);
}

/// Two points 50 µs apart have a speed of 20 rad/s, which carries a smooth motion far beyond all points in the seconds after.
#[test]
fn a_motion_that_swings_far_beyond_its_points_is_warned_of() {
    let folder = scratch("motions-swing");
    let warned = |times: &str, kind: &str| {
        let points = "[[0, 0], [1, 1], [1.001, 1], [0, 0]]";
        let rest = format!(
            "[trajectory]\nkind = '{kind}'\ntimes = {times}\npoints = {points}\n[inverse]\nend = 1.0\nstep = 0.5\n"
        );
        call(&folder, &["inverse", &scenario(&folder, "two_link.toml", &rest), "-o", "run", "--force"]).stderr
    };
    for kind in ["minimum-jerk", "cubic"] {
        let warning = warned("[0, 1, 1.00005, 5]", kind);
        let wanted =
            ["between t = 1.00005 s and 5.0 s", "at `joint1`, whose points are all from 0 to 1 rad", "leave some out"];
        assert!(wanted.iter().all(|part| warning.contains(part)), "{kind}: {warning}");
        assert_eq!(warned("[0, 1, 2, 5]", kind), "", "{kind}, at times that are even enough");
    }
    // A joint that stands still, but for noise.
    let noise = "[trajectory]\nkind = 'minimum-jerk'\ntimes = [0, 1, 1.00005, 5]\n\
                 points = [[0, 0.3], [0, 0.30000001], [0, 0.3], [0, 0.3]]\n[inverse]\nend = 1.0\nstep = 0.5\n";
    let run = call(&folder, &["inverse", &scenario(&folder, "two_link.toml", noise), "-o", "run", "--force"]);
    assert_eq!(run.stderr, "");
}

/// A slider of 2 kg on a table, no gravity along it: the equation of a mass alone.
const SLIDER: &str = "name = 'slider'\ngravity = [0, 0, -9.81]\n[[link]]\nname = 'mass'\nparent = 'base'\njoint = 'prismatic'\n\
                      axis = [1, 0, 0]\nmass = 2.0\n";

/// The motion of the slider by `forward`, from 1 m at rest unless `rest` has an `initial`.
fn slides(name: &str, forward: &str, rest: &str) -> Table {
    let folder = scratch(name);
    fs::write(folder.join("slider.toml"), SLIDER).unwrap();
    fs::write(folder.join("forces.csv"), "t [s],tau mass [N]\n0,0\n1,4\n2,4\n").unwrap();
    let text =
        format!("model = 'slider.toml'\ninitial = {{ q = [1] }}\n{rest}[forward]\nend = 2.0\nstep = 0.1\n{forward}\n");
    fs::write(folder.join("trial.toml"), text).unwrap();
    succeed(&folder, &["forward", "trial.toml", "-o", "run"]);
    Table::csv(&folder.join("run/statevar.csv"))
}

fn moves(found: &Table, most: f64, expected: impl Fn(f64) -> [f64; 2]) {
    let exact: Vec<Vec<f64>> = found.column("t [s]").into_iter().map(|t| expected(t).to_vec()).collect();
    let worst = deviation(&found.columns(1..3), &exact);
    assert!(worst < most, "off by {worst:e}");
}

#[test]
fn a_spring_swings() {
    let found = slides("p", &format!("{AGAINST_CLOSED_FORMS}torque = {{ law = 'p', target = [0], kp = 8 }}"), "");
    moves(&found, 1e-10, |t| [(2.0 * t).cos(), -2.0 * (2.0 * t).sin()]);
}

#[test]
fn a_damped_spring_swings_out() {
    let law = "torque = { law = 'pd', target = [0.5], kp = [10], kd = { mass = 8 } }";
    let found = slides("pd", &format!("{AGAINST_CLOSED_FORMS}{law}"), "");
    // 2 ẍ + 8 ẋ + 10 (x − 1/2) = 0: the roots are −2 ± i.
    moves(&found, 1e-10, |t| {
        let ((sin, cos), decay) = (t.sin_cos(), (-2.0 * t).exp());
        [0.5 + 0.5 * decay * (cos + 2.0 * sin), -2.5 * decay * sin]
    });
}

/// The target runs ahead at 1 m/s from 1 m: the error obeys the same equation.
const AHEAD: &str = "trajectory = { kind = 'constant-speed', from = [1], speed = [1] }\n";

/// From rest, 1 m/s too slow: the error is exp(−2 t) sin t.
fn catches_up(t: f64) -> [f64; 2] {
    let ((sin, cos), decay) = (t.sin_cos(), (-2.0 * t).exp());
    [1.0 + t - decay * sin, 1.0 - decay * (cos - 2.0 * sin)]
}

#[test]
fn a_tracking_law_follows() {
    let found = slides(
        "tracking",
        &format!("{AGAINST_CLOSED_FORMS}torque = {{ law = 'tracking-pd', kp = 10, kd = 8 }}"),
        AHEAD,
    );
    moves(&found, 1e-10, catches_up);
}

#[test]
fn computed_torque_leaves_its_own_equation_whatever_the_mass() {
    let found = slides(
        "computed",
        &format!("{AGAINST_CLOSED_FORMS}torque = {{ law = 'computed-torque', kp = 5, kd = 4 }}"),
        AHEAD,
    );
    moves(&found, 1e-10, catches_up);
}

#[test]
fn forces_of_a_table_lie_on_straight_lines_between_its_rows() {
    let found = slides("forces", &format!("{AGAINST_CLOSED_FORMS}torque = {{ law = 'csv', file = 'forces.csv' }}"), "");
    // 4 t N on 2 kg for a second, then 4 N.
    moves(&found, 1e-9, |t| match t - 1.0 {
        more if more > 0.0 => [1.0 + 1.0 / 3.0 + more + more * more, 1.0 + 2.0 * more],
        _ => [1.0 + t.powi(3) / 3.0, t * t],
    });
}

/// The error of a swing of 2 rad/s by an integrator: the largest of the rows each 0.1 s, and that of the last.
fn swing_error(method: &str, settings: &str) -> (f64, f64) {
    let name = if method.parse::<u8>().is_ok() { method.to_owned() } else { format!("'{method}'") };
    let law = "torque = { law = 'p', target = [0], kp = 8 }";
    let scratch = format!("by-{method}-{}", settings.replace([' ', '='], ""));
    let found = slides(&scratch, &format!("integrator = {{ method = {name}, {settings} }}\n{law}"), "");
    let exact = |t: f64| vec![(2.0 * t).cos(), -2.0 * (2.0 * t).sin()];
    let exact: Vec<Vec<f64>> = found.column("t [s]").into_iter().map(exact).collect();
    let (found, last) = (found.columns(1..3), exact.len() - 1);
    (deviation(&found, &exact), deviation(&found[last..], &exact[last..]))
}

#[test]
fn integrators_with_steps_of_one_size_have_their_orders() {
    let orders = [
        ("SemiImplicitEuler", 1),
        ("Euler", 1),
        ("Ode4", 4),
        ("Ode5", 5),
        ("2", 5),
        ("Dop8", 8),
        ("Gauss4", 4),
        ("Gauss6", 6),
    ];
    for (method, order) in orders {
        let step = if order == 8 { 0.4 } else { 0.1 };
        let [long, short] = [step, step / 2.0].map(|step| swing_error(method, &format!("step = {step}")).1);
        let found = (long / short).log2();
        println!("{method}: {long:.1e} {short:.1e}, order {found:.2}");
        assert!((found - f64::from(order)).abs() < 0.5, "{method}: order {found:.2}");
    }
}

#[test]
fn rows_between_the_ends_of_steps_lose_at_most_one_order() {
    let within = [("Ode4", 3, 0.06), ("Ode5", 4, 0.06), ("Dop8", 7, 0.24), ("Gauss4", 4, 0.06), ("Gauss6", 6, 0.12)];
    for (method, order, step) in within {
        let [long, short] = [step, step / 2.0].map(|step| swing_error(method, &format!("step = {step}")).0);
        let found = (long / short).log2();
        println!("{method}: {long:.1e} {short:.1e}, order {found:.2}");
        assert!(found > f64::from(order) - 0.35, "{method}: order {found:.2}");
    }
}

/// Two links that fall from the horizontal. `energy_drift` is the largest at a row or the end of a step.
#[test]
fn rows_between_the_ends_of_steps_of_gauss_do_not_add_to_the_drift() {
    let folder = scratch("gauss-rows");
    let drift = |rows: f64| -> f64 {
        let rest = format!("[forward]\nend = 2.0\nstep = {rows}\nintegrator = {{ method = 'Gauss6', step = 0.01 }}\n");
        let run = call(&folder, &["forward", &scenario(&folder, "two_link.toml", &rest), "-o", "run", "--force"]);
        assert_eq!((run.code, run.stderr.as_str()), (0, ""), "{}", run.output());
        let text = std::fs::read_to_string(folder.join("run/run.toml")).expect("it is written");
        let line = text.lines().find_map(|line| line.strip_prefix("energy_drift = ")).expect("it is there");
        line.parse().expect("a number")
    };
    let (ends, within) = (drift(0.01), drift(0.007));
    println!("rows each 10 ms: {ends:e} J, each 7 ms: {within:e} J");
    assert!(ends > 1e-12 && within < 3.0 * ends, "{within:e} J between the ends, {ends:e} J at them");
}

#[test]
fn integrators_with_steps_from_tolerances_stay_within_them() {
    for method in ["Ode45", "Dop853", "Ode15s", "Radau5", "0", "1"] {
        let [loose, tight] =
            ["rtol = 1e-5, atol = 1e-5", "rtol = 1e-9, atol = 1e-9"].map(|set| swing_error(method, set).0);
        println!("{method}: {loose:.1e} {tight:.1e}");
        // An error per step adds up over the some four radians of the swing.
        assert!(loose < 40.0 * 1e-5 && tight < 40.0 * 1e-9 && tight > 0.0, "{method}: {loose:e} {tight:e}");
    }
}

#[test]
fn each_kind_of_component_has_its_own_absolute_tolerance() {
    let law = "torque = { law = 'p', target = [0], kp = 8 }";
    let error = |name: &str, atol: &str| {
        let found =
            slides(name, &format!("integrator = {{ method = 'Ode45', rtol = 1e-13, atol = {atol} }}\n{law}"), "");
        let exact: Vec<Vec<f64>> = found.column("t [s]").into_iter().map(|t| vec![(2.0 * t).cos()]).collect();
        deviation(&found.columns(1..2), &exact)
    };
    let [tight, uniform] = [error("atol-tight", "1e-11"), error("atol-uniform", "1e-3")];
    let apart = error("atol-apart", "{ position = 1e-11, velocity = 1e-11, work = 1e-3 }");
    assert!(tight < 1e-9 && uniform > 1e-6, "{tight:e} {uniform:e}");
    // The energy is of no use to the motion: it asks for smaller steps only where it is to be exact.
    assert!(apart < 1e-9, "{apart:e}");
    let loose = error("atol-loose", "{ position = 1e-3, velocity = 1e-3, work = 1e-11 }");
    assert!(loose < 1e-6, "the work alone keeps the steps small: {loose:e}");
}

#[test]
fn energy_is_what_the_actuators_give() {
    slides("work", &format!("{AGAINST_CLOSED_FORMS}torque = {{ law = 'csv', file = 'forces.csv' }}"), "");
    let energy = Table::csv(&Path::new(env!("CARGO_TARGET_TMPDIR")).join("work/run/energy.csv"));
    // 3 m/s at the end: 9 J.
    let last = |name: &str| *energy.column(name).last().unwrap();
    assert!((last("work [J]") - 9.0).abs() < 1e-8, "{}", last("work [J]"));
    assert!((last("kinetic [J]") - 9.0).abs() < 1e-8);
    assert!(last("drift [J]").abs() < 1e-8);
}

/// Two sliders on one another, of which the second has no actuator.
fn passive(name: &str, law: &str) -> (Table, String) {
    let folder = scratch(name);
    let second = "[[link]]\nname = 'passive'\nparent = 'mass'\njoint = 'prismatic'\naxis = [0, 1, 0]\nmass = 1.0\n\
                  actuated = false\n";
    fs::write(folder.join("model.toml"), format!("{SLIDER}{second}")).unwrap();
    let text = format!(
        "model = 'model.toml'\ntrajectory = {{ kind = 'constant-speed', from = [1, 1], speed = [1, 1] }}\n\
         [forward]\nend = 1.0\nstep = 0.1\ntorque = {{ {law} }}\n"
    );
    fs::write(folder.join("trial.toml"), text).unwrap();
    let run = call(&folder, &["forward", "trial.toml", "-o", "run"]);
    assert_eq!(run.code, 0, "{}", run.output());
    (Table::csv(&folder.join("run/tor.csv")), run.stderr)
}

#[test]
fn a_tracking_law_drives_what_has_an_actuator() {
    let (forces, output) = passive("tracking-passive", "law = 'tracking-pd', kp = 10, kd = 8");
    assert!(forces.column("tau passive [N]").iter().all(|force| *force == 0.0) && output.is_empty(), "{output}");
    assert!(forces.column("tau mass [N]").iter().any(|force| *force > 1.0));
}

#[test]
fn a_spring_at_a_joint_without_actuator_is_warned_of() {
    let (forces, output) = passive("spring-passive", "law = 'p', joints = ['passive'], target = [1], kp = 10");
    assert!(output.contains("drives the joint `passive`, which has no actuator") && output.contains("^"), "{output}");
    assert!(forces.column("tau passive [N]").iter().any(|force| *force > 1.0));
}

#[test]
fn computed_torque_is_refused_where_joints_of_a_tree_have_no_actuator() {
    let folder = scratch("computed-passive");
    fs::write(folder.join("slider.toml"), format!("{SLIDER}actuated = false\n")).unwrap();
    let law = "torque = { law = 'computed-torque', kp = 1, kd = 1 }";
    let text = format!("model = 'slider.toml'\n{AHEAD}[forward]\nend = 1.0\nstep = 0.1\n{law}\n");
    fs::write(folder.join("trial.toml"), text).unwrap();
    let output = fail(&folder, &["forward", "trial.toml", "-o", "run"], 1);
    assert!(output.contains("the joint `mass` has no actuator") && output.contains("tracking-pd"), "{output}");
}
