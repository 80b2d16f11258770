//! The two tasks that the ReDySim paper timed, on the gripper as ReDySim ships it.
//!
//! The state that the timer hands over is not used, but comes from outside: it is added to the start with weight zero,
//! so that nothing can be worked out in advance.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3};

use redysim::{Cycloid, ForwardSimulation, ZeroTorque, Integrator, Ode45, Trajectory, redysim};

use crate::call::export;

redysim! { struct ShippedGripper("../../../models/gripper.toml"); }

type Joints = [f64; ShippedGripper::NV];

/// ReDySim's grid for inverse dynamics: an instant each 10 ms.
const INSTANTS: usize = 101;

export!("task_inverse", f64 => [Joints; INSTANTS], |&unknown| inverse(0.0 * unknown));
export!("task_fall", f64 => [f64; 2 * ShippedGripper::NV + 1], |&unknown| fall(0.0 * unknown));

/// Joint forces along the motion of the paper's Table 1, over 1 s.
fn inverse(zero: f64) -> [Joints; INSTANTS] {
    let to = [60.0, 80.0, 80.0, 120.0].map(f64::to_radians);
    let motion = Cycloid::new([zero, 0.0, 0.0, FRAC_PI_2], to, 1.0).expect("the ends of a motion of 1 s");
    std::array::from_fn(|k| {
        let at = motion.at(k as f64 / (INSTANTS - 1) as f64);
        ShippedGripper::inverse_dynamics(&at.q, &at.v, &at.a)
    })
}

/// Free fall from 60° below the horizontal for 1 s, at the tolerances that ReDySim ships.
fn fall(zero: f64) -> [f64; 2 * ShippedGripper::NV + 1] {
    let mut simulation = ForwardSimulation::new(&ShippedGripper, ZeroTorque);
    let start = simulation.state(&[-FRAC_PI_3 + zero, 0.0, 0.0, 0.0], &[0.0; ShippedGripper::NV]);
    let shipped = Ode45::new().rtol(1e-4).atol(1e-6);
    shipped.integrate(&mut simulation, (0.0, 1.0), start).expect("a fall of 1 s").y
}
