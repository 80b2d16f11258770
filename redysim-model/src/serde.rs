//! Models by [`serde`]: as their fields, and checked when they are read.

use crate::model::Model;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

impl Serialize for Model {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Model::serialize(self, serializer)
    }
}

/// Reads the fields, and [checks](Model::check) the model that they make: the error has every fault.
impl<'de> Deserialize<'de> for Model {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let model = Model::deserialize(deserializer)?;
        model.check().map(|loaded| loaded.model).map_err(Error::custom)
    }
}
