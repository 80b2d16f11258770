//! Models by [`serde`]: as their fields, and checked when they are read.

use crate::model::{JointRange, Model};
use crate::per_velocity::PerVelocity;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

impl Serialize for Model {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Model::serialize(self, serializer)
    }
}

/// The ranges of a joint: those of its velocities, one by itself, or null.
pub(crate) fn ranges<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<JointRange>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Ranges {
        One(JointRange),
        Each(Vec<JointRange>),
    }
    Ok(match Option::deserialize(deserializer)? {
        None => Vec::new(),
        Some(Ranges::One(range)) => vec![range],
        Some(Ranges::Each(ranges)) => ranges,
    })
}

/// The coordinates of a joint: all of them, or one by itself.
pub(crate) fn coordinates<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
    Ok(PerVelocity::deserialize(deserializer)?.values().to_vec())
}

/// Reads the fields, and [checks](Model::check) the model that they make: the error has every fault.
impl<'de> Deserialize<'de> for Model {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let model = Model::deserialize(deserializer)?;
        model.check().map(|loaded| loaded.model).map_err(Error::custom)
    }
}
