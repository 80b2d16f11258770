//! The Coriolis matrix, from composite bodies.
//!
//! The force that a body of inertia I at the velocity v takes because of v alone is B v, with
//! B = ½ ((v ×*) I − I (v ×) + (I v) ×̄*). Of all matrices with this product it is the one whose sum over the bodies
//! gives C of the Christoffel symbols (Echeandia & Wensing, "Numerical methods to compute the Coriolis matrix and
//! Christoffel symbols for rigid-body systems", Journal of Computational and Nonlinear Dynamics 16(9), 2021).
//!
//! B needs no matrix of 36 elements. With the momentum (n; p) of the body and the rate J̇ at which its inertia tensor
//! about the origin changes, B (x; y) = (½ (J̇ x − n × x); x × p). All three add up over bodies, and mass moves with its
//! body: (p, J̇) are the rates of a first and a second moment, and are carried to the parent as these are.

use super::frame::{JointFrame, joint_frames};
use super::mass_matrix::find_planar;
use super::trace::Trace;
use super::workspace::Composite;
use crate::inertia::Sym3;
use crate::parameter::ParameterIn;
use crate::pseudo::PseudoInertia;
use crate::spatial::{Twist, Vec3, Wrench};
use crate::tree::Tree;
use redysim_runtime::Scalar;

/// C(q, v), by rows, of the Christoffel symbols: C v is the joint force of the velocities alone, without gravity and
/// without what acts in the joints, and Ṁ − 2 C is skew-symmetric.
pub fn coriolis_matrix<S: Scalar>(
    tree: &Tree<impl ParameterIn<S>>,
    trace: &impl Trace<S>,
    q: &[S],
    v: &[S],
) -> Vec<Vec<S>> {
    let (q, v) = (&tree.all_coordinates(q), &tree.all_velocities(v));
    let frames = joint_frames(tree, trace, q);
    let mut planar = Vec::new();
    find_planar(&mut planar, tree);
    let mut velocities: Vec<Twist<S>> = Vec::with_capacity(tree.bodies.len());
    let mut composites: Vec<MovingComposite<S>> = Vec::with_capacity(tree.bodies.len());
    for index in tree.outward() {
        let (body, frame) = (&tree.bodies[index], &frames[index]);
        let parent = body.parent.map_or(Twist::zero(), |parent| velocities[parent]);
        let velocity = body.joint.added(frame.twist_to_body(parent), &v[body.v.clone()]);
        trace.name_twist(velocity, ["w", "vel"], index);
        velocities.push(velocity);
        composites.push(MovingComposite::new(Composite::new(body.inertia, frame), velocity));
    }
    let mut matrix = vec![vec![S::zero(); tree.nv_of_all()]; tree.nv_of_all()];
    for index in tree.inward() {
        let (body, composite) = (&tree.bodies[index], composites[index].clone());
        composite.name(trace, index);
        if let Some(parent) = body.parent {
            composites[parent] = composites[parent].plus(&composite.to_parent(&frames[index], planar[index]));
        }
        let inertia = composite.inertia.to_rigid();
        for (column, screw) in body.v.clone().zip(body.joint.screws()) {
            let motion = screw.motion();
            let mut momentum = inertia.momentum(motion);
            let mut own = inertia.momentum(motion.rate_in(velocities[index])) + composite.coriolis(motion);
            let mut of_others = composite.coriolis_transposed(motion);
            for (row, screw) in body.v.clone().zip(body.joint.screws()) {
                matrix[row][column] = screw.project(own);
            }
            let mut at = index;
            while let Some(parent) = tree.bodies[at].parent {
                [momentum, own, of_others] =
                    [momentum, own, of_others].map(|wrench| frames[at].wrench_to_parent(wrench));
                let joint = &tree.bodies[parent];
                for (row, screw) in joint.v.clone().zip(joint.joint.screws()) {
                    let rate = screw.motion().rate_in(velocities[parent]);
                    matrix[row][column] = screw.project(own);
                    matrix[column][row] = momentum.dot(rate) + screw.project(of_others);
                }
                at = parent;
            }
        }
    }
    tree.folded_matrix(matrix)
}

/// A body and all it carries, each at its own velocity.
#[derive(Clone)]
struct MovingComposite<S> {
    inertia: Composite<S>,
    /// The rates of mass (zero), first moment (the momentum) and second moment, about the point of space where the
    /// origin is.
    rate: Composite<S>,
    /// The angular momentum about the origin.
    angular_momentum: Vec3<S>,
}

impl<S: Scalar> MovingComposite<S> {
    fn new(inertia: Composite<S>, velocity: Twist<S>) -> Self {
        let PseudoInertia { moment: h, second, .. } = inertia.inertia;
        let Wrench { moment: angular_momentum, force: momentum } = inertia.to_rigid().momentum(velocity);
        // d/dt ∫ r rᵀ dm with ṙ = u + ω × r.
        let (u, turned) = (velocity.linear, velocity.angular.skew() * second.full());
        let rate = Sym3::from_upper(|i, j| (u[i] * h[j] + h[i] * u[j]) + (turned.0[i][j] + turned.0[j][i]));
        // Rotation does not change the trace.
        let half_polar = (u[0] * h[0] + u[1] * h[1]) - turned.0[2][2];
        let rate = PseudoInertia { mass: S::zero(), moment: momentum, second: rate };
        MovingComposite { inertia, rate: Composite { inertia: rate, polar: half_polar + half_polar }, angular_momentum }
    }

    fn plus(&self, other: &Self) -> Self {
        MovingComposite {
            inertia: self.inertia.plus(&other.inertia),
            rate: self.rate.plus(&other.rate),
            angular_momentum: self.angular_momentum + other.angular_momentum,
        }
    }

    /// The composite in the parent's axes and about the parent's origin.
    fn to_parent(&self, frame: &JointFrame<S>, planar: bool) -> Self {
        let momentum = Wrench { moment: self.angular_momentum, force: self.rate.inertia.moment };
        MovingComposite {
            inertia: self.inertia.to_parent(frame, planar),
            rate: self.rate.to_parent(frame, planar),
            angular_momentum: frame.wrench_to_parent(momentum).moment,
        }
    }

    /// B (x; y).
    fn coriolis(&self, Twist { angular: x, .. }: Twist<S>) -> Wrench<S> {
        let moment = self.rate.to_rigid().tensor.full().fused_product(x) - self.angular_momentum.fused_cross(x);
        Wrench { moment: moment.scale(S::from_f64(0.5)), force: x.fused_cross(self.rate.inertia.moment) }
    }

    /// Bᵀ (x; y).
    fn coriolis_transposed(&self, Twist { angular: x, linear: y }: Twist<S>) -> Wrench<S> {
        let moment = self.rate.to_rigid().tensor.full().fused_product(x) + self.angular_momentum.fused_cross(x);
        Wrench { moment: moment.scale(S::from_f64(0.5)) + self.rate.inertia.moment.fused_cross(y), force: Vec3::zero() }
    }

    fn name(&self, trace: &impl Trace<S>, body: usize) {
        self.inertia.name(trace, body);
        trace.name_vector(self.rate.inertia.moment, "p", body);
        trace.name_vector(self.angular_momentum, "n", body);
    }
}
