//! Motions of joints: their coordinates, and the velocities and accelerations that belong to them.

use std::ops::Range;

use redysim_model::joint;
use redysim_runtime::Motion;

use crate::layout::Layout;

/// Some joints, whose coordinates and velocities stand one after the other.
#[derive(Clone, Debug)]
pub struct Moving {
    joints: Vec<Part>,
}

/// A joint, and where its coordinates and velocities stand.
#[derive(Clone, Debug)]
struct Part {
    motion: joint::LinkJoint,
    q: Range<usize>,
    v: Range<usize>,
}

impl Moving {
    /// The joints `chosen`.
    pub fn new(layout: &Layout, chosen: &[usize]) -> Self {
        let (mut nq, mut nv) = (0, 0);
        let part = |&index: &usize| {
            let motion = layout.joints[index].motion;
            let (q, v) = (nq..nq + motion.nq(), nv..nv + motion.nv());
            (nq, nv) = (q.end, v.end);
            Part { motion, q, v }
        };
        Moving { joints: chosen.iter().map(part).collect() }
    }

    /// Whether the velocities of each are the rates of its coordinates.
    pub fn is_linear(&self) -> bool {
        self.joints.iter().all(|part| part.motion.is_linear())
    }

    fn velocities(&self, mut write: impl FnMut(&Part, &mut [f64])) -> Vec<f64> {
        let mut all = vec![0.0; self.joints.last().map_or(0, |part| part.v.end)];
        self.joints.iter().for_each(|part| write(part, &mut all[part.v.clone()]));
        all
    }

    fn coordinates(&self, mut write: impl FnMut(&Part, &mut [f64])) -> Vec<f64> {
        let mut all = vec![0.0; self.joints.last().map_or(0, |part| part.q.end)];
        self.joints.iter().for_each(|part| write(part, &mut all[part.q.clone()]));
        all
    }

    /// q ⊞ dv.
    pub fn integrate(&self, q: &[f64], dv: &[f64]) -> Vec<f64> {
        self.coordinates(|part, moved| part.motion.integrate(&q[part.q.clone()], &dv[part.v.clone()], moved))
    }

    /// q₁ ⊟ q₀.
    pub fn difference(&self, q0: &[f64], q1: &[f64]) -> Vec<f64> {
        self.velocities(|part, dv| part.motion.difference(&q0[part.q.clone()], &q1[part.q.clone()], dv))
    }

    /// The velocities and accelerations at which coordinates of any length of quaternion move with the rates q̇ and q̈
    /// in the place of these; quaternions become those of length 1.
    pub fn of_coordinates(
        &self,
        Motion { q, v: rates, a: second }: Motion<Vec<f64>, Vec<f64>>,
    ) -> Motion<Vec<f64>, Vec<f64>> {
        let v = self.velocities(|part, v| part.motion.velocities(&q[part.q.clone()], &rates[part.q.clone()], v));
        let a = self.velocities(|part, a| {
            let (q, rates) = (&q[part.q.clone()], &rates[part.q.clone()]);
            part.motion.velocities(q, &second[part.q.clone()], a);
            // v = Rᵀ ṗ and ω = 2 q⁻¹ q̇, derived.
            if let (Some(quaternion), Some(rates)) = (orientation(part, q), orientation(part, rates)) {
                let v = &v[part.v.clone()];
                let (linear, angular) = v.split_at(v.len() - 3);
                let growth = 2.0 * dot(quaternion, rates) / dot(quaternion, quaternion);
                let (of_linear, of_angular) = a.split_at_mut(linear.len());
                of_angular.iter_mut().zip(angular).for_each(|(a, w)| *a -= growth * w);
                of_linear.iter_mut().zip(turned(angular, linear)).for_each(|(a, turned)| *a -= turned);
            }
        });
        let q = self.coordinates(|part, unit| {
            unit.copy_from_slice(&q[part.q.clone()]);
            if let Some(quaternion) = orientation(part, &q[part.q.clone()]) {
                let length = dot(quaternion, quaternion).sqrt();
                let first = unit.len() - 4;
                unit[first..].iter_mut().for_each(|component| *component /= length);
            }
        });
        Motion { q, v, a }
    }

    /// The rates q̇ and q̈ of the coordinates in the place of velocities and accelerations: the inverse of
    /// [`of_coordinates`](Self::of_coordinates).
    pub fn in_coordinates(&self, Motion { q, v, a }: Motion<Vec<f64>, Vec<f64>>) -> Motion<Vec<f64>, Vec<f64>> {
        let rates = self.coordinates(|part, rates| {
            part.motion.coordinate_rates(&q[part.q.clone()], &v[part.v.clone()], rates);
        });
        let second = self.coordinates(|part, second| {
            let (q, v) = (&q[part.q.clone()], &v[part.v.clone()]);
            let mut a = a[part.v.clone()].to_vec();
            let Some(of_rates) = orientation(part, &rates[part.q.clone()]) else {
                return part.motion.coordinate_rates(q, &a, second);
            };
            // ṗ = R v and q̇ = ½ q ω, derived.
            let (linear, angular) = v.split_at(v.len() - 3);
            a.iter_mut().zip(turned(angular, linear)).for_each(|(a, turned)| *a += turned);
            part.motion.coordinate_rates(q, &a, second);
            let mut change = [0.0; 4];
            joint::Joint::Spherical.coordinate_rates(of_rates, angular, &mut change);
            let first = second.len() - 4;
            second[first..].iter_mut().zip(change).for_each(|(second, change)| *second += change);
        });
        Motion { q, v: rates, a: second }
    }

    /// Turns quaternions round that are on the other side of those `before` them: a quaternion and its negative are the
    /// same orientation, but not the same way apart. Fails with the first coordinate of one that is zero.
    pub fn follow(&self, before: Option<&[f64]>, q: &mut [f64]) -> Result<(), usize> {
        for part in self.joints.iter().filter(|part| !part.motion.is_linear()) {
            let at = part.q.end - 4..part.q.end;
            let length = dot(&q[at.clone()], &q[at.clone()]).sqrt();
            if length == 0.0 {
                return Err(at.start);
            }
            let turned = before.is_some_and(|before| dot(&before[at.clone()], &q[at.clone()]) < 0.0);
            let factor = if turned { -1.0 } else { 1.0 } / length;
            q[at].iter_mut().for_each(|component| *component *= factor);
        }
        Ok(())
    }
}

/// The quaternion among coordinates of a joint, or their rates, if it has one.
fn orientation<'q>(part: &Part, q: &'q [f64]) -> Option<&'q [f64]> {
    Some(&q[part.motion.quaternion()]).filter(|quaternion| !quaternion.is_empty())
}

/// ω × v; nothing of a joint without linear velocities.
fn turned(angular: &[f64], linear: &[f64]) -> Vec<f64> {
    let component = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        angular[j] * linear[k] - angular[k] * linear[j]
    };
    (0..linear.len()).map(component).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::tests::free_base_with_arm;

    #[test]
    fn velocities_and_rates_of_coordinates_are_inverse_to_each_other() {
        let moving = Moving::new(&free_base_with_arm(), &[1, 0]);
        let motion = Motion {
            q: vec![0.4, 1.0, -2.0, 3.0, 0.5, -0.1, 0.5, 0.7],
            v: vec![1.5, 0.3, -0.2, 0.1, 2.0, -1.0, 0.5],
            a: vec![0.7, -3.0, 2.0, 1.0, 0.4, 0.6, -0.8],
        };
        let back = moving.of_coordinates(moving.in_coordinates(motion.clone()));
        for (found, expected) in [(&back.q, &motion.q), (&back.v, &motion.v), (&back.a, &motion.a)] {
            assert!(
                found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14),
                "{found:?} instead of {expected:?}"
            );
        }
    }

    #[test]
    fn accelerations_are_the_slopes_of_velocities_whatever_the_length_of_the_quaternion() {
        let moving = Moving::new(&free_base_with_arm(), &[0]);
        let along = |t: f64| {
            let of = |i: usize, k: usize| (i as f64 + 0.3 * (k as f64)).sin();
            let sum = |power: [f64; 3]| (0..7).map(|i| (0..3).map(|k| of(i, k) * power[k]).sum()).collect::<Vec<f64>>();
            moving.of_coordinates(Motion {
                q: sum([1.0, t, t * t]),
                v: sum([0.0, 1.0, 2.0 * t]),
                a: sum([0.0, 0.0, 2.0]),
            })
        };
        let step = 1e-5;
        let (before, now, after) = (along(0.3 - step), along(0.3), along(0.3 + step));
        for i in 0..6 {
            let slope = (after.v[i] - before.v[i]) / (2.0 * step);
            assert!((now.a[i] - slope).abs() < 1e-8 * (1.0 + slope.abs()), "{i}: {} instead of {slope}", now.a[i]);
        }
        let moved = moving.difference(&before.q, &after.q);
        assert!(moved.iter().zip(&now.v).all(|(moved, v)| (moved / (2.0 * step) - v).abs() < 1e-8), "{moved:?}");
    }
}
