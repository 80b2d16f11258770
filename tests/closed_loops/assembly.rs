//! Closing loops from a guess, and saying why not.
#![cfg(feature = "generic")]

use crate::common::models::generic;
use crate::linkages::{Fourbar, NFourbar2 as Windows};
use redysim::Real;
use redysim::{
    ClosedLoop, ClosedLoopSimulation, IntegrationError, Integrator, LoopError, Ode4, Stabilisation, ZeroTorque,
};

const START: [f64; 3] = [0.0, 0.984_373_060_839_76, 4.314_439_185_500_066];

#[test]
fn the_shipped_start_closes_with_the_crank_held_and_reports_how_far_it_moved() {
    let assembly = ClosedLoop::new(&Fourbar).assemble(&[0.0, 0.9844, 4.3144], &[4.7124, 1.4045, 0.0], &[0]);
    let assembly = assembly.expect("it closes");
    println!("{assembly:?}");
    assert_eq!((assembly.q[0], assembly.v[0]), (0.0, 4.7124));
    assert!(assembly.position_residual < 1e-14 * 0.2);
    assert!(assembly.q.iter().zip(START).all(|(q, exact)| (q - exact).abs() < 1e-14), "{:?}", assembly.q);
    assert!((assembly.v[1] - 1.40448).abs() < 1e-5 && assembly.v[2].abs() < 1e-12);
    assert!((assembly.largest_displacement - (4.3144 - START[2]).abs()).abs() < 1e-12 && assembly.velocity == 2);
    assert!(assembly.distance > assembly.largest_displacement && assembly.distance < 1e-4);
    assert_eq!(assembly.rank, 2);
}

/// With the crank held at rest nothing can move, and what rounding leaves of the speeds asked for is no fault of the
/// loops.
#[test]
fn a_held_crank_at_rest_stops_the_whole_linkage() {
    for asked in [[0.0_f64, 1.0, 0.0], [0.0, 0.0, -3e8], [0.0, 1e-9, 7.0]] {
        let stopped = ClosedLoop::new(&Fourbar).assemble(&[0.0, 0.9844, 4.3144], &asked, &[0]).expect("it stops");
        let most = asked.iter().fold(0.0, |most: f64, v| Real::maximum(most, v.abs()));
        assert!(stopped.v.iter().all(|v| v.abs() < 1e-15 * most), "{asked:?}: {:?}", stopped.v);
        ClosedLoopSimulation::new(ClosedLoop::new(&Fourbar), ZeroTorque)
            .start(&stopped.q, &stopped.v)
            .expect("it fits");
    }
}

#[test]
fn the_branch_of_the_guess_is_kept() {
    let loops = ClosedLoop::new(&Fourbar);
    let (one, other) = ([0.3, 1.1, 4.2], [0.3, -1.1, -4.2]);
    let one = loops.assemble(&one, &[0.0; 3], &[0]).expect("it closes").q;
    let other = loops.assemble(&other, &[0.0; 3], &[0]).expect("it closes").q;
    assert!(one[1] > 0.5 && other[1] < -0.5, "{one:?} {other:?}");
}

#[test]
fn the_starts_that_ship_open_are_mended() {
    let rrr = generic("three_rrr");
    let q = vec![1.0467, 5.4206, -2.5357, 4.1883, -2.0939, 5.7637, -0.9869];
    let assembly = ClosedLoop::new(&rrr).assemble(&q, &vec![0.0; 7], &[0, 3, 5]).expect("it closes");
    println!(
        "3-RRR: {:e} rad at {}, gap {:e}",
        assembly.largest_displacement, assembly.velocity, assembly.position_residual
    );
    assert!(
        assembly.position_residual < 1e-14
            && assembly.largest_displacement > 1e-3
            && assembly.largest_displacement < 0.05
    );
}

#[test]
fn a_loop_that_cannot_close_is_refused_with_the_position_residual() {
    // The rocker held where the crank and the coupler do not reach its tip.
    let error = ClosedLoop::new(&Fourbar).assemble(&[0.0, 3.0, 4.0], &[0.0; 3], &[1]).unwrap_err();
    println!("{error}");
    let distance = |angle: f64| (0.0895 - 0.1152 * angle.cos()).hypot(0.1152 * angle.sin()) - 0.1152 - 0.038;
    match error {
        LoopError::CannotClose { position_residual: gap, .. } => {
            assert!(gap > 0.3 * distance(3.0) && gap < 1.1 * distance(3.0), "{gap} of {}", distance(3.0));
        }
        other => panic!("{other}"),
    }
    assert!(error.to_string().contains(" m remains"), "{error}");
}

#[test]
fn held_velocities_that_are_inconsistent_with_the_loop_are_refused() {
    let loops = ClosedLoop::new(&Fourbar);
    let error = loops.assemble(&START, &[1.0, -1.0, 0.0], &[0, 1]).unwrap_err();
    assert!(matches!(error, LoopError::InconsistentVelocity { residual, .. } if residual > 1e-3), "{error}");
    assert_eq!(
        loops.assemble(&START, &[0.0; 3], &[7]).unwrap_err(),
        LoopError::VelocityOutOfRange { velocity: 7, count: 3 }
    );
    assert_eq!(loops.assemble(&[f64::NAN; 3], &[0.0; 3], &[]).unwrap_err(), LoopError::NotFinite);
    assert_eq!(loops.assemble(&START, &[f64::NAN; 3], &[]).unwrap_err(), LoopError::NotFinite);
}

/// All links in line and open: no first-order motion closes it, which must be said, or it must close.
#[test]
fn a_guess_with_all_links_in_line_ends_in_an_answer() {
    match ClosedLoop::new(&Windows).assemble(&[-1.569_f64, 1.5, -1.572, 1.6, -1.573], &[0.0; 5], &[]) {
        Ok(assembly) => assert!(
            assembly.position_residual < 1e-13 && assembly.q.iter().all(|q: &f64| q.is_finite()),
            "{assembly:?}"
        ),
        Err(error) => assert!(error.to_string().contains("position residual"), "{error}"),
    }
}

#[test]
fn a_start_that_is_not_closed_or_has_inconsistent_velocities_is_refused() {
    let simulation = ClosedLoopSimulation::new(ClosedLoop::new(&Fourbar), ZeroTorque);
    let error = simulation.start(&[0.0, 0.9844, 4.3144], &[0.0; 3]).unwrap_err();
    assert!(
        matches!(error, LoopError::NotClosed { position_residual: gap, .. } if 1e-6 < gap && gap < 1e-4),
        "{error}"
    );
    let error = simulation.start(&START, &[4.7124, 1.0, 0.0]).unwrap_err();
    assert!(matches!(error, LoopError::InconsistentVelocity { .. }), "{error}");
    assert_eq!(simulation.start(&START, &[f64::NAN, 0.0, 0.0]), Err(LoopError::NotFinite));
}

#[test]
fn baumgarte_with_steps_known_to_blow_up_is_refused() {
    let baumgarte = |alpha| {
        ClosedLoopSimulation::new(ClosedLoop::new(&Fourbar), ZeroTorque)
            .stabilisation(Stabilisation::Baumgarte { alpha })
    };
    let mut simulation = baumgarte(1300.0);
    let start = simulation.start(&START, &[0.0; 3]).expect("a closed start");
    let error = Ode4::new(1e-3).integrate(&mut simulation, (0.0, 0.01), start).unwrap_err();
    assert_eq!(error, IntegrationError::Refused { t: 1e-3 });
    let reason = simulation.last_error().expect("a reason");
    assert_eq!(reason, LoopError::UnstableBaumgarte { alpha: 1300.0, step: 1e-3 });
    assert!(reason.to_string().contains("below 1.3"), "{reason}");
    Ode4::new(9.9e-4).integrate(&mut simulation, (0.0, 0.0099), start).expect("just below");
    assert_eq!(Stabilisation::Baumgarte { alpha: 0.0 }.check(0.1), Err(LoopError::InvalidAlpha { alpha: 0.0 }));
    assert_eq!(
        Stabilisation::Baumgarte { alpha: 13.0 }.check(0.1),
        Err(LoopError::UnstableBaumgarte { alpha: 13.0, step: 0.1 })
    );
}

#[test]
fn a_torque_that_is_not_a_number_comes_out_with_the_reason() {
    let law = |t: f64, _: &[f64; 3], _: &[f64; 3]| [if t > 0.005 { f64::NAN } else { 0.0 }, 0.0, 0.0];
    let mut simulation = ClosedLoopSimulation::new(ClosedLoop::new(&Fourbar), law);
    let start = simulation.start(&START, &[0.0; 3]).expect("a closed start");
    let error = Ode4::new(1e-3).integrate(&mut simulation, (0.0, 0.01), start).unwrap_err();
    assert!(matches!(error, IntegrationError::NonFiniteDerivative { .. }), "{error}");
    assert_eq!(simulation.last_error(), Some(LoopError::NotFinite));
}

#[test]
fn the_four_bar_of_the_gui_is_mended_from_its_open_start() {
    let fourbar = generic("fourbar_gui");
    let shipped = vec![0.0, 145.54_f64.to_radians(), 130.54_f64.to_radians()];
    let open = redysim::LoopClosure::loop_residual(&fourbar, &shipped);
    assert!((open[0] - 3.4e-3).abs() < 1e-4 && (open[1] + 25.9e-3).abs() < 1e-4, "{open:?} m");
    let assembly = ClosedLoop::new(&fourbar).assemble(&shipped, &vec![0.0; 3], &[0]).expect("it closes");
    // At the consistent start both angles are the same, 130.54 degrees.
    assert!(assembly.q[1..].iter().all(|angle| (angle - 2.278_380_763_520_252).abs() < 1e-9), "{:?}", assembly.q);
    assert!((assembly.largest_displacement.to_degrees() - 15.0).abs() < 0.01 && assembly.velocity == 1);
}

#[test]
fn a_mechanism_without_loops_is_closed_as_it_stands() {
    let kr5 = generic("kr5");
    let loops = ClosedLoop::new(&kr5);
    let (q, v) = (vec![0.3; 6], vec![1.0; 6]);
    let assembly = loops.assemble(&q, &v, &[]).expect("nothing is open");
    assert_eq!((assembly.q, assembly.v, assembly.rank), (q.clone(), v.clone(), 0));
    assert_eq!(loops.project(&q, &v).expect("nothing drifts").v, v);
}

#[test]
fn a_link_that_weighs_next_to_nothing_closes_as_any_other() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/models/slider_crank.toml");
    let mut model = redysim::generic::Model::load(path).expect("a good model").model;
    for (link, factor) in model.links.iter_mut().zip([100.0, 1e-9, 10.0]) {
        link.mass *= factor;
        for moment in [&mut link.inertia.xx, &mut link.inertia.yy, &mut link.inertia.zz] {
            *moment *= factor;
        }
    }
    let light = redysim::generic::GenericMechanism::new(model);
    let assembly = ClosedLoop::new(&light).assemble(&vec![-1.0, 0.4, 1.5], &vec![0.0; 3], &[0]).expect("it closes");
    let heavy = generic("slider_crank");
    let same = ClosedLoop::new(&heavy).assemble(&vec![-1.0, 0.4, 1.5], &vec![0.0; 3], &[0]).expect("it closes");
    assert!(assembly.q.iter().zip(&same.q).all(|(a, b)| f64::abs(a - b) < 1e-12), "{:?} {:?}", assembly.q, same.q);
    assert_eq!(assembly.rank, 2);
}
