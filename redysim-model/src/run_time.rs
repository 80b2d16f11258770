//! Run-time parameters: the numbers of a model that a program gives when it runs.

use crate::inertia::Sym3;
use crate::joint::JointPhysics;
use crate::model::{Link, Model};
use crate::parameter::Parameter;
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
    /// The coordinate at which a joint's spring is relaxed, rad or m.
    Rest,
}

const SCALAR: &[&str] = &[""];
const VECTOR: &[&str] = &[".x", ".y", ".z"];
const TENSOR: &[&str] = &[".xx", ".yy", ".zz", ".xy", ".yz", ".xz"];

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

    /// Whether it belongs to a joint that moves, not to a body.
    pub fn is_of_joint(self) -> bool {
        !matches!(self, Quantity::Gravity | Quantity::Mass | Quantity::Com | Quantity::Inertia)
    }

    /// What is appended to the name for each of its numbers.
    fn components(self) -> &'static [&'static str] {
        match self {
            Quantity::Gravity | Quantity::Com => VECTOR,
            Quantity::Inertia => TENSOR,
            _ => SCALAR,
        }
    }

    /// What its numbers must fulfil.
    pub fn rule(self) -> ParameterRule {
        match self {
            Quantity::Gravity | Quantity::Com | Quantity::Rest => ParameterRule::Finite,
            Quantity::Inertia => ParameterRule::Inertia,
            Quantity::FrictionVelocity => ParameterRule::Positive,
            _ => ParameterRule::NotNegative,
        }
    }
}

impl RunTimeParameter {
    /// Its name in a model file: `gravity`, `tool.mass`, `tool.inertia`, `joint2.damping`.
    pub fn name(self, model: &Model) -> String {
        self.name_with(self.owner(model))
    }

    /// The names of its numbers: `gravity.x`, `tool.mass`, `tool.inertia.xx`, `joint2.damping`.
    pub fn names(self, model: &Model) -> impl Iterator<Item = String> {
        self.names_with(self.owner(model))
    }

    fn owner(self, model: &Model) -> Option<&String> {
        let link = self.link.and_then(|link| model.links.get(link))?;
        Some(if self.quantity.is_of_joint() { &link.joint_name } else { &link.name })
    }

    fn name_with(self, owner: Option<&String>) -> String {
        owner.map_or(String::new(), |owner| format!("{owner}.")) + self.quantity.name()
    }

    /// The names of its numbers, if it belongs to the link or joint `owner`.
    pub(crate) fn names_with(self, owner: Option<&String>) -> impl Iterator<Item = String> {
        let name = self.name_with(owner);
        self.quantity.components().iter().map(move |component| format!("{name}{component}"))
    }

    /// The numbers of the model itself.
    pub fn values(self, model: &Model) -> Vec<f64> {
        Numbers::of(model).of_parameter(self).into_iter().map(|number| *number).collect()
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
    pub physics: JointPhysics<P>,
}

impl<P: Parameter> Numbers<P> {
    /// The numbers of the model itself.
    pub fn of(model: &Model) -> Self {
        let link = |link: &Link| LinkNumbers {
            mass: P::from_f64(link.mass),
            com: link.com.map(P::from_f64),
            inertia: Sym3::from(link.inertia).map(P::from_f64),
            physics: link.physics.map(P::from_f64),
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
            Quantity::Armature => vec![&mut physics.armature],
            Quantity::Damping => vec![&mut physics.damping],
            Quantity::Friction => vec![&mut physics.friction],
            Quantity::FrictionVelocity => vec![&mut physics.friction_velocity],
            Quantity::Stiffness => vec![&mut physics.stiffness],
            Quantity::Rest => vec![&mut physics.rest],
        }
    }
}
