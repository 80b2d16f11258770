//! Scenarios of closed loops with spherical joints.

use crate::common::{AGAINST_CLOSED_FORMS, BALLS, Table, deviation, fail, root, scenario, scratch, succeed};
use nalgebra::{Quaternion, UnitQuaternion};
use std::fs;

#[test]
fn a_loop_through_a_spherical_joint_stays_closed_and_keeps_its_energy() {
    let folder = scratch("balls-free");
    fs::write(folder.join("balls.toml"), BALLS).unwrap();
    let law = "torque = { law = 'pd', target = [1], kp = 20, kd = 0 }";
    let rest = format!(
        "model = 'balls.toml'\n[initial]\nv = {{ crank = 3, 'coupler.wx' = 1 }}\n\
         [forward]\nend = 1.0\nstep = 0.1\n{AGAINST_CLOSED_FORMS}{law}\n"
    );
    fs::write(folder.join("trial.toml"), rest).unwrap();
    let printed = succeed(&folder, &["forward", "trial.toml", "-o", "run"]);
    assert!(printed.contains("coupler.qy by -0.3162 1"), "{printed}");
    let text = fs::read_to_string(folder.join("run/run.toml")).unwrap();
    let run: toml::Table = text.parse().unwrap();
    let number = |key: &str| run["run"][key].as_float().unwrap();
    assert!(number("worst_position_residual") < 1e-12 && number("energy_drift") < 1e-9, "{text}");
    assert!(number("energy_exchanged") > 0.5, "{text}");
}

#[test]
fn a_trajectory_prescribes_all_velocities_of_a_ball_and_is_refused_if_the_loops_leave_fewer_free() {
    let folder = scratch("balls-prescribed");
    fs::write(folder.join("balls.toml"), BALLS).unwrap();
    let rest = "model = 'balls.toml'\n[trajectory]\njoints = ['coupler']\nfrom = [0, 0, 0, 1]\nto = [0, 0, 1, 1]\n\
                duration = 1.0\n[inverse]\nend = 1.0\nstep = 0.1\n";
    fs::write(folder.join("trial.toml"), rest).unwrap();
    let shown = fail(&folder, &["inverse", "trial.toml"], 1);
    assert!(
        shown.contains("the trajectory prescribes 3 degrees of freedom (coupler), but the loops leave 2 free"),
        "{shown}"
    );
}

/// The motion of the ball has its rods follow; that of the rods, with its velocities and accelerations in a table, the ball.
#[test]
fn the_legs_of_a_platform_take_the_same_forces_whether_its_ball_is_prescribed_or_they_are() {
    let folder = scratch("balls-platform");
    let shipped = format!("{}/scenarios/ball_platform.toml", root().display());
    let printed = succeed(&folder, &["inverse", &shipped, "-o", "by_ball"]);
    assert!(printed.contains("The loops begin closed with sleeve1.phi at -0.33"), "{printed}");
    let start = "[initial]\nq = { 'sleeve1.phi' = -0.3, 'sleeve2.phi' = -0.3, 'sleeve3.phi' = -0.3, 'sleeve1.theta' = -0.4, \
                 'sleeve2.theta' = -0.4, 'sleeve3.theta' = -0.4 }\n";
    let motion = "[trajectory]\nkind = 'csv'\nfile = 'by_ball/traj.csv'\n[inverse]\nend = 2.0\nstep = 0.02\n";
    let by_rods = scenario(&folder, "ball_platform.toml", &format!("{start}{motion}"));
    succeed(&folder, &["inverse", &by_rods, "-o", "by_rods", "--quiet"]);
    let read = |run: &str, table: &str| Table::csv(&folder.join(run).join(table));
    let forces = read("by_ball", "tor.csv");
    let worst = deviation(&read("by_rods", "tor.csv").rows, &forces.rows);
    assert!(worst < 1e-9, "off by {worst:e} N");
    let of_rods = ["rod1", "rod2", "rod3"].map(|rod| forces.column(&format!("tau {rod} [N]")));
    assert!(of_rods.iter().all(|forces| forces.iter().any(|force| force.abs() > 1.0)), "each leg carries: {of_rods:?}");
    let drift = read("by_ball", "energy.csv").column("drift [J]");
    assert!(drift.iter().all(|drift| drift.abs() < 1e-7), "the legs give all the energy: {drift:?}");
}

/// Errors of 9 deg and less die away as (1 + 10 t) exp(−10 t), to 1e-8 of them at the end.
#[test]
fn computed_torque_of_its_legs_turns_a_platform_on_a_ball() {
    let folder = scratch("balls-computed-torque");
    succeed(&folder, &["forward", &format!("{}/scenarios/ball_platform.toml", root().display()), "-o", "run"]);
    let states = Table::csv(&folder.join("run/statevar.csv"));
    let [first, last] = [states.rows.first().unwrap(), states.rows.last().unwrap()]
        .map(|row| UnitQuaternion::new_normalize(Quaternion::new(row[4], row[1], row[2], row[3])));
    let [roll, pitch, yaw] = [20.0_f64, -15.0, 30.0].map(f64::to_radians);
    let wanted = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
    assert!(first.angle_to(&UnitQuaternion::identity()) > 0.1, "it starts beside the motion: {first}");
    assert!(last.angle_to(&wanted) < 1e-7, "it ends {:e} rad beside the motion", last.angle_to(&wanted));
}
