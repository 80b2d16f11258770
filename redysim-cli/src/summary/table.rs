//! The summary as a text: what the model is, then what its functions cost.

use super::{LinkSummary, Summary};
use crate::number::{counted, rounded};
use crate::output::visible_name;
use redysim_model::JointKind;
use std::fmt::{Display, Formatter, Result};

/// A title, and what stands below it.
type Column = (&'static str, fn(&LinkSummary) -> String);

impl Display for Summary {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let row = |f: &mut Formatter<'_>, name: &str, value: String| writeln!(f, "  {name:<11}{value}");
        writeln!(f, "{}", visible_name(&self.name))?;
        row(f, "links", format!("{}, {} kg in all", self.links.len(), rounded(self.mass)))?;
        row(f, "joints", self.kinds())?;
        row(f, "mobility", self.mobility.to_string())?;
        row(f, "actuated", self.actuators())?;
        row(f, "gravity", self.gravity_text())?;
        for each in &self.loops {
            let sides = format!("{} – {}", each.link_a, each.link_b);
            let rank = format!("rank {} of {}", each.rank, counted(each.constraints, "constraint"));
            row(f, "loop", visible_name(&format!("{}: {}, {sides}, {rank}", each.name, each.kind)).into_owned())?;
        }
        if self.loops.len() > 1 {
            row(f, "all loops", format!("rank {} of {} constraints", self.loop_rank, self.loop_constraints))?;
        }
        for each in &self.springs {
            let name = each.name.as_ref().map_or(String::new(), |name| format!("{name}: "));
            let ends = format!("{} – {}", each.link_a, each.link_b);
            let [stiffness, damping, length] = [each.stiffness, each.damping, each.length].map(rounded);
            let numbers = format!("{stiffness} N/m, {damping} N s/m, relaxed at {length} m");
            row(f, "spring", visible_name(&format!("{name}{ends}, {numbers}")).into_owned())?;
        }
        writeln!(f)?;
        self.write_links(f)
    }
}

impl Summary {
    /// What each compiled function costs, below the rest.
    pub fn operations_table(&self) -> String {
        let head = format!("\n  {:<20}{:>8}{:>18}\n", "compiled function", "flops", "sine-cosine pairs");
        let rows = self
            .operations
            .iter()
            .map(|each| format!("  {:<20}{:>8}{:>18}\n", each.function, each.count.flops(), each.count.trig));
        std::iter::once(head).chain(rows).collect()
    }

    /// "5 revolute, 1 prismatic".
    fn kinds(&self) -> String {
        let count = |kind: &str| self.links.iter().filter(|link| link.kind == kind).count();
        let kinds = JointKind::ALL.map(|(kind, _)| (kind, count(kind)));
        let there = kinds.iter().filter(|(_, count)| *count > 0);
        there.map(|(kind, count)| format!("{count} {kind}")).collect::<Vec<_>>().join(", ")
    }

    fn actuators(&self) -> String {
        let (actuated, passive) = (self.actuated.len(), self.passive.len());
        if passive == 0 {
            format!("all {actuated} joints")
        } else {
            format!("{actuated} of {} joints", actuated + passive)
        }
    }

    fn gravity_text(&self) -> String {
        let [x, y, z] = self.gravity;
        format!("[{x}, {y}, {z}] m/s²")
    }

    fn write_links(&self, f: &mut Formatter<'_>) -> Result {
        let columns: [Column; 6] = [
            ("link", |link| visible_name(&link.name).into_owned()),
            ("on", |link| visible_name(&link.parent).into_owned()),
            ("joint", |link| visible_name(&link.joint).into_owned()),
            ("kind", |link| match &link.mimics {
                Some(joint) => format!("{}, mimics {}", link.kind, visible_name(joint)),
                None => link.kind.to_string(),
            }),
            ("actuator", |link| actuator(&link.actuated_velocities)),
            ("mass, kg", |link| rounded(link.mass)),
        ];
        let widths = columns.map(|(title, cell)| {
            let cells = self.links.iter().map(|link| cell(link).chars().count());
            cells.chain([title.chars().count()]).max().unwrap_or(0) + 2
        });
        let mut line = |cells: [String; 6]| {
            // Not by a format width, which is limited to 16 bits.
            let padded = |(cell, width): (&String, usize)| cell.clone() + &" ".repeat(width - cell.chars().count());
            let padded = cells.iter().zip(widths).map(padded).collect::<String>();
            writeln!(f, "  {}", padded.trim_end())
        };
        line(columns.map(|(title, _)| title.to_string()))?;
        self.links.iter().try_for_each(|link| line(columns.map(|(_, cell)| cell(link))))
    }
}

/// Whether the velocities of a joint have actuators, or how many of them; nothing of a joint that does not move.
fn actuator(velocities: &[bool]) -> String {
    match (velocities.iter().filter(|actuated| **actuated).count(), velocities.len()) {
        (_, 0) => String::new(),
        (0, _) => "no".to_owned(),
        (actuated, all) if actuated == all => "yes".to_owned(),
        (actuated, all) => format!("{actuated} of {all}"),
    }
}
