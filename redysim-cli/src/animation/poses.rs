//! Where every link is, frame by frame.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use redysim_model::{GenericMechanism, Model};
use redysim_runtime::LinkKinematics;
use serde::Serialize;

use crate::failure::Failure;
use crate::recorded::{Recorded, Table, spread};

/// Frames that a page holds at most; between them it interpolates.
const FRAMES: usize = 1200;
/// Links times frames at most, for mechanisms of very many links.
const LINK_FRAMES: usize = 60_000;

/// The poses of all links over time.
#[derive(Serialize)]
pub struct Poses {
    /// The instants, s.
    t: Vec<f64>,
    /// For each instant and each link: the origin x, y, z, m, and the rotation as a quaternion x, y, z, w.
    values: Vec<f32>,
}

/// Origin and axes (as columns; `[row][column]`) of a link.
type Pose = ([f64; 3], [[f64; 3]; 3]);

/// The poses that the run has written, or else those of the joint angles that it has.
pub fn of(recorded: &Recorded, model: &Model) -> Result<Poses, Failure> {
    if let Some(table) = recorded.table("kinematics.csv")? {
        return written(&table, model);
    }
    if let Some(table) = recorded.motion()? {
        return computed(&table, model);
    }
    let folder = recorded.folder().display();
    Err(Failure::input(format!("{folder} holds no motion: no kinematics.csv, statevar.csv or traj.csv"))
        .help("a run writes them; is this its folder?"))
}

/// From the columns x, y, z and r11 to r33 of every link.
fn written(table: &Table, model: &Model) -> Result<Poses, Failure> {
    let mut links = Vec::new();
    for link in &model.links {
        let columns = ["x", "y", "z", "r11", "r12", "r13", "r21", "r22", "r23", "r31", "r32", "r33"];
        links.push(columns.iter().map(|symbol| table.column(symbol, &link.name)).collect::<Result<Vec<_>, _>>()?);
    }
    frames(&table.t, model.links.len(), |row| {
        let mut poses = Vec::with_capacity(links.len());
        for columns in &links {
            if let Some(column) = columns.iter().find(|column| !column.values[row].is_finite()) {
                return Err(table.fault(column, row, "is no place where a link can be"));
            }
            let at = |index: usize| columns[index].values[row];
            poses.push(([at(0), at(1), at(2)], [3, 6, 9].map(|r| [at(r), at(r + 1), at(r + 2)])));
        }
        Ok(poses)
    })
}

/// From the joint coordinates, by the model.
fn computed(table: &Table, model: &Model) -> Result<Poses, Failure> {
    let joints: Result<Vec<_>, _> = model.moving_links().map(|link| table.column("q", &link.joint_name)).collect();
    let (joints, mechanism) = (joints?, GenericMechanism::new(model.clone()));
    frames(&table.t, model.links.len(), |row| {
        if let Some(column) = joints.iter().find(|column| !column.values[row].is_finite()) {
            return Err(table.fault(column, row, "is no position of a joint"));
        }
        let q: Vec<f64> = joints.iter().map(|column| column.values[row]).collect();
        let links = mechanism.link_kinematics(&q, &vec![0.0; q.len()]);
        Ok(links.into_iter().map(|link| (link.origin, link.rotation)).collect())
    })
}

/// The poses at as many instants as a page can hold.
fn frames(t: &[f64], links: usize, pose: impl Fn(usize) -> Result<Vec<Pose>, Failure>) -> Result<Poses, Failure> {
    let rows = spread(t.len(), FRAMES.min(LINK_FRAMES / links.max(1)).max(100));
    let mut values = Vec::with_capacity(rows.len() * links * 7);
    for &row in &rows {
        for (origin, axes) in pose(row)? {
            let axes = Matrix3::from_fn(|row, column| axes[row][column]);
            let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
            values.extend(origin.iter().chain(turn.coords.iter()).map(|&x| x as f32));
        }
    }
    Ok(Poses { t: rows.into_iter().map(|row| t[row]).collect(), values })
}
