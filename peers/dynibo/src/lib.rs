//! dynibo as the timer calls it (see `peers/programs/timer.c`). Results are written where the timer wants them.

mod floating;

use std::cell::UnsafeCell;
use std::ffi::{CStr, c_char, c_int};
use std::slice;

use dynibo::{Robot, RobotModel};

use floating::Floating;

enum Prepared {
    Fixed(Robot),
    Floating(Floating),
}

struct Slot(UnsafeCell<Option<Prepared>>);

// SAFETY: the timer has one thread.
unsafe impl Sync for Slot {}

static SLOT: Slot = Slot(UnsafeCell::new(None));

#[unsafe(no_mangle)]
extern "C" fn prepare(robot: *const c_char) -> c_int {
    // SAFETY: the timer hands over a C string.
    let path = unsafe { CStr::from_ptr(robot) }.to_string_lossy();
    match RobotModel::from_urdf(path.as_ref()) {
        Ok(model) => {
            // A root with mass floats; a robot on the ground has a root without.
            let prepared = match model.floating_robot() {
                Ok(robot) => Prepared::Floating(Floating::new(robot)),
                Err(_) => Prepared::Fixed(model.robot()),
            };
            // SAFETY: the timer has one thread.
            unsafe { *SLOT.0.get() = Some(prepared) };
            0
        }
        Err(error) => {
            eprintln!("dynibo: {error}");
            1
        }
    }
}

/// What was prepared, its state's three vectors at this address, and a result, a vector or a matrix.
fn taken<'a>(state: *const f64, result: *mut f64, matrix: bool) -> (&'a mut Prepared, [&'a [f64]; 3], &'a mut [f64]) {
    // SAFETY: the timer has one thread, prepares first, and hands over memory for three vectors and a result.
    unsafe {
        let prepared = (*SLOT.0.get()).as_mut().expect("`prepare` is called first");
        let (nq, nv) = match prepared {
            Prepared::Fixed(robot) => (robot.generalized_count(), robot.generalized_count()),
            Prepared::Floating(floating) => (floating.nv() + 1, floating.nv()),
        };
        let part = |start, length| slice::from_raw_parts(state.add(start), length);
        let result = slice::from_raw_parts_mut(result, if matrix { nv * nv } else { nv });
        (prepared, [part(0, nq), part(nq, nv), part(nq + nv, nv)], result)
    }
}

#[unsafe(no_mangle)]
extern "C" fn inverse(state: *const f64, result: *mut f64) -> *const f64 {
    let (prepared, [q, v, a], output) = taken(state, result, false);
    match prepared {
        Prepared::Fixed(robot) => robot.inverse_dynamics(q, v, a, &[], output).expect("inverse dynamics"),
        Prepared::Floating(floating) => floating.inverse_dynamics(q, v, a, output),
    }
    result
}

#[unsafe(no_mangle)]
extern "C" fn forward(state: *const f64, result: *mut f64) -> *const f64 {
    let (prepared, [q, v, tau], output) = taken(state, result, false);
    match prepared {
        Prepared::Fixed(robot) => robot.forward_dynamics(q, v, tau, &[], output).expect("forward dynamics"),
        Prepared::Floating(floating) => floating.forward_dynamics(q, v, tau, output),
    }
    result
}

#[unsafe(no_mangle)]
extern "C" fn mass(state: *const f64, result: *mut f64) -> *const f64 {
    let (prepared, [q, ..], output) = taken(state, result, true);
    match prepared {
        Prepared::Fixed(robot) => robot.mass_matrix(q, output).expect("mass matrix"),
        Prepared::Floating(floating) => floating.mass_matrix(q, output),
    }
    result
}

/// A floating robot's matrix stays in dynibo's velocities while it is timed.
#[unsafe(no_mangle)]
extern "C" fn mass_result(state: *const f64, result: *mut f64) -> *const f64 {
    let (prepared, [q, ..], output) = taken(state, result, true);
    if let Prepared::Floating(floating) = prepared {
        floating.to_own_axes(q, output);
    }
    result
}
