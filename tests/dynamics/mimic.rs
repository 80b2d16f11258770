//! Joints that mimic others: a gripper in closed form, and what a type shows of them. Random trees with such joints are held
//! against Kane's equations in [`super::random_trees`], their hybrid dynamics in [`super::hybrid`].

use super::random_trees::models::{Joints, mimic_some, random_model};
use super::random_trees::state_in_space;
use crate::common::dual::moving;
use crate::common::random::{Random, State};
use redysim::generic::Model;
use redysim::lanes::F64x4;
use redysim::{batch, redysim};
use redysim_model::denoc::{self, Method, Untraced};
use redysim_model::spatial::Vec3;
use redysim_model::{CutKind, CutSide, GenericMechanism, Link, LockError, Loop, Tree};

redysim! { struct Gripper("models/parallel_gripper.toml"); }
redysim! { struct Loaded("models/parallel_gripper.toml", parameters = ["left.mass", "right_rack.friction"]); }
redysim! { struct Held("models/parallel_gripper.toml", locked = { pinion = 0.7 }); }

const ROUNDOFF: f64 = 1e-14;

fn gripper() -> Model {
    Model::load("models/parallel_gripper.toml").expect("a valid model").model
}

fn assert_near(found: f64, expected: f64, what: &str) {
    assert!((found - expected).abs() < ROUNDOFF * expected.abs().max(1.0), "{what}: {found} instead of {expected}");
}

#[test]
fn joints_that_mimic_others_have_no_coordinates_of_their_own() {
    assert_eq!((Gripper::NQ, Gripper::NV, Gripper::NL, Gripper::NJ), (2, 2, 4, 2));
    assert_eq!((Gripper::JOINT_NAMES, Gripper::ACTUATED), (["wrist", "pinion"], [true; 2]));
}

/// With the radius r of the pinion, the racks at x = ±(r q + 0.02 m) have the speed r q̇ in the hand: the pinion meets
/// I + armature + 2 m r², the wrist also the racks' moments about its axis, and r dx/dt of their speed in each force.
#[test]
fn a_pinion_meets_the_inertia_and_the_friction_of_the_racks_that_it_drives() {
    let (radius, mass) = (0.01, 0.12);
    let (q, v, a) = ([0.4, 0.9], [1.3, -2.1], [3.0, 5.0]);
    let x = radius * q[1] + 0.02;
    let [[of_wrist, coupling], [_, of_pinion]] = Gripper::mass_matrix(&q);
    assert_near(of_pinion, 1.0e-6 + 2.0e-5 + 2.0 * mass * radius * radius, "inertia at the pinion");
    // Left: com at (x + 0.005, 0.08 + 0.03), right: com at (−x − 0.005, 0.06 + 0.05).
    let [height, reach] = [0.11, x + 0.005];
    let hand = 1.3e-3 + 0.8 * 0.04 * 0.04 + 1.0e-6 + 0.02 * 0.07 * 0.07;
    assert_near(of_wrist, hand + 2.0 * (1.0e-4 + mass * (height * height + reach * reach)), "inertia at the wrist");
    // The racks move oppositely at one height. The pinion turns with the hand about the same axis.
    assert_near(coupling, 1.0e-6, "coupling");

    let speed = radius * v[1];
    let friction = 2.0 * 0.5 * speed / speed.hypot(0.01);
    let centrifugal = -2.0 * mass * reach * v[0] * v[0];
    let force = of_pinion * a[1] + coupling * a[0] + radius * (friction + centrifugal);
    assert_near(Gripper::inverse_dynamics(&q, &v, &a)[1], force, "force at the pinion");

    let links: [redysim::LinkState<f64>; 4] = Gripper::link_kinematics(&[0.0, q[1]], &[0.0, v[1]]);
    assert_near(links[2].origin[0], x, "left rack");
    assert_near(links[3].origin[0], -x, "right rack, which mimics the left one");
    assert_near(links[3].velocity[0], -speed, "its velocity");
}

#[test]
fn forward_dynamics_of_the_compiled_gripper_is_the_inverse_of_inverse_dynamics() {
    let mut random = Random::new(5);
    for _ in 0..20 {
        let [q, v, a]: [[f64; 2]; 3] = [2.0, 5.0, 20.0].map(|bound| random.vector(2, bound).try_into().expect("two"));
        let tau = Gripper::inverse_dynamics(&q, &v, &a);
        let found = Gripper::forward_dynamics(&q, &v, &tau);
        (0..2).for_each(|i| assert!((found[i] - a[i]).abs() < 1e-11, "{found:?} instead of {a:?}"));
    }
}

#[test]
fn numbers_of_joints_that_mimic_others_are_given_at_run_time() {
    // The racks are level, so that their weights do not act along them.
    let (q, v, a) = ([0.0, 0.9], [0.0, 20.0], [0.0; 2]);
    let loaded = Loaded::new(&[0.5, 0.2]);
    let [[_, _], [_, of_pinion]] = loaded.mass_matrix(&q);
    assert_near(of_pinion, 1.0e-6 + 2.0e-5 + (0.5 + 0.12) * 1e-4, "inertia at the pinion");
    let less = Gripper::inverse_dynamics(&q, &v, &a)[1] - loaded.inverse_dynamics(&q, &v, &a)[1];
    let speed = 0.01 * v[1];
    assert_near(less, 0.01 * (0.5 - 0.2) * speed / speed.hypot(0.01), "friction of the right rack");
}

#[test]
fn lanes_and_batches_of_a_mechanism_with_mimics_compute_what_single_states_do() {
    let mut random = Random::new(6);
    let states: Vec<[[f64; 2]; 3]> =
        (0..101).map(|_| [2.0, 5.0, 20.0].map(|bound| random.vector(2, bound).try_into().expect("two"))).collect();
    let part = |k: usize| states.iter().map(|state| state[k]).collect::<Vec<_>>();
    let (q, v, x) = (part(0), part(1), part(2));
    let mut found = vec![[0.0; 2]; states.len()];
    batch::forward_dynamics(&Gripper, &q, &v, &x, &mut found).expect("equal lengths");
    for (index, [q, v, tau]) in states.iter().enumerate() {
        let single = Gripper::forward_dynamics(q, v, tau);
        let lanes = |vector: &[f64; 2]| vector.map(|value| F64x4::from([value; 4]));
        let in_lanes: [F64x4; 2] = Gripper::forward_dynamics(&lanes(q), &lanes(v), &lanes(tau));
        for i in 0..2 {
            assert_near(found[index][i], single[i], "batch");
            in_lanes[i].to_array().into_iter().for_each(|lane| assert_near(lane, single[i], "lane"));
        }
    }
}

/// A motor that weighs nothing lifts two platforms by racks: only together do their joints meet inertia, m r² each.
#[test]
fn a_joint_without_mass_moves_what_joints_that_mimic_it_move() {
    let rack = |name: &str, multiplier: f64, mass: f64| {
        format!(
            "[[link]]\nname = '{name}'\nparent = 'base'\njoint = 'prismatic'\naxis = [0, 0, 1]\n\
             mimic = {{ joint = 'motor', multiplier = {multiplier:?} }}\nmass = {mass:?}\n"
        )
    };
    let lift = |masses: [f64; 2]| {
        let [up, down] = [("up", 0.03), ("down", -0.02)]
            .map(|(name, multiplier)| rack(name, multiplier, masses[usize::from(name == "down")]));
        let text = format!(
            "name = 'lift'\ngravity = [0, 0, -9.81]\nfunctions = ['forward_dynamics', 'inverse_dynamics', 'mass_matrix']\n\
             [[link]]\nname = 'motor'\nparent = 'base'\njoint = 'revolute'\naxis = [1, 0, 0]\nmass = 0\n{up}{down}"
        );
        Model::from_toml(text, "lift.toml").map(|loaded| loaded.model)
    };
    let model = lift([5.0, 3.0]).unwrap_or_else(|faults| panic!("{faults}"));
    let tree = Tree::new(&model);
    let inertia = 5.0 * 0.03 * 0.03 + 3.0 * 0.02 * 0.02;
    let weight = 9.81 * (5.0 * 0.03 - 3.0 * 0.02);
    for method in [Method::Recursion, Method::Factorisation] {
        let a = denoc::forward_dynamics(method, &tree, &Untraced, &[0.4], &[2.0], &[1.5]);
        assert_near(a[0], (1.5 - weight) / inertia, "acceleration");
    }
    let faults = lift([0.0, 0.0]).expect_err("nothing has mass").to_string();
    assert!(faults.contains("link `motor`: its joint `motor` moves no mass"), "{faults}");
}

/// A wheel behind coaxial joints that turn it back as far as they turn it does not move at all, but for the roundoff of
/// 1 + 0.3 + 0.4 − 1.7. Each of the joints meets inertia by itself.
#[test]
fn joints_of_a_group_whose_motions_cancel_are_refused() {
    let text = |last: f64| {
        let follower = |name: &str, parent: &str, multiplier: f64, body: &str| {
            format!(
                "[[link]]\nname = '{name}'\nparent = '{parent}'\njoint = 'revolute'\norigin = {{}}\naxis = [0.48, -0.6, 0.64]\n\
                 mimic = {{ joint = 'carrier', multiplier = {multiplier:?} }}\n{body}\n"
            )
        };
        let body = "mass = 2.0\ncom = [0.3, 0.1, -0.2]\ninertia = { xx = 0.1, yy = 0.2, zz = 0.15 }";
        let followers = [
            follower("first", "carrier", 0.3, "mass = 0"),
            follower("second", "first", 0.4, "mass = 0"),
            follower("wheel", "second", last, body),
        ];
        "name = 'wheel'\ngravity = [0, 0, 0]\n[[link]]\nname = 'carrier'\nparent = 'base'\njoint = 'revolute'\n\
         axis = [0.48, -0.6, 0.64]\nmass = 0\n"
            .to_owned()
            + &followers.concat()
    };
    let faults = Model::from_toml(text(-1.7), "wheel.toml").expect_err("it stands still").to_string();
    assert!(faults.contains("joint `carrier` meets no inertia at any position"), "{faults}");
    // About the axis n: n·I n + m |n × c|², at twice the speed of the carrier.
    let model = Model::from_toml(text(0.3), "wheel.toml").unwrap_or_else(|faults| panic!("{faults}")).model;
    let (n, com) = (Vec3([0.48, -0.6, 0.64]), Vec3([0.3, 0.1, -0.2]));
    let arm = n.cross(com);
    let inertia = 0.1 * n[0] * n[0] + 0.2 * n[1] * n[1] + 0.15 * n[2] * n[2] + 2.0 * arm.dot(arm);
    let a = denoc::forward_dynamics(Method::Recursion, &Tree::new(&model), &Untraced, &[0.4], &[2.0], &[1.5]);
    assert_near(a[0], 1.5 / (4.0 * inertia), "acceleration");
}

#[test]
fn joints_that_mimic_a_locked_joint_are_held_where_they_are_then() {
    assert_eq!((Held::NQ, Held::JOINT_NAMES), (1, ["wrist"]));
    let held: [redysim::LinkState<f64>; 4] = Held::link_kinematics(&[0.3], &[1.1]);
    let moving: [redysim::LinkState<f64>; 4] = Gripper::link_kinematics(&[0.3, 0.7], &[1.1, 0.0]);
    let by_function = GenericMechanism::new(gripper().locked(&[("pinion", 0.7)]).expect("a joint"));
    let generic = denoc::link_kinematics(by_function.tree(), &Untraced, &[0.3], &[1.1]);
    for ((held, moving), generic) in held.iter().zip(&moving).zip(&generic) {
        for i in 0..3 {
            assert_near(held.com[i], moving.com[i], "by the option");
            assert_near(generic.com[i], moving.com[i], "by the function");
        }
    }
    let refused = gripper().locked(&[("right_rack", 0.02)]).expect_err("it mimics");
    assert_eq!(refused, LockError::Mimics { joint: "right_rack".into(), followed: "left_rack".into() });
    assert_eq!(refused.to_string(), "joint `right_rack` mimics `left_rack`: lock that one instead");
}

#[test]
fn a_model_with_mimics_reads_back_from_its_text() {
    assert_eq!(gripper().check().expect("a valid model").model, gripper());
}

/// J v is the rate of the residual, and the bias that of J v, by dual numbers.
#[test]
fn loops_between_joints_that_mimic_others_have_the_jacobian_of_their_residual() {
    for seed in 0..40 {
        let mut random = Random::new(seed);
        let mut model = random_model(&mut random, Joints::InSpace, false, false);
        mimic_some(&mut random, &mut model);
        let last = model.links.len() - 1;
        let mut side =
            |link| CutSide { link, point: Vec3::from_fn(|_| random.within(0.3)), axis: Vec3([0.6, 0.0, 0.8]) };
        let (a, b) = (side(None), side(Some(last)));
        model.loops.push(Loop { name: "cut".into(), joint: CutKind::Revolute, a, b });
        let tree = Tree::new(&model);
        let State { q, v, .. } = state_in_space(&mut random, &model);
        let at = moving(&q, &denoc::coordinate_rates(&tree, &q, &v));
        let jacobian = denoc::loop_jacobian(&tree, &Untraced, &at);
        let residual = denoc::loop_residual(&tree, &Untraced, &at);
        let bias = denoc::loop_bias(&tree, &Untraced, &q, &v);
        let along = |row: &[f64]| row.iter().zip(&v).map(|(x, v)| x * v).sum::<f64>();
        for ((row, residual), bias) in jacobian.iter().zip(&residual).zip(&bias) {
            let (values, rates): (Vec<f64>, Vec<f64>) = row.iter().map(|x| (x.value, x.rate)).unzip();
            let size = 1.0 + v.iter().map(|v| v * v).sum::<f64>();
            assert!((along(&values) - residual.rate).abs() < 1e-12 * size, "seed {seed}");
            assert!((along(&rates) - bias).abs() < 1e-12 * size, "seed {seed}");
        }
    }
}

#[test]
fn the_degrees_of_freedom_of_a_model_are_those_of_joints_that_do_not_mimic() {
    let model = gripper();
    assert_eq!(model.links.iter().map(Link::dof).collect::<Vec<_>>(), [1, 1, 0, 0]);
    assert_eq!((model.dof(), Tree::new(&model).nv(), Tree::new(&model).nv_of_all()), (2, 2, 4));
}
