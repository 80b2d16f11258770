//! Reference results, which none of this project's code computed. Where they are from:
//! `tests/reference/README.md`.

use super::{Context, Failure, Rows, Series};

/// A reference run: values at instants.
pub struct Reference {
    /// Whose results these are.
    pub by: &'static str,
    /// The instants, s.
    pub t: Vec<f64>,
    /// Joint coordinates, rad.
    pub q: Rows,
    /// Joint velocities, rad/s.
    pub v: Rows,
    /// Joint accelerations, rad/s²; empty for a free motion.
    pub a: Rows,
    /// Joint forces, N m; empty for a free motion.
    pub tau: Rows,
    /// Multipliers of the loops' rows, N; empty for a tree.
    pub lambda: Rows,
}

impl Reference {
    /// Reads a file of joint forces: t, q, q̇, q̈, τ.
    pub fn joint_forces(by: &'static str, text: &str, joints: usize) -> Result<Self, Failure> {
        let rows = read(by, text, 1 + 4 * joints)?;
        let (a, tau) = (block(&rows, 2, joints), block(&rows, 3, joints));
        let (q, v) = (block(&rows, 0, joints), block(&rows, 1, joints));
        Ok(Reference { by, q, v, a, tau, lambda: Vec::new(), t: times(&rows) })
    }

    /// Reads a file of the forces of closed loops: t, q, q̇, q̈, the torques of the actuators, λ.
    pub fn loop_forces(by: &'static str, text: &str, joints: usize, actuated: usize) -> Result<Self, Failure> {
        let rows = read(by, text, 1 + 4 * joints)?;
        let tau = columns(&rows, 1 + 3 * joints, actuated);
        let lambda = columns(&rows, 1 + 3 * joints + actuated, joints - actuated);
        let [q, v, a] = [0, 1, 2].map(|index| block(&rows, index, joints));
        Ok(Reference { by, q, v, a, tau, lambda, t: times(&rows) })
    }

    /// Reads a file of a free motion: t, q, q̇, work of the actuators, kinetic energy, potential energy.
    pub fn motion(by: &'static str, text: &str, joints: usize) -> Result<Self, Failure> {
        let rows = read(by, text, 1 + 2 * joints + 3)?;
        let (q, v) = (block(&rows, 0, joints), block(&rows, 1, joints));
        Ok(Reference { by, q, v, a: Vec::new(), tau: Vec::new(), lambda: Vec::new(), t: times(&rows) })
    }

    /// Reads a file of a free motion with closed loops: as [`motion`](Self::motion), then λ of each of `nc` rows.
    pub fn loop_motion(by: &'static str, text: &str, joints: usize, nc: usize) -> Result<Self, Failure> {
        let rows = read(by, text, 1 + 2 * joints + 3 + nc)?;
        let (q, v) = (block(&rows, 0, joints), block(&rows, 1, joints));
        let lambda = columns(&rows, 1 + 2 * joints + 3, nc);
        Ok(Reference { by, q, v, a: Vec::new(), tau: Vec::new(), lambda, t: times(&rows) })
    }

    /// The instants up to `end` alone, s.
    pub fn until(mut self, end: f64) -> Self {
        let kept = self.t.partition_point(|&t| t <= end);
        self.t.truncate(kept);
        for rows in [&mut self.q, &mut self.v, &mut self.a, &mut self.tau, &mut self.lambda] {
            rows.truncate(kept);
        }
        self
    }

    /// Some of its rows, under its name.
    pub fn series<'a>(&'a self, rows: &'a Rows) -> Series<'a> {
        Series { name: self.by, t: &self.t, rows }
    }
}

/// Lines of numbers with commas between them, and comments behind `#`.
pub fn read(by: &str, text: &str, columns: usize) -> Result<Rows, Failure> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.starts_with('#'));
    let row = |(index, line): (usize, &str)| {
        let place =
            || format!("results by {by}, line {} of their file in tests/reference; restore the file", index + 1);
        let numbers = line.split(',').map(|number| number.trim().parse::<f64>().context(place));
        let numbers = numbers.collect::<Result<Vec<_>, _>>()?;
        if numbers.len() == columns {
            Ok(numbers)
        } else {
            Err(Failure(format!("{}: {} numbers where {columns} should be", place(), numbers.len())))
        }
    };
    lines.map(row).collect()
}

fn block(rows: &Rows, index: usize, joints: usize) -> Rows {
    columns(rows, 1 + index * joints, joints)
}

fn columns(rows: &Rows, first: usize, count: usize) -> Rows {
    rows.iter().map(|row| row[first..first + count].to_vec()).collect()
}

fn times(rows: &Rows) -> Vec<f64> {
    rows.iter().map(|row| row[0]).collect()
}
