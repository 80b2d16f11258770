//! What belongs to each velocity of a joint.

/// A quantity of a joint for each of its velocities.
///
/// ```
/// use redysim_model::PerVelocity;
///
/// assert_eq!(PerVelocity::from(false).of_velocities(3, true), [false; 3]);
/// assert_eq!(PerVelocity::Each(vec![0.5, 2.0]).of_velocities(2, 0.0), [0.5, 2.0]);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(untagged))]
pub enum PerVelocity<T> {
    /// The same for all of them.
    Uniform(T),
    /// Each by itself, in the order of the joint's velocities.
    Each(Vec<T>),
}

impl<T> From<T> for PerVelocity<T> {
    fn from(value: T) -> Self {
        PerVelocity::Uniform(value)
    }
}

impl<T: Clone> PerVelocity<T> {
    /// The values of a joint that has `count` velocities; `default` of those that are not listed.
    pub fn of_velocities(&self, count: usize, default: T) -> Vec<T> {
        match self {
            PerVelocity::Uniform(value) => vec![value.clone(); count],
            PerVelocity::Each(each) => each.iter().cloned().chain(std::iter::repeat(default)).take(count).collect(),
        }
    }
}

impl<T> PerVelocity<T> {
    /// Every value that is given.
    pub fn values(&self) -> &[T] {
        match self {
            PerVelocity::Uniform(value) => std::slice::from_ref(value),
            PerVelocity::Each(each) => each,
        }
    }
}
