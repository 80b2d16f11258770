//! What acts in the joint itself: keys that belong together, and to a joint that moves.

use crate::joint::{FRICTION_VELOCITY, JointPhysics};
use crate::messages;
use crate::model::JointKind;
use crate::schema::{LinkTable, PhysicsKeys, keys};
use redysim_toml::{Findings, Spanned};
use std::ops::Range;

/// The physics of the link's joint.
pub(super) fn check(link: &LinkTable, findings: &mut Findings) -> Option<JointPhysics> {
    let PhysicsKeys { armature, damping, friction, friction_velocity, stiffness, rest } = &link.physics;
    if link.joint.value() == Some(&JointKind::Fixed) {
        for (key, place) in link.physics.given() {
            findings.error(place, messages::physics_of_fixed(&link.item, key.name));
        }
    }
    let mut needs = |place: Option<Range<usize>>, key: &str, is_missing: bool, missing: &str| {
        if let Some(place) = place.filter(|_| is_missing) {
            findings.error(place, messages::physics_without(&link.item, key, missing));
        }
    };
    let place = friction_velocity.spanned().map(Spanned::span);
    needs(place, keys::FRICTION_VELOCITY.name, friction.is_missing(), keys::FRICTION.name);
    needs(rest.spanned().map(Spanned::span), keys::REST.name, stiffness.is_missing(), keys::STIFFNESS.name);
    Some(JointPhysics {
        armature: armature.value_or(0.0.into())?,
        damping: damping.value_or(0.0.into())?,
        friction: friction.value_or(0.0.into())?,
        friction_velocity: friction_velocity.value_or(FRICTION_VELOCITY.into())?,
        stiffness: stiffness.value_or(0.0.into())?,
        rest: rest.value_or(Vec::new())?,
    })
}
