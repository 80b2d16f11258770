//! Calls every measured function once at each of a few states. `run` counts the instructions within the functions of
//! this file that are named `counted_…`, calls included.
//!
//! Without an argument it prints what can be counted, and the number of calls; with the name of a function it calls
//! that.

use redysim::redysim;
use std::hint::black_box;

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

        fn call(name: &str) {
            $(
                match name {
                    stringify!($inverse) => calls($inverse),
                    stringify!($forward) => calls($forward),
                    stringify!($matrix) => calls($matrix),
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

fn calls<const N: usize, R>(function: fn(&State<N>) -> R) {
    let mut count = 0.0;
    for _ in 0..CALLS {
        // Numbers that fill an interval evenly: multiples of the golden ratio, without whole parts.
        let state = [std::f64::consts::PI, 3.0, 10.0].map(|bound| {
            core::array::from_fn(|_| {
                count += 1.0;
                bound * (2.0 * (count * 1.618_033_988_749_895_f64).fract() - 1.0)
            })
        });
        black_box(function(black_box(&state)));
    }
}

fn main() {
    match std::env::args().nth(1) {
        Some(name) => call(&name),
        None => NAMES.iter().for_each(|name| println!("{name} {CALLS}")),
    }
}
