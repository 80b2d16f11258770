//! Dynamics of a model file at given states, by redysim's generic path: `redysim-evaluate MODEL.toml < STATES`.
//!
//! First it prints the names of the joints that move, with tabs between. Then, for each line of 3 NV numbers q, v and a that
//! it reads, one line of NV + NV² + NV: the joint forces at (q, v, a), the mass matrix by rows, and the accelerations at
//! (q, v) under the forces a. Numbers are written so that they read back as they are.

use redysim::generic::GenericMechanism;
use redysim::{ForwardDynamics, InverseDynamics, MassMatrix, Mechanism};
use std::error::Error;
use std::io::{BufRead, Write};

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("which model file?")?;
    let mechanism = GenericMechanism::new(redysim::generic::Model::load(path)?.model);
    let nv = Mechanism::<f64>::nv(&mechanism);
    let mut out = std::io::stdout().lock();
    let names: Vec<&str> = (0..nv).filter_map(|joint| Mechanism::<f64>::joint_name(&mechanism, joint)).collect();
    writeln!(out, "{}", names.join("\t"))?;
    for line in std::io::stdin().lock().lines() {
        let state = line?.split_whitespace().map(str::parse).collect::<Result<Vec<f64>, _>>()?;
        if state.len() != 3 * nv {
            return Err(format!("a state of {} numbers instead of 3 · {nv}", state.len()).into());
        }
        let [q, v, a] = [0, 1, 2].map(|part| state[part * nv..(part + 1) * nv].to_vec());
        let forces = mechanism.inverse_dynamics(&q, &v, &a);
        let matrix = mechanism.mass_matrix(&q).concat();
        let accelerations = mechanism.forward_dynamics(&q, &v, &a);
        let numbers = forces.iter().chain(&matrix).chain(&accelerations);
        writeln!(out, "{}", numbers.map(|number| format!("{number:?}")).collect::<Vec<_>>().join(" "))?;
    }
    Ok(())
}
