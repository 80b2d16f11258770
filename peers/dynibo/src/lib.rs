//! dynibo as the timer calls it (see `peers/programs/timer.c`). Results are written where the timer wants them.

use std::cell::UnsafeCell;
use std::ffi::{CStr, c_char, c_int};
use std::slice;

use dynibo::Robot;

struct Slot(UnsafeCell<Option<Robot>>);

// SAFETY: the timer has one thread.
unsafe impl Sync for Slot {}

static SLOT: Slot = Slot(UnsafeCell::new(None));

#[unsafe(no_mangle)]
extern "C" fn prepare(robot: *const c_char) -> c_int {
    // SAFETY: the timer hands over a C string.
    let path = unsafe { CStr::from_ptr(robot) }.to_string_lossy();
    match Robot::from_urdf(path.as_ref()) {
        Ok(robot) => {
            // SAFETY: the timer has one thread.
            unsafe { *SLOT.0.get() = Some(robot) };
            0
        }
        Err(error) => {
            eprintln!("dynibo: {error}");
            1
        }
    }
}

/// The robot, its state's three vectors at this address, and a result of `values` numbers.
fn taken<'a>(state: *const f64, result: *mut f64, matrix: bool) -> (&'a mut Robot, [&'a [f64]; 3], &'a mut [f64]) {
    // SAFETY: the timer has one thread, prepares first, and hands over memory for three vectors and a result.
    unsafe {
        let robot = (*SLOT.0.get()).as_mut().expect("`prepare` is called first");
        let dof = robot.generalized_count();
        let part = |k| slice::from_raw_parts(state.add(k * dof), dof);
        (robot, [part(0), part(1), part(2)], slice::from_raw_parts_mut(result, if matrix { dof * dof } else { dof }))
    }
}

#[unsafe(no_mangle)]
extern "C" fn inverse(state: *const f64, result: *mut f64) -> *const f64 {
    let (robot, [q, v, a], output) = taken(state, result, false);
    robot.inverse_dynamics(q, v, a, &[], output).expect("inverse dynamics");
    result
}

#[unsafe(no_mangle)]
extern "C" fn forward(state: *const f64, result: *mut f64) -> *const f64 {
    let (robot, [q, v, tau], output) = taken(state, result, false);
    robot.forward_dynamics(q, v, tau, &[], output).expect("forward dynamics");
    result
}

#[unsafe(no_mangle)]
extern "C" fn mass(state: *const f64, result: *mut f64) -> *const f64 {
    let (robot, [q, ..], output) = taken(state, result, true);
    robot.mass_matrix(q, output).expect("mass matrix");
    result
}
