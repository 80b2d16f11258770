//! Which coordinates and velocities each joint has, and what they are called: tables, messages and pictures take sizes
//! and names from here.

use std::ops::Range;

use redysim_model::Model;
pub use redysim_model::joint::Measure;
use redysim_model::joint::{EulerSequence, LinkJoint, Series};

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

    /// The sequence of Euler angles that are its last three coordinates, if its orientation is given by some.
    pub fn euler_sequence(&self) -> Option<EulerSequence> {
        match self.motion {
            LinkJoint::Series(Series::Spherical(sequence) | Series::Free(sequence)) => Some(sequence),
            _ => None,
        }
    }

    /// Whether its coordinates are an orientation in space, and maybe a position before it: a quaternion, or Euler angles.
    pub fn has_orientation(&self) -> bool {
        self.is_in_space() || self.euler_sequence().is_some()
    }

    /// Which of its coordinates are its orientation, a quaternion x, y, z, w; none of a joint of one coordinate.
    pub fn orientation(&self) -> Range<usize> {
        let Range { start, end } = self.motion.quaternion();
        self.q.start + start..self.q.start + end
    }
}

/// The coordinates of joints, or their velocities.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum StatePart {
    Coordinates,
    Velocities,
}

impl StatePart {
    /// All of them.
    pub fn components(self, layout: &Layout) -> &[Component] {
        match self {
            StatePart::Coordinates => &layout.coordinates,
            StatePart::Velocities => &layout.velocities,
        }
    }

    /// Those of a joint.
    pub fn of_joint(self, joint: &Joint) -> Range<usize> {
        match self {
            StatePart::Coordinates => joint.q.clone(),
            StatePart::Velocities => joint.v.clone(),
        }
    }

    /// The other part.
    pub fn other(self) -> StatePart {
        match self {
            StatePart::Coordinates => StatePart::Velocities,
            StatePart::Velocities => StatePart::Coordinates,
        }
    }

    /// Those with the name, or whose joint has it.
    pub fn named(self, layout: &Layout, name: &str) -> Option<Range<usize>> {
        if let Some(joint) = layout.joints.iter().find(|joint| joint.name == name) {
            return Some(self.of_joint(joint));
        }
        let index = self.components(layout).iter().position(|component| component.name == name)?;
        Some(index..index + 1)
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
        self.joints.push(Joint { name: name.to_owned(), motion, q, v });
    }

    /// How many coordinates there are.
    pub fn nq(&self) -> usize {
        self.coordinates.len()
    }

    /// How many velocities there are.
    pub fn nv(&self) -> usize {
        self.velocities.len()
    }

    /// The joint of a velocity.
    pub fn joint_of(&self, velocity: usize) -> &Joint {
        &self.joints[self.velocities[velocity].joint]
    }

    /// The coordinates that velocities change, in their order and each once: that of each, but all of a joint with a
    /// quaternion.
    pub fn coordinates_along(&self, velocities: &[usize]) -> Vec<usize> {
        let mut coordinates = Vec::new();
        for &velocity in velocities {
            let joint = self.joint_of(velocity);
            let first = joint.q.start + velocity - joint.v.start;
            let changed = if joint.is_in_space() { joint.q.clone() } else { first..first + 1 };
            if !coordinates.contains(&changed.start) {
                coordinates.extend(changed);
            }
        }
        coordinates
    }

    /// The names of `velocities`: that of a joint where all of its velocities follow each other, else of each.
    pub fn names(&self, velocities: &[usize]) -> Vec<&str> {
        let (mut names, mut rest) = (Vec::new(), velocities);
        while let [first, ..] = rest {
            let joint = self.joint_of(*first);
            let is_whole = rest.get(..joint.v.len()).is_some_and(|some| some.iter().copied().eq(joint.v.clone()));
            let (name, count) = match is_whole {
                true => (&joint.name, joint.v.len()),
                false => (&self.velocities[*first].name, 1),
            };
            names.push(name.as_str());
            rest = &rest[count..];
        }
        names
    }

    /// What messages call the first of `velocities`: its joint, if they have all velocities of that.
    pub fn first_of(&self, velocities: &[usize]) -> Option<String> {
        let first = *velocities.first()?;
        Some(match self.has_all_of(velocities, first) {
            true => format!("the joint `{}`", self.joint_of(first).name),
            false => format!("the velocity `{}`", self.velocities[first].name),
        })
    }

    /// What the first of `velocities` without an actuator is called, and what messages report of it; `None` if all have one.
    pub fn lacking_actuators(&self, velocities: &[usize]) -> Option<(String, &'static str)> {
        let is_passive = |velocity: &usize| !self.velocities[*velocity].actuated;
        let first = velocities.iter().copied().find(is_passive)?;
        let joint = self.joint_of(first);
        if self.has_all_of(velocities, first) && !joint.v.clone().all(|velocity| is_passive(&velocity)) {
            return Some((format!("the joint `{}`", joint.name), "has actuators for some of its velocities only"));
        }
        let passive: Vec<usize> = velocities.iter().copied().filter(is_passive).collect();
        Some((self.first_of(&passive)?, "has no actuator"))
    }

    /// The first of `velocities` that belongs to a joint with a quaternion of which they do not have all velocities, in
    /// their order: such a joint has a position only as a whole.
    pub fn part_of_quaternion(&self, velocities: &[usize]) -> Option<usize> {
        let is_part = |velocity: &usize| {
            let joint = self.joint_of(*velocity);
            let is_whole = |some: &[usize]| some.iter().copied().eq(joint.v.clone());
            joint.is_in_space() && !velocities.windows(joint.v.len()).any(is_whole)
        };
        velocities.iter().copied().find(is_part)
    }

    /// Whether `velocities` have all velocities of the joint of one of them.
    fn has_all_of(&self, velocities: &[usize], one: usize) -> bool {
        self.joint_of(one).v.clone().all(|velocity| velocities.contains(&velocity))
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
        assert_eq!((layout.joints[1].q.clone(), layout.joints[1].v.clone()), (7..8, 6..7));
        assert_eq!(layout.coordinates_along(&[6]), [7]);
    }

    #[test]
    fn velocities_of_a_joint_with_a_quaternion_change_all_its_coordinates_and_others_their_own() {
        let mut layout = free_base_with_arm();
        layout.push("swivel", &[true, false], joint::LinkJoint::Series(joint::Series::Universal));
        assert_eq!(layout.coordinates_along(&[8, 4, 1, 6]), [9, 0, 1, 2, 3, 4, 5, 6, 7]);
    }

    #[test]
    fn velocities_are_called_by_their_joint_where_they_are_all_of_it() {
        let mut layout = free_base_with_arm();
        layout.push("swivel", &[true, false], joint::LinkJoint::Series(joint::Series::Universal));
        assert_eq!(layout.names(&[6, 7, 8, 0, 1, 2, 3, 4, 5]), ["arm", "swivel", "base"]);
        assert_eq!(layout.names(&[8, 7, 5]), ["swivel.theta", "swivel.phi", "base.wz"]);
        let lacking =
            |velocities: &[usize]| layout.lacking_actuators(velocities).map(|(name, what)| format!("{name} {what}"));
        assert_eq!(lacking(&[6, 7]), None);
        assert_eq!(lacking(&[7, 8]).unwrap(), "the joint `swivel` has actuators for some of its velocities only");
        assert_eq!(lacking(&[6, 8]).unwrap(), "the velocity `swivel.theta` has no actuator");
        assert_eq!(lacking(&[0, 1, 2, 3, 4, 5, 6]).unwrap(), "the joint `base` has no actuator");
    }

    #[test]
    fn a_joint_with_a_quaternion_is_whole_only_with_all_its_velocities_in_their_order() {
        let layout = free_base_with_arm();
        assert_eq!(layout.part_of_quaternion(&[6, 0, 1, 2, 3, 4, 5]), None);
        assert_eq!(layout.part_of_quaternion(&[6, 0, 1, 2, 3, 5, 4]), Some(0));
        assert_eq!(layout.part_of_quaternion(&[6, 4]), Some(4));
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
