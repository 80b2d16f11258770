//! What is asked of the model: things that it has.

use crate::diagnostic::{Findings, messages};
use crate::model::Link;
use crate::scene::{AccelerationMethod, Functions, Scene};
use crate::schema::{Document, Entry};

/// The functions that only a mechanism with loops has begin with this.
const OF_LOOPS: &str = "loop_";

/// The function that solves with the mass matrix of the tree.
const OF_TREE: &str = "forward_dynamics";

/// The scene, if it has no fault.
pub(super) fn check(document: &Document, findings: &mut Findings) -> Option<Scene> {
    let Entry { text, said } = &document.scene.functions;
    let asked = said.value().into_iter().flat_map(|names| &names.0);
    for name in asked.filter(|name| name.get_ref().starts_with(OF_LOOPS) && document.loops.is_empty()) {
        findings.within(*text, |findings| {
            findings.error(name.span(), messages::function_of_loops(&document.item, name.get_ref()));
        });
    }
    let functions = if said.is_missing() { Functions::ALL } else { said.value()?.set() };
    let forward_dynamics = &document.scene.forward_dynamics.said;
    let forward_dynamics =
        if forward_dynamics.is_missing() { AccelerationMethod::Auto } else { *forward_dynamics.value()? };
    Some(Scene { functions, tolerance: tolerance(document, findings)?, forward_dynamics })
}

/// Leaves out what only the tree could do, whose mass matrix is singular because of `link`, though closed loops move: forward
/// dynamics. To ask for it by name is a fault.
pub(super) fn without_dynamics_of_tree(
    document: &Document,
    link: &Link,
    scene: Option<&mut Scene>,
    findings: &mut Findings,
) {
    let Entry { text, said } = &document.scene.functions;
    let asked = said.value().into_iter().flat_map(|names| &names.0);
    for name in asked.filter(|name| *name.get_ref() == OF_TREE) {
        findings.within(*text, |findings| {
            findings.error(name.span(), messages::singular_tree(&document.item, OF_TREE, &link.name, &link.joint_name));
        });
    }
    if let Some(scene) = scene {
        scene.functions = scene.functions.without(OF_TREE);
    }
}

/// The tolerance, which needs the range of every joint that moves; `Some(None)` without one.
fn tolerance(document: &Document, findings: &mut Findings) -> Option<Option<f64>> {
    let Entry { text, said } = &document.scene.tolerance;
    if said.is_missing() {
        return Some(None);
    }
    let given = said.spanned()?;
    let without = document.links.iter().filter(|link| !link.is_rigid() && link.range.is_missing());
    let without: Vec<&str> = without.filter_map(|link| link.joint_name()).map(|name| name.get_ref().as_str()).collect();
    if !without.is_empty() {
        findings.within(*text, |findings| {
            findings.error(given.span(), messages::no_range(&document.item, &without));
        });
    }
    Some(Some(*given.get_ref()))
}
