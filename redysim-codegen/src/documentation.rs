//! The documentation of a generated function.

use crate::functions::TracedFunction;
use crate::pruning::Pruning;
use redysim_model::joint::{LinkJoint, Measure};
use redysim_model::{Function, JointRange, Model, MovingJoint};
use redysim_runtime::OperationCount;
use redysim_runtime::function::Shape;

/// The paragraphs of a function.
pub fn paragraphs(traced: &TracedFunction, model: &Model) -> Vec<String> {
    let TracedFunction { function, method, expressions, pruning } = traced;
    let mut paragraphs = vec![function.signature().summary.to_string()];
    paragraphs.extend(method.map(|choice| choice.to_string()));
    paragraphs.push(cost(&expressions.count()));
    if let Some(pruning) = pruning {
        paragraphs.push(pruned(pruning, *function));
        paragraphs.push(ranges(model));
    }
    paragraphs
}

/// The compiler warning for a function whose tolerance did not hold.
pub fn warning(traced: &TracedFunction) -> Option<String> {
    let Pruning { tolerance, worst, states, .. } = traced.pruning.filter(|pruning| !pruning.holds)?;
    Some(format!(
        "`{}` is not pruned: the tolerance {tolerance:?} did not hold, the worst error of {states} sampled \
         states was {worst:.1e} of {}",
        traced.function.name(),
        scale(traced.function),
    ))
}

fn cost(count: &OperationCount) -> String {
    let OperationCount { additions, multiplications, divisions, trig } = count;
    format!(
        "{} flops: {additions} additions, {multiplications} multiplications, {divisions} divisions; {trig} sine-cosine \
         pairs.",
        count.flops()
    )
}

fn pruned(Pruning { tolerance, before, worst, states, holds }: &Pruning, function: Function) -> String {
    if !holds {
        return format!("Not pruned: a tolerance of {tolerance:?} did not hold in {states} sampled states.");
    }
    format!(
        "Pruned to a tolerance of {tolerance:?}: {} flops and {} sine-cosine pairs before. The worst error of {states} \
         sampled states within the ranges below is {worst:.1e} of {}.",
        before.flops(),
        before.trig,
        scale(function),
    )
}

/// The scale of which an error is a share.
fn scale(function: Function) -> &'static str {
    match function.signature().result {
        Shape::MassMatrix => "√(M_ii M_jj) at its largest",
        Shape::Accelerations => "each joint's largest acceleration",
        _ => "each joint's force: the one stated for it, else its largest",
    }
}

fn ranges(model: &Model) -> String {
    let line = |(name, measure, range): (&String, Measure, JointRange)| {
        let (unit, force_unit) = if measure == Measure::Angle { ("rad", "N m") } else { ("m", "N") };
        let JointRange { position: [least, largest], velocity, acceleration, force } = range;
        let acceleration = acceleration.map_or(String::new(), |acceleration| format!(", ±{acceleration:.4} {unit}/s²"));
        let motion = format!("{least:.4} to {largest:.4} {unit}, ±{velocity:.4} {unit}/s{acceleration}");
        let force = force.map_or(String::new(), |force| format!(", force {force} {force_unit}"));
        format!("- `{name}`: {motion}{force}")
    };
    let names = MovingJoint::all(model).into_iter().map(|joint| joint.velocities);
    let lines = model.moving_links().zip(names).flat_map(|(link, names)| {
        let measures = LinkJoint::of(link).map(LinkJoint::velocity_measures).unwrap_or_default();
        let each = names.iter().zip(measures).zip(&link.range);
        each.map(|((name, measure), range)| line((name, measure, *range))).collect::<Vec<_>>()
    });
    lines.collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::functions::trace_model;
    use crate::passes::Passes;
    use redysim_model::CodegenOptions;

    #[test]
    fn a_tolerance_that_does_not_hold_is_a_warning() {
        let text = "name = 'rod'\ngravity = [0, -10, 0]\n[[link]]\nname = 'rod'\nparent = 'base'\njoint = 'revolute'\n\
                    dh = {}\nmass = 1\ncom = [1, 0, 0]\n\
                    range = { position = [0, 1], velocity = 1, acceleration = 1 }";
        let model = Model::from_toml(text, "rod.toml").expect("a good model").model;
        let options = CodegenOptions { tolerance: Some(0.01), ..CodegenOptions::default() };
        let mut function = trace_model(&model, &options, &Passes::all()).expect("a range").swap_remove(0);
        assert_eq!(warning(&function), None);
        function.pruning = function.pruning.map(|pruning| Pruning { worst: 0.02, holds: false, ..pruning });
        assert_eq!(
            warning(&function).as_deref(),
            Some(
                "`inverse_dynamics` is not pruned: the tolerance 0.01 did not hold, the worst error of 100000 sampled \
                 states was 2.0e-2 of each joint's force: the one stated for it, else its largest"
            )
        );
        assert!(paragraphs(&function, &model).iter().any(|line| line.starts_with("Not pruned: a tolerance of 0.01")));
    }
}
