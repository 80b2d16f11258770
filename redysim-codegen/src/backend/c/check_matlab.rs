//! A function of MATLAB and Octave that checks the compiled gateway, as the program of [`check`](super::check) checks C.

use super::check::{Expected, Reference, STATES, numbers, takes};
use super::comment::percent;
use super::function::Writer;
use redysim_runtime::function::Argument;

/// The length of a line.
const WIDTH: usize = 110;

/// The file `prefix_check.m`.
pub fn check(writer: &Writer, reference: &Reference) -> String {
    let name = writer.prefix.as_str();
    let mut text = format!("function {name}_check()\n");
    text += &percent([
        format!(
            "{}_CHECK  Calls every function of {name} at {STATES} states, and compares the results with those of redysim's run-time \
                 path.",
            name.to_uppercase()
        ),
        String::new(),
        "  An error names the functions that differ by more than rounding errors can.".into(),
    ]);
    let given = |argument: &Argument| writer.functions().any(|program| takes(program.function, *argument));
    for argument in Argument::ALL.into_iter().filter(given) {
        let of_state = |state: &_| {
            let numbers = numbers(state, argument).iter().map(|number| format!("{number:?}"));
            format!(
                "    reshape([{}], {}, []), ...\n",
                wrapped(numbers, ", ", " ...\n        "),
                match argument.numbers() {
                    1 => numbers_of_argument(writer, argument),
                    several => several,
                }
            )
        };
        let states: String = reference.states.iter().map(of_state).collect();
        text += &format!("{} = {{ ...\n{states}}};\n", argument.name());
    }
    let parameters = if writer.is_parametric() {
        let values = reference.parameters.iter().map(|value| format!("{value:?}"));
        text += &format!("parameters = [{}];\n", wrapped(values, ", ", " ...\n    "));
        "{{}, {parameters}, {parameters}}"
    } else {
        "{{}, {}, {}}"
    };
    text += &format!("others = {parameters};\nfaults = {{}};\n");
    for program in writer.functions() {
        let function = program.function;
        let names: Vec<&str> = function.signature().arguments.iter().map(|argument| argument.name()).collect();
        let (_, values) =
            reference.values.iter().find(|(other, _)| *other == function).expect("every function has values");
        for (state, values) in values.iter().enumerate().map(|(index, values)| (index + 1, values)) {
            let arguments: String = names.iter().map(|name| format!(", {name}{{{state}}}")).collect();
            text += &format!(
                "faults = [faults, compare('{function}', {state}, {name}('{function}'{arguments}, others{{{state}}}{{:}}), [ ...\n    {}])];\n",
                wrapped(values.iter().map(pair), "; ", "\n    ")
            );
        }
    }
    text + &format!(
        "if ~isempty(faults)\n    error('redysim:check', '{name}: rounding errors do not explain\\n%s', sprintf('%s\\n', faults{{:}}));\n\
         end\nfprintf('{name}: all results are within rounding errors\\n');\nend\n{COMPARE}"
    )
}

fn numbers_of_argument(writer: &Writer, argument: Argument) -> usize {
    writer.mechanism.interface.size(argument.dimension())
}

/// A value and how far it may be off, rounded up.
fn pair(expected: &Expected) -> String {
    let bound = if expected.bound.is_finite() { format!("{:.1e}", 1.1 * expected.bound) } else { "Inf".into() };
    format!("{:?} {bound}", expected.value)
}

/// Texts on lines.
fn wrapped(texts: impl Iterator<Item = String>, separator: &str, end_of_line: &str) -> String {
    let (mut all, mut line) = (String::new(), 0);
    for text in texts {
        if !all.is_empty() {
            all += separator;
            if line + text.len() > WIDTH {
                all.truncate(all.trim_end().len());
                all += end_of_line;
                line = 0;
            }
        }
        line += text.len() + separator.len();
        all += &text;
    }
    all
}

const COMPARE: &str = "
function faults = compare(name, state, result, expected)
% A line for each number that is off by more than the bound beside the expected value.
faults = {};
found = numbers(result);
if numel(found) ~= size(expected, 1)
    faults = {sprintf('%s: %d numbers instead of %d', name, numel(found), size(expected, 1))};
    return
end
for i = find(~(abs(found - expected(:, 1)) <= expected(:, 2)))'
    faults{end + 1} = sprintf('%s: state %d, number %d is %.17g instead of %.17g, where rounding errors are at most %.1e', ...
        name, state, i, found(i), expected(i, 1), expected(i, 2));
end
end

function list = numbers(result)
% The numbers of a result, matrices by rows.
if ~isstruct(result)
    list = reshape(result.', [], 1);
    return
end
list = [];
names = fieldnames(result);
for i = 1:numel(result)
    for j = 1:numel(names)
        list = [list; numbers(result(i).(names{j}))];
    end
end
end
";
