//! The heavy top of Géradin and Cardona, in quaternions, and in Euler angles past their gimbal.

#[path = "../../../tests/common/elliptic.rs"]
mod elliptic;

use std::fs;

use crate::common::{Table, deviation, fail, root, scenario, scratch, succeed};
use elliptic::jacobi;

/// The mass, kg, the moments of inertia about the axis of symmetry and across it at the fixed point, kg m², the spin
/// and the rate of precession at the start, rad/s.
const MASS: f64 = 15.0;
const ALONG: f64 = 0.46875;
const ACROSS: f64 = 0.234375 + MASS;
const SPIN: f64 = 150.0;
const PRECESSION: f64 = -60.0 / 13.0;
/// The kinetic energy of the spin, J.
const KINETIC: f64 = 0.5 * ALONG * SPIN * SPIN;

/// With u the height of the centre of mass, 1 m from the point, a = ALONG SPIN/ACROSS and β = 2 m g/ACROSS, the integrals of
/// the motion give u̇² = u (1 + u) (β u − β − 2 a²), since the precession is −a at u = 0 (Goldstein, *Classical
/// Mechanics*, section 5.7). Then u = sn²(K + n t) − 1 with n = √(2 β + 2 a²)/2 and the modulus k² = β/(2 β + 2 a²), and
/// sn(K + x) = cn x/dn x.
fn height(t: f64) -> f64 {
    let (a, beta) = (ALONG * SPIN / ACROSS, 2.0 * MASS * 9.81 / ACROSS);
    assert!((a + PRECESSION).abs() < 1e-14);
    let sum = 2.0 * beta + 2.0 * a * a;
    let [_, cn, dn] = jacobi(0.5 * sum.sqrt() * t, (1.0 - beta / sum).sqrt());
    (cn / dn).powi(2) - 1.0
}

#[test]
fn the_heavy_top_nods_as_elliptic_functions_have_it_and_keeps_its_spin() {
    let folder = scratch("heavy-top");
    succeed(&folder, &["forward", &format!("{}/scenarios/heavy_top.toml", root().display()), "-o", "run"]);
    let read = |name: &str| Table::csv(&folder.join("run").join(name));
    let (heights, states) = (read("kinematics.csv"), read("statevar.csv"));
    let found: Vec<_> = heights.rows.iter().map(|row| vec![row[6]]).collect();
    let expected: Vec<_> = heights.rows.iter().map(|row| vec![height(row[0])]).collect();
    let spins: Vec<_> = states.rows.iter().map(|row| vec![row[6]]).collect();
    let [nod, spin] = [deviation(&found, &expected), deviation(&spins, &vec![vec![SPIN]; spins.len()])];
    println!("height {nod:.1e} m, spin {spin:.1e} rad/s");
    // The relative tolerance of a step is 1e-10; errors of the thousand steps of an oscillation hardly add up.
    assert!(nod < 1e-9 && spin < 1e-9, "height {nod:e} m, spin {spin:e} rad/s");
    assert!(expected.iter().any(|height| height[0] < -0.999), "it goes through the vertical");
    let drift = read("energy.csv").column("drift [J]");
    assert!(drift.iter().all(|drift| drift.abs() < 1e-10 * KINETIC), "{drift:?}");
}

/// The top in Euler angles, which nods through their gimbal at 0.3726 s.
const IN_ANGLES: &str = "\
[[link]]
name = 'top'
joint_name = 'pivot'
parent = 'base'
joint = 'spherical'
coordinates = 'zxy'
origin = {}
mass = 15.0
com = [0.0, 1.0, 0.0]
inertia = { xx = 0.234375, yy = 0.46875, zz = 0.234375 }
";

#[test]
fn a_run_that_fails_in_gimbal_lock_advises_a_quaternion() {
    let folder = scratch("heavy-top-in-angles");
    let model = folder.join("top.toml");
    fs::write(&model, format!("name = 'top'\ngravity = [0.0, 0.0, -9.81]\n{IN_ANGLES}")).unwrap();
    for (method, reason) in [("Ode4", "is infinite or not a number"), ("Gauss6", "are not solved by iteration")] {
        let rest = format!(
            "[initial]\nv = {{ pivot = [-4.61538, 0, {SPIN:?}] }}\n[forward]\nend = 2.0\nstep = 0.01\n\
             integrator = {{ method = '{method}', step = 1e-4 }}\ntorque = {{ law = 'free' }}\n"
        );
        let path = scenario(&folder, &model.display().to_string(), &rest);
        let printed = fail(&folder, &["forward", &path, "-o", "run", "--force"], 3);
        assert!(printed.contains(reason), "{printed}");
        assert!(printed.contains("at t = 0.37 s the Euler angles of the joint `pivot` are "), "{printed}");
        assert!(printed.contains("leave `coordinates` of its link out of the model"), "{printed}");
        // Of energy that has come from nowhere, and within 3° of gimbal lock shorter steps may help as well.
        let drifts = printed.contains("the motion is wrong: ");
        assert_eq!(drifts, method == "Ode4", "{printed}");
        assert_eq!(drifts, printed.contains("; or take a `step` of the integrator below 0.0001 s"), "{printed}");
    }
}
