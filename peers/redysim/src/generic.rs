//! redysim's generic path: the model is read when the timer calls `prepare`.

use std::cell::UnsafeCell;
use std::ffi::{CStr, c_char, c_int};
use std::slice;

use redysim::Mechanism;
use redysim::generic::{GenericMechanism, Model, Workspace};

/// The mechanism, with room and results that live from call to call, as those of a program would.
struct Prepared {
    mechanism: GenericMechanism,
    workspace: Workspace<f64>,
    result: Vec<f64>,
    matrix: Vec<f64>,
}

struct Slot(UnsafeCell<Option<Prepared>>);

// SAFETY: the timer has one thread.
unsafe impl Sync for Slot {}

static SLOT: Slot = Slot(UnsafeCell::new(None));

impl Slot {
    /// What was prepared, and the three vectors of the state at this address.
    fn at(&self, state: *const f64) -> (&mut Prepared, [&[f64]; 3]) {
        // SAFETY: the timer has one thread, and keeps no result over a further call.
        let prepared = unsafe { &mut *self.0.get() }.as_mut().expect("`prepare` is called first");
        let (nq, nv) = (prepared.mechanism.nq(), prepared.mechanism.nv());
        // SAFETY: a state is three vectors, one after another.
        let state = unsafe { slice::from_raw_parts(state, nq + 2 * nv) };
        let (q, rest) = state.split_at(nq);
        let (v, input) = rest.split_at(nv);
        (prepared, [q, v, input])
    }
}

#[unsafe(no_mangle)]
extern "C" fn prepare(robot: *const c_char) -> c_int {
    // SAFETY: the timer hands over a C string.
    let path = unsafe { CStr::from_ptr(robot) }.to_string_lossy();
    match Model::load(path.as_ref()) {
        Ok(loaded) => {
            let mechanism = GenericMechanism::new(loaded.model);
            let nv = mechanism.nv();
            let (result, matrix) = (vec![0.0; nv], vec![0.0; nv * nv]);
            // SAFETY: the timer has one thread.
            unsafe { *SLOT.0.get() = Some(Prepared { mechanism, workspace: Workspace::default(), result, matrix }) };
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
    let (Prepared { mechanism, workspace, result, .. }, [q, v, a]) = SLOT.at(state);
    mechanism.inverse_dynamics_in(workspace, q, v, a, result);
    result.as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn generic_forward(state: *const f64, _: *mut f64) -> *const f64 {
    let (Prepared { mechanism, workspace, result, .. }, [q, v, tau]) = SLOT.at(state);
    mechanism.forward_dynamics_in(workspace, q, v, tau, result);
    result.as_ptr()
}

#[unsafe(no_mangle)]
extern "C" fn generic_mass(state: *const f64, _: *mut f64) -> *const f64 {
    let (Prepared { mechanism, workspace, matrix, .. }, [q, ..]) = SLOT.at(state);
    mechanism.mass_matrix_in(workspace, q, matrix);
    matrix.as_ptr()
}
