//! Andrews' squeezing mechanism (IFToMM A03): fast, stiffened by three loops, with a published answer.

use redysim::{Ode45, redysim};

use super::study::{Plan, Studies};
use crate::andrews_data::{END, END_MULTIPLIERS, END_VELOCITIES, START, TORQUES};
use crate::common::table::{Table, headline, remark, tiny};
use crate::common::{Failure, instants, peak};

redysim! {
    /// Seven bodies in the plane, three loops cut in one point.
    pub struct Andrews("../../models/andrews.toml");
}

/// Moves it for the published 0.03 s, driven by its moment.
pub fn run(studies: &mut Studies) -> Result<(), Failure> {
    let law = |_t: f64, _q: &[f64; 7], _v: &[f64; 7]| TORQUES;
    let (q, v, t) = (START, [0.0; 7], instants(0.03, 600));
    let plan = Plan { name: "andrews", mechanism: &Andrews, law, q, v, held: &[0], t };
    studies.run(plan, &Ode45::new().rtol(1e-13).atol(1e-13))
}

/// Against the published numbers at the end.
pub fn compare(studies: &Studies) -> Result<(), Failure> {
    let motion = &studies.get("andrews")?.motion;
    let last = motion.t.len() - 1;
    headline("Andrews' squeezing mechanism at t = 0.03 s, against the published numbers");
    let mut table =
        Table::new(&["", "worst |Δ|\nrad, rad/s, N", "\nrelative", "correct digits\n", "published to\nabout"]);
    for (name, ours, published, good) in [
        ("positions", &motion.q[last], &END[..], "1e-10"),
        ("velocities", &motion.v[last], &END_VELOCITIES, "5e-8"),
        ("multipliers", &motion.lambda[last], &END_MULTIPLIERS, "1e-6"),
    ] {
        let worst = peak(ours.iter().zip(published).map(|(a, b)| a - b));
        let relative = peak(ours.iter().zip(published).map(|(a, b)| (a - b) / b));
        let digits = format!("{:.1}", -relative.log10());
        table.row([name.to_owned(), tiny(worst), tiny(relative), digits, good.to_owned()]);
    }
    table.print();
    remark("Relative: of each component, the worst of all. Digits: how many of it are right.");
    Ok(())
}
