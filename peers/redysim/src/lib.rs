//! redysim as the timer calls it (see `peers/programs/timer.c`): C functions from a state [q, v, input] to a result.
//!
//! The compiled functions have the robot's name in front and the scalar's behind: `kr5_inverse_f64`.

mod call;
mod compiled;
mod generic;
mod robots;
mod tasks;
