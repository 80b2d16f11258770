//! Docstrings of the functions, in the form that NumPy's documentation has.

use redysim_runtime::Function;
use redysim_runtime::function::{Form, Length};

/// The docstring of a function: what it computes, and shapes and units of what it takes and returns.
pub fn of(function: Function) -> String {
    let signature = function.signature();
    let mut text = format!("{}\n", wrapped(signature.summary, 0));
    let result = signature.result.form();
    text += "\nParameters\n----------\n";
    for argument in signature.arguments {
        text += &entry(function, argument.name(), &argument.form());
    }
    let out = "What is returned, to be written to: an array of the dtype and the shape of the result, such as an earlier \
               result. It must not overlap an argument.";
    text += &format!("out : numpy.ndarray, optional\n{}\n", wrapped(out, 4));
    let many =
        if signature.arguments.is_empty() { "" } else { " An argument of one state counts for each of k states." };
    format!("{text}\nReturns\n-------\n{}{}", entry(function, result.name, &result), wrapped(many.trim(), 0))
        .trim_end()
        .to_owned()
}

/// A parameter or a result.
fn entry(function: Function, name: &str, form: &Form) -> String {
    // The six numbers of a wrench are an axis of the array; parts of a result have names.
    let Some(structure) = form.structure else {
        let what = sentence(&with_units(function, name, form.what));
        return format!("{name} : float64, {}\n{}\n", shapes(form.lengths, ""), wrapped(&what, 4));
    };
    if name == "wrenches" {
        let what = format!("{}: force (N), then moment about the frame's origin (N m).", form.what);
        return format!("{name} : float64, {}\n{}\n", shapes(form.lengths, "6"), wrapped(&what, 4));
    }
    let parts: String = structure
        .fields
        .iter()
        .map(|(part, lengths, what)| {
            let shape = if lengths.is_empty() { String::new() } else { format!(", each {}", shape(lengths, "")) };
            wrapped(&format!("- `{part}`{shape}: {}", sentence(&with_units(function, part, what))), 4) + "\n"
        })
        .collect();
    let what = wrapped(&format!("{}, as a record array with the parts", form.what), 4);
    format!("{name} : numpy.recarray, {}\n{what}\n\n{parts}", shapes(form.lengths, ""))
}

/// What an argument, a result or a part of one is, with the units where the table leaves them to the function.
fn with_units(function: Function, name: &str, what: &str) -> String {
    let units = match (function, name) {
        (Function::CoordinateRates, "result") => "rad/s or m/s; of components of quaternions 1/s",
        (Function::Integrate | Function::Neutral, "result") => "rad or m; components of quaternions are dimensionless",
        (Function::HybridDynamics, "u") => "rad/s² or m/s²; of forces N m or N",
        (Function::LoopResidual, "result") => "m; dimensionless where it aligns directions",
        (Function::LoopJacobian, "jacobian") => {
            "m/rad, or dimensionless for sliding joints; 1/rad or 1/m where it aligns directions"
        }
        (Function::LoopBias, "result") => "m/s²; 1/s² where it aligns directions",
        (Function::FrameJacobians, "linear") => "m/rad, or dimensionless for sliding joints",
        (Function::FrameJacobians, "angular") => "dimensionless, or rad/m for sliding joints",
        (_, "rotation") => "dimensionless",
        _ => return what.to_owned(),
    };
    format!("{what} ({units})")
}

fn sentence(what: &str) -> String {
    format!("{}.", what.trim_end_matches('.'))
}

/// The shapes of one state and of k states.
fn shapes(lengths: &[Length], last: &str) -> String {
    let (one, many) = (shape(lengths, last), axes(lengths, last));
    let many = if many.is_empty() { "(k,)".into() } else { format!("(k, {})", many.join(", ")) };
    format!("{one} or {many}")
}

fn shape(lengths: &[Length], last: &str) -> String {
    match &axes(lengths, last)[..] {
        [one] => format!("({one},)"),
        all => format!("({})", all.join(", ")),
    }
}

fn axes(lengths: &[Length], last: &str) -> Vec<String> {
    let name = |length: &Length| match length {
        Length::Size(dimension) => dimension.name().to_lowercase(),
        Length::Three => "3".into(),
    };
    lengths.iter().map(name).chain((!last.is_empty()).then(|| last.into())).collect()
}

/// Lines of at most 88 characters, with an indentation.
fn wrapped(text: &str, indentation: usize) -> String {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= 88 => *line += &format!(" {word}"),
            Some(_) if text.starts_with("- ") => lines.push(format!("{}{word}", " ".repeat(indentation + 2))),
            _ => lines.push(" ".repeat(indentation) + word),
        }
    }
    lines.join("\n")
}
