//! The heavy top at 150 rad/s with a quaternion and with Euler angles, whose singularity it passes. The table of
//! `docs/floating_and_walking.md` has the figures.
#![cfg(feature = "generic")]

#[path = "../common/scenes/heavy_top.rs"]
mod scene;

use nalgebra::Vector3;
use redysim::{Dop853, IntegrationError, LinkKinematics, Mechanism, Ode4};
use redysim_model::joint::EulerSequence;
use scene::{SPIN, run, top};

const ZXY: Option<EulerSequence> = Some(EulerSequence::Zxy);

/// A spin about the last axis of the sequence, as favourable as it can be: the top nods through the gimbal all the same.
#[test]
fn fixed_steps_fail_at_the_gimbal_of_euler_angles_and_not_with_a_quaternion() {
    let by_quaternion = run(None, SPIN, &Ode4::new(1e-4));
    assert!(by_quaternion.end.is_ok() && by_quaternion.drift < 2e-10, "{:e}", by_quaternion.drift);
    let by_angles = run(ZXY, SPIN, &Ode4::new(1e-4));
    let fault = by_angles.end.expect_err("the steps pass the gimbal too fast");
    assert!(matches!(fault, IntegrationError::NonFiniteDerivative { t, .. } if t > 0.37 && t < 0.38), "{fault}");
    assert!(by_angles.drift > 1.0, "it gains energy before: {:e}", by_angles.drift);
}

#[test]
fn steps_by_tolerance_pass_the_gimbal_of_euler_angles_by_rejected_steps_and_agree_with_a_quaternion() {
    let method = Dop853::new().rtol(1e-10).atol(1e-10);
    let runs = [None, ZXY].map(|coordinates| {
        let top = top(coordinates);
        let run = run(coordinates, SPIN, &method);
        let end = run.end.expect("it arrives");
        let (q, rest) = end.y.split_at(top.nq());
        let com = top.link_kinematics(&q.to_vec(), &rest[..3].to_vec())[0].com;
        println!("{coordinates:?}: drift {:.1e}, |cos θ| {:.1e}, {:?}", run.drift, run.gimbal, end.statistics);
        (Vector3::from(com), run.drift, run.gimbal, end.statistics.rejected)
    });
    let [(expected, drift, _, rejected), (found, drift_by_angles, gimbal, rejected_by_angles)] = runs;
    assert!(gimbal < 1e-6, "{gimbal:e}");
    assert!(drift < 2e-11 && drift_by_angles < 2e-10, "{drift:e}, {drift_by_angles:e}");
    assert!(rejected == 0 && rejected_by_angles > 20, "{rejected}, {rejected_by_angles}");
    // 1e-10 a step over a thousand steps.
    assert!((found - expected).amax() < 1e-8, "{found} {expected}");
}

/// Where the first and the third axis are the same, the top starts in the gimbal.
#[test]
fn a_start_in_the_gimbal_is_reported_with_what_to_look_for() {
    let sequence = Some(EulerSequence::Zxz);
    let fault = run(sequence, SPIN, &Ode4::new(1e-4)).end.expect_err("the mass matrix is singular");
    assert!(fault.to_string().contains("a singular mass matrix"), "{fault}");
}
