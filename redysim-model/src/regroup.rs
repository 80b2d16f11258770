//! Base parameters: inertia that a joint cannot tell from its parent's is moved to the parent.
//!
//! For a joint that turns about z, the mass m, the first moment along z and an inertia diag(a, a, 0) move with the
//! parent whatever the joint does: the kinetic energy ½ m v² + v·(ω × h) + ½ ωᵀ J ω of such a body depends neither on
//! the joint's angle nor on its rate. Choosing a = J_yy leaves the body with seven parameters instead of ten. For a
//! joint that moves along z, the whole tensor about the body's origin can go. Kinetic and potential energy of the whole
//! mechanism, hence M, C and g, stay exactly the same (Gautier & Khalil, "Direct calculation of minimum set of inertial
//! parameters of serial robots", IEEE Trans. Robotics and Automation 6(3), 1990). Energies and wrenches of single
//! links do not, and a body left over need not be a possible one.

use crate::inertia::{RigidInertia, Sym3};
use crate::spatial::Vec3;
use crate::tree::{Joint, Tree};

/// The tree with as much inertia as possible moved towards the ground.
pub fn base_parameters(tree: &Tree) -> Tree {
    let mut tree = tree.clone();
    for index in (0..tree.bodies.len()).rev() {
        let body = &mut tree.bodies[index];
        let (own, shared) = split(body.joint, body.inertia);
        body.inertia = own;
        let (parent, moved) = (body.parent, shared.transformed(body.placement));
        let carrier = match parent {
            Some(parent) => &mut tree.bodies[parent].inertia,
            None => &mut tree.ground,
        };
        *carrier = (*carrier + moved).without_roundoff();
    }
    tree
}

/// What stays with the body, and what its parent may carry as well.
fn split(joint: Joint, inertia: RigidInertia<f64>) -> (RigidInertia<f64>, RigidInertia<f64>) {
    let RigidInertia { mass, moment: Vec3([x, y, z]), tensor } = inertia;
    match joint {
        Joint::Revolute => {
            let a = tensor.yy;
            (
                RigidInertia {
                    mass: 0.0,
                    moment: Vec3([x, y, 0.0]),
                    tensor: Sym3 { xx: tensor.xx - a, yy: 0.0, ..tensor },
                },
                RigidInertia { mass, moment: Vec3([0.0, 0.0, z]), tensor: Sym3 { xx: a, yy: a, ..Sym3::zero() } },
            )
        }
        Joint::Prismatic => (
            RigidInertia { mass, moment: inertia.moment, tensor: Sym3::zero() },
            RigidInertia { mass: 0.0, moment: Vec3::zero(), tensor },
        ),
    }
}
