//! Robots that float: the shipped scenarios against references in quadruple precision.

use std::fs;
use std::path::Path;

use crate::common::{Table, deviation, root, scratch, succeed};

/// The shipped integrator of ReDySim's floating robots, and tolerances that leave hardly more than rounding.
const SHIPPED: &str = "method = \"Ode45\", rtol = 1e-5, atol = 1e-7";
const TIGHT: &str = "method = \"Dop853\", rtol = 1e-13, atol = 1e-14";

/// The tables of a shipped scenario of a motion by an integrator that leaves hardly more than rounding.
fn tight(folder: &Path, name: &str) -> impl Fn(&str) -> Table {
    let text = fs::read_to_string(root().join(format!("scenarios/{name}.toml"))).unwrap();
    assert!(text.contains(SHIPPED), "{name} has ReDySim's tolerances");
    let text = text.replace("../models", &root().join("models").display().to_string()).replace(SHIPPED, TIGHT);
    fs::write(folder.join("tight.toml"), text).unwrap();
    succeed(folder, &["forward", "tight.toml", "-o", "run"]);
    let run = folder.join("run");
    move |table| Table::csv(&run.join(format!("{table}.csv")))
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
fn a_satellite_turns_under_its_tracking_arm_as_in_quadruple_precision() {
    let folder = scratch("floating-pd");
    let read = tight(&folder, "floating_three_link");
    let (state, energy) = (read("statevar"), read("energy"));
    let row = |(state, energy): (&Vec<f64>, &Vec<f64>)| {
        let (t, [q, v]) = (state[0], euler_angles(&state[1..8], &state[11..17]));
        let [kinetic, potential, work] = [energy[1], energy[2], energy[4]];
        [&[t], &q[..], &state[8..11], &v, &state[17..20], &[-work, kinetic, potential]].concat()
    };
    let found: Vec<_> = state.rows.iter().zip(&energy.rows).map(row).collect();
    assert_is_the_reference("floating_three_link", &found, &Table::reference("golden_ref_fb3_pd.csv"));
}

#[test]
fn an_arm_that_follows_a_cycloid_takes_the_forces_and_moves_its_satellite_as_in_quadruple_precision() {
    let folder = scratch("floating-id");
    let read = tight(&folder, "floating_three_link_prescribed");
    let (state, energy, forces) = (read("statevar"), read("energy"), read("tor"));
    let row = |((state, energy), forces): ((&Vec<f64>, &Vec<f64>), &Vec<f64>)| {
        let (t, [q, v]) = (state[0], euler_angles(&state[1..8], &state[11..17]));
        let [kinetic, potential, work] = [energy[1], energy[2], energy[4]];
        assert_eq!(forces[1..7], [0.0; 6], "of the satellite");
        [&[t], &q[..], &v, &[-work], &forces[7..10], &[kinetic, potential]].concat()
    };
    let found: Vec<_> = state.rows.iter().zip(&energy.rows).zip(&forces.rows).map(row).collect();
    assert_is_the_reference("floating_three_link_prescribed", &found, &Table::reference("golden_ref_fb3_id.csv"));
}
