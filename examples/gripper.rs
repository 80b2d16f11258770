//! The robotic gripper of the ReDySim paper: its Figures 4 and 5, against references, and the speed of compiled code.
//!
//! `cargo run --release --example gripper`

mod common;

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3};

use common::figure::joint_grid;
use common::free_fall::{FreeFall, by_several_methods, report_methods};
use common::inverse::along;
use common::reference::Reference;
use common::{Context, Failure, Outputs, instants, speed};
use redysim::generic::{GenericMechanism, Model};
use redysim::{Cycloid, redysim};

redysim! {
    /// Two fingers on a common first link, in the vertical plane.
    pub struct Gripper("../models/gripper.toml");
}

fn main() -> Result<(), Failure> {
    let mut outputs = Outputs::of("gripper")?;
    inverse_dynamics(&mut outputs)?;
    free_fall(&mut outputs)?;
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/gripper.toml");
    let model = Model::load(path).context(|| format!("cannot read {path}"))?.model;
    speed::report(&Gripper, &Gripper::OPS, &GenericMechanism::new(model));
    outputs.print();
    Ok(())
}

/// Figure 4: the fingers close and the arm turns, as in the paper's Table 1.
fn inverse_dynamics(outputs: &mut Outputs) -> Result<(), Failure> {
    let text = include_str!("../tests/reference/golden_octave_ID_Robotic_Gripper.csv");
    let redysim = Reference::joint_forces("ReDySim", text, Gripper::NV)?;
    let text = include_str!("../tests/reference/kane_quad_ID_gripper.csv");
    let quad = Reference::joint_forces("quad", text, Gripper::NV)?;
    let close = [60.0, 80.0, 80.0, 120.0].map(f64::to_radians);
    let run = along(&Gripper, &Cycloid::new([0.0, 0.0, 0.0, FRAC_PI_2], close, 1.0)?, instants(1.0, 1000));
    run.report("Gripper, inverse dynamics: the motion of Table 1 in 1 s (Fig 4)", &[&redysim, &quad]);
    outputs.picture("fig4_joint_motion", "the prescribed motion", &run.motion_figure())?;
    outputs.picture("fig4_joint_torques", "the torques it takes, and ReDySim's", &run.force_figure(&redysim))?;
    outputs.numbers("inverse_dynamics", "motion and torques, each 1 ms", &run.csv())
}

/// Figure 5: let go with the arm 60° below the horizontal. The paper does not state how the second finger stands at the
/// start: along the arm, or across it as in Table 1. Here are both.
fn free_fall(outputs: &mut Outputs) -> Result<(), Failure> {
    let text = include_str!("../tests/reference/golden_ref_gripper_paper.csv");
    let (along_arm, along_reference) = fall(0.0, text, "Gripper, free fall of 1 s from θ = (−60°, 0, 0, 0) (Fig 5)")?;
    let text = include_str!("../tests/reference/golden_ref_gripper_paper_th4_90.csv");
    let (across, across_reference) = fall(FRAC_PI_2, text, "Gripper, free fall of 1 s from θ = (−60°, 0, 0, 90°)")?;
    let lines = [along_arm.angles("from θ4 = 0°"), across.angles("from θ4 = 90°")];
    let circles = [along_reference.series(&along_reference.q), across_reference.series(&across_reference.q)];
    let angles = joint_grid("angle", "deg", 1_f64.to_degrees(), &lines, &circles);
    outputs.picture("fig5_free_fall", "joint angles, and those in quad precision", &angles)?;
    outputs.picture("free_fall_energy", "energies and drift, from θ4 = 0°", &along_arm.energy_figure())?;
    outputs.picture("free_fall_energy_th4_90", "energies and drift, from θ4 = 90°", &across.energy_figure())?;
    outputs.numbers("free_fall", "motion and energies, each 1 ms, from θ4 = 0°", &along_arm.csv())?;
    outputs.numbers("free_fall_th4_90", "motion and energies, each 1 ms, from θ4 = 90°", &across.csv())
}

/// The free fall from `theta4` and its reference.
fn fall(theta4: f64, text: &str, title: &str) -> Result<(FreeFall, Reference), Failure> {
    let reference = Reference::motion("quad precision", text, Gripper::NV)?;
    let mut runs = by_several_methods(&Gripper, &[-FRAC_PI_3, 0.0, 0.0, theta4], &instants(1.0, 1000))?;
    runs[0].report(title, &reference);
    report_methods(&runs, &reference);
    Ok((runs.swap_remove(0), reference))
}
