//! A mechanism as programs and data, the input of a backend.

use crate::angles::{Angle, Angles};
use crate::documentation;
use crate::functions::TracedFunction;
use crate::generate::TracedMechanism;
use crate::program::{NamingContext, Program, program};
use crate::siblings::SideBySide;
use redysim_model::joint::LinkJoint;
use redysim_model::{Body, Function, Model, PublicInterface, Tree};
use redysim_runtime::OperationCount;

/// A mechanism for a backend. Every choice is made: a backend only prints it.
#[derive(Clone, Debug)]
pub struct MechanismProgram<'a> {
    /// Names and sizes.
    pub interface: &'a PublicInterface,
    /// The sines and cosines of all angles, which functions share.
    pub trig: TrigProgram,
    /// The functions, in the order of [`Function::ALL`].
    pub functions: Vec<FunctionProgram>,
    /// What depends on run-time parameters alone, if there are any: a function of them, whose outputs are the numbers
    /// that the programs are [given](crate::program::Value::Given).
    pub lumped: Option<Program>,
}

/// A function of a mechanism.
#[derive(Clone, Debug)]
pub struct FunctionProgram {
    /// Which one it is.
    pub function: Function,
    /// The paragraphs of its documentation, in Markdown.
    pub documentation: Vec<String>,
    /// Its operations.
    pub operations: OperationCount,
    /// The sines and cosines that it needs.
    pub trig: TrigProgram,
    /// The computation after the sines and cosines. Its input has those of all angles, of which it reads some.
    pub program: Program,
}

/// How sines and cosines are computed: of some coordinates whole turns are taken off, angles are summed from these and
/// from other coordinates, and the sines and cosines of all angles are computed together.
#[derive(Clone, Debug)]
pub struct TrigProgram {
    /// The coordinates of which whole turns are taken off, in order.
    pub without_turns: Vec<u32>,
    /// The angles.
    pub angles: Vec<Angle>,
    /// For each angle of the mechanism, its index in `angles`; `None` if it is not needed.
    pub places: Vec<Option<usize>>,
}

impl<'a> MechanismProgram<'a> {
    /// The programs of a mechanism that was traced. No variable has a name in `reserved`, which the backend
    /// defines.
    pub fn new(
        model: &Model,
        interface: &'a PublicInterface,
        TracedMechanism { functions, siblings, lumped, .. }: &TracedMechanism,
        reserved: &[&str],
    ) -> MechanismProgram<'a> {
        let tree = Tree::new(model);
        let bodies = body_names(model, &tree);
        let angles = Angles::of(functions.iter().map(|traced| &traced.expressions));
        let function = |traced: &TracedFunction| {
            let arguments = traced.function.signature().arguments.iter().map(|argument| argument.name());
            let reserved: Vec<&str> = arguments.chain(reserved.iter().copied()).collect();
            FunctionProgram {
                function: traced.function,
                documentation: documentation::paragraphs(traced, model),
                operations: traced.expressions.count(),
                trig: TrigProgram::new(&angles, &angles.needed_by(&traced.expressions)),
                program: program(
                    &traced.expressions,
                    SideBySide::of(&traced.expressions, traced.function, siblings).as_ref(),
                    &NamingContext { reserved: &reserved, bodies: &bodies, angles: &angles },
                ),
            }
        };
        MechanismProgram {
            interface,
            trig: TrigProgram::new(&angles, &Vec::from_iter(0..angles.len())),
            functions: functions.iter().map(function).collect(),
            lumped: lumped.as_ref().map(|expressions| {
                program(expressions, None, &NamingContext { reserved, bodies: &bodies, angles: &angles })
            }),
        }
    }
}

impl TrigProgram {
    /// Computes the angles at the positions `needed`, which are in order.
    fn new(angles: &Angles, needed: &[usize]) -> TrigProgram {
        TrigProgram {
            without_turns: angles.summed(needed.iter().copied()),
            angles: angles.at(needed.iter().copied()).cloned().collect(),
            places: (0..angles.len()).map(|position| needed.binary_search(&position).ok()).collect(),
        }
    }

    /// Whether its angles are all those of the mechanism, in their order.
    pub fn is_complete(&self) -> bool {
        self.places.iter().enumerate().all(|(angle, place)| *place == Some(angle))
    }
}

/// The names of the bodies of `tree`: each is that of its link. Of a link whose joint is several in series, the bodies but
/// the last are named by their joint's component too.
fn body_names(model: &Model, tree: &Tree) -> Vec<String> {
    let name = |(index, body): (usize, &Body)| {
        let link = &model.links[body.link];
        match tree.links.get(body.link).and_then(|attachment| attachment.body) {
            Some(last) if last != index => {
                let first = tree.bodies.iter().filter(|other| other.link == body.link).map(|other| other.v.start).min();
                let component = body.v.start - first.unwrap_or(body.v.start);
                let names = LinkJoint::of(link).map_or(&[][..], LinkJoint::velocity_names);
                format!("{}_{}", link.name, names.get(component).unwrap_or(&""))
            }
            _ => link.name.clone(),
        }
    };
    tree.bodies.iter().enumerate().map(name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In the file, the tool precedes the arm that carries it. Its joint has the sizes of a free joint.
    #[test]
    fn bodies_have_the_names_of_their_links_however_many_velocities_joints_have() {
        let text = "name = 'r'\ngravity = [0, 0, -10]\n[[link]]\nname = 'tool'\nparent = 'arm'\njoint = 'revolute'\n\
                    dh = {}\nmass = 1\ncom = [1, 0, 0]\n[[link]]\nname = 'arm'\nparent = 'base'\njoint = 'revolute'\n\
                    dh = {}\nmass = 1\ncom = [1, 0, 0]";
        let model = Model::from_toml(text, "r.toml").expect("a good model").model;
        let mut tree = Tree::new(&model);
        let [arm, tool] = tree.bodies.as_mut_slice() else { panic!("two bodies") };
        (tool.q, tool.v) = (0..7, 0..6);
        (arm.q, arm.v) = (7..8, 6..7);
        assert_eq!(body_names(&model, &tree), ["arm", "tool"]);
    }
}
