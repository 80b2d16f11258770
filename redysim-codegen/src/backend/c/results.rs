//! What functions take and give in C: arrays, matrices by rows, and structs with named parts.

use super::names::Prefix;
use redysim_model::PublicInterface;
use redysim_runtime::function::{Form, Length, Structure};

/// As a length is written behind the name of an array.
fn written(length: Length, prefix: &Prefix) -> String {
    match length {
        Length::Size(dimension) => prefix.constant(dimension.name()),
        Length::Three => "3".into(),
    }
}

fn number(length: Length, interface: &PublicInterface) -> usize {
    match length {
        Length::Size(dimension) => interface.size(dimension),
        Length::Three => 3,
    }
}

/// The lengths of an array behind its name.
pub fn brackets(lengths: &[Length], prefix: &Prefix) -> String {
    lengths.iter().map(|length| format!("[{}]", written(*length, prefix))).collect()
}

/// The indices of all elements of an array, in order.
fn indices(lengths: &[Length], interface: &PublicInterface) -> Vec<String> {
    lengths.iter().fold(vec![String::new()], |before, length| {
        let number = number(*length, interface);
        before.iter().flat_map(|indices| (0..number).map(move |index| format!("{indices}[{index}]"))).collect()
    })
}

/// An argument or a result in C.
pub trait InC {
    /// The type of its elements.
    fn element(&self, number: &str, prefix: &Prefix) -> String;
    /// The parameter that takes it, with its type.
    fn parameter(&self, number: &str, prefix: &Prefix) -> String;
    /// Where each of its numbers is stored, in order.
    fn places(&self, interface: &PublicInterface) -> Vec<String>;
    /// Whether it has no number, as the loops of a mechanism without loops.
    fn is_empty(&self, interface: &PublicInterface) -> bool;
}

impl InC for Form {
    fn element(&self, number: &str, prefix: &Prefix) -> String {
        self.structure.map_or(number.to_string(), |structure| prefix.type_of(structure.name))
    }

    fn parameter(&self, number: &str, prefix: &Prefix) -> String {
        let (element, Form { name, lengths, .. }) = (self.element(number, prefix), self);
        if lengths.is_empty() {
            format!("{element} *{name}")
        } else {
            format!("{element} {name}{}", brackets(lengths, prefix))
        }
    }

    fn places(&self, interface: &PublicInterface) -> Vec<String> {
        let Form { name, lengths, structure, .. } = self;
        let elements = indices(lengths, interface);
        match structure {
            None if lengths.is_empty() => vec![format!("*{name}")],
            None => elements.iter().map(|indices| format!("{name}{indices}")).collect(),
            Some(Structure { fields, .. }) => {
                let parts: Vec<String> = fields
                    .iter()
                    .flat_map(|(field, lengths, _)| {
                        indices(lengths, interface).into_iter().map(move |indices| format!("{field}{indices}"))
                    })
                    .collect();
                let joint = if lengths.is_empty() { "->" } else { "." };
                let all = elements.iter().flat_map(|element| parts.iter().map(move |part| (element, part)));
                all.map(|(element, part)| format!("{name}{element}{joint}{part}")).collect()
            }
        }
    }

    fn is_empty(&self, interface: &PublicInterface) -> bool {
        self.lengths.iter().any(|length| number(*length, interface) == 0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use redysim_runtime::function::Shape;

    #[test]
    fn places_are_in_the_order_of_the_shape() {
        let interface = PublicInterface { frames: vec!["tip".into()], ..PublicInterface::default() };
        let places = Shape::Frames.form().places(&interface);
        assert_eq!(places.len(), 18);
        assert_eq!(
            [&places[1], &places[9], &places[17]],
            ["frames[0].rotation[0][1]", "frames[0].origin[0]", "frames[0].angular_velocity[2]"]
        );
        assert_eq!(Shape::Energy.form().places(&interface), ["energy->kinetic", "energy->potential"]);
        assert!(Shape::LoopRows.form().is_empty(&interface) && !Shape::Power.form().is_empty(&interface));
    }
}
