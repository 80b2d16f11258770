//! Where a joint stands and about what it moves, given in one of two ways.

use crate::messages;
use crate::model::JointKind;
use crate::rotation::{about_x, about_z, roll_pitch_yaw};
use crate::schema::{Dh, LinkTable, Origin};
use crate::spatial::{Mat3, Pose, Vec3};
use redysim_toml::{Field, Findings, Spanned};

/// The z axis: of every Denavit-Hartenberg joint, and of others unless the file says otherwise.
const Z: Vec3<f64> = Vec3([0.0, 0.0, 1.0]);

/// Shorter vectors are taken for a zero that roundoff has blurred.
const SHORTEST_AXIS: f64 = 1e-9;

/// Placement, axis and offset of the link's joint (see [`crate::Link`]).
pub(super) fn place(link: &LinkTable, findings: &mut Findings) -> Option<(Pose<f64>, Vec3<f64>, f64)> {
    placed_once(link, findings);
    let axis_allowed = axis_allowed(link, findings);
    let axis = unit_axis(&link.item, "axis", &link.axis, axis_allowed, findings);
    let joint = *link.joint.value()?;
    if let Some(pitch) = link.pitch.spanned().filter(|_| joint != JointKind::Helical) {
        findings.error(pitch.span(), messages::pitch_on_another_joint(&link.item, joint.name()));
    }
    let pitch = link.pitch.value_or(0.0)?;
    if let Some(dh) = link.dh.value() {
        let (placement, offset) = from_dh(joint, pitch, *dh);
        return Some((placement, Z, offset));
    }
    let Origin { xyz, rpy } = link.origin.value_or(Origin::default())?;
    let placement = Pose { rotation: roll_pitch_yaw(rpy), position: Vec3(xyz) };
    Some((placement.without_negative_zeros(), axis?, 0.0))
}

/// Either `dh`, or `origin` and `axis` or one of them.
fn placed_once(link: &LinkTable, findings: &mut Findings) {
    let origin = link.origin.spanned().map(|origin| ("origin", origin.span()));
    let axis = link.axis.spanned().map(|axis| ("axis", axis.span()));
    let nothing_given = link.origin.is_missing() && link.axis.is_missing();
    match (!link.dh.is_missing(), origin.or(axis)) {
        (true, Some((key, span))) => findings.error(span, messages::two_placements(&link.item, key)),
        (false, None) if nothing_given => findings.error(link.place(), messages::no_placement(&link.item)),
        _ => {}
    }
}

fn axis_allowed(link: &LinkTable, findings: &mut Findings) -> bool {
    let fixed = link.joint.value() == Some(&JointKind::Fixed);
    if let Some(axis) = link.axis.spanned().filter(|_| fixed) {
        findings.error(axis.span(), messages::axis_on_fixed(&link.item));
    }
    !fixed
}

/// The unit vector along the axis that the file gives, or z. An axis that is not `wanted` is not looked at.
pub(super) fn unit_axis(
    item: &str,
    key: &str,
    axis: &Field<[f64; 3]>,
    wanted: bool,
    findings: &mut Findings,
) -> Option<Vec3<f64>> {
    let (given, span) = match axis {
        Field::Value(axis) if wanted => (Vec3(*axis.get_ref()), Spanned::span(axis)),
        Field::Invalid => return None,
        _ => return Some(Z),
    };
    // Scaled first, so that the squares neither overflow nor vanish.
    let scale = given.0.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let scaled = Vec3::from_fn(|i| given[i] / scale);
    let length = scaled.dot(scaled).sqrt();
    if scale * length < SHORTEST_AXIS || scale == 0.0 {
        let length = if scale == 0.0 { 0.0 } else { scale * length };
        findings.error(span, messages::zero_axis(item, key, length));
        return None;
    }
    Some(Vec3::from_fn(|i| scaled[i] / length + 0.0))
}

/// Rx(alpha) Tx(a) Rz(theta) Tz(b), with the joint variable added to theta (revolute), to b (prismatic), or to theta
/// and `pitch` times to b (helical). As Rz and Tz commute, the variable's factor can stand last, where the joint's
/// motion is.
fn from_dh(joint: JointKind, pitch: f64, dh: Dh) -> (Pose<f64>, f64) {
    let turned = |rotation| Pose { rotation, position: Vec3::zero() };
    let moved = |x, z| Pose { rotation: Mat3::identity(), position: Vec3([x, 0.0, z]) };
    let before = turned(about_x(dh.alpha));
    let (placement, offset) = match joint {
        JointKind::Revolute => (before * moved(dh.a, dh.b), dh.theta),
        // The motion of the offset slides, too.
        JointKind::Helical => (before * moved(dh.a, dh.b - pitch * dh.theta), dh.theta),
        JointKind::Prismatic => (before * moved(dh.a, 0.0) * turned(about_z(dh.theta)), dh.b),
        JointKind::Fixed => (before * moved(dh.a, dh.b) * turned(about_z(dh.theta)), 0.0),
    };
    (placement.without_negative_zeros(), offset)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    /// Rx(alpha) Tx(a) Rz(theta) Tz(b), as the field writes it.
    fn khalil_kleinfinger(dh: Dh) -> Pose<f64> {
        let turned = |rotation| Pose { rotation, position: Vec3::zero() };
        let moved = |position| Pose { rotation: Mat3::identity(), position: Vec3(position) };
        turned(about_x(dh.alpha)) * moved([dh.a, 0.0, 0.0]) * turned(about_z(dh.theta)) * moved([0.0, 0.0, dh.b])
    }

    fn distance(a: Pose<f64>, b: Pose<f64>) -> f64 {
        let rotation = (a.rotation - b.rotation).0;
        let entries =
            rotation.as_flattened().iter().chain(&(a.position - b.position).0).map(|x| x.abs()).collect::<Vec<_>>();
        entries.into_iter().fold(0.0, f64::max)
    }

    #[test]
    fn the_joint_motion_stands_last() {
        let dh = Dh { a: 0.3, alpha: 0.7, b: -0.2, theta: 1.1 };
        let expected = khalil_kleinfinger(dh);
        let (placement, offset) = from_dh(JointKind::Revolute, 0.0, dh);
        let motion = Pose { rotation: about_z(offset), position: Vec3::zero() };
        assert!(distance(placement * motion, expected) < 1e-15);
        let (placement, offset) = from_dh(JointKind::Prismatic, 0.0, dh);
        let motion = Pose { rotation: Mat3::identity(), position: Vec3([0.0, 0.0, offset]) };
        assert!(distance(placement * motion, expected) < 1e-15);
        let (placement, offset) = from_dh(JointKind::Fixed, 0.0, dh);
        assert!(distance(placement, expected) < 1e-15 && offset == 0.0);
    }

    #[test]
    fn quarter_turns_stay_exact() {
        let dh = Dh { a: 0.12, alpha: FRAC_PI_2, b: 0.62, theta: -FRAC_PI_2 };
        let (placement, _) = from_dh(JointKind::Fixed, 0.0, dh);
        assert_eq!(placement.rotation, Mat3([[0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0]]));
        assert_eq!(placement.position, Vec3([0.12, -0.62, 0.0]));
    }

    #[test]
    fn no_coordinate_is_a_negative_zero() {
        for theta in [0.0, 1.0, 2.0, 4.0, 5.0] {
            let dh = Dh { alpha: FRAC_PI_2, theta, ..Dh::default() };
            let (placement, _) = from_dh(JointKind::Fixed, 0.0, dh);
            let mut numbers = placement.rotation.0.as_flattened().iter().chain(&placement.position.0);
            assert!(numbers.all(|x| *x != 0.0 || x.is_sign_positive()), "{placement:?}");
        }
    }
}
