//! What is asked of the model: things that it has.

use crate::diagnostic::{Findings, messages};
use crate::scene::{Functions, Scene};
use crate::schema::{Document, Entry};

/// The functions that only a mechanism with loops has begin with this.
const OF_LOOPS: &str = "loop_";

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
    Some(Scene { functions })
}
