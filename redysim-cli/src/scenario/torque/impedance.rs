//! Impedance control of a frame, as a scenario has it.

use redysim_model::{GenericMechanism, Model, rotation};
use redysim_runtime::{Compensation, FrameGains, FrameState, Frames, Impedance};
use redysim_toml::{DeValue, Field, Key, KeyPath, Reader, Value};

use super::payload;
use crate::scenario::frames::frame;
use crate::scenario::initial::Initial;
use crate::scenario::joints::not_negative;
use crate::scenario::keys;
use crate::scenario::subject::given;

/// A frame on springs and dampers.
#[derive(Clone, Debug)]
pub struct HeldFrame {
    /// The velocities that are driven.
    pub driven: Vec<usize>,
    /// The model with the payload that the law assumes, if it assumes one.
    laden: Option<Box<GenericMechanism>>,
    /// The number of the frame.
    frame: usize,
    /// Where its origin should be, if not where it starts, m.
    origin: Option<[f64; 3]>,
    /// How it should be turned, if not as it starts.
    rotation: Option<[[f64; 3]; 3]>,
    pub stiffness: FrameGains<f64>,
    pub damping: FrameGains<f64>,
    pub compensation: Compensation,
    pub null_space_damping: f64,
}

const COMPENSATIONS: [(&str, Compensation); 2] = [("gravity", Compensation::Gravity), ("bias", Compensation::Bias)];

impl HeldFrame {
    /// Reads the keys of the law, which drives the velocities `driven`.
    pub fn read(reader: &mut Reader<'_, '_>, model: &Model, driven: Vec<usize>) -> Option<HeldFrame> {
        let name = reader.required(&keys::FRAME, Reader::text);
        let frame = name.spanned().and_then(|name| frame(reader, model, name, "the law `impedance`"));
        let target = given(reader.table(&keys::POSE, |mut reader| {
            let (xyz, rpy) = (reader.vector(&keys::XYZ), reader.angles(&keys::RPY));
            if matches!(xyz, Field::Invalid) || matches!(rpy, Field::Invalid) {
                return None;
            }
            Some((xyz.value().copied(), rpy.value().map(|&rpy| rotation::roll_pitch_yaw(rpy).0)))
        }));
        let [stiffness, damping] =
            [keys::STIFFNESS, keys::DAMPING].map(|key| reader.required(&key, gains).value().copied());
        let [angular_stiffness, angular_damping] =
            [keys::ANGULAR_STIFFNESS, keys::ANGULAR_DAMPING].map(|key| gains(reader, &key).value_or([0.0; 3]));
        let compensation = reader.choice(&keys::COMPENSATION, &COMPENSATIONS).value_or(Compensation::default());
        let null_space_damping = reader.field(&keys::NULL_SPACE_DAMPING, gain).value_or(0.0);
        let laden = payload::read(reader, model);
        let (origin, rotation) = target?.unwrap_or_default();
        Some(HeldFrame {
            driven,
            laden: laden?,
            frame: frame?,
            origin,
            rotation,
            stiffness: FrameGains { linear: stiffness?, angular: angular_stiffness? },
            damping: FrameGains { linear: damping?, angular: angular_damping? },
            compensation: compensation?,
            null_space_damping: null_space_damping?,
        })
    }

    /// The law as it acts on `mechanism`, which starts at `initial`.
    pub fn law<'a>(
        &'a self,
        mechanism: &'a GenericMechanism,
        initial: &Initial,
    ) -> Impedance<'a, f64, GenericMechanism, FrameState<f64>> {
        let at_rest = vec![0.0; initial.v.len()];
        let start = mechanism.frame_kinematics(&initial.q, &at_rest)[self.frame];
        Impedance {
            mechanism: self.laden.as_deref().unwrap_or(mechanism),
            frame: self.frame,
            target: FrameState {
                origin: self.origin.unwrap_or(start.origin),
                rotation: self.rotation.unwrap_or(start.rotation),
                ..start
            },
            stiffness: self.stiffness,
            damping: self.damping,
            compensation: self.compensation,
            null_space_damping: self.null_space_damping,
        }
    }

    /// What scenarios call a compensation.
    pub fn name_of(compensation: Compensation) -> &'static str {
        let named = COMPENSATIONS.iter().find(|(_, other)| *other == compensation);
        named.map_or("", |(name, _)| name)
    }
}

/// Three gains, or one for all axes.
fn gains(reader: &mut Reader<'_, '_>, key: &Key) -> Field<[f64; 3]> {
    reader.field(key, |reader, path, value| {
        let DeValue::Array(array) = value.get_ref() else {
            return Some([gain(reader, path, value)?; 3]);
        };
        let gains = reader.elements(path, array, gain)?;
        let found = gains.len();
        gains.try_into().ok().or_else(|| reader.wrong_length(path, value, "3 numbers", found))
    })
}

/// A gain, which is zero or above.
fn gain(reader: &mut Reader<'_, '_>, path: &KeyPath, value: &Value<'_>) -> Option<f64> {
    not_negative(reader, path, value, "a negative gain drives the frame away from its place: give zero or more")
}
