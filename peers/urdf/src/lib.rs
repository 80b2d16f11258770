//! Dynamics of a mechanism, compiled or generic, at states that another program writes.

use redysim::{ForwardDynamics, InverseDynamics, MassMatrix, Vector};
use std::error::Error;
use std::io::{BufRead, Write};

/// Answers to the states on the standard input.
///
/// First it prints the names of the joints that move, with tabs between. Then, for each line of 3 NV numbers q, v and a
/// that it reads, one line of NV + NV² + NV: the joint forces at (q, v, a), the mass matrix by rows, and the
/// accelerations at (q, v) under the forces a. Numbers are written so that they read back as they are.
pub fn answer<M>(mechanism: &M) -> Result<(), Box<dyn Error>>
where
    M: InverseDynamics<f64> + MassMatrix<f64> + ForwardDynamics<f64>,
{
    let nv = mechanism.nv();
    let mut out = std::io::stdout().lock();
    let names: Vec<&str> = (0..nv).filter_map(|joint| mechanism.joint_name(joint)).collect();
    writeln!(out, "{}", names.join("\t"))?;
    for line in std::io::stdin().lock().lines() {
        let state = line?.split_whitespace().map(str::parse).collect::<Result<Vec<f64>, _>>()?;
        if state.len() != 3 * nv {
            return Err(format!("a state of {} numbers instead of 3 · {nv}", state.len()).into());
        }
        let q = M::Coordinates::from_fn(nv, |joint| state[joint]);
        let [v, a] = [1, 2].map(|part| M::Velocities::from_fn(nv, |joint| state[part * nv + joint]));
        let forces = mechanism.inverse_dynamics(&q, &v, &a);
        let matrix = mechanism.mass_matrix(&q);
        let accelerations = mechanism.forward_dynamics(&q, &v, &a);
        let rows = matrix.as_ref().iter().flat_map(|row| row.as_ref());
        let numbers = forces.as_ref().iter().chain(rows).chain(accelerations.as_ref());
        writeln!(out, "{}", numbers.map(|number| format!("{number:?}")).collect::<Vec<_>>().join(" "))?;
    }
    Ok(())
}
