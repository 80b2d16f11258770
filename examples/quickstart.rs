//! A robot arm under gravity for one second: `cargo run --example quickstart`.

use redysim::{ForwardSimulation, Integrator, Mechanism, Ode45, ZeroTorque, redysim};

redysim! { struct Kr5("../models/kr5.toml"); }

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let hold: [f64; 6] = Kr5::gravity_forces(&[0.0; 6]);
    println!("torques that hold {} at rest: {hold:.1?} N m", Kr5.name());

    let mut motion = ForwardSimulation::new(&Kr5, ZeroTorque);
    let start = motion.state(&[0.0; 6], &[0.0; 6]);
    let tenths = (0..=10).map(|tenth| 0.1 * f64::from(tenth));
    Ode45::new().rtol(1e-9).solve(&mut motion, (0.0, 1.0), start, tenths, |t, state| {
        println!("{t:.1} s: q = {:6.3?} rad", &state[..Kr5::NQ]);
    })?;
    Ok(())
}
