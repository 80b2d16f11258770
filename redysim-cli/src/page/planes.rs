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
    for contact in scenario.contact.iter().flatten() {
        let plane = Plane::of(own_ground(contact).unwrap_or(ground))?;
        let number = planes.iter().position(|other| *other == plane).unwrap_or(planes.len());
        if number == planes.len() {
            planes.push(plane);
        }
        contacts.extend(named(contact).into_iter().map(|(name, frame)| PlaneContact { name, frame, plane: number }));
    }
    Ok((planes, contacts))
}

/// Whether a contact meets the ground of the scenario.
pub fn meets_ground(scenario: &Scenario) -> bool {
    scenario.contact.iter().flatten().any(|contact| own_ground(contact).is_none())
}

/// The plane of the contacts of a table `contact`, if it is not the ground of the scenario.
fn own_ground(contact: &Contact) -> Option<Ground> {
    let (Contact::ReDySim { ground, .. } | Contact::HuntCrossley { ground, .. }) = contact;
    *ground
}

/// Names and frames of the contacts of a table `contact`.
fn named(contact: &Contact) -> Vec<(&str, &str)> {
    let (Contact::ReDySim { name, frame, .. } | Contact::HuntCrossley { name, frame, .. }) = contact;
    match frame {
        FrameNames::One(frame) => vec![(name.as_deref().unwrap_or(frame), frame)],
        FrameNames::Several(frames) => frames.iter().map(|frame| (frame.as_str(), frame.as_str())).collect(),
    }
}
