//! Generated code has no operations for what a model lacks: motion out of the plane, the extent of a point mass, gravity
//! of zero, the motion of a locked joint.

use redysim::OperationCount;
use redysim_codegen::functions::trace;
use redysim_model::{Inertia, JointKind, Link, Model, Tree, spatial::Vec3};

type Counts = Vec<(&'static str, OperationCount)>;

fn model(name: &str) -> Model {
    let path = format!("{}/models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Model::load(path).expect("a good model").model
}

fn counts(model: &Model) -> Counts {
    let functions = trace(&Tree::new(model)).expect("no pass changes a value").into_iter();
    functions.map(|function| (function.function.name(), function.expressions.count())).collect()
}

fn of(counts: &Counts, name: &str) -> OperationCount {
    counts.iter().find(|(function, _)| *function == name).expect("a function").1
}

/// The model with each of its links changed.
fn with_links(mut model: Model, change: impl Fn(usize, &mut Link)) -> Model {
    model.links.iter_mut().enumerate().for_each(|(index, link)| change(index, link));
    model
}

const PLANAR: [&str; 7] = ["gripper", "fourbar", "fourbar_gui", "slider_crank", "three_rrr", "leg", "andrews"];

/// A body in the plane has a mass, a place of it, and one moment. What a drawing program adds (thickness, links one
/// above the other, a tensor with nine elements) does nothing in the plane.
#[test]
fn a_planar_mechanism_in_space_costs_planar_code() {
    for name in PLANAR {
        let planar = with_links(model(name), |_, link| {
            link.com.0[2] = 0.0;
            link.inertia = Inertia { zz: link.inertia.zz, ..Inertia::default() };
        });
        let spatial = with_links(planar.clone(), |index, link| {
            // A slider's z is the direction in which it moves.
            if link.joint == JointKind::Revolute {
                link.com.0[2] = 0.02 + 0.01 * index as f64;
            }
            let Inertia { zz, .. } = link.inertia;
            link.inertia = Inertia { xx: 0.7 * zz + 0.01, yy: 0.9 * zz + 0.02, zz, xy: 1e-3, yz: -2e-3, xz: 3e-3 };
        });
        let [planar, spatial] = [planar, spatial].map(|model| counts(&model));
        // Angular momentum has three components: what stands out of the plane has some in it, too.
        let in_plane = planar.iter().zip(&spatial).filter(|((function, _), _)| *function != "momentum");
        for ((function, planar), (_, spatial)) in in_plane {
            assert_eq!(spatial, planar, "{name}, {function}");
        }
        assert!(of(&planar, "inverse_dynamics").flops() > 0, "{name}");
    }
}

/// Gravity along the axes of a planar arm, as of a SCARA, pushes no joint.
#[test]
fn gravity_that_pushes_no_joint_costs_nothing() {
    for name in PLANAR {
        let [none, across] = [0.0, -9.81].map(|z| Model { gravity: Vec3([0.0, 0.0, z]), ..model(name) });
        let [none, across] = [none, across].map(|model| counts(&model));
        for function in ["inverse_dynamics", "forward_dynamics", "mass_matrix", "bias_forces", "gravity_forces"] {
            assert_eq!(of(&across, function), of(&none, function), "{name}, {function}");
        }
        assert_eq!(of(&across, "gravity_forces"), OperationCount::NONE, "{name}");
    }
}

#[test]
fn without_gravity_nothing_is_computed_for_it() {
    let robots = ["kr5", "gripper", "test/gantry", "peers/humanoid30"];
    // The last takes as long as ten of the others, unoptimised.
    for name in robots.into_iter().take(if cfg!(debug_assertions) { 3 } else { 4 }) {
        let weightless = counts(&Model { gravity: Vec3([0.0; 3]), ..model(name) });
        let heavy = counts(&model(name));
        assert_eq!(of(&weightless, "gravity_forces"), OperationCount::NONE, "{name}");
        assert_eq!(of(&weightless, "mass_matrix"), of(&heavy, "mass_matrix"), "{name}");
        assert_eq!(of(&weightless, "link_kinematics"), of(&heavy, "link_kinematics"), "{name}");
        for function in ["inverse_dynamics", "bias_forces", "energy", "forward_dynamics"] {
            let [weightless, heavy] = [&weightless, &heavy].map(|counts| of(counts, function).flops());
            assert!(weightless < heavy, "{name}, {function}: {weightless} without gravity, {heavy} with");
        }
    }
}

/// All bodies of a robot as point masses, against bodies of some extent at the same places.
#[test]
fn a_point_mass_costs_no_terms_of_inertia() {
    let points = |name| with_links(model(name), |_, link| link.inertia = Inertia::default());
    let bodies = |name| {
        with_links(model(name), |index, link| {
            let size = 0.01 * (1.0 + index as f64);
            let [xx, yy, zz] = [1.0, 0.9, 0.8].map(|moment| moment * size);
            link.inertia = Inertia { xx, yy, zz, xy: 0.1 * size, yz: 0.07 * size, xz: -0.05 * size };
        })
    };
    for name in ["kr5", "peers/chain10", "test/gantry"] {
        let [points, bodies] = [points(name), bodies(name)].map(|model| counts(&model));
        assert_eq!(of(&points, "gravity_forces"), of(&bodies, "gravity_forces"), "{name}");
        for function in ["inverse_dynamics", "forward_dynamics", "mass_matrix", "bias_forces", "energy"] {
            let [points, bodies] = [&points, &bodies].map(|counts| of(counts, function).flops());
            println!("{name} {function}: {points} for points, {bodies} for bodies");
            assert!(points < bodies, "{name}, {function}: {points} for points, {bodies} for bodies");
        }
    }
}

/// A weight that hangs on two crossed axes: |r|² m for each of them, by hand. With an extent it is more.
#[test]
fn a_point_mass_on_crossed_axes_takes_what_it_takes_by_hand() {
    let text = |inertia: &str| {
        format!(
            "name = 'weight'\ngravity = [0, 0, 0]\n\
             [[link]]\nname = 'yoke'\nparent = 'base'\njoint = 'revolute'\ndh = {{}}\nmass = 0\n\
             [[link]]\nname = 'weight'\nparent = 'yoke'\njoint = 'revolute'\ndh = {{ alpha = '90 deg' }}\nmass = 2.0\n\
             com = [0.5, 0, 0]\n{inertia}"
        )
    };
    let counts = |inertia| counts(&Model::from_toml(text(inertia), "weight.toml").expect("a good model").model);
    let point = counts("");
    // M = diag(m l² cos² q₂, m l²).
    assert_eq!(of(&point, "mass_matrix").flops(), 2);
    // With p = m l² cos q₂: τ₁ = p (cos q₂ a₁ − 2 sin q₂ v₁ v₂) and τ₂ = m l² a₂ + p sin q₂ v₁²: one, six and five.
    let by_hand = 12;
    let flops = of(&point, "inverse_dynamics").flops();
    assert!(flops <= by_hand, "{flops}");
    let body = counts("inertia = { xx = 0.02, yy = 0.03, zz = 0.04, xy = 0.001 }");
    assert!(of(&body, "inverse_dynamics").flops() > flops);
}

#[test]
fn a_locked_joint_costs_what_a_fixed_joint_costs() {
    let path = format!("{}/models/kr5.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a file of the repository");
    let (before, last) = text.split_once("name = \"link6\"").expect("a sixth link");
    let last = last.replace("revolute", "fixed").replace("theta = \"0 deg\"", "theta = \"40 deg\"");
    let fixed = Model::from_toml(format!("{before}name = \"link6\"{last}"), "fixed.toml").expect("a good model").model;
    let locked = model("kr5").locked(&[("joint6", 40_f64.to_radians())]).expect("a joint that moves");
    assert_eq!(counts(&locked), counts(&fixed));
    for ((function, locked), (_, free)) in counts(&locked).iter().zip(&counts(&model("kr5"))) {
        assert!(locked.flops() <= free.flops(), "{function}");
    }
}
