//! What the functions of a mechanism with closed loops cost, compiled and generic.

use std::hint::black_box;

use redysim::{
    ClosedLoop, ClosedLoopInverse, LoopClosure, OperationCount, Operations, Trajectory, TreeDynamics, Vector,
};

use super::Failure;
use super::loop_inverse::{LoopInverseRun, along_loops};
use super::speed::{STATES, remark_processor, side_by_side};
use super::table::{Table, headline, remark};

/// A motion to go through, periodic in `period`.
pub struct Turn<'a, T> {
    pub actuated: &'a [usize],
    /// A closed position, or nearly, at the beginning.
    pub guess: &'a [f64],
    pub trajectory: T,
    pub period: f64,
}

/// Prints operations and time per call of what closed loops are solved by, along one period of a motion.
pub fn report<M, G, I, T>(compiled: &M, operations: &Operations, generic: &G, turn: &Turn<'_, T>) -> Result<(), Failure>
where
    M: TreeDynamics<f64> + LoopClosure<f64, M>,
    G: TreeDynamics<f64> + LoopClosure<f64, G>,
    I: Vector<f64>,
    T: Trajectory<f64, I, I>,
{
    headline("Operations, and time per call: compiled against the generic path");
    let (fast, slow) = (calls(compiled, turn)?, calls(generic, turn)?);
    let counts = [
        Some(operations.mass_matrix),
        Some(operations.bias_forces),
        Some(operations.loop_residual),
        Some(operations.loop_jacobian),
        Some(operations.loop_bias),
        None,
        None,
        None,
    ];
    let mut table = Table::new(&["function", "flops\n", "sin/cos\npairs", "compiled\nns", "generic\nns", "ratio\n"]);
    for (((name, mut fast), (_, mut slow)), count) in fast.into_iter().zip(slow).zip(counts) {
        let (fast, slow) = side_by_side(&mut fast, &mut slow);
        let of =
            |part: fn(&OperationCount) -> u32| count.as_ref().map_or("".to_owned(), |count| part(count).to_string());
        let times = [format!("{fast:.1}"), format!("{slow:.0}"), format!("{:.1}", slow / fast)];
        table.row([name.to_owned(), of(OperationCount::flops), of(|count| count.trig)].into_iter().chain(times));
    }
    table.print();
    remark("Medians of batches in turns. The loops' inverse dynamics moves on to the next instant by Newton's method,");
    remark(&format!("1/{STATES} of the period; the projection is that of a step that has not drifted."));
    remark_processor();
    Ok(())
}

type Call<'a> = Box<dyn FnMut(usize) + 'a>;

/// The functions by name; each is given the number of an instant.
fn calls<'a, M, I, T>(mechanism: &'a M, turn: &'a Turn<'_, T>) -> Result<Vec<(&'static str, Call<'a>)>, Failure>
where
    M: TreeDynamics<f64> + LoopClosure<f64, M>,
    I: Vector<f64> + 'a,
    T: Trajectory<f64, I, I>,
{
    let instants: Vec<f64> = (0..STATES).map(|k| turn.period * k as f64 / STATES as f64).collect();
    let guess = || M::Coordinates::from_fn(mechanism.nq(), |i| turn.guess[i]);
    let run = along_loops(mechanism, turn.actuated, guess(), &turn.trajectory, instants)?;
    let states = states(mechanism, &run);
    let loops = ClosedLoop::new(mechanism);
    let mut inverse = ClosedLoopInverse::new(loops, turn.actuated, guess());
    let at = move |call: fn(&M, &State<M>)| -> Call<'a> {
        let states = states.clone();
        Box::new(move |k| call(mechanism, black_box(&states[k])))
    };
    // On and on, not back to the beginning: a whole turn back would be a long way for Newton's method.
    let mut count = 0.0;
    let inverse_dynamics = move |_: usize| {
        count += 1.0;
        black_box(inverse.at(black_box(turn.period / STATES as f64 * count), &turn.trajectory).is_ok());
    };
    Ok(vec![
        ("mass matrix", at(|m, s| drop(black_box(m.mass_matrix(&s.q))))),
        ("bias forces", at(|m, s| drop(black_box(m.bias_forces(&s.q, &s.v))))),
        ("loop residual", at(|m, s| drop(black_box(m.loop_residual(&s.q))))),
        ("loop Jacobian", at(|m, s| drop(black_box(m.loop_jacobian(&s.q))))),
        ("loop bias", at(|m, s| drop(black_box(m.loop_bias(&s.q, &s.v))))),
        ("accelerations and λ", at(|m, s| drop(black_box(ClosedLoop::new(m).dynamics(&s.q, &s.v, &s.tau))))),
        ("projection", at(|m, s| drop(black_box(ClosedLoop::new(m).project(&s.q, &s.v))))),
        ("inverse dynamics of the loops", Box::new(inverse_dynamics)),
    ])
}

/// Coordinates, velocities and joint forces.
struct State<M: TreeDynamics<f64>> {
    q: M::Coordinates,
    v: M::Velocities,
    tau: M::Velocities,
}

fn states<M: TreeDynamics<f64>>(mechanism: &M, run: &LoopInverseRun) -> std::rc::Rc<Vec<State<M>>> {
    let velocities = |row: &[f64]| M::Velocities::from_fn(mechanism.nv(), |i| row[i]);
    let state = |k: usize| State {
        q: M::Coordinates::from_fn(mechanism.nq(), |i| run.q[k][i]),
        v: velocities(&run.v[k]),
        tau: M::Velocities::from_fn(mechanism.nv(), |_| 0.0),
    };
    std::rc::Rc::new((0..run.t.len()).map(state).collect())
}
