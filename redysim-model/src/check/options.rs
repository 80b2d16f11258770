//! What is asked of the model: things that it has.

use crate::messages;
use crate::model::Link;
use crate::options::{AccelerationMethod, CodegenOptions};
use crate::schema::{Document, Entry, LinkTable};
use redysim_runtime::{Function, Functions};
use redysim_toml::Findings;

/// The options, if they have no fault.
pub(super) fn check(document: &Document, findings: &mut Findings) -> Option<CodegenOptions> {
    let Entry { text, value: functions } = &document.options.functions;
    let requested = functions.value().into_iter().flat_map(|requested| &requested.0);
    for requested in requested {
        let function = *requested.get_ref();
        let message = match () {
            _ if function.needs_loops() && document.loops.is_empty() => messages::function_of_loops,
            _ if function.needs_frames() && document.frames.is_empty() => messages::function_of_frames,
            _ if function.needs_passive_joints() && !document.has_passive_joints() => {
                messages::function_of_passive_joints
            }
            _ => continue,
        };
        findings.within(*text, |findings| findings.error(requested.span(), message(&document.item, function)));
    }
    let functions = if functions.is_missing() { Functions::ALL } else { functions.value()?.set() };
    let forward_dynamics = &document.options.forward_dynamics.value;
    let forward_dynamics =
        if forward_dynamics.is_missing() { AccelerationMethod::Auto } else { *forward_dynamics.value()? };
    let Entry { text, value: parameters } = &document.options.parameters;
    for parameter in parameters.value().into_iter().flatten() {
        let link = parameter.get_ref().link.and_then(|link| document.links.get(link));
        if let Some(link) = link.filter(|link| parameter.get_ref().quantity.is_of_joint() && link.is_rigid()) {
            findings.within(*text, |findings| {
                findings.error(parameter.span(), messages::parameter_of_fixed(&document.item, &link.item));
            });
        }
    }
    let parameters: Vec<_> =
        if parameters.is_missing() { Vec::new() } else { parameters.value()?.iter().map(|p| *p.get_ref()).collect() };
    Some(CodegenOptions { functions, tolerance: tolerance(document, findings)?, forward_dynamics, parameters })
}

/// Leaves out what only the tree could do, whose mass matrix is singular because of `link`, though closed loops move:
/// forward dynamics. To ask for it by name is a fault.
pub(super) fn without_dynamics_of_tree(
    document: &Document,
    link: &Link,
    options: Option<&mut CodegenOptions>,
    findings: &mut Findings,
) {
    let Entry { text, value: functions } = &document.options.functions;
    let solving = Function::ForwardDynamics;
    let requested = functions.value().into_iter().flat_map(|requested| &requested.0);
    for function in requested.filter(|function| *function.get_ref() == solving) {
        findings.within(*text, |findings| {
            let message = messages::singular_tree(&document.item, solving, &link.name, &link.joint_name);
            findings.error(function.span(), message);
        });
    }
    if let Some(options) = options {
        options.functions = options.functions.without(solving);
    }
}

/// The tolerance, which needs the range of every joint that moves, with an acceleration; `Some(None)` without one.
fn tolerance(document: &Document, findings: &mut Findings) -> Option<Option<f64>> {
    let Entry { text, value: tolerance } = &document.options.tolerance;
    if tolerance.is_missing() {
        return Some(None);
    }
    let given = tolerance.spanned()?;
    let joints_where = |lacks: fn(&LinkTable) -> bool| -> Vec<&str> {
        let links = document.links.iter().filter(|link| link.is_independent() && lacks(link));
        links.filter_map(|link| link.joint_name()).map(|name| name.get_ref().as_str()).collect()
    };
    let without_acceleration = |link: &LinkTable| {
        link.range.value().is_some_and(|ranges| ranges.iter().any(|range| range.acceleration.is_none()))
    };
    let lacking = [
        ("no range", joints_where(|link| link.range.is_missing())),
        ("a range without an acceleration", joints_where(without_acceleration)),
    ];
    for (what, joints) in lacking.into_iter().filter(|(_, joints)| !joints.is_empty()) {
        findings.within(*text, |findings| {
            findings.error(given.span(), messages::no_range(&document.item, what, &joints));
        });
    }
    Some(Some(*given.get_ref()))
}
