//! One mechanism in motion, from a start that may be open.

use redysim::{Assembly, ClosedLoop, ClosedLoopSimulation, Integrator, LoopClosure, TorqueLaw, TreeDynamics};

use crate::common::loop_motion::{LoopMotion, record};
use crate::common::table::{Table, tiny};
use crate::common::{Failure, peak};

/// What to do with a mechanism.
pub struct Plan<'a, M: TreeDynamics<f64>, L> {
    pub name: &'static str,
    pub mechanism: &'a M,
    pub law: L,
    /// The start as it is given; assembly closes it.
    pub q: M::Coordinates,
    pub v: M::Velocities,
    /// What assembly holds.
    pub held: &'a [usize],
    /// The instants to record, s.
    pub t: Vec<f64>,
}

/// What was done.
pub struct Study {
    pub name: &'static str,
    pub motion: LoopMotion,
    cells: Vec<String>,
}

/// All mechanisms so far.
#[derive(Default)]
pub struct Studies {
    pub all: Vec<Study>,
    mended: Vec<String>,
}

/// A start that is open by more than this is reported in full, m: more than what four printed digits leave.
const OPEN: f64 = 1e-3;

impl Studies {
    /// Closes the start, moves the mechanism and records it.
    pub fn run<M, L>(&mut self, plan: Plan<'_, M, L>, integrator: &impl Integrator<f64>) -> Result<(), Failure>
    where
        M: TreeDynamics<f64> + LoopClosure<f64, M>,
        L: TorqueLaw<f64, M>,
    {
        let Plan { name, mechanism, law, q, v, held, t } = plan;
        let loops = ClosedLoop::new(mechanism);
        let residual = mechanism.loop_residual(&q).as_ref().to_vec();
        let start = loops.assemble(&q, &v, held)?;
        let mut simulation = ClosedLoopSimulation::new(loops, law);
        let state = simulation.assembled(&start);
        let motion = record(name, &mut simulation, integrator, state, &t)?;
        let largest = peak(residual.iter().copied());
        let joint = mechanism.velocity_name(start.velocity).unwrap_or("");
        if largest > OPEN {
            self.mended.push(mended(name, &residual, &start, joint));
        }
        let cells = vec![
            name.to_owned(),
            mechanism.nv().to_string(),
            mechanism.nc().to_string(),
            start.rank.to_string(),
            (mechanism.nv() - start.rank).to_string(),
            tiny(largest),
            tiny(start.largest_displacement.abs()),
            t[t.len() - 1].to_string(),
            motion.statistics.steps.to_string(),
            tiny(motion.worst_position_residual()),
            tiny(motion.worst_drift()),
            format!("{:.3}", motion.seconds),
        ];
        self.all.push(Study { name, motion, cells });
        Ok(())
    }

    /// The mechanism of that name, which was run.
    pub fn get(&self, name: &str) -> Result<&Study, Failure> {
        let found = self.all.iter().find(|study| study.name == name);
        found.ok_or_else(|| Failure(format!("{name} has not been run")))
    }

    /// A row for each.
    pub fn table(&self) -> Table {
        let mut table = Table::new(&[
            "mechanism",
            "joints\n",
            "rows\n",
            "rank\n",
            "mobility\n",
            "residual\nm",
            "moved\nrad, m",
            "run\ns",
            "steps\n",
            "open\nm",
            "energy drift\nJ",
            "time\ns",
        ]);
        for study in &self.all {
            table.row(study.cells.clone());
        }
        table
    }

    /// A line for each start that was mended.
    pub fn mended(&self) -> &[String] {
        &self.mended
    }
}

fn mended<Q, V>(name: &str, residual: &[f64], start: &Assembly<f64, Q, V>, joint: &str) -> String {
    let rows = residual.iter().map(|row| format!("{:.1}", 1e3 * row).replace('-', "−")).collect::<Vec<_>>();
    format!(
        "{name}: the shipped start is open by ({}) mm. Assembly moves {joint} by {:.3}°, the others by less.",
        rows.join(", "),
        start.largest_displacement.abs().to_degrees()
    )
}
