//! How cuts of every kind close, by the kinematics of Kane's equations.

use super::kane::{Body, Kane};
use nalgebra::{DMatrix, Matrix3, RowDVector};
use redysim_model::{CutKind, Loop, Model};

/// The Jacobian of all loops: how what vanishes where they are closed changes with each of `dof` velocities. Rows that are zero
/// at every position are among them.
///
/// From the library it takes only which two directions it measures along across the axis of a cut.
pub fn loop_rows(model: &Model, equations: &Kane, dof: usize) -> DMatrix<f64> {
    let cuts = model.loops.iter().zip(&equations.loops);
    let rows: Vec<_> = cuts.flat_map(|(cut, [a, b])| rows_of(cut, a, b, dof)).collect();
    DMatrix::from_fn(rows.len(), dof, |row, velocity| rows[row][velocity])
}

/// The rows of one cut between the points `a` and `b`.
fn rows_of(cut: &Loop, a: &Body, b: &Body, dof: usize) -> Vec<RowDVector<f64>> {
    let axes = cut.axes().map(|axes| Matrix3::from_fn(|i, j| axes.0[i][j]));
    let (axes_of_a, axes_of_b) = (a.rotation * axes[0], b.rotation * axes[1]);
    let ((linear_of_a, angular_of_a), (linear_of_b, angular_of_b)) = (a.jacobians(dof), b.jacobians(dof));
    let (way, moved, turned) = (b.origin - a.origin, linear_of_b - linear_of_a, angular_of_b - &angular_of_a);
    let points = || (0..3).map(|i| moved.row(i).into_owned());
    // The rate of a·w, with an axis a of side a and the way w between the points.
    let along = |i: usize| {
        let axis = axes_of_a.column(i);
        axis.transpose() * &moved + axis.cross(&way).transpose() * &angular_of_a
    };
    // The rate of a·b, with an axis of either side.
    let aligned = |i: usize, j: usize| axes_of_b.column(j).cross(&axes_of_a.column(i)).transpose() * &turned;
    // The sine of the angle between the frames about each axis.
    let frames = || [(2, 1), (0, 2), (1, 0)].map(|(i, j)| (aligned(i, j) - aligned(j, i)) * 0.5);
    let axis = || [aligned(0, 2), aligned(1, 2)];
    match cut.joint {
        CutKind::Spherical => points().collect(),
        CutKind::Revolute => points().chain(axis()).collect(),
        CutKind::Universal => points().chain([aligned(2, 2)]).collect(),
        CutKind::Cylindrical => [along(0), along(1)].into_iter().chain(axis()).collect(),
        CutKind::Planar => [along(2)].into_iter().chain(axis()).collect(),
        CutKind::Prismatic => [along(0), along(1)].into_iter().chain(frames()).collect(),
        CutKind::Weld => points().chain(frames()).collect(),
        other => panic!("the rows of {other:?} cuts are not written"),
    }
}
