//! A file that is not a robot is refused with one clear message and its line, and leaves no file behind.

use super::{folder_with, import_from};
use crate::common::{fail, names};

/// The inertial of a link.
pub const BODY: &str =
    "<inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial>";

/// Links a, b, c with bodies on lines 2 to 4, then these joints (name, parent, child) from line 5.
fn robot(joints: &[[&str; 3]]) -> String {
    let link = |name: &str| format!("<link name=\"{name}\">{BODY}</link>\n");
    let joint = |[name, parent, child]: &[&str; 3]| {
        format!(
            "<joint name=\"{name}\" type=\"continuous\"><parent link=\"{parent}\"/><child link=\"{child}\"/></joint>\n"
        )
    };
    let (links, joints): (String, String) = (["a", "b", "c"].map(link).concat(), joints.iter().map(joint).collect());
    format!("<robot name=\"r\">\n{links}{joints}</robot>\n")
}

pub fn refused(urdf: &str, wanted: &[&str]) {
    let folder = folder_with(urdf);
    let run = import_from(&folder, &["-o", "robot.toml"]);
    assert_eq!((run.code, run.stdout.as_str()), (1, ""), "{}", run.stderr);
    for wanted in wanted {
        assert!(run.stderr.contains(wanted), "`{wanted}` in:\n{}", run.stderr);
    }
    assert_eq!(run.stderr.matches("error:").count(), 1, "{}", run.stderr);
    assert_eq!(names(&folder), ["robot.urdf"], "no file is left");
}

#[test]
fn a_chain_is_accepted() {
    let run = import_from(&folder_with(robot(&[["j", "a", "b"], ["k", "b", "c"]])), &[]);
    assert_eq!(run.code, 0, "{}", run.stderr);
}

#[test]
fn broken_xml_is_shown_where_it_breaks() {
    refused("<robot name=\"r\">\n<link name=\"a\">\n</robot>", &["robot.urdf:3:", "XML", "'link'"]);
    refused("", &["robot.urdf:1:1", "XML"]);
    refused("no XML at all", &["robot.urdf:1:1", "XML"]);
    refused("<sdf>\n<model/></sdf>", &["robot.urdf:1:", "<sdf>", "not a <robot>"]);
}

#[test]
fn loops_circles_and_several_roots_are_refused() {
    refused(
        &robot(&[["j", "a", "b"], ["k", "a", "c"], ["l", "b", "c"]]),
        &["robot.urdf:7:", "link `c`", "`k` and `l`"],
    );
    refused(&robot(&[["j", "a", "b"]]), &["robot.urdf:4:", "2 roots: `a`, `c`"]);
    refused(&robot(&[["j", "a", "b"], ["k", "b", "c"], ["l", "c", "a"]]), &["no link is the root", "circle"]);
    refused(&robot(&[["j", "b", "c"], ["k", "c", "b"]]), &["robot.urdf:3:", "link `b` hangs on itself"]);
}

#[test]
fn an_unknown_or_repeated_name_is_refused() {
    refused(&robot(&[["j", "a", "b"], ["k", "bb", "c"]]), &["robot.urdf:6:", "joint `k`: unknown link `bb`"]);
    refused(&robot(&[["j", "a", "b"], ["j", "b", "c"]]), &["robot.urdf:6:", "two joints of the name `j`"]);
    let twice = robot(&[["j", "a", "b"], ["k", "b", "c"]]).replace("<link name=\"c\">", "<link name=\"b\">");
    refused(&twice, &["robot.urdf:4:", "two links of the name `b`"]);
    refused(
        &robot(&[["j", "a", "b"]]).replace("<link name=\"b\">", "<link>"),
        &["robot.urdf:3:", "a <link> has no `name`"],
    );
}

#[test]
fn what_is_not_a_number_is_refused_where_a_number_is_due() {
    let good = robot(&[["j", "a", "b"], ["k", "b", "c"]]);
    let with = |from: &str, to: &str| good.replacen(from, to, 1);
    refused(&with("value=\"1\"", "value=\"one\""), &["robot.urdf:2:", "link `a`", "`value` of its <mass>", "\"one\""]);
    refused(&with("value=\"1\"", "value=\"inf\""), &["robot.urdf:2:", "a finite number"]);
    refused(&with("<mass value=\"1\"/>", ""), &["robot.urdf:2:", "its <inertial> has no <mass>"]);
    refused(&with("iyy=\"1\" ", ""), &["robot.urdf:2:", "its <inertia> has no `iyy`"]);
    refused(
        &with("</joint>", "<axis xyz=\"0 0\"/></joint>"),
        &["robot.urdf:5:", "joint `j`", "3 finite numbers", "\"0 0\""],
    );
    refused(&with("</joint>", "<origin rpy=\"0 0 0 x\"/></joint>"), &["robot.urdf:5:", "`rpy` of its <origin>"]);
    refused(&with(" type=\"continuous\"", ""), &["robot.urdf:5:", "no `type`"]);
    refused(
        &with("continuous", "helical"),
        &["robot.urdf:5:", "joint `j`: its `type` cannot be `helical`", "continuous, prismatic"],
    );
}

#[test]
fn what_is_not_a_number_is_refused_in_limits_and_mimics() {
    let good = robot(&[["j", "a", "b"], ["k", "b", "c"]]);
    // Joint k is on line 6; what is added to it stands on the next.
    let with = |inside: &str| good.replace("<child link=\"c\"/>", &format!("<child link=\"c\"/>\n{inside}"));
    let wrong = [
        (
            "<mimic joint=\"j\" multiplier=\"abc\"/>",
            "`multiplier` of its <mimic> must be a finite number, found \"abc\"",
        ),
        ("<mimic joint=\"j\" offset=\"inf\"/>", "`offset` of its <mimic> must be a finite number, found \"inf\""),
        ("<mimic multiplier=\"2\"/>", "its <mimic> has no `joint`"),
        ("<limit velocity=\"1\" effort=\"nan\"/>", "`effort` of its <limit> must be a number, found \"nan\""),
        ("<limit velocity=\"fast\"/>", "`velocity` of its <limit> must be a number, found \"fast\""),
        ("<limit lower=\"\"/>", "`lower` of its <limit> must be a number, found \"\""),
        ("<limit velocity=\"1\" jerk=\"x\"/>", "`jerk` of its <limit> must be a number, found \"x\""),
    ];
    for (inside, reason) in wrong {
        refused(&with(inside), &["robot.urdf:7: joint `k`: ", reason]);
    }
}

#[test]
fn an_infinite_limit_is_accepted() {
    let limit = "<limit lower=\"-inf\" upper=\"inf\" effort=\"inf\" velocity=\"3\"/></joint>";
    let good = robot(&[["j", "a", "b"], ["k", "b", "c"]]);
    let run = import_from(&folder_with(good.replacen("</joint>", limit, 1)), &[]);
    assert!(run.code == 0 && run.stdout.contains("velocity = 3 rad/s; a `range`"), "{} {}", run.stdout, run.stderr);
}

#[test]
fn a_second_element_of_what_may_stand_once_is_refused() {
    let good = robot(&[["j", "a", "b"], ["k", "b", "c"]]);
    let twice = good.replacen("</link>", &format!("\n{BODY}</link>"), 1);
    refused(&twice, &["robot.urdf:3:", "link `a`: its <link> has a second <inertial>", "keep one"]);
    let twice = good.replacen("</inertial>", "\n<mass value=\"2\"/></inertial>", 1);
    refused(&twice, &["robot.urdf:3:", "link `a`: its <inertial> has a second <mass>"]);
    for (tag, element) in [
        ("axis", "<axis xyz=\"0 0 1\"/>"),
        ("origin", "<origin/>"),
        ("limit", "<limit velocity=\"1\"/>"),
        ("mimic", "<mimic joint=\"j\"/>"),
        ("child", ""),
    ] {
        let again = if tag == "child" { "<child link=\"b\"/>" } else { element };
        let twice = good.replacen("</joint>", &format!("{element}\n{again}</joint>"), 1);
        refused(&twice, &["robot.urdf:6:", &format!("joint `j`: its <joint> has a second <{tag}>")]);
    }
}

#[test]
fn impossible_values_are_shown_with_their_line() {
    let good = robot(&[["j", "a", "b"], ["k", "b", "c"]]);
    let heavy =
        good.replace("<link name=\"c\"><inertial><mass value=\"1\"", "<link name=\"c\"><inertial><mass value=\"-1\"");
    refused(&heavy, &["robot.urdf:4:", "link `c`: `mass` is -1.0 kg, which is negative"]);
    refused(&good.replacen("</joint>", "<axis xyz=\"0 0 0\"/></joint>", 1), &["robot.urdf:5:", "joint `j`", "`axis`"]);
    refused(&good.replace("continuous", "fixed"), &["every joint is fixed"]);
    refused(&format!("<robot name=\"r\"><link name=\"a\">{BODY}</link></robot>"), &["no joints"]);
    refused("<robot name=\"r\"/>", &["no links"]);
    refused("<?xml version=\"1.0\"?>\n<robot name=\"r\"/>", &["robot.urdf:2:", "no links"]);
}

/// Deep nesting must not exhaust the stack, wherever it stands.
#[test]
fn deeply_nested_elements_do_no_harm() {
    let deep = format!("{}{}", "<a>".repeat(100_000), "</a>".repeat(100_000));
    let good = robot(&[["j", "a", "b"], ["k", "b", "c"]]);
    for inside in ["</robot>", "</link>", "</inertial>", "</joint>"] {
        let run = import_from(&folder_with(good.replacen(inside, &format!("{deep}{inside}"), 1)), &[]);
        assert!(run.code == 0 && run.stderr.contains("left out: <a>"), "{inside}: {} {}", run.code, run.stderr);
    }
}

#[test]
fn a_file_with_xacro_macros_is_refused_until_they_are_expanded() {
    let urdf = "<robot name=\"r\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">\n<xacro:arm/></robot>";
    refused(urdf, &["robot.urdf:2:", "<xacro:arm>", "expand it first"]);
    let without_namespace = "<robot name=\"r\">\n<xacro:arm/></robot>";
    refused(without_namespace, &["robot.urdf:2:", "'xacro'", "expand it first"]);
    let variable = robot(&[["j", "a", "b"], ["k", "b", "c"]]).replacen("<mass value=\"1\"", "<mass value=\"${m}\"", 1);
    refused(&variable, &["must be a finite number, found \"${m}\"", "expand it first"]);
}

#[test]
fn a_file_that_is_not_utf8_is_refused_as_such() {
    let folder = folder_with(b"<robot name=\"\xff\"/>");
    let run = import_from(&folder, &[]);
    assert!(run.code == 1 && run.stderr.contains("not UTF-8 (byte 14)"), "{}", run.stderr);
    fail(&folder, &["import", "nowhere.urdf"], 3);
}
