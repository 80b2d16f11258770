//! Run-time parameters: the numbers of a model that a program gives when it runs.

use crate::inertia::Sym3;
use crate::joint::{BodyPhysics, LinkJoint, VelocityPhysics};
use crate::model::{Inertia, Link, Model};
use crate::parameter::Parameter;
use crate::per_velocity::PerVelocity;
use crate::schema::keys;
use crate::spatial::Vec3;
use redysim_runtime::ParameterRule;

/// A quantity of a model that is given at run time: an entry of the option `parameters`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RunTimeParameter {
    /// What is given.
    pub quantity: Quantity,
    /// Index of the link that has it in [`Model::links`]; `None` for gravity.
    pub link: Option<usize>,
}

/// The quantities that may be given at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "snake_case"))]
#[non_exhaustive]
pub enum Quantity {
    /// Acceleration of gravity in the base frame, m/s².
    Gravity,
    /// Mass of a link, kg.
    Mass,
    /// Centre of mass in the link's frame, m.
    Com,
    /// Inertia about the centre of mass, in the link's axes, kg m².
    Inertia,
    /// Reflected inertia of a joint's rotor, kg m² or kg.
    Armature,
    /// Viscous damping of a joint, N m s/rad or N s/m.
    Damping,
    /// Coulomb friction of a joint, N m or N.
    Friction,
    /// The speed at which friction is 1/√2 of its limit, rad/s or m/s.
    FrictionVelocity,
    /// Stiffness of a joint's spring, N m/rad or N/m.
    Stiffness,
    /// The coordinates at which a joint's springs are relaxed, rad or m.
    Rest,
}

impl Quantity {
    /// Those of links and joints, with their names in a model file.
    pub const OF_LINKS: [(&'static str, Quantity); 9] = [
        (keys::MASS.name, Quantity::Mass),
        (keys::COM.name, Quantity::Com),
        (keys::INERTIA.name, Quantity::Inertia),
        (keys::ARMATURE.name, Quantity::Armature),
        (keys::DAMPING.name, Quantity::Damping),
        (keys::FRICTION.name, Quantity::Friction),
        (keys::FRICTION_VELOCITY.name, Quantity::FrictionVelocity),
        (keys::STIFFNESS.name, Quantity::Stiffness),
        (keys::REST.name, Quantity::Rest),
    ];

    /// Its name in a model file.
    pub fn name(self) -> &'static str {
        Quantity::OF_LINKS.iter().find(|(_, quantity)| *quantity == self).map_or(keys::GRAVITY.name, |(name, _)| name)
    }

    /// What is appended to the name for each of its numbers, where their count does not depend on the joint.
    pub(crate) fn components(self) -> &'static [&'static str] {
        match self {
            Quantity::Gravity | Quantity::Com => &["x", "y", "z"],
            Quantity::Inertia => &["xx", "yy", "zz", "xy", "yz", "xz"],
            _ => &[],
        }
    }

    /// Whether it belongs to a joint that moves, not to a body.
    pub fn is_of_joint(self) -> bool {
        !matches!(self, Quantity::Gravity | Quantity::Mass | Quantity::Com | Quantity::Inertia)
    }

    /// What is appended to the name for each of its numbers, and what these must fulfil. The joint of the link that has it
    /// is `joint`.
    fn numbers(self, joint: Option<LinkJoint>) -> Vec<(String, ParameterRule)> {
        let all = |components: &[&str], rule: ParameterRule| -> Vec<(String, ParameterRule)> {
            let suffix = |component: &&str| if components.len() == 1 { String::new() } else { format!(".{component}") };
            components.iter().map(|component| (suffix(component), rule)).collect()
        };
        match self {
            Quantity::Gravity | Quantity::Com => all(self.components(), ParameterRule::Finite),
            Quantity::Mass => all(&[""], ParameterRule::NotNegative),
            Quantity::Inertia => all(self.components(), ParameterRule::Inertia),
            Quantity::Rest => {
                let mut rest = all(joint.map_or(&[""], LinkJoint::coordinate_names), ParameterRule::Finite);
                for (_, rule) in &mut rest[joint.map_or(0..0, LinkJoint::quaternion)] {
                    *rule = ParameterRule::Quaternion;
                }
                rest
            }
            Quantity::Armature
            | Quantity::Damping
            | Quantity::Friction
            | Quantity::FrictionVelocity
            | Quantity::Stiffness => {
                let rule = match self {
                    Quantity::FrictionVelocity => ParameterRule::Positive,
                    _ => ParameterRule::NotNegative,
                };
                all(joint.map_or(&[""], LinkJoint::velocity_names), rule)
            }
        }
    }
}

impl RunTimeParameter {
    /// Its name in a model file: `gravity`, `tool.mass`, `tool.inertia`, `joint2.damping`.
    pub fn name(self, model: &Model) -> String {
        self.name_with(self.owner(model))
    }

    /// The names of its numbers, `gravity.x`, `tool.mass`, `tool.inertia.xx`, `joint2.damping`, `base.damping.vx`, and what
    /// these must fulfil.
    pub fn numbers(self, model: &Model) -> impl Iterator<Item = (String, ParameterRule)> {
        let joint = self.link.and_then(|link| LinkJoint::of(model.links.get(link)?));
        self.numbers_with(self.owner(model), joint)
    }

    /// The names of its numbers.
    pub fn names(self, model: &Model) -> impl Iterator<Item = String> {
        self.numbers(model).map(|(name, _)| name)
    }

    fn owner(self, model: &Model) -> Option<&String> {
        let link = self.link.and_then(|link| model.links.get(link))?;
        Some(if self.quantity.is_of_joint() { &link.joint_name } else { &link.name })
    }

    fn name_with(self, owner: Option<&String>) -> String {
        owner.map_or(String::new(), |owner| format!("{owner}.")) + self.quantity.name()
    }

    /// The names of its numbers and what these must fulfil, if it belongs to the link or joint `owner`, where the joint of
    /// the link is `joint`.
    pub(crate) fn numbers_with(
        self,
        owner: Option<&String>,
        joint: Option<LinkJoint>,
    ) -> impl Iterator<Item = (String, ParameterRule)> {
        let name = self.name_with(owner);
        self.quantity.numbers(joint).into_iter().map(move |(component, rule)| (format!("{name}{component}"), rule))
    }

    /// The numbers of the model itself.
    pub fn values(self, model: &Model) -> Vec<f64> {
        Numbers::of(model).of_parameter(self).into_iter().map(|number| *number).collect()
    }
}

impl Model {
    /// The model in which `values` stand in place of the numbers of the `parameters`, in the order of their
    /// [names](RunTimeParameter::names). Values are not checked.
    ///
    /// ```
    /// use redysim_model::{Loaded, Model};
    ///
    /// # let rod = "name = 'rod'\ngravity = [0, 0, -9.81]\n\n[[link]]\nname = 'rod'\nparent = 'base'\n\
    /// #     joint = 'revolute'\naxis = [0, 1, 0]\nmass = 2.0\ncom = [0.5, 0, 0]";
    /// let Loaded { model, options, .. } = Model::from_toml_with(rod, "rod.toml", "parameters = ['rod.mass']")?;
    /// assert_eq!(model.with_parameters(&options.parameters, &[3.0]).links[0].mass, 3.0);
    /// # Ok::<(), redysim_model::Faults>(())
    /// ```
    pub fn with_parameters(&self, parameters: &[RunTimeParameter], values: &[f64]) -> Model {
        let numbers = Numbers::<f64>::of(self).with(parameters, values);
        let mut model = self.clone();
        for RunTimeParameter { quantity, link } in parameters {
            let Some((link, own)) = link.and_then(|link| Some((model.links.get_mut(link)?, numbers.links.get(link)?)))
            else {
                model.gravity = numbers.gravity;
                continue;
            };
            let each = |number: fn(&VelocityPhysics) -> f64| match &own.physics.velocities[..] {
                [only] => PerVelocity::Uniform(number(only)),
                all => PerVelocity::Each(all.iter().map(number).collect()),
            };
            match quantity {
                Quantity::Gravity => {}
                Quantity::Mass => link.mass = own.mass,
                Quantity::Com => link.com = own.com,
                Quantity::Inertia => {
                    let Sym3 { xx, yy, zz, xy, yz, xz } = own.inertia;
                    link.inertia = Inertia { xx, yy, zz, xy, yz, xz };
                }
                Quantity::Armature => link.physics.armature = each(|velocity| velocity.armature),
                Quantity::Damping => link.physics.damping = each(|velocity| velocity.damping),
                Quantity::Friction => link.physics.friction = each(|velocity| velocity.friction),
                Quantity::FrictionVelocity => {
                    link.physics.friction_velocity = each(|velocity| velocity.friction_velocity);
                }
                Quantity::Stiffness => link.physics.stiffness = each(|velocity| velocity.stiffness),
                Quantity::Rest => link.physics.rest.clone_from(&own.physics.rest),
            }
        }
        model
    }
}

/// The numbers of a model that may be given at run time.
pub(crate) struct Numbers<P> {
    pub gravity: Vec3<P>,
    pub links: Vec<LinkNumbers<P>>,
}

/// Those of a link and its joint.
pub(crate) struct LinkNumbers<P> {
    pub mass: P,
    pub com: Vec3<P>,
    /// Inertia tensor about the centre of mass.
    pub inertia: Sym3<P>,
    pub physics: BodyPhysics<P>,
}

impl<P: Parameter> Numbers<P> {
    /// The numbers of the model itself.
    pub fn of(model: &Model) -> Self {
        let link = |link: &Link| LinkNumbers {
            mass: P::from_f64(link.mass),
            com: link.com.map(P::from_f64),
            inertia: Sym3::from(link.inertia).map(P::from_f64),
            physics: LinkJoint::of(link).map_or(BodyPhysics::none(), |joint| BodyPhysics::new(&link.physics, joint)),
        };
        Numbers { gravity: model.gravity.map(P::from_f64), links: model.links.iter().map(link).collect() }
    }

    /// With `values` in place of the numbers of the parameters, in their order.
    pub fn with(mut self, parameters: &[RunTimeParameter], values: &[P]) -> Self {
        let mut values = values.iter();
        for parameter in parameters {
            for (number, value) in self.of_parameter(*parameter).into_iter().zip(&mut values) {
                *number = *value;
            }
        }
        self
    }

    /// The numbers of a parameter, in the order of their names.
    fn of_parameter(&mut self, RunTimeParameter { quantity, link }: RunTimeParameter) -> Vec<&mut P> {
        let Some(LinkNumbers { mass, com, inertia, physics }) = link.and_then(|link| self.links.get_mut(link)) else {
            return self.gravity.0.iter_mut().collect();
        };
        match quantity {
            Quantity::Gravity => self.gravity.0.iter_mut().collect(),
            Quantity::Mass => vec![mass],
            Quantity::Com => com.0.iter_mut().collect(),
            Quantity::Inertia => {
                let Sym3 { xx, yy, zz, xy, yz, xz } = inertia;
                vec![xx, yy, zz, xy, yz, xz]
            }
            Quantity::Armature => physics.velocities.iter_mut().map(|each| &mut each.armature).collect(),
            Quantity::Damping => physics.velocities.iter_mut().map(|each| &mut each.damping).collect(),
            Quantity::Friction => physics.velocities.iter_mut().map(|each| &mut each.friction).collect(),
            Quantity::FrictionVelocity => {
                physics.velocities.iter_mut().map(|each| &mut each.friction_velocity).collect()
            }
            Quantity::Stiffness => physics.velocities.iter_mut().map(|each| &mut each.stiffness).collect(),
            Quantity::Rest => physics.rest.iter_mut().collect(),
        }
    }
}
