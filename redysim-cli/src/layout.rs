//! Which coordinates and velocities each joint has, and what they are called: tables, messages and pictures take sizes
//! and names from here.

use std::ops::Range;

use redysim_model::Model;
use redysim_model::joint::LinkJoint;
pub use redysim_model::joint::Measure;

/// The joints that move, with their coordinates and velocities, all in the model's order.
#[derive(Clone, Debug, Default)]
pub struct Layout {
    /// The joints.
    pub joints: Vec<Joint>,
    /// The coordinates.
    pub coordinates: Vec<Component>,
    /// The velocities; accelerations and forces have the same names.
    pub velocities: Vec<Component>,
}

/// A joint that moves.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// Whether each of its velocities has an actuator.
    pub actuated: bool,
    /// How it moves.
    pub motion: LinkJoint,
    /// Its coordinates.
    pub q: Range<usize>,
    /// Its velocities.
    pub v: Range<usize>,
}

/// One coordinate or velocity.
#[derive(Clone, Debug)]
pub struct Component {
    /// Its name: that of the joint, if the joint has no other component.
    pub name: String,
    /// The number of its joint.
    pub joint: usize,
    /// What it measures.
    pub measure: Measure,
    /// Of a velocity, whether it has an actuator; false of a coordinate.
    pub actuated: bool,
    /// Its value at the joint's neutral position; of a velocity, zero.
    pub neutral: f64,
}

impl Component {
    /// Whether it is an angle.
    pub fn turns(&self) -> bool {
        self.measure == Measure::Angle
    }

    /// Its unit as a coordinate.
    pub fn unit(&self) -> &'static str {
        self.measure.unit()
    }

    /// The unit of a force that works along it.
    pub fn unit_of_force(&self) -> &'static str {
        self.measure.unit_of_force()
    }
}

impl Joint {
    /// Whether it moves in space: its coordinates are an orientation, and maybe a position before it.
    pub fn is_in_space(&self) -> bool {
        !self.motion.is_linear()
    }

    /// Which of its coordinates are its orientation, a quaternion x, y, z, w; none of a joint of one coordinate.
    pub fn orientation(&self) -> Range<usize> {
        let Range { start, end } = self.motion.quaternion();
        self.q.start + start..self.q.start + end
    }
}

impl Layout {
    /// The layout of a model.
    pub fn of(model: &Model) -> Self {
        let mut layout = Layout::default();
        for link in model.moving_links() {
            if let Some(motion) = LinkJoint::of(link) {
                layout.push(&link.joint_name, &link.actuated_velocities(), motion);
            }
        }
        layout
    }

    /// Adds a joint with its coordinates and velocities. A single one has the name of the joint.
    fn push(&mut self, name: &str, actuated: &[bool], motion: LinkJoint) {
        let joint = self.joints.len();
        let add = |components: &mut Vec<Component>, names: &[&str], measures: &[Measure], neutral: &[f64]| {
            let first = components.len();
            components.extend(names.iter().zip(measures).zip(neutral).map(|((part, &measure), &neutral)| {
                let name = if names.len() == 1 { name.to_owned() } else { format!("{name}.{part}") };
                Component { name, joint, measure, actuated: false, neutral }
            }));
            first..components.len()
        };
        let (of_q, of_v) = (&motion.coordinate_measures(), &motion.velocity_measures());
        let mut neutral = vec![0.0; motion.nq()];
        motion.neutral(&mut neutral);
        let q = add(&mut self.coordinates, motion.coordinate_names(), of_q, &neutral);
        let v = add(&mut self.velocities, motion.velocity_names(), of_v, &vec![0.0; motion.nv()]);
        for (velocity, &actuated) in self.velocities[v.clone()].iter_mut().zip(actuated) {
            velocity.actuated = actuated;
        }
        let actuated = actuated.iter().all(|actuated| *actuated);
        self.joints.push(Joint { name: name.to_owned(), actuated, motion, q, v });
    }

    /// How many coordinates there are.
    pub fn nq(&self) -> usize {
        self.coordinates.len()
    }

    /// How many velocities there are.
    pub fn nv(&self) -> usize {
        self.velocities.len()
    }

    /// The coordinates of some of the joints.
    pub fn coordinates_of(&self, joints: &[usize]) -> Vec<usize> {
        joints.iter().flat_map(|&joint| self.joints[joint].q.clone()).collect()
    }

    /// The velocities of some of the joints.
    pub fn velocities_of(&self, joints: &[usize]) -> Vec<usize> {
        joints.iter().flat_map(|&joint| self.joints[joint].v.clone()).collect()
    }

    /// What messages report of a joint that does not have an actuator for each of its velocities.
    pub fn lacking_actuators(&self, joint: &Joint) -> &'static str {
        match self.velocities[joint.v.clone()].iter().any(|velocity| velocity.actuated) {
            true => "has actuators for some of its velocities only",
            false => "has no actuator",
        }
    }

    /// The velocities that have an actuator.
    pub fn actuated_velocities(&self) -> Vec<usize> {
        (0..self.nv()).filter(|&velocity| self.velocities[velocity].actuated).collect()
    }

    /// The joint whose velocity is this component of the state [q, v, work of the actuators], if it is one.
    pub fn joint_of_velocity_in_state(&self, component: usize) -> Option<&Joint> {
        let velocity = self.velocities.get(component.checked_sub(self.nq())?)?;
        self.joints.get(velocity.joint)
    }

    /// What messages call a component of the state [q, v, work of the actuators, integral actions] of a forward run.
    pub fn name_in_state(&self, component: usize) -> String {
        let (what, of) = match component.checked_sub(self.nq()) {
            None => ("coordinate", &self.coordinates[component]),
            Some(velocity) if velocity < self.nv() => ("velocity", &self.velocities[velocity]),
            Some(state) if (self.nv() + 1..=2 * self.nv()).contains(&state) => {
                ("integral action", &self.velocities[state - self.nv() - 1])
            }
            Some(_) => return "the work of the actuators".to_owned(),
        };
        let joint = &self.joints[of.joint].name;
        match &of.name == joint {
            true => format!("the {what} of the joint `{joint}`"),
            false => format!("the {what} `{}` of the joint `{joint}`", of.name),
        }
    }
}

#[cfg(test)]
pub mod tests {
    use redysim_model::joint;

    use super::*;

    /// A free joint `base` with seven coordinates and six velocities, then a revolute joint `arm`.
    pub fn free_base_with_arm() -> Layout {
        let mut layout = Layout::default();
        layout.push("base", &[false; 6], joint::Joint::Free.into());
        layout.push("arm", &[true], joint::Joint::Revolute.into());
        layout
    }

    #[test]
    fn joints_find_their_coordinates_and_velocities_behind_a_free_joint() {
        let layout = free_base_with_arm();
        assert_eq!((layout.nq(), layout.nv()), (8, 7));
        assert_eq!((layout.coordinates_of(&[1]), layout.velocities_of(&[1])), (vec![7], vec![6]));
        assert_eq!(layout.coordinates_of(&[0]), [0, 1, 2, 3, 4, 5, 6]);
        assert_eq!(layout.velocities_of(&[1, 0]), [6, 0, 1, 2, 3, 4, 5]);
    }

    #[test]
    fn growing_errors_are_those_of_the_joint_whose_velocity_grows_behind_a_free_joint() {
        let layout = free_base_with_arm();
        let joint = |component| layout.joint_of_velocity_in_state(component).map(|joint| joint.name.as_str());
        assert_eq!([7, 8, 13, 14, 15].map(joint), [None, Some("base"), Some("base"), Some("arm"), None]);
    }

    #[test]
    fn a_component_of_the_state_is_called_by_its_joint_behind_a_free_joint() {
        let layout = free_base_with_arm();
        for (component, name) in [
            (0, "the coordinate `base.x` of the joint `base`"),
            (6, "the coordinate `base.qw` of the joint `base`"),
            (7, "the coordinate of the joint `arm`"),
            (8, "the velocity `base.vx` of the joint `base`"),
            (14, "the velocity of the joint `arm`"),
            (15, "the work of the actuators"),
            (16, "the integral action `base.vx` of the joint `base`"),
            (22, "the integral action of the joint `arm`"),
        ] {
            assert_eq!(layout.name_in_state(component), name, "component {component}");
        }
    }
}
