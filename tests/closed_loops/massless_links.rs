//! A link without mass that a loop holds: the tree's mass matrix is singular, the closed mechanism moves.
#![cfg(feature = "generic")]

use redysim::Real;
use std::fs;

use crate::common::models::generic;
use redysim::generic::{GenericMechanism, Model};
use redysim::{
    ClosedLoop, ClosedLoopInverse, ClosedLoopSimulation, Dop853, ForwardDynamics, Function, Integrator, LoopError,
    MassMatrix, Motion, ZeroTorque, redysim,
};

redysim! { struct Massless("models/test/fourbar_massless_coupler.toml"); }

/// Crank, rocker and coupler of the model.
const LENGTHS: [f64; 3] = [0.038, 0.1152, 0.1152];
const GROUND: f64 = -0.0895;
const MASSES: [f64; 2] = [1.5, 3.0];
const LEVERS: [f64; 2] = [0.019, 0.0576];
const INERTIAS: [f64; 2] = [0.0001805, 0.00331776];
const GRAVITY: f64 = 9.81;

/// Accelerations of crank and rocker, and the force of the crank on the coupler.
struct Expected {
    crank: f64,
    rocker: f64,
    force: [f64; 2],
}

/// Lagrange's equations of crank and rocker alone, whose tips the rod keeps at its length: F = ½ (|A − B|² − l²) = 0. The
/// rod's force is μ (A − B), along it. Nothing here knows the coupler's coordinate, a mass matrix or a Jacobian of the code.
fn lagrange([phi, psi]: [f64; 2], [phi_rate, psi_rate]: [f64; 2], tau: [f64; 2]) -> Expected {
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let tip = |length: f64, angle: f64| {
        let (sin, cos) = angle.sin_cos();
        // The tip from its pivot, and its first and second derivatives with respect to the angle.
        [[length * cos, length * sin], [-length * sin, length * cos], [-length * cos, -length * sin]]
    };
    let [a, a1, a2] = tip(LENGTHS[0], phi);
    let [b, b1, b2] = tip(LENGTHS[1], psi);
    let rod = [a[0] - GROUND - b[0], a[1] - b[1]];
    assert!((dot(rod, rod).sqrt() - LENGTHS[2]).abs() < 1e-12, "the loop is closed");
    let (f_phi, f_psi) = (dot(rod, a1), -dot(rod, b1));
    let second = (dot(a1, a1) + dot(rod, a2)) * phi_rate * phi_rate - 2.0 * dot(a1, b1) * phi_rate * psi_rate
        + (dot(b1, b1) - dot(rod, b2)) * psi_rate * psi_rate;
    let inertia = |i: usize| INERTIAS[i] + MASSES[i] * LEVERS[i] * LEVERS[i];
    let drive = |i: usize, angle: f64| tau[i] - GRAVITY * MASSES[i] * LEVERS[i] * angle.cos();
    let (drives, inertias) = ([drive(0, phi), drive(1, psi)], [inertia(0), inertia(1)]);
    // F_φ φ̈ + F_ψ ψ̈ + second = 0 with I φ̈ = drive + μ F_φ.
    let free = f_phi * drives[0] / inertias[0] + f_psi * drives[1] / inertias[1] + second;
    let mu = -free / (f_phi * f_phi / inertias[0] + f_psi * f_psi / inertias[1]);
    Expected {
        crank: (drives[0] + mu * f_phi) / inertias[0],
        rocker: (drives[1] + mu * f_psi) / inertias[1],
        force: [-mu * rod[0], -mu * rod[1]],
    }
}

/// Closed states around a turn of the crank at 5 rad/s.
fn states() -> Vec<([f64; 3], [f64; 3])> {
    let loops = ClosedLoop::new(&Massless);
    let mut guess = [0.0, 0.9844, 4.3144];
    let around = (0..24).map(|k| {
        guess[0] = f64::from(k) * std::f64::consts::TAU / 24.0;
        let closed = loops.assemble(&guess, &[5.0, 0.0, 0.0], &[0]).expect("it closes with the crank held");
        guess = closed.q;
        (closed.q, closed.v)
    });
    around.collect()
}

fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, |most, size| if size <= most { most } else { size })
}

/// The model with a coupler of this mass, and of inertia in proportion.
fn with_coupler_of(mass: f64) -> GenericMechanism {
    let mut model = generic("fourbar").model().clone();
    let coupler = &mut model.links[2];
    let share = mass / coupler.mass;
    coupler.mass = mass;
    for element in [&mut coupler.inertia.xx, &mut coupler.inertia.yy, &mut coupler.inertia.zz] {
        *element *= share;
    }
    GenericMechanism::new(model)
}

#[test]
fn a_four_bar_with_a_massless_coupler_moves_as_lagrange_derived_it() {
    let general = generic("test/fourbar_massless_coupler");
    for (q, v) in states() {
        assert_eq!(Massless::mass_matrix(&q)[2], [0.0; 3], "the tree does not know how the coupler moves");
        let tau = [0.7, -0.2, 0.0];
        let expected = lagrange([q[0], q[1]], [v[0], v[1]], [tau[0], tau[1]]);
        let motion = ClosedLoop::new(&Massless).dynamics(&q, &v, &tau).expect("the closed mechanism is regular");
        let (a, lambda) = (motion.accelerations, motion.multipliers);
        let size = expected.crank.abs() + expected.rocker.abs() + 1.0;
        assert!(difference(&a[..2], &[expected.crank, expected.rocker]) < 1e-12 * size, "{a:?}");
        let size = expected.force.iter().fold(1.0, |most: f64, force| Real::maximum(most, force.abs()));
        assert!(difference(&lambda, &expected.force) < 1e-12 * size, "{lambda:?}, {:?}", expected.force);
        assert_eq!(motion.rank, 2);
        let of_model = ClosedLoop::new(&general)
            .dynamics(&q.to_vec(), &v.to_vec(), &tau.to_vec())
            .expect("on the generic path, too");
        assert!(difference(&of_model.accelerations, &a) < 1e-11 * size, "{of_model:?}");
        assert!(difference(&of_model.multipliers, &lambda) < 1e-12 * size, "{of_model:?}");
    }
}

/// A force of the coupler's own joint, too: M a + h = τ + Jᵀλ and J a = −J̇ q̇, in each of its rows.
#[test]
fn forces_balance_and_loops_stay_closed_with_a_force_on_the_massless_link() {
    for (q, v) in states() {
        let tau = [0.7, -0.2, 0.1];
        let motion = ClosedLoop::new(&Massless).dynamics(&q, &v, &tau).expect("regular");
        let needed = Massless::inverse_dynamics(&q, &v, &motion.accelerations);
        let (jacobian, bias) = (Massless::loop_jacobian(&q), Massless::loop_bias(&q, &v));
        for i in 0..3 {
            let by_loop: f64 = (0..2).map(|row| jacobian[row][i] * motion.multipliers[row]).sum();
            assert!((needed[i] - tau[i] - by_loop).abs() < 1e-12, "coordinate {i}");
        }
        for row in 0..2 {
            let second: f64 = (0..3).map(|i| jacobian[row][i] * motion.accelerations[i]).sum();
            assert!((second + bias[row]).abs() < 1e-11, "row {row}");
        }
    }
}

#[test]
fn a_coupler_whose_mass_goes_to_zero_moves_ever_more_like_one_without() {
    let tau = vec![0.7, -0.2, 0.0];
    for (q, v) in states() {
        let exact = ClosedLoop::new(&Massless).dynamics(&q, &v, &[0.7, -0.2, 0.0]).expect("regular");
        let errors = [1e-2, 1e-4, 1e-6].map(|mass| {
            let light = with_coupler_of(mass);
            let motion = ClosedLoop::new(&light).dynamics(&q.to_vec(), &v.to_vec(), &tau).expect("regular");
            let of = |a: &[f64], b: &[f64]| {
                difference(a, b) / b.iter().fold(1.0, |most: f64, b| Real::maximum(most, b.abs()))
            };
            of(&motion.accelerations, &exact.accelerations).max(of(&motion.multipliers, &exact.multipliers))
        });
        // In proportion to the mass, which the others weigh some hundred times.
        assert!(errors[0] < 0.2 && errors[1] < 0.02 * errors[0] && errors[2] < 0.02 * errors[1], "{errors:?}");
    }
}

#[test]
fn a_four_bar_with_a_massless_coupler_keeps_its_energy_and_that_of_lagrange() {
    let loops = ClosedLoop::new(&Massless);
    let closed = loops.assemble(&[0.0, 0.9844, 4.3144], &[4.7, 0.0, 0.0], &[0]).expect("it closes");
    let energy = |q: &[f64; 3], v: &[f64; 3]| Massless::energy(q, v).total();
    let before = energy(&closed.q, &closed.v);
    let method = Dop853::new().rtol(1e-11).atol(1e-12);
    let mut fall = ClosedLoopSimulation::new(loops, ZeroTorque);
    let start = fall.assembled(&closed);
    let copy = ClosedLoopSimulation::<f64, _, _>::new(loops, ZeroTorque);
    let (mut drift, mut gap, mut exchanged) = (0.0_f64, 0.0_f64, 0.0_f64);
    let end = method.each_step(&mut fall, (0.0, 1.0), start, |step| {
        let now = copy.split(step.end().1);
        drift = drift.max((energy(&now.q, &now.v) - before).abs());
        gap = gap.max(difference(&Massless::loop_residual(&now.q), &[0.0; 2]));
        exchanged = exchanged.max(Massless::energy(&now.q, &now.v).kinetic);
    });
    let end = end.expect("it moves").y;
    println!("drift {drift:.1e} J of {exchanged:.2} J, gap {gap:.1e} m");
    // The steps are right to 1e-11, and some hundred follow each other.
    assert!(exchanged > 0.5 && drift < 1e-9 * exchanged && gap < 1e-14, "{drift:e} J, {gap:e} m");

    // y = [φ, ψ, φ̇, ψ̇].
    let mut equation = |_t: f64, y: &[f64; 4], rate: &mut [f64; 4]| {
        let Expected { crank, rocker, .. } = lagrange_nearby([y[0], y[1]], [y[2], y[3]]);
        *rate = [y[2], y[3], crank, rocker];
    };
    let start = [closed.q[0], closed.q[1], closed.v[0], closed.v[1]];
    let expected = method.integrate(&mut equation, (0.0, 1.0), start).expect("it moves").y;
    let error = difference(&[end[0], end[1], end[3], end[4]], &expected);
    println!("{error:.1e} from Lagrange's equations");
    assert!(error < 1e-6, "{error:e}");

    let general = generic("test/fourbar_massless_coupler");
    let mut fall = ClosedLoopSimulation::new(ClosedLoop::new(&general), ZeroTorque);
    let start = fall.state(&closed.q.to_vec(), &closed.v.to_vec());
    let of_model = method.integrate(&mut fall, (0.0, 1.0), start).expect("on the generic path, too").y;
    assert!(difference(&of_model[..6], &end[..6]) < 1e-7, "{of_model:?}");
}

/// Within its steps the equation drifts a little: the rocker is moved to where the rod has its length.
fn lagrange_nearby([phi, mut psi]: [f64; 2], rates: [f64; 2]) -> Expected {
    for _ in 0..4 {
        let a = [LENGTHS[0] * phi.cos() - GROUND, LENGTHS[0] * phi.sin()];
        let rod = [a[0] - LENGTHS[1] * psi.cos(), a[1] - LENGTHS[1] * psi.sin()];
        let gap = 0.5 * (rod[0] * rod[0] + rod[1] * rod[1] - LENGTHS[2] * LENGTHS[2]);
        psi -= gap / (LENGTHS[1] * (rod[0] * psi.sin() - rod[1] * psi.cos()));
    }
    lagrange([phi, psi], rates, [0.0; 2])
}

#[test]
fn inverse_dynamics_of_a_massless_coupler_finds_the_force_that_moved_the_four_bar() {
    for (q, v) in states() {
        let motion = ClosedLoop::new(&Massless).dynamics(&q, &v, &[0.7, 0.0, 0.0]).expect("regular");
        let wanted = |_t: f64| Motion { q: [q[0]], v: [v[0]], a: [motion.accelerations[0]] };
        let mut inverse = ClosedLoopInverse::new(ClosedLoop::new(&Massless), &[0], q);
        let found = inverse.at(0.0, &wanted).expect("the crank moves all");
        assert!((found.forces[0] - 0.7).abs() < 1e-11, "{:?}", found.forces);
        assert!(difference(&found.multipliers, &motion.multipliers) < 1e-9, "{found:?}");
    }
}

#[test]
fn a_massless_coupler_is_solved_to_1e_3_in_single_precision() {
    for (q, v) in states() {
        let exact = ClosedLoop::new(&Massless).dynamics(&q, &v, &[0.7, -0.2, 0.0]).expect("regular");
        let (q, v) = (q.map(|q| q as f32), v.map(|v| v as f32));
        let motion = ClosedLoop::new(&Massless).dynamics(&q, &v, &[0.7, -0.2, 0.0]).expect("regular");
        let size = exact.accelerations.iter().fold(1.0, |most: f64, a| Real::maximum(most, a.abs()));
        assert!(difference(&motion.accelerations.map(f64::from), &exact.accelerations) < 1e-3 * size, "{motion:?}");
    }
}

/// Redundant rows: the force at the cut is shared by the least norm, and is the same.
#[test]
fn a_massless_coupler_in_space_moves_as_the_one_in_the_plane() {
    let mut model = generic("test/fourbar_spatial").model().clone();
    let coupler = model.links.iter_mut().find(|link| link.name == "coupler").expect("a coupler");
    (coupler.mass, coupler.inertia) = (0.0, Default::default());
    let spatial = GenericMechanism::new(model);
    for (q, v) in states() {
        let tau = [0.7, -0.2, 0.0];
        let planar = ClosedLoop::new(&Massless).dynamics(&q, &v, &tau).expect("regular");
        let found = ClosedLoop::new(&spatial).dynamics(&q.to_vec(), &v.to_vec(), &tau.to_vec()).expect("redundant");
        assert_eq!(found.rank, 2);
        let size = planar.accelerations.iter().fold(1.0, |most: f64, a| Real::maximum(most, a.abs()));
        assert!(difference(&found.accelerations, &planar.accelerations) < 1e-9 * size, "{found:?}");
        let norm = |lambda: &[f64]| lambda.iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!(
            (norm(&found.multipliers) - norm(&planar.multipliers)).abs() < 1e-9 * (1.0 + norm(&planar.multipliers))
        );
    }
}

/// A coupler with all its mass on its joint with the rocker meets no inertia either: it moves as a massless one does on
/// a rocker with that mass at its tip.
#[test]
fn a_point_mass_on_the_axis_of_the_coupler_moves_with_the_rocker() {
    let massless = text("test/fourbar_massless_coupler");
    let on_axis = massless.replace("mass = 0.0", "mass = 2.0");
    let tip =
        "[[link]]\nname = \"tip\"\nparent = \"rocker\"\njoint = \"fixed\"\ndh = { a = 0.1152 }\nmass = 2.0\n\n[[loop]]";
    let [on_axis, at_tip] = [on_axis, massless.replace("[[loop]]", tip)]
        .map(|text| GenericMechanism::new(Model::from_toml(text, "trial.toml").expect("a model").model));
    for (q, v) in states() {
        let (q, v, tau) = (q.to_vec(), v.to_vec(), vec![0.7, -0.2, 0.0]);
        let [on_axis, at_tip] =
            [&on_axis, &at_tip].map(|model| ClosedLoop::new(model).dynamics(&q, &v, &tau).expect("regular"));
        let size = at_tip.accelerations.iter().fold(1.0, |most: f64, a| Real::maximum(most, a.abs()));
        assert!(difference(&on_axis.accelerations, &at_tip.accelerations) < 1e-11 * size, "{on_axis:?}, {at_tip:?}");
    }
}

fn text(name: &str) -> String {
    fs::read_to_string(format!("{}/models/{name}.toml", env!("CARGO_MANIFEST_DIR"))).expect("a model file")
}

/// What loading reports as errors.
fn refusal(text: &str) -> String {
    Model::from_toml(text, "trial.toml").expect_err("a fault").to_string()
}

#[test]
fn a_massless_link_that_no_loop_holds_is_refused_as_before() {
    let massless = text("test/fourbar_massless_coupler");
    let open = massless.split_once("[[loop]]").expect("a loop").0;
    assert!(refusal(open).contains("link `coupler`: its joint `coupler` moves no mass"), "{}", refusal(open));
    // The loop holds the coupler, not what turns at its end.
    let loose = "[[link]]\nname = \"flap\"\nparent = \"coupler\"\njoint = \"revolute\"\ndh = { a = 0.1 }\nmass = 0.0\n\n[[loop]]";
    let said = refusal(&massless.replace("[[loop]]", loose));
    assert!(said.contains("link `flap`: its joint `flap` moves no mass"), "{said}");
}

#[test]
fn the_forward_dynamics_of_a_tree_with_a_massless_link_is_refused_by_name_and_left_out_of_all() {
    let massless = text("test/fourbar_massless_coupler");
    let loaded = Model::from_toml(massless.clone(), "trial.toml").expect("a model");
    assert!(
        !loaded.options.functions.contains(Function::ForwardDynamics)
            && loaded.options.functions.contains(Function::MassMatrix)
    );
    assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
    assert_eq!(Massless::OPS.forward_dynamics.flops(), 0);
    let said = refusal(&format!("functions = [\"mass_matrix\", \"forward_dynamics\"]\n{massless}"));
    for word in
        ["whose mass matrix is singular", "joint `coupler`", "ClosedLoop::dynamics", "a small mass", "trial.toml:1:29"]
    {
        assert!(said.contains(word), "no `{word}` in {said}");
    }
}

/// With the cut gone, nothing holds the coupler: the solve says so and makes no numbers up.
#[test]
fn a_closure_that_leaves_the_massless_link_free_is_refused_by_the_solve() {
    let (q, v) = states()[3];
    let mut model = generic("test/fourbar_massless_coupler").model().clone();
    // A cut on the rocker leaves the coupler free.
    model.loops[0].b.link = model.links.iter().position(|link| link.name == "rocker");
    let free = GenericMechanism::new(model);
    assert_eq!(MassMatrix::<f64>::mass_matrix(&free, &q.to_vec())[2], [0.0; 3]);
    let error = ClosedLoop::new(&free).dynamics(&q.to_vec(), &v.to_vec(), &vec![0.0; 3]).expect_err("nothing holds it");
    assert_eq!(error, LoopError::SingularInertia { velocity: 2 });
}

/// What the README documents of the generic path, which has all functions at all times.
#[test]
fn the_tree_alone_has_accelerations_that_are_not_finite() {
    let (q, v) = states()[3];
    let general = generic("test/fourbar_massless_coupler");
    let a = general.forward_dynamics(&q.to_vec(), &v.to_vec(), &vec![0.1; 3]);
    assert!(a.iter().any(|a: &f64| !a.is_finite()), "{a:?}");
    // Code that is generated without the options of the file has the function, and the same there.
    let source = redysim_codegen::source_file(general.model(), "Trial").expect("source");
    assert!(source.contains("forward_dynamics"));
}
