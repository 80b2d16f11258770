//! One function of a mechanism in C: of coordinates, and of precomputed joint trigonometry.

use super::body::{COSINES, GIVEN, Printer, SINES};
use super::comment::{documentation, statement};
use super::names::Prefix;
use super::results::InC;
use super::scalar::{CScalar, Numbers};
use super::units::Units;
use crate::angles::{Angle, Term};
use crate::mechanism::{FunctionProgram, MechanismProgram, TrigProgram};
use crate::policies::LONGEST_UNROLLED;
use crate::program::{Program, Value};
use redysim_model::{Function, PublicInterface};
use redysim_runtime::function::{Argument, Dimension, Form};

/// The name of the argument that has the coordinates with the sines and cosines.
const TRIG: &str = "trig";
/// The name of the argument that has the numbers that are given at run time.
pub const ROBOT: &str = "robot";
/// The coordinates of which whole turns are taken off.
const NEAR: &str = "near";
/// The numbers of the wrenches in one array.
const WRENCH_NUMBERS: &str = "wrench_numbers";

/// Writes functions of one mechanism.
#[derive(Clone, Copy)]
pub struct Writer<'a> {
    pub mechanism: &'a MechanismProgram<'a>,
    pub prefix: &'a Prefix,
    pub scalar: CScalar,
    pub units: &'a Units,
}

/// How a function is called: which arguments precede those of its signature after the coordinates.
#[derive(Clone, Copy, PartialEq)]
enum Call {
    /// Of coordinates.
    Plain,
    /// Of joint trigonometry.
    WithTrig,
    /// Of coordinates and the arrays of sines and cosines.
    Inlined,
}

impl Writer<'_> {
    fn interface(&self) -> &PublicInterface {
        self.mechanism.interface
    }

    /// Whether the mechanism has numbers that are given at run time.
    pub fn is_parametric(&self) -> bool {
        !self.interface().parameters.is_empty()
    }

    /// Whether the mechanism has angles, and so joint trigonometry.
    pub fn has_trig(&self) -> bool {
        !self.mechanism.trig.angles.is_empty()
    }

    /// The functions whose results have numbers.
    pub fn functions(&self) -> impl Iterator<Item = &FunctionProgram> {
        let interface = self.interface();
        self.mechanism
            .functions
            .iter()
            .filter(|program| !program.function.signature().result.form().is_empty(interface))
    }

    /// Whether a function has a form of joint trigonometry: where it needs sines and cosines.
    pub fn has_form_with_trig(&self, program: &FunctionProgram) -> bool {
        !program.trig.angles.is_empty() && !program.function.is_always_present()
    }

    /// The declarations of a function for the header, with documentation.
    pub fn declarations(&self, program: &FunctionProgram) -> String {
        let (function, signature) = (program.function, program.function.signature());
        let result = signature.result.form();
        let mut lines: Vec<String> = Vec::new();
        for paragraph in &program.documentation {
            lines.extend(paragraph.lines().map(String::from));
            lines.push(String::new());
        }
        let arguments =
            signature.arguments.iter().map(|argument| format!("{}: {}.", argument.name(), argument.form().what));
        lines.extend(arguments.map(|line| format!("- {line}")));
        lines.push(format!("- {}: {}.", result.name, result.what));
        let mut text = documentation(lines) + &statement(0, &format!("{};", self.head(function, Call::Plain)));
        if self.has_form_with_trig(program) {
            let line =
                format!("{} with sines and cosines that are already computed.", self.prefix.item(function.name()));
            text += &documentation([line]);
            text += &statement(0, &format!("{};", self.head(function, Call::WithTrig)));
        }
        text
    }

    /// The definitions of a function. The code after the sines and cosines is a function of its own, which both forms
    /// call.
    pub fn definitions(&self, program: &FunctionProgram) -> String {
        let function = program.function;
        let body = self.body(program);
        if program.trig.angles.is_empty() {
            return self.definition(&self.head(function, Call::Plain), program, &body);
        }
        // Inlined, so that sines and cosines of a short function do not go through memory.
        let is_long = program.operations.flops() > LONGEST_UNROLLED;
        let linkage = if is_long { "REDYSIM_SHARED" } else { "REDYSIM_INLINE" };
        let inlined = format!("{linkage} {}", self.head(function, Call::Inlined));
        let mut text = self.definition(&inlined, program, &body);
        let call = self.call(function, "q", [SINES, COSINES]);
        let plain = self.sines_and_cosines(&program.trig, true) + &statement(1, &call);
        text += &format!("\n{}{{\n{plain}}}\n", statement(0, &self.head(function, Call::Plain)));
        if self.has_form_with_trig(program) {
            let call = self.call(
                function,
                &format!("{TRIG}->q"),
                ["sines", "cosines"].map(|array| format!("{TRIG}->{array}")),
            );
            let head = self.head(function, Call::WithTrig);
            text += &format!("\n{}{{\n{}}}\n", statement(0, &head), statement(1, &call));
        }
        text
    }

    /// A function whose parameters are all used, if only by name.
    fn definition(&self, head: &str, program: &FunctionProgram, body: &str) -> String {
        let signature = program.function.signature();
        let mut names: Vec<&str> = signature.arguments.iter().map(|argument| argument.name()).collect();
        if !program.trig.angles.is_empty() {
            names.extend([SINES, COSINES]);
        }
        if self.is_parametric() {
            names.insert(0, ROBOT);
        }
        let unused = names.iter().filter(|name| !has_word(body, name));
        let unused: String = unused.map(|name| statement(1, &format!("(void){name};"))).collect();
        format!("{}{{\n{unused}{body}}}\n", statement(0, head))
    }

    /// The statements of a function after the sines and cosines.
    fn body(&self, program: &FunctionProgram) -> String {
        let signature = program.function.signature();
        let arguments: Vec<&str> = signature.arguments.iter().map(|argument| self.array(*argument)).collect();
        let places = signature.result.form().places(self.interface());
        let code = self.code(&program.program, &arguments, &places);
        let wrenches = if has_word(&code, WRENCH_NUMBERS) { self.wrench_numbers() } else { String::new() };
        let given = if has_word(&code, GIVEN) { self.given() } else { String::new() };
        format!("{given}{wrenches}{code}")
    }

    /// The statements of a program that stores its outputs at `places`. They are stored last, so that an array may be
    /// argument and result.
    pub fn code(&self, program: &Program, arguments: &[&str], places: &[String]) -> String {
        self.code_over(Numbers::One(self.scalar), program, arguments, places)
    }

    /// The same over numbers of one state or of several.
    pub fn code_over(&self, numbers: Numbers, program: &Program, arguments: &[&str], places: &[String]) -> String {
        let printer = Printer { numbers, arguments };
        let mut text = printer.statements(&program.statements, 1);
        let mut stores = String::new();
        for (number, (output, place)) in program.outputs.iter().zip(places).enumerate() {
            let mut value = printer.whole(output);
            if !is_ready(output) {
                let name = format!("out_{number}");
                text += &printer.definition(&name, &value, 1);
                value = name;
            }
            stores += &statement(1, &format!("{place} = {value};"));
        }
        text + &stores
    }

    /// The name of the array of an argument's numbers.
    fn array(&self, argument: Argument) -> &'static str {
        if argument == Argument::Wrenches { WRENCH_NUMBERS } else { argument.name() }
    }

    fn wrench_numbers(&self) -> String {
        let numbers = Argument::Wrenches.form().places(self.interface()).join(", ");
        let number = self.scalar.type_name();
        statement(1, &format!("const {number} {WRENCH_NUMBERS}[] = {{{numbers}}};"))
    }

    fn given(&self) -> String {
        statement(1, &format!("const {} *{GIVEN} = {ROBOT}->{GIVEN};", self.scalar.type_name()))
    }

    /// The statements that compute the sines and cosines of `trig`, in arrays of those of all angles of the mechanism if
    /// `all`.
    fn sines_and_cosines(&self, trig: &TrigProgram, all: bool) -> String {
        self.sines_and_cosines_over(Numbers::One(self.scalar), trig, all)
    }

    /// The same over numbers of one state or of several.
    pub fn sines_and_cosines_over(&self, numbers: Numbers, trig: &TrigProgram, all: bool) -> String {
        let (number, count) = (numbers.type_name(), trig.angles.len());
        let of_angles = numbers.trigonometry("sin_cos");
        let mut text = String::new();
        let turning: Vec<String> = trig.without_turns.iter().map(|coordinate| format!("q[{coordinate}]")).collect();
        if !turning.is_empty() {
            let turns = turning.len();
            text += &statement(1, &format!("{number} {NEAR}[{turns}] = {{{}}};", turning.join(", ")));
            // One after the other, whichever states they are of.
            let all_near = match numbers {
                Numbers::One(_) | Numbers::Branches(..) => format!("{turns}, {NEAR}"),
                Numbers::Lanes => format!("{turns} * REDYSIM_LANES, (double *){NEAR}"),
            };
            text += &statement(1, &format!("redysim_without_turns({all_near});"));
        }
        let room = if numbers == Numbers::Lanes { count.to_string() } else { format!("REDYSIM_ROOM({count})") };
        let angles = consecutive_coordinates(&trig.angles).unwrap_or_else(|| {
            let angles: Vec<String> = trig.angles.iter().map(|angle| self.angle(angle, trig)).collect();
            text += &statement(1, &format!("const {number} angles[] = {{{}}};", angles.join(", ")));
            "angles".into()
        });
        if trig.is_complete() || !all {
            text += &statement(1, &format!("{number} {SINES}[{room}], {COSINES}[{room}];"));
            return text + &statement(1, &format!("{of_angles}({count}, {angles}, {SINES}, {COSINES});"));
        }
        text += &statement(1, &format!("{number} some_sines[{room}], some_cosines[{room}];"));
        text += &statement(1, &format!("{number} {SINES}[{0}], {COSINES}[{0}];", trig.places.len()));
        text += &statement(1, &format!("{of_angles}({count}, {angles}, some_sines, some_cosines);"));
        for (index, place) in trig.places.iter().enumerate() {
            if let Some(place) = place {
                text += &statement(1, &format!("{SINES}[{index}] = some_sines[{place}];"));
                text += &statement(1, &format!("{COSINES}[{index}] = some_cosines[{place}];"));
            }
        }
        text
    }

    /// An angle as an expression of the coordinates, of which some are read without whole turns.
    fn angle(
        &self,
        Angle { terms, constant }: &Angle,
        TrigProgram { without_turns: turning, .. }: &TrigProgram,
    ) -> String {
        let mut sum = String::new();
        for (place, Term { coordinate, factor, without_turns }) in terms.iter().enumerate() {
            let near = turning.iter().position(|turning| *without_turns && turning == coordinate);
            let value = near.map_or(format!("q[{coordinate}]"), |place| format!("{NEAR}[{place}]"));
            let sign = match (place, *factor < 0.0) {
                (0, false) => "",
                (0, true) => "-",
                (_, false) => " + ",
                (_, true) => " - ",
            };
            let size = factor.abs();
            let scale = if size == 1.0 { String::new() } else { format!("{} * ", self.scalar.literal(size)) };
            sum += &format!("{sign}{scale}{value}");
        }
        if *constant != 0.0 {
            let sign = if *constant < 0.0 { '-' } else { '+' };
            sum += &format!(" {sign} {}", self.scalar.literal(constant.abs()));
        }
        sum
    }

    /// The function that computes the sines and cosines of all angles: its head.
    pub fn head_of_joint_trig(&self) -> String {
        let q = self.parameter(Argument::Coordinates);
        let robot = self.robot();
        let trig = self.prefix.type_of("joint_trig");
        format!("void {}({robot}{q}, {trig} *{TRIG})", self.prefix.item("joint_trig"))
    }

    /// The function that computes the sines and cosines of all angles.
    pub fn joint_trig(&self) -> String {
        let (nq, count) = (self.interface().size(Dimension::Coordinates), self.mechanism.trig.angles.len());
        let robot = if self.is_parametric() { statement(1, &format!("(void){ROBOT};")) } else { String::new() };
        let sines_and_cosines = self.sines_and_cosines(&self.mechanism.trig, false);
        let copies: String = [("q", "q", nq), (SINES, SINES, count), (COSINES, COSINES, count)]
            .into_iter()
            .map(|(field, array, count)| {
                statement(1, &format!("for (int i = 0; i < {count}; i++) {{"))
                    + &statement(2, &format!("{TRIG}->{field}[i] = {array}[i];"))
                    + &statement(1, "}")
            })
            .collect();
        format!("{}{{\n{robot}{sines_and_cosines}{copies}}}\n", statement(0, &self.head_of_joint_trig()))
    }

    /// The argument with the numbers that are given at run time, if there are any.
    pub fn robot(&self) -> String {
        if self.is_parametric() { format!("const {}_t *{ROBOT}, ", self.prefix.as_str()) } else { String::new() }
    }

    fn parameter(&self, argument: Argument) -> String {
        let (element, length) = self.element_and_length(argument);
        format!("const {element} {}[{length}]", argument.name())
    }

    /// The type of an argument's elements, and how many there are.
    pub fn element_and_length(&self, argument: Argument) -> (String, String) {
        let element = argument.form().element(self.scalar.type_name(), self.prefix);
        (element, self.prefix.constant(argument.dimension().name()))
    }

    fn head(&self, function: Function, call: Call) -> String {
        let signature = function.signature();
        let mut parameters: Vec<String> =
            signature.arguments.iter().map(|argument| self.parameter(*argument)).collect();
        let result: Form = signature.result.form();
        parameters.push(result.parameter(self.scalar.type_name(), self.prefix));
        let name = match call {
            Call::Plain => self.prefix.item(function.name()),
            Call::WithTrig => {
                parameters[0] = format!("const {} *{TRIG}", self.prefix.type_of("joint_trig"));
                self.prefix.item(&format!("{}_with_trig", function.name()))
            }
            Call::Inlined => {
                let array = |name: &str| {
                    format!("const {} {name}[{}]", self.scalar.type_name(), self.mechanism.trig.angles.len())
                };
                parameters.splice(1..1, [array(SINES), array(COSINES)]);
                self.prefix.item(&format!("{}_inlined", function.name()))
            }
        };
        format!("void {name}({}{})", self.robot(), parameters.join(", "))
    }

    /// The call of the inlined form.
    fn call(&self, function: Function, q: &str, [sines, cosines]: [impl AsRef<str>; 2]) -> String {
        let signature = function.signature();
        let others = signature.arguments.iter().skip(1).map(|argument| argument.name());
        let robot = if self.is_parametric() { format!("{ROBOT}, ") } else { String::new() };
        let arguments: Vec<&str> = [q, sines.as_ref(), cosines.as_ref()].into_iter().chain(others).collect();
        let name = self.prefix.item(&format!("{}_inlined", function.name()));
        format!("{name}({robot}{}, {});", arguments.join(", "), signature.result.form().name)
    }
}

/// The coordinates as an array, from the first of `angles` on, if the angles are coordinates in a row. They need no copy, which
/// compilers would put together number by number.
fn consecutive_coordinates(angles: &[Angle]) -> Option<String> {
    let first = angles.first()?.coordinate()?;
    let are_consecutive = angles.iter().zip(first..).all(|(angle, place)| angle.coordinate() == Some(place));
    are_consecutive.then(|| if first == 0 { "q".into() } else { format!("&q[{first}]") })
}

/// Whether a value does not depend on what an argument points to.
fn is_ready(value: &Value) -> bool {
    match value {
        Value::Variable(_) | Value::Constant(_) | Value::LiveOut(..) | Value::OfBranch { .. } => true,
        Value::Negative(value) => is_ready(value),
        _ => false,
    }
}

/// Whether `text` has the identifier `word`.
fn has_word(text: &str, word: &str) -> bool {
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    text.match_indices(word).any(|(start, _)| {
        let (before, after) = (&text[..start], &text[start + word.len()..]);
        !before.ends_with(is_part) && !after.starts_with(is_part)
    })
}
