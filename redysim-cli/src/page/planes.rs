//! The planes that the contacts of a scenario meet.

use redysim_runtime::GroundPlane;
use serde::Serialize;

use crate::data::{Contact, FrameNames, Ground, Scenario};
use crate::failure::Failure;
use crate::scenario::contact::{USUAL_NORMAL, USUAL_POINT};

/// A plane.
#[derive(PartialEq, Serialize)]
pub struct Plane {
    /// A point of it, m.
    point: [f64; 3],
    /// Its outward unit normal.
    normal: [f64; 3],
    #[serde(skip)]
    plane: GroundPlane<f64>,
}

impl Plane {
    fn of(ground: Ground) -> Result<Plane, Failure> {
        let (point, normal) = (ground.point.unwrap_or(USUAL_POINT), ground.normal.unwrap_or(USUAL_NORMAL));
        let plane = GroundPlane::new(point, normal).map_err(Failure::input)?;
        Ok(Plane { point, normal: plane.normal(), plane })
    }

    /// A footprint: when, s, and the point of the plane nearest to `place`, m.
    pub fn footprint(&self, (t, place): (f64, [f64; 3])) -> [f64; 4] {
        let height = self.plane.height(&place);
        let [x, y, z] = [0, 1, 2].map(|axis| place[axis] - height * self.normal[axis]);
        [t, x, y, z]
    }
}

/// A contact of a scenario.
pub struct PlaneContact<'s> {
    pub name: &'s str,
    pub frame: &'s str,
    /// The number of the plane that it meets.
    pub plane: usize,
}

/// The contacts of a scenario, and the planes that they meet: the ground of the scenario, if one meets it, then the others.
///
/// # Errors
/// If a normal is zero.
pub fn planes_and_contacts(scenario: &Scenario) -> Result<(Vec<Plane>, Vec<PlaneContact<'_>>), Failure> {
    let ground = scenario.ground.unwrap_or_default();
    let mut planes = Vec::new();
    if meets_ground(scenario) {
        planes.push(Plane::of(ground)?);
    }
    let mut contacts = Vec::new();
    for (frames, own) in scenario.contact.iter().flatten().map(parts) {
        let plane = Plane::of(own.unwrap_or(ground))?;
        let number = planes.iter().position(|other| *other == plane).unwrap_or(planes.len());
        if number == planes.len() {
            planes.push(plane);
        }
        contacts.extend(frames.into_iter().map(|(name, frame)| PlaneContact { name, frame, plane: number }));
    }
    Ok((planes, contacts))
}

/// Whether a contact meets the ground of the scenario.
pub fn meets_ground(scenario: &Scenario) -> bool {
    scenario.contact.iter().flatten().any(|contact| parts(contact).1.is_none())
}

/// The contacts of a table `contact`, by name and frame, and their own ground.
fn parts(contact: &Contact) -> (Vec<(&str, &str)>, Option<Ground>) {
    let (Contact::ReDySim { name, frame, ground, .. } | Contact::HuntCrossley { name, frame, ground, .. }) = contact;
    let frames = match frame {
        FrameNames::One(frame) => vec![(name.as_deref().unwrap_or(frame), frame.as_str())],
        FrameNames::Several(frames) => frames.iter().map(|frame| (frame.as_str(), frame.as_str())).collect(),
    };
    (frames, *ground)
}
