//! Joint forces over time, from a table.

use redysim_model::GenericMechanism;
use redysim_runtime::TorqueLaw;

use super::subject::spread;
use super::table::InputTable;
use crate::failure::Failure;
use crate::layout::Layout;

/// Joint forces over time, with straight lines between the rows of a table.
#[derive(Clone, Debug)]
pub struct Forces {
    /// The table that they were read from.
    pub table: InputTable,
    /// By rows, a force for each velocity; zero for a velocity without a column.
    rows: Vec<Vec<f64>>,
}

impl Forces {
    /// Those along `velocities`.
    pub fn of(table: InputTable, layout: &Layout, velocities: &[usize]) -> Result<Forces, Failure> {
        let rows = table.of_components("tau", &layout.velocities, velocities, None)?;
        let rows =
            rows.ok_or_else(|| table.fault("it has no forces", "add a column `tau <joint> [N m]` for each joint"))?;
        let rows = rows.iter().map(|row| spread(velocities, row, &layout.velocities)).collect();
        Ok(Forces { table, rows })
    }

    fn at(&self, time: f64) -> Vec<f64> {
        let t = &self.table.t;
        let right = t.partition_point(|&row| row <= time).clamp(1, t.len() - 1);
        let (from, to) = (&self.rows[right - 1], &self.rows[right]);
        // Beyond the ends, by rounding or within a last step, the forces are those of the ends.
        let part = ((time - t[right - 1]) / (t[right] - t[right - 1])).clamp(0.0, 1.0);
        from.iter().zip(to).map(|(from, to)| from + part * (to - from)).collect()
    }
}

type Pair<'a> = (&'a Vec<f64>, &'a Vec<f64>);

impl TorqueLaw<f64, GenericMechanism> for &Forces {
    fn torque(&mut self, _mechanism: &GenericMechanism, t: f64, _q: &Vec<f64>, _v: &Vec<f64>) -> Vec<f64> {
        self.at(t)
    }

    fn torque_tangent(
        &mut self,
        _mechanism: &GenericMechanism,
        _t: f64,
        _at: Pair<'_>,
        (_, dv): Pair<'_>,
    ) -> Option<Vec<f64>> {
        Some(vec![0.0; dv.len()])
    }
}
