//! What a good file says arrives in the model.

use redysim_model::joint::JointPhysics;
use redysim_model::spatial::{Mat3, Vec3};
use redysim_model::{CutKind, Inertia, JointKind, Link, Model};
use std::f64::consts::FRAC_PI_2;
use std::path::Path;

fn load(name: &str) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models").join(name);
    Model::load(path).unwrap_or_else(|faults| panic!("{faults}")).model
}

fn read(text: &str) -> Model {
    Model::from_toml(text, "test.toml").unwrap_or_else(|faults| panic!("{faults}")).model
}

/// A model of one link with these lines.
fn one_link(lines: &str) -> Link {
    let head = "name = 'test'\ngravity = [0, 0, 0]\n[[link]]\nname = 'arm'\nparent = 'base'\nmass = 1\ncom = [0.1, 0.2, 0.3]\n";
    read(&format!("{head}{lines}")).links.remove(0)
}

#[test]
fn kr5_is_the_robot_of_the_paper() {
    let model = load("kr5.toml");
    assert_eq!(model.gravity, Vec3([0.0, 0.0, -9.81]));
    assert_eq!((model.links.len(), model.dof(), model.loops.len()), (6, 6, 0));
    for (i, link) in model.links.iter().enumerate() {
        assert_eq!((&link.name, &link.joint_name), (&format!("link{}", i + 1), &format!("joint{}", i + 1)));
        assert_eq!(
            (link.parent, link.joint, link.actuated_velocities()),
            (i.checked_sub(1), JointKind::Revolute, vec![true])
        );
        assert_eq!((link.axis, link.offset), (Vec3([0.0, 0.0, 1.0]), 0.0));
    }
    let wrist = &model.links[3];
    assert_eq!(wrist.placement.rotation, Mat3([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]));
    assert_eq!(wrist.placement.position, Vec3([0.12, -0.62, 0.0]));
    assert_eq!((model.links[2].mass, wrist.mass), (12.973, 2.051));
    assert_eq!(wrist.com, Vec3([-0.000033, 0.007634, -0.109372]));
    let expected = Inertia { xx: 0.004767354, yy: 0.010122217, zz: 0.01210886, ..Inertia::default() };
    assert_eq!(wrist.inertia, expected);
}

#[test]
fn table_2_has_its_own_third_mass_and_the_same_geometry() {
    let (shipped, printed) = (load("kr5.toml"), load("kr5_table2.toml"));
    assert_eq!(printed.links[2].mass, 12.937);
    for (shipped, printed) in shipped.links.iter().zip(&printed.links) {
        assert_eq!(shipped.placement, printed.placement);
    }
}

#[test]
fn the_gripper_has_two_fingers() {
    let model = load("gripper.toml");
    assert_eq!(model.gravity, Vec3([0.0, -9.81, 0.0]));
    let parents: Vec<_> = model.links.iter().map(|link| link.parent).collect();
    assert_eq!(parents, [None, Some(0), Some(1), Some(0)]);
    for (link, length) in model.links.iter().zip([0.1, 0.05, 0.05, 0.05]) {
        let across = link.mass * length * length / 12.0;
        assert!((link.inertia.yy - across).abs() < 1e-15 * across && link.inertia.zz == link.inertia.yy);
        assert_eq!((link.inertia.xx, link.com), (0.0, Vec3([length / 2.0, 0.0, 0.0])));
    }
}

#[test]
fn links_may_stand_in_any_order() {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/gripper.toml")).unwrap();
    let mut tables: Vec<_> = text.split("[[link]]").collect();
    let head = tables.remove(0);
    let in_order = load("gripper.toml");
    for turn in 0..tables.len() {
        tables.rotate_left(1);
        let reordered = read(&format!("{head}[[link]]{}", tables.join("\n[[link]]")));
        for link in &reordered.links {
            let original = in_order.links.iter().find(|original| original.name == link.name).unwrap();
            let parent_name = |model: &Model, link: &Link| link.parent.map(|parent| model.links[parent].name.clone());
            assert_eq!(parent_name(&reordered, link), parent_name(&in_order, original), "turned by {turn}");
            assert_eq!(Link { parent: None, ..link.clone() }, Link { parent: None, ..original.clone() });
        }
    }
}

#[test]
fn denavit_hartenberg_and_origin_place_alike() {
    for (dh, origin) in [
        ("a = 0.18, alpha = '90 deg', b = 0.4", "xyz = [0.18, -0.4, 0], rpy = ['90 deg', 0, 0]"),
        ("a = 0.6, alpha = '180 deg', b = 0.1", "xyz = [0.6, 0, -0.1], rpy = ['180 deg', 0, 0]"),
        ("alpha = '-90 deg', b = 2", "xyz = [0, 2, 0], rpy = ['-1.5707963267948966 rad', 0, 0]"),
    ] {
        let by_dh = one_link(&format!("joint = 'revolute'\ndh = {{ {dh} }}"));
        let by_origin = one_link(&format!("joint = 'revolute'\norigin = {{ {origin} }}\naxis = [0, 0, 1]"));
        assert_eq!(by_dh, by_origin);
    }
    let by_dh = one_link("joint = 'prismatic'\ndh = { a = 0.3, theta = '90 deg', b = 0.2 }");
    let by_origin =
        one_link("joint = 'prismatic'\norigin = { xyz = [0.3, 0, 0], rpy = [0, 0, '90 deg'] }\naxis = [0, 0, 1]");
    assert_eq!(by_dh, Link { offset: 0.2, ..by_origin });
}

#[test]
fn the_offset_is_theta_or_b() {
    assert_eq!(one_link("joint = 'revolute'\ndh = { theta = '90 deg', b = 3 }").offset, FRAC_PI_2);
    assert_eq!(one_link("joint = 'prismatic'\ndh = { theta = '90 deg', b = 3 }").offset, 3.0);
    assert_eq!(one_link("joint = 'revolute'\ndh.theta = 1.5707963267948966").offset, FRAC_PI_2);
}

#[test]
fn axes_have_unit_length() {
    assert_eq!(one_link("joint = 'revolute'\naxis = [0, -2, 0]").axis, Vec3([0.0, -1.0, 0.0]));
    assert_eq!(one_link("joint = 'revolute'\naxis = [3, 0, 4]").axis, Vec3([0.6, 0.0, 0.8]));
    assert_eq!(one_link("joint = 'revolute'\naxis = [1e100, 0, 0]").axis, Vec3([1.0, 0.0, 0.0]));
    assert_eq!(one_link("joint = 'prismatic'\naxis = [0, 0, 0.1]").axis, Vec3([0.0, 0.0, 1.0]));
}

/// The warnings about one link with this inertia.
fn warnings_about(inertia: &str) -> usize {
    let text = format!(
        "name = 'rod'\ngravity = [0, 0, 0]\n[[link]]\nname = 'rod'\nparent = 'base'\njoint = 'revolute'\n\
         axis = [0, 0, 1]\nmass = 1\ninertia = {{ {inertia} }}"
    );
    Model::from_toml(text, "rod.toml").unwrap_or_else(|faults| panic!("{faults}")).warnings.len()
}

#[test]
fn rods_lie_on_the_edge_of_the_triangle_inequality() {
    assert_eq!(warnings_about("yy = 0.1, zz = 0.1"), 0);
    assert_eq!(warnings_about("xx = 0.1, yy = 0.2, zz = 0.3000000000000001"), 0);
    assert_eq!(warnings_about("xx = 0.1, yy = 0.2, zz = 0.3001"), 1);
    // A rod along (x, y, z) has the inertia 1 - n nᵀ, with roundoff in every element.
    for (x, y, z) in (1..100).map(|i| (f64::from(i).sin(), f64::from(2 * i).cos(), f64::from(3 * i).sin())) {
        let length = (x * x + y * y + z * z).sqrt();
        let [x, y, z] = [x, y, z].map(|component| component / length);
        let moments = format!("xx = {:?}, yy = {:?}, zz = {:?}", 1.0 - x * x, 1.0 - y * y, 1.0 - z * z);
        let products = format!("xy = {:?}, yz = {:?}, xz = {:?}", -x * y, -y * z, -x * z);
        assert_eq!(warnings_about(&format!("{moments}, {products}")), 0);
    }
}

#[test]
fn massless_links_may_stand_inside_a_chain() {
    let model = read(
        "name = 'cardan'\ngravity = [0, 0, 0]\n\
         [[link]]\nname = 'cross'\nparent = 'base'\njoint = 'revolute'\naxis = [1, 0, 0]\nmass = 0\n\
         [[link]]\nname = 'arm'\nparent = 'cross'\njoint = 'revolute'\naxis = [0, 1, 0]\nmass = 0\n\
         [[link]]\nname = 'tool'\nparent = 'arm'\njoint = 'fixed'\norigin.xyz = [0, 0, 1]\nmass = 1\n",
    );
    assert_eq!(model.dof(), 2);
}

#[test]
fn loops_know_their_links() {
    let model = read(
        "name = 'pendulum on a rail'\ngravity = [0, 0, 0]\n\
         [[link]]\nname = 'arm'\nparent = 'base'\njoint = 'revolute'\naxis = [0, 0, 1]\nmass = 1\ncom = [1, 0, 0]\nactuated = false\n\
         [[loop]]\nname = 'rail'\njoint = 'revolute'\nlink_a = 'base'\nlink_b = 'arm'\npoint_b = [1, 0, 0]\naxis_b = [0, 0, 2]\n",
    );
    let rail = &model.loops[0];
    assert_eq!((rail.joint, rail.a.link, rail.b.link), (CutKind::Revolute, None, Some(0)));
    assert_eq!((rail.a.point, rail.b.point), (Vec3([0.0; 3]), Vec3([1.0, 0.0, 0.0])));
    assert_eq!((rail.a.axis, rail.b.axis), (Vec3([0.0, 0.0, 1.0]), Vec3([0.0, 0.0, 1.0])));
    assert_eq!(model.links[0].actuated_velocities(), [false]);
}

#[test]
fn what_acts_in_a_joint_is_read_in_the_units_of_the_joint() {
    let placed = "joint = 'revolute'\naxis = [0, 0, 1]\n";
    let turning = one_link(&format!(
        "{placed}armature = 0.3\ndamping = 0.5\nfriction = 2\nfriction_velocity = '1 deg'\nstiffness = 20\nrest = '90 deg'"
    ));
    let expected = JointPhysics {
        armature: 0.3.into(),
        damping: 0.5.into(),
        friction: 2.0.into(),
        friction_velocity: 1_f64.to_radians().into(),
        stiffness: 20.0.into(),
        rest: vec![FRAC_PI_2],
    };
    assert_eq!(turning.physics, expected);
    let sliding = one_link("joint = 'prismatic'\naxis = [0, 0, 1]\nfriction = 2.0\nstiffness = 7\nrest = 0.1");
    assert_eq!(
        sliding.physics,
        JointPhysics { friction: 2.0.into(), stiffness: 7.0.into(), rest: vec![0.1], ..JointPhysics::default() }
    );
    assert_eq!(sliding.physics.friction_velocity, 0.01.into());
    assert_eq!(one_link(placed).physics, JointPhysics::default());
}

/// Its row of the mass matrix is the armature.
#[test]
fn a_link_without_mass_may_move_on_a_joint_with_an_armature() {
    let text = "name = 'test'\ngravity = [0, 0, 0]\n[[link]]\nname = 'rotor'\nparent = 'base'\nmass = 0\n\
                joint = 'revolute'\naxis = [0, 0, 1]\n";
    assert!(Model::from_toml(text, "test.toml").is_err());
    assert_eq!(read(&format!("{text}armature = 0.01")).dof(), 1);
}
