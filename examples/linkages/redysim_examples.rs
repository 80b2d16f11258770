//! The examples that ship with ReDySim: its other four-bar, the slider-crank, the 3-RRR and the leg.

use std::f64::consts::{FRAC_PI_2, TAU};

use redysim::{
    ClosedLoop, ClosedLoopSimulation, Integrator, LoopClosure, Motion, Ode45, Stabilisation, TreeDynamics, ZeroTorque,
    redysim,
};

use super::study::{Plan, Studies};
use crate::common::loop_inverse::along_loops;
use crate::common::loop_motion::{LoopMotion, record};
use crate::common::reference::Reference;
use crate::common::table::{Table, headline, remark, tiny};
use crate::common::{Failure, instants, peak};

redysim! {
    /// The four-bar of ReDySim's GUI.
    pub struct FourbarGui("../../models/fourbar_gui.toml");
}
redysim! {
    /// Crank, coupler and a slider.
    pub struct SliderCrank("../../models/slider_crank.toml");
}
redysim! {
    /// A platform on three legs.
    pub struct ThreeRrr("../../models/three_rrr.toml");
}
redysim! {
    /// A straight-line four-bar that drives a pantograph.
    pub struct Leg("../../models/leg.toml");
}

/// 145.54° and 130.54°, where it does not close.
const GUI_START: [f64; 3] = [0.0, 2.540_152_193_352_547_3, 2.278_352_805_553_397_7];
const RRR_START: [f64; 7] = [1.0467, 5.4206, -2.5357, 4.1883, -2.0939, 5.7637, -0.9869];
/// The start of the 3-RRR's inverse dynamics, which is another one, and its cranks.
const RRR_CIRCLE: [f64; 7] = [1.9814, -2.3099, 0.3284, -1.605, -2.8061, 0.5403, -2.5131];
const RRR_CRANKS: [usize; 3] = [0, 3, 5];
const LEG_START: [f64; 7] = [0.0, 4.511, -2.7389, -0.8764, -1.4604, -1.4604, -1.6812];

/// Moves them from the shipped starts for the shipped times.
pub fn move_all(studies: &mut Studies) -> Result<(), Failure> {
    let (rest, t) = ([0.0; 3], instants(1.33, 1330));
    let (name, law) = ("fourbar_gui", ZeroTorque);
    let plan = Plan { name, mechanism: &FourbarGui, law, q: GUI_START, v: rest, held: &[0], t };
    studies.run(plan, &method())?;
    let (name, q, t) = ("slider_crank", [-FRAC_PI_2, TAU, 2.0], instants(3.0, 3000));
    studies.run(Plan { name, mechanism: &SliderCrank, law, q, v: rest, held: &[0], t }, &method())?;
    let (name, t) = ("three_rrr", instants(2.0, 2000));
    let plan = Plan { name, mechanism: &ThreeRrr, law, q: RRR_START, v: [0.0; 7], held: &RRR_CRANKS, t };
    studies.run(plan, &method())?;
    let (name, t) = ("leg", instants(1.33, 1330));
    studies.run(Plan { name, mechanism: &Leg, law: turn, q: LEG_START, v: [0.0; 7], held: &[0], t }, &method())
}

fn method() -> Ode45<'static, f64> {
    Ode45::new().rtol(1e-10).atol(1e-12)
}

/// ReDySim's law for the leg: the crank alone is turned back to −360° by a spring and a damper.
fn turn(_t: f64, q: &[f64; 7], v: &[f64; 7]) -> [f64; 7] {
    let mut torques = [0.0; 7];
    torques[0] = 49.0 * (-TAU - q[0]) - 14.0 * v[0];
    torques
}

/// Against ReDySim's own inverse dynamics, and free motions in quadruple precision.
pub fn compare(studies: &Studies) -> Result<(), Failure> {
    inverse_of_three_rrr()?;
    slider_crank(&studies.get("slider_crank")?.motion)?;
    headline("Free motion from the open starts, without projection, against quad precision");
    let mut table = Table::new(&["mechanism", "run\ns", "steps\n", "max |Δq|\nrad", "max |Δv|\nrad/s", "max |Δλ|\nN"]);
    let text = include_str!("../../tests/reference/golden_ref_fourbar_v2.csv");
    free(&mut table, "fourbar_gui", &FourbarGui, GUI_START, Reference::loop_motion("quad", text, 3, 2)?)?;
    let text = include_str!("../../tests/reference/golden_ref_rrr3.csv");
    free(&mut table, "three_rrr", &ThreeRrr, RRR_START, Reference::loop_motion("quad", text, 7, 4)?)?;
    table.print();
    remark(
        "The references leave the position residual of the start as it is: their multipliers hold accelerations alone.",
    );
    Ok(())
}

/// With φ from the start, falling, and s = sin φ: (2/3 + 4 s²) φ̇² / 2 = 9.81 s, since links of equal length let the
/// coupler turn back as far as the crank turns on. At φ = 90° the slider is in the crank's pivot, and the position
/// singular.
fn slider_crank(motion: &LoopMotion) -> Result<(), Failure> {
    let mut equation = |_t: f64, y: &[f64; 2], rate: &mut [f64; 2]| {
        let (sin, cos) = y[0].sin_cos();
        *rate = [y[1], (9.81 - 4.0 * sin * y[1] * y[1]) * cos / (2.0 / 3.0 + 4.0 * sin * sin)];
    };
    let mut deviations = Vec::new();
    let (times, mut found) = (motion.t.iter().copied(), motion.q.iter());
    Ode45::new().rtol(3e-14).atol(1e-15).solve(&mut equation, (0.0, 3.0), [0.0; 2], times, |_, y| {
        deviations.extend(found.next().map(|q| q[0] + FRAC_PI_2 + y[0]));
    })?;
    headline("Slider-crank, free fall of 3 s from rest, against its one equation of motion");
    let turned = motion.q.iter().fold(0.0_f64, |most, q| most.max(-FRAC_PI_2 - q[0]));
    remark(&format!(
        "The crank falls through {:.3}°, past the singular position at 90°, and back:",
        turned.to_degrees()
    ));
    remark(&format!("max |Δq| of the crank {} rad.", tiny(peak(deviations))));
    Ok(())
}

/// The platform goes along a circle. The cranks' motion is the reference's; what follows from it is not.
fn inverse_of_three_rrr() -> Result<(), Failure> {
    let text = include_str!("../../tests/reference/golden_octave_ID_3-RRR_Parallel_robot.csv");
    let reference = Reference::loop_forces("ReDySim", text, 7, RRR_CRANKS.len())?;
    let cranks = |row: &Vec<f64>| RRR_CRANKS.map(|joint| row[joint]);
    let circle = |t: f64| {
        let k = (100.0 * t).round() as usize;
        Motion { q: cranks(&reference.q[k]), v: cranks(&reference.v[k]), a: cranks(&reference.a[k]) }
    };
    let run = along_loops(&ThreeRrr, &RRR_CRANKS, RRR_CIRCLE, &circle, reference.t.clone())?;
    headline("3-RRR, inverse dynamics: the platform's centre on a circle, 2 s");
    let mut table = Table::new(&["force", "peak\nN m, N", "max |Δ| to ReDySim,\n201 instants", "\nof peak"]);
    let names = ["τ crank 1", "τ crank 2", "τ crank 3", "λ x, leg 2", "λ y, leg 2", "λ x, leg 3", "λ y, leg 3"];
    for (name, (peak, deviation)) in names.into_iter().zip(run.force_deviations(&reference)) {
        table.row([name.to_owned(), format!("{peak:.3}"), tiny(deviation), tiny(deviation / peak)]);
    }
    table.print();
    remark(&format!("Largest deviation: {} of the force's peak.", tiny(run.worst(&reference))));
    Ok(())
}

fn free<M>(
    table: &mut Table,
    name: &'static str,
    mechanism: &M,
    q: M::Coordinates,
    reference: Reference,
) -> Result<(), Failure>
where
    M: TreeDynamics<f64> + LoopClosure<f64, M>,
{
    let loops = ClosedLoop::new(mechanism);
    let mut simulation = ClosedLoopSimulation::new(loops, ZeroTorque).stabilisation(Stabilisation::None);
    let start = simulation.state(&q, &redysim::uniform(mechanism, 0.0));
    let run = record(name, &mut simulation, &Ode45::new().rtol(3e-14).atol(1e-15), start, &reference.t)?;
    let numbers = [reference.t[reference.t.len() - 1].to_string(), run.statistics.steps.to_string()];
    let deviations = run.deviations(&reference).map(tiny);
    table.row([name.to_owned()].into_iter().chain(numbers).chain(deviations));
    Ok(())
}
