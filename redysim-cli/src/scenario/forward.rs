//! A motion that is to be computed.

use redysim_model::document::{Field, Message, Reader, Shape};
use redysim_runtime::Stabilisation;

use super::integrator::Fixed;
use super::{Integrator, Prescribed, Span, Subject, Torque};

/// A motion that is to be computed.
pub struct Forward {
    pub span: Span,
    pub integrator: Integrator,
    pub torque: Torque,
    /// What keeps loops closed.
    pub stabilisation: Stabilisation<f64>,
}

const FORWARD: Shape =
    Shape { owner: "`forward`", keys: &["start", "end", "step", "integrator", "torque", "stabilisation"] };

const PLAIN: Shape = Shape { owner: "This stabilisation", keys: &["kind"] };
const BAUMGARTE: Shape = Shape { owner: "Baumgarte's stabilisation", keys: &["kind", "alpha"] };

impl Forward {
    /// Reads the table `forward`, in which a torque law may follow `trajectory`; `None`, if what is wrong with that has been
    /// reported.
    pub fn read(
        reader: &mut Reader<'_, '_>,
        subject: &Subject<'_>,
        trajectory: Option<Option<&Prescribed>>,
    ) -> Field<Option<Forward>> {
        reader.table("forward", &FORWARD, |mut reader| {
            let span = Span::read(&mut reader);
            let integrator = Integrator::read(&mut reader, span.map_or(f64::INFINITY, Span::length));
            let torque = Torque::read(&mut reader, subject, trajectory);
            let stabilisation = stabilisation(&mut reader);
            if let (Some(span), Some(integrator)) = (span, integrator) {
                warn_of_rows(&mut reader, span, integrator);
            }
            Some(Forward { span: span?, integrator: integrator?, torque: torque?, stabilisation: stabilisation? })
        })
    }
}

/// Gauss's methods are as exact as their order at the ends of steps only.
fn warn_of_rows(reader: &mut Reader<'_, '_>, span: Span, integrator: Integrator) {
    let Integrator::Fixed(Fixed::Gauss4 | Fixed::Gauss6, step) = integrator else { return };
    let steps = span.step / step;
    if (steps - steps.round()).abs() < 1e-9 * steps {
        return;
    }
    let (item, name) = (reader.item(), integrator.name());
    reader.warning_of_table(Message {
        title: format!("{item}: rows lie between the steps of {name}, where it is far less exact than at their ends"),
        label: format!("steps of {step:?} s, rows each {:?} s", span.step),
        help: "give the integrator a `step` that goes a whole number of times into that of the rows".into(),
    });
}

fn stabilisation(reader: &mut Reader<'_, '_>) -> Option<Stabilisation<f64>> {
    let kind = |name, kind| (name, (kind, &PLAIN));
    let kinds = [
        kind("projection", Some(Stabilisation::Projection)),
        kind("none", Some(Stabilisation::None)),
        ("baumgarte", (None, &BAUMGARTE)),
    ];
    let field = reader.table_of_kind("stabilisation", "kind", &kinds, kinds[0].1, |mut reader, kind| {
        kind.or_else(|| {
            let alpha = reader.positive("alpha");
            Some(Stabilisation::Baumgarte { alpha: *reader.required("alpha", alpha).value()? })
        })
    });
    field.value_or(Some(Stabilisation::Projection))?
}
