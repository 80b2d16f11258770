//! Sizes of a mechanism, and names and units of its vectors.

use super::Mechanism;
use pyo3::prelude::*;
use redysim_model::joint::{LinkJoint, Measure};
use redysim_runtime::function::Dimension;

impl Mechanism {
    fn measures(&self, of: fn(LinkJoint) -> Vec<Measure>) -> impl Iterator<Item = Measure> {
        self.file.model.moving_links().filter_map(LinkJoint::of).flat_map(of)
    }

    /// The loop of each row of the constraints, the number of the row among those of the loop, from 1, and what it measures.
    fn loop_rows(&self) -> impl Iterator<Item = (&str, usize, Measure)> {
        let loops = self.file.model.loops.iter().zip(&self.tree.cuts);
        loops.flat_map(|(each, cut)| {
            let kept = cut.joint.rows().iter().zip(&cut.rows).filter(|(_, kept)| **kept);
            kept.zip(1..).map(|((row, _), k)| (each.name.as_str(), k, row.measure()))
        })
    }
}

#[pymethods]
impl Mechanism {
    /// Number of coordinates.
    #[getter]
    pub(super) fn nq(&self) -> usize {
        self.interface().size(Dimension::Coordinates)
    }

    /// Number of velocities.
    #[getter]
    pub(super) fn nv(&self) -> usize {
        self.interface().size(Dimension::Velocities)
    }

    /// Number of links.
    #[getter]
    pub(super) fn nl(&self) -> usize {
        self.interface().size(Dimension::Links)
    }

    /// Number of rows of the loop constraints.
    #[getter]
    pub(super) fn nc(&self) -> usize {
        self.interface().size(Dimension::LoopRows)
    }

    /// Number of frames of interest.
    #[getter]
    pub(super) fn nf(&self) -> usize {
        self.interface().size(Dimension::Frames)
    }

    /// Names of the moving joints.
    #[getter]
    fn joint_names(&self) -> Vec<&str> {
        self.interface().joints.iter().map(|joint| joint.name.as_str()).collect()
    }

    /// Names of the coordinates; a joint of one coordinate gives it its own name.
    #[getter]
    fn coordinate_names(&self) -> Vec<&str> {
        self.interface().coordinate_names().collect()
    }

    /// Names of the velocities.
    #[getter]
    fn velocity_names(&self) -> Vec<&str> {
        self.interface().velocity_names().collect()
    }

    /// Units of the coordinates: rad, m, or 1 for a component of a quaternion.
    #[getter]
    fn coordinate_units(&self) -> Vec<&'static str> {
        self.measures(LinkJoint::coordinate_measures).map(Measure::unit).collect()
    }

    /// Units of what the velocities change: rad or m.
    #[getter]
    fn velocity_units(&self) -> Vec<&'static str> {
        self.measures(LinkJoint::velocity_measures).map(Measure::unit).collect()
    }

    /// Units of the joint forces: N m or N.
    #[getter]
    fn force_units(&self) -> Vec<&'static str> {
        self.measures(LinkJoint::velocity_measures).map(Measure::unit_of_force).collect()
    }

    /// Names of the rows of the loop constraints, as in results: the loop, and the number of the row in it, from 1.
    #[getter]
    fn loop_row_names(&self) -> Vec<String> {
        self.loop_rows().map(|(name, k, _)| format!("{name} {k}")).collect()
    }

    /// Units of the multipliers of the loop constraints: N, or N m for a row that aligns directions.
    #[getter]
    fn loop_force_units(&self) -> Vec<&'static str> {
        self.loop_rows().map(|(.., measure)| measure.unit_of_force()).collect()
    }

    /// Names of the links.
    #[getter]
    fn link_names(&self) -> &[String] {
        &self.interface().links
    }

    /// Names of the frames of interest.
    #[getter]
    fn frame_names(&self) -> &[String] {
        &self.interface().frames
    }

    /// Whether each velocity has an actuator.
    #[getter]
    fn actuated(&self) -> Vec<bool> {
        self.interface().actuated().collect()
    }
}
