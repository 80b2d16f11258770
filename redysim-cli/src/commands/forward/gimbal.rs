//! Joints in Euler angles that come near gimbal lock, where the first and the third axis are parallel and the angles change
//! arbitrarily fast.

use redysim_model::joint::EulerSequence;

use crate::layout::{Joint, Layout};
use crate::number::size;

/// The sine of the angle between the first and the third axis below which a run that goes wrong may do so because of gimbal
/// lock: within 3°.
const NEAR: f64 = 0.05;

/// How near the joints of a run have come to gimbal lock.
pub struct Gimbals<'a> {
    joints: Vec<(&'a Joint, EulerSequence)>,
    nearest: Option<Approach<'a>>,
}

/// The nearest that a joint has come to gimbal lock.
struct Approach<'a> {
    joint: &'a str,
    t: f64,
    sine: f64,
}

impl<'a> Gimbals<'a> {
    /// Of a run in which the motion along the velocities `prescribed` is given: a joint that follows it does not fail at gimbal
    /// lock.
    pub fn new(layout: &'a Layout, prescribed: &[usize]) -> Self {
        let in_angles = layout.joints.iter().filter_map(|joint| Some((joint, joint.euler_sequence()?)));
        let is_free = |joint: &Joint| joint.v.clone().any(|velocity| !prescribed.contains(&velocity));
        Gimbals { joints: in_angles.filter(|(joint, _)| is_free(joint)).collect(), nearest: None }
    }

    /// Looks at the position `q` at `t`.
    pub fn see(&mut self, t: f64, q: &[f64]) {
        for &(joint, sequence) in &self.joints {
            let sine = sine(sequence, q[joint.q.end - 2]);
            if sine < self.nearest.as_ref().map_or(NEAR, |nearest| nearest.sine) {
                self.nearest = Some(Approach { joint: &joint.name, t, sine });
            }
        }
    }

    /// What to do about a run that goes wrong, if a joint has come near gimbal lock.
    pub fn advice(&self) -> Option<String> {
        let Approach { joint, t, sine } = self.nearest.as_ref()?;
        Some(format!(
            "at t = {} s the Euler angles of the joint `{joint}` are {}° from gimbal lock, near which they change arbitrarily \
             fast: leave `coordinates` of its link out of the model, so that the joint has a quaternion, and its velocities \
             are the angular velocity",
            size(*t),
            size(sine.asin().to_degrees())
        ))
    }
}

/// The sine of the angle between the first and the third axis at the second angle `theta`.
fn sine(sequence: EulerSequence, theta: f64) -> f64 {
    let [first, _, third] = sequence.axes();
    if first == third { theta.sin() } else { theta.cos() }.abs()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_PI_2;

    use redysim_model::Model;

    use super::*;

    fn layout(joint: &str, coordinates: &str) -> Layout {
        let model = format!(
            "name = 'body'\ngravity = [0.0, 0.0, -9.81]\n[[link]]\nname = 'body'\nparent = 'base'\njoint = '{joint}'\n\
             {coordinates}\norigin = {{}}\nmass = 1.0\ninertia = {{ xx = 1.0, yy = 1.0, zz = 1.0 }}"
        );
        Layout::of(&Model::from_toml(model, "body.toml").unwrap().model)
    }

    fn advice(layout: &Layout, second_angles: &[f64]) -> Option<String> {
        let mut gimbals = Gimbals::new(layout, &[]);
        for (t, &theta) in second_angles.iter().enumerate() {
            let mut q: Vec<f64> = layout.coordinates.iter().map(|_| 0.4).collect();
            let place = q.len() - 2;
            q[place] = theta;
            gimbals.see(t as f64, &q);
        }
        gimbals.advice()
    }

    #[test]
    fn the_advice_is_about_the_instant_that_is_nearest_to_gimbal_lock() {
        let layout = layout("free", "coordinates = 'zxy'");
        let found = advice(&layout, &[0.3, FRAC_PI_2 - 0.01, 3.0 * FRAC_PI_2 + 1e-4, FRAC_PI_2 - 0.02]).unwrap();
        assert!(
            found.starts_with("at t = 2 s the Euler angles of the joint `body` are 0.0057° from gimbal lock"),
            "{found}"
        );
    }

    #[test]
    fn sequences_of_two_axes_lock_where_the_second_angle_is_zero() {
        let layout = layout("spherical", "coordinates = 'zxz'");
        assert!(advice(&layout, &[FRAC_PI_2]).is_none());
        assert!(advice(&layout, &[0.01]).is_some());
    }

    #[test]
    fn motions_far_from_gimbal_lock_and_quaternions_have_no_advice() {
        assert!(advice(&layout("free", "coordinates = 'zxy'"), &[1.4, -1.4]).is_none());
        assert!(advice(&layout("free", ""), &[FRAC_PI_2]).is_none());
    }

    #[test]
    fn a_joint_that_follows_a_motion_is_where_the_motion_has_it_and_has_no_advice() {
        let layout = layout("free", "coordinates = 'zxy'");
        let mut q: Vec<f64> = layout.coordinates.iter().map(|_| 0.4).collect();
        q[4] = FRAC_PI_2;
        let see = |prescribed: &[usize]| {
            let mut gimbals = Gimbals::new(&layout, prescribed);
            gimbals.see(0.0, &q);
            gimbals.advice()
        };
        assert!(see(&[0, 1, 2, 3, 4, 5]).is_none());
        assert!(see(&[0, 1, 2, 3, 4]).is_some());
    }
}
