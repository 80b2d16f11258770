//! redysim's generic path: the model is read when the timer calls `prepare`.

use std::cell::UnsafeCell;
use std::ffi::{CStr, c_char, c_int};
use std::slice;

use redysim::generic::{GenericMechanism, Model};
use redysim::{ForwardDynamics, InverseDynamics, MassMatrix, Mechanism};

/// The mechanism, and vectors that live from call to call, as those of a program would.
struct Prepared {
    mechanism: GenericMechanism,
    q: Vec<f64>,
    v: Vec<f64>,
    input: Vec<f64>,
    result: Vec<f64>,
    matrix: Vec<Vec<f64>>,
}

struct Slot(UnsafeCell<Option<Prepared>>);

// SAFETY: the timer has one thread.
unsafe impl Sync for Slot {}

static SLOT: Slot = Slot(UnsafeCell::new(None));

impl Slot {
    /// What was prepared, with the state at this address taken over.
    fn at(&self, state: *const f64) -> &mut Prepared {
        // SAFETY: the timer has one thread, and keeps no result over a further call.
        let prepared = unsafe { &mut *self.0.get() }.as_mut().expect("`prepare` is called first");
        let dof = prepared.q.len();
        // SAFETY: a state is three vectors, one after another.
        let state = unsafe { slice::from_raw_parts(state, 3 * dof) };
        prepared.q.copy_from_slice(&state[..dof]);
        prepared.v.copy_from_slice(&state[dof..2 * dof]);
        prepared.input.copy_from_slice(&state[2 * dof..]);
        prepared
    }
}

#[unsafe(no_mangle)]
extern "C" fn prepare(robot: *const c_char) -> c_int {
    // SAFETY: the timer hands over a C string.
    let path = unsafe { CStr::from_ptr(robot) }.to_string_lossy();
    match Model::load(path.as_ref()) {
        Ok(loaded) => {
            let mechanism = GenericMechanism::new(loaded.model);
            let zeros = vec![0.0; Mechanism::<f64>::nv(&mechanism)];
            let [q, v, input, result] = [zeros.clone(), zeros.clone(), zeros.clone(), zeros];
            // SAFETY: the timer has one thread.
            unsafe { *SLOT.0.get() = Some(Prepared { mechanism, q, v, input, result, matrix: Vec::new() }) };
            0
        }
        Err(faults) => {
            eprintln!("{faults}");
            1
        }
    }
}

#[unsafe(no_mangle)]
extern "C" fn generic_inverse(state: *const f64, _: *mut f64) -> *const f64 {
    let prepared = SLOT.at(state);
    prepared.result = prepared.mechanism.inverse_dynamics(&prepared.q, &prepared.v, &prepared.input);
    prepared.result.as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn generic_forward(state: *const f64, _: *mut f64) -> *const f64 {
    let prepared = SLOT.at(state);
    prepared.result = prepared.mechanism.forward_dynamics(&prepared.q, &prepared.v, &prepared.input);
    prepared.result.as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn generic_mass(state: *const f64, _: *mut f64) -> *const f64 {
    let prepared = SLOT.at(state);
    prepared.matrix = prepared.mechanism.mass_matrix(&prepared.q);
    prepared.matrix[0].as_ptr()
}

/// The matrix of the last call in one piece, for the check.
#[unsafe(no_mangle)]
extern "C" fn generic_mass_result(state: *const f64, _: *mut f64) -> *const f64 {
    let prepared = SLOT.at(state);
    prepared.result = prepared.matrix.concat();
    prepared.result.as_ptr()
}
