//! The compiled part of the Python package `redysim`.

mod arrays;
mod compiled;
mod compiler;
mod evaluator;
mod load;
mod mechanism;
mod method;
mod robots;
mod scenario;
mod simulate;
mod source_file;
mod sweep;

use pyo3::prelude::*;

#[pymodule]
mod _core {
    use super::*;
    use redysim_model::Function;

    #[pymodule_export]
    use super::load::{ModelWarning, RedysimError, load, restored};
    #[pymodule_export]
    use super::mechanism::Mechanism;
    #[pymodule_export]
    use super::scenario::{compute, page, read_results, runs_of_scenario};
    #[pymodule_export]
    use super::simulate::simulate;
    #[pymodule_export]
    use super::sweep::{Rows, Sampler, Study};

    /// The name of every function, the names of its arguments, and the name of the record that it returns, if it is one.
    #[pyfunction]
    fn table_of_functions() -> Vec<(&'static str, Vec<&'static str>, Option<&'static str>)> {
        let row = |function: &Function| {
            let signature = function.signature();
            let arguments = signature.arguments.iter().map(|argument| argument.name()).collect();
            (function.name(), arguments, signature.result.form().structure.map(|structure| structure.name))
        };
        Function::ALL.iter().map(row).collect()
    }

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
