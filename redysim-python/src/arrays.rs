//! Arrays of NumPy as arguments and results: their shapes, dtypes and memory.

use numpy::npyffi::{self, PY_ARRAY_API};
use numpy::{
    Element, PyArrayDescr, PyArrayDescrMethods, PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods,
    npyffi::{NPY_ARRAY_ALIGNED, NPY_ARRAY_C_CONTIGUOUS, NPY_ARRAY_WRITEABLE},
};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{IntoPyDict, PyDict, PyList, PyTuple, PyType};
use redysim_model::PublicInterface;
use redysim_runtime::function::{Argument, Length, Shape, Structure};
use std::ffi::c_int;
use std::ptr;

/// The array of an argument or a result for one state.
pub struct Layout {
    name: &'static str,
    /// Of what there may be several.
    each: &'static str,
    /// Its shape; of several states, the number of states comes before.
    shape: Vec<usize>,
    /// What an element has in place of a number, with the lengths of its parts.
    structure: Option<(Structure, Vec<Vec<usize>>)>,
    /// How many numbers it has.
    numbers: usize,
}

impl Layout {
    pub fn of_argument(argument: Argument, interface: &PublicInterface) -> Layout {
        let form = argument.form();
        let mut shape = sizes(form.lengths, interface);
        // The numbers of a struct are one more axis.
        shape.extend(form.structure.map(|_| argument.numbers()));
        Layout { name: form.name, each: "state", numbers: product(&shape), shape, structure: None }
    }

    pub fn of_result(shape: Shape, interface: &PublicInterface) -> Layout {
        let form = shape.form();
        let parts = |structure: Structure| -> Vec<Vec<usize>> {
            structure.fields.iter().map(|(_, lengths, _)| sizes(lengths, interface)).collect()
        };
        let structure = form.structure.map(|structure| (structure, parts(structure)));
        let of_element = structure.as_ref().map_or(1, |(_, parts)| parts.iter().map(|part| product(part)).sum());
        let shape = sizes(form.lengths, interface);
        Layout { name: form.name, each: "state", numbers: product(&shape) * of_element, shape, structure }
    }

    /// Of all run-time parameters.
    pub fn of_parameters(length: usize) -> Layout {
        Layout { name: "parameters", each: "robot", shape: vec![length], structure: None, numbers: length }
    }

    /// Of one run-time parameter.
    pub fn of_parameter() -> Layout {
        Layout { name: "the value", each: "robot", shape: Vec::new(), structure: None, numbers: 1 }
    }

    /// The shape for so many states, in the room of `axes`.
    fn shape_of<'a>(&self, count: Option<usize>, axes: &'a mut [usize; 4]) -> &'a [usize] {
        let all = count.into_iter().chain(self.shape.iter().copied());
        let length = axes.iter_mut().zip(all).map(|(axis, size)| *axis = size).count();
        &axes[..length]
    }

    /// The dtype of its elements: float64, or a record of named parts of it.
    pub fn dtype<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArrayDescr>> {
        let Some((structure, parts)) = &self.structure else { return Ok(f64::get_dtype(py)) };
        let fields = structure.fields.iter().zip(parts);
        let fields = fields.map(|((name, ..), part)| Ok((*name, "f8", PyTuple::new(py, part)?)));
        let fields: Vec<_> = fields.collect::<PyResult<_>>()?;
        let numpy = py.import("numpy")?;
        let dtype = numpy.getattr("dtype")?.call1(((numpy.getattr("record")?, PyList::new(py, fields)?),))?;
        Ok(dtype.cast_into()?)
    }
}

fn sizes(lengths: &[Length], interface: &PublicInterface) -> Vec<usize> {
    let size = |length: &Length| match length {
        Length::Size(dimension) => interface.size(*dimension),
        Length::Three => 3,
    };
    lengths.iter().map(size).collect()
}

fn product(shape: &[usize]) -> usize {
    shape.iter().product()
}

/// An argument: the numbers of one state or of several.
pub struct Input<'py> {
    name: &'static str,
    /// Keeps the numbers alive.
    array: Bound<'py, PyArrayDyn<f64>>,
    pub data: *const f64,
    /// The numbers of a state.
    pub length: usize,
    /// How many states it has; `None` for one without an axis for them.
    count: Option<usize>,
}

impl<'py> Input<'py> {
    /// The array of `object`, of the mechanism `owner`.
    ///
    /// # Errors
    /// If it is not an array of float64 with the shape of `layout`, or that of several states.
    pub fn new(object: &Bound<'py, PyAny>, layout: &Layout, owner: &str) -> PyResult<Input<'py>> {
        let Layout { name, each, shape, .. } = layout;
        let array = match plain(object) {
            Some(array) => array.clone(),
            None => match object.cast::<PyArrayDyn<f64>>() {
                Ok(array) => converted(array.as_any())?,
                Err(_) => of_numbers(object, name)?,
            },
        };
        let found = array.shape();
        let count = match found.strip_suffix(&shape[..]) {
            Some([]) => None,
            Some([count]) => Some(*count),
            _ => {
                let message = format!(
                    "{name} must have the shape {} for one {each} of {owner:?} or {} for k {each}s, not {}",
                    written(shape),
                    written_of_many(shape),
                    written(found)
                );
                return Err(PyValueError::new_err(message));
            }
        };
        Ok(Input { name, data: array.data(), length: layout.numbers, count, array })
    }

    /// From one state to the next: none if the same numbers count for all of them.
    pub fn stride(&self) -> usize {
        if self.count.is_some() { self.length } else { 0 }
    }

    /// All numbers, and of how many states they are.
    pub fn numbers(&self) -> PyResult<(Vec<f64>, Option<usize>)> {
        Ok((self.array.to_vec()?, self.count))
    }

    /// The numbers of one state.
    ///
    /// # Errors
    /// If there are several.
    pub fn of_one_state(&self) -> PyResult<Vec<f64>> {
        match self.count {
            None => Ok(self.array.to_vec()?),
            Some(count) => Err(PyValueError::new_err(format!("{} must be of one state, not of {count}", self.name))),
        }
    }

    fn bytes(&self) -> (usize, usize) {
        let start = self.data as usize;
        (start, start + 8 * self.length * self.count.unwrap_or(1))
    }
}

/// The array if its elements are contiguous `float64` in native byte order, which is the common case. This check takes
/// fewer calls of the Python API than the general conversion.
fn plain<'a, 'py>(object: &'a Bound<'py, PyAny>) -> Option<&'a Bound<'py, PyArrayDyn<f64>>> {
    has_dtype(object, NumPy::get(object.py()).float64.bind(object.py()), READABLE)
        // SAFETY: it is an array of float64, of any number of axes.
        .then(|| unsafe { object.cast_unchecked() })
}

/// What arguments and results must be.
const READABLE: c_int = NPY_ARRAY_C_CONTIGUOUS | NPY_ARRAY_ALIGNED;
const WRITABLE: c_int = READABLE | NPY_ARRAY_WRITEABLE;

/// What is asked of NumPy once.
struct NumPy {
    /// In the machine's order of bytes, of which NumPy has one object.
    float64: Py<PyArrayDescr>,
    array: *mut pyo3::ffi::PyTypeObject,
}

// SAFETY: the type lives as long as NumPy.
unsafe impl Send for NumPy {}
unsafe impl Sync for NumPy {}

impl NumPy {
    fn get(py: Python<'_>) -> &'static NumPy {
        static NUMPY: PyOnceLock<NumPy> = PyOnceLock::new();
        NUMPY.get_or_init(py, || NumPy {
            float64: f64::get_dtype(py).unbind(),
            // SAFETY: the interpreter's lock is held.
            array: unsafe { npyffi::get_type_object(py, npyffi::NpyTypes::PyArray_Type) },
        })
    }
}

/// Whether an object is an array of this very dtype, with these flags.
fn has_dtype(object: &Bound<'_, PyAny>, dtype: &Bound<'_, PyArrayDescr>, flags: c_int) -> bool {
    let py = object.py();
    let is_array = object.get_type_ptr() == NumPy::get(py).array
        // SAFETY: the object is alive.
        || unsafe { npyffi::PyArray_Check(py, object.as_ptr()) != 0 };
    if !is_array {
        return false;
    }
    // SAFETY: it is an array.
    let array = unsafe { &(*object.as_ptr().cast::<npyffi::PyArrayObject>()).fields };
    array.descr.cast() == dtype.as_ptr() && array.flags & flags == flags
}

/// Where the numbers of an argument or a result of one state are, if they stand in an array of the dtype that NumPy has for
/// them: what all others are, or lack, is found by [`Input::new`] and [`output`].
fn of_one(
    object: &Bound<'_, PyAny>,
    layout: &Layout,
    dtype: &Bound<'_, PyArrayDescr>,
    flags: c_int,
) -> Option<*mut f64> {
    if !has_dtype(object, dtype, flags) {
        return None;
    }
    // SAFETY: it is an array, with as many axes.
    let (array, axes) = unsafe {
        let array = &(*object.as_ptr().cast::<npyffi::PyArrayObject>()).fields;
        (array, std::slice::from_raw_parts(array.dimensions.cast::<usize>(), array.nd as usize))
    };
    (axes == layout.shape).then(|| array.data.cast())
}

/// The numbers of an argument of one state, if they stand in an array of float64.
pub fn argument_of_one(object: &Bound<'_, PyAny>, layout: &Layout) -> Option<*const f64> {
    of_one(object, layout, NumPy::get(object.py()).float64.bind(object.py()), READABLE).map(<*mut f64>::cast_const)
}

/// The array for the results of one state and where its numbers are, if `out` is one, or a new one of float64.
pub fn result_of_one<'py>(
    py: Python<'py>,
    out: Option<&Bound<'py, PyAny>>,
    (layout, dtype): (&Layout, &Bound<'py, PyArrayDescr>),
) -> PyResult<Option<(Bound<'py, PyAny>, *mut f64)>> {
    match out {
        Some(out) => Ok(of_one(out, layout, dtype, WRITABLE).map(|data| (out.clone(), data))),
        None => {
            let array = new(py, layout, dtype, &layout.shape)?;
            // SAFETY: the pointer is that of an array, which the reference keeps.
            let data = unsafe { (*array.as_array_ptr()).fields.data }.cast();
            Ok(Some((array.into_any(), data)))
        }
    }
}

impl Layout {
    /// Whether the numbers at `first`, of an array of this layout, and those at `second`, of the other one, overlap.
    pub fn overlaps(&self, first: *const f64, other: &Layout, second: *const f64) -> bool {
        (first as usize) < second as usize + 8 * other.numbers && (second as usize) < first as usize + 8 * self.numbers
    }
}

/// The numbers of something else: a list is converted, an array of another dtype is not.
fn of_numbers<'py>(object: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let help = format!("convert it by numpy.asarray({name}, dtype=numpy.float64)");
    if let Ok(array) = object.cast::<PyUntypedArray>() {
        let message = format!("{name} must be an array of float64, not of {}: {help}", array.dtype());
        return Err(PyTypeError::new_err(message));
    }
    converted(object).map_err(|_| {
        let kind = object.get_type().name().map_or("something else".into(), |name| name.to_string());
        PyTypeError::new_err(format!("{name} must be an array of float64, not a {kind} that does not convert to one"))
    })
}

fn converted<'py>(object: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    static AS_ARRAY: PyOnceLock<Py<PyAny>> = PyOnceLock::new();
    let py = object.py();
    let convert = AS_ARRAY.import(py, "numpy", "array")?;
    let options: Bound<'_, PyDict> = [("dtype", "f8"), ("order", "C")].into_py_dict(py)?;
    Ok(convert.call((object,), Some(&options))?.cast_into()?)
}

/// The arguments of a function, at most three.
#[derive(Default)]
pub struct Inputs<'py> {
    inputs: [Option<Input<'py>>; 3],
    count: usize,
}

impl<'py> Inputs<'py> {
    pub fn push(&mut self, input: Input<'py>) {
        self.inputs[self.count] = Some(input);
        self.count += 1;
    }

    pub fn iter(&self) -> impl Iterator<Item = &Input<'py>> {
        self.inputs.iter().flatten()
    }

    /// How many states the arguments have together, with run-time parameters of so many robots.
    ///
    /// # Errors
    /// If they have different numbers of states.
    pub fn common_count(&self, robots: Option<usize>) -> PyResult<Option<usize>> {
        let robots = robots.map(|count| ("parameters", count));
        let mut counts = self.iter().filter_map(|input| Some((input.name, input.count?))).chain(robots);
        let Some((first, count)) = counts.next() else { return Ok(None) };
        match counts.find(|(_, other)| *other != count) {
            None => Ok(Some(count)),
            Some((name, other)) => Err(PyValueError::new_err(format!(
                "{first} has {count} states and {name} has {other}: give each as many, or one state, which counts for all"
            ))),
        }
    }
}

/// The array to which results are written.
pub struct Output<'py> {
    pub object: Bound<'py, PyAny>,
    pub data: *mut f64,
    /// The numbers of a state.
    pub length: usize,
    /// How many states there are.
    pub count: usize,
}

/// The array for the results: `out`, or a new one.
///
/// # Errors
/// If `out` is not one to which they can be written.
pub fn output<'py>(
    py: Python<'py>,
    out: Option<&Bound<'py, PyAny>>,
    (layout, dtype): (&Layout, &Bound<'py, PyArrayDescr>),
    count: Option<usize>,
    inputs: &Inputs,
) -> PyResult<Output<'py>> {
    let mut axes = [0; 4];
    let shape = layout.shape_of(count, &mut axes);
    let array = match out {
        Some(out) => given(out, dtype, shape, layout.name)?,
        None => new(py, layout, dtype, shape)?,
    };
    // SAFETY: the pointer is that of an array, which the reference keeps.
    let data = unsafe { (*array.as_array_ptr()).fields.data }.cast::<f64>();
    let (length, count) = (layout.numbers, count.unwrap_or(1));
    let (start, end) = (data as usize, data as usize + 8 * length * count);
    let overlaps = |input: &&Input| input.bytes().0 < end && start < input.bytes().1;
    if let Some(Input { name, .. }) = out.and_then(|_| inputs.iter().find(overlaps)) {
        return Err(PyValueError::new_err(format!(
            "out must not overlap {name}: give another array, or a copy of {name}"
        )));
    }
    Ok(Output { object: array.into_any(), data, length, count })
}

/// An array that is given for results.
fn given<'py>(
    out: &Bound<'py, PyAny>,
    dtype: &Bound<'py, PyArrayDescr>,
    shape: &[usize],
    result: &str,
) -> PyResult<Bound<'py, PyUntypedArray>> {
    let Ok(array) = out.cast::<PyUntypedArray>() else {
        let kind = out.get_type().name()?;
        return Err(PyTypeError::new_err(format!("out must be a numpy.ndarray for {result}, not a {kind}")));
    };
    if !array.dtype().is_equiv_to(dtype) {
        let message = format!("out must have the dtype {dtype} for {result}, not {}", array.dtype());
        return Err(PyTypeError::new_err(message));
    }
    if array.shape() != shape {
        let message =
            format!("out must have the shape {} for {result}, not {}", written(shape), written(array.shape()));
        return Err(PyValueError::new_err(message));
    }
    // SAFETY: the pointer is that of an array, which the reference keeps.
    let (flags, data) = unsafe { ((*array.as_array_ptr()).fields.flags, (*array.as_array_ptr()).fields.data) };
    if flags & NPY_ARRAY_WRITEABLE == 0 {
        return Err(PyValueError::new_err("out is read-only: give an array that can be written"));
    }
    if !array.is_c_contiguous() || !data.cast::<f64>().is_aligned() {
        return Err(PyValueError::new_err(
            "out must be contiguous, in C's order: give an array of its own, not a slice",
        ));
    }
    Ok(array.clone())
}

/// A new array for results.
fn new<'py>(
    py: Python<'py>,
    layout: &Layout,
    dtype: &Bound<'py, PyArrayDescr>,
    shape: &[usize],
) -> PyResult<Bound<'py, PyUntypedArray>> {
    static RECORDS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    let kind = match &layout.structure {
        // SAFETY: the type lives as long as NumPy.
        None => unsafe { npyffi::get_type_object(py, npyffi::NpyTypes::PyArray_Type) },
        Some(_) => RECORDS.import(py, "redysim._records", "Records")?.as_type_ptr(),
    };
    let mut axes: [npyffi::npy_intp; 4] = [0; 4];
    axes.iter_mut().zip(shape).for_each(|(axis, &size)| *axis = size as npyffi::npy_intp);
    // SAFETY: the call takes over a reference to the dtype, and copies the axes.
    let array = unsafe {
        let array = PY_ARRAY_API.PyArray_NewFromDescr(
            py,
            kind,
            dtype.clone().into_dtype_ptr(),
            shape.len() as c_int,
            axes.as_mut_ptr(),
            ptr::null_mut(),
            ptr::null_mut(),
            0,
            ptr::null_mut(),
        );
        Bound::from_owned_ptr_or_err(py, array)?
    };
    Ok(array.cast_into()?)
}

/// A shape as Python writes it.
fn written(shape: &[usize]) -> String {
    match shape {
        [one] => format!("({one},)"),
        all => format!("({})", all.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")),
    }
}

fn written_of_many(shape: &[usize]) -> String {
    let axes: Vec<String> = shape.iter().map(usize::to_string).collect();
    if axes.is_empty() { "(k,)".into() } else { format!("(k, {})", axes.join(", ")) }
}
