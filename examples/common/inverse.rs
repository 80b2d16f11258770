//! Inverse dynamics of a mechanism along a trajectory.

use redysim::{InverseDynamics, Trajectory};

use super::compare::deviations;
use super::csv::{Csv, headers};
use super::figure::{Figure, Panel, joint_grid};
use super::reference::Reference;
use super::table::{Table, digits, headline, remark, tiny};
use super::{Rows, Series, column, peak};

/// A motion and the joint forces that it takes.
pub struct InverseRun {
    /// The instants, s.
    pub t: Vec<f64>,
    /// Coordinates, rad, velocities, rad/s, and accelerations, rad/s².
    pub q: Rows,
    pub v: Rows,
    pub a: Rows,
    /// Joint forces, N m.
    pub tau: Rows,
}

/// The joint forces along the trajectory at the instants `t`.
pub fn along<M, T>(mechanism: &M, trajectory: &T, t: Vec<f64>) -> InverseRun
where
    M: InverseDynamics<f64>,
    T: Trajectory<f64, M::Coordinates, M::Velocities>,
{
    let mut run = InverseRun { t: Vec::new(), q: Vec::new(), v: Vec::new(), a: Vec::new(), tau: Vec::new() };
    for &t in &t {
        let motion = trajectory.at(t);
        let tau = mechanism.inverse_dynamics(&motion.q, &motion.v, &motion.a);
        run.q.push(motion.q.as_ref().to_vec());
        run.v.push(motion.v.as_ref().to_vec());
        run.a.push(motion.a.as_ref().to_vec());
        run.tau.push(tau.as_ref().to_vec());
    }
    InverseRun { t, ..run }
}

impl InverseRun {
    fn joints(&self) -> usize {
        self.tau[0].len()
    }

    fn forces(&self) -> Series<'_> {
        Series { name: "redysim", t: &self.t, rows: &self.tau }
    }

    /// Prints, for each joint, the peak force and the largest deviations from the references.
    pub fn report(&self, title: &str, references: &[&Reference]) {
        headline(title);
        let compared: Vec<_> = references.iter().map(|r| (r.by, deviations(self.forces(), r.series(&r.tau)))).collect();
        let mut header = vec!["joint".to_owned(), "peak |τ|\nN m".to_owned()];
        for (by, (_, instants)) in &compared {
            header.push(format!("max |Δτ| to {by},\n{instants} instants, N m"));
            header.push("\nof peak".to_owned());
        }
        let mut table = Table::new(&header.iter().map(String::as_str).collect::<Vec<_>>());
        let mut worst = 0.0_f64;
        for joint in 0..self.joints() {
            let peak = peak(column(&self.tau, joint));
            let mut cells = vec![(joint + 1).to_string(), digits(peak)];
            for (_, (deviations, _)) in &compared {
                worst = worst.max(deviations[joint] / peak);
                cells.extend([tiny(deviations[joint]), tiny(deviations[joint] / peak)]);
            }
            table.row(cells);
        }
        table.print();
        remark(&format!("Largest deviation: {} of the joint's peak.", tiny(worst)));
    }

    /// All numbers of the run.
    pub fn csv(&self) -> Csv {
        let quantities = [("q", "rad"), ("v", "rad/s"), ("a", "rad/s²"), ("tau", "N m")];
        let mut csv = Csv::new(&headers(self.joints(), &quantities));
        for (k, &t) in self.t.iter().enumerate() {
            let blocks = [&self.q[k], &self.v[k], &self.a[k], &self.tau[k]];
            csv.row(std::iter::once(t).chain(blocks.into_iter().flatten().copied()));
        }
        csv
    }

    /// The motion: angles, velocities and accelerations.
    pub fn motion_figure(&self) -> Figure {
        let panel = |title: &str, quantity: &str, unit: &str, rows: &Rows| {
            let degrees: Rows = rows.iter().map(|row| row.iter().map(|value| value.to_degrees()).collect()).collect();
            Panel::new(title, quantity, unit).joints(&self.t, &degrees)
        };
        let panels = vec![
            panel("Joint angles", "angle", "deg", &self.q),
            panel("Joint velocities", "velocity", "deg/s", &self.v),
            panel("Joint accelerations", "acceleration", "deg/s²", &self.a),
        ];
        Figure { columns: 1, panels, shared_legend: false }
    }

    /// The joint forces, each with a scale of its own, and the reference's.
    pub fn force_figure(&self, reference: &Reference) -> Figure {
        let mut figure = joint_grid("torque", "N m", 1.0, &[self.forces()], &[reference.series(&reference.tau)]);
        figure.panels = figure.panels.into_iter().map(Panel::prefixed).collect();
        figure
    }
}
