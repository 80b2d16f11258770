//! What is odd about a URDF: the first twenty warnings or errors, and what they advise.

use super::faults::BODY;
use super::{LOSSY, close, folder_with, import, import_from, pendulum};
use crate::common::{Run, call};
use redysim_model::JointRange;
use redysim_runtime::MassMatrix;

#[test]
fn rounded_quarter_turns_are_exact_where_asked_for() {
    let (mechanism, run) = import(LOSSY, &["--quarter-turns"]);
    assert_eq!(mechanism.model().links[0].placement.rotation.0[2], [-1.0, 0.0, 0.0]);
    assert!(run.stderr.contains("1 angle made a multiple of 90°, changed by 3.7e-6 rad at most"), "{}", run.stderr);
    assert!(!run.stderr.contains("1.5708 rad"), "{}", run.stderr);
}

#[test]
fn warnings_of_rounded_quarter_turns_name_the_option_that_makes_them_exact() {
    let (_, run) = import(LOSSY, &[]);
    assert!(run.stderr.contains("1.5708 rad") && run.stderr.contains("help: --quarter-turns makes"), "{}", run.stderr);
    let (_, run) = import(LOSSY, &["--quarter-turns"]);
    assert!(!run.stderr.contains("--quarter-turns makes"), "{}", run.stderr);
    let shown = call(&folder_with(LOSSY), &["show", "robot.urdf", "-o", "page.html"]);
    assert!(shown.stderr.contains("`redysim import --quarter-turns` makes"), "{}", shown.stderr);
}

/// Imports the pendulum with a chain of `count` links, each with `body`, at its end.
fn import_chain(count: usize, body: &str) -> Run {
    let link = |k: usize| {
        let parent = if k == 0 { "rod".into() } else { format!("part{}", k - 1) };
        format!(
            "<link name=\"part{k}\">{body}</link><joint name=\"joint{k}\" type=\"continuous\">\
             <parent link=\"{parent}\"/><child link=\"part{k}\"/></joint>\n"
        )
    };
    let links: String = (0..count).map(link).collect();
    import_from(&folder_with(pendulum("", BODY).replace("</robot>", &(links + "</robot>"))), &[])
}

#[test]
fn of_very_many_errors_of_a_urdf_the_first_20_are_shown() {
    let faulty = BODY.replace("<mass value=\"", "<mass value=\"-");
    assert_ne!(faulty, BODY);
    let run = import_chain(50, &faulty);
    assert_eq!((run.code, run.stderr.matches("error: ").count()), (1, 20), "{}", run.stderr);
    assert!(run.stderr.ends_with("\nand 30 more errors\n"), "{}", run.stderr);
}

#[test]
fn of_very_many_warnings_of_a_urdf_the_first_20_are_shown() {
    let odd = "<inertial><mass value=\"1\"/><inertia ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.1\" iyz=\"0\" izz=\"0.3\"/></inertial>";
    let run = import_chain(21, odd);
    assert_eq!((run.code, run.stderr.matches("warning: link `part").count()), (0, 20), "{}", run.stderr);
    assert!(run.stderr.contains("\nand 1 more warning\n"), "{}", run.stderr);
}

/// The antennas of Tiago, as its makers publish them: their products of inertia exceed what their moments permit.
#[test]
fn a_negative_moment_of_a_small_part_is_a_warning() {
    let antenna = "<inertial><mass value=\"0.000001\"/><inertia ixx=\"2.371e-8\" ixy=\"6.119e-8\" ixz=\"1.179e-8\" \
                   iyy=\"2.833e-8\" iyz=\"0.774e-8\" izz=\"3.849e-8\"/></inertial>";
    for carrier in ["world", "rod"] {
        let fixed = format!(
            "<link name=\"antenna\">{antenna}</link><joint name=\"mount\" type=\"fixed\">\
             <parent link=\"{carrier}\"/><child link=\"antenna\"/></joint></robot>"
        );
        let urdf = pendulum("", BODY).replace("</robot>", &fixed);
        let (mechanism, run) = import(&urdf, &[]);
        assert_eq!(mechanism.model().links.len(), 2);
        assert!(run.stderr.contains("link `antenna`: `inertia` has a negative principal moment"), "{}", run.stderr);
        assert!(mechanism.mass_matrix(&vec![0.3])[0][0] > 0.0);
    }
}

/// As a program writes zero: no body has products of inertia without moments, but this one is meant to have none.
#[test]
fn an_inertia_of_roundoff_is_left_out() {
    let inertial = "<inertial><origin xyz=\"0 0.2 0\"/><mass value=\"1.5\"/><inertia ixx=\"0\" iyy=\"0\" izz=\"0\" ixy=\"0\" \
                    ixz=\"1.4e-20\" iyz=\"0\"/></inertial>";
    let (mechanism, run) = import(&pendulum("", inertial), &[]);
    assert_eq!(mechanism.model().links[0].inertia, Default::default());
    assert!(run.stderr.contains("the inertia of link `rod` is roundoff"), "{}", run.stderr);
    assert!(close(mechanism.mass_matrix(&vec![1.0])[0][0], 1.5 * 0.2 * 0.2));
}

#[test]
fn limits_are_a_range_with_the_acceleration_that_the_urdf_has() {
    let urdf = pendulum("<limit lower=\"-1\" upper=\"2\" effort=\"40\" velocity=\"3\" acceleration=\"7\"/>", BODY);
    let urdf = urdf.replace("<robot", "<robot version=\"1.2\"").replace("continuous", "revolute");
    let (mechanism, _) = import(&urdf, &[]);
    let range = mechanism.model().links[0].range[0];
    assert_eq!((range.position, range.velocity, range.acceleration), ([-1.0, 2.0], 3.0, Some(7.0)));
    assert_eq!(range.force, Some(40.0));
    let (mechanism, _) = import(&urdf.replace(" acceleration=\"7\"", ""), &[]);
    assert_eq!(mechanism.model().links[0].range[0], JointRange { acceleration: None, ..range });
}

/// What makes no sense is not dropped either.
#[test]
fn limits_whose_lower_one_is_not_below_the_upper_are_kept_as_they_are() {
    let urdf = pendulum("<limit lower=\"2\" upper=\"1\" effort=\"-10\" velocity=\"3\"/>", BODY);
    let (_, run) = import(&urdf.replace("continuous", "revolute"), &[]);
    let kept = "# limit: lower = 2 rad, upper = 1 rad, effort = -10 N m, velocity = 3 rad/s; \
                the lower one is not below the upper";
    assert!(run.stdout.contains(kept), "{}", run.stdout);
    let lost = "has no range here: its lower limit, 2 rad, is above its upper one, 1 rad";
    let warned = run.stderr.lines().any(|line| line.starts_with("warning: joint") && line.contains(lost));
    assert!(warned, "{}", run.stderr);
}

#[test]
fn what_of_a_urdf_is_probably_misspelled_or_impossible_is_warned_of() {
    let warned = |urdf: &str, wanted: &[&str]| {
        let (_, run) = import(urdf, &[]);
        let warnings: Vec<&str> = run.stderr.lines().filter(|line| line.starts_with("warning: ")).collect();
        for part in wanted {
            assert!(warnings.iter().any(|line| line.contains(part)), "no `{part}` in: {}", run.stderr);
        }
        assert_eq!(warnings.len(), wanted.len(), "{}", run.stderr);
    };
    let limit = |limit: &str| pendulum(limit, BODY).replace("continuous", "revolute");
    warned(&limit("<limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"3\"/>"), &[]);
    warned(
        &limit("<limit lowr=\"-1\" upper=\"1\" effort=\"1\" velocity=\"3\"/><axsi xyz=\"0 1 0\"/>"),
        &["<limit> has the unknown attribute `lowr`: did you mean `lower`?", "<axsi> is unknown: did you mean <axis>?"],
    );
    warned(
        &limit("<limit effort=\"-10\" velocity=\"3\"/>"),
        &["has no range here: its limit of effort is -10, which is negative"],
    );
    warned(&limit("<limit effort=\"1\" velocity=\"-3\"/>"), &["its limit of velocity is -3, which is negative"]);
    for (joint, why) in [("nobody", "no joint has this name"), ("hinge", "a joint cannot mimic itself")] {
        let found = format!(
            "joint `hinge` mimics `{joint}` in the URDF (1 times its value, plus 0 rad), but {why}: it is free"
        );
        warned(&limit(&format!("<mimic joint=\"{joint}\"/>")), &[&found]);
    }
}
