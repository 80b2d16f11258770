//! Run-time parameters: the numbers of one robot, or of a robot for each state.

use crate::arrays::{Input, Layout};
use crate::compiled::Compiled;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyKeyError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use redysim_model::PublicInterface;
use redysim_runtime::check_parameters;
use std::sync::OnceLock;

/// Stands for the name of a parameter in a message of the runtime, whose names are constants.
const NAME: &str = "\0";

/// The values of the run-time parameters.
pub struct Robots {
    /// Those of each robot, one after the other.
    pub values: Vec<f64>,
    /// How many robots there are; `None` for one without an axis for them.
    pub count: Option<usize>,
    /// What compiled code is given in place of them.
    given: OnceLock<Vec<f64>>,
}

impl Robots {
    fn new(values: Vec<f64>, count: Option<usize>) -> Robots {
        Robots { values, count, given: OnceLock::new() }
    }

    /// The robot of the model.
    pub fn of_model(interface: &PublicInterface) -> Robots {
        Robots::new(interface.parameters.iter().map(|parameter| parameter.value).collect(), None)
    }

    /// Those with the numbers of an array, or of a dictionary of names, in place of their own.
    ///
    /// # Errors
    /// If there are no parameters, a shape or a name is wrong, or a number violates its rule.
    pub fn with(&self, object: &Bound<'_, PyAny>, interface: &PublicInterface) -> PyResult<Robots> {
        let np = interface.parameters.len();
        if np == 0 {
            return Err(PyValueError::new_err(format!(
                "{:?} has no run-time parameters: name them by redysim.load(..., parameters=[...]) or the key `parameters` of \
                 its file",
                interface.name
            )));
        }
        let robots = match object.cast::<PyDict>() {
            Ok(named) => self.with_named(named, interface)?,
            Err(_) => {
                let input = Input::new(object, &Layout::of_parameters(np), &interface.name)?;
                let (values, count) = input.numbers()?;
                Robots::new(values, count)
            }
        };
        robots.check(interface)?;
        Ok(robots)
    }

    fn with_named(&self, named: &Bound<'_, PyDict>, interface: &PublicInterface) -> PyResult<Robots> {
        let np = interface.parameters.len();
        let mut robots = Robots::new(self.values.clone(), self.count);
        for (name, value) in named {
            let name: String = name.extract()?;
            let Some(place) = interface.parameters.iter().position(|parameter| parameter.name == name) else {
                let names: Vec<&str> = interface.parameters.iter().map(|parameter| parameter.name.as_str()).collect();
                return Err(PyKeyError::new_err(format!("{name:?} is not a parameter: give {}", names.join(", "))));
            };
            let (values, count) = Input::new(&value, &Layout::of_parameter(), &name)?.numbers()?;
            robots.count = match (robots.count, count) {
                (None, Some(count)) => {
                    robots.values = robots.values.repeat(count);
                    Some(count)
                }
                (Some(robots), Some(count)) if robots != count => {
                    let message = format!("{name:?} has values for {count} robots, others for {robots}");
                    return Err(PyValueError::new_err(message));
                }
                (count, _) => count,
            };
            for (robot, row) in robots.values.chunks_exact_mut(np).enumerate() {
                row[place] = values[if count.is_some() { robot } else { 0 }];
            }
        }
        Ok(robots)
    }

    fn check(&self, interface: &PublicInterface) -> PyResult<()> {
        let rules: Vec<_> = interface.parameters.iter().map(|parameter| parameter.rule).collect();
        let names = vec![NAME; rules.len()];
        for (robot, values) in self.values.chunks_exact(rules.len()).enumerate() {
            check_parameters(values, &names, &rules).map_err(|fault| {
                let of_robot = if self.count.is_some() { format!("robot {robot}: ") } else { String::new() };
                let name = &interface.parameters[fault.index].name;
                PyValueError::new_err(of_robot + &fault.to_string().replace(NAME, name))
            })?;
        }
        Ok(())
    }

    /// The values as an array.
    pub fn array<'py>(&self, py: Python<'py>, np: usize) -> PyResult<Bound<'py, PyAny>> {
        let values = PyArray1::from_slice(py, &self.values);
        match self.count {
            None => Ok(values.into_any()),
            Some(count) => Ok(values.reshape([count, np])?.into_any()),
        }
    }

    /// The numbers that compiled code is given, of all robots; of one without parameters none.
    pub fn given(&self, compiled: &Compiled) -> &[f64] {
        self.given.get_or_init(|| compiled.given(&self.values, self.count.unwrap_or(1)))
    }
}
