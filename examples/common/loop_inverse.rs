//! Inverse dynamics of closed loops along a trajectory of the independent coordinates.

use redysim::{ClosedLoop, ClosedLoopInverse, InverseDynamics, LoopClosure, MassMatrix, Trajectory, Vector};

use super::compare::deviations;
use super::csv::{Csv, headers};
use super::loop_motion::position_residual;
use super::reference::Reference;
use super::{Context, Failure, Rows, Series, peak};

/// A motion, and the forces of actuators and loops that it takes.
pub struct LoopInverseRun {
    /// The instants, s.
    pub t: Vec<f64>,
    /// Coordinates, velocities and accelerations of all joints.
    pub q: Rows,
    pub v: Rows,
    pub a: Rows,
    /// Forces of the actuated joints alone, N m.
    pub tau: Rows,
    /// λ, N.
    pub lambda: Rows,
    /// The largest position residual, m.
    pub position_residual: f64,
    /// The smallest rank.
    pub rank: usize,
}

/// The forces along the trajectory of the coordinates `actuated` at the instants `t`, on the branch of the guess `q`.
pub fn along_loops<M, I>(
    mechanism: &M,
    actuated: &[usize],
    q: M::Coordinates,
    trajectory: &impl Trajectory<f64, I, I>,
    t: Vec<f64>,
) -> Result<LoopInverseRun, Failure>
where
    M: MassMatrix<f64> + InverseDynamics<f64> + LoopClosure<f64, M>,
    I: Vector<f64>,
{
    let mut inverse = ClosedLoopInverse::new(ClosedLoop::new(mechanism), actuated, q);
    let empty = Vec::new;
    let mut run = LoopInverseRun {
        q: empty(),
        v: empty(),
        a: empty(),
        tau: empty(),
        lambda: empty(),
        position_residual: 0.0,
        rank: usize::MAX,
        t: Vec::new(),
    };
    for &t in &t {
        let forces = inverse.at(t, trajectory).context(|| format!("inverse dynamics of the loops at {t} s"))?;
        run.position_residual = run.position_residual.max(position_residual(mechanism, &forces.motion.q));
        run.rank = run.rank.min(forces.rank);
        run.q.push(forces.motion.q.as_ref().to_vec());
        run.v.push(forces.motion.v.as_ref().to_vec());
        run.a.push(forces.motion.a.as_ref().to_vec());
        run.tau.push(actuated.iter().map(|&joint| forces.forces.as_ref()[joint]).collect());
        run.lambda.push(forces.multipliers.as_ref().to_vec());
    }
    Ok(LoopInverseRun { t, ..run })
}

impl LoopInverseRun {
    /// Some of its rows, under the project's name.
    pub fn series<'a>(&'a self, rows: &'a Rows) -> Series<'a> {
        Series { name: "redysim", t: &self.t, rows }
    }

    /// For each actuator, then for each row of the loops: peak force, and the largest deviation from the reference.
    pub fn force_deviations(&self, reference: &Reference) -> Vec<(f64, f64)> {
        let blocks = [(&self.tau, &reference.tau), (&self.lambda, &reference.lambda)];
        let of_block = |(ours, theirs): (&Rows, &Rows)| {
            let (deviations, _) = deviations(self.series(ours), reference.series(theirs));
            let peaks: Vec<_> = (0..deviations.len()).map(|k| peak(super::column(ours, k))).collect();
            peaks.into_iter().zip(deviations).collect::<Vec<_>>()
        };
        blocks.into_iter().flat_map(of_block).collect()
    }

    /// The largest of those deviations, as a part of the peak.
    pub fn worst(&self, reference: &Reference) -> f64 {
        peak(self.force_deviations(reference).into_iter().map(|(peak, deviation)| deviation / peak))
    }

    /// All numbers of the run.
    pub fn csv(&self) -> Csv {
        let joints = self.q[0].len();
        let mut columns = headers(joints, &[("q", "rad"), ("v", "rad/s"), ("a", "rad/s²")]);
        columns.extend((1..=self.tau[0].len()).map(|actuator| format!("tau{actuator} [N m]")));
        columns.extend((1..=self.lambda[0].len()).map(|row| format!("lambda{row} [N]")));
        let mut csv = Csv::new(&columns);
        for (k, &t) in self.t.iter().enumerate() {
            let blocks = [&self.q[k], &self.v[k], &self.a[k], &self.tau[k], &self.lambda[k]];
            csv.row(std::iter::once(t).chain(blocks.into_iter().flatten().copied()));
        }
        csv
    }
}
