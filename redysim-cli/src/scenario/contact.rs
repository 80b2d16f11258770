//! Contacts of frames with the ground, as a scenario has them.

use redysim_model::{GenericMechanism, Model};
use redysim_runtime::{AnyContactLaw, ContactError, GroundPlane, Grounded, HuntCrossleyContact, ReDySimContact};
use redysim_toml::{DeValue, Field, Key, KeyPath, Kind, Message, Reader, Spanned, Value};

use super::frames::frame;
use super::keys;
use super::subject::given;

/// A contact under any of the laws that scenarios have.
pub type Contact = redysim_runtime::Contact<f64, AnyContactLaw<f64>>;
/// A mechanism on the ground, or without contacts the mechanism alone.
pub type Ground<'a> = Grounded<'a, f64, GenericMechanism, AnyContactLaw<f64>>;

/// The law that has an exponent.
pub const HUNT_CROSSLEY: &str = "hunt-crossley";
/// The exponent of a contact of spheres.
pub const USUAL_EXPONENT: f64 = 1.5;
/// The horizontal plane at the origin.
pub const USUAL_POINT: [f64; 3] = [0.0; 3];
pub const USUAL_NORMAL: [f64; 3] = [0.0, 0.0, 1.0];

/// The contacts of a scenario.
#[derive(Debug, Default)]
pub struct Contacts {
    /// What they are called.
    pub names: Vec<String>,
    /// The contacts, of frames that the model has.
    pub list: Vec<Contact>,
    /// Whether one of them meets the ground of the scenario.
    pub meet_ground: bool,
}

impl Contacts {
    /// Reads `ground` and the tables `contact`; `None` if they are invalid, which has been reported.
    pub fn read(reader: &mut Reader<'_, '_>, model: &Model) -> Option<Contacts> {
        let ground = reader.table(&keys::GROUND, read_plane);
        let field = reader.field(&keys::CONTACT, |reader, path, value| {
            let array = reader.array(path, value, "an array of tables, each headed `[[contact]]`")?;
            reader.elements(path, array, |reader, path, value| Table::read(reader, path, value, model))
        });
        let tables = field.value_or(vec![])?;
        let meet_ground = tables.iter().any(|table| table.plane.is_none());
        if let Field::Value(given) = &ground
            && !meet_ground
        {
            let (why, add) = if tables.is_empty() {
                ("the scenario has no contact", "add tables `[[contact]]`")
            } else {
                ("each has a `ground` of its own", "leave `ground` out of a contact that meets it")
            };
            let title = format!("{}: `ground` applies only to contacts, and {why}", reader.item());
            let help = format!("{add}, or leave it out of the scenario");
            reader.warning_at(given.span(), Message { title, label: "without effect".into(), help });
        }
        let usual = || GroundPlane::new(USUAL_POINT, USUAL_NORMAL).ok();
        let ground = given(ground)?.or_else(usual)?;
        let mut contacts = Contacts { meet_ground, ..Contacts::default() };
        for Table { names, frames, plane, law } in tables {
            let plane = plane.unwrap_or(ground);
            for (name, frame) in names.into_iter().zip(frames) {
                if contacts.names.contains(name.get_ref()) {
                    return twice(reader, &name);
                }
                contacts.names.push(name.into_inner());
                contacts.list.push(Contact::new(frame, plane, law).ok()?);
            }
        }
        Some(contacts)
    }

    /// No contacts, with a warning if the scenario has some: inverse dynamics has no ground.
    pub fn left_out(reader: &mut Reader<'_, '_>) -> Contacts {
        if let Field::Value(given) = reader.field(&keys::CONTACT, |_, _, _| Some(())) {
            let title = format!(
                "{}: `contact` applies only to `redysim forward`: the forces of `redysim inverse` are those without the \
                 ground",
                reader.item()
            );
            let help =
                "let `redysim forward` follow the trajectory, with `law = \"computed-torque\"` or with the joints \
                        under `prescribed`, for forces on the ground; for forces in the air, leave `contact` out"
                    .to_owned();
            reader.warning_at(given.span(), Message { title, label: "not in these forces".into(), help });
        }
        Contacts::default()
    }

    /// `mechanism`, whose model has the frames, with these contacts.
    pub fn under<'a>(&'a self, mechanism: &'a GenericMechanism) -> Ground<'a> {
        Grounded::new(mechanism, &self.list).expect("the frames were found in the model")
    }
}

/// A table `contact`.
#[derive(Clone)]
struct Table {
    /// One for each frame.
    names: Vec<Spanned<String>>,
    frames: Vec<usize>,
    /// The plane, if it is not the ground of the scenario.
    plane: Option<GroundPlane<f64>>,
    law: AnyContactLaw<f64>,
}

/// How the parameters of a law are read.
type ReadLaw = fn(&mut Reader<'_, '_>) -> Option<AnyContactLaw<f64>>;

const LAWS: [Kind<ReadLaw>; 2] = [
    Kind::new("redysim", redysim_law, &keys::REDYSIM_CONTACT),
    Kind::new(HUNT_CROSSLEY, hunt_crossley_law, &keys::HUNT_CROSSLEY),
];

impl Table {
    fn read(reader: &mut Reader<'_, '_>, path: &KeyPath, value: &Value<'_>, model: &Model) -> Option<Table> {
        reader.table_of_kind_at(path, value, &keys::CONTACT_LAW, &LAWS, None, |mut reader, law| {
            let frames = frames(&mut reader, model);
            let names = frames.as_ref().and_then(|frames| names(&mut reader, frames));
            let plane = given(reader.table(&keys::CONTACT_GROUND, read_plane));
            let law = law(&mut reader);
            let frames = frames?.into_iter().map(|(_, frame)| frame).collect();
            Some(Table { names: names?, frames, plane: plane?, law: law? })
        })?
    }
}

/// The frames, by name and number.
fn frames(reader: &mut Reader<'_, '_>, model: &Model) -> Option<Vec<(Spanned<String>, usize)>> {
    let found = reader.required(&keys::CONTACT_FRAME, |reader, key| {
        reader.field(key, |reader, path, value| {
            let one = |reader: &mut Reader<'_, '_>, path: &KeyPath, value: &Value<'_>| {
                let DeValue::String(name) = value.get_ref() else {
                    return reader.wrong_type(path, value, "the name of a frame");
                };
                let name = Spanned::new(value.span(), name.to_string());
                let number = frame(reader, model, &name, "a contact")?;
                Some((name, number))
            };
            match value.get_ref() {
                DeValue::Array(array) if array.is_empty() => {
                    let title = format!("{}: `{path}` has no frame", reader.item());
                    let help = "name at least one frame of the model, or leave the contact out".to_owned();
                    reader.error(value, Message { title, label: "empty".into(), help })
                }
                DeValue::Array(array) => reader.elements(path, array, one),
                _ => Some(vec![one(reader, path, value)?]),
            }
        })
    });
    found.value().cloned()
}

/// What the contacts of `frames` are called.
fn names(reader: &mut Reader<'_, '_>, frames: &[(Spanned<String>, usize)]) -> Option<Vec<Spanned<String>>> {
    let field = reader.text(&keys::CONTACT_NAME);
    let of_frames = frames.iter().map(|(name, _)| name.clone()).collect();
    let Some(given) = field.spanned() else { return field.value_or(String::new()).map(|_| of_frames) };
    if let [_] = frames {
        return Some(vec![given.clone()]);
    }
    let title =
        format!("{}: the contact has {} frames and one name, `{}`", reader.item(), frames.len(), given.get_ref());
    let help =
        "leave `name` out: each contact is called by its frame; or give each frame a table of its own".to_owned();
    reader.error_at(given.span(), Message { title, label: "of several contacts".into(), help })
}

fn twice<T>(reader: &mut Reader<'_, '_>, name: &Spanned<String>) -> Option<T> {
    let title = format!("{}: two contacts are called `{}`", reader.item(), name.get_ref());
    let help = "name each frame once, or give one of them another `name`".to_owned();
    reader.error_at(name.span(), Message { title, label: "again here".into(), help })
}

fn redysim_law(reader: &mut Reader<'_, '_>) -> Option<AnyContactLaw<f64>> {
    let keys =
        [keys::CONTACT_STIFFNESS, keys::CONTACT_DAMPING, keys::LEAVING_SPEED, keys::FRICTION, keys::SLIDING_DAMPING];
    checked(reader, keys.map(|key| (key, None)), |[stiffness, damping, leaving_speed, friction, sliding_damping]| {
        AnyContactLaw::ReDySim(ReDySimContact { stiffness, damping, leaving_speed, friction, sliding_damping })
    })
}

fn hunt_crossley_law(reader: &mut Reader<'_, '_>) -> Option<AnyContactLaw<f64>> {
    let keys = [
        (keys::HUNT_CROSSLEY_STIFFNESS, None),
        (keys::EXPONENT, Some(USUAL_EXPONENT)),
        (keys::HUNT_CROSSLEY_DAMPING, None),
        (keys::FRICTION, None),
        (keys::SLIP_VELOCITY, None),
    ];
    checked(reader, keys, |[stiffness, exponent, damping, friction, slip_velocity]| {
        AnyContactLaw::HuntCrossley(HuntCrossleyContact { stiffness, exponent, damping, friction, slip_velocity })
    })
}

/// The law of numbers under `keys`, each required unless it has a default, by the rules of the law.
fn checked<const N: usize>(
    reader: &mut Reader<'_, '_>,
    keys: [(Key, Option<f64>); N],
    law: impl FnOnce([f64; N]) -> AnyContactLaw<f64>,
) -> Option<AnyContactLaw<f64>> {
    let fields = keys.map(|(key, default)| match default {
        Some(default) => (key, reader.number(&key), default),
        None => (key, reader.required(&key, Reader::number), f64::NAN),
    });
    let numbers: Option<Vec<f64>> = fields.iter().map(|(_, field, default)| field.value_or(*default)).collect();
    let law = law(numbers?.try_into().ok()?);
    let plane = GroundPlane::new(USUAL_POINT, USUAL_NORMAL).ok()?;
    let Err(ContactError::InvalidParameter { parameter, value, rule }) = Contact::new(0, plane, law) else {
        return Some(law);
    };
    let (_, field, _) = fields.iter().find(|(key, ..)| key.name == parameter)?;
    let title = format!("{}: `{parameter}` of a contact is {value:?}, and must be {rule}", reader.item());
    let help = format!("give a number that is {rule}");
    reader.error_at(field.spanned()?.span(), Message { title, label: "out of range".into(), help })
}

fn read_plane(mut reader: Reader<'_, '_>) -> Option<GroundPlane<f64>> {
    let (point, normal) = (reader.vector(&keys::POINT), reader.vector(&keys::NORMAL));
    let plane = GroundPlane::new(point.value_or(USUAL_POINT)?, normal.value_or(USUAL_NORMAL)?);
    plane.map_or_else(
        |_| {
            let title = format!("{}: the normal of the ground is zero, so that it has no direction", reader.item());
            let help = "give the direction out of the ground, of any length, such as [0, 0, 1]".to_owned();
            reader.error_at(normal.spanned()?.span(), Message { title, label: "no direction".into(), help })
        },
        Some,
    )
}
