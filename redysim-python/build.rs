//! The methods of `Mechanism` from redysim's table of functions: their arguments, text signatures and documentation.

use redysim_runtime::Function;
use std::{env, fs, path::Path};

#[path = "src/documentation.rs"]
mod documentation;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src/documentation.rs");
    let methods: String = Function::ALL.iter().map(|function| method(*function)).collect();
    let path = Path::new(&env::var("OUT_DIR").expect("cargo sets it")).join("functions.rs");
    fs::write(path, format!("#[pymethods]\nimpl Mechanism {{\n{methods}}}\n")).expect("the folder is cargo's");
}

/// The method of one function, which passes its arguments on.
fn method(function: Function) -> String {
    let names: Vec<&str> = function.signature().arguments.iter().map(|argument| argument.name()).collect();
    let parameters: String = names.iter().map(|name| format!("{name}: &Bound<'py, PyAny>, ")).collect();
    let text_signature: String = names.iter().map(|name| format!("{name}, ")).collect();
    format!(
        "#[doc = {:?}]\n#[pyo3(signature = ({text_signature}*, out=None))]\nfn {name}<'py>(&self, py: Python<'py>, \
         {parameters}out: Option<&Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {{\n    self.call(py, \
         Function::{function:?}, &[{list}], out)\n}}\n",
        documentation::of(function),
        name = function.name(),
        list = names.join(", "),
    )
}
