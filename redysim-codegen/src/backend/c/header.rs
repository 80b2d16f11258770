//! The header of a mechanism in C: sizes, names, units, operation counts, types and functions.

use super::comment::{documentation, plain, statement, string};
use super::function::Writer;
use super::parametric;
use super::results::brackets;
use crate::backend::head::{VERSION, model_hash};
use redysim_model::{Function, Model};
use redysim_runtime::function::{Argument, Structure};

/// A table of a mechanism: its name after the prefix, its length by its macro, the type of its elements, what it has, and
/// its elements.
pub struct Table {
    pub name: &'static str,
    pub length: &'static str,
    element: String,
    what: &'static str,
    values: Vec<String>,
}

const STRINGS: &str = "char *const";

impl Table {
    /// Whether its elements are strings.
    pub fn is_of_strings(&self) -> bool {
        self.element == STRINGS
    }
}

/// The tables that have elements.
pub fn tables(writer: &Writer) -> Vec<Table> {
    let interface = writer.mechanism.interface;
    let strings = |name, length, what, values: Vec<&str>| {
        let values = values.into_iter().map(string).collect();
        Table { name, length, element: STRINGS.into(), what, values }
    };
    let units = writer.units;
    let texts = |units| <[String]>::iter(units).map(String::as_str).collect();
    let parameters = &interface.parameters;
    let number = writer.scalar.type_name().to_string();
    let actuated = interface.actuated().map(|actuated| u8::from(actuated).to_string()).collect();
    let all = vec![
        strings(
            "joint_names",
            "NJ",
            "Names of the joints that move, in the model's order.",
            interface.joints.iter().map(|joint| joint.name.as_str()).collect(),
        ),
        strings("coordinate_names", "NQ", "Names of the joint coordinates.", interface.coordinate_names().collect()),
        strings(
            "coordinate_units",
            "NQ",
            "Units of the joint coordinates; \"1\" for a component of a quaternion.",
            texts(&units.coordinates),
        ),
        strings("velocity_names", "NV", "Names of the joint velocities.", interface.velocity_names().collect()),
        strings("velocity_units", "NV", "Units of the joint velocities.", texts(&units.velocities)),
        strings("force_units", "NV", "Units of the joint forces.", texts(&units.forces)),
        Table {
            name: "actuated",
            length: "NV",
            element: "unsigned char".into(),
            what: "Whether each joint velocity has an actuator.",
            values: actuated,
        },
        strings("link_names", "NL", "Names of the links.", interface.links.iter().map(String::as_str).collect()),
        strings(
            "loop_names",
            "NC",
            "Name of the loop to which each row of the loop constraints belongs.",
            interface.loop_rows.iter().map(String::as_str).collect(),
        ),
        strings(
            "frame_names",
            "NF",
            "Names of the frames of interest.",
            interface.frames.iter().map(String::as_str).collect(),
        ),
        strings(
            "parameter_names",
            "NP",
            "Names of the run-time parameters.",
            parameters.iter().map(|parameter| parameter.name.as_str()).collect(),
        ),
        strings("parameter_units", "NP", "Units of the run-time parameters.", texts(&units.parameters)),
        strings(
            "parameter_rules",
            "NP",
            "What each run-time parameter must be.",
            parameters.iter().map(|parameter| parametric::rule(parameter.rule)).collect(),
        ),
        Table {
            name: "parameters",
            length: "NP",
            element: number,
            what: "The values that the run-time parameters have in the model.",
            values: parameters.iter().map(|parameter| writer.scalar.literal(parameter.value)).collect(),
        },
    ];
    all.into_iter().filter(|table| !table.values.is_empty()).collect()
}

/// The definitions of the tables.
pub fn definitions_of_tables(writer: &Writer) -> String {
    let definition = |Table { name, length, element, values, .. }: Table| {
        let (name, length) = (writer.prefix.item(name), writer.prefix.constant(length));
        // A line for each, however long, since a string does not go on in the next.
        let values: String = values.iter().map(|value| format!("    {value},\n")).collect();
        format!("const {element} {name}[{length}] = {{\n{values}}};\n")
    };
    tables(writer).into_iter().map(definition).collect()
}

/// The whole header; `head` is its first comment.
pub fn header(writer: &Writer, model: &Model, head: &str) -> String {
    let (prefix, interface) = (writer.prefix, writer.mechanism.interface);
    let guard = prefix.constant("H");
    let mut text = format!("{head}#ifndef {guard}\n#define {guard}\n\n#ifdef __cplusplus\nextern \"C\" {{\n#endif\n\n");
    let mut define = |name: &str, value: String, what: &str| {
        text += &documentation([what]);
        text += &format!("#define {} {value}\n", prefix.constant(name));
    };
    define("NAME", string(&interface.name), "Name of the model.");
    define("REDYSIM_VERSION", string(VERSION), "Version of redysim that made this file.");
    define("MODEL_HASH", string(&format!("{:016x}", model_hash(model))), "A number by which the model is recognised.");
    let sizes = [
        ("NJ", interface.joints.len(), "Number of joints that move."),
        ("NQ", interface.coordinate_names().count(), "Number of joint coordinates."),
        ("NV", interface.velocity_names().count(), "Number of joint velocities."),
        ("NL", interface.links.len(), "Number of links."),
        ("NC", interface.loop_rows.len(), "Number of rows of the loop constraints."),
        ("NF", interface.frames.len(), "Number of frames of interest."),
        ("NP", interface.parameters.len(), "Number of run-time parameters."),
        ("NA", writer.mechanism.trig.angles.len(), "Number of angles whose sines and cosines functions share."),
    ];
    for (name, size, what) in sizes {
        define(name, size.to_string(), what);
    }
    let with_parameters = if writer.is_parametric() { ", with the parameters of the model" } else { "" };
    define("MASS", writer.scalar.literal(interface.mass), &format!("Mass of all links, kg{with_parameters}."));
    text += "\n";
    text += &documentation([
        "Operations of a call of each function: additions, multiplications, divisions, and sines with cosines.",
    ]);
    for program in writer.functions() {
        let count = program.operations;
        let numbers = [
            ("ADDITIONS", count.additions),
            ("MULTIPLICATIONS", count.multiplications),
            ("DIVISIONS", count.divisions),
            ("SINE_COSINE_PAIRS", count.trig),
        ];
        for (what, number) in numbers {
            let name = prefix.constant(&format!("{}_{what}", program.function.name().to_ascii_uppercase()));
            text += &format!("#define {name} {number}\n");
        }
    }
    text += "\n";
    for Table { name, length, element, what, .. } in tables(writer) {
        text += &documentation([what]);
        text += &format!("extern const {element} {}[{}];\n", prefix.item(name), prefix.constant(length));
    }
    for structure in structures(writer) {
        text += &format!("\n{}", declaration(writer, &structure));
    }
    if let Some(lumped) = &writer.mechanism.lumped {
        text += &format!("\n{}", parametric::declarations(writer, lumped));
    }
    if writer.has_trig() {
        text += &format!("\n{}", joint_trig(writer));
    }
    for program in writer.functions() {
        text += &format!("\n{}", writer.declarations(program));
    }
    text + "\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n"
}

/// The structs of the functions' arguments and results, each once.
fn structures(writer: &Writer) -> Vec<Structure> {
    let functions: Vec<Function> = writer.functions().map(|program| program.function).collect();
    let takes_wrenches = functions.iter().any(|function| function.signature().arguments.contains(&Argument::Wrenches));
    let wrench = Argument::Wrenches.form().structure.filter(|_| takes_wrenches);
    let results = functions.iter().filter_map(|function| function.signature().result.form().structure);
    results.chain(wrench).collect()
}

fn declaration(writer: &Writer, Structure { name, what, fields }: &Structure) -> String {
    let number = writer.scalar.type_name();
    let fields: String = fields
        .iter()
        .map(|(field, lengths, what)| {
            format!("    /** {}. */\n    {number} {field}{};\n", plain(what), brackets(lengths, writer.prefix))
        })
        .collect();
    format!("{}typedef struct {{\n{fields}}} {};\n", documentation([what]), writer.prefix.type_of(name))
}

/// The struct of joint trigonometry and the function that computes it.
fn joint_trig(writer: &Writer) -> String {
    let (prefix, number) = (writer.prefix, writer.scalar.type_name());
    let (nq, na) = (prefix.constant("NQ"), prefix.constant("NA"));
    let structure = documentation([
        "The coordinates with the sines and cosines of all angles, computed once for every function whose name ends in \
         _with_trig. Angles of single joints come first, in the order of the coordinates, then sums.",
    ]) + &format!(
        "typedef struct {{\n    {number} q[{nq}];\n    {number} sines[{na}];\n    {number} cosines[{na}];\n}} {};\n",
        prefix.type_of("joint_trig")
    );
    let function = documentation(["The coordinates with the sines and cosines of all angles."])
        + &statement(0, &format!("{};", writer.head_of_joint_trig()));
    format!("{structure}\n{function}")
}
