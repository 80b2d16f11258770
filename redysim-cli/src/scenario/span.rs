//! From when to when, and the instants that are written.

use redysim_toml::{Message, Reader};

use super::keys;

/// The largest number of rows of a run: more would be tens of gigabytes, most likely by mistake.
const MOST: f64 = 1e7;
/// A step is so many roundings of the time at least.
const LEAST: f64 = 16.0;
/// An end that misses an instant by this part of a step is one.
const ROUNDING: f64 = 1e-6;

/// The instants of a run: `start` + k · `step`, up to `end`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// The first instant, s.
    pub start: f64,
    /// No instant is later by more than a millionth of a step, s.
    pub end: f64,
    /// From one to the next, s.
    pub step: f64,
    /// What start and step are in decimals, if they are any.
    decimals: Option<Decimals>,
}

impl Span {
    /// Reads `start` (0 by default), `end` and `step`.
    pub fn read(reader: &mut Reader<'_, '_>) -> Option<Span> {
        let start = reader.number(&keys::START);
        let end = reader.required(&keys::END, Reader::number);
        let step = reader.required(&keys::STEP, Reader::positive);
        let (start, spanned) = (start.value_or(0.0)?, end.spanned()?);
        let span = Span { start, end: *spanned.get_ref(), step: *step.value()?, decimals: None };
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
                title: format!("{item}: the first instant is the only one, since `step` is {:?} s", span.step),
                label: format!("less than a step from {start:?} s"),
                help: "give a `step`, s, that goes at least once into the run".into(),
            }
        } else if count > MOST {
            Message {
                title: format!(
                    "{item}: steps of {:?} s are {} rows, and no more than {MOST:.0} are written",
                    span.step,
                    if count < 1e15 { format!("{count:.0}") } else { format!("{count:.0e}") }
                ),
                label: "too far for this step".into(),
                help: "give a larger `step`: it sets what is written, not how exactly the motion is computed".into(),
            }
        } else if span.step < LEAST * f64::EPSILON * start.abs().max(span.end.abs()) {
            Message {
                title: format!("{item}: with steps of {:?} s there are no numbers between so late instants", span.step),
                label: format!("numbers are {:.0e} s apart here", f64::EPSILON * span.end.abs()),
                help: "give a larger `step`, or begin at 0".into(),
            }
        } else {
            return Some(span.in_decimals());
        };
        reader.error_at(spanned.span(), fault)
    }

    /// The same with its instants as decimals where they are some: for a span that has been checked.
    fn in_decimals(self) -> Span {
        Span { decimals: Decimals::of(self.start, self.step, self.steps()), ..self }
    }

    fn steps(&self) -> f64 {
        ((self.end - self.start) / self.step + ROUNDING).floor()
    }

    /// How many instants there are.
    pub fn count(&self) -> usize {
        self.steps() as usize + 1
    }

    /// The instant `k`, s: where the steps are decimals, as they mostly are, the decimal that a person expects, such as
    /// 0.3 for the third of 0.1, and not 0.30000000000000004. Each is by itself away from the start, so that they do
    /// not drift.
    pub fn instant(&self, k: usize) -> f64 {
        self.decimals.map_or(self.start + k as f64 * self.step, |decimals| decimals.at(k))
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

/// Instants as whole numbers of one decimal unit, 10⁻ⁿ.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Decimals {
    start: i64,
    step: i64,
    /// 10ⁿ, exactly.
    per_unit: f64,
}

/// Powers of ten up to this one are exact in binary.
const MOST_DIGITS: u32 = 22;
/// So are whole numbers up to here.
const MOST_UNITS: u64 = 1 << f64::MANTISSA_DIGITS;

impl Decimals {
    /// If start, step and all `steps` are whole numbers of a unit.
    fn of(start: f64, step: f64, steps: f64) -> Option<Self> {
        let ((start, a), (step, b)) = (decimal(start)?, decimal(step)?);
        let digits = a.max(b);
        let scaled = |units: i64, own: u32| units.checked_mul(10_i64.checked_pow(digits - own)?);
        let (start, step) = (scaled(start, a)?, scaled(step, b)?);
        let last = step.checked_mul(steps as i64)?.checked_add(start)?;
        let fits = digits <= MOST_DIGITS && start.unsigned_abs().max(last.unsigned_abs()) <= MOST_UNITS;
        fits.then(|| Decimals { start, step, per_unit: 10_f64.powi(digits as i32) })
    }

    /// A quotient of exact numbers is the number next to the decimal.
    fn at(&self, k: usize) -> f64 {
        (self.start + k as i64 * self.step) as f64 / self.per_unit
    }
}

/// A number as so many units of 10⁻ⁿ, and n.
fn decimal(value: f64) -> Option<(i64, u32)> {
    let text = format!("{value:e}");
    let (digits, exponent) = text.split_once('e')?;
    let (whole, part) = digits.split_once('.').unwrap_or((digits, ""));
    let units: i64 = format!("{whole}{part}").parse().ok()?;
    let below = part.len() as i32 - exponent.parse::<i32>().ok()?;
    match u32::try_from(below) {
        Ok(below) => Some((units, below)),
        Err(_) => Some((units.checked_mul(10_i64.checked_pow(below.unsigned_abs())?)?, 0)),
    }
}

#[cfg(test)]
mod tests {
    use super::Span;

    fn span(start: f64, end: f64, step: f64) -> Span {
        Span { start, end, step, decimals: None }.in_decimals()
    }

    #[test]
    fn instants_are_the_decimals_that_are_meant() {
        for (start, step, count) in
            [(0.0, 0.1, 1000), (-2.5, 0.05, 400), (1e3, 1e-6, 1000), (0.0, 20.0, 50), (0.3, 7e-9, 99)]
        {
            let span = span(start, start + step * f64::from(count), step);
            for k in 0..=count {
                let meant = (start * 1e9_f64).round() as i64 + i64::from(k) * (step * 1e9_f64).round() as i64;
                let text = format!("{meant}e-9");
                assert_eq!(span.instant(k as usize), text.parse::<f64>().unwrap(), "{start} + {k} · {step}");
            }
        }
    }

    #[test]
    fn steps_that_are_not_decimals_are_multiples() {
        for (start, step) in [(0.0, 1.0 / 3.0), (0.1 + 0.2, 0.1), (1e15, 0.7), (0.0, f64::MIN_POSITIVE)] {
            let span = span(start, start + 300.0 * step, step);
            assert!((0..=300).all(|k| span.instant(k) == start + k as f64 * step), "{start} {step}");
        }
    }
}
