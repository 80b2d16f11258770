//! From when to when, and the instants that are written.

use redysim_model::document::{Message, Reader};

/// Nothing that is written has more rows: nobody reads them, and tens of gigabytes are written by mistake only.
const MOST: f64 = 1e7;
/// An end that misses an instant by this part of a step is one.
const ROUNDING: f64 = 1e-6;

/// The instants of a run: `start` + k · `step`, up to `end`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The first instant, s.
    pub start: f64,
    /// No instant is later, s.
    pub end: f64,
    /// From one to the next, s.
    pub step: f64,
}

impl Span {
    /// Reads `start` (0 unless told), `end` and `step`.
    pub fn read(reader: &mut Reader<'_, '_>) -> Option<Span> {
        let start = reader.number("start");
        let end = reader.number("end");
        let end = reader.required("end", end);
        let step = reader.positive("step");
        let step = reader.required("step", step);
        let (start, spanned) = (start.value_or(0.0)?, end.spanned()?);
        let span = Span { start, end: *spanned.get_ref(), step: *step.value()? };
        let count = span.steps();
        let item = reader.item();
        let fault = if span.end <= start {
            Message {
                title: format!(
                    "{item}: the run must end after its start, but `end` is {:?} s and `start` {start:?} s",
                    span.end
                ),
                label: "not after the start".into(),
                help: "give the time at which it ends, s, not how long it takes".into(),
            }
        } else if count < 1.0 {
            Message {
                title: format!("{item}: there is no instant but the first, since `step` is {:?} s", span.step),
                label: format!("less than a step from {start:?} s"),
                help: "give a `step`, s, that goes at least once into the run".into(),
            }
        } else if count > MOST {
            Message {
                title: format!(
                    "{item}: steps of {:?} s are {count:.0} rows, and no more than {MOST:.0} are written",
                    span.step
                ),
                label: "too far for this step".into(),
                help: "give a larger `step`: it sets what is written, not how exactly the motion is computed".into(),
            }
        } else {
            return Some(span);
        };
        reader.fault_at(spanned.span(), fault)
    }

    fn steps(&self) -> f64 {
        ((self.end - self.start) / self.step + ROUNDING).floor()
    }

    /// How many instants there are.
    pub fn count(&self) -> usize {
        self.steps() as usize + 1
    }

    /// The instant `k`, s. Each is one product away from the start, so that they do not drift.
    pub fn instant(&self, k: usize) -> f64 {
        self.start + k as f64 * self.step
    }

    /// The first and the last instant, s.
    pub fn interval(&self) -> (f64, f64) {
        (self.start, self.instant(self.count() - 1))
    }

    /// From the first instant to the last, s.
    pub fn length(self) -> f64 {
        let (from, to) = self.interval();
        to - from
    }
}
