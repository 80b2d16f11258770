//! Motion in time under joint forces and events that are functions of Python.

use crate::arrays::{Input, Layout};
use crate::load::fault;
use crate::mechanism::Mechanism;
use crate::method::{Method, Task};
use crate::scenario::PATIENCE;
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use redysim_model::{GenericMechanism, Model};
use redysim_runtime::function::Argument;
use redysim_runtime::integrate::algorithm::Formula;
use redysim_runtime::integrate::{Direction, ObservedStep, Observer};
use redysim_runtime::{
    ClosedLoop, ClosedLoopSimulation, Event, ForwardDynamics, ForwardSimulation, IntegrationError, MechanicalEnergy,
    Occurrence, Ode, Solution, Step, TorqueLaw,
};
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// The first exception of a function of Python; numbers that it should have given are NaN then, at which the integration
/// ends.
type Raised = Mutex<Option<PyErr>>;

fn raise(raised: &Raised, error: PyErr) {
    raised.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
}

/// What was raised, if anything was.
fn check(raised: &Raised) -> PyResult<()> {
    raised.lock().unwrap_or_else(PoisonError::into_inner).take().map_or(Ok(()), Err)
}

/// Joint forces: constant, or a function of t, q and v.
enum Law<'a> {
    Constant(Vec<f64>),
    Function { function: &'a Py<PyAny>, owner: &'a Mechanism, raised: &'a Raised },
}

impl TorqueLaw<f64, GenericMechanism> for Law<'_> {
    fn torque(&mut self, _mechanism: &GenericMechanism, t: f64, q: &Vec<f64>, v: &Vec<f64>) -> Vec<f64> {
        match self {
            Law::Constant(tau) => tau.clone(),
            Law::Function { function, owner, raised } => {
                let tau = Python::attach(|py| owner.vector(&called(function.bind(py), t, q, v)?, Argument::Forces));
                tau.unwrap_or_else(|error| {
                    raise(raised, error);
                    vec![f64::NAN; v.len()]
                })
            }
        }
    }
}

fn called<'py>(function: &Bound<'py, PyAny>, t: f64, q: &[f64], v: &[f64]) -> PyResult<Bound<'py, PyAny>> {
    let py = function.py();
    function.call1((t, PyArray1::from_slice(py, q), PyArray1::from_slice(py, v)))
}

/// What moves: a tree, or closed loops.
enum System<'a> {
    Tree(ForwardSimulation<'a, GenericMechanism, Law<'a>>),
    Loops(ClosedLoopSimulation<'a, f64, GenericMechanism, Law<'a>>),
}

/// The rows of the results.
#[derive(Default)]
struct Rows {
    t: Vec<f64>,
    q: Vec<Vec<f64>>,
    v: Vec<Vec<f64>>,
    a: Vec<Vec<f64>>,
    tau: Vec<Vec<f64>>,
    /// Multipliers of the loop constraints; none for a tree.
    multipliers: Vec<Vec<f64>>,
    /// Kinetic and potential energy, and the work of the joint forces less what is dissipated.
    energy: Vec<Vec<f64>>,
}

impl System<'_> {
    fn ode(&mut self) -> &mut dyn Ode<f64, Vec<f64>> {
        match self {
            System::Tree(simulation) => simulation,
            System::Loops(simulation) => simulation,
        }
    }

    /// Adds the row of a state.
    fn add(&mut self, mechanism: &GenericMechanism, t: f64, state: &Vec<f64>, rows: &mut Rows) -> PyResult<()> {
        let parts = ForwardSimulation::new(mechanism, ()).split(state);
        let (mut q, mut v, work) = (parts.q, parts.v, parts.actuator_energy);
        let (tau, a, multipliers) = match self {
            System::Tree(simulation) => {
                let tau = simulation.torque(t, state);
                let a = mechanism.forward_dynamics(&q, &v, &tau);
                (tau, a, Vec::new())
            }
            System::Loops(simulation) => {
                let loops = simulation.loops();
                let failed = |reason| fault(&format!("at t = {t:?} s: {}", loops.with_names(reason)), "");
                // Within a step loops are only as closed as the method is accurate.
                let closed = loops.project(&q, &v).map_err(failed)?;
                (q, v) = (closed.q, closed.v);
                let mut state = state.clone();
                state[..q.len()].copy_from_slice(&q);
                state[q.len()..q.len() + v.len()].copy_from_slice(&v);
                let forced = simulation.forced_motion(t, &state).map_err(failed)?;
                (forced.tau, forced.motion.accelerations, forced.motion.multipliers)
            }
        };
        let energy = mechanism.energy(&q, &v);
        rows.energy.push(vec![energy.kinetic, energy.potential, work]);
        rows.t.push(t);
        rows.q.push(q);
        rows.v.push(v);
        rows.a.push(a);
        rows.tau.push(tau);
        rows.multipliers.push(multipliers);
        Ok(())
    }
}

/// Keeps the states at the requested instants, and watches for signals such as that of Ctrl-C.
struct Keeper<'a> {
    times: &'a [f64],
    states: Vec<(f64, Vec<f64>)>,
    raised: &'a Raised,
    watched: Instant,
}

impl Keeper<'_> {
    fn next(&self) -> Option<f64> {
        self.times.get(self.states.len()).copied()
    }
}

impl Observer<f64, Vec<f64>> for Keeper<'_> {
    fn needs_dense_output(&self, _from: f64, to: f64) -> bool {
        self.next().is_some_and(|t| t < to)
    }

    fn step(&mut self, _step: &Step<'_, f64, Vec<f64>>) -> ControlFlow<()> {
        if self.watched.elapsed() > PATIENCE {
            self.watched = Instant::now();
            if let Err(signal) = Python::attach(|py| py.check_signals()) {
                raise(self.raised, signal);
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(())
    }

    fn observe<F: Formula<f64, Vec<f64>>, O: Ode<f64, Vec<f64>> + ?Sized>(
        &mut self,
        observed: &mut ObservedStep<'_, '_, f64, Vec<f64>, F, O>,
    ) -> Result<ControlFlow<()>, IntegrationError<f64>> {
        let step = observed.step();
        let (end, mut state) = (step.end().0, step.end().1.clone());
        while let Some(t) = self.next().filter(|&t| t <= end) {
            observed.write_state_at(t, &mut state)?;
            self.states.push((t, state.clone()));
        }
        Ok(self.step(&observed.step()))
    }
}

/// The motion of a mechanism from q and v at the first of `times` to the last. `events` are functions of t, q and v, which
/// crossings count (negative: falling, positive: rising, 0: both), and whether one ends the motion.
#[pyfunction]
pub fn simulate<'py>(
    py: Python<'py>,
    owner: &Bound<'py, Mechanism>,
    times: Vec<f64>,
    start: (Bound<'py, PyAny>, Bound<'py, PyAny>),
    torque: Option<Bound<'py, PyAny>>,
    events: Vec<(Bound<'py, PyAny>, f64, bool)>,
    method: Method,
) -> PyResult<Bound<'py, PyDict>> {
    let owner = owner.get();
    let model = owner.one()?.model.clone();
    let (Some(&first), Some(&last)) = (times.first(), times.last()) else {
        return Err(PyValueError::new_err("t must have the instants of the motion, the start among them"));
    };
    if !(times.is_sorted() && first.is_finite() && last.is_finite()) {
        return Err(PyValueError::new_err("t must be finite, and no instant before the one that precedes it"));
    }
    method.check()?;
    let (q, v) = (owner.vector(&start.0, Argument::Coordinates)?, owner.vector(&start.1, Argument::Velocities)?);
    let raised = Raised::default();
    let mechanism = GenericMechanism::new(model);
    let function: Py<PyAny>;
    let law = match torque {
        None => Law::Constant(vec![0.0; v.len()]),
        Some(torque) if torque.is_callable() => {
            function = torque.unbind();
            Law::Function { function: &function, owner, raised: &raised }
        }
        Some(constant) => Law::Constant(owner.vector(&constant, Argument::Forces)?),
    };
    let (mut system, start) = begin(&mechanism, law, (q, v))?;
    let events: Vec<(Py<PyAny>, f64, bool)> =
        events.into_iter().map(|(function, direction, ends)| (function.unbind(), direction, ends)).collect();
    // Other threads run between the calls of functions of Python.
    let (solution, states, occurred) = py.detach(|| {
        let values: Vec<_> = events.iter().map(|(function, ..)| value(function, &mechanism, &raised)).collect();
        let directions = events.iter().map(|(_, direction, _)| direction_of(*direction));
        let searched = values.iter().zip(directions).map(|(value, direction)| Event::new(direction, value));
        let mut searched: Vec<Event<'_, f64, Vec<f64>>> = searched.collect();
        let mut occurred = Vec::new();
        let mut keeper = Keeper { times: &times, states: Vec::new(), raised: &raised, watched: Instant::now() };
        while keeper.next() == Some(first) {
            keeper.states.push((first, start.clone()));
        }
        let on_event = |Occurrence { event, t, y, .. }: Occurrence<'_, f64, Vec<f64>>| {
            occurred.push((event, t, y.clone()));
            if events[event].2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let (ode, interval) = (system.ode(), (first, last));
        let solution = method.run(Task { ode, interval, start, events: &mut searched, keeper: &mut keeper, on_event });
        (solution, keeper.states, occurred)
    });
    check(&raised)?;
    let solution = solution.map_err(|error| explained(&error, &system))?;
    let mut rows = Rows::default();
    for (t, state) in &states {
        system.add(&mechanism, *t, state, &mut rows)?;
    }
    // An event that ends the motion is its last row.
    if rows.t.last().is_some_and(|t| *t < solution.t) && solution.t < last {
        system.add(&mechanism, solution.t, &solution.y, &mut rows)?;
    }
    check(&raised)?;
    found(py, &mechanism, rows, &occurred, &solution)
}

/// The system and the state to start from; loops are closed there, by the joints without an actuator.
fn begin<'a>(
    mechanism: &'a GenericMechanism,
    law: Law<'a>,
    (q, v): (Vec<f64>, Vec<f64>),
) -> PyResult<(System<'a>, Vec<f64>)> {
    let model: &Model = mechanism.model();
    if model.loops.is_empty() {
        let simulation = ForwardSimulation::new(mechanism, law);
        let start = simulation.extended_state(&q, &v);
        return Ok((System::Tree(simulation), start));
    }
    let loops = ClosedLoop::new(mechanism);
    let actuated = mechanism.tree().actuated();
    let held: Vec<usize> = (0..v.len()).filter(|&velocity| actuated[velocity]).collect();
    let closed = loops
        .assemble(&q, &v, &held)
        .or_else(|_| loops.assemble(&q, &v, &[]))
        .map_err(|reason| fault(&format!("the start: {}", loops.with_names(reason)), "give another q or v"))?;
    let simulation = ClosedLoopSimulation::new(loops, law);
    let start = simulation.extended_state(&closed.q, &closed.v);
    Ok((System::Loops(simulation), start))
}

/// The function of an event, of time and state.
fn value<'a>(
    function: &'a Py<PyAny>,
    mechanism: &'a GenericMechanism,
    raised: &'a Raised,
) -> impl Fn(f64, &Vec<f64>) -> f64 + 'a {
    move |t, state| {
        let parts = ForwardSimulation::new(mechanism, ()).split(state);
        let value = Python::attach(|py| {
            let value = called(function.bind(py), t, &parts.q, &parts.v)?;
            value.extract().map_err(|_| PyTypeError::new_err("an event must return a number"))
        });
        value.unwrap_or_else(|error| {
            raise(raised, error);
            f64::NAN
        })
    }
}

fn direction_of(direction: f64) -> Direction {
    match direction {
        direction if direction > 0.0 => Direction::Rising,
        direction if direction < 0.0 => Direction::Falling,
        _ => Direction::Any,
    }
}

/// Why an integration ended.
fn explained(error: &IntegrationError<f64>, system: &System<'_>) -> PyErr {
    let of_loops = match system {
        System::Tree(_) => None,
        System::Loops(simulation) => {
            simulation.last_error().map(|reason| simulation.loops().with_names(reason).to_string())
        }
    };
    let help = match error {
        IntegrationError::Stiff { .. } => "take integrator=\"Ode15s\" or \"Radau5\"",
        IntegrationError::TooManySteps { .. } => "take larger steps or tolerances, or an earlier end",
        _ => "",
    };
    fault(&of_loops.unwrap_or_else(|| error.to_string()), help)
}

/// The motion as a dictionary of arrays.
fn found<'py>(
    py: Python<'py>,
    mechanism: &GenericMechanism,
    rows: Rows,
    occurred: &[(usize, f64, Vec<f64>)],
    solution: &Solution<f64, Vec<f64>>,
) -> PyResult<Bound<'py, PyDict>> {
    let found = PyDict::new(py);
    found.set_item("t", PyArray1::from_vec(py, rows.t))?;
    let tables = [
        ("q", rows.q),
        ("v", rows.v),
        ("a", rows.a),
        ("tau", rows.tau),
        ("multipliers", rows.multipliers),
        ("energy", rows.energy),
    ];
    for (name, rows) in tables {
        found.set_item(name, PyArray2::from_vec2(py, &rows)?)?;
    }
    let occurrences = occurred.iter().map(|(event, t, state)| {
        let parts = ForwardSimulation::new(mechanism, ()).split(state);
        (*event, *t, PyArray1::from_vec(py, parts.q), PyArray1::from_vec(py, parts.v))
    });
    found.set_item("events", occurrences.collect::<Vec<_>>())?;
    let statistics = PyDict::new(py);
    let of = &solution.statistics;
    for (name, number) in [
        ("steps", of.steps),
        ("rejected", of.rejected),
        ("evaluations", of.evaluations),
        ("corrections", of.corrections),
        ("jacobians", of.jacobians),
        ("decompositions", of.decompositions),
    ] {
        statistics.set_item(name, number)?;
    }
    found.set_item("statistics", statistics)?;
    Ok(found)
}

impl Mechanism {
    /// The numbers of one vector.
    fn vector(&self, object: &Bound<'_, PyAny>, argument: Argument) -> PyResult<Vec<f64>> {
        let input = Input::new(object, &Layout::of_argument(argument, self.interface()), &self.interface().name)?;
        input.of_one_state()
    }
}
