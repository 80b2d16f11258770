//! What acts in a joint itself: numbers that a joint can have.

use super::placement::of_several_freedoms;
use crate::joint::{FRICTION_VELOCITY, JointPhysics};
use crate::messages;
use crate::model::JointKind;
use crate::schema::{LinkTable, PhysicsKeys, keys};
use redysim_toml::{Field, Findings};

/// The physics of the link's joint.
pub(super) fn check(link: &LinkTable, findings: &mut Findings) -> Option<JointPhysics> {
    let PhysicsKeys { armature, damping, friction, friction_velocity, stiffness, rest } = &link.physics;
    if link.joint.value() == Some(&JointKind::Fixed) {
        for (key, field) in link.physics.fields() {
            if let Some(given) = field.spanned() {
                findings.error(given.span(), messages::physics_of_fixed(&link.item, key.name));
            }
        }
    }
    if let Some(joint) = of_several_freedoms(link) {
        for (key, field) in link.physics.fields() {
            if let Some(given) = field.spanned() {
                findings.error(given.span(), messages::needs_one_coordinate(&link.item, key.name, joint));
            }
        }
    }
    let not_negative = [
        (&keys::ARMATURE, armature),
        (&keys::DAMPING, damping),
        (&keys::FRICTION, friction),
        (&keys::STIFFNESS, stiffness),
    ];
    for (key, field) in not_negative {
        if let Some(given) = field.spanned().filter(|given| *given.get_ref() < 0.0) {
            findings.error(given.span(), messages::negative_physics(&link.item, key.name, *given.get_ref()));
        }
    }
    if let Some(given) = friction_velocity.spanned().filter(|given| *given.get_ref() <= 0.0) {
        findings.error(given.span(), messages::friction_velocity_not_positive(&link.item, *given.get_ref()));
    }
    let mut needs = |field: &Field<f64>, key: &str, other: &Field<f64>, missing: &str| {
        if let Some(given) = field.spanned().filter(|_| other.is_missing()) {
            findings.error(given.span(), messages::physics_without(&link.item, key, missing));
        }
    };
    needs(friction_velocity, keys::FRICTION_VELOCITY.name, friction, keys::FRICTION.name);
    needs(rest, keys::REST.name, stiffness, keys::STIFFNESS.name);
    Some(JointPhysics {
        armature: armature.value_or(0.0)?,
        damping: damping.value_or(0.0)?,
        friction: friction.value_or(0.0)?,
        friction_velocity: friction_velocity.value_or(FRICTION_VELOCITY)?,
        stiffness: stiffness.value_or(0.0)?,
        rest: rest.value_or(0.0)?,
    })
}
