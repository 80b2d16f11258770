//! A locked joint is a fixed joint, whoever locks it.

use redysim_model::{LockError, Model};

fn text(name: &str) -> String {
    std::fs::read_to_string(format!("{}/../models/{name}.toml", env!("CARGO_MANIFEST_DIR"))).unwrap()
}

fn loaded(text: &str, options: &str) -> Model {
    Model::from_toml_with(text, "test.toml", options).unwrap_or_else(|faults| panic!("{faults}")).model
}

/// KR5 with its third and sixth joints written as fixed ones.
fn written() -> String {
    let links = text("kr5").replace("\r\n", "\n");
    let fix = |text: &str, link: &str, theta: &str| {
        let (before, after) = text.split_once(&format!("name = \"{link}\"")).unwrap();
        let after = after.replacen("revolute", "fixed", 1).replacen("theta = \"0 deg\"", theta, 1);
        format!("{before}name = \"{link}\"{after}")
    };
    fix(&fix(&links, "link6", "theta = \"30 deg\""), "link3", "theta = -0.2")
}

#[test]
fn a_locked_joint_is_a_fixed_joint_at_its_place() {
    let expected = loaded(&written(), "");
    assert_eq!(expected.dof(), 4);
    assert_eq!(loaded(&text("kr5"), "locked = { joint6 = '30 deg', link3 = -0.2 }"), expected);
    assert_eq!(loaded(&text("kr5"), "").locked(&[("joint3", -0.2), ("joint6", 30_f64.to_radians())]), Ok(expected));
}

#[test]
fn a_prismatic_joint_is_locked_at_a_length() {
    let free = loaded(&text("test/gantry"), "");
    let locked = free.locked(&[("along", 0.3), ("boom", -0.1)]).unwrap();
    assert_eq!(locked, loaded(&text("test/gantry"), "locked = { carriage = 0.3, boom = -0.1 }"));
    for (name, travel) in [("carriage", 0.3), ("boom", -0.1)] {
        let [free, locked] = [&free, &locked].map(|model| model.links.iter().find(|link| link.name == name).unwrap());
        let along = free.placement.rotation * free.axis.scale(free.offset + travel);
        let off = (locked.placement.position - free.placement.position - along).0;
        assert!(off.iter().all(|x| x.abs() < 1e-15), "{name}: {off:?}");
    }
}

#[test]
fn options_beside_the_file_take_precedence() {
    let in_file =
        text("kr5").replace("[[link]]\nname = \"link1\"", "locked = { joint6 = 0 }\n[[link]]\nname = \"link1\"");
    assert_eq!(loaded(&in_file, "").dof(), 5);
    assert_eq!(loaded(&in_file, "locked = { joint1 = 0, joint2 = 0 }").dof(), 4);
    assert_eq!(loaded(&in_file, "locked = {}").dof(), 6);
}

/// What only the free joint would be blamed for is no fault of the locked one.
#[test]
fn checks_are_made_on_the_locked_model() {
    let leaf = text("fail/massless_leaf");
    assert!(Model::from_toml(leaf.clone(), "test.toml").is_err());
    assert_eq!(loaded(&leaf, "locked = { hand = 0.1, finger = 0.2 }").dof(), 2);
    let spindles = text("fail/mass_on_axis");
    assert!(Model::from_toml(spindles.clone(), "test.toml").is_err());
    assert_eq!(loaded(&spindles, "locked = { carrier = 0.1, tip = 0.2 }").dof(), 2);
}

#[test]
fn a_locked_joint_needs_no_range() {
    let without = text("test/kr5_ranges");
    let last = without.rfind("range =").unwrap();
    let without = &without[..last];
    let faults = Model::from_toml_with(without, "test.toml", "tolerance = 1e-3").unwrap_err();
    assert!(faults.errors().next().unwrap().title().contains("joint `joint6` has no range"), "{faults}");
    let options = "tolerance = 1e-3\nlocked = { joint6 = 0 }";
    let loaded = Model::from_toml_with(without, "test.toml", options).unwrap();
    assert_eq!((loaded.options.tolerance, loaded.model.dof()), (Some(1e-3), 5));
}

#[test]
fn locks_of_unknown_repeated_fixed_or_all_joints_are_reported() {
    let kr5 = loaded(&text("kr5"), "");
    let gantry = loaded(&text("test/gantry"), "");
    let refused = |joints: &[(&str, f64)]| kr5.locked(joints).unwrap_err().to_string();
    assert_eq!(
        refused(&[("joint7", 0.0)]),
        "unknown joint `joint7` to lock; The joints are: joint1, joint2, joint3, joint4, joint5, joint6"
    );
    assert_eq!(refused(&[("joint6", 0.0), ("link6", 0.1)]), "joint `link6` is locked twice: give it one value");
    assert_eq!(
        refused(&[("joint6", f64::NAN)]),
        "joint `joint6` cannot be locked at NaN: give a finite value, rad or m"
    );
    let all = ["joint1", "joint2", "joint3", "joint4", "joint5", "joint6"].map(|joint| (joint, 0.0));
    assert_eq!(kr5.locked(&all), Err(LockError::NothingMoves));
    assert_eq!(gantry.locked(&[("tool", 0.0)]), Err(LockError::Fixed { joint: "tool".into() }));
}

/// A name that only an unreadable link may have is not blamed on the lock.
#[test]
fn unreadable_links_give_no_echoes() {
    let broken = text("kr5").replace("joint_name = \"joint6\"", "joint_name = 6");
    let faults = Model::from_toml_with(broken, "test.toml", "locked = { joint6 = 0 }").unwrap_err();
    assert_eq!(faults.errors().count(), 1, "{faults}");
    assert_eq!(faults.interface.joints.len(), 6);
}

#[test]
fn nothing_acts_in_a_locked_joint() {
    let loose = text("kr5").replace("\r\n", "\n");
    let driven = loose.replace("joint = \"revolute\"", "joint = \"revolute\"\narmature = 0.2\nfriction = 3.0");
    let [loose, driven] = [loose, driven].map(|text| loaded(&text, "locked = { joint3 = 0.4 }"));
    assert_eq!(driven.links[2], loose.links[2]);
    assert_eq!(driven.links[3].physics.armature, 0.2.into());
}
