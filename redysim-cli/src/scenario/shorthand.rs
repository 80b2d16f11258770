//! Names in a scenario file that stand for tables.

use toml::Table;
use toml_edit::{Item, Value, value};

use super::keys;
use crate::text::set_default;

/// A table of one of several kinds, for which the name of its kind may stand.
pub struct Shorthand {
    /// The key of the table.
    pub key: &'static str,
    /// The key of the kind, in the table.
    kind: &'static str,
    default: &'static str,
}

pub const TRAJECTORY: Shorthand =
    Shorthand { key: keys::TRAJECTORY.name, kind: keys::MOTION_KIND.name, default: "cycloid" };
pub const INTEGRATOR: Shorthand = Shorthand { key: keys::INTEGRATOR.name, kind: keys::METHOD.name, default: "Ode45" };
pub const TORQUE: Shorthand = Shorthand { key: keys::TORQUE.name, kind: keys::LAW.name, default: "free" };
pub const STABILISATION: Shorthand =
    Shorthand { key: keys::STABILISATION.name, kind: keys::STABILISATION_KIND.name, default: "projection" };
/// Those in `forward`.
pub const IN_FORWARD: [Shorthand; 3] = [TORQUE, STABILISATION, INTEGRATOR];

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

    /// Replaces a name in `table` by the table that it stands for, without a default.
    pub fn spell_out(&self, table: &mut Table) {
        if let Some(value) = table.get_mut(self.key).filter(|value| value.is_str() || value.is_integer()) {
            *value = Table::from_iter([(self.kind.to_owned(), value.clone())]).into();
        }
    }
}
