//! A ball on the ground: forces, energy, and bounces against a separate integration.

use core::ops::ControlFlow;

use crate::mechanisms::{Ball, GRAVITY};
use redysim_runtime::integrate::{Ends, EveryStep};
use redysim_runtime::{
    AnyContactLaw, ConfigurationSpace, Contact, ContactError, ContactEvent, ContactLaw, ForwardDynamics,
    ForwardSimulation, FrameState, GroundPlane, Grounded, HuntCrossleyContact, IntegrationError, Integrator,
    MechanicalEnergy, Ode45, ReDySimContact, Real, SemiImplicitEuler, Solution, Statistics, Step, ZeroTorque,
};

const BALL: Ball = Ball { mass: 0.5 };
const RUBBER: HuntCrossleyContact<f64> =
    HuntCrossleyContact { stiffness: 2e5, exponent: 1.5, damping: 0.1, friction: 0.3, slip_velocity: 0.05 };
/// Of little damping, so that the ball bounces.
const REDYSIM: ReDySimContact<f64> =
    ReDySimContact { stiffness: 1e4, damping: 8.0, leaving_speed: 5.0, friction: 0.3, sliding_damping: 20.0 };

fn floor() -> GroundPlane<f64> {
    GroundPlane::new([0.0; 3], [0.0, 0.0, 1.0]).unwrap()
}

type Run = Result<Solution<f64, [f64; 7]>, IntegrationError<f64>>;

/// The ball from 0.5 m above the ground at 1 m/s along x, for `end` seconds at the tolerance `rtol`, from event to
/// event, and the events.
fn bounces<L: ContactLaw<f64>>(law: L, end: f64, rtol: f64) -> (Run, Vec<ContactEvent<f64>>) {
    let contacts = [Contact::new(0, floor(), law).unwrap()];
    let grounded = Grounded::new(&BALL, &contacts).unwrap();
    let mut simulation = ForwardSimulation::new(&grounded, ZeroTorque);
    let start = simulation.state(&[0.0, 0.0, 0.5], &[1.0, 0.0, 0.0]);
    let mut events = vec![];
    let method = Ode45::new().rtol(rtol).atol(1e-2 * rtol);
    let run = grounded.run(&method, &mut simulation, (0.0, end), start, &mut Ends, |event| events.push(event));
    (run, events)
}

/// The same at the hands of the integrator alone.
fn bounces_without_events<L: ContactLaw<f64>>(law: L, end: f64, rtol: f64) -> Run {
    let contacts = [Contact::new(0, floor(), law).unwrap()];
    let grounded = Grounded::new(&BALL, &contacts).unwrap();
    let mut simulation = ForwardSimulation::new(&grounded, ZeroTorque);
    let start = simulation.state(&[0.0, 0.0, 0.5], &[1.0, 0.0, 0.0]);
    Ode45::new().rtol(rtol).atol(1e-2 * rtol).integrate(&mut simulation, (0.0, end), start)
}

/// The same flight by a parabola to the height at which `force` begins and, in contact, by the classical Runge-Kutta
/// rule with steps of a microsecond; [x, z, ẋ, ż] at `end`, and the times at which the contact begins and ends.
/// `force` gives the force along x and z.
fn separately(onset: f64, end: f64, force: impl Fn([f64; 4]) -> [f64; 2]) -> ([f64; 4], Vec<f64>) {
    let rate = |y: [f64; 4]| {
        let [x, z] = force(y);
        [y[2], y[3], x / BALL.mass, z / BALL.mass - GRAVITY]
    };
    let moved = |y: [f64; 4], h: f64, k: [f64; 4]| [0, 1, 2, 3].map(|i| y[i] + h * k[i]);
    let step = |y: [f64; 4], h: f64| {
        let k1 = rate(y);
        let k2 = rate(moved(y, h / 2.0, k1));
        let k3 = rate(moved(y, h / 2.0, k2));
        let k4 = rate(moved(y, h, k3));
        [0, 1, 2, 3].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]))
    };
    let fall =
        |[x, z, vx, vz]: [f64; 4], h: f64| [x + vx * h, z + vz * h - GRAVITY / 2.0 * h * h, vx, vz - GRAVITY * h];
    let (mut t, mut y, mut changes) = (0.0, [0.0, 0.5, 1.0, 0.0], vec![]);
    loop {
        // z + onset + ż h − g h²/2 = 0
        let h = (y[3] + (y[3] * y[3] + 2.0 * GRAVITY * (y[1] + onset)).sqrt()) / GRAVITY;
        if t + h >= end {
            return (fall(y, end - t), changes);
        }
        (t, y) = (t + h, fall(y, h));
        changes.push(t);
        let h = 1e-6;
        loop {
            if t + h >= end {
                return (step(y, end - t), changes);
            }
            let next = step(y, h);
            if next[1] + onset > 0.0 {
                break;
            }
            (t, y) = (t + h, next);
        }
        let (mut inside, mut outside) = (0.0, h);
        for _ in 0..60 {
            let middle = 0.5 * (inside + outside);
            if step(y, middle)[1] + onset > 0.0 { outside = middle } else { inside = middle }
        }
        (t, y) = (t + outside, step(y, outside));
        changes.push(t);
    }
}

/// Fails unless a run is that of a separate integration.
fn agree(run: Run, events: &[ContactEvent<f64>], (reference, changes): ([f64; 4], Vec<f64>), tolerance: f64) {
    let y = run.unwrap().y;
    let found = [y[0], y[2], y[3], y[5]];
    for (found, reference) in found.iter().zip(reference) {
        assert!((found - reference).abs() < tolerance, "{found} instead of {reference}");
    }
    assert!(changes.len() >= 5 && events.len() == changes.len(), "{events:?} {changes:?}");
    for (index, (event, t)) in events.iter().zip(changes).enumerate() {
        assert!((event.t - t).abs() < tolerance && event.touching == (index % 2 == 0), "{event:?}, not {t}");
    }
}

/// The tolerance is a hundred times that of the steps, for bounces multiply errors of velocity by their times.
#[test]
fn a_ball_bounces_under_the_law_of_hunt_and_crossley_as_in_a_separate_integration() {
    let reference = separately(0.0, 2.0, |[_, z, vx, vz]| {
        let p = (-z).max(0.0);
        let normal = (2e5 * p * p.sqrt() * (1.0 - 0.1 * vz)).max(0.0);
        [-0.3 * normal * vx / vx.hypot(0.05), normal]
    });
    let (run, events) = bounces(RUBBER, 2.0, 1e-11);
    agree(run, &events, reference, 1e-9);
}

#[test]
fn a_ball_bounces_under_redysims_law_as_in_a_separate_integration() {
    let reference = separately(1e-5, 2.0, |[_, z, vx, vz]| {
        let (p, full) = (-z, 1.2 * 5.0 * 8.0 / 1e4);
        // ReDySim's coefficients of c = a₄ p³ + a₃ p².
        let (a3, a4) = (3.0 * 8.0 / (full * full), -2.0 * 8.0 / (full * full * full));
        let c = if vz > 0.0 && p <= full { a4 * p.powi(3) + a3 * p.powi(2) } else { 8.0 };
        let normal = 1e4 * p - c * vz;
        let limit = 2.0 / std::f64::consts::PI * 0.3 * normal.abs();
        [-limit * (20.0 * vx / limit).atan(), normal]
    });
    let (run, events) = bounces(REDYSIM, 2.0, 1e-11);
    agree(run, &events, reference, 1e-9);
}

/// Measured: 1053 evaluations (22 rejected steps) instead of 1789 (85) under ReDySim's law, whose force jumps at the
/// touch-down, and 1149 (9) instead of 1363 (43) under that of Hunt and Crossley, whose force does not.
#[test]
fn events_keep_adaptive_steps_from_stumbling_over_touch_downs() {
    fn compare(law: impl ContactLaw<f64> + Copy) -> [Statistics; 2] {
        [bounces(law, 2.0, 1e-6).0, bounces_without_events(law, 2.0, 1e-6)].map(|run| run.unwrap().statistics)
    }
    let [with, without] = compare(REDYSIM);
    assert!(with.evaluations < 1100 && with.rejected < 25, "{with:?}");
    assert!(5 * with.evaluations < 3 * without.evaluations && 3 * with.rejected < without.rejected, "{without:?}");
    let [with, without] = compare(RUBBER);
    assert!(with.evaluations < 1200 && with.rejected < 12, "{with:?}");
    assert!(with.evaluations < without.evaluations && 3 * with.rejected < without.rejected, "{without:?}");
}

/// Kinetic and potential energy, that of the ground with it, less E_act. The tolerance is that of a hundred steps.
#[test]
fn energy_is_balanced_at_every_step_of_bounces_with_friction() {
    for law in [AnyContactLaw::ReDySim(REDYSIM), AnyContactLaw::HuntCrossley(RUBBER)] {
        let contacts = [Contact::new(0, floor(), law).unwrap()];
        let grounded = Grounded::new(&BALL, &contacts).unwrap();
        let mut simulation = ForwardSimulation::new(&grounded, ZeroTorque);
        let start: [f64; 7] = simulation.state(&[0.0, 0.0, 0.5], &[1.0, -0.7, 0.0]);
        let total = |y: &[f64; 7]| grounded.energy(&[y[0], y[1], y[2]], &[y[3], y[4], y[5]]).total() - y[6];
        let (before, mut worst, mut stored) = (total(&start), 0.0_f64, 0.0_f64);
        let mut see = EveryStep(|step: &Step<'_, f64, [f64; 7]>| {
            let y = step.end().1;
            worst = Real::maximum(worst, (total(y) - before).abs());
            stored = stored.max(grounded.ground_energy(&[y[0], y[1], y[2]], &[y[3], y[4], y[5]]));
            ControlFlow::Continue(())
        });
        let method = Ode45::new().rtol(1e-10).atol(1e-12);
        let end = grounded.run(&method, &mut simulation, (0.0, 2.0), start, &mut see, |_| {}).unwrap();
        assert!(worst < 1e-8 && stored > 1.0, "{law:?}: {worst} {stored}");
        // After the run, touching follows from the position again.
        assert!(grounded.ground_energy(&[0.0, 0.0, -0.01], &[0.0; 3]) > 0.0);
        assert_eq!(grounded.ground_energy(&[0.0, 0.0, 0.01], &[0.0; 3]), 0.0);
        assert!(end.y[6] < -0.5, "the ground has taken {} J", -end.y[6]);
    }
}

/// N ṗ = dU/dt + P, with dU/dt by central differences of U at the penetrations before and after.
#[test]
fn force_energy_and_dissipation_of_a_law_agree() {
    for law in [AnyContactLaw::ReDySim(REDYSIM), AnyContactLaw::HuntCrossley(RUBBER)] {
        for p in [2e-4, 3e-3, 0.02] {
            for rate in [-20.0, -0.3, 0.0, 0.4, 3.0] {
                let normal = law.normal(p, rate);
                let h = 1e-4 * p;
                let slope = (law.normal(p + h, rate).energy - law.normal(p - h, rate).energy) / (2.0 * h);
                let rest = normal.force * rate - slope * rate - normal.dissipated_power;
                let scale = slope * rate.abs() + normal.dissipated_power + f64::MIN_POSITIVE;
                // The third derivative of U by that of p^(5/2), and rounding.
                assert!(rest.abs() < 1e-8 * scale && normal.dissipated_power >= 0.0, "{law:?} {p} {rate}: {rest}");
            }
        }
    }
}

#[test]
fn contacts_of_one_frame_and_of_several_add_up() {
    let contacts = [0, 0, 1].map(|frame| Contact::new(frame, floor(), RUBBER).unwrap());
    let (q, v) = ([0.0, 0.0, -0.01], [0.2, 0.0, -0.1]);
    let grounded = Grounded::new(&BALL, &contacts).unwrap();
    let single = Grounded::new(&BALL, &contacts[2..]).unwrap();
    let (all, one) = (grounded.ground_forces(&q, &v), single.ground_forces(&q, &v));
    for (all, one) in all.iter().zip(one) {
        assert!((all - 3.0 * one).abs() < 1e-12, "{all} {one}");
    }
    assert!(one[0] < -1.0 && one[1] == 0.0 && one[2] > 100.0, "{one:?}");
    let accelerations = grounded.forward_dynamics(&q, &v, &[0.0; 3]);
    assert!((accelerations[2] - (all[2] / BALL.mass - GRAVITY)).abs() < 1e-10);
    assert!((grounded.dissipated_power(&q, &v) - 3.0 * single.dissipated_power(&q, &v)).abs() < 1e-10);
    let mut penetrations = vec![];
    grounded.reactions(&q, &v, |contact, reaction| penetrations.push((contact.frame(), reaction.penetration)));
    assert_eq!(penetrations, [(0, 0.01), (0, 0.01), (1, 0.01)]);
}

/// Forces, power, energy and accelerations of the ball in a state on ground through the origin.
fn grounded_ball<S: Real>(law: AnyContactLaw<S>, normal: [f32; 3], q: [f32; 3], v: [f32; 3]) -> [Vec<f64>; 4] {
    let numbers = |vector: [f32; 3]| vector.map(|x| S::from_f64(f64::from(x)));
    let ground = GroundPlane::new([S::zero(); 3], numbers(normal)).unwrap();
    let contacts = [Contact::new(0, ground, law).unwrap()];
    let grounded = Grounded::new(&BALL, &contacts).unwrap();
    let (q, v) = (numbers(q), numbers(v));
    let one = |x: S| vec![x.to_f64()];
    let all = |vector: [S; 3]| vector.map(Real::to_f64).to_vec();
    [
        all(grounded.ground_forces(&q, &v)),
        one(grounded.ground_power(&q, &v)),
        one(grounded.ground_energy(&q, &v)),
        all(grounded.forward_dynamics(&q, &v, &[S::zero(); 3])),
    ]
}

/// In states in which the ball hits the ground, slides and leaves it, on level ground, whose heights are exact, and on
/// inclined ground. Parts of a force cancel where the ball leaves: an error is a share of their sizes, which are those of
/// the same speed into the ground.
#[test]
fn forces_energies_and_powers_in_single_precision_are_those_in_double_precision_to_a_few_roundings() {
    // Of parameters that are exact in single precision.
    fn laws<S: Real>() -> [AnyContactLaw<S>; 2] {
        let [stiffness, exponent, damping, friction, slip_velocity] =
            [2e5, 1.5, 0.125, 0.3125, 0.0625].map(S::from_f64);
        let hunt = HuntCrossleyContact { stiffness, exponent, damping, friction, slip_velocity };
        let [stiffness, damping, leaving_speed, friction, sliding_damping] =
            [1e4, 8.0, 5.0, 0.3125, 20.0].map(S::from_f64);
        let redysim = ReDySimContact { stiffness, damping, leaving_speed, friction, sliding_damping };
        [AnyContactLaw::HuntCrossley(hunt), AnyContactLaw::ReDySim(redysim)]
    }
    let (mut worst, mut pushed) = (0.0_f64, 0);
    for (single, double) in laws::<f32>().into_iter().zip(laws::<f64>()) {
        for normal in [[0.0, 0.0, 1.0], [0.25, -0.5, 1.0]] {
            for depth in [3e-4_f32, 2e-3, 0.017] {
                for speed in [-3.0_f32, -0.2, 0.0, 0.3, 7.0] {
                    let (q, v) = ([0.1 * depth, 0.3 * depth, -depth], [0.7 * speed, 0.2, speed]);
                    let found = grounded_ball(single, normal, q, v);
                    let expected = grounded_ball(double, normal, q, v);
                    let hits = grounded_ball(double, normal, q, [v[0], v[1], -speed.abs()]);
                    let force = hits[0].iter().fold(0.0_f64, |most, x| Real::maximum(most, x.abs()));
                    let scales = [force, force * f64::from(speed.abs().max(1.0)), hits[2][0], force / BALL.mass];
                    for ((found, expected), scale) in found.iter().zip(&expected).zip(scales) {
                        for (found, expected) in found.iter().zip(expected) {
                            worst = Real::maximum(worst, (found - expected).abs() / scale);
                        }
                    }
                    pushed += usize::from(force > 0.0 && expected[0][2] > 0.0);
                }
            }
        }
    }
    println!("{:.1} roundings in {pushed} states", worst / f64::from(f32::EPSILON));
    assert!(worst < 8.0 * f64::from(f32::EPSILON) && pushed > 40, "{worst:e} in {pushed} states");
}

/// A step of 10 ms under the damping of 500 N s/m throws a ball of 0.5 kg back nine times as fast as it came, out of the
/// ground before time has passed; between, it falls as before.
#[test]
fn steps_too_long_for_the_damping_of_the_ground_are_reported_where_contacts_chatter() {
    let law = ReDySimContact { damping: 500.0, ..REDYSIM };
    let contacts = [Contact::new(0, floor(), law).unwrap()];
    let grounded = Grounded::new(&BALL, &contacts).unwrap();
    let mut simulation = ForwardSimulation::new(&grounded, ZeroTorque);
    let start = simulation.state(&[0.0, 0.0, 0.1], &[0.0; 3]);
    let mut run = |step: f64| {
        let method = SemiImplicitEuler::new(step);
        grounded.run(&method, &mut simulation, (0.0, 0.3), start, &mut Ends, |_| {}).map(|end| end.y[2])
    };
    let error = run(1e-2).unwrap_err();
    let fallen = (0.2 / GRAVITY).sqrt();
    assert!(matches!(error, IntegrationError::Chattering { t, events: 101 } if (t - fallen).abs() < 1e-2), "{error}");
    assert!(run(1e-4).unwrap().abs() < 1e-2);
}

#[test]
fn contacts_of_frames_that_the_mechanism_does_not_have_are_errors() {
    let contacts = [0, 2].map(|frame| Contact::new(frame, floor(), RUBBER).unwrap());
    let error = Grounded::new(&BALL, &contacts).unwrap_err();
    assert_eq!(error, ContactError::UnknownFrame { contact: 1, frame: 2, frames: 2 });
    let message = error.to_string();
    assert!(
        message.starts_with("contact 1 (counted from 0) is of frame 2, but the mechanism has 2 frames"),
        "{message}"
    );
}

/// At the angle α, the acceleration along the slope is g (sin α − μ cos α) while it slides faster than ε by far: friction
/// is short of Coulomb's by (ε/v)²/2 of it.
#[test]
fn a_ball_slides_down_an_inclined_plane_against_coulomb_friction() {
    let (sin, cos) = (0.6, 0.8);
    let slope = GroundPlane::new([0.0; 3], [sin, 0.0, cos]).unwrap();
    let law = HuntCrossleyContact { slip_velocity: 1e-4, damping: 5.0, ..RUBBER };
    let contacts = [Contact::new(0, slope, law).unwrap()];
    let grounded = Grounded::new(&BALL, &contacts).unwrap();
    let mut simulation = ForwardSimulation::new(&grounded, ZeroTorque);
    // In equilibrium along the normal, k p^(3/2) = m g cos α.
    let depth = (0.5 * GRAVITY * cos / 2e5).powf(2.0 / 3.0);
    let start = simulation.state(&[-depth * sin, 0.0, -depth * cos], &[cos, 0.0, -sin]);
    let end = grounded
        .run(&Ode45::new().rtol(1e-9).atol(1e-11), &mut simulation, (0.0, 0.5), start, &mut Ends, |_| {})
        .unwrap();
    let speed = end.y[3] * cos - end.y[5] * sin;
    assert!((speed - (1.0 + 0.5 * GRAVITY * (sin - 0.3 * cos))).abs() < 1e-6, "{speed}");
}

#[test]
fn above_the_ground_nothing_acts_and_a_state_that_is_not_a_number_stays_one() {
    let contact = Contact::new(0, floor(), REDYSIM).unwrap();
    let at = |z| FrameState { origin: [0.0, 0.0, z], velocity: [1.0, 0.0, -1.0], ..FrameState::default() };
    let reaction = contact.reaction(&at(-0.9e-5));
    assert_eq!((reaction.force, reaction.energy, reaction.touching), ([0.0; 3], 0.0, false));
    assert!(contact.reaction(&at(-1.1e-5)).touching);
    assert!(contact.reaction(&at(f64::NAN)).force[2].is_nan());
}
