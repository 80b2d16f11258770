//! A warning about a step, in terms of the mechanism.

use core::fmt;

use super::{LinearStability, StableStep, largest_stable_step};
use crate::integrate::{FixedStep, IntegrationError};
use crate::{ConfigurationSpace, ForwardDynamics, ForwardSimulation, Real, TorqueLaw};

/// A step that is too large to be stable, with the joint that requires smaller ones; the message names the remedies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepWarning<'m, S> {
    /// The given step, s.
    pub step: S,
    /// The largest stable one, and what limits it.
    pub stable: StableStep<S>,
    /// The name of the velocity, which is that of its joint if the joint has no other; `None` if it does not have one.
    pub joint: Option<&'m str>,
}

impl<S: fmt::Debug + Copy> fmt::Display for StepWarning<'_, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { step, stable, joint } = self;
        write!(f, "the step of {step:?} s is not stable")?;
        match (joint, stable.velocity) {
            (Some(name), _) => write!(f, " for joint `{name}`")?,
            (None, Some(velocity)) => write!(f, " for velocity {velocity}")?,
            (None, None) => {}
        }
        let (re, im) = stable.eigenvalue;
        write!(
            f,
            ", whose motion has the eigenvalue {re:?} + {im:?}i 1/s: take steps of at most {:?} s, lower the gain, or \
             take an implicit method, such as Ode15s or Radau5",
            stable.step
        )
    }
}

impl<S: Real> StableStep<S> {
    /// The warning for steps of size `step`; `None` if they are stable.
    pub fn warning<'m, M: ConfigurationSpace<S>>(&self, step: S, mechanism: &'m M) -> Option<StepWarning<'m, S>> {
        let joint = self.velocity.and_then(|velocity| mechanism.velocity_name(velocity));
        (step > self.step).then_some(StepWarning { step, stable: *self, joint })
    }
}

impl<'m, M, L> ForwardSimulation<'m, M, L> {
    /// Whether the steps of `method` are stable near `state`, before the simulation runs: a warning if not, which names
    /// the joint that requires smaller ones. See [`largest_stable_step`].
    ///
    /// # Errors
    /// As [`largest_stable_step`].
    ///
    /// ```
    /// # #[allow(dead_code)]
    /// # mod mechanisms { include!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/mechanisms/mod.rs")); }
    /// # use mechanisms::Arm;
    /// use redysim_runtime::{ForwardSimulation, Ode5, Pd};
    ///
    /// let law = Pd { target: [0.5, 0.5], kp: [100.0, 100.0], kd: [20.0, 60.0] };
    /// let mut simulation = ForwardSimulation::new(&Arm, law);
    /// let state = simulation.state(&[0.0, 0.0], &[0.0, 0.0]);
    /// let warning = simulation.step_warning(&Ode5::new(0.02), 0.0, &state)?.unwrap();
    /// assert_eq!(warning.stable.velocity, Some(1));
    /// println!("{warning}");
    /// assert!(simulation.step_warning(&Ode5::new(0.002), 0.0, &state)?.is_none());
    /// # Ok::<(), redysim_runtime::IntegrationError<f64>>(())
    /// ```
    pub fn step_warning<S: Real>(
        &mut self,
        method: &FixedStep<S, impl LinearStability>,
        t: S,
        state: &M::State,
    ) -> Result<Option<StepWarning<'m, S>>, IntegrationError<S>>
    where
        M: ForwardDynamics<S>,
        L: TorqueLaw<S, M>,
    {
        let stable = largest_stable_step(self, t, state, method)?;
        Ok(stable.warning(method.step(), self.mechanism()))
    }
}
