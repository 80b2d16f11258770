//! Springs between points: the joint forces of what acts along the line between two points of bodies.
//!
//! With d the vector from point a to point b, ℓ² = d·d and ℓ ∂ℓ/∂qᵢ = d·∂d/∂qᵢ. The joints between the ground and the
//! nearest body that carries both points displace both alike, so only those between that body and the two ends have a
//! lever. Its sum with the velocities is ℓ ℓ̇, so that no velocity of a point is needed, and the force density f/ℓ times
//! the lever is the joint force: neither the direction of the line nor its rate is divided by ℓ.

use super::frame::JointFrame;
use crate::parameter::ParameterIn;
use crate::spatial::{Vec3, Wrench};
use crate::spring::{BodyPoint, BodySpring};
use crate::tree::Tree;
use redysim_runtime::Scalar;

/// Buffers for springs.
#[derive(Clone, Debug)]
pub(super) struct Springs<S> {
    /// The freedoms that move each end of the spring at hand against the other, from the end towards the ground.
    levers: [Vec<Lever<S>>; 2],
    /// The joint forces of all springs.
    forces: Vec<S>,
}

/// A freedom of a joint that moves one end of a spring.
#[derive(Clone, Copy, Debug)]
struct Lever<S> {
    body: usize,
    /// Which of the joint's velocities it is.
    freedom: usize,
    /// From the joint's origin to the end, in the axes of the joint's parent.
    arm: Vec3<S>,
    /// d·∂d/∂q.
    value: S,
}

impl<S> Lever<S> {
    /// The velocity of the freedom in the model's order.
    fn velocity<P>(&self, tree: &Tree<P>) -> usize {
        tree.bodies[self.body].v.start + self.freedom
    }
}

impl<S> Springs<S> {
    pub fn for_tree<P>(tree: &Tree<P>) -> Self {
        let count = if tree.springs.is_empty() { 0 } else { tree.nv_of_all() };
        Springs { levers: [0; 2].map(|_| Vec::with_capacity(count)), forces: Vec::with_capacity(count) }
    }
}

impl<S> Default for Springs<S> {
    fn default() -> Self {
        Springs { levers: [Vec::new(), Vec::new()], forces: Vec::new() }
    }
}

impl<S: Scalar> Springs<S> {
    /// The joint forces against all springs, one for each velocity; empty for a tree without springs.
    pub fn forces<P: ParameterIn<S>>(&mut self, tree: &Tree<P>, frames: &[JointFrame<S>], v: &[S]) -> &mut [S] {
        self.forces.clear();
        if !tree.springs.is_empty() {
            self.forces.resize(tree.nv_of_all(), S::zero());
        }
        for spring in &tree.springs {
            let square = self.measure(spring, tree, frames);
            let density = spring.force_density(square, || self.half_rate(tree, v));
            let Some(density) = density else { continue };
            for lever in self.levers.iter().flatten() {
                self.forces[lever.velocity(tree)] += lever.value * density;
            }
        }
        &mut self.forces
    }

    /// Σ k (ℓ − ℓ₀)², twice the energy of all springs; `None` without springs that store energy.
    pub fn twice_energy<P: ParameterIn<S>>(&mut self, tree: &Tree<P>, frames: &[JointFrame<S>]) -> Option<S> {
        let energies = tree.springs.iter().filter_map(|spring| {
            let square = self.measure(spring, tree, frames);
            spring.twice_energy(square)
        });
        energies.reduce(|sum, energy| sum + energy)
    }

    /// Σ c ℓ̇², the power that the dampers of all springs take; `None` without dampers.
    pub fn dissipated_power<P: ParameterIn<S>>(
        &mut self,
        tree: &Tree<P>,
        frames: &[JointFrame<S>],
        v: &[S],
    ) -> Option<S> {
        let powers = tree.springs.iter().filter_map(|spring| {
            let square = self.measure(spring, tree, frames);
            spring.dissipated_power(square, || self.half_rate(tree, v))
        });
        powers.reduce(|sum, power| sum + power)
    }

    /// d·d of a spring; its levers are found with it.
    fn measure<P: ParameterIn<S>>(&mut self, spring: &BodySpring<P>, tree: &Tree<P>, frames: &[JointFrame<S>]) -> S {
        let carrier = nearest_carrier(tree, spring.a.body, spring.b.body);
        let [of_a, of_b] = &mut self.levers;
        let from_a = climb(of_a, tree, frames, spring.a, carrier);
        let from_b = climb(of_b, tree, frames, spring.b, carrier);
        let line = from_b - from_a;
        for (levers, mut line) in [(of_a, -line), (of_b, line)] {
            for Lever { body, freedom, arm, value } in levers.iter_mut().rev() {
                let (frame, screw) = (&frames[*body], tree.bodies[*body].joint.screw(*freedom));
                *value = screw.project_along(
                    frame.rotation.axis(screw.axis),
                    Wrench { moment: arm.fused_cross(line), force: line },
                );
                if *freedom == 0 {
                    line = frame.to_body(line);
                }
            }
        }
        line.fused_dot(line)
    }

    /// ℓ ℓ̇ of the spring at hand.
    fn half_rate(&self, tree: &Tree<impl Copy>, v: &[S]) -> S {
        let terms = self.levers.iter().flatten().map(|lever| lever.value * v[lever.velocity(tree)]);
        terms.reduce(|sum, term| sum + term).unwrap_or_else(S::zero)
    }
}

/// The nearest body that carries both bodies, or is one of them; `None` is the ground.
fn nearest_carrier<P>(tree: &Tree<P>, mut a: Option<usize>, mut b: Option<usize>) -> Option<usize> {
    // Parents have smaller indices, and the ground the least.
    while a != b {
        let further = if a > b { &mut a } else { &mut b };
        *further = further.and_then(|body| tree.bodies[body].parent);
    }
    a
}

/// Collects the freedoms between a point and the body `carrier`, which carries it; returns the point in its axes.
fn climb<S: Scalar>(
    levers: &mut Vec<Lever<S>>,
    tree: &Tree<impl Copy>,
    frames: &[JointFrame<S>],
    end: BodyPoint,
    carrier: Option<usize>,
) -> Vec3<S> {
    levers.clear();
    let point = Vec3::constant(end.point);
    let mut point = end.body.map_or(point, |body| frames[body].fixed_vector(point));
    let mut at = end.body;
    while at != carrier {
        let Some(body) = at else { break };
        let arm = frames[body].to_parent(point);
        for freedom in 0..tree.bodies[body].v.len() {
            levers.push(Lever { body, freedom, arm, value: S::zero() });
        }
        point = arm + frames[body].position;
        at = tree.bodies[body].parent;
    }
    point
}
