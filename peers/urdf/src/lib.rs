//! Dynamics of a mechanism, compiled or generic, at states that another program writes.

use redysim::{
    ForwardDynamics, FrameAcceleration, Frames, InverseDynamics, MassCenter, MassMatrix, TotalMomentum, Vector, Wrench,
};
use std::error::Error;
use std::io::{BufRead, Write};

/// Answers to the states on the standard input.
///
/// First it prints the names of the joints that move, with tabs between. Then, for each line of 2 NQ + 2 NV + 6 NF numbers
/// q, v, a, other coordinates p and the wrenches w on the frames that it reads, one line of NV + NV² + NV + 6 NF NV + 6 NF
/// + 9 + NQ + NV: the joint forces at (q, v, a) under w, the mass matrix by rows, the accelerations at (q, v) under the
/// forces a and w, the Jacobians of the frames by rows, and their J̇ v; the centre of mass, linear momentum, and angular
/// momentum about it; q ⊞ v, and p ⊟ q. Numbers are written so that they read back as they are.
pub fn answer<M>(mechanism: &M) -> Result<(), Box<dyn Error>>
where
    M: InverseDynamics<f64>
        + MassMatrix<f64>
        + ForwardDynamics<f64>
        + MassCenter<f64>
        + TotalMomentum<f64>
        + Frames<f64, Wrenches: Vector<Wrench<f64>>>,
{
    let (nq, nv, nf) = (mechanism.nq(), mechanism.nv(), mechanism.nf());
    let mut out = std::io::stdout().lock();
    let names: Vec<&str> = (0..).map_while(|joint| mechanism.joint_name(joint)).collect();
    writeln!(out, "{}", names.join("\t"))?;
    for line in std::io::stdin().lock().lines() {
        let state = line?.split_whitespace().map(str::parse).collect::<Result<Vec<f64>, _>>()?;
        let own = 2 * nq + 2 * nv;
        if state.len() != own + 6 * nf {
            return Err(format!("a state of {} numbers instead of 2 · {nq} + 2 · {nv} + 6 · {nf}", state.len()).into());
        }
        let [q, other] = [0, nq + 2 * nv].map(|from| M::Coordinates::from_fn(nq, |index| state[from + index]));
        let [v, a] = [nq, nq + nv].map(|from| M::Velocities::from_fn(nv, |index| state[from + index]));
        let part = |from: usize| [0, 1, 2].map(|axis| state[own + from + axis]);
        let wrenches = M::Wrenches::from_fn(nf, |frame| Wrench { force: part(6 * frame), moment: part(6 * frame + 3) });
        let external = mechanism.frame_forces(&q, &wrenches);
        let external = external.as_ref();
        let driven = M::Velocities::from_fn(nv, |joint| a.as_ref()[joint] + external[joint]);
        let inverse = mechanism.inverse_dynamics(&q, &v, &a);
        let forces: Vec<f64> = (0..nv).map(|i| inverse.as_ref()[i] - external[i]).collect();
        let matrix = mechanism.mass_matrix(&q);
        let accelerations = mechanism.forward_dynamics(&q, &v, &driven);
        let (jacobians, bias) = (mechanism.frame_jacobians(&q), mechanism.frame_bias(&q, &v));
        let rows = matrix.as_ref().iter().flat_map(|row| row.as_ref());
        let columns = jacobians.as_ref().iter().flat_map(|jacobian| jacobian.linear.iter().chain(&jacobian.angular));
        let bias = bias.as_ref().iter().flat_map(|FrameAcceleration { linear, angular }| linear.iter().chain(angular));
        let (center, momentum) = (mechanism.center_of_mass(&q, &v), mechanism.momentum(&q, &v));
        let whole = [center.position, momentum.linear, momentum.angular];
        let (moved, way) = (mechanism.integrate(&q, &v), mechanism.difference(&q, &other));
        let numbers = forces.iter().chain(rows).chain(accelerations.as_ref());
        let numbers = numbers.chain(columns.flat_map(|row| row.as_ref())).chain(bias).chain(whole.as_flattened());
        let numbers = numbers.chain(moved.as_ref()).chain(way.as_ref());
        writeln!(out, "{}", numbers.map(|number| format!("{number:?}")).collect::<Vec<_>>().join(" "))?;
    }
    Ok(())
}
