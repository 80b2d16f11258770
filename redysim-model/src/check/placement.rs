//! Where a joint stands and about what it moves, given in one of three ways.

use crate::messages;
use crate::model::JointKind;
use crate::rotation::{about_x, about_z};
use crate::schema::{Dh, DhStandard, LinkTable, keys};
use crate::spatial::{Mat3, Pose, Vec3};
use redysim_toml::{Field, Findings, Key, Spanned};
use std::ops::Range;

/// The z axis: of every Denavit-Hartenberg joint, and of revolute cuts unless the file says otherwise.
const Z: Vec3<f64> = Vec3([0.0, 0.0, 1.0]);

/// Shorter vectors are taken for a zero that roundoff has blurred.
const SHORTEST_AXIS: f64 = 1e-9;

/// Placement, axis, offset and frame of a link (see [`crate::Link`]).
pub(super) struct Placed {
    pub(super) placement: Pose<f64>,
    pub(super) axis: Vec3<f64>,
    pub(super) offset: f64,
    pub(super) frame: Pose<f64>,
}

/// Where the link's joint stands, and the link's frame on it.
pub(super) fn place(link: &LinkTable, findings: &mut Findings) -> Option<Placed> {
    several_freedoms_by_origin(link, findings);
    placed_once(link, findings);
    axis_beside_origin(link, findings);
    beside_origin(link, findings);
    let axis_allowed = axis_allowed(link, findings);
    let axis = unit_axis(&link.item, "axis", &link.axis, axis_allowed, findings);
    let joint = *link.joint.value()?;
    if let Some(pitch) = link.pitch.spanned().filter(|_| joint != JointKind::Helical) {
        findings.error(pitch.span(), messages::pitch_on_another_joint(&link.item, joint.name()));
    }
    if let Some(sequence) = link.coordinates.spanned().filter(|_| !joint.moves_in_space()) {
        findings.error(sequence.span(), messages::coordinates_on_another_joint(&link.item, joint.name()));
    }
    let pitch = link.pitch.value_or(0.0)?;
    if let Some(dh) = link.dh.value() {
        return Some(from_dh(joint, pitch, *dh));
    }
    if let Some(dh) = link.dh_standard.value() {
        return Some(from_dh_standard(joint, pitch, *dh));
    }
    let placement = link.origin.value_or(Pose::identity())?;
    let frame = link.far_end.value_or(Pose::identity())?;
    Some(Placed { placement, axis: axis?, offset: link.offset.value_or(0.0)?, frame })
}

/// The kind of the link's joint, if it has several degrees of freedom.
pub(super) fn of_several_freedoms(link: &LinkTable) -> Option<JointKind> {
    link.joint.value().copied().filter(|joint| joint.dof() > 1)
}

/// Reports keys that a joint with several degrees of freedom does not take: an offset and Denavit-Hartenberg parameters
/// belong to one coordinate, `axis` to a joint with one axis, and `far_end` to a joint whose coordinates are not those of
/// the link's own frame.
fn several_freedoms_by_origin(link: &LinkTable, findings: &mut Findings) {
    let Some(joint) = of_several_freedoms(link) else { return };
    let axis = given(&keys::AXIS, &link.axis).filter(|_| !joint.has_axis());
    let far_end = given(&keys::FAR_END, &link.far_end).filter(|_| joint.moves_in_space());
    let keys = [
        given(&keys::DH, &link.dh),
        given(&keys::DH_STANDARD, &link.dh_standard),
        axis,
        given(&keys::OFFSET, &link.offset),
        far_end,
    ];
    for (key, span) in keys.into_iter().flatten() {
        if let Some(span) = span {
            findings.error(span, messages::needs_one_coordinate(&link.item, key, joint));
        }
    }
}

/// `offset` and `far_end` belong to a joint that moves, placed by `origin` or `axis`: Denavit-Hartenberg parameters have
/// both among their numbers.
fn beside_origin(link: &LinkTable, findings: &mut Findings) {
    let dh = given(&keys::DH, &link.dh).or(given(&keys::DH_STANDARD, &link.dh_standard));
    for (key, span) in [given(&keys::OFFSET, &link.offset), given(&keys::FAR_END, &link.far_end)].into_iter().flatten()
    {
        let Some(span) = span else { continue };
        if link.joint.value() == Some(&JointKind::Fixed) {
            findings.error(span, messages::placement_of_moving(&link.item, key));
        } else if let Some((parameters, _)) = dh {
            findings.error(span, messages::beside_dh(&link.item, key, parameters));
        }
    }
}

/// The name of a key and the place of its value, `None` if that is invalid; nothing without the key.
fn given<T>(key: &Key, field: &Field<T>) -> Option<(&'static str, Option<Range<usize>>)> {
    (!field.is_missing()).then(|| (key.name, field.spanned().map(Spanned::span)))
}

/// By `dh`, by `dh_standard`, or by `origin` and `axis`, of which fixed joints have the first alone, and others may have
/// the second alone.
fn placed_once(link: &LinkTable, findings: &mut Findings) {
    let by_origin = given(&keys::ORIGIN, &link.origin).or(given(&keys::AXIS, &link.axis));
    let ways = [given(&keys::DH, &link.dh), given(&keys::DH_STANDARD, &link.dh_standard), by_origin];
    let mut ways = ways.into_iter().flatten();
    match (ways.next(), ways.next()) {
        (None, _) => findings.error(link.place(), messages::no_placement(&link.item)),
        (Some((first, _)), Some((second, Some(span)))) => {
            findings.error(span, messages::two_placements(&link.item, first, second));
        }
        _ => {}
    }
}

/// A joint that moves has an axis beside its origin: what a missing one means differs from format to format.
fn axis_beside_origin(link: &LinkTable, findings: &mut Findings) {
    let without_dh = link.dh.is_missing() && link.dh_standard.is_missing();
    let moving = link.joint.value().filter(|joint| joint.has_axis() && without_dh);
    if let (Some(joint), Some(origin), true) = (moving, link.origin.spanned(), link.axis.is_missing()) {
        findings.error(origin.span(), messages::origin_without_axis(&link.item, joint.name()));
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
    // A unit vector stays as it is: normalised once more, it might change by a roundoff.
    if (given.dot(given) - 1.0).abs() <= 4.0 * f64::EPSILON {
        return Some(given.map(|x| x + 0.0));
    }
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

/// Rx(alpha) Tx(a) Rz(theta) Tz(b): the link's frame is the one that the joint moves.
fn from_dh(joint: JointKind, pitch: f64, Dh { a, alpha, b, theta }: Dh) -> Placed {
    let (screw, offset) = about_and_along_z(joint, pitch, theta, b);
    let placement = turned(about_x(alpha)) * moved(a, 0.0) * screw;
    Placed { placement: placement.without_negative_zeros(), axis: Z, offset, frame: Pose::identity() }
}

/// Rz(theta) Tz(d) Tx(a) Rx(alpha): the joint moves along or about the z axis of the parent's frame, and the link's
/// frame stands at the far end. That of a fixed link is its placement.
fn from_dh_standard(joint: JointKind, pitch: f64, DhStandard { a, alpha, d, theta }: DhStandard) -> Placed {
    let (screw, offset) = about_and_along_z(joint, pitch, theta, d);
    let far_end = moved(a, 0.0) * turned(about_x(alpha));
    let (placement, frame) = match joint {
        JointKind::Fixed => (screw * far_end, Pose::identity()),
        _ => (screw, far_end),
    };
    let [placement, frame] = [placement, frame].map(Pose::without_negative_zeros);
    Placed { placement, axis: Z, offset, frame }
}

/// Rz(angle) Tz(distance) before the motion of the joint, and the offset of its variable: this is added to the angle
/// (revolute), to the distance (prismatic), or to the angle and `pitch` times to the distance (helical). As Rz and Tz
/// commute, the variable's factor can stand last, where the joint's motion is.
fn about_and_along_z(joint: JointKind, pitch: f64, angle: f64, distance: f64) -> (Pose<f64>, f64) {
    match joint {
        JointKind::Revolute => (moved(0.0, distance), angle),
        // The motion of the offset slides, too.
        JointKind::Helical => (moved(0.0, distance - pitch * angle), angle),
        JointKind::Prismatic => (turned(about_z(angle)), distance),
        _ => (moved(0.0, distance) * turned(about_z(angle)), 0.0),
    }
}

fn turned(rotation: Mat3<f64>) -> Pose<f64> {
    Pose { rotation, position: Vec3::zero() }
}

fn moved(x: f64, z: f64) -> Pose<f64> {
    Pose { rotation: Mat3::identity(), position: Vec3([x, 0.0, z]) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    /// Rx(alpha) Tx(a) Rz(theta) Tz(b), as the field writes it.
    fn khalil_kleinfinger(dh: Dh) -> Pose<f64> {
        turned(about_x(dh.alpha)) * moved(dh.a, 0.0) * turned(about_z(dh.theta)) * moved(0.0, dh.b)
    }

    /// Where the link's frame stands for the joint variable `q`.
    fn at(joint: JointKind, pitch: f64, placed: &Placed, q: f64) -> Pose<f64> {
        let motion = match joint {
            JointKind::Revolute => turned(about_z(placed.offset + q)),
            JointKind::Prismatic => moved(0.0, placed.offset + q),
            JointKind::Helical => turned(about_z(placed.offset + q)) * moved(0.0, pitch * (placed.offset + q)),
            _ => Pose::identity(),
        };
        placed.placement * motion * placed.frame
    }

    fn distance(a: Pose<f64>, b: Pose<f64>) -> f64 {
        let rotation = (a.rotation - b.rotation).0;
        let entries =
            rotation.as_flattened().iter().chain(&(a.position - b.position).0).map(|x| x.abs()).collect::<Vec<_>>();
        entries.into_iter().fold(0.0, f64::max)
    }

    /// Each kind of joint with its pitch, and how much of its variable is rotation and translation.
    const JOINTS: [(JointKind, f64, f64, f64); 4] = [
        (JointKind::Revolute, 0.0, 1.0, 0.0),
        (JointKind::Prismatic, 0.0, 0.0, 1.0),
        (JointKind::Helical, 0.3, 1.0, 0.3),
        (JointKind::Fixed, 0.0, 0.0, 0.0),
    ];

    #[test]
    fn the_variable_of_a_khalil_kleinfinger_joint_adds_to_theta_and_b() {
        let dh = Dh { a: 0.3, alpha: 0.7, b: -0.2, theta: 1.1 };
        for (joint, pitch, turn, slide) in JOINTS {
            let q = 0.4;
            let expected = khalil_kleinfinger(Dh { b: dh.b + slide * q, theta: dh.theta + turn * q, ..dh });
            assert!(distance(at(joint, pitch, &from_dh(joint, pitch, dh), q), expected) < 1e-15, "{joint:?}");
        }
    }

    /// The matrix as textbooks print it (Spong, Hutchinson, Vidyasagar, Robot Modeling and Control, section 3.2).
    #[test]
    fn the_variable_of_a_standard_joint_adds_to_theta_and_d() {
        let dh = DhStandard { a: 0.3, alpha: 0.7, d: -0.2, theta: 1.1 };
        for (joint, pitch, turn, slide) in JOINTS {
            let q = 0.4;
            let (st, ct) = (dh.theta + turn * q).sin_cos();
            let (sa, ca) = dh.alpha.sin_cos();
            let expected = Pose {
                rotation: Mat3([[ct, -st * ca, st * sa], [st, ct * ca, -ct * sa], [0.0, sa, ca]]),
                position: Vec3([dh.a * ct, dh.a * st, dh.d + slide * q]),
            };
            assert!(distance(at(joint, pitch, &from_dh_standard(joint, pitch, dh), q), expected) < 1e-15, "{joint:?}");
        }
    }

    #[test]
    fn quarter_turns_stay_exact() {
        let dh = Dh { a: 0.12, alpha: FRAC_PI_2, b: 0.62, theta: -FRAC_PI_2 };
        let Placed { placement, .. } = from_dh(JointKind::Fixed, 0.0, dh);
        assert_eq!(placement.rotation, Mat3([[0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [-1.0, 0.0, 0.0]]));
        assert_eq!(placement.position, Vec3([0.12, -0.62, 0.0]));
    }

    #[test]
    fn no_coordinate_is_a_negative_zero() {
        for theta in [0.0, 1.0, 2.0, 4.0, 5.0] {
            let dh = Dh { alpha: FRAC_PI_2, theta, ..Dh::default() };
            let Placed { placement, .. } = from_dh(JointKind::Fixed, 0.0, dh);
            let mut numbers = placement.rotation.0.as_flattened().iter().chain(&placement.position.0);
            assert!(numbers.all(|x| *x != 0.0 || x.is_sign_positive()), "{placement:?}");
        }
    }
}
