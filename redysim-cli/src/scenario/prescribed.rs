//! Joints that follow the trajectory, whatever forces it takes, while the others move.

use redysim_model::GenericMechanism;
use redysim_toml::{Message, Reader, Spanned};

use super::joints::some;
use super::keys;
use super::subject::Subject;
use super::trajectory::Prescribed;
use crate::layout::Layout;

/// Some joints that follow the trajectory, while the others are free or driven.
pub struct PrescribedJoints {
    /// Which they are.
    pub joints: Vec<usize>,
    /// The motion that they follow, and perhaps others by a torque law.
    pub trajectory: Prescribed,
    /// The mechanism as if these joints alone had an actuator: hybrid dynamics takes the accelerations of such joints,
    /// and the forces of the others.
    pub mechanism: GenericMechanism,
}

impl PrescribedJoints {
    /// Reads the key `prescribed` of a motion in which joints may follow `trajectory`; `Some(None)` without it.
    /// `trajectory` is `None` if it is invalid, which has been reported.
    pub fn read(
        reader: &mut Reader<'_, '_>,
        subject: &Subject<'_>,
        trajectory: Option<Option<&Prescribed>>,
    ) -> Option<Option<PrescribedJoints>> {
        let field = some(reader, &keys::FOLLOWING, subject.joints());
        if field.is_missing() {
            return Some(None);
        }
        let named = field.spanned()?;
        let (joints, trajectory) = (named.get_ref(), trajectory?);
        if let Some((fault, help)) = fault(subject, joints, trajectory) {
            let message =
                Message { title: format!("{}: {fault}", reader.item()), label: "prescribed here".into(), help };
            return reader.error_at(named.span(), message);
        }
        warn_of_passive(reader, subject, named);
        let mut model = subject.model.clone();
        let moving = model.links.iter_mut().filter(|link| link.dof() > 0);
        moving.enumerate().for_each(|(joint, link)| link.actuated = joints.contains(&joint).into());
        let (joints, mechanism) = (joints.clone(), GenericMechanism::new(model));
        Some(Some(PrescribedJoints { joints, trajectory: trajectory?.clone(), mechanism }))
    }

    /// Puts the motion at `t` in the place of what `q` and `v` have for the joints.
    pub fn start(&self, layout: &Layout, t: f64, q: &mut [f64], v: &mut [f64]) {
        let motion = redysim_runtime::Trajectory::at(&self.trajectory.spread(layout), t);
        layout.coordinates_of(&self.joints).into_iter().for_each(|index| q[index] = motion.q[index]);
        layout.velocities_of(&self.joints).into_iter().for_each(|index| v[index] = motion.v[index]);
    }
}

/// What is wrong with prescribing `joints`, and what to do about it.
fn fault(subject: &Subject<'_>, joints: &[usize], trajectory: Option<&Prescribed>) -> Option<(String, String)> {
    let all = subject.joints();
    if subject.loops() {
        let help = "`redysim inverse` prescribes joints of closed loops; here, take the law `computed-torque`";
        return Some(("`prescribed` requires a tree, but the model has closed loops".into(), help.into()));
    }
    let Some(trajectory) = trajectory else {
        let fault = "`prescribed` names joints that follow a trajectory, but the scenario does not define one";
        return Some((fault.into(), "add a table `[trajectory]`".into()));
    };
    if let Some(&joint) = joints.iter().find(|joint| !trajectory.joints.contains(joint)) {
        let fault =
            format!("`prescribed` names the joint `{}`, for which the trajectory has no motion", all[joint].name);
        return Some((fault, "name it among the `joints` of `[trajectory]`, or leave it out here".into()));
    }
    if joints.len() == all.len() {
        let help = "name fewer joints; `redysim inverse` computes the forces of a motion of all joints";
        return Some(("every joint is prescribed, so that no motion is left to compute".into(), help.into()));
    }
    joints.is_empty().then(|| {
        let help = "name joints of the trajectory, or leave the key out: then all joints move under the torque law";
        ("`prescribed` names no joint".into(), help.into())
    })
}

/// Warns of joints that cannot follow a motion, since they have no actuator.
fn warn_of_passive(reader: &mut Reader<'_, '_>, subject: &Subject<'_>, named: &Spanned<Vec<usize>>) {
    let all = subject.joints();
    if let Some(&joint) = named.get_ref().iter().find(|joint| !all[**joint].actuated) {
        let (name, lacking) = (&all[joint].name, subject.layout.lacking_actuators(&all[joint]));
        let message = Message {
            title: format!("{}: the joint `{name}` is prescribed, but {lacking}", reader.item()),
            label: "one of these".into(),
            help: "this is valid if something outside the model moves the joint; otherwise leave it out, or give it an actuator".into(),
        };
        reader.warning_at(named.span(), message);
    }
}
