//! Why an integration failed.

use core::fmt;

use crate::LengthMismatch;

/// Why an integration was not begun, or could not go on.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum IntegrationError<S> {
    /// The interval is empty, infinite, or has an end that is not a number.
    InvalidInterval {
        /// The given first time.
        from: S,
        /// The given last time.
        to: S,
    },
    /// The relative tolerance is not a number or below what arithmetic can keep.
    InvalidRelativeTolerance {
        /// The given tolerance.
        value: S,
        /// The smallest that is accepted.
        smallest: S,
    },
    /// An absolute tolerance is zero, negative or not a number.
    InvalidAbsoluteTolerance {
        /// The component it belongs to; `None` for the tolerance of all.
        component: Option<usize>,
        /// The given tolerance.
        value: S,
    },
    /// There is not one absolute tolerance for each component.
    WrongToleranceCount {
        /// How many tolerances were given.
        given: usize,
        /// How many components the state has.
        needed: usize,
    },
    /// The state, or a vector that the equation holds, has a wrong length.
    WrongLength(LengthMismatch),
    /// A given step size is zero, negative, infinite or not a number.
    InvalidStep {
        /// Which one: "step", "initial step" or "maximum step".
        option: &'static str,
        /// The given size.
        value: S,
    },
    /// A time at which to save the solution lies outside the interval of integration or is not a number.
    SaveTimeOutside {
        /// That time.
        t: S,
        /// The first time of the interval.
        from: S,
        /// The last time of the interval.
        to: S,
    },
    /// A time at which to save the solution precedes the previous one, in the direction of integration.
    SaveTimesOutOfOrder {
        /// That time.
        t: S,
        /// The previous one.
        previous: S,
    },
    /// The state is infinite or not a number: the one given as start, or the one a step arrived at.
    NonFiniteState {
        /// The time.
        t: S,
        /// The first such component.
        component: usize,
    },
    /// The derivative is infinite or not a number.
    NonFiniteDerivative {
        /// The time.
        t: S,
        /// The first such component.
        component: usize,
    },
    /// The method treats coordinates and velocities differently, but the equation does not tell them apart.
    NoCoordinates,
    /// The eigenvalues of the Jacobian are not found.
    NoEigenvalues {
        /// The time.
        t: S,
    },
    /// The function of an event is infinite or not a number.
    NonFiniteEvent {
        /// The time.
        t: S,
        /// Which of the events.
        event: usize,
    },
    /// The equation refused the state at the end of a step (see [`Ode::accepted`](crate::Ode::accepted)).
    Refused {
        /// The time.
        t: S,
    },
    /// The equations of an implicit step were not solved: the iteration does not converge, or the matrix of the linear
    /// equations is singular.
    NotConverged {
        /// The time at which the step begins.
        t: S,
        /// The size of the step, with its sign.
        step: S,
    },
    /// The tolerances ask for a step below the spacing of floating-point times, or a given step is below it.
    StepTooSmall {
        /// The time that was reached.
        t: S,
        /// The size of the step that was to follow.
        step: S,
    },
    /// Steps of an explicit method are small for stability, not for accuracy, and the rest of the interval would take
    /// very many of them.
    Stiff {
        /// The time that was reached.
        t: S,
        /// The mean size of the last steps.
        step: S,
        /// How many of that size the rest would take.
        remaining: u64,
    },
    /// Contacts open and close again and again at one time: steps are too long for the ground.
    Chattering {
        /// The time.
        t: S,
        /// How often a contact has begun or ended there.
        events: u64,
    },
    /// The end is not reached, or with steps of one size will not be reached, within the largest number of steps.
    TooManySteps {
        /// The time that was reached.
        t: S,
        /// The largest number of steps.
        limit: u64,
    },
}

impl<S: fmt::Debug> fmt::Display for IntegrationError<S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::InvalidInterval { from, to } => write!(
                f,
                "the interval of integration must have two finite, different ends, but it runs from t = {from:?} to \
                 {to:?}; give it a length, forward or backward in time"
            ),
            Self::InvalidRelativeTolerance { value, smallest } => write!(
                f,
                "the relative tolerance must be finite and at least {smallest:?} (100 roundoff units), but it is \
                 {value:?}; give a larger one, or a scalar of higher precision"
            ),
            Self::InvalidAbsoluteTolerance { component: None, value } => write!(
                f,
                "the absolute tolerance must be positive and finite, but it is {value:?}; give the size below which a \
                 component no longer matters"
            ),
            Self::InvalidAbsoluteTolerance { component: Some(component), value } => write!(
                f,
                "every absolute tolerance must be positive and finite, but the one of component {component} is \
                 {value:?}; give the size below which that component no longer matters"
            ),
            Self::WrongToleranceCount { given, needed } => write!(
                f,
                "the state has {needed} components, but {given} absolute tolerances are given; give one for each \
                 component, or a single one for all"
            ),
            Self::WrongLength(mismatch) => mismatch.fmt(f),
            Self::InvalidStep { option, value } => write!(
                f,
                "the {option} must be positive and finite, but it is {value:?}; the direction in time comes from the \
                 interval, not from the sign"
            ),
            Self::SaveTimeOutside { t, from, to } => write!(
                f,
                "the solution is asked for at t = {t:?}, outside the interval from {from:?} to {to:?}; extend the \
                 interval or drop that time"
            ),
            Self::SaveTimesOutOfOrder { t, previous } => write!(
                f,
                "the solution is asked for at t = {t:?} after it was asked for at {previous:?}; sort the times in the \
                 direction of integration"
            ),
            Self::NonFiniteState { t, component } => write!(
                f,
                "component {component} of the state is infinite or not a number at t = {t:?}; look at the start if \
                 that is its time, else the solution grows without bound"
            ),
            Self::NonFiniteDerivative { t, component } => write!(
                f,
                "component {component} of the derivative is infinite or not a number at t = {t:?}; look for a division \
                 by zero, a singular mass matrix or a bad force there"
            ),
            Self::NoCoordinates => f.write_str(
                "the method treats coordinates and velocities differently, but the equation has 0 coordinates; \
                 simulate a mechanism, implement Ode::coordinate_rates, or take a method for any equation, such as \
                 Ode4",
            ),
            Self::NoEigenvalues { t } => write!(
                f,
                "the eigenvalues of the Jacobian at t = {t:?} are not found: its elements may be too large; look for a \
                 singularity nearby, or ask in another state"
            ),
            Self::NonFiniteEvent { t, event } => write!(
                f,
                "the function of event {event} is infinite or not a number at t = {t:?}; it must be finite for every \
                 state of the solution, also between the ends of steps"
            ),
            Self::Refused { t } => write!(
                f,
                "the equation refused the state at t = {t:?}; a closed-loop simulation has the reason in `last_error`"
            ),
            Self::NotConverged { t, step } => write!(
                f,
                "from t = {t:?} the equations of an implicit step of {step:?} are not solved by iteration; take \
                 smaller steps, or Radau5 or Ode15s if the equation is stiff, and look for a jump of the derivative or \
                 a wrong tangent there"
            ),
            Self::StepTooSmall { t, step } => write!(
                f,
                "at t = {t:?} a step of {step:?} is too small for the precision of time; the solution may have a \
                 singularity there, or the tolerance or the step is too small"
            ),
            Self::Stiff { t, step, remaining } => write!(
                f,
                "the equation is stiff at t = {t:?}: stability, not accuracy, keeps the steps at {step:?}, and the \
                 rest of the interval would take about {remaining} of them; take an implicit method, Ode15s or Radau5, \
                 lower the gains or dampings, or let it go on with stiffness_limit(None)"
            ),
            Self::Chattering { t, events } => write!(
                f,
                "contacts began and ended {events} times at t = {t:?}, within the precision of time: steps are too \
                 long for the stiffness and damping of the ground; take smaller steps, a method that chooses them from \
                 tolerances, or softer ground"
            ),
            Self::TooManySteps { t, limit } => write!(
                f,
                "the end is not within {limit} steps of t = {t:?}; loosen the tolerance, take larger steps, raise \
                 max_steps, or smooth a derivative that jumps to and fro there"
            ),
        }
    }
}

impl<S: fmt::Debug> core::error::Error for IntegrationError<S> {}
