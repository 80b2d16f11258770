//! A mechanism as Rust: `impl`s of a type, over any `S: Scalar`.

mod angles;
mod body;
mod configuration;
pub mod documentation;
mod function;
mod results;
#[cfg(feature = "source")]
pub mod source;
mod traits;

use crate::angles::Angles;
use crate::functions::TracedFunction;
use function::{Writer, head, head_with_trig, joint_trig_head};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use redysim_model::{Function, Model, PublicInterface, Tree};
use redysim_runtime::OperationCount;
use redysim_runtime::function::Dimension;

/// The `impl`s of the type `name` with the given functions.
pub fn mechanism(
    model: &Model,
    interface: &PublicInterface,
    functions: &[TracedFunction],
    name: &Ident,
    runtime: &TokenStream,
) -> TokenStream {
    let tree = Tree::new(model);
    let bodies = body_names(model, &tree);
    let angles = Angles::of(functions.iter().map(|function| &function.expressions));
    let writer = Writer { model, bodies: &bodies, angles: &angles, interface, runtime };
    let definitions =
        std::iter::once(writer.joint_trig()).chain(functions.iter().map(|function| writer.function(function)));
    let operations: Vec<_> = functions.iter().map(|traced| (traced.function, traced.expressions.count())).collect();
    type_impls(interface, Some(&tree), name, runtime, &operations, definitions.collect())
}

/// The names of the bodies of `tree`: each is that of its moving link. Velocities are in the order of the joints, and a
/// joint may have several.
fn body_names(model: &Model, tree: &Tree) -> Vec<String> {
    let mut names = vec![String::new(); tree.bodies.len()];
    for (link, body) in model.moving_links().zip(tree.bodies_by_joint()) {
        names[body].clone_from(&link.name);
    }
    names
}

/// The `impl`s of a type whose model has faults: every item has its type, but no function a body, so that the faults of
/// the model are the only errors.
pub fn stub(interface: &PublicInterface, name: &Ident, runtime: &TokenStream) -> TokenStream {
    let angles = interface.size(Dimension::Coordinates);
    let joint_trig = joint_trig_head(interface, angles, runtime);
    let functions = interface.functions.iter();
    let heads = functions.flat_map(|function| {
        [head(function, interface, runtime), head_with_trig(function, interface, angles, runtime)]
    });
    let definitions = std::iter::once(joint_trig).chain(heads).map(|head| quote!(pub #head { ::core::unreachable!() }));
    type_impls(interface, None, name, runtime, &[], definitions.collect())
}

fn type_impls(
    interface: &PublicInterface,
    tree: Option<&Tree>,
    name: &Ident,
    runtime: &TokenStream,
    operations: &[(Function, OperationCount)],
    definitions: Vec<TokenStream>,
) -> TokenStream {
    let constants = constants(interface, operations, runtime);
    let mechanism = traits::mechanism(interface, tree, name, runtime);
    let closure = traits::closure(interface, name, runtime);
    let traits = interface.functions.iter().map(|function| traits::own(function, interface, name, runtime));
    quote! {
        #[allow(dead_code, unused_variables, non_snake_case, clippy::all, clippy::pedantic)]
        impl #name {
            #constants
            #(#definitions)*
        }
        #mechanism
        #(#traits)*
        #closure
    }
}

/// A size of the mechanism, as the length of an array.
fn length(interface: &PublicInterface, dimension: Dimension) -> Literal {
    Literal::usize_unsuffixed(interface.size(dimension))
}

fn constants(
    interface: &PublicInterface,
    operations: &[(Function, OperationCount)],
    runtime: &TokenStream,
) -> TokenStream {
    let PublicInterface { name, links, joints, loop_rows, mass, .. } = interface;
    let (nj, joints) = (Literal::usize_unsuffixed(joints.len()), joints.iter().map(|joint| &joint.name));
    let actuated = interface.actuated();
    let sizes = [Dimension::Coordinates, Dimension::Velocities, Dimension::Links, Dimension::LoopRows];
    let [nq, nv, nl, nc] = sizes.map(|dimension| length(interface, dimension));
    let counts = operations.iter().map(|(function, count)| {
        let field = format_ident!("{}", function.name());
        let [additions, multiplications, divisions, trig] =
            [count.additions, count.multiplications, count.divisions, count.trig].map(Literal::u32_unsuffixed);
        quote!(#field: #runtime::OperationCount {
            additions: #additions, multiplications: #multiplications, divisions: #divisions, trig: #trig,
        })
    });
    quote! {
        /// Name of the model.
        pub const NAME: &'static str = #name;
        /// Number of joint coordinates.
        pub const NQ: usize = #nq;
        /// Number of joint velocities.
        pub const NV: usize = #nv;
        /// Number of links.
        pub const NL: usize = #nl;
        /// Number of rows of the loop constraints.
        pub const NC: usize = #nc;
        /// Mass of all links, kg.
        pub const MASS: f64 = #mass;
        /// Names of the links, in the model's order.
        pub const LINK_NAMES: [&'static str; #nl] = [#(#links),*];
        /// Names of the joints that move, in the model's order.
        pub const JOINT_NAMES: [&'static str; #nj] = [#(#joints),*];
        /// Name of the loop to which each row of the loop constraints belongs.
        pub const LOOP_NAMES: [&'static str; #nc] = [#(#loop_rows),*];
        /// Whether each joint velocity has an actuator.
        pub const ACTUATED: [bool; #nv] = [#(#actuated),*];
        /// Operations of each function.
        pub const OPS: #runtime::Operations = #runtime::Operations { #(#counts,)* ..#runtime::Operations::NONE };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tool stands before the arm that carries it, and its joint has as many coordinates and velocities as a free
    /// one.
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
