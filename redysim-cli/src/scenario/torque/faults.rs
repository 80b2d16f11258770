//! What can be wrong with a torque law beside its trajectory.

use redysim_toml::words::shortened;
use redysim_toml::{Message, Reader};

use crate::layout::Layout;

pub(super) fn unfollowed<T>(reader: &mut Reader<'_, '_>) -> Option<T> {
    reader.error_of_table(Message {
        title: format!("{}: the torque law follows a trajectory, but the scenario does not define one", reader.item()),
        label: "needs a trajectory".into(),
        help: "add a table `[trajectory]`".into(),
    })
}

/// Reports a law that by default drives nothing, since `of_none` has an actuator. Always `None`.
pub(super) fn nothing_actuated<T>(reader: &mut Reader<'_, '_>, of_none: &str) -> Option<T> {
    reader.error_of_table(Message {
        title: format!("{}: {of_none} has an actuator, so that the torque law drives nothing", reader.item()),
        label: "drives nothing".into(),
        help: "name those that the law drives under `joints`, or give a joint an actuator in the model".into(),
    })
}

/// Reports that the trajectory lacks the first of the velocities `missing`, which the law drives. Always `None`.
pub(super) fn not_prescribed<T>(reader: &mut Reader<'_, '_>, layout: &Layout, missing: &[usize]) -> Option<T> {
    let first = layout.first_of(missing)?;
    reader.error_of_table(Message {
        title: format!("{}: the trajectory does not prescribe {first} that the torque law drives", reader.item()),
        label: "drives a joint without a prescribed motion".into(),
        help: "name it among the `joints` of `[trajectory]`, or drive fewer".into(),
    })
}

/// Reports the first of some velocities that follow the trajectory and are driven as well, as `also` states. Always `None`.
pub(super) fn prescribed<T>(
    reader: &mut Reader<'_, '_>,
    also: &str,
    layout: &Layout,
    velocities: &[usize],
) -> Option<T> {
    let first = layout.first_of(velocities)?;
    reader.error_of_table(Message {
        title: format!("{}: {first} is prescribed, and {also}: its force follows from its motion", reader.item()),
        label: "drives a joint that is prescribed".into(),
        help: "leave the joint out here, or out of `forward.prescribed`".into(),
    })
}

/// Reports that computed torque cannot move what a trajectory prescribes of a tree in which some velocities have no
/// actuator: it is one of exactly those with an actuator. `idle` are those with an actuator that it lacks. Always `None`.
pub(super) fn underactuated<T>(
    reader: &mut Reader<'_, '_>,
    layout: &Layout,
    (prescribed, idle): (&[usize], &[usize]),
) -> Option<T> {
    let item = reader.item();
    let (title, help) = match (layout.lacking_actuators(prescribed), layout.first_of(idle)) {
        (Some((name, lacking)), _) => {
            let title = format!("{item}: computed torque moves what the trajectory prescribes, but {name} {lacking}");
            let actuated = layout.actuated_velocities();
            let named = match &layout.names(&actuated)[..] {
                [] => String::new(),
                names => format!(" ({})", shortened(names)),
            };
            let help = format!(
                "name those with an actuator as the `joints` of `[trajectory]`{named}, and the others follow from the dynamics; or \
                 take the law `tracking-pd`"
            );
            (title, help)
        }
        (None, first) => {
            let title = format!(
                "{item}: the trajectory does not prescribe {}, and computed torque moves every joint with an actuator",
                first?
            );
            (title, "name all joints with an actuator among the `joints` of `[trajectory]`".to_owned())
        }
    };
    reader.error_of_table(Message { title, label: "not with this trajectory".into(), help })
}
