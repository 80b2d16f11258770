//! The floating and legged robots are those of ReDySim's examples, number by number. `tests/reference/README.md` says where
//! these come from.

use redysim::generic::{JointKind, Mat3, Model};
use serde_json::Value;

/// A model, the example, and which of its two files.
const ROBOTS: [(&str, &str, &str); 6] = [
    // The file for forward dynamics has another first link.
    ("floating_three_link", "floating/3-link", "inputs_InvDyn"),
    ("floating_seven_link", "floating/7-link", "inputs_ForDyn"),
    ("floating_dual_arm", "floating/Dual Arm", "inputs_ForDyn"),
    ("walking_biped", "legged/Biped", "inputs_ForDyn"),
    ("quadruped", "legged/Quadruped", "inputs_ForDyn"),
    ("hexapod", "legged/Hexapod", "inputs_ForDyn"),
];

fn path(of: &str) -> String {
    format!("{}/{of}", env!("CARGO_MANIFEST_DIR"))
}

fn examples() -> Value {
    let text = std::fs::read_to_string(path("tests/reference/redysim_examples.json")).expect("it is there");
    serde_json::from_str(&text).expect("JSON")
}

/// The numbers of a key.
fn numbers(example: &Value, key: &str) -> Vec<f64> {
    let numbers = example[key].as_array().unwrap_or_else(|| panic!("no `{key}`"));
    numbers.iter().map(|number| number.as_f64().expect("a number")).collect()
}

/// The files print some numbers by 16 digits, others as quotients that are rounded: a rounding.
#[track_caller]
fn assert_equal(found: &[f64], expected: &[f64], what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= f64::EPSILON * expected.abs(), "{what}: {found:?}, not {expected:?}");
    }
}

#[test]
fn masses_lengths_and_inertias_of_the_floating_and_legged_robots_are_those_of_redysims_examples() {
    let examples = examples();
    for (name, example, file) in ROBOTS {
        let example = &examples[example][file];
        let model = Model::load(path(&format!("models/{name}.toml"))).expect("a good model").model;
        let of = |key: &str| numbers(example, key);
        let links = &model.links;
        let all = |number: fn(&redysim::generic::Link) -> f64| links.iter().map(number).collect::<Vec<f64>>();
        let same = |key: &str, found: &[f64]| assert_equal(found, &of(key), &format!("{name}: `{key}`"));
        same("g", &model.gravity.0);
        same("m", &all(|link| link.mass));
        same("dx", &all(|link| link.com.0[0]));
        same("dy", &all(|link| link.com.0[1]));
        same("Icxx", &all(|link| link.inertia.xx));
        same("Icyy", &all(|link| link.inertia.yy));
        same("Iczz", &all(|link| link.inertia.zz));
        same("Icxy", &all(|link| link.inertia.xy));
        same("Icyz", &all(|link| link.inertia.yz));
        same("Iczx", &all(|link| link.inertia.xz));
        same("bt", &all(|link| link.parent.map_or(0.0, |parent| parent as f64 + 1.0)));
        // Some are d cos 90°, which is 6e-17 d there.
        for (found, expected) in all(|link| link.com.0[2]).iter().zip(of("dz")) {
            assert!((found - expected).abs() <= 1e-16, "{name}: `dz`: {found:?}, not {expected:?}");
        }
        // Rx(alpha) Tx(a) Tz(b): a link is a from its parent along x, and b along its own z, turned by alpha about x. Which
        // angle is the zero of a joint the models choose.
        assert_eq!(links[0].joint, JointKind::Free, "{name}");
        for (i, link) in links.iter().enumerate().skip(1) {
            let [a, alpha, b] = ["a", "alp", "b"].map(|key| of(key)[i]);
            let (sin, cos) = alpha.sin_cos();
            let (place, Mat3(rows)) = (link.placement.position.0, link.placement.rotation);
            let close = |found: f64, expected: f64| (found - expected).abs() <= 1e-15;
            let expected = [a, -sin * b, cos * b];
            assert!((0..3).all(|k| close(place[k], expected[k])), "{name}, {}: {place:?}, not {expected:?}", link.name);
            let axis = [rows[0][2], rows[1][2], rows[2][2]];
            let expected = [0.0, -sin, cos];
            assert!((0..3).all(|k| close(axis[k], expected[k])), "{name}, {}: {axis:?}, not {expected:?}", link.name);
            assert!(link.joint == JointKind::Revolute && link.axis.0 == [0.0, 0.0, 1.0], "{name}, {}", link.name);
        }
    }
}

/// Stiffness, damping, leaving speed, friction and sliding damping.
#[test]
fn the_ground_of_the_legged_scenarios_is_that_of_redysims_examples() {
    let examples = examples();
    for (name, example, file) in &ROBOTS[3..] {
        let text = std::fs::read_to_string(path(&format!("scenarios/{name}.toml"))).expect("a scenario");
        let (_, contact) = text.split_once("[[contact]]").expect("a contact");
        let keys = ["stiffness", "damping", "leaving_speed", "friction", "sliding_damping"];
        let found = keys.map(|key| {
            let line = contact.lines().find_map(|line| line.strip_prefix(&format!("{key} = ")));
            line.expect("a line of this key").parse::<f64>().expect("a number")
        });
        assert_equal(&found, &numbers(&examples[*example][*file], "g_prop")[..5], name);
        // The second axis points up.
        assert!(text.contains("normal = [0, 1, 0]") && numbers(&examples[*example][*file], "g_prop")[5] == 2.0);
    }
}
