//! The KUKA KR5 of the ReDySim paper: its Figures 6, 7 and 8, against references, and the speed of compiled code.
//!
//! `cargo run --release --example kr5`

mod common;

use std::f64::consts::FRAC_PI_3;

use common::figure::joint_grid;
use common::free_fall::{by_several_methods, report_methods};
use common::inverse::along;
use common::reference::Reference;
use common::{Context, Failure, Outputs, instants, speed};
use redysim::generic::{GenericMechanism, Model};
use redysim::{Cycloid, redysim};

redysim! {
    /// The KUKA KR5, six revolute joints in a row.
    pub struct Kr5("../models/kr5.toml");
}

fn main() -> Result<(), Failure> {
    let mut outputs = Outputs::of("kr5")?;
    inverse_dynamics(&mut outputs)?;
    free_fall(&mut outputs)?;
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../models/kr5.toml");
    let model = Model::load(path).context(|| format!("cannot read {path}"))?.model;
    speed::report(&Kr5, &Kr5::OPS, &GenericMechanism::new(model));
    outputs.print();
    Ok(())
}

/// Figures 6 and 7: all joints turn from 0 to 60° in 1 s.
fn inverse_dynamics(outputs: &mut Outputs) -> Result<(), Failure> {
    let redysim = Reference::joint_forces(
        "ReDySim",
        include_str!("../tests/reference/golden_octave_ID_KUKA_Robot.csv"),
        Kr5::NV,
    )?;
    let quad = Reference::joint_forces("quad", include_str!("../tests/reference/kane_quad_ID_kr5.csv"), Kr5::NV)?;
    let turn = Cycloid::new([0.0; Kr5::NQ], [FRAC_PI_3; Kr5::NQ], 1.0)?;
    let run = along(&Kr5, &turn, instants(1.0, 1000));
    run.report("KR5, inverse dynamics: all joints from 0° to 60° in 1 s (Figs 6, 7)", &[&redysim, &quad]);
    outputs.picture("fig6_joint_motion", "the prescribed motion", &run.motion_figure())?;
    outputs.picture("fig7_joint_torques", "the torques it takes, and ReDySim's", &run.force_figure(&redysim))?;
    outputs.numbers("inverse_dynamics", "motion and torques, each 1 ms", &run.csv())
}

/// Figure 8: the robot, stretched out, is let go.
fn free_fall(outputs: &mut Outputs) -> Result<(), Failure> {
    let text = include_str!("../tests/reference/golden_ref_kuka.csv");
    let reference = Reference::motion("quad precision", text, Kr5::NV)?.until(1.0);
    let runs = by_several_methods(&Kr5, &[0.0; Kr5::NQ], &instants(1.0, 1000))?;
    let tight = &runs[0];
    tight.report("KR5, free fall of 1 s from rest at q = 0 (Fig 8)", &reference);
    report_methods(&runs, &reference);
    let circles = reference.series(&reference.q);
    let angles = joint_grid("angle", "deg", 1_f64.to_degrees(), &[tight.angles("redysim")], &[circles]);
    outputs.picture("fig8_free_fall", "joint angles, and those in quad precision", &angles)?;
    outputs.picture("free_fall_energy", "energies, and the drift of their sum", &tight.energy_figure())?;
    outputs.numbers("free_fall", "motion and energies, each 1 ms", &tight.csv())
}
