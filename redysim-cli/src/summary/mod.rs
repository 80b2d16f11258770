//! What a model is, for a person to check at a glance and for programs to read.

mod table;

use redysim_codegen::Counted;
use redysim_codegen::passes::PassError;
use redysim_model::{Link, Loaded, Mobility, Model, Spring, Tree};
use redysim_runtime::OperationCount;
use serde::{Serialize, Serializer};

/// A model in numbers. The names of the fields are the keys of `redysim check --json`: they stay.
#[derive(Debug, Serialize)]
pub struct Summary {
    /// Name of the mechanism.
    pub name: String,
    /// Acceleration of gravity in the base frame, m/s².
    pub gravity: [f64; 3],
    /// Mass of all links, kg.
    pub mass: f64,
    /// Joint velocities of the tree, NV.
    pub dof: usize,
    /// Independent joint velocities, with the loops closed.
    pub mobility: usize,
    /// Constraints of all loops together, NC.
    pub loop_constraints: usize,
    /// How many of them are independent.
    pub loop_rank: usize,
    /// Names of the joints that have an actuator for each of their velocities.
    pub actuated: Vec<String>,
    /// Names of the joints that move and have none, or not for each of their velocities.
    pub passive: Vec<String>,
    /// The links, in the file's order.
    pub links: Vec<LinkSummary>,
    /// The loops, in the file's order.
    pub loops: Vec<LoopSummary>,
    /// The springs between points, in the file's order.
    pub springs: Vec<SpringSummary>,
    /// Operations of each compiled function.
    pub operations: Vec<FunctionSummary>,
    /// What is rarely meant: the titles of named warnings and of notes about the model, and the generator's warnings.
    pub lints: Vec<String>,
    /// The generator's warnings alone.
    #[serde(skip)]
    pub generator_warnings: Vec<String>,
}

/// A link and its joint.
#[derive(Debug, Serialize)]
pub struct LinkSummary {
    /// Name of the link.
    pub name: String,
    /// Name of the link that carries it, or "base".
    pub parent: String,
    /// Name of the joint.
    pub joint: String,
    /// The name of its [`JointKind`](redysim_model::JointKind): "revolute", "prismatic",
    /// "helical", "spherical", "free" or "fixed".
    pub kind: &'static str,
    /// The joint that it mimics; null where it does not mimic one.
    pub mimics: Option<String>,
    /// Whether the joint has an actuator for each of its velocities; null where it does not have velocities of its own.
    pub actuated: Option<bool>,
    /// Whether each of its velocities has one.
    #[serde(skip)]
    pub actuated_velocities: Vec<bool>,
    /// Mass, kg.
    pub mass: f64,
}

/// A cut joint.
#[derive(Debug, Serialize)]
pub struct LoopSummary {
    /// Name of the loop.
    pub name: String,
    /// "revolute", "spherical" or "weld".
    pub kind: &'static str,
    /// The link on side a, or "base".
    pub link_a: String,
    /// The link on side b, or "base".
    pub link_b: String,
    /// Its constraints that do not hold at every position.
    pub constraints: usize,
    /// How many of these do not follow from the loops before it.
    pub rank: usize,
}

/// A spring with a damper between two points.
#[derive(Debug, Serialize)]
pub struct SpringSummary {
    /// Name of the spring; null if the file gives none.
    pub name: Option<String>,
    /// The link at end a, or "base".
    pub link_a: String,
    /// The link at end b, or "base".
    pub link_b: String,
    /// Stiffness, N/m.
    pub stiffness: f64,
    /// Damping, N s/m.
    pub damping: f64,
    /// Free length, m.
    pub length: f64,
}

/// What a compiled function costs.
#[derive(Debug, Serialize)]
pub struct FunctionSummary {
    /// Name of the function.
    pub function: &'static str,
    /// Its operations.
    #[serde(flatten, serialize_with = "counts")]
    pub count: OperationCount,
}

fn counts<S: Serializer>(count: &OperationCount, serializer: S) -> Result<S::Ok, S::Error> {
    use serde::ser::SerializeMap;
    let OperationCount { additions, multiplications, divisions, trig } = *count;
    let mut map = serializer.serialize_map(Some(5))?;
    map.serialize_entry("flops", &count.flops())?;
    map.serialize_entry("additions", &additions)?;
    map.serialize_entry("multiplications", &multiplications)?;
    map.serialize_entry("divisions", &divisions)?;
    map.serialize_entry("sine_cosine_pairs", &trig)?;
    map.end()
}

impl Summary {
    /// Of a checked model, without operations: these take the time of tracing every function, which of a long model is
    /// most of it.
    pub fn of(loaded: &Loaded) -> Summary {
        let model = &loaded.model;
        let found = Mobility::of(model);
        let named = loaded.warnings.iter().filter(|warning| warning.lint().is_some());
        let titles = named.chain(&loaded.notes).map(|found| found.title().to_string());
        let joints = |actuated: bool| {
            let is_actuated = |link: &Link| link.actuated_velocities().into_iter().all(|actuated| actuated);
            let chosen = model.moving_links().filter(move |link| is_actuated(link) == actuated);
            chosen.map(|link| link.joint_name.clone()).collect()
        };
        Summary {
            name: model.name.clone(),
            gravity: model.gravity.0,
            mass: model.mass(),
            dof: model.dof(),
            mobility: found.mobility,
            loop_constraints: found.constraints,
            loop_rank: found.rank,
            actuated: joints(true),
            passive: joints(false),
            links: model.links.iter().map(|link| link_summary(model, link)).collect(),
            loops: loop_summaries(model, &found.added),
            springs: model.springs.iter().map(|spring| spring_summary(model, spring)).collect(),
            operations: Vec::new(),
            lints: titles.collect(),
            generator_warnings: Vec::new(),
        }
    }

    /// Counts the operations of each compiled function of the model.
    ///
    /// # Errors
    ///
    /// If the generator's check of itself fails.
    pub fn count(&mut self, loaded: &Loaded) -> Result<(), PassError> {
        let Counted { operations, warnings } = redysim_codegen::operations(&loaded.model, &loaded.options)?;
        let has_loops = !loaded.model.loops.is_empty();
        let counted = operations.into_iter().filter(|(function, _)| has_loops || !function.needs_loops());
        self.operations =
            counted.map(|(function, count)| FunctionSummary { function: function.name(), count }).collect();
        self.lints.extend(warnings.iter().cloned());
        self.generator_warnings = warnings;
        Ok(())
    }
}

fn link_summary(model: &Model, link: &Link) -> LinkSummary {
    LinkSummary {
        name: link.name.clone(),
        parent: link_name(model, link.parent),
        joint: link.joint_name.clone(),
        kind: link.joint.name(),
        actuated: (link.dof() > 0).then(|| link.actuated_velocities().into_iter().all(|actuated| actuated)),
        mimics: link.mimic.map(|mimic| model.links[mimic.link].joint_name.clone()),
        actuated_velocities: if link.dof() > 0 { link.actuated_velocities() } else { Vec::new() },
        mass: link.mass,
    }
}

fn loop_summaries(model: &Model, added: &[usize]) -> Vec<LoopSummary> {
    let cuts = Tree::new(model).cuts;
    let summary = |((cut, constraints), &rank): ((&redysim_model::Loop, usize), &usize)| LoopSummary {
        name: cut.name.clone(),
        kind: cut.joint.name(),
        link_a: link_name(model, cut.a.link),
        link_b: link_name(model, cut.b.link),
        constraints,
        rank,
    };
    let constraints = cuts.iter().map(|cut| cut.rows.iter().filter(|kept| **kept).count());
    model.loops.iter().zip(constraints).zip(added).map(summary).collect()
}

fn spring_summary(model: &Model, spring: &Spring) -> SpringSummary {
    SpringSummary {
        name: spring.name.clone(),
        link_a: link_name(model, spring.a.link),
        link_b: link_name(model, spring.b.link),
        stiffness: spring.stiffness,
        damping: spring.damping,
        length: spring.length,
    }
}

fn link_name(model: &Model, link: Option<usize>) -> String {
    link.map_or("base".to_string(), |link| model.links[link].name.clone())
}
