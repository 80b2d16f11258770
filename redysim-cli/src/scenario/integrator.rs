//! The integrators by their names.

use redysim_model::GenericMechanism;
use redysim_runtime::integrate::stability::{StepWarning, largest_stable_step};
use redysim_runtime::integrate::{self, Observer};
use redysim_runtime::{
    ContactEvent, Dop8, Dop853, Gauss4, Gauss6, IntegrationError, Ode, Ode4, Ode5, Ode15s, Ode45, Radau5,
    SemiImplicitEuler, Solution,
};
use redysim_toml::{Field, Key, Kind, Message, Reader};

use super::{Ground, keys};

/// An integrator and its settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Integrator {
    /// Steps of one size, s.
    Fixed(Fixed, f64),
    /// Steps from tolerances.
    Adaptive(Adaptive, Tolerances),
}

/// Methods with steps of one size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fixed {
    SemiImplicitEuler,
    Ode4,
    Ode5,
    Dop8,
    Gauss4,
    Gauss6,
}

/// Methods with steps from tolerances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Adaptive {
    Ode45,
    Dop853,
    Ode15s,
    Radau5,
}

/// What keeps the steps of an adaptive method small.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    pub rtol: f64,
    pub atol: Absolute,
    /// The largest step, s.
    pub max_step: f64,
}

/// What a component of the state may be wrong by, however small it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Absolute {
    /// Of coordinates, rad or m.
    pub position: f64,
    /// Of their rates, rad/s or m/s.
    pub velocity: f64,
    /// Of the work that the actuators do, J, and of integral actions, N m or N.
    pub work: f64,
}

impl Absolute {
    const fn uniform(value: f64) -> Self {
        Absolute { position: value, velocity: value, work: value }
    }

    fn read(reader: &mut Reader<'_, '_>) -> Option<Absolute> {
        if !reader.has_table(&keys::ATOL) {
            return reader.positive(&keys::ATOL).value_or(USUAL_ATOL).map(Absolute::uniform);
        }
        let parts = reader.table(&keys::ATOL, |mut reader| {
            [keys::POSITION, keys::VELOCITY, keys::WORK].map(|key| reader.positive(&key).value_or(USUAL_ATOL))
        });
        let [position, velocity, work] = *parts.value()?;
        Some(Absolute { position: position?, velocity: velocity?, work: work? })
    }

    /// One for each of the `count` components of the state [q, q̇, E_act, z] of a mechanism: integral actions z, N m or
    /// N, are weighed as work is.
    fn of_state(self, mechanism: &GenericMechanism, count: usize) -> Vec<f64> {
        let (nq, nv) = (mechanism.tree().nq(), mechanism.tree().nv());
        let mut all = [vec![self.position; nq], vec![self.velocity; nv]].concat();
        all.resize(count, self.work);
        all
    }
}

/// MATLAB's defaults; the largest step is a part of the run.
const USUAL_RTOL: f64 = 1e-3;
const USUAL_ATOL: f64 = 1e-6;
const USUAL_MAX_STEP: f64 = 0.1;
/// The integrators' own limits of the number of steps.
const MOST_FIXED: f64 = 1e9;
const MOST_ADAPTIVE: f64 = 1e8;
/// A step that is longer than the run by this part of it is as long.
const ROUNDING: f64 = 1e-6;

#[derive(Clone, Copy)]
enum IntegrationMethod {
    Fixed(Fixed),
    Adaptive(Adaptive),
}

const fn fixed(name: &'static str, method: Fixed) -> Kind<IntegrationMethod> {
    Kind::new(name, IntegrationMethod::Fixed(method), &keys::FIXED_STEP)
}

const fn adaptive(name: &'static str, method: Adaptive) -> Kind<IntegrationMethod> {
    Kind::new(name, IntegrationMethod::Adaptive(method), &keys::ADAPTIVE_STEP)
}

/// The names, and behind them other names of the same: the numbers are those of ReDySim's `int_type`.
const METHODS: [Kind<IntegrationMethod>; 14] = [
    fixed("SemiImplicitEuler", Fixed::SemiImplicitEuler),
    fixed("Ode4", Fixed::Ode4),
    fixed("Ode5", Fixed::Ode5),
    fixed("Dop8", Fixed::Dop8),
    fixed("Gauss4", Fixed::Gauss4),
    fixed("Gauss6", Fixed::Gauss6),
    adaptive("Ode45", Adaptive::Ode45),
    adaptive("Dop853", Adaptive::Dop853),
    adaptive("Ode15s", Adaptive::Ode15s),
    adaptive("Radau5", Adaptive::Radau5),
    fixed("SemiImplicitEuler", Fixed::SemiImplicitEuler).also("Euler"),
    adaptive("Ode45", Adaptive::Ode45).also("0"),
    adaptive("Ode15s", Adaptive::Ode15s).also("1"),
    fixed("Ode5", Fixed::Ode5).also("2"),
];

/// The usual name of an integrator that has others.
pub fn usual_method(name: &str) -> &str {
    let named = METHODS.iter().find(|method| method.name == name);
    named.and_then(|method| method.same_as).unwrap_or(name)
}

impl Integrator {
    /// Reads the table `integrator` of a run that takes `length`, s.
    pub fn read(reader: &mut Reader<'_, '_>, length: f64) -> Option<Integrator> {
        let usual = adaptive("Ode45", Adaptive::Ode45);
        let read = reader.table_of_kind(&keys::INTEGRATOR, &keys::METHOD, &METHODS, &usual, |reader, method| {
            Integrator::of_method(reader, method, length)
        });
        let max_step = USUAL_MAX_STEP * length;
        let usual = Tolerances { rtol: USUAL_RTOL, atol: Absolute::uniform(USUAL_ATOL), max_step };
        read.value_or(Some(Integrator::Adaptive(Adaptive::Ode45, usual)))?
    }

    /// Reads the settings of a method.
    fn of_method(mut reader: Reader<'_, '_>, method: IntegrationMethod, length: f64) -> Option<Integrator> {
        match method {
            IntegrationMethod::Fixed(method) => {
                let step = reader.required(&keys::INTEGRATOR_STEP, Reader::positive);
                let spanned = step.spanned()?;
                let size = *spanned.get_ref();
                if size > length * (1.0 + ROUNDING) {
                    return reader.error_at(spanned.span(), too_long(reader.item(), size, length));
                }
                check_count(&mut reader, &keys::INTEGRATOR_STEP, &step, (length, MOST_FIXED))?;
                Some(Integrator::Fixed(method, size))
            }
            IntegrationMethod::Adaptive(method) => {
                let relative = reader.positive(&keys::RTOL);
                check_rtol(&mut reader, &relative)?;
                let rtol = relative.value_or(USUAL_RTOL);
                let largest = reader.positive(&keys::MAX_STEP);
                let max_step = largest.value_or(USUAL_MAX_STEP * length);
                check_count(&mut reader, &keys::MAX_STEP, &largest, (length, MOST_ADAPTIVE))?;
                let atol = Absolute::read(&mut reader);
                Some(Integrator::Adaptive(method, Tolerances { rtol: rtol?, atol: atol?, max_step: max_step? }))
            }
        }
    }

    /// Its name.
    pub fn name(&self) -> String {
        match self {
            Integrator::Fixed(method, _) => format!("{method:?}"),
            Integrator::Adaptive(method, _) => format!("{method:?}"),
        }
    }

    /// The warning that steps of one size grow errors near the state at `t`, with the joint that needs smaller ones;
    /// `None` if errors do not grow, or if the method cannot predict it.
    pub fn step_warning<'m>(
        &self,
        ode: &mut dyn Ode<f64, Vec<f64>>,
        (t, state): (f64, &Vec<f64>),
        mechanism: &'m GenericMechanism,
    ) -> Option<StepWarning<'m, f64>> {
        let Integrator::Fixed(method, step) = *self else { return None };
        let stable = match method {
            Fixed::SemiImplicitEuler => largest_stable_step(ode, t, state, &SemiImplicitEuler::new(step)),
            Fixed::Ode4 => largest_stable_step(ode, t, state, &Ode4::new(step)),
            Fixed::Ode5 => largest_stable_step(ode, t, state, &Ode5::new(step)),
            Fixed::Dop8 => largest_stable_step(ode, t, state, &Dop8::new(step)),
            // They are stable wherever their iteration converges, and report where it does not.
            Fixed::Gauss4 | Fixed::Gauss6 => return None,
        };
        // Without derivatives, the integration reports the reason.
        stable.ok()?.warning(step, mechanism)
    }

    /// Integrates `ode`, the motion of the mechanism of `ground`, over `interval`. Adaptive methods end a
    /// step at each of the times `stops`. Each touch-down and lift-off is shown to `on_event`.
    ///
    /// # Errors
    /// As [`Grounded::run`](redysim_runtime::Grounded::run).
    pub fn run(
        &self,
        ground: &Ground<'_>,
        ode: &mut dyn Ode<f64, Vec<f64>>,
        (interval, stops): ((f64, f64), &[f64]),
        start: Vec<f64>,
        observer: &mut impl Observer<f64, Vec<f64>>,
        on_event: impl FnMut(ContactEvent<f64>),
    ) -> Result<Solution<f64, Vec<f64>>, IntegrationError<f64>> {
        let atol = match self {
            Integrator::Fixed(..) => vec![],
            Integrator::Adaptive(_, Tolerances { atol, .. }) => atol.of_state(ground.mechanism(), start.len()),
        };
        let task = Task { ground, ode, interval, start, observer, on_event };
        match *self {
            Integrator::Fixed(method, step) => match method {
                Fixed::SemiImplicitEuler => task.by(&SemiImplicitEuler::new(step)),
                Fixed::Ode4 => task.by(&Ode4::new(step)),
                Fixed::Ode5 => task.by(&Ode5::new(step)),
                Fixed::Dop8 => task.by(&Dop8::new(step)),
                Fixed::Gauss4 => task.by(&Gauss4::new(step)),
                Fixed::Gauss6 => task.by(&Gauss6::new(step)),
            },
            Integrator::Adaptive(method, tolerances) => match method {
                Adaptive::Ode45 => task.by(&tolerances.on(Ode45::new(), &atol, stops)),
                Adaptive::Dop853 => task.by(&tolerances.on(Dop853::new(), &atol, stops)),
                Adaptive::Ode15s => task.by(&tolerances.on(Ode15s::new(), &atol, stops)),
                Adaptive::Radau5 => task.by(&tolerances.on(Radau5::new(), &atol, stops)),
            },
        }
    }
}

/// What is to be integrated, by whatever method.
struct Task<'t, 'a, O, G> {
    ground: &'t Ground<'a>,
    ode: &'t mut dyn Ode<f64, Vec<f64>>,
    interval: (f64, f64),
    start: Vec<f64>,
    observer: &'t mut O,
    on_event: G,
}

impl<O: Observer<f64, Vec<f64>>, G: FnMut(ContactEvent<f64>)> Task<'_, '_, O, G> {
    fn by(
        self,
        method: &impl redysim_runtime::Integrator<f64>,
    ) -> Result<Solution<f64, Vec<f64>>, IntegrationError<f64>> {
        let Task { ground, ode, interval, start, observer, on_event } = self;
        ground.run(method, ode, interval, start, observer, on_event)
    }
}

impl Tolerances {
    /// The method with these settings, the absolute tolerances of the state's components, and times at which steps end.
    fn on<'a, M>(
        self,
        method: integrate::Adaptive<'a, f64, M>,
        atol: &'a [f64],
        stops: &'a [f64],
    ) -> integrate::Adaptive<'a, f64, M> {
        method.rtol(self.rtol).atol_each(atol).max_step(self.max_step).stops(stops)
    }
}

/// Fails where steps no larger than that under `key` are more than a run may take.
fn check_count(reader: &mut Reader<'_, '_>, key: &Key, step: &Field<f64>, (length, most): (f64, f64)) -> Option<()> {
    let Some(spanned) = step.spanned() else { return Some(()) };
    let (step, key) = (*spanned.get_ref(), key.name);
    if !length.is_finite() || length / step <= most {
        return Some(());
    }
    let title = format!(
        "{}: with the integrator's `{key}` of {step:?} s the {length:?} s of the run take {:.1e} steps, and at most \
         {most:e} are taken",
        reader.item(),
        length / step
    );
    let help = format!("give a `{key}`, s, that is larger, or end earlier");
    reader.error_at(spanned.span(), Message { title, label: "too small for this run".into(), help })
}

/// Fails where a relative tolerance is below the roundoff of the steps, or allows errors as large as the values.
fn check_rtol(reader: &mut Reader<'_, '_>, rtol: &Field<f64>) -> Option<()> {
    let Some(spanned) = rtol.spanned() else { return Some(()) };
    let (value, item) = (*spanned.get_ref(), reader.item());
    let smallest = integrate::Tolerances::<f64>::smallest_relative();
    let (fault, label) = if value < smallest {
        ("no step in double precision keeps it", "too small")
    } else if value >= 1.0 {
        ("it allows errors as large as the motion", "too large")
    } else {
        return Some(());
    };
    let title = format!("{item}: the integrator's `rtol` is {value:?}, and {fault}");
    let help = format!("give a `rtol` between {smallest:.1e} and 0.1, such as {USUAL_RTOL:?}");
    reader.error_at(spanned.span(), Message { title, label: label.into(), help })
}

fn too_long(item: &str, step: f64, length: f64) -> Message {
    Message {
        title: format!("{item}: the integrator's `step` is {step:?} s, and the whole run takes {length:?} s"),
        label: "longer than the run".into(),
        help: "give the step of the integration, s: a hundredth of a swing or less".into(),
    }
}
