//! Calls every measured function once at each of a few states. `run` counts the instructions within the functions of
//! this file that are named `counted_…`, calls included.
//!
//! Without an argument it prints what can be counted, and the number of calls; with the name of a function it calls
//! that; with a number behind the name, it takes the states so often, several times, and prints the least time of a call, ns.

use redysim::redysim;
use std::hint::black_box;
use std::time::Instant;

redysim! {
    /// Six joints in a row; the last link's rounded inertia belongs to no body.
    #[allow(deprecated)]
    struct Kr5("../../../models/peers/kr5.toml");
}

redysim! {
    /// Two fingers in the plane.
    struct Gripper("../../../models/peers/gripper.toml");
}

redysim! {
    /// Legs, trunk, arms and head.
    struct Humanoid30("../../../models/peers/humanoid30.toml");
}

/// Enough for both signs and all quadrants of every angle.
const CALLS: usize = 64;

/// Coordinates, velocities, and accelerations or forces.
type State<const N: usize> = [[f64; N]; 3];

macro_rules! counted {
    ($($robot:ident: $inverse:ident, $forward:ident, $matrix:ident;)*) => {
        $(
            #[inline(never)]
            fn $inverse([q, v, a]: &State<{ $robot::NV }>) -> [f64; $robot::NV] {
                $robot::inverse_dynamics(q, v, a)
            }

            #[inline(never)]
            fn $forward([q, v, tau]: &State<{ $robot::NV }>) -> [f64; $robot::NV] {
                $robot::forward_dynamics(q, v, tau)
            }

            #[inline(never)]
            fn $matrix([q, _, _]: &State<{ $robot::NV }>) -> [[f64; $robot::NV]; $robot::NV] {
                $robot::mass_matrix(q)
            }
        )*

        /// What can be counted.
        const NAMES: &[&str] = &[$(stringify!($inverse), stringify!($forward), stringify!($matrix)),*];

        fn call(name: &str, rounds: Option<usize>) {
            $(
                match name {
                    stringify!($inverse) => calls($inverse, rounds),
                    stringify!($forward) => calls($forward, rounds),
                    stringify!($matrix) => calls($matrix, rounds),
                    _ => {}
                }
            )*
        }
    };
}

counted! {
    Kr5: counted_kr5_inverse_dynamics, counted_kr5_forward_dynamics, counted_kr5_mass_matrix;
    Gripper: counted_gripper_inverse_dynamics, counted_gripper_forward_dynamics, counted_gripper_mass_matrix;
    Humanoid30: counted_humanoid30_inverse_dynamics, counted_humanoid30_forward_dynamics, counted_humanoid30_mass_matrix;
}

/// How often the time of all rounds is taken, of which the least counts.
const REPETITIONS: usize = 40;

fn calls<const N: usize, R>(function: fn(&State<N>) -> R, rounds: Option<usize>) {
    let mut count = 0.0;
    // Numbers that fill an interval evenly: multiples of the golden ratio, without whole parts.
    let states: [State<N>; CALLS] = core::array::from_fn(|_| {
        [std::f64::consts::PI, 3.0, 10.0].map(|bound| {
            core::array::from_fn(|_| {
                count += 1.0;
                bound * (2.0 * (count * 1.618_033_988_749_895_f64).fract() - 1.0)
            })
        })
    });
    let once = || {
        for state in &states {
            // By reference: a result that is moved is copied.
            black_box(&function(black_box(state)));
        }
    };
    let Some(rounds) = rounds else { return once() };
    let time = |_| {
        let start = Instant::now();
        (0..rounds).for_each(|_| once());
        start.elapsed().as_nanos() as f64 / (rounds * CALLS) as f64
    };
    println!("{:.1}", (0..REPETITIONS).map(time).fold(f64::INFINITY, f64::min));
}

fn main() {
    let mut arguments = std::env::args().skip(1);
    match arguments.next() {
        Some(name) => call(&name, arguments.next().and_then(|rounds| rounds.parse().ok())),
        None => NAMES.iter().for_each(|name| println!("{name} {CALLS}")),
    }
}
