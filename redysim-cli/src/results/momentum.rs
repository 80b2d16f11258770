//! The momentum of a mechanism, and how far it drifts where nothing outside acts on it.

use redysim_model::{GenericMechanism, JointKind};
use redysim_runtime::{CenterOfMass, MassCenter, Momentum, TotalMomentum};

use crate::carriers::stands_on_ground;

/// Linear momentum, N s, angular momentum about the origin of the base frame, N m s, and the centre of mass.
pub fn about_base(mechanism: &GenericMechanism, q: &Vec<f64>, v: &Vec<f64>) -> (Momentum<f64>, CenterOfMass<f64>) {
    let (Momentum { linear, angular }, center) = (mechanism.momentum(q, v), mechanism.center_of_mass(q, v));
    // L₀ = L_c + c × p.
    let carried = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        angular[i] + center.position[j] * linear[k] - center.position[k] * linear[j]
    };
    (Momentum { linear, angular: std::array::from_fn(carried) }, center)
}

/// The largest drift of a momentum that nothing outside changes.
#[derive(Clone, Copy, Debug, Default)]
pub struct MomentumDrift {
    start: Option<Momentum<f64>>,
    /// Of the linear momentum, N s.
    pub linear: f64,
    /// Of the angular momentum about the origin of the base frame, N m s.
    pub angular: f64,
}

impl MomentumDrift {
    /// Looks at a momentum about the origin of the base frame.
    pub fn see(&mut self, momentum: Momentum<f64>) {
        let Momentum { linear, angular } = *self.start.get_or_insert(momentum);
        let apart = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt();
        self.linear = self.linear.max(apart(momentum.linear, linear));
        self.angular = self.angular.max(apart(momentum.angular, angular));
    }
}

/// Whether the ground does not act on a mechanism, unless through forces of its joints: without gravity, on free joints
/// alone, without springs to the ground or loops through it.
pub fn floats(mechanism: &GenericMechanism) -> bool {
    let (model, tree) = (mechanism.model(), mechanism.tree());
    model.gravity.0 == [0.0; 3]
        && model.moving_links().all(|link| link.joint == JointKind::Free || !stands_on_ground(mechanism.model(), link))
        && tree.cuts.iter().all(|cut| cut.a.body.is_some() && cut.b.body.is_some())
        && tree.springs.iter().all(|spring| spring.a.body.is_some() && spring.b.body.is_some())
}

/// Whether the joints on the ground take forces.
pub fn is_held(mechanism: &GenericMechanism, tau: &[f64]) -> bool {
    let mut first = 0;
    mechanism.model().moving_links().any(|link| {
        let own = first..first + link.dof();
        first = own.end;
        stands_on_ground(mechanism.model(), link) && tau[own].iter().any(|force| *force != 0.0)
    })
}

#[cfg(test)]
mod tests {
    use redysim_model::Model;
    use redysim_model::joint::EulerSequence;

    use super::*;

    fn mechanism(name: &str, change: impl FnOnce(&mut Model)) -> GenericMechanism {
        let path = format!("{}/../models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let mut model = Model::load(path).expect("a valid model").model;
        change(&mut model);
        GenericMechanism::new(model)
    }

    #[test]
    fn a_mechanism_floats_without_gravity_on_free_joints_alone() {
        let falls = |model: &mut Model| model.gravity.0 = [0.0, 0.0, -9.81];
        let euler = |model: &mut Model| model.links[0].coordinates = Some(EulerSequence::Zxy);
        assert!(floats(&mechanism("floating_three_link", |_| ())));
        assert!(floats(&mechanism("floating_three_link", euler)));
        assert!(!floats(&mechanism("floating_three_link", falls)), "it falls");
        assert!(!floats(&mechanism("three_link", |model| model.gravity.0 = [0.0; 3])), "it stands on the ground");
    }

    #[test]
    fn forces_of_the_arm_do_not_hold_a_robot_that_floats() {
        let robot = mechanism("floating_three_link", |_| ());
        let mut tau = vec![0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0];
        assert!(!is_held(&robot, &tau));
        tau[5] = 1e-3;
        assert!(is_held(&robot, &tau));
    }
}
