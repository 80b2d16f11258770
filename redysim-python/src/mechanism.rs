//! `redysim.Mechanism`: a model with its functions.

mod names;

use crate::arrays::{self, Input, Inputs, Layout};
use crate::compiled::{Compiled, Entry};
use crate::evaluator::{Evaluator, OfRobots};
use crate::load::{error, fault};
use crate::robots::Robots;
use crate::source_file::SourceFile;
use numpy::PyArrayDescr;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyBytes, PyDict, PyTuple};
use redysim_cli::ModelFile;
use redysim_model::{CodegenOptions, Function, Functions, Model, PublicInterface, Tree};
use std::ffi::OsString;
use std::path::PathBuf;
use std::ptr;
use std::sync::{Arc, OnceLock};

/// A mechanism that was read from a model file or a URDF: names, sizes and functions.
///
/// Vectors have the model's order. Coordinates of a spherical joint are the unit quaternion x, y, z, w, its velocities the
/// angular velocity in the link's frame; those of a free joint are x, y, z and the quaternion, and the linear velocity of
/// the link's origin, then the angular velocity, both in the link's frame. All numbers are in SI units, angles in radians.
#[pyclass(module = "redysim", frozen)]
pub struct Mechanism {
    /// Its model, with the run-time parameters of this robot; with those of the file if there are several robots.
    pub file: ModelFile,
    tree: Tree,
    robots: Robots,
    shared: Arc<Shared>,
}

/// What mechanisms with other run-time parameters share.
struct Shared {
    /// Where the model was read, and what was there.
    source: SourceFile,
    /// The model that was read.
    model: Model,
    interface: PublicInterface,
    /// Of each function.
    signatures: Vec<Signature>,
    compiled: OnceLock<Compiled>,
}

/// The arrays of a function.
struct Signature {
    arguments: Vec<Layout>,
    result: Layout,
    /// The dtype of the result, when it is first needed.
    dtype: PyOnceLock<Py<PyArrayDescr>>,
}

impl Signature {
    fn new(function: Function, interface: &PublicInterface) -> Self {
        let redysim_runtime::function::Signature { arguments, result, .. } = function.signature();
        Signature {
            arguments: arguments.iter().map(|argument| Layout::of_argument(*argument, interface)).collect(),
            result: Layout::of_result(result, interface),
            dtype: PyOnceLock::new(),
        }
    }
}

impl Mechanism {
    /// The mechanism of a file.
    ///
    /// # Errors
    /// Every fault of the file.
    pub fn new(source: SourceFile) -> PyResult<Self> {
        let file = source.model().map_err(error)?;
        let options = CodegenOptions { parameters: file.options.parameters.clone(), ..CodegenOptions::default() };
        let interface = PublicInterface::new(&file.model, &options);
        Ok(Mechanism {
            tree: Tree::new(&file.model),
            robots: Robots::of_model(&interface),
            shared: Arc::new(Shared {
                source,
                model: file.model.clone(),
                signatures: Function::ALL.iter().map(|function| Signature::new(*function, &interface)).collect(),
                interface,
                compiled: OnceLock::new(),
            }),
            file,
        })
    }

    pub fn interface(&self) -> &PublicInterface {
        &self.shared.interface
    }

    /// The model of one robot.
    ///
    /// # Errors
    /// If there are several.
    pub fn one(&self) -> PyResult<&ModelFile> {
        match self.robots.count {
            None => Ok(&self.file),
            Some(count) => Err(PyValueError::new_err(format!(
                "{:?} is {count} robots here: select one, as by robot.with_parameters(robot.parameters[0])",
                self.interface().name
            ))),
        }
    }

    /// Compiles the functions of these names, by default those of the file, unless they are.
    ///
    /// # Errors
    /// As `compile`.
    pub fn make_compiled(&self, names: Option<&[String]>, compiler: Option<OsString>) -> PyResult<()> {
        let (shared, options) = (&self.shared, &self.file.options);
        let named = |name: &String| {
            name.parse::<Function>().map_err(|error| PyValueError::new_err(format!("functions: {name:?} is {error}")))
        };
        let functions = match names {
            Some(names) => Functions::of(names.iter().map(named).collect::<PyResult<Vec<_>>>()?),
            None => options.functions,
        };
        if let Some(compiled) = shared.compiled.get() {
            return match functions.iter().find(|function| !compiled.functions.contains(*function)) {
                Some(function) => Err(fault(
                    &format!("{:?} is compiled already, without {function}", self.interface().name),
                    "load it again, and name all functions by compile(functions=[...])",
                )),
                None => Ok(()),
            };
        }
        let compiled = Compiled::new(&shared.model, (functions, &options.parameters), compiler)?;
        // Another thread may have been faster.
        let _ = shared.compiled.set(compiled);
        Ok(())
    }

    /// The results of a function of arrays.
    fn call<'py>(
        &self,
        py: Python<'py>,
        function: Function,
        arguments: &[&Bound<'py, PyAny>],
        out: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let Signature { arguments: layouts, result, dtype } = &self.shared.signatures[function as usize];
        let dtype = dtype.get_or_try_init(py, || result.dtype(py).map(Bound::unbind))?.bind(py);
        let robots = &self.robots;
        let mut evaluator = match robots.count {
            None => Evaluator::Tree(&self.tree),
            Some(_) => Evaluator::Trees(&self.shared.model, &self.file.options.parameters),
        };
        let mut of_robots = OfRobots { numbers: &robots.values, count: robots.count };
        if let Some(compiled) = self.shared.compiled.get() {
            self.shared.source.watch()?;
            if let Some(entry) = compiled.entry(function) {
                of_robots.numbers = robots.given(compiled);
                if let Some(done) = one_state(py, (entry, of_robots), (layouts, arguments), (result, dtype), out)? {
                    return Ok(done);
                }
                evaluator = Evaluator::Compiled(entry);
            }
        }
        let mut inputs = Inputs::default();
        for (layout, object) in layouts.iter().zip(arguments) {
            inputs.push(Input::new(object, layout, &self.interface().name)?);
        }
        let count = inputs.common_count(robots.count)?;
        let output = arrays::output(py, out, (result, dtype), count, &inputs)?;
        evaluator.evaluate(py, function, &inputs, of_robots, &output);
        Ok(output.object)
    }
}

/// Runs compiled code for one state whose arrays are as they are nearly always: what this takes is most of the time of a
/// call. Otherwise the result is `None`.
fn one_state<'py>(
    py: Python<'py>,
    (entry, robots): (Entry, OfRobots<'_>),
    (layouts, arguments): (&[Layout], &[&Bound<'py, PyAny>]),
    (result, dtype): (&Layout, &Bound<'py, PyArrayDescr>),
    out: Option<&Bound<'py, PyAny>>,
) -> PyResult<Option<Bound<'py, PyAny>>> {
    let mut data: [*const f64; 4] = [ptr::null(); 4];
    for ((layout, object), data) in layouts.iter().zip(arguments).zip(&mut data) {
        let Some(numbers) = arrays::argument_of_one(object, layout) else { return Ok(None) };
        *data = numbers;
    }
    if robots.count.is_some() {
        return Ok(None);
    }
    data[arguments.len()] = robots.numbers.as_ptr();
    let Some((array, place)) = arrays::result_of_one(py, out, (result, dtype))? else { return Ok(None) };
    if layouts.iter().zip(data).any(|(layout, data)| result.overlaps(place, layout, data)) {
        return Ok(None);
    }
    // SAFETY: the arrays have as many numbers as the code takes and gives for one state, and the result is apart.
    unsafe { entry(1, data.as_ptr(), [0; 4].as_ptr(), place) };
    Ok(Some(array))
}

#[pymethods]
impl Mechanism {
    /// Its name.
    #[getter]
    fn name(&self) -> &str {
        &self.shared.interface.name
    }

    /// The file of which it was made.
    #[getter]
    fn path(&self) -> PathBuf {
        self.shared.source.path.clone()
    }

    /// What the command `redysim check` would warn of, as it is shown there.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.file.warnings.clone()
    }

    /// Number of run-time parameters.
    #[getter]
    fn np(&self) -> usize {
        self.interface().parameters.len()
    }

    /// Names of the run-time parameters.
    #[getter]
    fn parameter_names(&self) -> Vec<&str> {
        self.interface().parameters.iter().map(|parameter| parameter.name.as_str()).collect()
    }

    /// Values of the run-time parameters, (np,), or (k, np) of k robots: kg, m, kg m² and so on.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.robots.array(py, self.np())
    }

    /// The mechanism with other values of its run-time parameters, compiled if this one is. What depends on them alone is
    /// computed once.
    ///
    /// Parameters
    /// ----------
    /// parameters : float64, (np,) or (k, np), or dict
    ///     Values in the order of `parameter_names`; of k robots, each of which computes one of k states. A dictionary has
    ///     names with values, () or (k,); the other ones stay as they are.
    ///
    /// Returns
    /// -------
    /// Mechanism
    ///     Another mechanism: this one stays as it is.
    ///
    /// Raises
    /// ------
    /// ValueError
    ///     If no rigid body or joint can have a value: the first one, with its name and the rule.
    pub fn with_parameters(&self, parameters: &Bound<'_, PyAny>) -> PyResult<Mechanism> {
        let robots = self.robots.with(parameters, self.interface())?;
        let mut file = self.file.clone();
        file.model = match robots.count {
            None => self.shared.model.with_parameters(&file.options.parameters, &robots.values),
            Some(_) => self.shared.model.clone(),
        };
        Ok(Mechanism { tree: Tree::new(&file.model), robots, shared: Arc::clone(&self.shared), file })
    }

    /// What pickle keeps: the text of the model, and how it was made a mechanism.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let SourceFile { bytes, path, floating, parameters, .. } = &self.shared.source;
        let source = (PyBytes::new(py, bytes), path.clone(), *floating, parameters.clone());
        let values = (self.np() > 0).then(|| self.parameters(py)).transpose()?;
        let restored = py.import("redysim._core")?.getattr("restored")?;
        let names = |compiled: &Compiled| compiled.functions.iter().map(Function::name).collect::<Vec<_>>();
        let compiled = self.shared.compiled.get().map(names);
        Ok((restored, (source, values, compiled).into_pyobject(py)?))
    }

    /// Mass of all links, kg.
    #[getter]
    fn mass(&self) -> PyResult<f64> {
        Ok(self.one()?.model.mass())
    }

    /// Acceleration of gravity in the base frame, m/s².
    #[getter]
    fn gravity(&self) -> PyResult<(f64, f64, f64)> {
        Ok(self.one()?.model.gravity.0.into())
    }

    /// Writes functions as C, compiles them by the system's compiler, and has every later call run the compiled code.
    ///
    /// The library is kept in a folder, under a name that depends on the model, the compiler and the processor: the next time
    /// it is loaded.
    ///
    /// Parameters
    /// ----------
    /// functions : sequence of str, optional
    ///     The names of the functions; by default those of the key `functions` of the model file, or all. The run-time path
    ///     computes the others.
    /// compiler : str, optional
    ///     The compiler; by default the environment variable CC, or cc.
    ///
    /// Returns
    /// -------
    /// Mechanism
    ///     The mechanism itself.
    ///
    /// Raises
    /// ------
    /// RedysimError
    ///     If the compiler is missing or fails, if the file has changed since it was loaded, or if other functions of the
    ///     mechanism are compiled already.
    #[pyo3(signature = (*, functions=None, compiler=None))]
    fn compile<'py>(
        slf: Bound<'py, Self>,
        functions: Option<Vec<String>>,
        compiler: Option<OsString>,
    ) -> PyResult<Bound<'py, Self>> {
        let mechanism = slf.get();
        mechanism.shared.source.check_unchanged()?;
        slf.py().detach(|| mechanism.make_compiled(functions.as_deref(), compiler))?;
        Ok(slf)
    }

    /// Whether functions are compiled.
    #[getter]
    fn is_compiled(&self) -> bool {
        self.shared.compiled.get().is_some()
    }

    /// The names of the functions that are compiled.
    #[getter]
    fn compiled_functions(&self) -> Vec<&'static str> {
        let compiled = self.shared.compiled.get();
        let is_compiled = |function: &Function| compiled.is_some_and(|compiled| compiled.entry(*function).is_some());
        Function::ALL.iter().copied().filter(is_compiled).map(Function::name).collect()
    }

    /// The library of compiled functions, if they are compiled.
    #[getter]
    fn library(&self) -> Option<PathBuf> {
        self.shared.compiled.get().map(|compiled| compiled.path.clone())
    }

    /// Fails if the file has changed since it was loaded.
    ///
    /// Raises
    /// ------
    /// RedysimError
    ///     If it has: this mechanism, and compiled functions of it, are those of the file as it was.
    fn check_unchanged(&self) -> PyResult<()> {
        self.shared.source.check_unchanged()
    }

    /// The motion from q and v at the first instant of t to the last.
    ///
    /// Parameters
    /// ----------
    /// t : float64, (m,)
    ///     The instants at which the motion is returned, s: the start first, the end last.
    /// q : float64, (nq,), optional
    ///     Coordinates at the start, rad or m; by default the zero position. Loops are closed from there, where possible with
    ///     the joints that have an actuator as they are.
    /// v : float64, (nv,), optional
    ///     Velocities at the start, rad/s or m/s; by default zero.
    /// torque : callable or float64, (nv,), optional
    ///     Joint forces, N m or N: constant, or a function of t, q and v; by default zero.
    /// events : sequence of callables, optional
    ///     Functions of t, q and v whose crossings of zero are found. As for scipy.integrate.solve_ivp, an attribute
    ///     `direction` selects rising (1) or falling (-1) ones, and with `terminal = True` one ends the motion.
    /// integrator : str
    ///     Steps from tolerances: Ode45, Dop853, and for stiff equations Ode15s, Radau5. Steps of one size:
    ///     SemiImplicitEuler, Ode4, Ode5, Dop8, Gauss4, Gauss6.
    /// rtol, atol : float
    ///     Relative and absolute tolerance.
    /// max_step : float, optional
    ///     The largest step from tolerances, s; by default a tenth of the motion.
    /// step : float, optional
    ///     The size of steps of one size, s.
    /// stops : float64, (k,), optional
    ///     Times at which a step from tolerances ends, s: where joint forces begin, change or end, so that no step passes over what
    ///     is short compared with the motion.
    ///
    /// Returns
    /// -------
    /// Motion
    ///     t, q, v, a, tau, the multipliers of loops, energies and events.
    ///
    /// Raises
    /// ------
    /// RedysimError
    ///     If the motion cannot be computed to its end; or what a function of yours raises.
    #[pyo3(signature = (t, q=None, v=None, *, torque=None, events=None, integrator="Ode45", rtol=1e-6, atol=1e-9,
        max_step=None, step=None, stops=None))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn simulate<'py>(
        slf: Bound<'py, Self>,
        t: Bound<'py, PyAny>,
        q: Option<Bound<'py, PyAny>>,
        v: Option<Bound<'py, PyAny>>,
        torque: Option<Bound<'py, PyAny>>,
        events: Option<Bound<'py, PyAny>>,
        integrator: &str,
        rtol: f64,
        atol: f64,
        max_step: Option<f64>,
        step: Option<f64>,
        stops: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = slf.py();
        let options = PyDict::new(py);
        options.set_item("torque", torque)?;
        options.set_item("events", events.unwrap_or_else(|| PyTuple::empty(py).into_any()))?;
        options.set_item("integrator", integrator)?;
        options.set_item("rtol", rtol)?;
        options.set_item("atol", atol)?;
        options.set_item("max_step", max_step)?;
        options.set_item("step", step)?;
        options.set_item("stops", stops.unwrap_or_else(|| PyTuple::empty(py).into_any()))?;
        py.import("redysim._results")?.getattr("simulate")?.call((slf, t, q, v), Some(&options))
    }

    /// The model as the text of a model file.
    fn to_toml(&self) -> PyResult<String> {
        Ok(self.one()?.model.to_toml())
    }

    fn _repr_html_<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let page = slf.get().page()?;
        slf.py().import("redysim._results")?.getattr("in_frame")?.call1((page,))
    }

    /// The page of HTML that shows the model in 3D and moves its joints by sliders, as `redysim show` makes it.
    fn page(&self) -> PyResult<String> {
        self.one()?.page().map_err(error)
    }

    fn __repr__(&self) -> String {
        let sizes = [
            ("nq", self.nq()),
            ("nv", self.nv()),
            ("nl", self.nl()),
            ("nc", self.nc()),
            ("nf", self.nf()),
            ("np", self.np()),
        ];
        let sizes = sizes.into_iter().filter(|(name, size)| *size > 0 || ["nq", "nv"].contains(name));
        let sizes: String = sizes.map(|(name, size)| format!(", {name}={size}")).collect();
        let robots = self.robots.count.map_or_else(String::new, |count| format!(", of {count} robots"));
        format!("<redysim.Mechanism {:?}{sizes}{robots}>", self.interface().name)
    }
}

include!(concat!(env!("OUT_DIR"), "/functions.rs"));
