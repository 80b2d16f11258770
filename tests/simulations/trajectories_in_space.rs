//! Trajectories of joints with orientations, against differences, turns of the base, and the splines of single angles.
#![cfg(feature = "generic")]

use crate::common::models::generic;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use redysim::Real;
use redysim::generic::{GenericMechanism, Model};
use redysim::{
    ConfigurationSpace, ConstantDirection, Cycloid, LengthMismatch, ManifoldSpline, Motion, TangentTrajectory,
    Trajectory, TrajectoryError, ViaPoints,
};

type Spline<'m> = ManifoldSpline<&'m GenericMechanism, Vec<f64>, Vec<f64>, Vec<f64>, f64>;
type Moved = Motion<Vec<f64>, Vec<f64>>;

/// A free body, on it a revolute joint, then a spherical and a prismatic one: 13 coordinates and 11 velocities.
fn robot() -> GenericMechanism {
    let body = "mass = 1\ncom = [0, 0, 0]\ninertia = { xx = 1, yy = 1, zz = 1 }\norigin = {}\n";
    let link = |name: &str, parent: &str, joint: &str| {
        format!("[[link]]\nname = '{name}'\nparent = '{parent}'\njoint = {joint}\n{body}")
    };
    let links = [
        link("hull", "base", "'free'"),
        link("arm", "hull", "'revolute'\naxis = [0, 0, 1]"),
        link("ball", "arm", "'spherical'"),
        link("slide", "ball", "'prismatic'\naxis = [1, 0, 0]"),
    ];
    let text = format!("name = 'robot'\ngravity = [0, 0, -9.81]\n{}", links.concat());
    GenericMechanism::new(Model::from_toml(text, "robot.toml").expect("a good model").model)
}

/// Displacements of up to `size` that follow no pattern.
fn displacement(k: usize, size: f64) -> Vec<f64> {
    (0..11).map(|i| size * (1.7 * k as f64 + 2.3 * i as f64 + 0.1 * (k * i) as f64).sin()).collect()
}

const TIMES: [f64; 5] = [0.0, 0.7, 1.5, 1.9, 3.0];

fn points(robot: &GenericMechanism) -> Vec<Vec<f64>> {
    (0..TIMES.len()).map(|k| robot.integrate(&robot.neutral(), &displacement(k, 0.9))).collect()
}

/// Points that the motion passes with given velocities and accelerations.
fn passed(robot: &GenericMechanism) -> Vec<Moved> {
    let passed = |(k, q)| Motion { q, v: displacement(k + 10, 2.0), a: displacement(k + 20, 3.0) };
    points(robot).into_iter().enumerate().map(passed).collect()
}

fn splines(robot: &GenericMechanism) -> [(&'static str, Spline<'_>); 3] {
    let times = || TIMES.to_vec();
    [
        ("minimum jerk", ManifoldSpline::minimum_jerk(robot, times(), points(robot)).expect("a motion")),
        ("cubic", ManifoldSpline::cubic(robot, times(), points(robot)).expect("a motion")),
        ("through", ManifoldSpline::through(robot, times(), passed(robot)).expect("a motion")),
    ]
}

/// The largest difference of components.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, Real::maximum)
}

/// Holds velocities and accelerations at `t` against differences of coordinates and velocities.
fn compare_with_differences(
    name: &str,
    robot: &GenericMechanism,
    trajectory: &impl Trajectory<f64, Vec<f64>, Vec<f64>>,
    t: f64,
) {
    let h = 1e-5;
    let [behind, here, ahead] = [t - h, t, t + h].map(|t| trajectory.at(t));
    let v: Vec<f64> = robot.difference(&behind.q, &ahead.q).iter().map(|way| way / (2.0 * h)).collect();
    let a: Vec<f64> = ahead.v.iter().zip(&behind.v).map(|(ahead, behind)| (ahead - behind) / (2.0 * h)).collect();
    // Truncation h²/6 of third derivatives some hundred times as large, rounding 1e-15/h.
    let tolerance =
        2e-8 * here.v.iter().chain(&here.a).fold(1.0, |largest: f64, part| Real::maximum(largest, part.abs()));
    assert!(apart(&v, &here.v) < tolerance, "{name} at {t}: {v:?}, {:?}", here.v);
    assert!(apart(&a, &here.a) < tolerance, "{name} at {t}: {a:?}, {:?}", here.a);
}

#[test]
fn velocities_and_accelerations_are_derivatives_on_the_manifold() {
    let robot = robot();
    for (name, spline) in splines(&robot) {
        for t in [0.1, 0.35, 0.69, 0.71, 1.2, 1.7, 2.0, 2.9] {
            compare_with_differences(name, &robot, &spline, t);
        }
    }
    // A way that bends, slow at first, where power series stand for sines, and later of more than a turn.
    let way = |t: f64| {
        let (linear, square) = (displacement(30, 2.0), displacement(31, 1.0));
        Motion {
            q: (0..11).map(|i| linear[i] * t + square[i] * t * t).collect(),
            v: (0..11).map(|i| linear[i] + 2.0 * square[i] * t).collect(),
            a: (0..11).map(|i| 2.0 * square[i]).collect::<Vec<f64>>(),
        }
    };
    let bent = TangentTrajectory { mechanism: &robot, from: points(&robot)[1].clone(), way };
    for t in [0.0, 0.01, 0.2, 0.5, 1.0, 2.0] {
        compare_with_differences("on the tangent", &robot, &bent, t);
    }
}

#[test]
fn a_spline_passes_its_points_without_a_jump_of_velocity_or_acceleration() {
    let robot = robot();
    for (name, spline) in splines(&robot) {
        assert_eq!(spline.span(), (0.0, 3.0));
        for (k, &t) in TIMES.iter().enumerate() {
            let (here, point) = (spline.at(t), &points(&robot)[k]);
            assert!(apart(&robot.difference(&here.q, point), &[0.0; 11]) < 1e-15, "{name}");
            let sides = [t - 1e-9, t + 1e-9].map(|t| spline.at(t));
            for side in sides.iter().skip(usize::from(k == 0)).take(if k == 0 || k == 4 { 1 } else { 2 }) {
                assert!(apart(&side.q, &here.q) < 1e-7, "{name} at {t}");
                assert!(apart(&side.v, &here.v) < 1e-6 && apart(&side.a, &here.a) < 1e-5, "{name} at {t}");
            }
        }
        let (before, after) = (spline.at(-1.0), spline.at(4.0));
        assert_eq!((&before.q, &after.q), (&spline.at(0.0).q, &spline.at(3.0).q));
        assert!([&before.v, &before.a, &after.v, &after.a].iter().all(|rest| **rest == vec![0.0; 11]));
    }
    let through = ManifoldSpline::through(&robot, TIMES.to_vec(), passed(&robot)).expect("a motion");
    let (here, expected) = (through.at(TIMES[2]), &passed(&robot)[2]);
    assert_eq!((&here.v, &here.a), (&expected.v, &expected.a));
    let rest = splines(&robot)[0].1.at(3.0);
    assert!(rest.v.iter().chain(&rest.a).all(|zero| *zero == 0.0), "{rest:?}");
}

/// The position in axes of the base that are turned and displaced.
fn seen_from(turn: &UnitQuaternion<f64>, q: &[f64]) -> Vec<f64> {
    let mut q = q.to_vec();
    let position = turn * Vector3::new(q[0], q[1], q[2]) + Vector3::new(3.0, -1.0, 2.0);
    q[..3].copy_from_slice(position.as_slice());
    for first in [3, 8] {
        let product = turn.quaternion() * Quaternion::new(q[first + 3], q[first], q[first + 1], q[first + 2]);
        q[first..first + 4].copy_from_slice(product.coords.as_slice());
    }
    q
}

#[test]
fn motions_do_not_depend_on_the_axes_of_the_base() {
    let robot = robot();
    let turn = UnitQuaternion::new(Vector3::new(-1.3, 0.4, 2.2));
    let turned = |points: Vec<Vec<f64>>| points.iter().map(|q| seen_from(&turn, q)).collect::<Vec<_>>();
    let same = |name: &str, found: &Moved, expected: &Moved| {
        let way = robot.difference(&found.q, &seen_from(&turn, &expected.q));
        assert!(apart(&way, &[0.0; 11]) < 1e-13, "{name}: {way:?}");
        assert!(apart(&found.v, &expected.v) < 1e-12, "{name}: {:?} {:?}", found.v, expected.v);
        assert!(apart(&found.a, &expected.a) < 1e-11, "{name}: {:?} {:?}", found.a, expected.a);
    };
    let of_turned = [
        ManifoldSpline::minimum_jerk(&robot, TIMES.to_vec(), turned(points(&robot))).expect("a motion"),
        ManifoldSpline::cubic(&robot, TIMES.to_vec(), turned(points(&robot))).expect("a motion"),
    ];
    for ((name, spline), of_turned) in splines(&robot).iter().zip(&of_turned) {
        for t in [0.2, 0.7, 1.1, 1.6, 2.5] {
            same(name, &of_turned.at(t), &spline.at(t));
        }
    }
    let screw = |points: Vec<Vec<f64>>| {
        let law = Cycloid::new([0.0], [1.0], 2.0).expect("a law");
        TangentTrajectory::along_screw(&robot, points[0].clone(), &points[1], law).expect("a motion")
    };
    same("screw", &screw(turned(points(&robot))).at(0.6), &screw(points(&robot)).at(0.6));
}

/// Checks a motion of the spherical joint against that of its angle about (2, −3, 6)/7.
fn compare_with_angle(robot: &GenericMechanism, from: &[f64], found: &Moved, angle: &Motion<[f64; 1], [f64; 1]>) {
    let along =
        |size: f64| (0..11).map(|i| if (7..10).contains(&i) { size * AXIS[i - 7] } else { 0.0 }).collect::<Vec<f64>>();
    let expected = robot.integrate(&from.to_vec(), &along(angle.q[0]));
    assert!(apart(&robot.difference(&expected, &found.q), &[0.0; 11]) < 1e-13, "{:?} {expected:?}", found.q);
    assert!(apart(&found.v, &along(angle.v[0])) < 1e-12, "{:?} {angle:?}", found.v);
    assert!(apart(&found.a, &along(angle.a[0])) < 1e-11, "{:?} {angle:?}", found.a);
}

const AXIS: [f64; 3] = [2.0 / 7.0, -3.0 / 7.0, 6.0 / 7.0];

/// The positions at the angles of the spherical joint, from `from`.
fn about_axis(robot: &GenericMechanism, from: &Vec<f64>, angles: &[f64]) -> Vec<Vec<f64>> {
    let way = |angle: &f64| (0..11).map(|i| if (7..10).contains(&i) { angle * AXIS[i - 7] } else { 0.0 }).collect();
    angles.iter().map(|angle| robot.integrate(from, &way(angle))).collect()
}

#[test]
fn about_one_axis_motions_are_those_of_the_angle() {
    let robot = robot();
    let from = points(&robot)[2].clone();
    // More than a turn, the ways between points less than half of one.
    let angles = [0.0, 2.9, 4.0, 7.0, 6.5];
    let points = about_axis(&robot, &from, &angles);
    let angles: Vec<[f64; 1]> = angles.iter().map(|angle| [*angle]).collect();
    let (times, t) = (TIMES.to_vec(), [0.3, 0.7, 1.0, 1.4, 1.7, 2.2, 2.9]);
    let jerk = ManifoldSpline::minimum_jerk(&robot, times.clone(), points.clone()).expect("a motion");
    let of_angle = ViaPoints::minimum_jerk(times.clone(), angles.clone()).expect("a motion");
    t.iter().for_each(|&t| compare_with_angle(&robot, &from, &jerk.at(t), &of_angle.at(t)));
    let cubic = ManifoldSpline::cubic(&robot, times.clone(), points.clone()).expect("a motion");
    let of_angle = ViaPoints::cubic(times, angles).expect("a motion");
    t.iter().for_each(|&t| compare_with_angle(&robot, &from, &cubic.at(t), &of_angle.at(t)));

    let law = |to: f64| Cycloid::new([0.0], [to], 2.0).expect("a law");
    let short = TangentTrajectory::along_screw(&robot, from.clone(), &points[1], law(1.0)).expect("a motion");
    compare_with_angle(&robot, &from, &short.at(0.6), &law(2.9).at(0.6));
    // The shorter way to 4 rad is back.
    let back = TangentTrajectory::along_screw(&robot, from.clone(), &points[2], law(1.0)).expect("a motion");
    compare_with_angle(&robot, &from, &back.at(0.6), &law(4.0 - std::f64::consts::TAU).at(0.6));
    // Three turns and a half.
    let way = (0..11).map(|i| if (7..10).contains(&i) { 22.0 * AXIS[i - 7] } else { 0.0 }).collect();
    let turns =
        TangentTrajectory { mechanism: &robot, from: from.clone(), way: ConstantDirection { way, law: law(1.0) } };
    compare_with_angle(&robot, &from, &turns.at(1.1), &law(22.0).at(1.1));
}

#[test]
fn a_quaternion_and_its_negative_are_the_same_point() {
    let robot = robot();
    let mut opposite = points(&robot);
    for (k, first) in [(1, 3), (1, 8), (3, 3), (4, 8)] {
        opposite[k][first..first + 4].iter_mut().for_each(|component| *component = -*component);
    }
    let splines = [points(&robot), opposite]
        .map(|points| ManifoldSpline::minimum_jerk(&robot, TIMES.to_vec(), points).expect("a motion"));
    let mut before = splines[0].at(0.0).q;
    for k in 0..=300 {
        let [one, other] = [&splines[0], &splines[1]].map(|spline| spline.at(0.01 * f64::from(k)));
        assert_eq!(one, other);
        assert!(apart(&one.q, &before) < 0.1, "its quaternions do not change their sign");
        before = one.q;
    }
}

#[test]
fn joints_of_one_coordinate_move_as_through_via_points_to_the_last_bit() {
    let arm = generic("two_link");
    let (times, points) = (vec![0.0, 0.3, 1.0], vec![vec![0.1, 0.7], vec![1.0 / 3.0, -0.2], vec![2.0, 0.3]]);
    let of_manifold = ManifoldSpline::minimum_jerk(&arm, times.clone(), points.clone()).expect("a motion");
    let of_angles = ViaPoints::minimum_jerk(times.clone(), points.clone()).expect("a motion");
    let cubic = ManifoldSpline::cubic(&arm, times.clone(), points.clone()).expect("a motion");
    let cubic_of_angles = ViaPoints::cubic(times, points).expect("a motion");
    for k in -10..=120 {
        let t = 0.01 * f64::from(k);
        assert_eq!(of_manifold.at(t), of_angles.at(t));
        assert_eq!(cubic.at(t), cubic_of_angles.at(t));
    }
}

#[test]
fn a_free_joint_goes_straight_through_points_on_a_line_however_it_turns() {
    let parcel = generic("parcel");
    let direction = [1.0, -2.0, 0.5];
    let point = |(s, turn): (f64, [f64; 3])| {
        let mut q = parcel.integrate(&parcel.neutral(), &[0.0; 3].into_iter().chain(turn).collect());
        (0..3).for_each(|i| q[i] = s * direction[i]);
        q
    };
    let points = [(0.0, [0.0; 3]), (0.4, [0.0, 1.0, 2.0]), (1.0, [1.5, 0.0, -0.4])].map(point).to_vec();
    let line = ManifoldSpline::minimum_jerk(&parcel, vec![0.0, 1.0, 2.0], points).expect("a motion");
    let along = ViaPoints::minimum_jerk([0.0, 1.0, 2.0], [[0.0], [0.4], [1.0]]).expect("a motion");
    for k in 0..=20 {
        let t = 0.1 * f64::from(k);
        let expected = direction.map(|component| component * along.at(t).q[0]);
        assert!(apart(&line.at(t).q[..3], &expected) < 1e-14, "{t}");
        compare_with_differences("line", &parcel, &line, (0.03 + t).min(1.97));
    }
}

/// Between samples a motion of two orientations, one after the other, is met better by the fourth power of their distance.
#[test]
fn unrolled_splines_meet_a_smooth_motion_the_better_the_closer_its_points() {
    let top = generic("spherical_pendulum");
    let tumble = |t: f64| {
        let s = t * t * t * (10.0 + t * (6.0 * t - 15.0));
        let middle = top.integrate(&top.neutral(), &vec![2.0 * s, -s, 0.5 * s]);
        top.integrate(&middle, &vec![0.3 * s * s, 1.8 * s, -2.2 * s])
    };
    let error = |count: u32| {
        let times: Vec<f64> = (0..=count).map(|k| f64::from(k) / f64::from(count)).collect();
        let points = times.iter().map(|&t| tumble(t)).collect();
        let spline = ManifoldSpline::minimum_jerk(&top, times, points).expect("a motion");
        let between = (0..count).map(|k| (f64::from(k) + 0.5) / f64::from(count));
        between.map(|t| apart(&top.difference(&spline.at(t).q, &tumble(t)), &[0.0; 3])).fold(0.0, Real::maximum)
    };
    let errors = [8, 16, 32].map(error);
    println!("{errors:?}");
    assert!(errors[2] < 1e-6 && errors[0] > 15.0 * errors[1] && errors[1] > 15.0 * errors[2], "{errors:?}");
}

#[test]
fn points_that_no_way_leads_to_and_vectors_of_other_lengths_are_refused() {
    let robot = robot();
    let with = |change: &dyn Fn(&mut Vec<f64>)| {
        let mut points = points(&robot);
        change(&mut points[3]);
        ManifoldSpline::minimum_jerk(&robot, TIMES.to_vec(), points).expect_err("a fault")
    };
    assert_eq!(with(&|q| q[8..12].fill(0.0)), TrajectoryError::NoWay { point: 3 });
    assert_eq!(with(&|q| q[7] = f64::NAN), TrajectoryError::NoWay { point: 3 });
    let mismatch = LengthMismatch { vector: "q", length: 12, expected: 13 };
    assert_eq!(with(&|q| q.truncate(12)), TrajectoryError::WrongLength(mismatch));
    let mut short = passed(&robot);
    short[2].a.clear();
    let mismatch = LengthMismatch { vector: "a", length: 0, expected: 11 };
    let error = ManifoldSpline::through(&robot, TIMES.to_vec(), short).expect_err("a fault");
    assert_eq!(error, TrajectoryError::WrongLength(mismatch));
    assert!(error.to_string().ends_with("`a` must have 11 elements, but it has 0"), "{error}");
    let error = ManifoldSpline::cubic(&robot, vec![0.0, 1.0], points(&robot)).expect_err("a fault");
    assert_eq!(error, TrajectoryError::DifferentCounts { times: 2, points: 5 });
    let law = Cycloid::new([0.0], [1.0], 2.0).expect("a law");
    let error = TangentTrajectory::along_screw(&robot, robot.neutral(), &vec![0.0; 13], law).expect_err("a fault");
    assert_eq!(error, TrajectoryError::NoWay { point: 1 });
    let error = TangentTrajectory::along_screw(&robot, vec![], &robot.neutral(), law).expect_err("a fault");
    assert_eq!(error, TrajectoryError::WrongLength(LengthMismatch { vector: "from", length: 0, expected: 13 }));
}
