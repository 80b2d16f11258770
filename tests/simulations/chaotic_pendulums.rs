//! Two and three rods released from the horizontal: a motion that doubles every error in less than a second. It is
//! right for as long as double precision allows, and keeps its energy ever after.
#![cfg(feature = "generic")]

use redysim::Real;
use redysim::{Dop853, ForwardSimulation, Integrator, TreeDynamics, Vector, ZeroTorque, redysim};

redysim! { struct DoublePendulum("models/double_pendulum.toml"); }
redysim! { struct TriplePendulum("models/triple_pendulum.toml"); }

const TIGHT: f64 = 3e-14;

/// Largest errors of the coordinates, rad, up to each time of the reference, and of the energy over all, J.
struct Errors {
    coordinates: Vec<(f64, f64)>,
    energy: f64,
}

impl Errors {
    fn until(&self, time: f64) -> f64 {
        self.coordinates.iter().filter(|(t, _)| *t <= time).fold(0.0, |worst, (_, error)| Real::maximum(worst, *error))
    }
}

fn release<M: TreeDynamics<f64>>(mechanism: &M, case: &str, start: &[f64], tolerance: f64) -> Errors {
    let dof = mechanism.nv();
    let text = include_str!("../reference/kane_quad_pendulum_chains.csv");
    let rows: Vec<Vec<f64>> = text
        .lines()
        .filter_map(|line| line.strip_prefix(&format!("{case},{dof},")))
        .map(|line| line.split(',').map(|number| number.parse().expect("a number")).collect())
        .collect();
    assert!(rows.len() >= 5, "{case}: {} rows", rows.len());
    let q = M::Coordinates::from_fn(dof, |i| start[i]);
    let v = M::Velocities::from_fn(dof, |_| 0.0);
    let at_rest = mechanism.energy(&q, &v).total();
    let mut simulation = ForwardSimulation::new(mechanism, ZeroTorque);
    let state = simulation.state(&q, &v);
    let copy = ForwardSimulation::new(mechanism, ZeroTorque);
    let mut errors = Errors { coordinates: Vec::new(), energy: 0.0 };
    let mut expected = rows.iter();
    let times = rows.iter().map(|row| row[0]);
    Dop853::new()
        .rtol(tolerance)
        .atol(tolerance / 30.0)
        .solve(&mut simulation, (0.0, 20.0), state, times, |t, state| {
            let row = expected.next().expect("a row for every time");
            let now = copy.split(state);
            let off =
                now.q.as_ref().iter().zip(&row[1..]).fold(0.0_f64, |worst, (q, x)| Real::maximum(worst, (q - x).abs()));
            let energy = (mechanism.energy(&now.q, &now.v).total() - at_rest).abs();
            println!("{case}, {dof} rods, {t} s: {off:.1e} rad, {energy:.1e} J");
            errors.coordinates.push((t, off));
            errors.energy = errors.energy.max(energy);
        })
        .expect("it swings for 20 s");
    errors
}

#[test]
fn a_chaotic_release_is_right_for_ten_seconds_and_keeps_its_energy_for_twenty() {
    for errors in [
        release(&DoublePendulum, "horizontal", &[0.0; 2], TIGHT),
        release(&TriplePendulum, "horizontal", &[0.0; 3], TIGHT),
    ] {
        assert!(errors.until(5.0) <= 1e-10, "{:.1e} rad up to 5 s", errors.until(5.0));
        assert!(errors.until(10.0) <= 1e-7, "{:.1e} rad up to 10 s", errors.until(10.0));
        assert!(errors.energy <= 1e-11, "{:.1e} J", errors.energy);
    }
}

/// Nothing but the tightest tolerance will do: an error of 1e-10 in the first second is one of 1e-5 in the tenth.
#[test]
fn a_looser_tolerance_loses_a_chaotic_release() {
    let errors = release(&TriplePendulum, "horizontal", &[0.0; 3], 1e-9);
    assert!(errors.until(5.0) > 1e-10 && errors.until(10.0) > 1e-7);
    assert!(errors.energy < 1e-5, "and yet keeps its energy: {:.1e} J", errors.energy);
}

/// The same chains where they are not chaotic: the errors above are the motion's, not the method's.
#[test]
fn small_swings_are_right_to_twelve_digits_after_twenty_seconds() {
    let hanging = -std::f64::consts::FRAC_PI_2;
    for errors in [
        release(&DoublePendulum, "small", &[hanging + 0.3, 0.1], TIGHT),
        release(&TriplePendulum, "small", &[hanging + 0.3, 0.1, 0.0], TIGHT),
    ] {
        assert!(errors.until(20.0) <= 1e-12, "{:.1e} rad", errors.until(20.0));
    }
}
