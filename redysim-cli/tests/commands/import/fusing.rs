//! Fixed links become parts of those that carry them.

use super::kinematics::{Numbers, tree, urdf};
use super::{close, import};
use redysim_runtime::{InverseDynamics, LinkKinematics, Real};

/// Fused, the same forces; moving links stay where they are, and the mass that moves is there.
#[test]
fn fusing_changes_nothing_that_moves() {
    let mut numbers = Numbers::new(2);
    for round in 0..20 {
        let joints = tree(&mut numbers, 4 + round);
        let (kept, _) = import(&urdf(&joints), &[]);
        let (fused, run) = import(&urdf(&joints), &["--fuse-fixed"]);
        let n = kept.tree().nv();
        let [q, v, a] = [0; 3].map(|_| (0..n).map(|_| numbers.within(3.0)).collect::<Vec<f64>>());
        let forces = (kept.inverse_dynamics(&q, &v, &a), fused.inverse_dynamics(&q, &v, &a));
        let largest = forces.0.iter().fold(0.0_f64, |most, x| Real::maximum(most, x.abs()));
        for (a, b) in forces.0.iter().zip(&forces.1) {
            assert!((a - b).abs() < 1e-12 * largest, "{:?}", forces);
        }
        let (all, moving) = (kept.link_kinematics(&q, &v), fused.link_kinematics(&q, &v));
        let names: Vec<&str> = kept.model().links.iter().map(|link| link.name.as_str()).collect();
        for (link, state) in fused.model().links.iter().zip(&moving) {
            let before = &all[names.iter().position(|name| *name == link.name).unwrap()];
            assert!((0..3).all(|axis| close(before.origin[axis], state.origin[axis])), "{}", link.name);
        }
        assert_eq!(fused.model().links.len(), n);
        for joint in joints.iter().filter(|joint| joint.kind == "fixed") {
            assert!(run.stdout.contains(&format!("link `{}` is a part of", joint.link)), "{}", run.stdout);
        }
        let carried = |index: usize| {
            std::iter::successors(Some(index), |&at| joints[at].parent).any(|at| joints[at].kind != "fixed")
        };
        let mass = |chosen: &dyn Fn(usize) -> bool| -> f64 {
            (0..joints.len()).filter(|&index| chosen(index)).map(|index| joints[index].mass).sum()
        };
        assert!(close(fused.model().links.iter().map(|link| link.mass).sum(), mass(&carried)));
        assert!(close(kept.model().links.iter().map(|link| link.mass).sum(), mass(&|_| true)));
    }
}

/// Two equal rods end to end are one of twice the mass and length, with (2m)(2l)²/12.
#[test]
fn two_rods_fused_are_a_longer_rod() {
    let (mass, length) = (3.0, 0.8);
    let moment = mass * length * length / 12.0;
    let rod = |name: &str| {
        format!(
            "<link name=\"{name}\"><inertial><origin xyz=\"{} 0 0\"/><mass value=\"{mass}\"/><inertia ixx=\"0\" \
             iyy=\"{moment}\" izz=\"{moment}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>",
            length / 2.0
        )
    };
    let joint = |name: &str, kind: &str, parent: &str, child: &str, inside: &str| {
        format!(
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>{inside}</joint>"
        )
    };
    let urdf = [
        "<robot name=\"rods\"><link name=\"world\"/>".to_string(),
        rod("inner"),
        rod("outer"),
        joint("hinge", "continuous", "world", "inner", "<axis xyz=\"0 0 1\"/>"),
        joint("weld", "fixed", "inner", "outer", &format!("<origin xyz=\"{length} 0 0\" rpy=\"1.2 0 0\"/>")),
        "</robot>".into(),
    ]
    .concat();
    let (mechanism, _) = import(&urdf, &["--fuse-fixed"]);
    let link = &mechanism.model().links[0];
    assert_eq!((link.name.as_str(), link.mass), ("inner", 2.0 * mass));
    assert!(close(link.com[0], length) && link.com[1] == 0.0);
    assert!(close(link.inertia.zz, 2.0 * mass * (2.0 * length).powi(2) / 12.0), "{:?}", link.inertia);
    assert!(link.inertia.xx.abs() < 1e-15);
}
