//! Which velocities of a joint have an actuator.

/// Which of a joint's velocities have an actuator.
///
/// ```
/// use redysim_model::Actuation;
///
/// assert_eq!(Actuation::from(false).of_velocities(3), [false; 3]);
/// assert_eq!(Actuation::PerVelocity(vec![true, false]).of_velocities(2), [true, false]);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(untagged))]
pub enum Actuation {
    /// All of them, or none.
    Uniform(bool),
    /// Each by itself, in the order of the joint's velocities; one that is missing has an actuator.
    PerVelocity(Vec<bool>),
}

impl From<bool> for Actuation {
    fn from(actuated: bool) -> Self {
        Actuation::Uniform(actuated)
    }
}

impl Actuation {
    /// Whether each of a joint's velocities has an actuator.
    pub fn of_velocities(&self, count: usize) -> Vec<bool> {
        match self {
            Actuation::Uniform(actuated) => vec![*actuated; count],
            Actuation::PerVelocity(each) => (0..count).map(|i| each.get(i).copied().unwrap_or(true)).collect(),
        }
    }
}
