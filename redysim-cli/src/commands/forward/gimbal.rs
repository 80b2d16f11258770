//! Joints in Euler angles that come near their gimbal, where the first and the third axis are parallel and the angles change
//! arbitrarily fast.

use crate::layout::{Joint, Layout};
use crate::number::size;

/// |cos θ| of the second angle, or |sin θ| where the first and the third axis are the same, below which a run that goes wrong may
/// do so because of the gimbal: within 3°.
const NEAR: f64 = 0.05;

/// How near the joints of a run have come to their gimbals.
#[derive(Default)]
pub struct Gimbals {
    nearest: Option<Approach>,
}

/// A joint beside its gimbal.
struct Approach {
    joint: String,
    t: f64,
    distance: f64,
}

impl Gimbals {
    /// Looks at the position `q` at `t`.
    pub fn see(&mut self, layout: &Layout, t: f64, q: &[f64]) {
        for joint in &layout.joints {
            let Some(distance) = distance(joint, q) else { continue };
            if distance < self.nearest.as_ref().map_or(NEAR, |nearest| nearest.distance) {
                self.nearest = Some(Approach { joint: joint.name.clone(), t, distance });
            }
        }
    }

    /// What to do about a run that goes wrong, if a joint has come near its gimbal.
    pub fn advice(&self) -> Option<String> {
        let Approach { joint, t, distance } = self.nearest.as_ref()?;
        Some(format!(
            "the Euler angles of the joint `{joint}` are {}° from their gimbal at t = {} s, near which they change \
             arbitrarily fast: leave `coordinates` of its link out of the model, so that the joint has a quaternion",
            size(distance.asin().to_degrees()),
            size(*t)
        ))
    }
}

/// The sine of the angle between the first and the third axis of a joint in Euler angles.
fn distance(joint: &Joint, q: &[f64]) -> Option<f64> {
    let [first, _, third] = joint.euler_sequence()?.axes();
    let theta = q.get(joint.q.end - 2)?;
    Some(if first == third { theta.sin() } else { theta.cos() }.abs())
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
        let mut gimbals = Gimbals::default();
        for (t, &theta) in second_angles.iter().enumerate() {
            let mut q: Vec<f64> = layout.coordinates.iter().map(|_| 0.4).collect();
            let place = q.len() - 2;
            q[place] = theta;
            gimbals.see(layout, t as f64, &q);
        }
        gimbals.advice()
    }

    #[test]
    fn the_advice_is_about_the_instant_that_is_nearest_to_the_gimbal() {
        let layout = layout("free", "coordinates = 'zxy'");
        let found = advice(&layout, &[0.3, FRAC_PI_2 - 0.01, 3.0 * FRAC_PI_2 + 1e-4, FRAC_PI_2 - 0.02]).unwrap();
        assert!(found.contains("0.0057° from their gimbal at t = 2 s"), "{found}");
    }

    #[test]
    fn sequences_of_two_axes_have_their_gimbal_where_the_second_angle_is_zero() {
        let layout = layout("spherical", "coordinates = 'zxz'");
        assert!(advice(&layout, &[FRAC_PI_2]).is_none());
        assert!(advice(&layout, &[0.01]).is_some());
    }

    #[test]
    fn motions_far_from_the_gimbal_and_quaternions_have_no_advice() {
        assert!(advice(&layout("free", "coordinates = 'zxy'"), &[1.4, -1.4]).is_none());
        assert!(advice(&layout("free", ""), &[FRAC_PI_2]).is_none());
    }
}
