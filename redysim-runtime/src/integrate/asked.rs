//! Answers at the times a caller asks for.

use super::interval::Interval;
use super::{IntegrationError, Step};
use crate::{Real, Vector};

/// The times still to be answered. Each is checked when the iterator yields it.
pub(super) struct AskedTimes<I, S> {
    times: I,
    next: Option<S>,
    interval: Interval<S>,
}

impl<S: Real, I: Iterator<Item = S>> AskedTimes<I, S> {
    pub fn new(times: I, interval: Interval<S>) -> Result<Self, IntegrationError<S>> {
        let mut asked = Self { times, next: None, interval };
        asked.pull(interval.from)?;
        Ok(asked)
    }

    /// Calls `output` for every asked time that `step` covers; `y` is room for the answers.
    pub fn answer<Y: Vector<S>>(
        &mut self,
        step: &Step<'_, S, Y>,
        y: &mut Y,
        output: &mut impl FnMut(S, &Y),
    ) -> Result<(), IntegrationError<S>> {
        while let Some(t) = self.next {
            if !self.interval.reaches(step.end().0, t) {
                break;
            }
            step.write_at(t, y);
            output(t, y);
            self.pull(t)?;
        }
        Ok(())
    }

    fn pull(&mut self, previous: S) -> Result<(), IntegrationError<S>> {
        self.next = self.times.next();
        match self.next {
            Some(t) if !self.interval.contains(t) => {
                Err(IntegrationError::AskedTimeOutside { t, from: self.interval.from, to: self.interval.to })
            }
            Some(t) if !self.interval.reaches(t, previous) => {
                Err(IntegrationError::AskedTimesOutOfOrder { t, previous })
            }
            _ => Ok(()),
        }
    }
}
