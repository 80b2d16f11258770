//! What a law assumes that a link carries.

use redysim_model::spatial::Vec3;
use redysim_model::{GenericMechanism, JointKind, Link, Model};
use redysim_toml::{Message, Reader, Spanned};

use crate::scenario::keys;
use crate::scenario::subject::given;

/// Reads the table `payload`: `model` with a mass at a point of a link. Returns `Some(None)` without the table, and `None`
/// if it is invalid, which has been reported.
pub fn read(reader: &mut Reader<'_, '_>, model: &Model) -> Option<Option<Box<GenericMechanism>>> {
    let field = reader.table(&keys::PAYLOAD, |mut reader| {
        let name = reader.required(&keys::PAYLOAD_LINK, Reader::text);
        let mass = reader.required(&keys::PAYLOAD_MASS, Reader::number);
        let com = reader.vector(&keys::PAYLOAD_COM).value_or([0.0; 3]);
        let name = name.spanned()?;
        let named: Vec<_> = model.links.iter().enumerate().map(|(index, link)| (link.name.as_str(), index)).collect();
        let link = reader.lookup(name.span(), "link", name.get_ref(), &named)?;
        let (mass, com) = (mass.spanned()?, com?);
        let total = model.links[link].mass + mass.get_ref();
        if total < 0.0 {
            return negative(&mut reader, mass, &model.links[link]);
        }
        let mut laden = model.clone();
        laden.links.push(Link {
            mass: *mass.get_ref(),
            com: Vec3(com),
            ..Link::new("payload", Some(link), JointKind::Fixed)
        });
        Some(Box::new(GenericMechanism::new(laden)))
    });
    given(field)
}

fn negative<T>(reader: &mut Reader<'_, '_>, mass: &Spanned<f64>, link: &Link) -> Option<T> {
    let Link { name, mass: own, .. } = link;
    let title = format!(
        "{}: with a payload of {:?} kg the link `{name}` of {own:?} kg has a negative mass",
        reader.item(),
        mass.get_ref()
    );
    let help = format!("take off {own:?} kg at most");
    reader.error_at(mass.span(), Message { title, label: "more than the link has".into(), help })
}
