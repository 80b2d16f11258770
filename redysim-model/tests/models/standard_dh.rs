//! Standard (distal) Denavit-Hartenberg parameters: the same robot as by Khalil-Kleinfinger's, and the robots of data
//! sheets and textbooks.

use redysim_model::spatial::{Mat3, Vec3};
use redysim_model::{GenericMechanism, Inertia, Model};
use redysim_runtime::{
    BiasForces, ForwardDynamics, GravityForces, InverseDynamics, LinkKinematics, LinkState, LoopClosure, MassMatrix,
    MechanicalEnergy,
};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use std::fmt::Write;
use std::path::Path;

/// A row of standard parameters with what it carries, in the frame at its far end.
#[derive(Clone, Copy)]
struct Row {
    joint: &'static str,
    a: f64,
    alpha: f64,
    d: f64,
    theta: f64,
    mass: f64,
    com: [f64; 3],
    /// xx, yy, zz, xy, yz, xz.
    inertia: [f64; 6],
}

const fn row(joint: &'static str, [a, alpha, d, theta]: [f64; 4], mass: f64, com: [f64; 3], inertia: [f64; 6]) -> Row {
    Row { joint, a, alpha, d, theta, mass, com, inertia }
}

/// Masses, centres of mass and inertias of no particular links.
fn body(number: usize) -> (f64, [f64; 3], [f64; 6]) {
    let x = number as f64;
    let com = [0.1 - 0.03 * x, 0.05 * x - 0.1, 0.02 + 0.04 * x];
    (4.0 - 0.5 * x, com, [0.2 + 0.01 * x, 0.25, 0.3 - 0.02 * x, 0.03, -0.02, 0.01 + 0.005 * x])
}

fn with_bodies<const N: usize>(rows: [(&'static str, [f64; 4]); N]) -> Vec<Row> {
    let numbered = rows.into_iter().enumerate();
    numbered
        .map(|(number, (joint, parameters))| {
            let (mass, com, inertia) = body(number);
            row(joint, parameters, mass, com, inertia)
        })
        .collect()
}

/// The Stanford arm (Paul, Robot Manipulators, table 2.2, with its wrist on the slide).
fn stanford() -> Vec<Row> {
    with_bodies([
        ("revolute", [0.0, -FRAC_PI_2, 0.412, 0.0]),
        ("revolute", [0.0, FRAC_PI_2, 0.154, 0.0]),
        ("prismatic", [0.0, 0.0, 0.3, -FRAC_PI_2]),
        ("revolute", [0.0, -FRAC_PI_2, 0.0, 0.0]),
        ("revolute", [0.0, FRAC_PI_2, 0.0, 0.0]),
        ("revolute", [0.0, 0.0, 0.263, 0.0]),
    ])
}

/// Every length and angle there is, on every kind of joint.
fn oblique() -> Vec<Row> {
    with_bodies([
        ("revolute", [0.3, 0.7, 0.2, 0.4]),
        ("prismatic", [-0.2, -1.1, 0.5, 0.9]),
        ("helical", [0.1, 0.3, -0.4, 1.3]),
        ("fixed", [0.25, 2.1, 0.15, -0.6]),
        ("revolute", [-0.35, -0.8, 0.1, -2.2]),
        ("prismatic", [0.15, 1.9, -0.3, 2.8]),
        ("revolute", [0.2, -0.5, 0.05, 0.1]),
    ])
}

/// The PUMA 560 with the inertias of Armstrong, Khatib and Burdick in standard frames, as Corke's Robotics Toolbox has it
/// (`mdl_puma560`).
fn puma560() -> Vec<Row> {
    vec![
        row("revolute", [0.0, FRAC_PI_2, 0.0, 0.0], 0.0, [0.0; 3], [0.0, 0.35, 0.0, 0.0, 0.0, 0.0]),
        row("revolute", [0.4318, 0.0, 0.0, 0.0], 17.4, [-0.3638, 0.006, 0.2275], [0.13, 0.524, 0.539, 0.0, 0.0, 0.0]),
        row(
            "revolute",
            [0.0203, -FRAC_PI_2, 0.15005, 0.0],
            4.8,
            [-0.0203, -0.0141, 0.070],
            [0.066, 0.086, 0.0125, 0.0, 0.0, 0.0],
        ),
        row(
            "revolute",
            [0.0, FRAC_PI_2, 0.4318, 0.0],
            0.82,
            [0.0, 0.019, 0.0],
            [1.8e-3, 1.3e-3, 1.8e-3, 0.0, 0.0, 0.0],
        ),
        row("revolute", [0.0, -FRAC_PI_2, 0.0, 0.0], 0.34, [0.0; 3], [0.3e-3, 0.4e-3, 0.3e-3, 0.0, 0.0, 0.0]),
        row("revolute", [0.0; 4], 0.09, [0.0, 0.0, 0.032], [0.15e-3, 0.15e-3, 0.04e-3, 0.0, 0.0, 0.0]),
    ]
}

/// The robot as a model file, with the placement and the body of each row by `link`.
fn model(rows: &[Row], link: impl Fn(usize) -> (String, [f64; 3], [f64; 6])) -> GenericMechanism {
    let mut text = String::from("name = 'robot'\ngravity = [1.1, -2.3, -9.81]\n");
    for (number, Row { joint, mass, .. }) in rows.iter().enumerate() {
        let (placement, [x, y, z], [xx, yy, zz, xy, yz, xz]) = link(number);
        let parent = number.checked_sub(1).map_or("base".into(), |parent| format!("link{parent}"));
        let pitch = if *joint == "helical" { "pitch = 0.3\n" } else { "" };
        write!(
            text,
            "[[link]]\nname = 'link{number}'\nparent = '{parent}'\njoint = '{joint}'\n{pitch}{placement}\nmass = {mass:?}\n\
             com = [{x:?}, {y:?}, {z:?}]\n\
             inertia = {{ xx = {xx:?}, yy = {yy:?}, zz = {zz:?}, xy = {xy:?}, yz = {yz:?}, xz = {xz:?} }}\n"
        )
        .unwrap();
    }
    read(&text)
}

fn read(text: &str) -> GenericMechanism {
    GenericMechanism::new(Model::from_toml(text, "robot.toml").unwrap_or_else(|faults| panic!("{faults}")).model)
}

fn load(name: &str) -> GenericMechanism {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models").join(name);
    GenericMechanism::new(Model::load(path).unwrap_or_else(|faults| panic!("{faults}")).model)
}

fn standard(rows: &[Row]) -> GenericMechanism {
    model(rows, |number| {
        let Row { a, alpha, d, theta, com, inertia, .. } = rows[number];
        (
            format!("dh_standard = {{ a = {a:?}, alpha = {}, d = {d:?}, theta = {} }}", rad(alpha), rad(theta)),
            com,
            inertia,
        )
    })
}

fn rad(angle: f64) -> String {
    format!("'{angle:?} rad'")
}

/// The same robot by Khalil-Kleinfinger's parameters: a row has the a and alpha of the one before, and its body is turned
/// and moved from the far end to the joint.
fn khalil_kleinfinger(rows: &[Row]) -> GenericMechanism {
    model(rows, |number| {
        let Row { a, alpha, d, theta, com: [x, y, z], inertia: [xx, yy, zz, xy, yz, xz], .. } = rows[number];
        let (a_before, alpha_before) =
            number.checked_sub(1).map_or((0.0, 0.0), |before| (rows[before].a, rows[before].alpha));
        let placement =
            format!("dh = {{ a = {a_before:?}, alpha = {}, b = {d:?}, theta = {} }}", rad(alpha_before), rad(theta));
        let (s, c) = sin_cos(alpha);
        // Rx I Rxᵀ, written out.
        let inertia = [
            xx,
            c * c * yy + s * s * zz - 2.0 * s * c * yz,
            s * s * yy + c * c * zz + 2.0 * s * c * yz,
            c * xy - s * xz,
            s * c * (yy - zz) + (c * c - s * s) * yz,
            s * xy + c * xz,
        ];
        (placement, [x + a, c * y - s * z, s * y + c * z], inertia)
    })
}

/// Exact at quarter turns.
fn sin_cos(angle: f64) -> (f64, f64) {
    let (s, c) = angle.sin_cos();
    let exact = |x: f64| if (x - x.round()).abs() < 1e-15 { x.round() } else { x };
    (exact(s), exact(c))
}

/// Tx(a) Rx(alpha): a link's frame by standard parameters in the one by Khalil-Kleinfinger's.
fn far_end(row: &Row) -> (Mat3<f64>, Vec3<f64>) {
    let (s, c) = sin_cos(row.alpha);
    (Mat3([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]), Vec3([row.a, 0.0, 0.0]))
}

/// A few states without pattern.
fn states(dof: usize) -> impl Iterator<Item = [Vec<f64>; 3]> {
    (0..20).map(move |state| {
        [1, 2, 3].map(|which| (0..dof).map(|i| 2.5 * f64::sin((97 * state + 31 * which + 7 * i * i) as f64)).collect())
    })
}

/// Whether vectors are equal to `tolerance` of the largest element.
fn assert_close(what: &str, found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len(), "{what}");
    let size = expected.iter().fold(0.0_f64, |size, x| size.max(x.abs()));
    let error = found.iter().zip(expected).fold(0.0_f64, |error, (a, b)| error.max((a - b).abs()));
    assert!(error <= tolerance * size, "{what}: {:.1e} of {size}", error / size);
}

/// The joint forces are sums over up to seven links, whose constants the two descriptions round differently.
const EQUAL: f64 = 1e-15;

/// The condition of a positive definite matrix in the Frobenius norm, at most as many times that of its eigenvalues as it
/// has rows; its inverse by Gauss and Jordan.
fn condition(matrix: &[Vec<f64>]) -> f64 {
    let n = matrix.len();
    let norm = |rows: &[Vec<f64>]| rows.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
    let unit = |i: usize| (0..n).map(move |j| if i == j { 1.0 } else { 0.0 });
    let mut rows: Vec<Vec<f64>> =
        matrix.iter().enumerate().map(|(i, row)| row.iter().copied().chain(unit(i)).collect()).collect();
    for pivot in 0..n {
        let by = rows[pivot][pivot];
        assert!(by > 0.0, "positive definite");
        rows[pivot].iter_mut().for_each(|x| *x /= by);
        let of_pivot = rows[pivot].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|(i, _)| *i != pivot) {
            let factor = row[pivot];
            row.iter_mut().zip(&of_pivot).for_each(|(x, of_pivot)| *x -= factor * of_pivot);
        }
    }
    let inverse: Vec<Vec<f64>> = rows.into_iter().map(|row| row[n..].to_vec()).collect();
    norm(matrix) * norm(&inverse)
}

fn assert_same_robot(rows: &[Row]) {
    let (ours, theirs) = (standard(rows), khalil_kleinfinger(rows));
    let dof = ours.model().dof();
    for [q, v, a] in states(dof) {
        let tau: Vec<f64> = theirs.inverse_dynamics(&q, &v, &a);
        assert_close("inverse dynamics", &ours.inverse_dynamics(&q, &v, &a), &tau, EQUAL);
        let [matrix, expected] = [&ours, &theirs].map(|robot| robot.mass_matrix(&q).concat());
        assert_close("mass matrix", &matrix, &expected, EQUAL);
        assert_close("bias forces", &ours.bias_forces(&q, &v), &theirs.bias_forces(&q, &v), EQUAL);
        assert_close("gravity forces", &ours.gravity_forces(&q), &theirs.gravity_forces(&q), EQUAL);
        let [energy, expected] = [&ours, &theirs].map(|robot| robot.energy(&q, &v));
        // Potential energies of links above and below the base cancel, their roundings do not.
        let weight = |link: &redysim_model::Link| 10.2 * link.mass;
        let links = theirs.link_kinematics(&q, &v);
        let height = |link: &LinkState<f64>| Vec3(link.com).dot(Vec3(link.com)).sqrt();
        let lifted: f64 = theirs.model().links.iter().zip(&links).map(|(link, at)| weight(link) * height(at)).sum();
        assert!((energy.kinetic - expected.kinetic).abs() <= EQUAL * expected.kinetic);
        assert!((energy.potential - expected.potential).abs() <= EQUAL * lifted);

        // Roundings of the forces, times the condition of the matrix that turns them into accelerations.
        let rounding = EQUAL * condition(&theirs.mass_matrix(&q)).max(1e3);
        assert_close("forward dynamics", &ours.forward_dynamics(&q, &v, &tau), &a, rounding);

        let [ours, theirs] = [&ours, &theirs].map(|robot| robot.link_kinematics(&q, &v));
        let flat = |states: &[LinkState<f64>], part: fn(&LinkState<f64>) -> [f64; 3]| {
            states.iter().flat_map(part).collect::<Vec<_>>()
        };
        assert_close("centres of mass", &flat(&ours, |link| link.com), &flat(&theirs, |link| link.com), EQUAL);
        let omega = |link: &LinkState<f64>| link.angular_velocity;
        assert_close("angular velocities", &flat(&ours, omega), &flat(&theirs, omega), EQUAL);
        let at_far_end: Vec<_> = theirs
            .iter()
            .zip(rows)
            .map(|(link, row)| {
                let (rotation, position) = far_end(row);
                let arm = Mat3(link.rotation) * position;
                let velocity = Vec3(link.velocity) + Vec3(link.angular_velocity).cross(arm);
                LinkState {
                    rotation: (Mat3(link.rotation) * rotation).0,
                    origin: (Vec3(link.origin) + arm).0,
                    velocity: velocity.0,
                    ..*link
                }
            })
            .collect();
        assert_close("origins", &flat(&ours, |link| link.origin), &flat(&at_far_end, |link| link.origin), EQUAL);
        assert_close("velocities", &flat(&ours, |link| link.velocity), &flat(&at_far_end, |link| link.velocity), EQUAL);
        for (ours, theirs) in ours.iter().zip(&at_far_end) {
            assert_close("axes", &ours.rotation.concat(), &theirs.rotation.concat(), EQUAL);
        }
    }
}

#[test]
fn standard_parameters_describe_the_robot_that_khalil_kleinfinger_parameters_describe() {
    for rows in [stanford(), oblique(), puma560()] {
        assert_same_robot(&rows);
    }
}

/// The matrix of a row as textbooks print it (Spong, Hutchinson, Vidyasagar, Robot Modeling and Control, section 3.2).
fn textbook(a: f64, alpha: f64, d: f64, theta: f64) -> [[f64; 4]; 4] {
    let ((sa, ca), (st, ct)) = (alpha.sin_cos(), theta.sin_cos());
    [[ct, -st * ca, st * sa, a * ct], [st, ct * ca, -ct * sa, a * st], [0.0, sa, ca, d], [0.0, 0.0, 0.0, 1.0]]
}

fn product(a: [[f64; 4]; 4], b: [[f64; 4]; 4]) -> [[f64; 4]; 4] {
    [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| (0..4).map(|k| a[i][k] * b[k][j]).sum()))
}

/// The data sheet's rows, as a person copies them: a, alpha, d.
const UR5: [[f64; 3]; 6] = [
    [0.0, FRAC_PI_2, 0.089159],
    [-0.425, 0.0, 0.0],
    [-0.39225, 0.0, 0.0],
    [0.0, FRAC_PI_2, 0.10915],
    [0.0, -FRAC_PI_2, 0.09465],
    [0.0, 0.0, 0.0823],
];

#[test]
fn link_frames_of_the_ur5_are_the_products_of_the_textbook_matrices() {
    let ur5 = load("test/ur5.toml");
    for [q, v, _] in states(6) {
        let mut frame = textbook(0.0, 0.0, 0.0, 0.0);
        for (link, ([a, alpha, d], q)) in ur5.link_kinematics(&q, &v).iter().zip(UR5.into_iter().zip(&q)) {
            frame = product(frame, textbook(a, alpha, d, *q));
            for (i, [x, y, z, position]) in frame.into_iter().take(3).enumerate() {
                assert!((link.origin[i] - position).abs() < 1e-15);
                assert!(
                    link.rotation[i].iter().zip([x, y, z]).all(|(found, expected)| (found - expected).abs() < 2e-15)
                );
            }
        }
    }
    // Stretched along −x, the tool stands at −(a2 + a3) and −(d4 + d6), and points along −y.
    let tool = ur5.link_kinematics(&vec![0.0; 6], &vec![0.0; 6])[5];
    assert_close("tool", &tool.origin, &[-0.81725, -0.19145, -0.005491], 1e-15);
}

/// A vertical axis carries no weight.
#[test]
fn the_first_axis_of_the_ur5_meets_no_gravity() {
    let ur5 = load("test/ur5.toml");
    for [q, ..] in states(6) {
        let gravity = ur5.gravity_forces(&q);
        assert!(gravity[0].abs() < 1e-14 && gravity[1].abs() > 1e-3, "{gravity:?}");
    }
}

/// Corke, Robotics, Vision and Control (2nd edition, section 9.2), for the PUMA 560 at its nominal position: gravity load,
/// N m, and the inertia matrix, kg m², to the digits that are printed. The printed diagonal includes G² Jm of the motors.
#[test]
fn gravity_and_inertia_of_the_puma_560_are_those_of_the_robotics_toolbox() {
    let puma = standard(&puma560()).model().clone();
    let puma = GenericMechanism::new(Model { gravity: Vec3([0.0, 0.0, -9.81]), ..puma });
    let q = vec![0.0, FRAC_PI_4, PI, 0.0, FRAC_PI_4, 0.0];
    let gravity = puma.gravity_forces(&q);
    for (found, printed) in gravity.iter().zip([0.0, 31.6399, 6.0351, 0.0, 0.0283, 0.0]) {
        assert!((found - printed).abs() < 0.5e-4, "{gravity:?}");
    }
    let printed = [
        [3.6594, -0.4044, 0.1006, -0.0025, 0.0000, 0.0000],
        [-0.4044, 4.4137, 0.3509, 0.0000, 0.0024, 0.0000],
        [0.1006, 0.3509, 0.9378, 0.0000, 0.0015, 0.0000],
        [-0.0025, 0.0000, 0.0000, 0.1925, 0.0000, 0.0000],
        [0.0000, 0.0024, 0.0015, 0.0000, 0.1713, 0.0000],
        [0.0000, 0.0000, 0.0000, 0.0000, 0.0000, 0.1941],
    ];
    let motors =
        [(200e-6, 62.6111), (200e-6, 107.815), (200e-6, 53.7063), (33e-6, 76.0364), (33e-6, 71.923), (33e-6, 76.686)];
    let matrix = puma.mass_matrix(&q);
    for (i, row) in matrix.iter().enumerate() {
        for (j, element) in row.iter().enumerate() {
            let (inertia, ratio): (f64, f64) = motors[i];
            let motor = if i == j { inertia * ratio * ratio } else { 0.0 };
            assert!((element + motor - printed[i][j]).abs() < 1e-4, "M[{i}][{j}] = {}", element + motor);
        }
    }
}

/// A tool by `origin` and `axis`, and another by `dh`, on a link by standard parameters stand in its far-end frame; a loop's
/// point does, too; and a link by standard parameters on a link by `origin` turns about that one's z axis.
#[test]
fn placements_of_every_kind_stand_in_the_frame_of_the_parent_link() {
    let text = "name = 'mixed'\ngravity = [0, 0, -9.81]\n\
        [[link]]\nname = 'mast'\nparent = 'base'\njoint = 'revolute'\n\
        origin = { xyz = [0.1, 0.2, 0.3], rpy = ['90 deg', 0, 0] }\naxis = [0, 1, 0]\nmass = 1\ncom = [0.1, 0, 0]\n\
        [[link]]\nname = 'arm'\nparent = 'mast'\njoint = 'revolute'\n\
        dh_standard = { a = 0.5, alpha = '90 deg', d = 0.4, theta = '30 deg' }\nmass = 1\ncom = [-0.2, 0, 0.1]\n\
        [[link]]\nname = 'tool'\nparent = 'arm'\njoint = 'prismatic'\n\
        origin = { xyz = [0.01, 0.02, 0.03] }\naxis = [1, 0, 0]\nmass = 1\n\
        [[link]]\nname = 'wrist'\nparent = 'arm'\njoint = 'revolute'\ndh = { a = 0.2, b = 0.1 }\nmass = 1\ncom = [0.1, 0, 0]\n\
        [[loop]]\nname = 'pin'\njoint = 'spherical'\nlink_a = 'arm'\npoint_a = [0.05, 0.06, 0.07]\nlink_b = 'base'\n";
    let mixed = read(text);
    let q: Vec<f64> = vec![0.6, -0.4, 0.15, 0.9];
    let pose = |rotation: [[f64; 3]; 3], position: [f64; 3]| {
        let [x, y, z] = [0, 1, 2].map(|i| [rotation[i][0], rotation[i][1], rotation[i][2], position[i]]);
        [x, y, z, [0.0, 0.0, 0.0, 1.0]]
    };
    let ((s, c), (sz, cz)) = (q[0].sin_cos(), q[3].sin_cos());
    let upright = pose([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]], [0.1, 0.2, 0.3]);
    let mast = product(upright, pose([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]], [0.0; 3]));
    let arm = product(mast, textbook(0.5, FRAC_PI_2, 0.4, PI / 6.0 + q[1]));
    let identity = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let tool = product(arm, pose(identity, [0.01 + q[2], 0.02, 0.03]));
    let wrist = product(arm, pose([[cz, -sz, 0.0], [sz, cz, 0.0], [0.0, 0.0, 1.0]], [0.2, 0.0, 0.1]));
    let found = mixed.link_kinematics(&q, &vec![0.0; 4]);
    for (link, expected) in found.iter().zip([mast, arm, tool, wrist]) {
        let origin = [0, 1, 2].map(|i| expected[i][3]);
        assert_close("origin", &link.origin, &origin, EQUAL);
        let axes = [0, 1, 2].map(|i| [expected[i][0], expected[i][1], expected[i][2]]).concat();
        assert_close("axes", &link.rotation.concat(), &axes, EQUAL);
    }
    let pin = product(arm, pose(identity, [0.05, 0.06, 0.07]));
    // The residual is the point on side b, the origin of the base, against that on side a.
    let residual: f64 = mixed.loop_residual(&q).iter().map(|x| x * x).sum::<f64>().sqrt();
    let distance = (0..3).map(|i| pin[i][3] * pin[i][3]).sum::<f64>().sqrt();
    assert!((residual - distance).abs() < 1e-15);
}

#[test]
fn a_locked_joint_holds_the_link_at_its_far_end() {
    let robot = standard(&oblique());
    let [q, v, _] = states(6).nth(3).unwrap();
    let moving: Vec<_> = robot.model().moving_links().map(|link| link.joint_name.clone()).collect();
    let held = robot.model().locked(&[(&moving[2], q[2]), (&moving[4], q[4])]).unwrap();
    let held = GenericMechanism::new(held);
    let left = |x: &[f64]| [0, 1, 3, 5].map(|i| x[i]).to_vec();
    let still = [0, 1, 2, 3, 4, 5].map(|i| if i == 2 || i == 4 { 0.0 } else { v[i] }).to_vec();
    let (found, expected) = (held.link_kinematics(&left(&q), &left(&v)), robot.link_kinematics(&q, &still));
    for (found, expected) in found.iter().zip(&expected) {
        assert_close("origin", &found.origin, &expected.origin, EQUAL);
        assert_close("centre of mass", &found.com, &expected.com, EQUAL);
        assert_close("velocity", &found.velocity, &expected.velocity, EQUAL);
        assert_close("axes", &found.rotation.concat(), &expected.rotation.concat(), EQUAL);
    }
    assert_eq!(robot.model().links[0].inertia, Inertia { xx: 0.2, yy: 0.25, zz: 0.3, xy: 0.03, yz: -0.02, xz: 0.01 });
}
