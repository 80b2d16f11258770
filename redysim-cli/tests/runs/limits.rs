//! Numbers that are out of range are refused before the run, where they stand, with exit code 1.

use std::fs;
use std::time::{Duration, Instant};

use crate::common::{LIFT, SWING, refuses, refuses_in, scenario, scratch, succeed};

/// What is refused is not begun: reading takes a fraction of this, and what these scenarios ask for minutes or more.
const AT_ONCE: Duration = Duration::from_secs(10);

/// As [`refuses`] with the user's exit code, at once.
fn refuses_at_once(name: &str, command: &str, rest: &str, words: &[&str]) {
    let begun = Instant::now();
    refuses(name, command, rest, 1, words);
    assert!(begun.elapsed() < AT_ONCE, "{name} took {:?}", begun.elapsed());
}

/// Forward dynamics with these keys of `forward`, in the line 6.
fn with(settings: &str) -> String {
    format!("{SWING}{settings}\n")
}

#[test]
fn an_integer_of_more_than_64_bits_is_refused_where_it_stands() {
    let law = |kp: &str| with(&format!("torque = {{ law = 'p', target = [0, 0], kp = {kp} }}"));
    for (name, kp) in [
        ("decimal", "9223372036854775808"),
        ("negative", "-9223372036854775809"),
        ("long", "1000000000000000000000000000000000000000000"),
        ("hexadecimal", "0xffffffffffffffff"),
    ] {
        let words = ["`forward.torque.kp` is the integer", "64 bits", "with an exponent", "trial.toml:6:45"];
        refuses_at_once(name, "forward", &law(kp), &words);
    }
    let end = SWING.replace("end = 1.0", "end = 9300000000000000000");
    refuses_at_once("end", "forward", &end, &["`forward.end` is the integer", "as in 9.3e18", "trial.toml:4:7"]);
}

/// It would be copied into the results.
#[test]
fn a_number_beyond_toml_is_refused_also_where_the_run_does_not_look() {
    for (name, end) in [("unread-integer", "9223372036854775808"), ("unread-float", "1e400")] {
        let rest = format!("{SWING}[inverse]\nend = {end}\nstep = 1.0\n");
        refuses_at_once(
            name,
            "forward",
            &rest,
            &["not TOML", "overflowed", "from -2^63 to 2^63 - 1", "trial.toml:7:7"],
        );
    }
}

#[test]
fn the_largest_and_the_least_integer_of_64_bits_are_read() {
    let folder = scratch("limits-integers");
    // Velocities of the start, which inverse dynamics reads but does not need.
    for v in ["9223372036854775807", "-9223372036854775808"] {
        let rest = format!("{LIFT}[initial]\nv = [0, {v}]\n");
        succeed(&folder, &["inverse", &scenario(&folder, "two_link.toml", &rest), "-o", "run", "--force"]);
    }
}

#[test]
fn an_end_far_before_the_start_is_refused_like_any_other() {
    for (name, end) in [("int", "-9223372036854775808"), ("float", "-9.3e18"), ("far", "-1e99")] {
        let swing = SWING.replace("end = 1.0", &format!("end = {end}"));
        refuses_at_once(&format!("end-{name}"), "forward", &swing, &["must end after its start", "trial.toml:4:7"]);
    }
    let swing = SWING.replace("end = 1.0", "end = 9.3e18\nstart = 9.2e18");
    refuses_at_once("end-late", "forward", &swing, &["rows", "trial.toml:4:7"]);
}

#[test]
fn a_speed_that_turns_a_joint_farther_than_angles_are_resolved_is_refused() {
    let turn = |speed: &str, end: &str| {
        format!(
            "[trajectory]\nkind = 'constant-speed'\nfrom = [0, 0]\nspeed = [{speed}, 0]\n[inverse]\nend = {end}\nstep = 0.1\n"
        )
    };
    let words = ["joint `joint1`", "at most 1e9 rad", "1e-7 rad apart", "trial.toml:5:9"];
    refuses_at_once("speed", "inverse", &turn("9e18", "1.0"), &words);
    refuses_at_once("speed-end", "inverse", &turn("1e9", "1.1"), &["1.1e9 rad at t = 1.1 s", "trial.toml:5:9"]);
    let folder = scratch("limits-speed");
    succeed(&folder, &["inverse", &scenario(&folder, "two_link.toml", &turn("1e9", "1.0")), "-o", "run"]);
}

#[test]
fn closed_loops_are_not_followed_over_moves_that_lose_their_branch() {
    let turn = |speed: &str| {
        format!(
            "initial = {{ q = [0, 0.9844, 4.3144] }}\n[trajectory]\nkind = 'constant-speed'\nfrom = [0]\n\
             speed = [{speed}]\n[inverse]\nend = 0.1\nstep = 0.1\n"
        )
    };
    let folder = scratch("limits-loops");
    for (speed, words) in [("9e18", ["joint `crank`", "1e9 rad"]), ("1.1e4", ["joint `crank`", "over 1000.0 rad"])] {
        let begun = Instant::now();
        refuses_in(&folder, "inverse", &scenario(&folder, "fourbar.toml", &turn(speed)), 1, &words);
        assert!(begun.elapsed() < AT_ONCE, "{:?}", begun.elapsed());
    }
    succeed(&folder, &["inverse", &scenario(&folder, "fourbar.toml", &turn("1e2")), "-o", "run"]);
}

#[test]
fn a_start_too_fast_for_the_run_is_refused() {
    let start = |v: &str| SWING.replace("q = [0, 1]", &format!("q = [0, 1], v = [0, {v}]"));
    let words = ["joint `joint2` starts with 9e18 rad/s", "at most 1e9 rad", "trial.toml:2:"];
    refuses_at_once("start", "forward", &start("9e18"), &words);
}

#[test]
fn angles_of_too_many_turns_are_refused_wherever_they_stand() {
    let start = SWING.replace("[0, 1]", "[0, '1e12 deg']");
    refuses_at_once("angle", "forward", &start, &["`initial.q[1]`", "at most 1e9 rad", "trial.toml:2:21"]);
    // The warning of a number that looks like degrees advises nothing else.
    let start = SWING.replace("[0, 1]", "[0, 1e12]");
    refuses_at_once("number", "forward", &start, &["more than a whole turn", "= help: leave whole turns out\n"]);
    let law = with("torque = { law = 'p', target = { joint1 = '2e9 rad' }, kp = 1 }");
    refuses_at_once("target", "forward", &law, &["`forward.torque.target.joint1`", "trial.toml:6:"]);
    let folder = scratch("limits-table");
    fs::write(folder.join("motion.csv"), "t [s],q joint1 [rad],q joint2 [rad]\n0,0,0\n1,1e12,0\n").unwrap();
    let rest = "[trajectory]\nkind = 'csv'\nfile = 'motion.csv'\n[inverse]\nend = 1.0\nstep = 0.1\n";
    let path = scenario(&folder, "two_link.toml", rest);
    refuses_in(&folder, "inverse", &path, 1, &["joint `joint1`", "at most 1e9 rad"]);
    fs::write(folder.join("motion.csv"), "t [s],q joint1 [rad],q joint2 [rad]\n0,0,0\n1,1e300,0\n").unwrap();
    refuses_in(&folder, "inverse", &path, 1, &["motion.csv:3", "`q joint1 [rad]` is 1e300", "at most 1e100"]);
}

#[test]
fn a_motion_through_points_too_close_in_time_is_refused() {
    let rest = "[trajectory]\nkind = 'minimum-jerk'\ntimes = [0, 1e-99, 1]\npoints = [[0, 0], [1, 1], [0, 0]]\n\
                [inverse]\nend = 1.0\nstep = 0.1\n";
    refuses_at_once("points", "inverse", rest, &["joint `joint1`", "infinite or not a number"]);
}

#[test]
fn more_steps_of_integration_than_the_limit_are_refused() {
    for (name, settings, most) in [
        ("fixed", "method = 'Ode4', step = 1e-10", "at most 1e9"),
        ("adaptive", "method = 'Ode45', max_step = 1e-9", "at most 1e8"),
    ] {
        let rest = with(&format!("integrator = {{ {settings} }}"));
        refuses_at_once(name, "forward", &rest, &["step` of 1e-", most, "give a", "trial.toml:6:"]);
    }
}

#[test]
fn a_relative_tolerance_that_no_step_keeps_or_that_bounds_nothing_is_refused_where_it_stands() {
    let of = |rtol: &str| with(&format!("integrator = {{ method = \"Ode45\", rtol = {rtol} }}"));
    let place = "trial.toml:6:41";
    refuses_at_once(
        "rtol-small",
        "forward",
        &of("1e-30"),
        &["`rtol` is 1e-30", "no step", "between 2.2e-14 and", place],
    );
    refuses_at_once("rtol-large", "forward", &of("100"), &["`rtol` is 100.0", "as large as the motion", place]);
}
