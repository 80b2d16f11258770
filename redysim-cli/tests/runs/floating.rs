//! Robots that float: the shipped scenarios against references in quadruple precision.

use std::fs;
use std::path::Path;

use nalgebra::{Matrix3, Vector3};
use redysim_model::{GenericMechanism, Model};
use redysim_runtime::{LinkKinematics, LinkState, Mechanism};

use crate::common::{Table, deviation, results, root, scenario, scratch, succeed};

/// The shipped integrator of ReDySim's floating robots, and tolerances that leave hardly more than rounding.
const SHIPPED: &str = "method = \"Ode45\", rtol = 1e-5, atol = 1e-7";
const TIGHT: &str = "method = \"Dop853\", rtol = 1e-13, atol = 1e-14";

/// The coordinates of the satellite: a position and a quaternion, as shipped, or a position and ReDySim's Euler angles.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Attitude {
    Quaternion,
    EulerAngles,
}

/// The tables of a shipped scenario of a motion by an integrator that leaves hardly more than rounding.
fn tight(folder: &Path, name: &str, attitude: Attitude) -> impl Fn(&str) -> Table + use<> {
    let text = fs::read_to_string(root().join(format!("scenarios/{name}.toml"))).unwrap();
    assert!(text.contains(SHIPPED), "{name} has ReDySim's tolerances");
    let mut scenario: toml::Table = text.replace(SHIPPED, TIGHT).parse().unwrap();
    let model = root().join("scenarios").join(scenario["model"].as_str().unwrap());
    let mut model: toml::Table = fs::read_to_string(model).unwrap().parse().unwrap();
    if attitude == Attitude::EulerAngles {
        let satellite = model["link"][0].as_table_mut().unwrap();
        satellite.insert("coordinates".into(), "zxy".into());
    }
    fs::write(folder.join("model.toml"), model.to_string()).unwrap();
    scenario["model"] = "model.toml".into();
    fs::write(folder.join("tight.toml"), scenario.to_string()).unwrap();
    succeed(folder, &["forward", "tight.toml", "-o", "run", "--force"]);
    let run = folder.join("run");
    move |table| Table::csv(&run.join(format!("{table}.csv")))
}

/// ReDySim's coordinates of the satellite and their rates in a row of states, and those of the joints.
fn redysims(attitude: Attitude, state: &[f64]) -> [[Vec<f64>; 2]; 2] {
    let state = &state[1..];
    let base = if attitude == Attitude::Quaternion { 7 } else { 6 };
    let ((q, joints), v) = (state[..base + 3].split_at(base), &state[base + 3..]);
    let satellite = match attitude {
        Attitude::Quaternion => euler_angles(q, &v[..6]).map(Vec::from),
        Attitude::EulerAngles => [q.to_vec(), v[..6].to_vec()],
    };
    [satellite, [joints.to_vec(), v[6..].to_vec()]]
}

/// ReDySim's coordinates of a free joint and their rates: x, y, z, φ, θ, ψ, the attitude of which is Rz(φ) Rx(θ) Ry(ψ),
/// from position and quaternion, and from the velocities in the link's frame.
fn euler_angles(q: &[f64], v: &[f64]) -> [[f64; 6]; 2] {
    let [x, y, z, w] = [q[3], q[4], q[5], q[6]];
    let rotation = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ];
    let phi = (-rotation[0][1]).atan2(rotation[1][1]);
    let theta = rotation[2][1].asin();
    let psi = (-rotation[2][0]).atan2(rotation[2][2]);
    let linear = rotation.map(|row| row.iter().zip(&v[..3]).map(|(r, v)| r * v).sum::<f64>());
    let (sin, cos) = psi.sin_cos();
    let theta_rate = cos * v[3] + sin * v[5];
    let phi_rate = (cos * v[5] - sin * v[3]) / theta.cos();
    let psi_rate = v[4] - theta.sin() * phi_rate;
    [[q[0], q[1], q[2], phi, theta, psi], [linear[0], linear[1], linear[2], phi_rate, theta_rate, psi_rate]]
}

/// What the references of ReDySim's floating robots may be missed by, in every number, rad, m, their rates, N m and J.
const OFF: f64 = 1e-9;

/// Fails unless each column of `found` is the reference's in every row.
fn assert_is_the_reference(name: &str, found: &[Vec<f64>], reference: &Table) {
    for column in 0..reference.rows[0].len() {
        let of = |rows: &[Vec<f64>]| rows.iter().map(|row| vec![row[column]]).collect::<Vec<_>>();
        let off = deviation(&of(found), &of(&reference.rows));
        println!("{name}: column {column}: {off:.1e}");
        assert!(off < OFF, "{name}: column {column} is off by {off:e}");
    }
}

#[test]
#[cfg_attr(debug_assertions, ignore = "slow: run in release, by .ci/run")]
fn a_satellite_turns_under_its_tracking_arm_as_in_quadruple_precision() {
    let folder = scratch("floating-pd");
    for attitude in [Attitude::Quaternion, Attitude::EulerAngles] {
        let read = tight(&folder, "floating_three_link", attitude);
        let (state, energy) = (read("statevar"), read("energy"));
        let row = |(state, energy): (&Vec<f64>, &Vec<f64>)| {
            let [[q, v], [joints, rates]] = redysims(attitude, state);
            let [kinetic, potential, work] = [energy[1], energy[2], energy[4]];
            [vec![state[0]], q, joints, v, rates, vec![-work, kinetic, potential]].concat()
        };
        let found: Vec<_> = state.rows.iter().zip(&energy.rows).map(row).collect();
        assert_is_the_reference(&format!("{attitude:?}"), &found, &Table::reference("golden_ref_fb3_pd.csv"));
    }
}

#[test]
fn an_arm_that_follows_a_cycloid_takes_the_forces_and_moves_its_satellite_as_in_quadruple_precision() {
    let folder = scratch("floating-id");
    for attitude in [Attitude::Quaternion, Attitude::EulerAngles] {
        let read = tight(&folder, "floating_three_link_prescribed", attitude);
        let (state, energy, forces) = (read("statevar"), read("energy"), read("tor"));
        let row = |((state, energy), forces): ((&Vec<f64>, &Vec<f64>), &Vec<f64>)| {
            let [[q, v], _] = redysims(attitude, state);
            let [kinetic, potential, work] = [energy[1], energy[2], energy[4]];
            assert_eq!(forces[1..7], [0.0; 6], "of the satellite");
            [vec![state[0]], q, v, vec![-work], forces[7..10].to_vec(), vec![kinetic, potential]].concat()
        };
        let found: Vec<_> = state.rows.iter().zip(&energy.rows).zip(&forces.rows).map(row).collect();
        assert_is_the_reference(&format!("{attitude:?}"), &found, &Table::reference("golden_ref_fb3_id.csv"));
    }
}

/// Momenta of the links from where they are and how they move: m ċ, and I ω + m c × ċ about the origin of the base frame;
/// each with the sum of their sizes.
fn momenta(mechanism: &GenericMechanism, state: &[f64]) -> [([f64; 3], f64); 2] {
    let (q, v) = state.split_at(state.len() - mechanism.nv());
    let mut totals = [([0.0; 3], 0.0); 2];
    let states: Vec<LinkState<f64>> = mechanism.link_kinematics(&q.to_vec(), &v.to_vec());
    for (link, at) in mechanism.model().links.iter().zip(states) {
        let rotation = Matrix3::from_fn(|i, j| at.rotation[i][j]);
        let [origin, com, velocity, omega] = [at.origin, at.com, at.velocity, at.angular_velocity].map(Vector3::from);
        let inertia = link.inertia;
        let tensor = Matrix3::new(
            inertia.xx, inertia.xy, inertia.xz, inertia.xy, inertia.yy, inertia.yz, inertia.xz, inertia.yz, inertia.zz,
        );
        let linear = link.mass * (velocity + omega.cross(&(com - origin)));
        let angular = rotation * tensor * rotation.transpose() * omega + com.cross(&linear);
        for ((total, size), own) in totals.iter_mut().zip([linear, angular]) {
            (0..3).for_each(|i| total[i] += own[i]);
            *size += own.norm();
        }
    }
    totals
}

/// A row of states, and one of momenta, without their times.
type StateAndMomenta = (Vec<f64>, Vec<f64>);

/// The mechanism of a run, and the rows of its states and momenta.
fn states_and_momenta(run: &Path) -> (GenericMechanism, Vec<StateAndMomenta>) {
    let mechanism = GenericMechanism::new(Model::load(run.join("model.toml")).unwrap().model);
    let [state, momentum] = ["statevar.csv", "momentum.csv"].map(|name| Table::csv(&run.join(name)).rows);
    let rows = state.iter().zip(&momentum).map(|(state, momentum)| (state[1..].to_vec(), momentum[1..].to_vec()));
    (mechanism, rows.collect())
}

#[test]
fn momentum_and_centre_of_mass_are_those_of_the_links() {
    let start = "[initial]\nq = { base = { xyz = [1, 2, 3], rpy = [0.1, 0.2, 0.3] }, joint2 = 0.5 }\n\
                 v = { base = [1, -2, 0.5, 0.5, 1, -1], joint2 = 2, joint3 = -3 }\n";
    let run = results(
        &scratch("floating-links"),
        "forward",
        "kr5_floating.toml",
        &format!("{start}[forward]\nend = 1.0\nstep = 0.1\n"),
    );
    let (mechanism, rows) = states_and_momenta(&run);
    let masses: Vec<f64> = mechanism.model().links.iter().map(|link| link.mass).collect();
    let total: f64 = masses.iter().sum();
    let places = Table::csv(&run.join("kinematics.csv"));
    for ((state, found), placed) in rows.iter().zip(&places.rows) {
        let [(linear, size), (angular, moment)] = momenta(&mechanism, state);
        let off = |found: &[f64], expected: [f64; 3]| deviation(&[found.to_vec()], &[expected.to_vec()]);
        assert!(off(&found[..3], linear) < 1e-14 * size && off(&found[3..6], angular) < 1e-14 * moment, "{found:?}");
        let sum = |axis: usize| {
            masses.iter().enumerate().map(|(link, mass)| mass * placed[4 + 15 * link + axis]).sum::<f64>()
        };
        assert!(off(&found[6..9], [0, 1, 2].map(|axis| sum(axis) / total)) < 1e-14, "{found:?}");
        assert!(off(&found[9..12], linear.map(|linear| linear / total)) < 1e-14 * size / total, "{found:?}");
    }
    let headers = Table::csv(&run.join("momentum.csv")).headers;
    let expected = ["linear x [N s]", "angular z [N m s]", "com y [m]", "com_velocity z [m/s]"];
    assert_eq!([&*headers[1], &*headers[6], &*headers[8], &*headers[12]], expected);
}

/// The shipped robots that float without gravity.
const FLOATING: [&str; 6] = [
    "floating_three_link",
    "floating_three_link_prescribed",
    "floating_seven_link",
    "floating_seven_link_prescribed",
    "floating_dual_arm",
    "floating_dual_arm_prescribed",
];

/// Momenta as a share of those of the links, the energy less the work as a share of what is exchanged.
#[test]
fn every_shipped_robot_that_floats_keeps_its_momentum_and_its_energy() {
    let count = if cfg!(debug_assertions) { 2 } else { FLOATING.len() };
    for name in &FLOATING[..count] {
        let folder = scratch(&format!("floating-momentum-{name}"));
        let _ = tight(&folder, name, Attitude::Quaternion);
        let (mechanism, rows) = states_and_momenta(&folder.join("run"));
        let sizes = rows.iter().map(|(state, _)| momenta(&mechanism, state).map(|(_, size)| size));
        let [linear, angular] = sizes.fold([0.0, 0.0], |[a, b], [linear, angular]| [linear.max(a), angular.max(b)]);
        let text = fs::read_to_string(folder.join("run/run.toml")).unwrap();
        let run: toml::Table = text.parse().unwrap();
        let shares = [("linear_momentum_drift", linear), ("angular_momentum_drift", angular)]
            .map(|(key, size)| run["run"][key].as_float().unwrap() / size);
        println!("{name}: {shares:?} of {linear:.1e} N s and {angular:.1e} N m s");
        assert!(shares.iter().all(|share| *share < 1e-12), "{name}: {shares:?}");
        let [drift, exchanged] = ["energy_drift", "energy_exchanged"].map(|key| run["run"][key].as_float().unwrap());
        println!("{name}: energy {:.1e} of {exchanged} J", drift / exchanged);
        assert!(drift < 1e-12 * exchanged && exchanged > 0.1, "{name}: {drift:e} of {exchanged} J");
        let first = &rows[0].1[..6];
        for (_, row) in &rows {
            let size = |k: usize| if k < 3 { linear } else { angular };
            assert!((0..6).all(|k| (row[k] - first[k]).abs() < 1e-12 * size(k)), "{name}: {row:?} after {first:?}");
        }
    }
}

#[test]
fn the_drift_of_momentum_is_reported_only_where_nothing_outside_acts() {
    let folder = scratch("floating-reported");
    let run = |scenario: &str| succeed(&folder, &["forward", scenario, "-o", "run", "--force"]);
    let shipped = |name: &str| root().join(format!("scenarios/{name}.toml")).display().to_string();
    assert!(run(&shipped("floating_three_link")).contains("momentum drift"));
    assert!(!run(&shipped("kr5_floating")).contains("momentum"), "it falls");
    assert!(!run(&shipped("three_link")).contains("momentum"), "it stands on the ground");
    let held = "[forward]\nend = 1.0\nstep = 0.1\n\
                torque = { law = 'pd', joints = ['base'], target = { base = { xyz = [1, 0, 0] } }, kp = 9, kd = 9 }\n";
    let printed = run(&scenario(&folder, "floating_three_link.toml", held));
    assert!(!printed.contains("momentum"), "a spring pulls it: {printed}");
}
