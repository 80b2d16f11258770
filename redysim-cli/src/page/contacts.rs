//! What a run has done to the ground: the forces of its contacts, and the places where they touched down.

use redysim_model::{GenericMechanism, Model};
use redysim_runtime::Frames;
use serde::Serialize;

use super::bodies::{self, Body};
use super::footprints::TouchDowns;
use super::planes::{Plane, PlaneContact, meets_ground, planes_and_contacts};
use crate::data::Results;
use crate::failure::Failure;
use crate::layout::Layout;
use crate::number::counted;
use crate::recorded::{Recorded, evenly};
use crate::results::names;
use crate::table::Table;

/// Components of forces that a page holds at most: a megabyte of them.
const NUMBERS: usize = 60_000;

/// The ground and its contacts over time.
#[derive(Serialize)]
pub struct Contacts {
    /// Whether the first plane is the ground of the scenario.
    ground: bool,
    /// The ground, if a contact meets it, then the other planes.
    planes: Vec<Plane>,
    /// The instants of the forces, s.
    t: Vec<f64>,
    places: Vec<Place>,
    /// How many touch-downs have no footprint, since no row shows them.
    #[serde(skip)]
    lost: u64,
}

/// A contact.
#[derive(Serialize)]
struct Place {
    /// The number of the plane that it meets.
    plane: usize,
    /// The body that carries it, and where it is in the frame of the body, m.
    body: usize,
    position: [f64; 3],
    /// The force on the mechanism in the base frame at each instant, N.
    forces: Vec<[f32; 3]>,
    /// When, s, and where on the plane, m, it touched down; also where it stands at the start.
    footprints: Vec<[f64; 4]>,
}

/// The contacts of a run; `None` for a run without contacts.
///
/// # Errors
/// If the run or its tables cannot be read.
pub fn of(recorded: &Recorded, model: &Model, layout: &Layout) -> Result<Option<Contacts>, Failure> {
    let (Some(table), Some(motion)) = (recorded.table(names::CONTACTS)?, recorded.motion()?) else { return Ok(None) };
    let Results { scenario, run, .. } = Results::load(recorded.folder())?;
    let touch_downs = TouchDowns::of(recorded)?;
    let (planes, contacts) = planes_and_contacts(&scenario)?;
    let mechanism = GenericMechanism::new(model.clone());
    let q = positions(&motion, layout);
    let at_rest = vec![0.0; layout.nv()];
    let origins: Vec<Vec<[f64; 3]>> =
        q.iter().map(|q| mechanism.frame_kinematics(q, &at_rest).iter().map(|state| state.origin).collect()).collect();
    let rows = evenly(table.t.len(), NUMBERS / (3 * contacts.len()).max(1));
    let of_frames: Vec<_> = bodies::frames(model).into_iter().skip(model.links.len()).collect();
    let mut places = Vec::new();
    for (contact, PlaneContact { name, frame, plane }) in contacts.into_iter().enumerate() {
        let Some(number) = model.frames.iter().position(|of| of.name == frame) else { continue };
        let column = |symbol: &str| table.of(symbol).find(|column| column.name == name).map(|column| &column.values);
        let (Some(x), Some(y), Some(z)) = (column("force_x"), column("force_y"), column("force_z")) else { continue };
        let Some(touching) = column("touching") else { continue };
        // At the start it may stand there. Without a record of touch-downs it begins where a row has it and the last one
        // does not.
        let begins =
            |row: &usize| touching[*row] > 0.5 && (*row == 0 || touch_downs.is_none() && touching[row - 1] < 0.5);
        let in_row = |row: usize| Some((table.t[row], *origins.get(row)?.get(number)?));
        let by_rows = (0..table.t.len()).filter(begins).filter_map(in_row);
        let in_record = touch_downs.iter().flat_map(|touch_downs| touch_downs.of_contact(contact));
        let (body, position) = of_frames[number].place();
        places.push(Place {
            plane,
            body,
            position,
            forces: rows.iter().map(|&row| [x[row] as f32, y[row] as f32, z[row] as f32]).collect(),
            footprints: by_rows.chain(in_record).map(|print| planes[plane].footprint(print)).collect(),
        });
    }
    let t = rows.iter().map(|&row| table.t[row]).collect();
    let after_start =
        places.iter().flat_map(|place| &place.footprints).filter(|[t, ..]| *t > table.t[0]).count() as u64;
    let without_record = run.touch_downs.filter(|_| touch_downs.is_none());
    let lost = without_record.map_or(0, |count| count.saturating_sub(after_start));
    Ok(Some(Contacts { ground: meets_ground(&scenario), planes, t, places, lost }))
}

impl Contacts {
    /// That footprints are missing.
    pub fn note(&self) -> Option<String> {
        let note = |lost| {
            let touch_downs = counted(lost, "touch-down");
            format!("{touch_downs} between instants without a footprint: run the scenario again, which records them")
        };
        (self.lost > 0).then(|| note(self.lost))
    }

    /// Draws each body to its contacts.
    pub fn extend(&self, bodies: &mut [Body<'_>]) {
        for Place { body, position, .. } in &self.places {
            bodies[*body].reach_to(*position);
        }
    }
}

/// The coordinates at each row.
fn positions(motion: &Table, layout: &Layout) -> Vec<Vec<f64>> {
    let columns: Vec<_> = layout
        .coordinates
        .iter()
        .filter_map(|coordinate| motion.of("q").find(|column| column.name == coordinate.name.trim()))
        .collect();
    (0..motion.t.len()).map(|row| columns.iter().map(|column| column.values[row]).collect()).collect()
}
