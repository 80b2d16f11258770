//! What can be wrong with a torque law beside its trajectory.

use redysim_toml::{Message, Reader};

use crate::layout::{Joint, Layout};

pub(super) fn unfollowed<T>(reader: &mut Reader<'_, '_>) -> Option<T> {
    reader.error_of_table(Message {
        title: format!("{}: the torque law follows a trajectory, but the scenario does not define one", reader.item()),
        label: "needs a trajectory".into(),
        help: "add a table `[trajectory]`".into(),
    })
}

pub(super) fn nothing_actuated<T>(reader: &mut Reader<'_, '_>) -> Option<T> {
    reader.error_of_table(Message {
        title: format!("{}: no joint that the trajectory prescribes has an actuator", reader.item()),
        label: "drives nothing".into(),
        help: "prescribe actuated joints, or name those that the law drives under `joints`".into(),
    })
}

pub(super) fn not_prescribed<T>(reader: &mut Reader<'_, '_>, joint: &Joint) -> Option<T> {
    reader.error_of_table(Message {
        title: format!(
            "{}: the trajectory does not prescribe the joint `{}` that the torque law drives",
            reader.item(),
            joint.name
        ),
        label: "drives a joint without a prescribed motion".into(),
        help: "name it among the `joints` of `[trajectory]`, or drive fewer".into(),
    })
}

/// Reports a joint that follows the trajectory and is driven as well, as `also` states. Always `None`.
pub(super) fn prescribed<T>(reader: &mut Reader<'_, '_>, also: &str, joint: &Joint) -> Option<T> {
    reader.error_of_table(Message {
        title: format!(
            "{}: the joint `{}` is prescribed, and {also}: its force follows from its motion",
            reader.item(),
            joint.name
        ),
        label: "drives a joint that is prescribed".into(),
        help: "leave the joint out here, or out of `forward.prescribed`".into(),
    })
}

/// Of a tree with joints that have no actuator, computed torque moves the others, all of them.
pub(super) fn underactuated<T>(reader: &mut Reader<'_, '_>, layout: &Layout, joint: &Joint) -> Option<T> {
    let (item, Joint { name, actuated, .. }) = (reader.item(), joint);
    let (title, help) = if *actuated {
        let title = format!(
            "{item}: the trajectory does not prescribe the joint `{name}`, and computed torque moves every joint with \
             an actuator"
        );
        (title, "name all joints with an actuator among the `joints` of `[trajectory]`")
    } else {
        let title = format!(
            "{item}: computed torque moves what the trajectory prescribes, but the joint `{name}` {}",
            layout.lacking_actuators(joint)
        );
        let help = "name those with an actuator as the `joints` of `[trajectory]`, and the others follow from the \
                    dynamics; or take the law `tracking-pd`";
        (title, help)
    };
    reader.error_of_table(Message { title, label: "not with this trajectory".into(), help: help.into() })
}
