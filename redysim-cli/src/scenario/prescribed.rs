//! Joints that follow the trajectory, whatever forces it takes, while the others move.

use std::cmp::Ordering;

use redysim_model::{GenericMechanism, Mobility, PerVelocity};
use redysim_runtime::ClosedLoop;
use redysim_toml::{Message, Reader, Spanned};

use super::chosen::chosen;
use super::initial::Initial;
use super::keys;
use super::subject::{Subject, neutral};
use super::trajectory::{Prescribed, freedoms};
use crate::closed::{closed_position, independent_velocities};

/// Some joints that follow the trajectory, while the others are free or driven.
pub struct PrescribedJoints {
    /// The velocities along which they do.
    pub velocities: Vec<usize>,
    /// The motion that they follow, and perhaps others by a torque law.
    pub trajectory: Prescribed,
    /// The mechanism as if these velocities alone had an actuator: hybrid dynamics takes the accelerations of such velocities,
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
        let field = chosen(reader, &keys::FOLLOWING, subject.layout);
        if field.is_missing() {
            return Some(None);
        }
        let named = field.spanned()?;
        let (velocities, trajectory) = (named.get_ref(), trajectory?);
        if let Some((fault, help)) = fault(subject, velocities, trajectory) {
            let message =
                Message { title: format!("{}: {fault}", reader.item()), label: "prescribed here".into(), help };
            return reader.error_at(named.span(), message);
        }
        warn_of_passive(reader, subject, named);
        let mut model = subject.model.clone();
        let moving = model.links.iter_mut().filter(|link| link.dof() > 0);
        for (link, joint) in moving.zip(&subject.layout.joints) {
            link.actuated = PerVelocity::Each(joint.v.clone().map(|velocity| velocities.contains(&velocity)).collect());
        }
        let (velocities, mechanism) = (velocities.clone(), GenericMechanism::new(model));
        Some(Some(PrescribedJoints { velocities, trajectory: trajectory?.clone(), mechanism }))
    }

    /// Puts the motion at `t` in the place of what `initial` has for the joints, which then stay there while loops are
    /// closed: fails where this does not close them.
    pub fn start(
        &self,
        reader: &mut Reader<'_, '_>,
        subject: &Subject<'_>,
        t: f64,
        initial: &mut Initial,
    ) -> Option<()> {
        let layout = subject.layout;
        let motion = redysim_runtime::Trajectory::at(&self.trajectory.spread(layout), t);
        layout.coordinates_along(&self.velocities).into_iter().for_each(|index| initial.q[index] = motion.q[index]);
        self.velocities.iter().for_each(|&index| initial.v[index] = motion.v[index]);
        initial.hold(&self.velocities);
        if !(subject.loops() && initial.assemble) {
            return Some(());
        }
        let loops = ClosedLoop::new(&self.mechanism);
        let Err(error) = loops.assemble(&initial.q, &initial.v, &initial.held) else {
            return Some(());
        };
        let reason = loops.with_names(error);
        let names = layout.names(&self.velocities).join(", ");
        let title = format!("{}: where the prescribed joints ({names}) are at t = {t:?} s, {reason}", reader.item());
        let help = "begin the trajectory where the links reach, give `initial.q` nearer, or name fewer joints in \
                    `prescribed` or `initial.held`";
        reader.error_at(self.trajectory.place.clone(), Message::new(title, "begins here", help))
    }
}

/// What is wrong with prescribing `velocities`, and what to do about it.
fn fault(subject: &Subject<'_>, velocities: &[usize], trajectory: Option<&Prescribed>) -> Option<(String, String)> {
    let layout = subject.layout;
    let Some(trajectory) = trajectory else {
        let fault = "`prescribed` names joints that follow a trajectory, but the scenario does not define one";
        return Some((fault.into(), "add a table `[trajectory]`".into()));
    };
    if let Some(part) = layout.part_of_quaternion(velocities) {
        let (name, joint) = (&layout.velocities[part].name, &layout.joint_of(part).name);
        let fault = format!(
            "`prescribed` names `{name}`, but the orientation of the joint `{joint}` is a quaternion, which moves as a whole"
        );
        return Some((fault, format!("name the joint `{joint}`, or leave it out")));
    }
    let unmoved: Vec<usize> =
        velocities.iter().copied().filter(|velocity| !trajectory.velocities.contains(velocity)).collect();
    if let Some(first) = layout.first_of(&unmoved) {
        let fault = format!("`prescribed` names {first}, for which the trajectory has no motion");
        return Some((fault, "name it among the `joints` of `[trajectory]`, or leave it out here".into()));
    }
    if velocities.len() == layout.nv() {
        let help = "name fewer joints; `redysim inverse` computes the forces of a motion of all joints";
        return Some(("every joint is prescribed, so that no motion is left to compute".into(), help.into()));
    }
    if subject.loops() { fault_of_loops(subject, velocities) } else { None }
}

/// What is wrong with prescribing `velocities` of closed loops: these must leave them free of each other, and leave more.
fn fault_of_loops(subject: &Subject<'_>, velocities: &[usize]) -> Option<(String, String)> {
    let Mobility { mobility: free, position_residual, .. } = *subject.mobility();
    if position_residual.is_some() {
        // What loops leave free that were not closed from anywhere is seen when the start closes them.
        return None;
    }
    let names = subject.layout.names(velocities).join(", ");
    let what = format!("`prescribed` names {} ({names})", freedoms(velocities.len()));
    match velocities.len().cmp(&free) {
        Ordering::Greater => {
            let help = match free {
                0 => "as the model is, nothing moves: `redysim check` reports which constraints do not follow from others"
                    .into(),
                1 => "leave the key out: one joint determines how all others move; `redysim inverse` computes the forces of that"
                    .into(),
                _ => format!("name joints of fewer than {}: the others follow from the loops", freedoms(free)),
            };
            return Some((format!("{what}, but the loops leave {free} free"), help));
        }
        Ordering::Equal => {
            let help =
                "name fewer joints; `redysim inverse` computes the forces of a motion that determines all joints";
            return Some((
                format!("{what}, as many as the loops leave free, so that no motion is left to compute"),
                help.into(),
            ));
        }
        Ordering::Less => {}
    }
    let mechanism = GenericMechanism::new(subject.model.clone());
    let position = closed_position(&mechanism, neutral(&subject.layout.coordinates)).ok()?;
    let preferred: Vec<bool> = (0..subject.layout.nv()).map(|velocity| velocities.contains(&velocity)).collect();
    let independent = independent_velocities(&mechanism, &position, &preferred);
    let determined = velocities.iter().find(|velocity| !independent.contains(velocity))?;
    let name = &subject.layout.velocities[*determined].name;
    let fault =
        format!("the loops determine how `{name}` moves by the other joints of `prescribed`, or do not let it move");
    Some((fault, format!("leave `{name}` out: it follows from the loops")))
}

/// Warns of joints that cannot follow a motion, since they have no actuator.
fn warn_of_passive(reader: &mut Reader<'_, '_>, subject: &Subject<'_>, named: &Spanned<Vec<usize>>) {
    if let Some((name, lacking)) = subject.layout.lacking_actuators(named.get_ref()) {
        let message = Message {
            title: format!("{}: {name} is prescribed, but {lacking}", reader.item()),
            label: "one of these".into(),
            help: "this is valid if something outside the model moves the joint; otherwise leave it out, or give it an actuator".into(),
        };
        reader.warning_at(named.span(), message);
    }
}
