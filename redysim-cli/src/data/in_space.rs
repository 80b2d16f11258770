//! Joints of several coordinates that a scenario file gives by one name, component by component.

use toml_edit::visit_mut::{self, VisitMut};
use toml_edit::{InlineTable, Item, KeyMut, TableLike, Value};

use crate::layout::{Joint, Layout, StatePart};
use crate::scenario::in_space::{Orientation, position_of};
use crate::scenario::keys;

/// Replaces what stands for all components of a joint, an array or the table of a position, by an entry for each.
pub struct InSpace<'a> {
    pub layout: &'a Layout,
    /// What the values at the place are for, if they are for components of joints.
    pub of: Option<StatePart>,
}

const KEYS: [(&str, StatePart); 12] = [
    (keys::Q.name, StatePart::Coordinates),
    (keys::FROM.name, StatePart::Coordinates),
    (keys::TO.name, StatePart::Coordinates),
    (keys::POINTS.name, StatePart::Coordinates),
    (keys::TARGET.name, StatePart::Coordinates),
    (keys::V.name, StatePart::Velocities),
    (keys::SPEED.name, StatePart::Velocities),
    (keys::KP.name, StatePart::Velocities),
    (keys::KI.name, StatePart::Velocities),
    (keys::KD.name, StatePart::Velocities),
    (keys::TRACKING_RATE.name, StatePart::Velocities),
    (keys::LIMITS.name, StatePart::Velocities),
];

impl VisitMut for InSpace<'_> {
    fn visit_table_like_kv_mut(&mut self, key: KeyMut<'_>, item: &mut Item) {
        let of = KEYS.iter().find(|(name, _)| *name == key.get()).map(|(_, of)| *of);
        if let (Some(of), Some(table)) = (of, item.as_table_like_mut()) {
            self.expand(of, table);
        }
        visit_mut::visit_table_like_kv_mut(&mut InSpace { of, ..*self }, key, item);
    }

    fn visit_inline_table_mut(&mut self, table: &mut InlineTable) {
        // A point of a motion, in an array.
        if let Some(of) = self.of {
            self.expand(of, table);
        }
        visit_mut::visit_inline_table_mut(self, table);
    }
}

impl InSpace<'_> {
    fn expand(&self, of: StatePart, table: &mut dyn TableLike) {
        for joint in self.layout.joints.iter().filter(|joint| joint.q.len() > 1) {
            let Some(values) = table.get(&joint.name).and_then(|item| values(item, joint)) else { continue };
            table.remove(&joint.name);
            for (component, value) in of.components(self.layout)[of.of_joint(joint)].iter().zip(values) {
                table.insert(&component.name, toml_edit::value(value));
            }
        }
    }
}

/// The values of all components of a joint; `None` unless the value is an array or the short form of a position.
fn values(item: &Item, joint: &Joint) -> Option<Vec<f64>> {
    let Some(table) = item.as_table_like() else { return numbers(item) };
    let three = |name: &str| -> Option<[f64; 3]> { numbers(table.get(name)?)?.try_into().ok() };
    let quaternion = || numbers(table.get(keys::QUATERNION.name)?)?.try_into().ok().map(Orientation::Quaternion);
    let rpy = || three(keys::JOINT_RPY.name).map(Orientation::Rpy);
    let axis_angle =
        || Some(Orientation::AxisAngle(three(keys::AXIS.name)?, number(table.get(keys::ANGLE.name)?.as_value()?)?));
    let orientation = quaternion().or_else(rpy).or_else(axis_angle);
    Some(position_of(joint, three(keys::JOINT_XYZ.name), orientation))
}

fn numbers(item: &Item) -> Option<Vec<f64>> {
    item.as_array()?.iter().map(number).collect()
}

fn number(value: &Value) -> Option<f64> {
    value.as_float().or(value.as_integer().map(|number| number as f64))
}
