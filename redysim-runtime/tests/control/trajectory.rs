//! The cycloidal motion, against its definition.

use std::f64::consts::PI;

use redysim_runtime::{Cycloid, Motion, Trajectory, TrajectoryError};

const FROM: [f64; 3] = [0.5, -1.0, 2.0];
const TO: [f64; 3] = [1.5, 2.0, 2.0];
const DURATION: f64 = 2.5;

fn cycloid() -> Cycloid<f64, [f64; 3]> {
    Cycloid::new(FROM, TO, DURATION).unwrap()
}

#[test]
fn coordinates_follow_equation_one() {
    for k in 0..=50 {
        let t = DURATION * f64::from(k) / 50.0;
        let q = cycloid().at(t).q;
        for i in 0..3 {
            let expected =
                FROM[i] + (TO[i] - FROM[i]) / DURATION * (t - DURATION / (2.0 * PI) * (2.0 * PI * t / DURATION).sin());
            assert!((q[i] - expected).abs() < 1e-14, "{} instead of {expected}", q[i]);
        }
    }
}

#[test]
fn velocities_and_accelerations_are_the_derivatives() {
    let d = 1e-4;
    for k in 1..50 {
        let t = DURATION * f64::from(k) / 50.0;
        let [before, now, after] = [t - d, t, t + d].map(|t| cycloid().at(t));
        for i in 0..3 {
            assert!(((after.q[i] - before.q[i]) / (2.0 * d) - now.v[i]).abs() < 1e-7, "velocity at {t}");
            assert!(((after.v[i] - before.v[i]) / (2.0 * d) - now.a[i]).abs() < 1e-7, "acceleration at {t}");
        }
    }
}

#[test]
fn the_motion_rests_exactly_at_and_beyond_both_ends() {
    let resting = |q| Motion { q, v: [0.0; 3], a: [0.0; 3] };
    for t in [0.0, -0.0, -1.0, f64::NEG_INFINITY] {
        assert_eq!(cycloid().at(t), resting(FROM));
    }
    for t in [DURATION, 3.0, f64::INFINITY] {
        assert_eq!(cycloid().at(t), resting(TO));
    }
}

#[test]
fn the_motion_sets_off_and_arrives_smoothly() {
    for t in [1e-6, DURATION - 1e-6] {
        let motion = cycloid().at(t);
        for i in 0..3 {
            assert!(motion.v[i].abs() < 1e-10 && motion.a[i].abs() < 1e-4, "{motion:?}");
        }
    }
}

#[test]
fn single_precision_gives_the_same_motion() {
    let single = Cycloid::new(FROM.map(|x| x as f32), TO.map(|x| x as f32), DURATION as f32).unwrap().at(0.7);
    let double = cycloid().at(f64::from(0.7_f32));
    for i in 0..3 {
        assert!((f64::from(single.q[i]) - double.q[i]).abs() < 1e-6);
        assert!((f64::from(single.a[i]) - double.a[i]).abs() < 1e-5);
    }
}

#[test]
fn a_duration_is_positive_and_finite() {
    for duration in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = Cycloid::new(FROM, TO, duration).unwrap_err();
        assert!(matches!(error, TrajectoryError::BadDuration { .. }));
        assert!(error.to_string().contains(&format!("{duration:?} s")), "{error}");
    }
}

#[cfg(feature = "alloc")]
#[test]
fn start_and_end_have_the_same_joints() {
    let error = Cycloid::new(vec![0.0; 2], vec![1.0; 3], 1.0).unwrap_err();
    assert_eq!(error, TrajectoryError::DifferentLengths { from: 2, to: 3 });
    assert!(error.to_string().contains("2 joints start and 3 end"), "{error}");
}
