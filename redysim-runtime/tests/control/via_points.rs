//! Motions through points, against the polynomials that they must be and the integrals that they must make least.

use redysim_runtime::{Motion, Trajectory, TrajectoryError, ViaPoints};

const TIMES: [f64; 4] = [0.5, 1.25, 3.0, 3.5];
const POINTS: [[f64; 2]; 4] = [[0.0, 1.0], [2.0, -1.0], [1.0, 3.0], [-1.0, 0.5]];

#[test]
fn between_two_points_least_jerk_is_the_polynomial_of_flash_and_hogan() {
    let motion = ViaPoints::minimum_jerk([1.0, 3.0], [[2.0], [-1.0]]).unwrap();
    for k in 0..=40 {
        let s = f64::from(k) / 40.0;
        let found = motion.at(1.0 + 2.0 * s);
        let q = 2.0 - 3.0 * (10.0 * s.powi(3) - 15.0 * s.powi(4) + 6.0 * s.powi(5));
        let v = -3.0 * (30.0 * s.powi(2) - 60.0 * s.powi(3) + 30.0 * s.powi(4)) / 2.0;
        let a = -3.0 * (60.0 * s - 180.0 * s.powi(2) + 120.0 * s.powi(3)) / 4.0;
        for (found, expected) in [(found.q, q), (found.v, v), (found.a, a)] {
            assert!((found[0] - expected).abs() < 1e-13, "{found:?} instead of {expected} at s = {s}");
        }
    }
}

#[test]
fn between_two_points_the_cubic_is_the_one_at_rest_at_both_ends() {
    let motion = ViaPoints::cubic([0.0, 2.0], [[1.0], [5.0]]).unwrap();
    for k in 0..=20 {
        let s = f64::from(k) / 20.0;
        let found = motion.at(2.0 * s);
        assert!((found.q[0] - (1.0 + 4.0 * (3.0 * s * s - 2.0 * s.powi(3)))).abs() < 1e-14, "{found:?}");
        assert!((found.v[0] - 2.0 * (6.0 * s - 6.0 * s * s)).abs() < 1e-14, "{found:?}");
        assert!((found.a[0] - (6.0 - 12.0 * s)).abs() < 1e-14, "{found:?}");
    }
}

/// The k-th difference quotient of the coordinates ahead of `t` (`side` 1) or behind it (−1), extrapolated to `t`.
fn derivative(motion: &impl Trajectory<f64, [f64; 2], [f64; 2]>, t: f64, side: f64, order: usize) -> f64 {
    // Of accelerations, which are exact, so that no more than two differences are taken: the polynomial's own degree is
    // 3.
    let h = 0.01 * side;
    let a: Vec<f64> = (0..4).map(|k| motion.at(t + h * (f64::from(k) + 1e-9)).a[0]).collect();
    match order {
        3 => (-11.0 * a[0] + 18.0 * a[1] - 9.0 * a[2] + 2.0 * a[3]) / (6.0 * h),
        4 => (2.0 * a[0] - 5.0 * a[1] + 4.0 * a[2] - a[3]) / (h * h),
        _ => a[0],
    }
}

#[test]
fn least_jerk_passes_every_point_with_jerk_and_snap_unbroken() {
    let motion = ViaPoints::minimum_jerk(TIMES, POINTS).unwrap();
    for (t, q) in TIMES.into_iter().zip(POINTS) {
        assert_eq!(motion.at(t).q, q);
    }
    for end in [0.5, 3.5] {
        assert_eq!((motion.at(end).v, motion.at(end).a), ([0.0; 2], [0.0; 2]), "at rest");
    }
    for t in [1.25, 3.0] {
        for (order, most) in [(2, 1e-5), (3, 1e-3), (4, 1e-1)] {
            let [behind, ahead] = [-1.0, 1.0].map(|side| derivative(&motion, t, side, order));
            assert!((behind - ahead).abs() < most, "derivative {order} at {t} s: {behind} and {ahead}");
        }
    }
}

#[test]
fn the_cubic_passes_every_point_with_acceleration_unbroken_and_constant_jerk_between() {
    let motion = ViaPoints::cubic(TIMES, POINTS).unwrap();
    for (t, q) in TIMES.into_iter().zip(POINTS) {
        assert_eq!(motion.at(t).q, q);
    }
    for t in [1.25, 3.0] {
        let [behind, ahead] = [-1e-9, 1e-9].map(|d| motion.at(t + d).a[0]);
        assert!((behind - ahead).abs() < 1e-6, "{behind} and {ahead} at {t} s");
    }
    for pair in TIMES.windows(2) {
        let at = |part: f64| motion.at(pair[0] + part * (pair[1] - pair[0])).a[1];
        assert!((at(0.25) - 2.0 * at(0.5) + at(0.75)).abs() < 1e-11, "the acceleration is a line");
    }
    assert_eq!(motion.at(0.5).v, [0.0; 2]);
    assert!(motion.at(0.5).a[0] != 0.0, "it sets off with a jerk");
}

/// ∫ x(t)² dt over the points' times by Simpson's rule on a grid that has the points on it.
fn integral(x: impl Fn(f64) -> f64) -> f64 {
    TIMES
        .windows(2)
        .map(|pair| {
            let h = (pair[1] - pair[0]) / 400.0;
            let at = |k: u32| x((pair[0] + h * f64::from(k)).clamp(pair[0] + 1e-9, pair[1] - 1e-9)).powi(2);
            (0..200).map(|k| h / 3.0 * (at(2 * k) + 4.0 * at(2 * k + 1) + at(2 * k + 2))).sum::<f64>()
        })
        .sum()
}

/// The motion through the points with other velocities and accelerations at those between.
fn bent(by: f64) -> impl Trajectory<f64, [f64; 2], [f64; 2]> {
    let best = ViaPoints::minimum_jerk(TIMES, POINTS).unwrap();
    let points = std::array::from_fn(|k| {
        let Motion { q, v, a } = best.at(TIMES[k]);
        let by = if k == 1 || k == 2 { by } else { 0.0 };
        Motion { q, v: [v[0] + by, v[1]], a: [a[0] - 2.0 * by, a[1]] }
    });
    ViaPoints::through(TIMES, points).unwrap()
}

#[test]
fn no_other_velocities_and_accelerations_at_the_points_have_less_jerk() {
    let d = 1e-4;
    let jerk = |by: f64| {
        let motion = bent(by);
        integral(|t| (motion.at(t + d).a[0] - motion.at(t - d).a[0]) / (2.0 * d))
    };
    let best = jerk(0.0);
    assert!(jerk(0.3) > 1.001 * best && jerk(-0.3) > 1.001 * best, "{} {best} {}", jerk(-0.3), jerk(0.3));
}

#[test]
fn a_motion_through_states_has_them_and_their_derivatives() {
    let points: [[f64; 3]; 3] = [[0.0, 1.0, -2.0], [1.0, 0.5, 4.0], [-1.0, 0.0, 0.0]];
    let points = points.map(|[q, v, a]| Motion { q: [q], v: [v], a: [a] });
    let times: [f64; 3] = [0.0, 1.0, 1.5];
    let motion = ViaPoints::through(times, points).unwrap();
    for (t, point) in times.into_iter().zip(points) {
        assert_eq!(motion.at(t), point);
    }
    let d = 1e-4;
    for t in [0.1, 0.5, 0.9, 1.2, 1.4] {
        let [before, now, after] = [t - d, t, t + d].map(|t| motion.at(t));
        assert!(((after.q[0] - before.q[0]) / (2.0 * d) - now.v[0]).abs() < 1e-5, "velocity at {t}");
        assert!(((after.v[0] - before.v[0]) / (2.0 * d) - now.a[0]).abs() < 1e-4, "acceleration at {t}");
    }
}

#[test]
fn a_motion_stands_at_its_ends_before_and_after() {
    let motion = ViaPoints::cubic(TIMES, POINTS).unwrap();
    for (t, q) in [(-1.0, POINTS[0]), (0.499, POINTS[0]), (3.6, POINTS[3]), (f64::INFINITY, POINTS[3])] {
        assert_eq!(motion.at(t), Motion { q, v: [0.0; 2], a: [0.0; 2] });
    }
    assert!(motion.at(f64::NAN).q[0].is_nan(), "no time has no place");
}

#[test]
fn single_precision_gives_the_same_motion() {
    let single = ViaPoints::minimum_jerk(TIMES.map(|t| t as f32), POINTS.map(|q| q.map(|x| x as f32))).unwrap();
    let double = ViaPoints::minimum_jerk(TIMES, POINTS).unwrap().at(f64::from(2.1_f32));
    let single = single.at(2.1);
    assert!((f64::from(single.q[0]) - double.q[0]).abs() < 1e-5, "{single:?} {double:?}");
    assert!((f64::from(single.a[1]) - double.a[1]).abs() < 1e-3, "{single:?} {double:?}");
}

#[test]
fn points_follow_each_other_in_time() {
    for (times, point) in [([0.0, 0.0, 1.0], 1), ([0.0, 2.0, 1.0], 2), ([0.0, f64::NAN, 1.0], 1)] {
        let error = ViaPoints::cubic(times, [[0.0]; 3]).unwrap_err();
        assert!(matches!(error, TrajectoryError::TimesOutOfOrder { point: found, .. } if found == point), "{error}");
    }
    let error = ViaPoints::cubic([0.0, 2.0, 1.0], [[0.0]; 3]).unwrap_err().to_string();
    assert!(error.contains("point 2 (counted from 0) is at t = 1.0 s and the one before it at 2.0 s"), "{error}");
    assert_eq!(ViaPoints::cubic([0.0], [[0.0]]).unwrap_err(), TrajectoryError::TooFewPoints { given: 1 });
}

#[cfg(feature = "alloc")]
#[test]
fn every_point_has_a_time_and_the_same_joints() {
    let error = ViaPoints::cubic(vec![0.0, 1.0], vec![vec![0.0]]).unwrap_err();
    assert_eq!(error, TrajectoryError::DifferentCounts { times: 2, points: 1 });
    let error = ViaPoints::minimum_jerk(vec![0.0, 1.0], vec![vec![0.0], vec![0.0; 2]]).unwrap_err();
    assert_eq!(error, TrajectoryError::DifferentLengths { from: 1, to: 2 });
}
