//! Names in a scenario file that stand for tables.

use toml_edit::{Item, Value, value};

use super::keys;
use crate::text::set_default;

/// A table of one of several kinds, for which the name of its kind may stand.
pub struct Shorthand {
    /// The key of the kind.
    kind: &'static str,
    default: &'static str,
}

pub const TRAJECTORY: Shorthand = Shorthand { kind: keys::MOTION_KIND.name, default: "cycloid" };
pub const INTEGRATOR: Shorthand = Shorthand { kind: keys::METHOD.name, default: "Ode45" };
pub const TORQUE: Shorthand = Shorthand { kind: keys::LAW.name, default: "free" };
pub const STABILISATION: Shorthand = Shorthand { kind: keys::STABILISATION_KIND.name, default: "projection" };

/// The name of a kind, which may be a number.
pub fn name(item: &Item) -> Option<String> {
    match item {
        Item::Value(Value::String(name)) => Some(name.value().clone()),
        Item::Value(Value::Integer(number)) => Some(number.value().to_string()),
        _ => None,
    }
}

impl Shorthand {
    /// Replaces a name by the table that it stands for. A table without a kind, or one that is not there, gets the
    /// default.
    pub fn expand(&self, item: &mut Item) {
        if let Some(name) = name(item) {
            *item = Item::None;
            item[self.kind] = value(name);
        }
        set_default(item, self.kind, value(self.default));
    }
}
