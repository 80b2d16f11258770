//! The model description of an FMU: its variables with units, and which depend on which.

use super::FmiVersion;
use super::variables::{Role, Variable, Variables, exponents};
use crate::backend::c::comment::plain;
use crate::backend::head::VERSION;
use crate::functions::TracedFunction;
use crate::generate::TracedMechanism;
use redysim_model::Function;
use redysim_runtime::function::Argument;
use std::collections::{BTreeMap, BTreeSet};

/// What a model description is of.
pub struct Description<'a> {
    pub version: FmiVersion,
    /// The name of the model, and the prefix of names in C.
    pub names: [&'a str; 2],
    pub variables: &'a Variables,
    /// For each computed variable, those on which it depends.
    pub dependencies: &'a BTreeMap<usize, BTreeSet<usize>>,
}

/// For each derivative and output, the inputs and states on which it depends: those that its expression reads.
pub fn dependencies(traced: &TracedMechanism, variables: &Variables) -> BTreeMap<usize, BTreeSet<usize>> {
    let of = |function: Function| traced.functions.iter().find(move |traced| traced.function == function);
    let results = [
        (Function::CoordinateRates, &variables.rates),
        (Function::ForwardDynamics, &variables.a),
        (Function::Energy, &variables.energy),
    ];
    let all = results.into_iter().filter_map(|(function, results)| Some((of(function)?, results.clone())));
    let computed = all.flat_map(|(TracedFunction { function, expressions, .. }, results)| {
        let reference = |(argument, index): (u8, u32)| {
            let first = match function.signature().arguments[usize::from(argument)] {
                Argument::Coordinates => variables.q.start,
                Argument::Velocities => variables.v.start,
                _ => variables.tau.start,
            };
            first + index as usize
        };
        let inputs = expressions.inputs_of_outputs();
        results.zip(inputs).map(move |(result, inputs)| (result, inputs.into_iter().map(reference).collect()))
    });
    let states = variables.q.clone().chain(variables.v.clone()).map(|state| (state, BTreeSet::from([state])));
    computed.chain(states).collect()
}

/// The file `modelDescription.xml`.
pub fn xml(description: &Description, token: &str) -> String {
    let Description { version, names: [model, prefix], variables, .. } = description;
    let is_3 = *version == FmiVersion::V3;
    let (token_name, convention) = (
        if is_3 { "instantiationToken" } else { "guid" },
        if variables.are_structured() { "structured" } else { "flat" },
    );
    let indicators = if is_3 { "" } else { " numberOfEventIndicators=\"0\"" };
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"{}\" modelName=\"{}\" \
         {token_name}=\"{token}\" description=\"Dynamics of the mechanism {}\" generationTool=\"redysim {VERSION}\" \
         variableNamingConvention=\"{convention}\"{indicators}>\n",
        version.name(),
        attribute(model),
        attribute(model),
    );
    text += &if is_3 {
        let both = format!("modelIdentifier=\"{prefix}\" canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\"");
        format!(
            "  <ModelExchange {both} needsCompletedIntegratorStep=\"false\"/>\n  <CoSimulation {both} \
             canHandleVariableCommunicationStepSize=\"true\"/>\n"
        )
    } else {
        let both = format!(
            "modelIdentifier=\"{prefix}\" canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\" \
             canSerializeFMUstate=\"true\""
        );
        let files = format!(
            "    <SourceFiles>\n      <File name=\"{prefix}.c\"/>\n      <File name=\"{prefix}_fmu.c\"/>\n    </SourceFiles>\n"
        );
        format!(
            "  <ModelExchange {both} completedIntegratorStepNotNeeded=\"true\">\n{files}  </ModelExchange>\n  \
             <CoSimulation {both} canHandleVariableCommunicationStepSize=\"true\">\n{files}  </CoSimulation>\n"
        )
    };
    text += "  <UnitDefinitions>\n";
    let units: BTreeSet<&str> = variables.all.iter().map(|variable| variable.unit.as_str()).collect();
    for unit in units {
        let base: String = ["kg", "m", "s", "rad"]
            .iter()
            .zip(exponents(unit))
            // FMI 2 knows the radian as a base unit, too.
            .filter(|(_, exponent)| *exponent != 0)
            .map(|(name, exponent)| format!(" {name}=\"{exponent}\""))
            .collect();
        text += &format!("    <Unit name=\"{unit}\"><BaseUnit{base}/></Unit>\n");
    }
    text += "  </UnitDefinitions>\n  <LogCategories>\n    <Category name=\"logStatusDiscard\"/>\n    \
             <Category name=\"logStatusError\"/>\n  </LogCategories>\n  \
             <DefaultExperiment startTime=\"0\" stopTime=\"1\" tolerance=\"1e-6\"/>\n  <ModelVariables>\n";
    for (reference, variable) in variables.all.iter().enumerate() {
        text += &of_variable(*version, reference, variable);
    }
    text += "  </ModelVariables>\n  <ModelStructure>\n";
    text + &structure(description) + "  </ModelStructure>\n</fmiModelDescription>\n"
}

fn of_variable(version: FmiVersion, reference: usize, variable: &Variable) -> String {
    let Variable { name, description, unit, role, derivative_of } = variable;
    let (causality, variability, initial) = match role {
        Role::Time => ("independent", "continuous", None),
        Role::Parameter { .. } => ("parameter", "fixed", Some("exact")),
        Role::Input => ("input", "continuous", None),
        Role::State { .. } => ("output", "continuous", Some("exact")),
        Role::Rate => ("local", "continuous", Some("calculated")),
        Role::Output => ("output", "continuous", Some("calculated")),
    };
    let initial = initial.map_or(String::new(), |initial| format!(" initial=\"{initial}\""));
    let general = format!(
        "name=\"{}\" valueReference=\"{reference}\" description=\"{}\" causality=\"{causality}\" \
         variability=\"{variability}\"{initial}",
        attribute(name),
        attribute(description)
    );
    let mut number = format!("unit=\"{unit}\"");
    if let Role::Parameter { not_negative: true, .. } = role {
        number += " min=\"0\"";
    }
    if let Some(start) = role.start() {
        number += &format!(" start=\"{start:?}\"");
    }
    if let Some(of) = derivative_of {
        // In FMI 2 it is the place among all variables, from 1.
        number += &format!(" derivative=\"{}\"", version.reference(*of));
    }
    match version {
        FmiVersion::V3 => format!("    <Float64 {general} {number}/>\n"),
        FmiVersion::V2 => format!("    <ScalarVariable {general}><Real {number}/></ScalarVariable>\n"),
    }
}

/// The outputs, the derivatives of the states, and what is computed at the start.
fn structure(Description { version, variables, dependencies, .. }: &Description) -> String {
    let Variables { q, v, rates, a, energy, .. } = variables;
    let unknown = |element: &str, unknown: usize, with_dependencies: bool| {
        let list = dependencies.get(&unknown).filter(|_| with_dependencies).map(|dependencies| {
            let list: Vec<String> =
                dependencies.iter().map(|&reference| version.reference(reference).to_string()).collect();
            format!(" dependencies=\"{}\"", list.join(" "))
        });
        let name = if *version == FmiVersion::V3 { "valueReference" } else { "index" };
        let list = list.unwrap_or_default();
        format!("<{element} {name}=\"{}\"{list}/>\n", version.reference(unknown))
    };
    let outputs = || q.clone().chain(v.clone()).chain(a.clone()).chain(energy.clone());
    let derivatives = || rates.clone().chain(a.clone());
    let computed = || rates.clone().chain(a.clone()).chain(energy.clone());
    match version {
        FmiVersion::V3 => [
            outputs().map(|output| format!("    {}", unknown("Output", output, true))).collect::<String>(),
            derivatives().map(|rate| format!("    {}", unknown("ContinuousStateDerivative", rate, true))).collect(),
            // All that is known may matter: parameters do, too.
            computed().map(|rate| format!("    {}", unknown("InitialUnknown", rate, false))).collect(),
        ]
        .concat(),
        FmiVersion::V2 => {
            let list = |name: &str, all: &mut dyn Iterator<Item = usize>, with_dependencies: bool| {
                let all: String =
                    all.map(|each| format!("      {}", unknown("Unknown", each, with_dependencies))).collect();
                format!("    <{name}>\n{all}    </{name}>\n")
            };
            list("Outputs", &mut outputs(), true)
                + &list("Derivatives", &mut derivatives(), true)
                + &list("InitialUnknowns", &mut computed(), false)
        }
    }
}

/// The value of an attribute.
fn attribute(text: &str) -> String {
    plain(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// The file `sources/buildDescription.xml` of FMI 3.
pub fn build_description(prefix: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiBuildDescription fmiVersion=\"3.0\">\n  \
         <BuildConfiguration modelIdentifier=\"{prefix}\">\n    <SourceFileSet language=\"C99\">\n      \
         <SourceFile name=\"{prefix}.c\"/>\n      <SourceFile name=\"{prefix}_fmu.c\"/>\n    </SourceFileSet>\n  \
         </BuildConfiguration>\n</fmiBuildDescription>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::attribute;

    #[test]
    fn no_name_ends_an_attribute() {
        assert_eq!(attribute("a\"<b>&\n"), "a&quot;&lt;b&gt;&amp;\\n");
    }
}
