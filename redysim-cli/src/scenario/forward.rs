//! A motion that is to be computed.

use redysim_model::Mobility;
use redysim_runtime::Stabilisation;
use redysim_toml::{Field, Kind, Message, Reader};

use super::integrator::Integrator;
use super::keys;
use super::prescribed::PrescribedJoints;
use super::span::Span;
use super::subject::Subject;
use super::torque::Torque;
use super::trajectory::Prescribed;

/// A motion that is to be computed.
pub struct Forward {
    pub span: Span,
    pub integrator: Integrator,
    /// The joints that follow the trajectory whatever force it takes, if some do.
    pub prescribed: Option<PrescribedJoints>,
    pub torque: Torque,
    /// What keeps loops closed.
    pub stabilisation: Stabilisation<f64>,
}

impl Forward {
    /// Reads the table `forward`, in which joints or a torque law may follow `trajectory`; `None` if it is invalid, which has
    /// been reported.
    pub fn read(
        reader: &mut Reader<'_, '_>,
        subject: &Subject<'_>,
        trajectory: Option<Option<&Prescribed>>,
    ) -> Field<Option<Forward>> {
        reader.table(&keys::FORWARD, |mut reader| {
            let span = Span::read(&mut reader);
            let integrator = Integrator::read(&mut reader, span.map_or(f64::INFINITY, Span::length));
            let prescribed = PrescribedJoints::read(&mut reader, subject, trajectory);
            let followers =
                prescribed.as_ref().and_then(Option::as_ref).map_or(&[][..], |prescribed| &prescribed.velocities);
            let torque = Torque::read(&mut reader, subject, trajectory, followers);
            let stabilisation = stabilisation(&mut reader, subject);
            let unlimited = torque.as_ref().map(Torque::unlimited);
            let solved = match unlimited {
                _ if !followers.is_empty() => Some("prescribed joints need"),
                Some(Torque::Computed { .. }) => Some("computed torque needs"),
                _ => None,
            };
            if let (Some(what), Some(stabilisation)) = (solved, stabilisation) {
                warn_of_redundancy(&mut reader, subject, stabilisation, what);
            }
            Some(Forward {
                span: span?,
                integrator: integrator?,
                prescribed: prescribed?,
                torque: torque?,
                stabilisation: stabilisation?,
            })
        })
    }

    /// The times at which an integration step must end, s, in ascending order: those of the followed motion, and the rows of a
    /// table of forces.
    pub fn stops(&self) -> Vec<f64> {
        let mut times = self.followed().map_or(Vec::new(), Prescribed::times);
        if let Torque::Table { forces, .. } = self.torque.unlimited() {
            times.extend(&forces.table.t);
        }
        times.sort_by(f64::total_cmp);
        times.dedup();
        times
    }

    /// The motion that joints or the torque law follow, if one of them does: that of the scenario.
    pub fn followed(&self) -> Option<&Prescribed> {
        self.torque.followed().or(self.prescribed.as_ref().map(|prescribed| &prescribed.trajectory))
    }
}

/// Warns that redundant constraints contradict each other in loops that are slightly open, where functions that need
/// closed loops do not have a solution.
fn warn_of_redundancy(
    reader: &mut Reader<'_, '_>,
    subject: &Subject<'_>,
    stabilisation: Stabilisation<f64>,
    what_needs: &str,
) {
    if !subject.loops() || stabilisation == Stabilisation::Projection {
        return;
    }
    let Mobility { constraints, rank, .. } = *subject.mobility();
    if rank < constraints {
        let item = reader.item();
        reader.warning_of_table(Message {
            title: format!(
                "{item}: of the loops' {constraints} constraints {rank} are independent, for which {what_needs} \
                 closed loops"
            ),
            label: "each step leaves them a little open".into(),
            help: "take stabilisation = \"projection\", or leave constraints out that follow from others".into(),
        });
    }
}

fn stabilisation(reader: &mut Reader<'_, '_>, subject: &Subject<'_>) -> Option<Stabilisation<f64>> {
    let plain = |name, kind| Kind::new(name, Some(kind), &keys::PLAIN_STABILISATION);
    let kinds = [
        plain("projection", Stabilisation::Projection),
        plain("none", Stabilisation::None),
        Kind::new("baumgarte", None, &keys::BAUMGARTE),
    ];
    let field =
        reader.table_of_kind(&keys::STABILISATION, &keys::STABILISATION_KIND, &kinds, &kinds[0], |mut reader, kind| {
            // Without loops no kind has an effect, and none requires its keys.
            if !subject.loops() {
                return Some(Stabilisation::Projection);
            }
            kind.or_else(|| {
                Some(Stabilisation::Baumgarte { alpha: *reader.required(&keys::ALPHA, Reader::positive).value()? })
            })
        });
    subject.expect_loops(reader, "forward.stabilisation", &field);
    field.value_or(Some(Stabilisation::Projection))?
}
