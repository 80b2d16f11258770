//! Times the functions whose machine code `run` looks at. Prints for every function its name, the number of its angles,
//! the time of a call in ns and the processor's clock in GHz.
//!
//! The clock is found by a chain of additions, of which every processor does one a cycle, in turns with the function.
//! Of many short runs the fastest counts, since what else the machine does only makes them slower.

use processors::{Gripper, Kr5, gripper, kr5, lanes};
use redysim::Scalar;
use redysim::lanes::{F64x4, F64x8};
use std::arch::asm;
use std::hint::black_box;
use std::time::Instant;

/// States that calls go through: as in the benches.
const STATES: usize = 64;
const CALLS_OF_A_RUN: usize = 16 * STATES;
const RUNS: usize = 1000;

/// Nanoseconds that an addition takes which waits for the one before it.
fn addition() -> f64 {
    const REPEATED: usize = 200;
    let mut sum = 1_u64;
    let start = Instant::now();
    for _ in 0..REPEATED {
        // SAFETY: it changes one register, which it names, and the flags.
        unsafe {
            #[cfg(target_arch = "x86_64")]
            asm!(".rept 100", "add {0}, {0}", ".endr", inout(reg) sum, options(nomem, nostack));
            #[cfg(target_arch = "aarch64")]
            asm!(".rept 100", "add {0}, {0}, {0}", ".endr", inout(reg) sum, options(nomem, nostack));
        }
    }
    black_box(sum);
    start.elapsed().as_nanos() as f64 / (REPEATED * 100) as f64
}

/// Numbers that fill an interval evenly: multiples of the golden ratio, without whole parts.
struct Numbers(f64);

impl Numbers {
    fn row<S: Scalar, const N: usize>(&mut self, bound: f64) -> [S; N] {
        std::array::from_fn(|_| {
            self.0 += 1.0;
            S::from_f64(bound * (2.0 * (self.0 * 1.618_033_988_749_895_f64).fract() - 1.0))
        })
    }
}

type State<S, const N: usize> = [[S; N]; 3];

/// Prints the time of a call.
fn time<S: Scalar, const N: usize, R>(name: &str, angles: u32, call: impl Fn(&State<S, N>) -> R) {
    let mut numbers = Numbers(0.0);
    let states: [State<S, N>; STATES] =
        std::array::from_fn(|_| [std::f64::consts::PI, 3.0, 10.0].map(|bound| numbers.row(bound)));
    let run = || {
        let start = Instant::now();
        for _ in 0..CALLS_OF_A_RUN / STATES {
            for state in black_box(&states) {
                // By reference: by value the result would be copied, in another way for each target.
                black_box(&call(state));
            }
        }
        start.elapsed().as_nanos() as f64 / CALLS_OF_A_RUN as f64
    };
    let [mut call, mut cycle] = [f64::INFINITY; 2];
    for _ in 0..RUNS {
        (call, cycle) = (call.min(run()), cycle.min(addition()));
    }
    println!("{name} {angles} {call} {}", 1.0 / cycle);
}

macro_rules! timed {
    ($($name:literal $robot:ident $scalar:ident $($module:ident)::*;)*) => {$({
        use $($module)::* as functions;
        const N: usize = $robot::NQ;
        let ops = $robot::OPS;
        time::<$scalar, N, _>(concat!($name, "_inverse_dynamics"), ops.inverse_dynamics.trig, |[q, v, a]| {
            functions::inverse_dynamics(q, v, a)
        });
        time::<$scalar, N, _>(concat!($name, "_forward_dynamics"), ops.forward_dynamics.trig, |[q, v, tau]| {
            functions::forward_dynamics(q, v, tau)
        });
        time::<$scalar, N, _>(concat!($name, "_mass_matrix"), ops.mass_matrix.trig, |[q, _, _]| {
            functions::mass_matrix(q)
        });
    })*};
}

fn main() {
    timed! {
        "single_kr5_f64" Kr5 f64 kr5::double;
        "single_kr5_f32" Kr5 f32 kr5::float;
        "lanes_kr5_F64x4" Kr5 F64x4 lanes::kr5_four;
        "lanes_kr5_F64x8" Kr5 F64x8 lanes::kr5_eight;
        "single_gripper_f64" Gripper f64 gripper::double;
        "single_gripper_f32" Gripper f32 gripper::float;
        "lanes_gripper_F64x4" Gripper F64x4 lanes::gripper_four;
        "lanes_gripper_F64x8" Gripper F64x8 lanes::gripper_eight;
    }
}
